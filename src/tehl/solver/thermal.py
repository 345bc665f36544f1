"""Coupling of temperature and shear stress with the film: one energy sweep after each cycle.

What heat and shear thinning do to the flow enters the Reynolds equation as two factors on the
isothermal Newtonian mobility and density. They are kept during a cycle, and injected to the
coarser grids.
"""

from collections.abc import Sequence

import numpy as np

from tehl.kernels import reynolds
from tehl.operators.energy import FilmState, HeatedFilm
from tehl.operators.transfer import midpoints
from tehl.options import Options
from tehl.scaling import ScaledProblem
from tehl.solver.level import Level
from tehl.typing import Array

COUPLED_FROM = 64
"""Intervals of a grid from which the film is heated: on coarser ones it keeps the inlet's."""
SOUND = 5.0
"""Least film, over the floor of the conductance, that is worth heating on a coarser grid."""
FIRST_SWEEPS = 10
"""Energy sweeps on the first heated grid before its first cycle."""
MOST_SWEEPS, RESTLESS = 4, 5.0
"""Most energy sweeps after a cycle, and the change of temperature [K] that asks for another."""
QUIET, CALM = 0.05, 0.0015
"""Largest change of the temperature by a sweep, and change of its largest rise since the last one,
over that rise, below which the next cycle may do without a sweep."""
LEAST_SWEEPS = 2
"""Sweeps on a grid before one may be left out."""
FIRST_STEPS, STEPS = 40, 3
"""Newton steps for the shear stress on the first sweep and later."""
RAMP = 24
"""Sweeps over which sliding is raised from nothing, if it is."""
UNSETTLED = 100.0
"""Change of temperature [K] that a sweep before the end of that counts for."""
CARRIED = ("temperature", "tau_x", "tau_y")
"""Fields of the film that one sweep takes from the last."""
SETTLED = 8.0
"""Change of temperature [K] at which the first sweeps may end."""


class Coupling:
    """Effects on the film other than pressure and elasticity.

    This one has none: it is that of an isothermal Newtonian film. `FilmCoupling` overrides it.

    Attributes
    ----------
    follow : float
        Part of the way, in logarithms, that mobility and density follow per sweep [-].
    state : FilmState or None
        Temperature and shear stress on the finest level; None where there are none.
    """

    follow = 1.0
    state: FilmState | None = None

    def begin(self, levels: Sequence[Level], *, finest: bool, has_film: bool) -> bool:
        """Start on the last of ``levels`` from the coarser ones; return whether there is an effect.

        ``has_film``: the film is that of cycles, not just the start from the Hertz pressure.
        """
        del levels, finest, has_film
        return False

    def update(self, levels: Sequence[Level]) -> tuple[float, float]:
        """Follow the film on the last of ``levels``; return change and rise of temperature [K]."""
        del levels
        return 0.0, 0.0

    def forget(self, levels: Sequence[Level]) -> None:
        """Undo the effect on ``levels``: their film is not a start for the next grid."""

    def begin_transient(self, levels: Sequence[Level], time_step: float) -> None:
        """Start a transient run from the present state, in steps of ``time_step`` [a_x / u_m]."""

    def excess(self) -> Array | None:
        """Return the part of the mass in motion that the film does not hold, (ny, nx); or None."""
        return None

    def advance(self, levels: Sequence[Level]) -> None:
        """Make the present state the past of the next step."""

    def go_back(self, levels: Sequence[Level]) -> None:
        """Restore the state of the last step."""

    def pack(self, levels: Sequence[Level]) -> dict[str, Array]:
        """Return the state as arrays by name, for a checkpoint."""
        del levels
        return {}

    def unpack(self, levels: Sequence[Level], fields: dict[str, Array]) -> None:
        """Restore the state that `pack` returned."""


