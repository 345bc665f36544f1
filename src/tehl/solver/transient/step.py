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
from typing import Literal

import numpy as np

from tehl.base.typing import Array
from tehl.contact.moment import Moment
from tehl.contact.transient import Transient
from tehl.operators.reynolds import carried, steady_flux, steady_wedge, step_stencil, upstream
from tehl.solver.cycle.equations import Equations
from tehl.solver.cycle.fas import Cycle, cycle
from tehl.solver.cycle.film_solver import FilmSolver
from tehl.solver.cycle.level import Level
from tehl.solver.cycle.relaxation import Relaxation
from tehl.solver.cycle.start import pose_step
from tehl.solver.cycle.transfers import TRANSFERS
from tehl.solver.judging.convergence import LEAST_KELVIN, RUNAWAY
from tehl.solver.physics.boundary_cycle import TouchingCycle
from tehl.solver.physics.cavity import oil_flow
from tehl.solver.transient.predictor import Predictor

LARGEST_STEP_LOAD_ERROR = 1e-4
"""Load error accepted in a step."""
LARGEST_REST = 0.01
"""Residual accepted in a step where surfaces may touch, over the tolerance: single nodes that begin
to touch change little."""
LARGEST_STEP_KELVIN_CHANGE = 0.01
"""Change of temperature in the last cycle of a step, over the largest rise."""
LEAST_CYCLES = 2
"""Least cycles of a step."""
WEIGHT_OF_POINTS = 12.0
"""Weight of rho H in a step over the conductance from which nodes relax as points. A smooth error
moves the film more than a point does, and grows where the conductance does not outweigh it: at
three times this value, slowly enough to seem converged (M = 20 to 100, L = 1 to 5)."""
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


class StepError(ArithmeticError):
    """No relaxation converged; ``cause`` is "diverged" or "stalled"."""

    def __init__(self, cause: Literal["diverged", "stalled"], change: float) -> None:
        super().__init__(cause)
        self.cause, self.change = cause, change


