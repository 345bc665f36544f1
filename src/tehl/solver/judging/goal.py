"""The accuracy to reach: error estimates of a run so far, and whether a finer grid follows."""

import math
import time
from dataclasses import dataclass, field, replace

from tehl.base.units import percentage
from tehl.base.wording import grid_size
from tehl.contact.options import MOST_NODES_PER_AXIS, Domain, Options, can_be_halved
from tehl.estimate.domain import far_field_error
from tehl.estimate.entering import entry_error
from tehl.estimate.memory import USUAL_MEMORY, memory_limit, needed_memory
from tehl.estimate.nodes import FAMILIES, FAVOURED, LIMITED_RATIO, most_lines, side_bar
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.spin import spin_error
from tehl.estimate.starvation import supply_error
from tehl.estimate.third_order import LEAST_SLENDER, third_order_bar
from tehl.result.bars import ErrorEstimate
from tehl.solver.cost import LEAST_SECONDS
from tehl.solver.cycle.continuation import Roughness
from tehl.solver.cycle.hierarchy import Hierarchy
from tehl.solver.cycle.level import Level
from tehl.solver.judging.convergence import GridTrace
from tehl.solver.judging.film_summary import central_value
from tehl.solver.judging.grid_errors import Thinnest, error_estimate, single_grid_estimate
from tehl.solver.judging.measures import (
    is_pressed_at_end,
    is_thinnest_at_end,
    is_thinnest_at_side,
    side_reach,
)

FACTOR = 5.0
"""Expected time on a grid over that on the next coarser one, which has a quarter of its nodes."""
MOST_TRIES = 2
"""Finer grids that follow grids on which the cycles do not converge."""
MOST_EXPECTED = 0.85
"""Largest over usual bar of a flooded film with a wedge of third order: of 96 films of machines on
grids with a usual bar below 2 % as many lie outside (3) as with 1.25, judged on grids two to four
times as fine. With scarce oil the edge of the film decides."""
HOT_SPEED = 30.0
"""Moes speed L up to which that holds where oil heats: of 3 rings with L = 31 to 53 two lie
outside, of 21 others with L > 18 none."""
FEW_LINES, LOAD_AT_EXIT, PART_AT_EXIT = 3.0, 3e3, 0.9
"""Nodes along x over lines, and load M, from which the bar of a minimum at the exit is at least
this part of the bar to expect: it varies along y there. Four of 60 bearings with M = 100 to 50,000
lie outside by up to a third, as judged by films within 0.1 %; without it six by up to three."""
LOAD_AT_SIDES, EXTRAPOLATED_AT_SIDE = 1e3, 0.5
"""Load M from which two grids of a wide contact are enough to extrapolate a minimum at the sides,
and its least bar over that of one that is not: of 14 rigs (M = 1,700 to 14,000) it errs by a third
as much."""
MISSED_LOBE = 1.9
"""Factor on the least bar of a minimum at the sides where oil is scarce and none was found: lines
may miss it. That of an outer ring (M = 4,850) is 1.6 % thinner than at the exit."""
LEAST_HALVINGS = 3
"""Halvings of the smallest grid that is planned."""
NEGLIGIBLE_ITERATION_ERROR = 0.05
"""Iteration error that is accepted, over the error to reach: the error bars contain it."""
SPARE_PART, MOST_SPARE = 0.5, 0.2
"""Part of what the other errors leave of the error to reach, and part of that error, that the
iteration may keep on the finest grid."""
LINES_PART = 2.0
"""Bar of the minimum film over that of the central one from which the mesh along y decides."""
LEAST_LEFT = 0.4
"""Part of the error to reach that is left to the mesh along y, below which lines alone are too
many: with 0.55 of it by the supply a ring (M = 34,300) needs 1.7 times as many."""
FLOODED_PART = 0.7
"""Error to reach of a flooded film to which ``supply.ratio`` is stated, over that of the starved
one, which has it beside its own: with 0.5 an inner ring (M = 3,700) needs another grid, with 1 a
starved rig (M = 811)."""
BETWEEN, BETWEEN_MARGIN, MOST_OTHERS = 1.5, 1.05, 2
"""Most intervals along x of another grid over those of the last, as half the mesh width costs four
times as much; margin of its error bars; and how many other grids are tried."""