class FilmCoupling(Coupling):
    """Energy equation and shear law of the film.

    Parameters
    ----------
    scaled : ScaledProblem
        Laws, motion and heat.
    options : Options
        Order of the upstream differences, and how far the answer is iterated.
    slide_in_steps : bool
        Raise the sliding speed from zero over the first sweeps.
    follow : float
        Part of the way that the flow follows each sweep, in logarithms [-]. Between rough surfaces
        the pressure that drives the oil down a flank may make nearly all of its heat and thinning:
        a flow that follows at once makes more of both, and the pressure moves too late.
    """

    def __init__(
        self,
        scaled: ScaledProblem,
        options: Options,
        *,
        slide_in_steps: bool = False,
        follow: float = 1.0,
    ) -> None:
        self.film = HeatedFilm(scaled)
        self.wedge_order = options.wedge_order
        motion = scaled.problem.motion
        counter_moving = min(motion.speed_1, motion.speed_2) <= 0.0
        # elsewhere the backflow of the coarser grids is a good one
        self.thorough = options.accuracy == "tight" or counter_moving
        self.sweeps_left, self.follow = RAMP if slide_in_steps else 0, follow
        self.state: FilmState | None = None
        self.factors: reynolds.Factors | None = None
        self.change, self.rise, self.quiet = 0.0, 0.0, False

    def begin(self, levels: Sequence[Level], *, finest: bool, has_film: bool) -> bool:
        """Heat the last of ``levels`` from the temperature of the one before it.

        A coarser grid that does not resolve the film, or has none to start from, is left as it is;
        return whether it is heated.
        """
        fine, coarser = levels[-1], self.state
        large = min(fine.grid.nx, fine.grid.ny) > COUPLED_FROM
        sound = has_film and float(fine.film.h.min()) > SOUND * fine.equations.floor
        if not (finest or coarser is not None or (large and sound)):
            return False
        self.quiet = False
        state = FilmState(
            fine.grid,
            self.film,
            self.wedge_order,
            finest=finest,
            thorough=self.thorough,
        )
        self.state = state
        if coarser is not None:
            state.refine_from(coarser)
            state.set_film(fine.film.p, fine.film.h, fine.equations.floor)
            if not all(side.marches for side in state.sides):  # a line needs no help to begin
                state.update_surfaces()
            self._hand_down(levels, refined(levels[-2]))
            return True
        for _ in range(FIRST_SWEEPS):
            if self._sweep(state, levels, FIRST_STEPS) < SETTLED:
                break
        return True

    def update(self, levels: Sequence[Level]) -> tuple[float, float]:
        """Sweep; return the largest change and the largest rise of the temperature [K].

        One sweep follows a film that settles; a restless one is swept again, and a quiet one is
        left alone for a cycle, unless the answer is to be tight.
        """
        if self.state is None:
            return 0.0, 0.0
        if self.quiet:
            self.quiet = False
            return self.change, self.rise
        for _ in range(MOST_SWEEPS):
            self.change = self._sweep(self.state, levels, STEPS)
            if self.change < RESTLESS or self.sweeps_left:
                break
        before, self.rise = self.rise, self._rise(self.state)
        calm = abs(self.rise - before) < CALM * self.rise
        settling = self.state.sweeps >= LEAST_SWEEPS and not self.thorough and self.follow == 1.0
        self.quiet = settling and calm and self.change < QUIET * self.rise
        return self.change, self.rise

    def _rise(self, state: FilmState) -> float:
        """Return the largest temperature over that of the oil at the inlet [K]."""
        return float(state.temperature.max()) - self.film.scaled.scales.temperature

    def forget(self, levels: Sequence[Level]) -> None:
        """Start again on the next grid, from an isothermal film."""
        self.state = None
        for level in levels:
            level.uncouple()

    def pack(self, levels: Sequence[Level]) -> dict[str, Array]:
        """Return temperature, stress and fluxes, and the factors that follow from them."""
        state, factors = self.state, levels[-1].factors
        if state is None or factors is None:
            return {}
        known = {f"factor_{name}": getattr(factors, name) for name in factors._fields}
        known |= {f"film_{name}": getattr(state.fields, name) for name in CARRIED}
        known["film_back"] = state.work.back  # how far the march back goes before the next sweep
        return known | (state.time.memory() if state.time is not None else {})

    def unpack(self, levels: Sequence[Level], fields: dict[str, Array]) -> None:
        """Take them back."""
        if self.state is None or not fields:
            return
        for name in CARRIED:
            getattr(self.state.fields, name)[:] = fields[f"film_{name}"]
        self.state.work.back[:] = fields["film_back"]
        if self.state.time is not None:
            self.state.time.recall(fields)
        names = reynolds.Factors._fields
        self._hand_down(levels, reynolds.Factors(*(fields[f"factor_{name}"] for name in names)))
        self.factors = levels[-1].factors

    def begin_transient(self, levels: Sequence[Level], time_step: float) -> None:
        """Let the temperatures change in time, if there are any."""
        self.factors = levels[-1].factors
        if self.state is not None and self.state.model.terms.heat:
            self.state.begin_time(time_step)

    def excess(self) -> Array | None:
        """Return 1 - rho_e/rho*, by the temperatures of the last sweep, (ny, nx).

        Oil that is stiffer on the fast side of the film carries more mass along than the mean speed
        says: the wedge has the density rho* of that flux, but the squeeze the mean density rho_e.
        """
        if self.state is None:
            return None
        held = self.state.view("held") / self.state.view("density")
        return np.ascontiguousarray(1.0 - held.T)

    def advance(self, levels: Sequence[Level]) -> None:
        """Keep temperatures, stresses and factors."""
        self.factors = levels[-1].factors
        if self.state is not None and self.state.time is not None:
            self.state.time.advance()

    def go_back(self, levels: Sequence[Level]) -> None:
        """Take them again."""
        if self.state is not None and self.state.time is not None:
            self.state.time.go_back()
        if self.factors is not None:
            self._hand_down(levels, self.factors)

    def _sweep(self, state: FilmState, levels: Sequence[Level], steps: int) -> float:
        fine = levels[-1]
        self.sweeps_left = max(self.sweeps_left - 1, 0)
        state.slide(1.0 - self.sweeps_left / RAMP)
        state.set_film(fine.film.p, fine.film.h, fine.equations.floor)
        change = state.sweep(steps)
        if self.sweeps_left:
            change = max(change, UNSETTLED)
        self._couple(state, levels)
        return change

    def _couple(self, state: FilmState, levels: Sequence[Level]) -> None:
        """Hand what heat and thinning make of the flow to all of ``levels``."""
        fine, names = levels[-1], reynolds.Heated._fields
        shape = fine.grid.shape
        heated = reynolds.Heated(*(np.ascontiguousarray(state.view(name).T) for name in names))
        heated.mobility[:] /= self.film.scaled.groups.lambda_bar
        factors = reynolds.Factors(*np.empty((5, *shape)))
        isothermal = reynolds.Film(fine.film.p, np.ones(shape), *np.empty((5, *shape)))
        flow = fine.equations.flow
        reynolds.factors_of(heated, isothermal, flow.table, flow.step, factors)
        if fine.factors is not None and self.follow < 1.0:
            factors = between(fine.factors, factors, self.follow)
        self._hand_down(levels, factors)

    @staticmethod
    def _hand_down(levels: Sequence[Level], factors: reynolds.Factors) -> None:
        """Give the last of ``levels`` these factors, and the coarser ones every other of them."""
        fine = levels[-1]
        for level in reversed(levels):
            level.couple(factors)
            factors = reynolds.Factors(*(array[::2, ::2].copy() for array in factors))
        fine.update_properties()
        fine.write_source()


def between(old: reynolds.Factors, new: reynolds.Factors, part: float) -> reynolds.Factors:
    """Return factors some part of the way from old to new ones.

    In logarithms, but for the rest of the mobility, which may vanish.
    """
    rest = old.rest + part * (new.rest - old.rest)
    others = (a * (b / a) ** part for a, b in zip(old[1:], new[1:], strict=True))
    return reynolds.Factors(rest, *others)


def refined(coarse: Level) -> reynolds.Factors:
    """Return the factors of a level between its nodes as well."""
    if coarse.factors is None:
        raise ValueError("a level that is not coupled has no factors")
    return reynolds.Factors(*(midpoints(array) for array in coarse.factors))