class Stepper:
    """Advances a film in time from the steady one of ``solver``.

    ``settings`` are the relaxations to try, fastest first.
    """

    def __init__(
        self, solver: FilmSolver, transient: Transient, settings: Sequence[Relaxation]
    ) -> None:
        self.solver, self.transient, self.settings = solver, transient, settings
        level = solver.finest
        self.time_step = transient.stride * level.grid.dx
        self.steady, self.wedge = _steady_oil(level, solver.options.order)
        mirrored = steady_wedge(self.steady[:, ::-1], level.grid.dx, solver.options.order)
        self.against = -mirrored[:, ::-1]  # the wedge where the film moves against x
        self.now, self.before = self.steady.copy(), self.steady.copy()
        self.predictor = Predictor(level.pressure, transient.stride)
        # all levels take the same time step, and so the same weight of rho H
        for one in solver.levels:
            stencil = step_stencil(one.stencil, self.time_step)
            one.equations = replace(one.equations, stencil=stencil)
        self.equations = level.equations  # with load and gap of the start
        solver.coupling.damping = 1.0  # steps are small: heat and thinning need no damping
        solver.coupling.begin_transient(solver.levels, self.time_step)
        self.method: Callable[[], None] = partial(
            cycle, solver.levels, solver.hierarchy.coarsest.step, TRANSFERS, SHAPE
        )
        self.touching: TouchingCycle | None = None
        if level.equations.contact_film is not None:
            self.touching = TouchingCycle(solver.levels, self.method)
            self.method = self.touching.step
        step = (self.time_step, level.grid.dx, transient.stride)
        excess = solver.coupling.excess()
        self.squeeze = Squeeze(self.steady, excess, step, solver.options.order)
        self.setting = 0
        self.choose(0)

    def step(
        self, heights: Array, moment: Moment, passed: tuple[float, float] | None = None
    ) -> StepEnd:
        """Advance by one step.

        Parameters
        ----------
        heights : Array
            Of both surfaces together [-], (ny, nx).
        moment : Moment
            Load, motion and radius at the new time.
        passed : (float, float) or None
            Distances of the mean motion in this step and in the last two [a_x]; None where it
            moves as the contact states.

        Raises
        ------
        StepError
            When no relaxation converges; pressure and film are those of the last attempt.
        """
        level, history = self.solver.finest, self._history(moment, passed)
        start = level.state()
        first, equations = self.setting, self._equations(moment)
        for number in range(first, len(self.settings)):
            self.choose(number)
            if number > first:  # retry: first restore the film from which stresses follow
                level.set_state(*start)
                level.update()
                self.solver.coupling.revert(self.solver.levels)
            elif self.touching is None:
                level.set_pressure(self.predictor.onward())
            pose_step(level, history + self.squeeze.onward(), heights, equations)
            try:
                end = self._solve(self.settings[number].name)
            except ArithmeticError as error:  # also from a kernel, if the film is NaN
                if number < len(self.settings) - 1:
                    continue
                if isinstance(error, StepError):
                    raise
                raise StepError("diverged", np.nan) from error
            self.before, self.now = self.now, self._held(moment)
            self.predictor.note(level.pressure)
            self.squeeze.advance()
            self.solver.coupling.advance(self.solver.levels)
            return end
        raise StepError("stalled", np.inf)

    def _history(self, moment: Moment, passed: tuple[float, float] | None) -> Array:
        """Return the known terms of wedge and squeeze, (ny, nx).

        The mass of the steady film keeps its own wedge, whatever the stride; only the difference to
        it is differentiated along the motion.
        """
        steady, wedge, level = self.steady, self.wedge, self.solver.finest
        steps = (float(self.transient.stride), 2.0 * self.transient.stride)
        if passed is not None:
            spacing = level.grid.dx
            steps = passed[0] / spacing, passed[1] / spacing
            if moment.speed < 0.0 and not level.stencil.conserves:
                wedge = self.against
            wedge = moment.speed * wedge
        limited = passed is not None and level.stencil.conserves > 0
        last = 2.0 * carried(self.now - steady, steps[0], limited=limited)
        before = 0.5 * carried(self.before - steady, steps[1], limited=limited)
        return (last - before + 1.5 * steady) / self.time_step - wedge

    def _equations(self, moment: Moment) -> Equations:
        """Return the equations of the finest level at a moment."""
        return self.equations.at(moment, self.solver.hierarchy.scaled)

    def _held(self, moment: Moment) -> Array:
        """Return the oil at each node; on the edges where it enters that of the steady film.

        Where the film moves against x the supply enters at the other edge.
        """
        level = self.solver.finest
        held = level.cavity.held(level)
        if level.stencil.conserves:
            starved = level.film.partial[:, 0] > 0
            held[starved, 0] = self.steady[starved, 0]
            outlet, last = (-1, -2) if moment.speed > 0.0 else (0, 1)
            held[:, outlet] = np.minimum(held[:, outlet], held[:, last])
            if moment.speed < 0.0:
                full = level.film.rho[:, -1] * level.film.h[:, -1]
                held[:, -1] = np.minimum(full, level.film.layer)
            for edge in level.grid.edge_rows:
                held[edge] = self.steady[edge]
        return held

    def choose(self, number: int) -> None:
        """Set the relaxation, with at least the threshold of dipoles that the time step needs."""
        self.setting, setting = number, self.settings[number]
        for level in self.solver.levels:
            # below this conductance smooth errors grow if nodes relax as points
            least = level.stencil.w0 / WEIGHT_OF_POINTS
            threshold = max(setting.threshold, least)
            level.set_relaxation(replace(setting, threshold=threshold))

    def _solve(self, name: str) -> StepEnd:
        """Perform cycles until the step has converged."""
        level, change = self.solver.finest, np.inf
        times = 1 + self.setting  # slower relaxations get more cycles
        if self.touching is not None:
            self.touching.begin()
        for number in range(1, times * self.transient.max_cycles + 1):
            before = level.pressure.copy()
            self.method()
            level.update()
            warmer, rise = self.solver.coupling.update(self.solver.levels)
            self._follow_density()
            np.subtract(level.pressure, before, out=before)
            change = float(max(before.max(), -before.min()))
            error = level.load_error()
            finite = np.isfinite(change) and np.isfinite(level.film.h).all()
            if not (finite and abs(error) < RUNAWAY):
                raise StepError("diverged", change)
            done = change <= self.transient.tolerance and abs(error) <= LARGEST_STEP_LOAD_ERROR
            done = done and warmer <= max(LARGEST_STEP_KELVIN_CHANGE * rise, LEAST_KELVIN)
            if self.touching is not None:
                done = done and level.evaluate_residual() <= LARGEST_REST * self.transient.tolerance
            if number >= LEAST_CYCLES and done:
                return StepEnd(cycles=number, change=change, load_error=error, smoother=name)
        raise StepError("stalled", change)

    def _follow_density(self) -> None:
        """Update the squeeze for the densities at the last temperatures."""
        level, excess = self.solver.finest, self.solver.coupling.excess()
        history = level.sources.history
        if excess is None or history is None:
            return
        more = self.squeeze.update(excess * level.film.rho * level.film.h)
        history += more
        level.sources.reynolds -= more