def estimated_errors(
    level: Level, traces: list[GridTrace], roughness: Roughness, hierarchy: Hierarchy
) -> ErrorEstimate | None:
    """Return estimated errors of the film on the last grid; None before its first cycle.

    Parameters
    ----------
    level : Level
        The last level that was solved.
    traces : list of GridTrace
        Film over the cycles of its grid and of the coarser ones, coarsest first.
    roughness : Roughness
        Heights on the levels.
    hierarchy : Hierarchy
        The contact, and the order of the wedge.
    """
    found = _by_grids(level, traces, roughness, hierarchy)
    if found is None:
        return None
    bars, at_end = found.bars, is_pressed_at_end(level)
    if at_end:
        bars = {name: bar for name, bar in bars.items() if name != "pressure_max"}
    # a boundary film in the middle does not depend on the oil that enters
    meets = central_value(level.grid, level.share.meets(level).astype(float))
    least, expected = 0.0, 0.0 if roughness.is_rough else _expected_bar(hierarchy, level)
    at_side, scaled = is_thinnest_at_side(level), hierarchy.scaled
    if expected and (at_side or scaled.problem.supply is not None):
        least = side_bar(scaled, level.grid.domain, level.grid.ny) * (
            1.0 if at_side else MISSED_LOBE
        )
        least *= EXTRAPOLATED_AT_SIDE if found.extrapolated else 1.0
    elif level.grid.nx > FEW_LINES * level.grid.ny and scaled.groups.M > LOAD_AT_EXIT:
        least = PART_AT_EXIT * expected
    # after the last cycle; grids that show an order show it with what lines miss
    if traces[-1].measured and not (roughness.is_rough or found.extrapolated):
        least = max(least, side_reach(level))
    supply = max(1.0 - meets, 0.0) * supply_error(scaled)
    return replace(
        found,
        bars={name: bar + supply for name, bar in bars.items()},
        discretisation_minimum=max(found.discretisation_minimum, least),
        supply=supply,
        minimum_has_limit=not is_thinnest_at_end(level),
        pressure_has_limit=not at_end,
    )


def _by_grids(
    level: Level, traces: list[GridTrace], roughness: Roughness, hierarchy: Hierarchy
) -> ErrorEstimate | None:
    """Return the errors of `estimated_errors` without that of the supply."""
    scaled, order = hierarchy.scaled, hierarchy.options.order
    if len(traces) < 2 or not traces[-1].reports or traces[-1].diverged:
        return None
    edges, domain, newtonian = level.grid.domain, 0.0, not scaled.problem.is_coupled
    sliding = math.hypot(scaled.moment.sliding, scaled.problem.motion.sliding_ratio[1])
    if level.equations.far_field is not None:
        domain = far_field_error(scaled.entering, edges) + entry_error(scaled, edges)
        domain += spin_error(scaled)
    goes_on = scaled.groups.shape.goes_on
    if not roughness.is_rough:
        compared = comparable(traces, goes_on=goes_on)
        if len(compared) < 2:
            return None
        expected = _expected_bar(hierarchy, level)
        is_scarce = scaled.problem.supply is not None
        is_limited = not is_scarce or scaled.groups.ellipticity >= LIMITED_RATIO
        is_limited &= scaled.problem.thermal is None or scaled.groups.L <= HOT_SPEED
        return error_estimate(
            compared,
            order,
            domain,
            newtonian=newtonian,
            sliding=sliding,
            least=expected,
            most=MOST_EXPECTED * expected if expected and is_limited else math.inf,
            extrapolate=bool(hierarchy.options.extrapolate) and traces[-2:] == compared[-2:],
            kind=scaled.problem.contact.type,
            thinnest=_thinnest(level),
            scarce=is_scarce,
        )
    # grids that resolve the same heights
    compared = comparable(traces[roughness.first_comparable :], goes_on=goes_on)
    if len(compared) < 2:
        points, amplitude = roughness.points, roughness.amplitude
        return single_grid_estimate(traces[-1], level.grid.dx, points, amplitude, domain)
    kind = scaled.problem.contact.type
    return error_estimate(
        compared, order, domain, rough=True, newtonian=newtonian, sliding=sliding, kind=kind
    )


