"""The ladder of strategies: which method is tried first, and its fallbacks.

A strategy is a relaxation with the settings of everything around it. Smooth isothermal films need
the first rung only, up to M = 1000 and more; later rungs trade speed for robustness.
"""

import math
from dataclasses import dataclass, field, replace

from tehl.contact.options import Options
from tehl.contact.problem import ContactProblem
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.settled import crowds_at_ends, raises_order
from tehl.estimate.summits import shared_load
from tehl.estimate.third_order import LEAST_SLENDER
from tehl.solver.cycle.continuation import Continuation
from tehl.solver.cycle.equations import move_together
from tehl.solver.cycle.relaxation import (
    APART,
    BESIDE_NEWTON,
    BROAD,
    CAREFUL,
    DAMPED,
    FAST,
    FRONTS,
    GAUSS_SEIDEL,
    LIMITED,
    ROBUST,
    ROUGH,
    STEEP,
    STEEPER,
    THIN,
    Relaxation,
)


@dataclass(frozen=True, kw_only=True, slots=True)
class Strategy:
    """How a contact is solved."""

    relaxation: Relaxation
    continuation: Continuation = field(default_factory=Continuation)
    memory: int = 0
    """Earlier cycles combined by Anderson acceleration; 0 is none."""
    patience: int = 1
    """Factor on the largest number of cycles."""
    damping: float = 1.0
    """Damping factor of the logarithms of mobility and density of a rough film, per sweep of the
    energy equation; 1 is undamped [-]."""
    newton: bool = False
    """Use Newton's method instead of cycles on the grids that have the heights."""
    wedge_order: int | None = None
    """Order of the wedge on this rung, if it is another than that of the options."""
    gives_up: bool = False
    """End it on the finest grid as soon as its cycles recede, as another strategy follows."""
    slide_in_steps: bool = False
    """Raise the sliding speed from zero over the first sweeps of the energy equation."""
    answers: bool = True
    """Whether contact through a boundary film answers to the oil on coarser grids too."""
    crowds: bool = True
    """Whether the lines of a roller crowd at its ends, if the grid of the plan has them so."""
    early: bool = False
    """Begin heat and thinning on a grid with half as many lines: there a front is wide. The finest
    grid is tried though the cycles of the coarser one come to no rest: of six rollers with L = 20
    to 36 on which all others fail five converge so."""

    @property
    def name(self) -> str:
        """Name of the relaxation."""
        return self.relaxation.name

    @property
    def first_relaxation(self) -> Relaxation:
        """Relaxation of the coarse grids on which the film is isothermal and conducts less."""
        return FAST if self.relaxation is BROAD else self.relaxation

    @property
    def description(self) -> str:
        """The strategy in words."""
        if self.newton:
            return "Newton's method (slow)"
        steps = ", with continuation in the sliding speed" if self.slide_in_steps else ""
        order = "" if self.wedge_order is None else ", with a wedge of second order"
        damped = "damped " if self.damping < 1.0 else ""
        apart = "" if self.relaxation.together else ", asperities one by one"
        lines = "" if self.crowds else ", on uniform lines"
        return f"the {damped}{self.name} smoother{steps}{order}{apart}{lines}"


