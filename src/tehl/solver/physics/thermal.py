"""Coupling of temperature and shear stress with the film: energy sweeps after each cycle.

Heat and shear thinning enter the Reynolds equation as factors on the isothermal Newtonian mobility
and density, which are constant during a cycle and injected to the coarser grids
(docs/theory/numerics-thermal.md on the coupling with the film).
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from tehl.base.typing import Array
from tehl.contact.moment import Moment
from tehl.contact.options import Options
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.ways import Way
from tehl.kernels import properties
from tehl.operators.energy import FilmState
from tehl.operators.heated_film import HeatedFilm
from tehl.operators.transfer import injected, midpoints
from tehl.solver.cycle.level import Level
from tehl.solver.physics.lag import LARGEST_BOUNDED_STEP, LARGEST_LOG_STEP, Lag

COUPLED_FROM, BOUNDED_FROM = 64, 40
"""Intervals of the coarsest grid that is heated, the smaller number where a boundary film bounds
the film; coarser ones keep the inlet temperature."""
RESOLVED_FILM_OVER_FLOOR = 5.0
"""Least film on a heated coarser grid, over the floor of the conductance."""
FIRST_SWEEPS = 10
"""Energy sweeps on the first heated grid before its first cycle."""
MOST_SWEEPS, LARGE_CHANGE = 4, 5.0
"""Most energy sweeps after a cycle, and change of temperature [K] after which another follows."""
SMALL_KELVIN_CHANGE, SMALL_RISE_CHANGE = 0.05, 0.0015
"""Largest change of temperature in a sweep, and change of the largest rise since the last sweep,
both over that rise, below which the sweep of the next cycle is skipped."""
LEAST_SWEEPS = 2
"""Sweeps on a grid before one may be skipped."""
FIRST_STRESS_STEPS, STRESS_STEPS = 40, 12
"""Most Newton steps for the shear stress in the first sweeps and later: with 3 a heated traction
drive (M = 51, L = 22.6) fails, and with 12 it takes 6 s."""
RAMP = 24
"""Sweeps over which the sliding speed is raised from zero in `Strategy.slide_in_steps`."""
UNFINISHED = 100.0
"""Change of temperature [K] reported for a sweep below the full sliding speed."""
CARRIED = ("temperature", "tau_x", "tau_y")
"""Fields of the film that a sweep starts from."""
HERTZ_CYCLES, ISOTHERMAL_CYCLES = 2, 4
"""Isothermal cycles that come first: on a grid that started from the Hertz pressure, until it has a
film, and before damped heat."""
MOST_DOUBLINGS = 4
"""Most doublings of the cycles on a coarser grid, one for each grid between it and the finest."""
COARSE_PATIENCE = 2
"""Factor on the cycles in which the residual of a coarser heated grid has to halve."""
FIRST_CHANGE = 8.0
"""Change of temperature [K] at which the first sweeps end."""

Chain = Callable[[Sequence[Level]], Sequence[Level]]


class Coupling:
    """Effects of heat and shear thinning on the film; none if it is isothermal and Newtonian.

    Parameters
    ----------
    scaled, options : ScaledProblem, Options
        The contact; order of the upstream differences, and accuracy.
    slide_in_steps : bool
        Raise the sliding speed from zero over the first sweeps.
    damping : float
        Damping factor of the logarithms of mobility and density per sweep, 1 is undamped [-]. On
        rough flanks the pressure gradient may cause nearly all heat and thinning; undamped, the
        flow increases both before the pressure can fall, and the iteration diverges.
    chain : callable
        Returns the levels of a cycle on the last of some levels.
    """

    def __init__(
        self,
        scaled: ScaledProblem,
        options: Options,
        *,
        slide_in_steps: bool = False,
        damping: float = 1.0,
        chain: Chain = list,
    ) -> None:
        self.chain = chain
        self.scaled, is_coupled = scaled, scaled.problem.is_coupled
        self.film = HeatedFilm(scaled) if is_coupled else None
        self.wedge_order = options.order
        counter_moving = min(scaled.moment.speeds) <= 0.0
        # elsewhere the backflow of the coarser grids is accurate enough
        flows_back = counter_moving or scaled.problem.has_hot_inlet or scaled.groups.shape.as_line
        self.thorough = options.accuracy == "tight" or flows_back
        self.sweeps_left = RAMP if slide_in_steps else 0
        self.lag = Lag(damping if is_coupled else 1.0, heats=scaled.problem.thermal is not None)
        self.state: FilmState | None = None  # on the last level that was started
        self.factors: properties.Factors | None = None
        self.last = 0.0, 0.0  # change and rise of the last sweep [K]
        self.rest = ""  # "now" if no sweep followed the last cycle, "due" if none follows the next
        # where motion varies: the density is that of the oil, not of its flux
        self.carries_mean = False

    def begin(
        self, levels: Sequence[Level], *, finest: bool, full: bool, early: bool = False
    ) -> bool:
        """Heat the last of ``levels``; return whether it is heated or thinned.

        It starts from the temperatures of the next coarser grid, if there are any. A coarser grid
        that does not resolve the film stays isothermal.

        Parameters
        ----------
        levels : sequence of Level
            Coarsest first.
        finest, full : bool
            Whether the last one is the level of the result, and whether it has the full sources: so
            do those whose temperatures are compared.
        early : bool
            Whether a grid with enough nodes along x may be the first.
        """
        if self.film is None:
            return False
        fine, coarser = levels[-1], self.state
        large = self.heats_from(fine.grid, early=early)
        least = RESOLVED_FILM_OVER_FLOOR * fine.equations.floor
        resolved = fine.share.bounds_film or float(fine.film.h.min()) > least
        if not (finest or coarser is not None or (large and resolved)):
            return False
        self.rest = ""
        self.lag.begin()
        state = FilmState(
            fine.grid, self.film, self.wedge_order, finest=full, thorough=self.thorough
        )
        state.is_first_grid = not finest
        self.state = state
        if coarser is not None:
            state.refine_from(coarser)
            _set_film(state, fine)
            # line sources march with the sweep
            if not all(side.marches for side in self.film.sides):
                state.update_surfaces()
            assert levels[-2].factors is not None  # that grid is heated
            shape = fine.grid.shape
            factors = properties.Factors(*(_refined(one, shape) for one in levels[-2].factors))
            self._set_factors(levels, factors)
            return True
        # the first heated grid starts from the inlet temperature everywhere
        for _ in range(FIRST_SWEEPS):
            if self._sweep(state, levels, FIRST_STRESS_STEPS) < FIRST_CHANGE or self.damping < 1.0:
                break
        return True

    @property
    def damping(self) -> float:
        """Damping factor per sweep, 1 is undamped [-]."""
        return self.lag.damping

    @property
    def is_pending(self) -> bool:
        """Whether heat or thinning are still to begin."""
        return self.film is not None and self.state is None

    @property
    def is_damped(self) -> bool:
        """Whether changes of heat or thinning are damped, and have begun."""
        return self.state is not None and self.damping < 1.0

    @property
    def patience(self) -> float:
        """Factor on the cycles in which the residual of a coarser grid has to halve."""
        return math.inf if self.state is None else COARSE_PATIENCE

    def cycles_before(self, *, from_hertz: bool) -> int:
        """Return the isothermal cycles on a grid before heat or thinning begin.

        A film that is not in balance would flow and heat far too much.

        Parameters
        ----------
        from_hertz : bool
            Whether the grid started from the Hertz pressure.
        """
        if not self.is_pending:
            return 0
        return ISOTHERMAL_CYCLES if self.damping < 1.0 else HERTZ_CYCLES * from_hertz

    def doublings(self, finer: int) -> int:
        """Return how many times the cycles on a coarser grid are doubled; ``finer`` grids follow.

        Smooth parts of the temperature may converge slowly: on coarse grids that costs little.
        """
        if self.state is None:
            return 0
        return MOST_DOUBLINGS if self.is_damped else min(finer, MOST_DOUBLINGS)

    def update(self, levels: Sequence[Level]) -> tuple[float, float]:
        """Sweep; return the largest change, and the largest rise or fall of the temperature [K].

        One sweep per cycle; more while the temperature changes by more than `LARGE_CHANGE`. When it
        hardly changes, the sweep of the next cycle is skipped, unless the accuracy is tight.
        """
        if self.state is None:
            return 0.0, 0.0
        if self.rest == "due":
            self.rest = "now"
            return self.last
        for _ in range(MOST_SWEEPS):
            change = self._sweep(self.state, levels, STRESS_STEPS)
            if change < LARGE_CHANGE or self.sweeps_left or self.damping < 1.0:
                break
        (_, before), inlet = self.last, self.scaled.scales.temperature
        hottest, coldest = self.state.temperature.max(), self.state.temperature.min()
        rise = max(float(hottest) - inlet, float(coldest) - inlet, key=abs)
        steady = abs(rise - before) < SMALL_RISE_CHANGE * abs(rise)
        may_skip = self.state.sweeps >= LEAST_SWEEPS and not self.thorough and self.damping == 1.0
        rests = may_skip and steady and change < SMALL_KELVIN_CHANGE * abs(rise)
        self.rest = "due" if rests else ""
        self.last = change, rise
        return self.last

    def temperature_rise(self) -> float:
        """Return the largest temperature rise over the inlet [K]."""
        if self.state is None:
            return 0.0
        return float(self.state.temperature.max()) - self.scaled.scales.temperature

    def heats_from(self, grid: Grid, *, early: bool) -> bool:
        """Return whether a coarser grid has the nodes from which a film is heated.

        Parameters
        ----------
        grid : Grid
            Nodes along x and y.
        early : bool
            Whether a grid with enough nodes along x may be the first.
        """
        nodes = (grid.nx,) if early else grid.points
        is_bounded = self.scaled.problem.contact_film is not None
        least = BOUNDED_FROM if is_bounded else COUPLED_FROM
        return self.film is not None and min(n for n in nodes if n > 1) > least

    def kept(self, levels: Sequence[Level]) -> tuple[FilmState, properties.Factors] | None:
        """Return temperatures and factors of the last of ``levels``; None if it is isothermal."""
        factors = levels[-1].factors
        return None if self.state is None or factors is None else (self.state, factors)

    def take(
        self, levels: Sequence[Level], known: tuple[FilmState, properties.Factors] | None
    ) -> None:
        """Take what `kept` returned on the same levels of another solve.

        Parameters
        ----------
        levels : sequence of Level
            Coarsest first.
        known : (FilmState, Factors) or None
            None leaves them isothermal.
        """
        if known is not None:
            self.state = known[0]
            self._set_factors(levels, known[1])

    def reset(self, levels: Sequence[Level]) -> None:
        """Make ``levels`` isothermal again: their film is not a start for the next grid."""
        if self.film is None:
            return
        self.state = None
        for level in (*levels, *self.chain(levels)):
            level.sources.drift = None
            level.couple(None)

    def pack(self, levels: Sequence[Level]) -> dict[str, Array]:
        """Return temperature, stress, fluxes and factors as arrays by name, for a checkpoint."""
        state, factors = self.state, levels[-1].factors
        if state is None or factors is None:
            return {}
        known = {f"factor_{name}": getattr(factors, name) for name in factors._fields}
        known |= {f"film_{name}": getattr(state.fields, name) for name in CARRIED}
        known["film_back"] = state.work.back  # extent of the next march against the flow
        return known | (state.last.pack() if state.last is not None else {})

    def unpack(self, levels: Sequence[Level], fields: dict[str, Array]) -> None:
        """Restore the state that `pack` returned.

        Parameters
        ----------
        levels : sequence of Level
            The coarsest first; their factors are restored too.
        fields : dict
            Arrays by name; an empty one leaves the state as it is.
        """
        if self.state is None or not fields:
            return
        for name in CARRIED:
            getattr(self.state.fields, name)[:] = fields[f"film_{name}"]
        self.state.work.back[:] = fields["film_back"]
        if self.state.last is not None:
            self.state.last.unpack(fields)
        names = properties.Factors._fields
        self._set_factors(levels, properties.Factors(*(fields[f"factor_{name}"] for name in names)))
        self.factors = levels[-1].factors

    def begin_transient(
        self, levels: Sequence[Level], time_step: float, varying: tuple[int, int] | None = None
    ) -> None:
        """Make the energy equation transient.

        Parameters
        ----------
        levels : sequence of Level
            The coarsest first, with the factors of the steady film.
        time_step : float
            Step [a_x / u_m].
        varying : (int, int) or None
            Where the surfaces change their speeds: steps of the run, and nodes beyond either edge
            to which surfaces go that come back.
        """
        self.lag.damping = 1.0  # steps are small: heat and thinning need no damping
        if self.state is not None and varying is not None:
            self.carries_mean = self.thorough = self.state.thorough = True
            self._couple(self.state, levels)
        self.factors = levels[-1].factors
        if self.state is not None:
            self.state.begin_transient(time_step, varying)

    def begin_step(self, moment: Moment, ways: Sequence[Way]) -> None:
        """Set the motion of a step.

        Parameters
        ----------
        moment : Moment
            Its speeds.
        ways : (Way, Way)
            Of both surfaces in it.
        """
        if self.film is None or self.state is None:
            return
        self.lag.begin()
        self.scaled = self.film.scaled = replace(self.scaled, moment=moment)
        if self.state.transient is not None:
            self.state.transient.move(ways)

    def lead(self) -> Array | None:
        """Return `FilmState.lead` of the last sweep; None where the oil is the same across."""
        return None if self.state is None else self.state.lead()

    def excess(self) -> Array | None:
        """Return 1 - rho_e/rho* at the temperatures of the last sweep, (ny, nx); None if zero.

        Oil that is stiffer on the fast side of the film carries more mass than the mean speed: the
        wedge has the density rho* of that flux, the squeeze the mean density rho_e
        (docs/theory/numerics-thermal.md on transient runs).
        """
        if self.state is None:
            return None
        part = self.state.view("mean_density") / self.state.view("density")
        return np.ascontiguousarray(1.0 - part.T)

    def advance(self, levels: Sequence[Level]) -> None:
        """Accept temperatures, stresses and factors as those of the last time step."""
        self.factors = levels[-1].factors
        if self.state is not None and self.state.last is not None:
            self.state.last.advance()

    def revert(self, levels: Sequence[Level]) -> None:
        """Restore those of the last time step."""
        self.lag.begin()
        if self.state is not None and self.state.last is not None:
            self.state.last.go_back()
        if self.factors is not None:
            self._set_factors(levels, self.factors)

    def _sweep(self, state: FilmState, levels: Sequence[Level], steps: int) -> float:
        """Sweep the energy equation and update the flow; return the change of temperature [K]."""
        fine = levels[-1]
        self.sweeps_left = max(self.sweeps_left - 1, 0)
        state.slide(1.0 - self.sweeps_left / RAMP)
        _set_film(state, fine)
        self.lag.drive(state)
        change = state.sweep(steps)
        if self.sweeps_left:
            change = max(change, UNFINISHED)
        self._couple(state, levels)
        return change

    def _couple(self, state: FilmState, levels: Sequence[Level]) -> None:
        """Compute the factors of heat and thinning and set them on all of ``levels``."""
        fine, shape, names = levels[-1], levels[-1].grid.shape, properties.Heated._fields
        heated = properties.Heated(*(np.ascontiguousarray(state.view(name).T) for name in names))
        if self.carries_mean:
            heated.density[:] = state.view("mean_density").T
        elif state.model.terms.plain:  # the wedge has the speed of the moment
            heated.density[:] /= self.scaled.moment.speed
        heated.mobility[:] /= self.scaled.groups.lambda_bar
        fine.cavity.limit(fine, heated)  # first: the lag was noted with these exponents
        self.lag.complete(heated)
        factors = properties.Factors(*np.empty((7, *shape)))
        # at H = 1 the conductance is the mobility
        isothermal = properties.Film(fine.film.p, np.ones(shape), *np.empty((5, *shape)))
        thickness = fine.film.conducting(fine.equations.floor)
        properties.factors_of(heated, isothermal, fine.equations.flow, thickness, factors)
        before = fine.factors
        if before is None and self.damping < 1.0:
            before = factors._replace(rest=np.zeros(shape), mobility=np.ones(shape))
            ones = np.ones(shape)
            before = before._replace(density=ones, stretch_x=ones, stretch_y=ones)
        fine.sources.drift = None if self.carries_mean else state.drift(fine.cavity.full(fine))
        if before is not None:
            bounded = fine.share.bounds_film
            largest = LARGEST_BOUNDED_STEP if bounded else LARGEST_LOG_STEP
            factors = self.lag.damped(before, factors, isothermal.eps, largest)
        self._set_factors(levels, factors)

    def _set_factors(self, levels: Sequence[Level], factors: properties.Factors) -> None:
        """Set the factors of the last of ``levels``, and inject them to the coarser ones."""
        fine = levels[-1]
        fine.cavity.limit(fine, factors)
        for level in reversed(self.chain(levels)):
            # injected to the coarser ones
            here = (injected(array, level.film.p) for array in factors)
            if level is not fine:
                factors = properties.Factors(*(array.copy() for array in here))
            level.couple(factors)
        fine.update_properties()
        fine.write_source()


def _refined(factor: Array, shape: tuple[int, ...]) -> Array:
    """Return a factor on a grid of half the mesh width, by logarithms if it is positive.

    On a steep front it changes by orders of magnitude from node to node.
    """
    if factor.min() > 0.0:
        return np.asarray(np.exp(midpoints(np.log(factor), shape)))
    return midpoints(factor, shape)


def _set_film(state: FilmState, level: Level) -> None:
    """Set pressure and film of a level, and the heat of its asperities."""
    film, floor, conducted = level.film, level.equations.floor, None
    if film.channel.size:
        along = (film.channel / np.maximum(film.h, floor)) ** 3
        conducted = along, along * film.across if film.across.size else along
    state.set_film(np.maximum(film.p, 0.0), film.h, floor, conducted)
    rubbing = level.share.rubbing(level)
    if rubbing is not None:
        state.rub(*rubbing)