def _thinnest(level: Level) -> Thinnest:
    """Return where a heavily loaded film is thinnest, as `error_estimate` asks."""
    groups, at_side = level.equations.groups, is_thinnest_at_side(level)
    is_wide = groups.ellipticity < LEAST_SLENDER
    if is_wide and at_side and groups.M > LOAD_AT_SIDES:
        return "sides"
    return "anywhere" if is_wide or at_side or groups.M < LOAD_AT_EXIT else "exit"


def comparable(traces: list[GridTrace], *, goes_on: bool = False) -> list[GridTrace]:
    """Return the grids that did not diverge, whose films make error bars, coarsest first.

    They are the last two where the third last is isothermal and the last one is not.

    Parameters
    ----------
    traces : list of GridTrace
        Coarsest first.
    goes_on : bool
        Whether the contact is a piece of a roller. Its first grids differ in their lines alone, so
        that their films agree however long their cells are along x: of those the last one counts.
    """
    found = [trace for trace in traces if not trace.diverged]
    if goes_on:
        alike = (k for k in range(1, len(found)) if found[k].columns == found[k - 1].columns)
        found = found[max(alike, default=0) :]
    if len(found) > 2 and found[-3].coupled != found[-1].coupled:
        return found[-2:]
    return found


def _expected_bar(hierarchy: Hierarchy, level: Level) -> float:
    """Return the error bar to expect with a wedge of third order; zero where there is no fit."""
    if hierarchy.options.order < 3 or hierarchy.scaled.groups.shape.as_line:
        return 0.0
    return third_order_bar(hierarchy.scaled, level.grid.domain, *level.grid.points)