SMOOTH = (
    Strategy(relaxation=FAST),
    Strategy(relaxation=STEEP),
    Strategy(relaxation=ROBUST),
    Strategy(relaxation=STEEPER),
)
BETWEEN_ASPERITIES = (
    Strategy(relaxation=FAST),
    Strategy(relaxation=STEEP),
    # on coarse grids a small correction of the film moves much load to the asperities
    Strategy(relaxation=LIMITED),
    # asperities that carry half the load behind a steep spike: the cycles alone oscillate
    Strategy(relaxation=ROBUST, memory=5, patience=2),
    Strategy(relaxation=DAMPED, patience=3),
)
COUPLED = (
    Strategy(relaxation=BROAD, gives_up=True),
    Strategy(relaxation=STEEP, damping=0.5, patience=3),
    # heavily loaded and starved or heated: on fine grids the rim of the film is wide and steep
    Strategy(relaxation=STEEPER, damping=0.3, patience=4),
    Strategy(relaxation=ROBUST, patience=3),
    Strategy(relaxation=ROBUST, damping=0.3, patience=3),
    Strategy(relaxation=ROBUST, slide_in_steps=True),
)
BETWEEN_ROUGH = (
    Strategy(relaxation=ROUGH, memory=5),
    Strategy(
        relaxation=CAREFUL,
        continuation=Continuation(correction=0.5, limit=0.3, ramp=8),
        memory=8,
        patience=2,
        damping=0.3,
    ),
    Strategy(
        relaxation=DAMPED,
        continuation=Continuation(correction=0.15, limit=0.15, ramp=48, points=12.0),
        memory=10,
        patience=3,
        damping=0.3,
    ),
    Strategy(relaxation=BESIDE_NEWTON, continuation=Continuation(points=5.0), newton=True),
)
EACH_ALONE = Strategy(relaxation=APART)
"""Tried next between asperities that change together, but of lines. Where they do, films at sharp
ends flip (two rollers, M = 56 and 65); where they do not, others stall (M = 8, L = 8.7)."""
HELD_APART, HELD_LOAD = Strategy(relaxation=FAST), 0.5
"""Tried first between rough surfaces where asperities below the mesh carry more than that part of
the load, by formulas: they hold the surfaces apart, so the film between heights is smooth. Cycles
that are combined pass load from oil to asperities and back (an ellipse with M = 214 and 99 %
of the load on asperities: 4 % of it is missing after all strategies of rough surfaces, and none
after 3 cycles of this one); three other contacts have the same film in half to all of the time."""
TOUCHING = (
    # Anderson acceleration combines states that touch at other nodes: it takes more cycles
    Strategy(
        relaxation=CAREFUL,
        continuation=Continuation(correction=0.7, limit=0.3, ramp=8),
        patience=3,
    ),
    # of 60 contacts with random other physics 3 of the 7 on which the first one failed; where hot
    # oil moves the rim of a patch, contact that follows at once overshoots
    Strategy(
        relaxation=CAREFUL,
        continuation=Continuation(correction=0.4, limit=0.2, ramp=16),
        patience=4,
        damping=0.3,
        answers=False,
    ),
    Strategy(
        relaxation=BESIDE_NEWTON,
        continuation=Continuation(points=5.0),
        newton=True,
        patience=2,
    ),
)
UNCOMBINED = Strategy(relaxation=BROAD, damping=0.5, patience=3, early=True)
"""Tried with a wedge of third order after the combined cycles, which overshoot at the steep fronts
(L = 20 to 30) of films that are heated or thin."""
AT_EDGES = replace(UNCOMBINED, relaxation=FRONTS)
"""The same where little oil carries a heavy load, and large steps at the edge of its film diverge:
two of five bearings and rigs (M = 9,000 to 43,000) that fail with the broad smoother converge."""
THIRD_ORDER_STRATEGIES = 2
"""Strategies that are tried with a wedge of third order before one of second order."""
COMBINED_CYCLES = 3
"""Earlier cycles combined where nodes change by small steps, or heat and thinning by a part: 9
replace 12 on the finest grid of an isothermal bearing with M = 27,400, and 15 contacts with M =
9,000 to 80,000 take 0.7 of the CPU time. Between asperities it takes more cycles; with a wedge of
second order, the last resort, steep spikes (L = 29) diverge."""
COMBINED_LOAD = 1e3
"""Moes load M of an isothermal contact from which they are: the first changes of a thick film (M =
1) on coarse grids lead away from it."""
STEEP_SPEED = 13.0
"""Moes speed L above which `UNCOMBINED` comes before the combined cycles. Nine contacts of machines
whose first strategy fails take 0.75 of the CPU time by this and by going on from solved grids, and
30 with asperities and heat 0.76."""
STEEPEST_SPEED = 20.0
"""Moes speed L above which films that are heated have a wedge of second order after two strategies:
eight contacts (L = 21 to 41) take 0.64 of the work, and one of them (L = 33) fails without. Those
that only thin have it after a damped one of third order: 55 of them (L = 20 to 47) take 0.46 of the
work, and one more converges (a starved inner ring, M = 1,470); 34 heated ones take 1.1 by it."""
UNDAMPED = Strategy(relaxation=STEEP, gives_up=True)
"""Tried soon where the oil is scarce: at the edge of the film damped heat and thinning follow it
too slowly. It takes 0.8 of the CPU time of 39 contacts of machines. Of nine with L > `STEEP_SPEED`
whose first strategy fails all converge by it; before `UNCOMBINED` it takes 0.7 of the time."""
UNDAMPED_FIRST = replace(UNDAMPED, memory=COMBINED_CYCLES)
"""Tried first on heavy slender films, flooded and without asperities, up to `STEEP_SPEED`: damping
costs coarse grids up to half of their cycles. Behind a steeper spike (an inner ring, L = 13.6) they
oscillate without, between asperities (M = 43,000) they stall. Of wide films the grids agree less
well: a rig (M = 20,000) just misses 1 %."""
THINNEST = Strategy(relaxation=THIN, damping=0.5, patience=3, memory=COMBINED_CYCLES)
"""For films so thin that on coarse grids any other strategy makes them negative."""
STARVED_DAMPING = 0.3
"""Damping of the second strategy where the oil is scarce: with 0.5, which saves a fifth of the time
of 30 flooded contacts, the edge of the film of an inner ring (M = 2,500) does not rest."""
HEAVY = ((7e3, 0.0), (4e3, 600.0), (2e3, 1250.0))
"""Moes loads M, each with the M over kappa and the root of L that is exceeded too, from which the
first strategy is left out: it converged in two of 38 such bearings, gears and rigs, but in 106 of
150 others with M > 80."""
THIN_LOAD, THIN_RATIO = 7e4, 3000.0
"""Moes load M and that ratio from which `THINNEST` comes first: it converges for seven of eight
flooded bearings with M = 85,000 to 257,000, and no other strategy for any of four of them."""
THIN_LATER = (4e4, 2000.0)
"""The same from which it follows the usual strategies: before them it takes up to three times as
long, but of 46 bearing contacts three converge by no other."""
CROWDED = 2
"""Strategies at the least on lines that crowd at the ends of a roller before uniform ones, which
converge but miss the smallest film: of 120 rollers (seeds 7 and 8 of `benchmarks.rollers`) 92
converge by the first, two by the second, and of eight others one by a later one on crowded lines,
and all on uniform ones."""
STATED = {one.name: Strategy(relaxation=one) for one in (FAST, BROAD, ROBUST, GAUSS_SEIDEL)}


