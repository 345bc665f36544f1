"""The accuracy to reach, and whether a finer grid follows."""

import math
from dataclasses import dataclass, field, replace

from tehl.base.units import percentage
from tehl.base.wording import grid_size
from tehl.contact.options import MOST_NODES_PER_AXIS, Domain, Options, can_be_halved
from tehl.estimate.domain import thinner_error
from tehl.estimate.memory import RESTING_PART, USUAL_MEMORY, memory_limit, needed_memory
from tehl.estimate.nodes import FAMILIES, FAVOURED, most_lines, side_bar
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.spin import LESS_SPIN, spin_error
from tehl.estimate.starvation import supply_error
from tehl.result.bars import ErrorEstimate
from tehl.solver.cost import LEAST_SECONDS, working_time
from tehl.solver.cycle.level import Level
from tehl.solver.judging.measures import (
    is_thinnest_at_side,
    side_reach,
)

FACTOR = 5.0
"""Expected time on a grid over that on the next coarser one, which has a quarter of its nodes."""
MOST_TRIES = 2
"""Finer grids that follow grids on which the cycles do not converge."""
LEAST_HALVINGS = 3
"""Halvings of the smallest grid that is planned."""
NEGLIGIBLE_ITERATION_ERROR = 0.05
"""Iteration error that is accepted, over the error to reach: the error bars contain it."""
SPARE_PART, MOST_SPARE = 0.5, 0.2
"""Part of what the other errors leave of the error to reach, and part of that error, that the
iteration may keep on the finest grid."""
LINES_ORDER = 1.5
"""Order of the minimum film at the sides by the mesh along y (`tehl.estimate.nodes.lines_bar`): of
13 contacts whose lines alone became more the bars fall with orders of 0.8 to 2.2, 1.2 in the
mean."""
LINES_PART = 2.0
"""Bar of the minimum film over that of the central one from which the mesh along y decides."""
LEAST_LEFT = 0.4
"""Part of the error to reach that is left to the mesh along y, below which lines alone are too
many: with 0.55 of it by the supply a drive (M = 34,300) needs 1.7 times as many."""
FLOODED_PART, EXACT_PART, EXACT_LOAD = 0.55, 0.4, 5e3
"""Error that a flooded film to which ``supply.ratio`` is stated may pass on, over that to reach of
the starved one, which has it beside its own: of 49 starved contacts (M = 9 to 20,000) four need
another grid with 0.7 that do not with 0.55. The second from a Moes load M on: an isothermal
flooded film then takes a tenth of the time of the other, and with 0.7 a ring (M = 30,000) just
misses 1 %."""
BETWEEN, MOST_OTHERS = 1.5, 3
"""Most intervals along x of another grid over those of the last, as half the mesh width costs four
times as much; and how many other grids are tried."""
UNREFINED = 2.0
"""Error of the central film over that by the domain, or by the flooded film, up to which no finer
grid follows where these alone exceed the error to reach: the mesh leaves no more than they do."""
PART_OF_FURTHER = 0.25
"""Part of an iteration error that five further cycles leave where films of scarce oil converge by
0.75 per cycle, as hot ones do."""
PART_AT_START = 0.5
"""Part of the error to reach that a steady film may have on a coarser grid from which a transient
run starts: its film becomes thinner where the motion slows down. The minimum of an ellipse whose
entrainment turns round (M = 500) is 0.8 % below that on 321 x 641 nodes at the start and 2.3 % at
the end, on 193 x 385."""
TOO_THIN = "No grid resolves so thin a film: a smaller load, or a larger speed, makes it thicker."
"""Advice where no grid may be finer."""
BETWEEN_MARGIN, SCARCE_MARGIN = 1.05, 1.25
"""Margins of the error bars of another grid, the second one where oil is scarce: there minima at
the sides converge with an order of 1.5 (a ring, M = 30,000)."""