@dataclass(slots=True)
class Goal:
    """The relative error of the film to reach, and the limits of memory and time.

    Parameters
    ----------
    scaled, options : ScaledProblem, Options
        The contact, and the options of the user.
    of_central : bool
        Whether the error is that of the central film alone: a supply is stated to that.
    until : float
        When the time is over, on the clock of `time.perf_counter` [s].
    """

    scaled: ScaledProblem
    options: Options
    of_central: bool = False
    until: float = math.inf
    obstacle: str = ""
    """Why no finer grid follows."""
    _tries: int = 0
    _others: int = 0
    _started: float = field(default_factory=time.perf_counter)
    _last: float = field(default_factory=time.perf_counter)

    @property
    def target(self) -> float:
        """The relative error to reach [-]."""
        return self.options.target * (FLOODED_PART if self.of_central else 1.0)

    @property
    def is_open(self) -> bool:
        """Whether the error decides the number of nodes."""
        return self.options.points == "auto"

    @property
    def may_end_early(self) -> bool:
        """Whether a grid coarser than the planned one may be the last.

        Roughness, also such that moves in later, needs the planned grid.
        """
        return self.is_open and not self.scaled.problem.is_rough

    @property
    def negligible(self) -> float:
        """Relative iteration error of the film that is always accepted [-]."""
        return NEGLIGIBLE_ITERATION_ERROR * self.target if self.is_open else 0.0

    def spare(self, errors: ErrorEstimate | None) -> float:
        """Return the relative iteration error that is accepted on the finest grid [-].

        Parameters
        ----------
        errors : ErrorEstimate or None
            Estimates on that grid after its last cycle.
        """
        if errors is None or not self.is_open:
            return 0.0
        others = errors.central - errors.iteration_central
        if errors.minimum_has_limit and not self.of_central:
            others = max(others, errors.minimum - errors.iteration_minimum)
        target = self.target
        return min(SPARE_PART * (target - others), MOST_SPARE * target)

    def fitting(self, plan: Options) -> Options:
        """Return options of the planned grid, halved until it fits into the memory."""
        available = memory_limit(self.options)
        while self.is_open and can_be_halved(plan, LEAST_HALVINGS):
            if needed_memory(plan, self.scaled.problem) <= available:
                break
            ny, nx = ((n - 1) // 2 + 1 for n in plan.shape)
            plan = plan.on_points(nx, ny)
        return plan

    def begin_grid(self) -> None:
        """Note the time at which the work on a grid begins."""
        self._last = time.perf_counter()

    def is_met(
        self, errors: ErrorEstimate | None, part: float = 1.0, error: float | None = None
    ) -> bool:
        """Return whether the error estimates are below the error to reach, or ``error``.

        Parameters
        ----------
        errors : ErrorEstimate or None
            Estimates on a grid.
        part : float
            Minimum film over the film to which its error is relative [-].
        error : float
            Another relative error [-].
        """
        if errors is None:
            return False
        reached = errors.central if self.of_central else errors.film(part)
        return reached <= (error or self.target)

    @property
    def is_over(self) -> bool:
        """Whether the time is over, so that no other cycle begins."""
        return time.perf_counter() > max(self.until, self._started + LEAST_SECONDS)

    def may_try(self, level: Level) -> bool:
        """Return whether a finer grid may follow one that did not converge."""
        if not self.is_open or self._tries == MOST_TRIES:
            return False
        self._tries += 1
        return self.may_refine(level)

    def more_lines(self, level: Level, errors: ErrorEstimate | None) -> int | None:
        """Return lines with which the minimum film meets the goal; None if others err too.

        Parameters
        ----------
        level : Level
            Finest level so far, whose central film meets the goal.
        errors : ErrorEstimate or None
            Of that level.
        """
        grid, target = level.grid, self.target
        if errors is None or errors.central > target or not self.options.extrapolate:
            return None
        bar = errors.discretisation_minimum
        left = target - (errors.minimum - bar)
        if self.of_central or not errors.minimum_has_limit or left < LEAST_LEFT * target:
            return None
        if side_reach(level) < bar:  # or else lines alone decide
            is_scarce = self.scaled.problem.supply is not None
            at_side = is_thinnest_at_side(level) or is_scarce
            if not at_side or bar < LINES_PART * errors.discretisation_central:
                return None
            known = side_bar(self.scaled, grid.domain, grid.ny)
            if known < 0.2 * target and not (is_scarce and known == 0.0):
                return None
        least = (grid.ny - 1) * math.sqrt(BETWEEN_MARGIN * bar / left)
        enough = (n for n in FAVOURED if n > least and n > grid.ny)
        finer = min(next(enough, MOST_NODES_PER_AXIS), 2 * grid.ny - 1)
        most = most_lines(self.scaled.groups.ellipticity) * grid.nx
        return finer if finer <= min(most, MOST_NODES_PER_AXIS) else None

    def other_nodes(self, level: Level, errors: ErrorEstimate | None) -> tuple[int, int] | None:
        """Return nodes (nx, ny) of another grid that is expected to reach the error; None if none.

        It has more lines alone, or a mesh between that of the last grid and half of it.

        Parameters
        ----------
        level : Level
            Finest level so far.
        errors : ErrorEstimate or None
            Of that level.
        """
        if self._others == MOST_OTHERS:
            return None
        lines = self.more_lines(level, errors)
        found = self._between(level, errors) if lines is None else (level.grid.nx, lines)
        if found is None or self._needed(found) > self._left(level):
            return None
        self._others += 1
        return found

    def _between(self, level: Level, errors: ErrorEstimate | None) -> tuple[int, int] | None:
        """Return nodes (nx, ny) with a mesh on which bars of second order meet the goal.

        If they do on none, and half the mesh width is out of reach, those with the finest.
        """
        grid, target = level.grid, self.target
        if errors is None or not self.options.extrapolate:
            return None
        if self.of_central or self.scaled.problem.supply is not None:  # fewer grids converge
            return None
        pairs = [(errors.central, errors.discretisation_central)]
        if errors.minimum_has_limit:
            pairs.append((errors.minimum, errors.discretisation_minimum))
        left = [(bar, target - (whole - bar)) for whole, bar in pairs]
        if min(part for _, part in left) <= 0.0 or grid.is_closed or grid.ny == 1:
            return None
        ratio = max(bar / part for bar, part in left)
        least = (grid.nx - 1) * math.sqrt(BETWEEN_MARGIN * ratio)
        between = [n for n in FAMILIES if grid.nx < n <= BETWEEN * (grid.nx - 1) + 1]
        least_lines = [(n - 1) * (grid.ny - 1) / (grid.nx - 1) + 1 for n in between]
        lines = [next((m for m in FAMILIES if m >= one), 0) for one in least_lines]
        grids = [points for points in zip(between, lines, strict=True) if points[1]]
        found = next((points for points in grids if points[0] > least), None)
        if found or self.may_refine(level, errors):
            return found
        fits = [points for points in grids if self._needed(points) <= self._left(level)]
        return fits[-1] if fits else None

    def _left(self, level: Level) -> float:
        """Return the memory beside the grids up to a level, kept until others end [byte]."""
        return memory_limit(self.options) - self._needed(level.grid.points)

    def _needed(self, points: tuple[int, int]) -> float:
        """Return the memory that a grid of nodes (nx, ny) needs [byte]."""
        return needed_memory(self.options.on_points(*points), self.scaled.problem)

    def may_refine(self, level: Level, errors: ErrorEstimate | None = None) -> bool:
        """Return whether a grid of twice the intervals may follow; if not, `obstacle` says why.

        Parameters
        ----------
        level : Level
            Finest level so far.
        errors : ErrorEstimate or None
            Of that level; the part of the domain would not become smaller.
        """
        nx, ny = (2 * (n - 1) + 1 for n in level.grid.points)
        now, limit = time.perf_counter(), self.options.max_time
        expected = FACTOR * (now - self._last)
        needed = self._needed((nx, ny))
        available, supply = memory_limit(self.options), supply_error(self.scaled)
        self.obstacle = ""
        if errors is not None and errors.domain > self.target:
            cause = "the domain, upstream of which the oil warms or cools"
            if spin_error(self.scaled) > 0.5 * errors.domain:
                cause = "the pressure that spin makes outside the domain, in the gap of an ellipse"
            if isinstance(self.options.domain, Domain):
                cause = "numerics.domain"
            self.obstacle = f"{percentage(errors.domain)} are due to {cause}"
        elif errors is not None and supply > self.target and errors.central < 2.0 * supply:
            self.obstacle = (
                f"{percentage(supply)} are due to the flooded film, of which supply.ratio is a part"
            )
        elif max(nx, ny) > MOST_NODES_PER_AXIS:
            self.obstacle = f"grids have at most {MOST_NODES_PER_AXIS} nodes along one direction"
        elif needed > available:
            self.obstacle = (
                f"{grid_size((nx, ny))} need {needed / 1e9:.2g} GB of memory, and "
                f"{_named_limit(self.options, available)}"
            )
        elif now + expected > self.until:
            self.obstacle = (
                f"{grid_size((nx, ny))} would take {expected:.3g} s more, and numerics.max_time is "
                f"{limit:g} s"
            )
        return not self.obstacle


def _named_limit(options: Options, limit: float) -> str:
    """Return the limit of the memory in words."""
    if options.max_memory is not None:
        return f"numerics.max_memory is {limit / 1e9:.2g} GB"
    whose = "the usual limit" if limit == USUAL_MEMORY else "half of what is free"
    return f"{whose} is {limit / 1e9:.2g} GB (numerics.max_memory)"