def ladder(scaled: ScaledProblem, options: Options, *, rough: bool) -> tuple[Strategy, ...]:
    """Return the strategies to try, fastest first.

    Parameters
    ----------
    scaled : ScaledProblem
        Supply, heat, contact, shape and load decide the strategies.
    options : Options
        A stated ``smoother`` is the only rung.
    rough : bool
        Whether the surfaces have heights.
    """
    problem = scaled.problem
    if problem.contact_film is not None:
        # Newton's method linearises neither partly filled cavities nor asperities below the grid
        by_cycles = problem.conserves_oil or problem.asperities is not None
        rungs = TOUCHING[:-1] if by_cycles else TOUCHING
        found = _of_third_order_first(problem, options, TOUCHING[:-1], rungs)
        return _crowded_first(problem, found, CROWDED)
    if options.smoother != "auto":
        return (STATED[options.smoother],)
    if rough:
        return _between_rough(scaled, options)
    is_second = options.order < 3 and not raises_order(problem, options)
    (first, *others), then = _rungs(problem), _second(scaled)
    found = (first, *then, *others)
    if not (is_second or options.wedge_order is not None):
        return _with_third_order(scaled, found)
    return _crowded_first(problem, found, max(1 + len(then), CROWDED))


def _crowded_first(
    problem: ContactProblem, rungs: tuple[Strategy, ...], number: int
) -> tuple[Strategy, ...]:
    """Return ``rungs`` on uniform lines behind a number of them on those that may crowd."""
    if not crowds_at_ends(problem):
        return rungs
    return (*rungs[:number], *(replace(one, crowds=False) for one in rungs))


def _second(scaled: ScaledProblem) -> tuple[Strategy, ...]:
    """Return what is tried after the first strategy between asperities, and at steep ends."""
    problem, kind = scaled.problem, scaled.problem.contact
    if kind.is_line:
        return ()
    alone = move_together(scaled) and (kind.has_lines or not problem.is_coupled)
    steep = kind.has_lines and problem.is_coupled and scaled.groups.L > STEEP_SPEED
    return (EACH_ALONE,) * alone + (UNCOMBINED,) * steep


def _between_rough(scaled: ScaledProblem, options: Options) -> tuple[Strategy, ...]:
    """Return the strategies for rough surfaces, those with a wedge of third order first."""
    problem = scaled.problem
    # with heat, Newton steps converge no better than cycles, at ten times the cost
    cycles = tuple(one for one in BETWEEN_ROUGH if not one.newton)
    # and their Jacobian lacks partly filled cavities
    rungs = cycles if problem.is_coupled or problem.conserves_oil else BETWEEN_ROUGH
    found = _of_third_order_first(problem, options, cycles[:THIRD_ORDER_STRATEGIES], rungs)
    is_held = problem.asperities is not None and shared_load(scaled).share > HELD_LOAD
    return _crowded_first(problem, (HELD_APART, *found) if is_held else found, CROWDED)