@dataclass(slots=True)
class Goal:
    """The relative error of the film to reach, and the limits of memory and time.

    Parameters
    ----------
    scaled, options : ScaledProblem, Options
        The contact, and the options of the user.
    passed_on : float or None
        Part of its error that a flooded film passes on to the starved one which is stated to it:
        the error is that of the central film alone. None is a film for itself.
    until : float
        When the time is over, on the clock of `working_time` [s].
    tolerance : float
        Largest tolerance of a tight solve that has ended its cycles.
    """

    scaled: ScaledProblem
    options: Options
    passed_on: float | None = None
    until: float = math.inf
    tolerance: float = 0.0
    obstacle: str = ""
    """Why no finer grid follows."""
    advice: str = ""
    """What would help there, beside a larger error."""
    _tries: int = 0
    _others: int = 0
    _most: int = 0
    _started: float = field(default_factory=working_time)
    _last: float = field(default_factory=working_time)

    @property
    def target(self) -> float:
        """The relative error to reach [-]."""
        if self.passed_on is None:
            return self.options.target
        part = EXACT_PART if self.scaled.groups.M > EXACT_LOAD else FLOODED_PART
        return self.options.target * min(part / self.passed_on, 1.0)

    @property
    def of_central(self) -> bool:
        """Whether the error is that of the central film alone."""
        return self.passed_on is not None

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

    @property
    def most_spare(self) -> float:
        """The most that `spare` returns [-]."""
        return MOST_SPARE * self.target if self.is_open else 0.0

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
        return min(SPARE_PART * (self.target - others), self.most_spare)

    def fitting(self, plan: Options) -> Options:
        """Return options of the planned grid, halved until it fits into the memory."""
        available = memory_limit(self.options)
        while self.is_open and can_be_halved(plan, LEAST_HALVINGS):
            if needed_memory(plan, self.scaled.problem) <= available:
                break
            ny, nx = ((n - 1) // 2 + 1 for n in plan.shape)
            plan = plan.on_points(nx, ny)
        return plan

    def begin_cycles(self) -> None:
        """Note the time at which the cycles of a grid begin."""
        self._last = working_time()

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

    def awaits_cycles(self, errors: ErrorEstimate | None, part: float) -> bool:
        """Return whether further cycles reach the error, which the mesh alone does not exceed.

        Parameters
        ----------
        errors, part
            As of `is_met`.
        """
        if errors is None or not self.is_open or self.is_met(errors, part):
            return False
        names = ("iteration_central", "iteration_minimum")
        left = {name: PART_OF_FURTHER * getattr(errors, name) for name in names}
        return self.is_met(replace(errors, **left), part)

    @property
    def is_over(self) -> bool:
        """Whether the time is over, so that no other cycle begins."""
        return working_time() > max(self.until, self._started + LEAST_SECONDS)

    def may_try(self, level: Level) -> bool:
        """Return whether a finer grid may follow one that did not converge."""
        if not self.is_open or self._tries == MOST_TRIES:
            return False
        self._tries += 1
        return self.may_refine(level)

    def more_lines(self, level: Level, errors: ErrorEstimate | None) -> int | None:
        """Return lines with which the minimum film meets the goal; None if others err too.

        If that is more than a grid may have, and half the mesh width is out of reach, the most.

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
        if not self._lines_decide(level, errors):
            return None
        least = (grid.ny - 1) * (BETWEEN_MARGIN * bar / left) ** (1.0 / LINES_ORDER)
        enough = (n for n in FAVOURED if n > least and n > grid.ny)
        finer = min(next(enough, MOST_NODES_PER_AXIS), 2 * grid.ny - 1)
        most = min(most_lines(self.scaled.groups.ellipticity) * grid.nx, MOST_NODES_PER_AXIS)
        if finer <= most:
            return finer
        if self.may_refine(level, errors):
            return None
        return max((n for n in FAVOURED if grid.ny < n <= most), default=None)

    def _lines_decide(self, level: Level, errors: ErrorEstimate) -> bool:
        """Return whether the minimum film errs by the mesh along y alone."""
        bar, grid = errors.discretisation_minimum, level.grid
        scarce = self.scaled.problem.supply is not None
        if side_reach(level, scarce=scarce) >= bar:
            return True
        at_side = scarce or is_thinnest_at_side(level)
        if not at_side or bar < LINES_PART * errors.discretisation_central:
            return False
        known = side_bar(self.scaled, grid.domain, grid.ny)
        return known >= 0.2 * self.target or (scarce and known == 0.0)

    def other_nodes(self, level: Level, errors: ErrorEstimate | None) -> tuple[int, int] | None:
        """Return nodes (nx, ny) of another grid that is expected to reach the error; None if none.

        It has more lines or more columns alone, or a mesh between that of the last grid and half of
        it, and more nodes than those that were named before.

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
        found = (level.grid.nx, lines) if lines else self._more_columns(level, errors)
        found = found or self._between(level, errors)
        if found is None or self._needed(found, level) > self._left(level):
            return None
        nodes = math.prod(found)
        spent = working_time() - self._last
        expected = FACTOR * spent * nodes / (4.0 * math.prod(level.grid.points))
        if nodes <= self._most or working_time() + expected > self.until:
            return None
        self._others, self._most = self._others + 1, nodes
        return found

    def _more_columns(self, level: Level, errors: ErrorEstimate | None) -> tuple[int, int] | None:
        """Return nodes (nx, ny) of a roller with columns half as far apart; None if none help.

        Where half the mesh width is out of reach: its lines are close at its ends already. Of 15
        rough rollers two reach 2 % so (M = 7), where twice the lines do not fit into the memory.
        """
        nx, ny = level.grid.points
        finer = 2 * nx - 1
        if errors is None or not level.grid.is_closed or finer > MOST_NODES_PER_AXIS:
            return None
        if _over_left(errors, self.target) is None or self.may_refine(level, errors):
            return None
        return finer, ny

    def _between(self, level: Level, errors: ErrorEstimate | None) -> tuple[int, int] | None:
        """Return nodes (nx, ny) with a mesh on which bars of second order meet the goal.

        Of steady films and starts, as each step of a run takes the nodes of its start. If they do
        on none, and half the mesh width is out of reach, those with the finest.
        """
        grid, in_time = level.grid, self.scaled.problem.transient is not None
        if errors is None or not (self.options.extrapolate or (in_time and self.may_end_early)):
            return None
        scarce = self.scaled.problem.supply is not None
        # on grids of another family the sides of wide contacts with scarce oil come to rest later
        if self.of_central or (scarce and self.scaled.groups.ellipticity < 1.0):
            return None
        ratio = _over_left(errors, self.target)
        if ratio is None or grid.is_closed or grid.ny == 1:
            return None
        margin = SCARCE_MARGIN if scarce else BETWEEN_MARGIN
        least = (grid.nx - 1) * math.sqrt(margin * ratio)
        between = [n for n in FAMILIES if grid.nx < n <= BETWEEN * (grid.nx - 1) + 1]
        least_lines = [(n - 1) * (grid.ny - 1) / (grid.nx - 1) + 1 for n in between]
        lines = [next((m for m in FAMILIES if m >= one), 0) for one in least_lines]
        grids = [points for points in zip(between, lines, strict=True) if points[1]]
        found = next((points for points in grids if points[0] > least), None)
        if found or self.may_refine(level, errors):
            return found
        fits = [points for points in grids if self._needed(points, level) <= self._left(level)]
        return fits[-1] if fits else None

    def fewer_nodes(self, level: Level, errors: ErrorEstimate | None) -> tuple[int, int] | None:
        """Return the fewest nodes (nx, ny) with which a transient run may start; None if none are.

        Each step moves by a mesh width and is solved on all nodes: half as many per direction cost
        an eighth.

        Parameters
        ----------
        level : Level
            Finest level of the steady film, which meets the goal.
        errors : ErrorEstimate or None
            Of that level.
        """
        if errors is None or not self.may_end_early:
            return None
        ratio, (nx, ny) = _over_left(errors, PART_AT_START * self.target), level.grid.points
        if ratio is None:
            return None
        least, lines = (nx - 1) * math.sqrt(ratio), (ny - 1) / (nx - 1)
        for columns in FAMILIES:
            rows = lines * (columns - 1) + 1.0
            plan = self.options.on_points(columns, round(rows))
            halves = rows.is_integer() and can_be_halved(plan, 1)  # bars compare three grids
            if least < columns < nx and halves:
                return plan.shape[::-1]
        return None

    def _left(self, level: Level) -> float:
        """Return the memory beside what the grid of a level keeps until others end [byte]."""
        return memory_limit(self.options) - RESTING_PART * self._needed(level.grid.points, level)

    def _needed(self, points: tuple[int, int], level: Level) -> float:
        """Return the memory that a grid of nodes (nx, ny) like that of a level needs [byte]."""
        plan, crowds = self.options.on_points(*points), level.grid.crowding > 0.0
        return needed_memory(plan, self.scaled.problem, crowds=crowds)

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
        now, limit = working_time(), self.options.max_time
        expected = FACTOR * (now - self._last)
        needed = self._needed((nx, ny), level)
        available, supply = memory_limit(self.options), supply_error(self.scaled)
        self.obstacle = self.advice = ""
        least = math.inf if errors is None else errors.central / UNREFINED
        if errors is not None and errors.domain > max(self.target, least):
            cause, self.advice = self._beyond(level.grid.domain, errors.domain)
            self.obstacle = f"{percentage(errors.domain)} are due to {cause}"
        elif errors is not None and supply > self.target and errors.central < UNREFINED * supply:
            self.obstacle = (
                f"{percentage(supply)} are due to the flooded film, of which supply.ratio is a part"
            )
            self.advice = "Take a longer numerics.max_time, or state the supply as a layer."
        elif max(nx, ny) > MOST_NODES_PER_AXIS:
            self.obstacle = f"grids have at most {MOST_NODES_PER_AXIS} nodes along one direction"
            self.advice = TOO_THIN
        elif needed > available:
            self.obstacle = (
                f"{grid_size((nx, ny))} need {needed / 1e9:.2g} GB of memory, and "
                f"{_named_limit(self.options, available)}"
            )
            self.advice = "Take a larger numerics.max_memory, or a larger numerics.error."
        elif now + expected > self.until:
            self.obstacle = (
                f"{grid_size((nx, ny))} would take {expected:.3g} s more, and numerics.max_time is "
                f"{limit:g} s"
            )
            self.advice = "Take a longer numerics.max_time, or a larger numerics.error."
        return not self.obstacle

    def _beyond(self, domain: Domain, error: float) -> tuple[str, str]:
        """Return what beyond a domain causes most of an error of the film, and what would help."""
        if spin_error(self.scaled, domain) > 0.5 * error:
            cause = "the pressure that spin makes outside the domain, in the gap of an ellipse"
            advice = LESS_SPIN
        else:
            thins = thinner_error(self.scaled, domain) > 0.5 * error
            happens = "thins in shear" if thins else "warms or cools"
            cause, advice = f"the domain, upstream of which the oil {happens}", ""
        return "numerics.domain" if isinstance(self.options.domain, Domain) else cause, advice


def _over_left(errors: ErrorEstimate, target: float) -> float | None:
    """Return the bar of the mesh over what other errors leave of ``target``; None if they do not.

    The larger one of central and minimum film.
    """
    pairs = [(errors.central, errors.discretisation_central)]
    if errors.minimum_has_limit:
        pairs.append((errors.minimum, errors.discretisation_minimum))
    left = [(bar, target - (whole - bar)) for whole, bar in pairs]
    if min(part for _, part in left) <= 0.0:
        return None
    return max(bar / part for bar, part in left)


def _named_limit(options: Options, limit: float) -> str:
    """Return the limit of the memory in words."""
    if options.max_memory is not None:
        return f"numerics.max_memory is {limit / 1e9:.2g} GB"
    whose = "the usual limit" if limit == USUAL_MEMORY else "half of what is free"
    return f"{whose} is {limit / 1e9:.2g} GB (numerics.max_memory)"