def _steady_oil(level: Level, order: int) -> tuple[Array, Array]:
    """Return oil and upstream difference of its flux in a steady film, (ny, nx) each [-]."""
    if not level.stencil.conserves:
        mass = level.film.rho * level.film.h
        if level.equations.contact_film is not None:
            return mass, steady_flux(level.film, mass, level.grid.dx, order)
        return mass, steady_wedge(mass, level.grid.dx, order)
    held, _ = oil_flow(level)
    for edge in level.grid.edge_rows:  # nothing is solved there
        held[edge] = np.minimum(held[edge], level.film.layer[edge])
    return held, steady_flux(level.film, held, level.grid.dx, order)


class Squeeze:
    """Correction of the squeeze of heated films: subtracts dq/dt with q = (rho* - rho_e) H.

    A heated film carries rho* H and stores rho_e H (docs/theory/numerics-thermal.md),

        d(rho* H)/dx + d(rho_e H)/dt = Poiseuille flow,

    but the step differentiates rho* H along the mean motion, which includes d(rho* H)/dt. Where
    layers of the film are stiffer than others it moves at rho*/rho_e of the mean speed.

    The derivative is second-order backward. At a fixed place it is stable if the film is slower
    than the mean motion (q < 0); for a faster one (q > 0) dq/dt is the derivative along the motion
    less the upstream derivative along x.

    Parameters
    ----------
    mass : (ny, nx) array
        rho* H of the steady film [-].
    excess : (ny, nx) array or None
        (rho* - rho_e)/rho*; None if it is always zero.
    step : (float, float, int)
        Time step [a_x / u_m], mesh width along x [a_x], and mesh widths per step.
    wedge_order : int
        Order of the upstream difference along x.
    """

    def __init__(
        self, mass: Array, excess: Array | None, step: tuple[float, float, int], wedge_order: int
    ) -> None:
        (self.time_step, self.spacing, self.stride), self.wedge_order = step, wedge_order
        self.steady = mass[:0] if excess is None else excess * mass
        self.past = np.stack([self.steady, self.steady])
        self.now, self.rate = self.steady, np.zeros_like(self.steady)

    def onward(self) -> Array | float:
        """Return dq/dt at the start of a step, with q extrapolated linearly in time."""
        if not len(self.steady):
            return 0.0
        self.now = 2.0 * self.past[0] - self.past[1]
        self.rate = self._rate(self.now)
        return self.rate

    def update(self, excess: Array) -> Array:
        """Set q of the present film, (ny, nx); return the change of dq/dt."""
        rate = self._rate(excess)
        more = rate - self.rate
        self.now, self.rate = excess, rate
        return more

    def advance(self) -> None:
        """Accept the present q as the previous one of the next step."""
        self.past[1] = self.past[0]
        self.past[0] = self.now

    def _rate(self, now: Array) -> Array:
        """Return dq/dt of the present q."""
        last, before = self.past
        # q < 0: derivative in time at a fixed place
        slow = 1.5 * _part(now, -1) - 2.0 * _part(last, -1) + 0.5 * _part(before, -1)
        # q > 0: along the motion, less the derivative along x
        start = _part(self.steady, 1)  # its wedge is in the steady film
        now, last, before = (_part(q, 1) - start for q in (now, last, before))
        fast = 1.5 * now - 2.0 * upstream(last, self.stride)
        fast += 0.5 * upstream(before, 2 * self.stride)
        along = steady_wedge(now, self.spacing, self.wedge_order)
        return (slow + fast) / self.time_step - along


def _part(excess: Array, sign: int) -> Array:
    """Return the positive or the negative part."""
    return np.maximum(excess, 0.0) if sign > 0 else np.minimum(excess, 0.0)