def _of_third_order_first(
    problem: ContactProblem,
    options: Options,
    cycles: tuple[Strategy, ...],
    rungs: tuple[Strategy, ...],
) -> tuple[Strategy, ...]:
    """Return ``rungs``, of second order behind ``cycles`` of third where the order is raised.

    Between high waves cycles with third order do not converge, nor do Newton steps.
    """
    if not raises_order(problem, options):
        return rungs
    return (*cycles, *(replace(one, wedge_order=2) for one in rungs))


def _with_third_order(scaled: ScaledProblem, rungs: tuple[Strategy, ...]) -> tuple[Strategy, ...]:
    """Return strategies with a wedge of third order, then ``rungs`` with one of second order."""
    problem = scaled.problem
    heavy = problem.is_coupled and _is_heavy(scaled)
    rungs = rungs[1:] if heavy else rungs
    first = (UNDAMPED_FIRST,) if heavy and _needs_no_damping(scaled) else ()
    thin = (THINNEST,) if _exceeds(scaled, THIN_LOAD, THIN_RATIO) else ()
    later = (THINNEST,) if not thin and _exceeds(scaled, *THIN_LATER) else ()
    steep = (AT_EDGES if heavy and problem.supply else UNCOMBINED,) if problem.is_coupled else ()
    scarce = (UNDAMPED,) if problem.is_coupled and problem.supply and not heavy else ()
    # behind steep pressure spikes some contacts converge with second order only
    second = (replace(one, wedge_order=2) for one in rungs)
    quick, *others = rungs[:THIRD_ORDER_STRATEGIES]
    if problem.asperities is not None:
        others, later = [*others, rungs[THIRD_ORDER_STRATEGIES]], ()
    elif problem.is_coupled or scaled.groups.M > COMBINED_LOAD:
        quick, *others = map(_combined, (quick, *others))
    if scaled.groups.L > STEEP_SPEED:
        third = (quick, *scarce, *steep, *later, *others)
        if problem.is_coupled and scaled.groups.L > STEEPEST_SPEED:
            more = 1 + len(scarce) if problem.thermal is None else 0
            third = third[: THIRD_ORDER_STRATEGIES + more]
    else:
        third = (quick, *scarce, *others, *steep, *later)
    return (*thin, *first, *third, *second)


def _needs_no_damping(scaled: ScaledProblem) -> bool:
    """Return whether a heavy film is expected to converge by `UNDAMPED_FIRST`."""
    groups, problem = scaled.groups, scaled.problem
    is_slender = not groups.skew and groups.ellipticity >= LEAST_SLENDER
    is_alone = problem.supply is None and problem.asperities is None
    return is_slender and is_alone and groups.L <= STEEP_SPEED


def _combined(strategy: Strategy) -> Strategy:
    """Return a strategy that combines its cycles if nodes change by small steps."""
    return replace(strategy, memory=COMBINED_CYCLES) if strategy.relaxation.stiff else strategy


def _is_heavy(scaled: ScaledProblem) -> bool:
    """Return whether the film is too thin for the first strategy, which coarse grids try first."""
    return any(_exceeds(scaled, load, ratio) for load, ratio in HEAVY)


def _exceeds(scaled: ScaledProblem, load: float, ratio: float) -> bool:
    """Return whether M exceeds ``load``, and M over kappa and the root of L ``ratio``."""
    groups = scaled.groups
    slender = max(groups.ellipticity, 1.0) * math.sqrt(max(groups.L, 0.1))
    return groups.M > max(load, ratio * slender)


def _rungs(problem: ContactProblem) -> tuple[Strategy, ...]:
    """Return the strategies for smooth surfaces."""
    if not problem.is_coupled:
        return SMOOTH if problem.asperities is None else BETWEEN_ASPERITIES
    coupled = COUPLED if problem.motion.slides else COUPLED[:-1]
    if problem.supply is not None:
        starved = replace(coupled[1], damping=STARVED_DAMPING)
        coupled = (coupled[0], starved, *coupled[2:])
    if problem.asperities is None:
        return coupled
    limited = replace(coupled[1], relaxation=LIMITED)
    return (
        *coupled[:THIRD_ORDER_STRATEGIES],
        limited,
        *coupled[THIRD_ORDER_STRATEGIES:],
        BETWEEN_ASPERITIES[-1],
    )
