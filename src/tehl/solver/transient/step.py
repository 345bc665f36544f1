"""One time step: wedge and squeeze along the mean motion, solved by multigrid cycles.

Where surfaces may touch through a boundary film, a cycle has the contact too
(`tehl.solver.physics.boundary_cycle`).

With x in a_x and t in a_x / u_m a step advances by dt = s dx, s the stride, and wedge plus squeeze
are one derivative of m = rho H along the mean motion, second-order backward:

    (d/dx + d/dt) m = [3/2 m(x, t) - 2 m(x - s dx, t - dt) + 1/2 m(x - 2 s dx, t - 2 dt)] / dt

(docs/theory/numerics-transient.md; numerics-thermal.md on heated ones).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Literal, NamedTuple

import numpy as np

from tehl.base.typing import Array
from tehl.contact.moment import Moment
from tehl.contact.transient import Transient
from tehl.estimate.schedule import Schedule
from tehl.operators.opening import Opening, approach, squeezed_by
from tehl.operators.reynolds import step_stencil
from tehl.operators.turning import ALONG_X
from tehl.solver.cycle.equations import Equations
from tehl.solver.cycle.fas import Cycle, cycle
from tehl.solver.cycle.film_solver import FilmSolver
from tehl.solver.cycle.relaxation import Relaxation
from tehl.solver.cycle.start import pose_step
from tehl.solver.cycle.transfers import TRANSFERS
from tehl.solver.judging.convergence import LEAST_CYCLES, LEAST_KELVIN, RUNAWAY
from tehl.solver.physics.boundary_cycle import TouchingCycle
from tehl.solver.transient.oil import Lead, Squeeze, oil_of
from tehl.solver.transient.predictor import Predictor

LARGEST_STEP_LOAD_ERROR = 1e-4
"""Load error accepted in a step."""
SETTLED_AFTER, SETTLING_SWEEPS = 10, 8
"""Cycles of a step after which sweeps over the finest grid follow each, and how many: ridges of oil
a node wide, which reversal leaves between cavities, take turns with the coarse grids. With 1 to 4
three circles (M = 4, a supply of 0.5 to 0.8) converge too, but may leave four times the residual of
other steps; with 8 less than a tenth of it. Other steps take fewer cycles."""
LARGEST_REST = 0.01
"""Residual accepted in a step where surfaces may touch, over the tolerance: single nodes that begin
to touch change little."""
LARGEST_STEP_KELVIN_CHANGE = 0.01
"""Change of temperature in the last cycle of a step, over the largest rise."""
ALTERNATING = 0.5
"""Part of the last change of a pressure, from which on the next one takes it back."""
WEIGHT_OF_POINTS = 12.0
"""Weight of rho H in a step over the conductance from which nodes relax as points. A smooth error
moves the film more than a point does, and grows where the conductance does not outweigh it: at
three times this value, slowly enough to seem converged (M = 20 to 100, L = 1 to 5)."""
DAMPED = 0.5
"""Part of the way that mobility and density go per cycle in slower relaxations. A measured map in
a film that thins (M = 79, L = 12, 129 nodes) takes 20 cycles a step with it, and stops without."""
SHAPE = Cycle(kind="V", pre_sweeps=2, post_sweeps=1, extra_sweeps=1)
"""The extra sweep on coarse grids is for long waves: ripples of steps converged to 1e-3 are within
0.2 % of those converged to 1e-5 with it, within 0.9 % without."""


@dataclass(frozen=True, kw_only=True, slots=True)
class StepEnd:
    """End of a converged step: cycles, change of P and load error of the last one, relaxation."""

    cycles: int
    change: float
    load_error: float
    smoother: str


class LastStep(NamedTuple):
    """What a step leaves to the next one beside its film."""

    motion: Array
    """Change of the rigid motions."""
    approaches: Array
    """`tehl.operators.opening.approach` after it, and before it."""


class StepError(ArithmeticError):
    """No relaxation converged; ``cause`` is "diverged" or "stalled"."""

    def __init__(self, cause: Literal["diverged", "stalled"], change: float) -> None:
        super().__init__(cause)
        self.cause, self.change = cause, change


class Stepper:
    """Advances a film in time from the steady one of ``solver``.

    ``settings`` are the relaxations to try, fastest first; ``schedule`` has load and motion.
    """

    def __init__(
        self,
        solver: FilmSolver,
        transient: Transient,
        settings: Sequence[Relaxation],
        schedule: Schedule,
    ) -> None:
        self.solver, self.transient, self.settings = solver, transient, settings
        self.schedule, level = schedule, solver.finest
        varying = schedule.length(level.grid.dx, level.grid.nx)
        solver.coupling.begin_transient(solver.levels, schedule.step, varying)
        touches = level.equations.solids.contact_film is not None
        # where surfaces may touch fluxes are of second order at most
        order = min(solver.options.order, 2) if touches else solver.options.order
        self.oil = oil_of(level, transient.stride, order, schedule)
        self.predictor = Predictor(level.pressure, transient.stride)
        approaches = np.full(2, approach(level.separation, level.equations.gap))
        self.last = LastStep(np.zeros_like(level.rigid), approaches)
        # all levels take the same time step, and so the same weight of rho H
        levels = solver.hierarchy.chain(solver.levels)
        for one in levels:
            stencil = step_stencil(one.equations.stencil, schedule.step)
            one.equations = replace(one.equations, stencil=stencil, entrainment=ALONG_X)
            one.film = one.film._replace(**ALONG_X._asdict())
        self.equations = level.equations  # with load and gap of the start
        solver.hierarchy.coarsest.last = None  # a matrix without the weights of the step
        self.method: Callable[[], None] = partial(
            cycle, levels, solver.hierarchy.coarsest.step, TRANSFERS, SHAPE
        )
        self.touching: TouchingCycle | None = None
        if touches:
            self.touching = TouchingCycle(levels, self.method)
            self.method = self.touching.step
        self.squeeze: Squeeze | Lead
        if varying is not None:
            stretch = solver.hierarchy.scaled.groups.ellipticity
            self.squeeze = Lead(self._lead(), level.grid, order, stretch, self.oil.follows)
        else:
            step = (schedule.step, level.grid, transient.stride)
            excess = solver.coupling.excess()
            self.squeeze = Squeeze(self.oil.steady, excess, step, order)
        self.setting = 0
        self.choose(0)

    def step(self, heights: Array, number: int) -> StepEnd:
        """Advance by one step.

        Parameters
        ----------
        heights : Array
            Of both surfaces together [-], (ny, nx).
        number : int
            Of the step, from one on.

        Raises
        ------
        StepError
            When no relaxation converges; pressure and film are those of the last attempt.
        """
        level, coupling = self.solver.finest, self.solver.coupling
        moment, moved = self.schedule.moments[number], self.schedule.moved(number)
        if moved is not None:
            coupling.begin_step(moment, moved)
        self.solver.hierarchy.coarsest.begin_step()
        history, start = self.oil.brought(number), level.state()
        self._turn_means(moment.speed)
        equations = self._opening(self.equations.at(moment, self.solver.hierarchy.scaled), moment)
        last = len(self.settings) - 1
        # the slowest has a second try, from the film of the last step as it is
        tries = (*range(self.setting, last + 1), *((last,) if self.setting == last else ()))
        for number_of_try, chosen in enumerate(tries):
            if number_of_try:  # first restore the film from which stresses follow
                self.choose(chosen)
                level.set_state(*start)
                level.update()
                coupling.revert(self.solver.levels)
            elif self.touching is None:
                # a pressure without its approach is a film that the first cycle has to move back
                level.move(self.last.motion)
                level.set_pressure(self.predictor.onward())
            pose_step(level, history + self.squeeze.onward(), heights, equations)
            try:
                end = self._solve(self.settings[chosen].name)
            except ArithmeticError as error:  # also from a kernel, if the film is NaN
                if number_of_try < len(tries) - 1:
                    continue
                if isinstance(error, StepError):
                    raise
                raise StepError("diverged", np.nan) from error
            self.oil.accept(moment)
            self.predictor.note(level.pressure)
            now = approach(level.separation, equations.gap)
            approaches = np.array([now, self.last.approaches[0]])
            self.last = LastStep(level.rigid - start[1], approaches)
            self.squeeze.advance()
            coupling.advance(self.solver.levels)
            return end
        raise StepError("stalled", np.inf)

    def _opening(self, equations: Equations, moment: Moment) -> Equations:
        """Return the equations of a moment with what the gap squeezes beyond the edges."""
        level, outside = self.solver.finest, equations.outside
        squeezed, oil = None, outside.far_field
        if oil is not None:
            squeezed = squeezed_by(level.grid, self.solver.hierarchy.scaled, moment)
        if oil is None or squeezed is None:
            return equations
        past = (*self.last.approaches.tolist(), self.schedule.step)
        opening = Opening(oil, squeezed, equations.gap, past)
        return replace(equations, outside=outside._replace(far_field=opening))

    def choose(self, number: int) -> None:
        """Set the relaxation, with at least the threshold of dipoles that the time step needs."""
        self.setting, setting = number, self.settings[number]
        for level in self.solver.hierarchy.chain(self.solver.levels):
            # below this conductance smooth errors grow if nodes relax as points
            least = level.stencil.w0 / WEIGHT_OF_POINTS
            threshold = max(setting.threshold, least)
            level.set_relaxation(replace(setting, threshold=threshold))
        self.solver.coupling.lag.damping = DAMPED if number else 1.0

    def _turn_means(self, speed: float) -> None:
        """Turn the means of the conductance with the film: they differ where it rises on the way.

        Else a film that has turned is not the mirror image of its start, by the error of 2nd order.
        """
        turned = -self.equations.stencil.geometric
        if turned * speed <= 0.0:
            return
        for one in self.solver.hierarchy.chain(self.solver.levels):
            stencil = one.equations.stencil._replace(geometric=turned)
            one.equations = replace(one.equations, stencil=stencil)
        self.equations = replace(self.equations, stencil=self.solver.finest.equations.stencil)

    def _solve(self, name: str) -> StepEnd:
        """Perform cycles until the step has converged.

        Temperatures that have settled are not computed again for a cycle that hardly changes the
        pressure.
        """
        level, change, is_warm = self.solver.finest, np.inf, False
        last = np.zeros_like(level.pressure)
        times = 1 + self.setting  # slower relaxations get more cycles
        if self.touching is not None:
            self.touching.begin()
        for number in range(1, times * self.transient.max_cycles + 1):
            before = level.pressure.copy()
            self._cycle(number)
            np.subtract(level.pressure, before, out=before)
            change = float(max(before.max(), -before.min()))
            if not (is_warm and change <= self.transient.tolerance):
                warmer, rise = self.solver.coupling.update(self.solver.levels)
                is_warm = warmer <= max(LARGEST_STEP_KELVIN_CHANGE * rise, LEAST_KELVIN)
                self._follow_density()
            error = level.load_error()
            finite = np.isfinite(change) and np.isfinite(level.film.h).all()
            if not (finite and abs(error) < RUNAWAY):
                raise StepError("diverged", change)
            done = change <= self.transient.tolerance and abs(error) <= LARGEST_STEP_LOAD_ERROR
            done = done and is_warm
            if self.touching is not None:
                done = done and level.evaluate_residual() <= LARGEST_REST * self.transient.tolerance
            if number >= LEAST_CYCLES and done:
                return StepEnd(cycles=number, change=change, load_error=error, smoother=name)
            if self.touching is None and _alternates(before, last):
                level.set_pressure(level.pressure - 0.5 * before)
                before[:] = 0.0
            last = before
        raise StepError("stalled", change)

    def _cycle(self, number: int) -> None:
        """Perform one cycle of a step, and sweeps after it if there were many."""
        self.method()
        if number > SETTLED_AFTER and self.touching is None:
            self.solver.finest.relax(SETTLING_SWEEPS)
        self.solver.finest.update()

    def _lead(self) -> Array | None:
        """Return the flux that leads that of the mean motion, as `Lead` has it; None without."""
        lead = self.solver.coupling.lead()
        return None if lead is None else lead * self.solver.finest.film.h

    def _follow_density(self) -> None:
        """Update what follows from the densities at the last temperatures."""
        level, coupling = self.solver.finest, self.solver.coupling
        history = level.sources.history
        if coupling.state is None or history is None:
            return
        if isinstance(self.squeeze, Lead):
            now = self._lead()
        else:
            excess = coupling.excess()
            now = None if excess is None else excess * level.film.rho * level.film.h
        if now is None:
            return
        more = self.squeeze.update(now)
        history += more
        level.sources.reynolds -= more


def _alternates(change: Array, last: Array) -> bool:
    """Return whether the largest change of a cycle takes back more than half of the last one.

    The first node of a film may alternate between two values by little more than the tolerance:
    midway it rests.
    """
    place = np.unravel_index(int(np.abs(change).argmax()), change.shape)
    return bool(last[place] * change[place] < -ALTERNATING * change[place] ** 2)
