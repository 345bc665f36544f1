"""One time step: wedge and squeeze along the mean motion, cycles until it has converged."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tehl.operators.reynolds import steady_wedge, step_stencil, upstream
from tehl.solver.convergence import LEAST_KELVIN
from tehl.solver.fas import Cycle, cycle
from tehl.solver.film_solver import RUNAWAY, FilmSolver
from tehl.solver.relaxation import Relaxation
from tehl.solver.transient.predictor import Predictor
from tehl.transient import Transient
from tehl.typing import Array

LARGEST_LOAD_ERROR = 1e-4
"""Load error at which a step is balanced."""
HEATED = 0.01
"""Change of temperature in the last cycle of a step, over the largest rise."""
LEAST_CYCLES = 2
WEIGHT_OF_POINTS = 12.0
"""Weight of rho h in a step, over the conductance from which nodes relax as points. Smooth errors
move the film by many times as much as a point does, and grow where the conductance does not
outweigh it: at three times this value, slowly enough to seem settled (M = 20 to 100, L = 1 to 5).
"""
SHAPE = Cycle(kind="V", pre_sweeps=2, post_sweeps=1, extra_sweeps=1)
"""The extra sweep on coarse grids is for the film of long waves: ripples of steps that settle to
1e-3 are within 0.2 % of those settled to 1e-5 with it, within 0.9 % without."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Settled:
    """How a step ended: cycles, change of P and load error of the last one, and the setting."""

    cycles: int
    change: float
    load_error: float
    smoother: str


class StepError(ArithmeticError):
    """No setting made the step settle; ``cause`` says how it ended."""

    def __init__(self, cause: str, change: float) -> None:
        super().__init__(cause)
        self.cause, self.change = cause, change


class Stepper:
    """Moves the film of a hierarchy of levels on in time.

    Parameters
    ----------
    run : FilmSolver
        Solved for the steady film that the run begins with.
    transient : Transient
        Length of the step, and when it has settled.
    settings : sequence of Relaxation
        Settings of the relaxation to try, the fastest first.
    """

    def __init__(
        self, run: FilmSolver, transient: Transient, settings: Sequence[Relaxation]
    ) -> None:
        self.run, self.transient, self.settings = run, transient, settings
        level = run.finest
        self.time_step = transient.stride * level.grid.dx
        self.steady = level.film.rho * level.film.h
        self.wedge = steady_wedge(self.steady, level.grid.dx, run.options.wedge_order)
        self.now, self.before = self.steady.copy(), self.steady.copy()
        self.predictor = Predictor(level.film.p, transient.stride)
        for one in run.levels:
            mesh = step_stencil(one.mesh, self.time_step)
            one.equations = replace(one.equations, mesh=mesh)
        run.coupling.follow = 1.0  # steps are small enough to follow at once
        run.coupling.begin_transient(run.levels, self.time_step)
        step = (self.time_step, level.grid.dx, transient.stride)
        excess = run.coupling.excess()
        self.squeeze = Squeeze(self.steady, excess, step, run.options.wedge_order)
        self.setting = 0
        self.choose(0)

    def step(self, heights: Array, load: float) -> Settled:
        """Go one step on.

        Parameters
        ----------
        heights : (ny, nx) array
            Of both surfaces at the new time [-].
        load : float
            Over that of the contact [-].

        Raises
        ------
        StepError
            When no setting makes it settle; pressure and film are those of the last attempt.
        """
        level, history = self.run.finest, self._history()
        start = level.film.p.copy(), level.rigid_approach
        first = self.setting
        for number in range(first, len(self.settings)):
            self.choose(number)
            if number > first:  # before the step is posed: it takes stresses from this film
                level.set_state(*start)
                level.update()
                self.run.coupling.go_back(self.run.levels)
            else:
                level.set_state(self.predictor.onward(), level.rigid_approach)
            level.pose_step(history + self.squeeze.onward(), heights, load)
            try:
                settled = self._settle(self.settings[number].name)
            except ArithmeticError as error:  # of a kernel too, at a film that is no number
                if number < len(self.settings) - 1:
                    continue
                if isinstance(error, StepError):
                    raise
                raise StepError("diverged", np.nan) from error
            self.before, self.now = self.now, level.film.rho * level.film.h
            self.predictor.note(level.film.p)
            self.squeeze.advance()
            self.run.coupling.advance(self.run.levels)
            return settled
        raise StepError("stalled", np.inf)

    def _history(self) -> Array:
        """Return what is known of wedge and squeeze, (ny, nx).

        The mass of the steady film at the beginning has the wedge of that film, however long the
        step; only what has changed since is followed along the motion.
        """
        stride, steady = self.transient.stride, self.steady
        last = 2.0 * upstream(self.now - steady, stride)
        before = 0.5 * upstream(self.before - steady, 2 * stride)
        return (last - before + 1.5 * steady) / self.time_step - self.wedge

    def choose(self, number: int) -> None:
        """Relax with a setting from now on, its dipoles as far as short steps ask for them."""
        self.setting, setting = number, self.settings[number]
        for level in self.run.levels:
            least = level.mesh.w0 / WEIGHT_OF_POINTS
            threshold = max(setting.threshold, least)
            level.set_relaxation(replace(setting, threshold=threshold))

    def _settle(self, name: str) -> Settled:
        """Cycle until the step has settled."""
        level, change = self.run.finest, np.inf
        # a slower setting is given more of them
        for number in range(1, (1 + self.setting) * self.transient.max_cycles + 1):
            before = level.film.p.copy()
            cycle(self.run.levels, self.run.hierarchy.coarsest.step, SHAPE)
            level.update()
            warmer, rise = self.run.coupling.update(self.run.levels)
            self._follow_density()
            np.subtract(level.film.p, before, out=before)
            change = float(max(before.max(), -before.min()))
            error = level.load_error()
            sound = np.isfinite(change) and np.isfinite(level.film.h).all()
            if not (sound and abs(error) < RUNAWAY):
                raise StepError("diverged", change)
            settled = change <= self.transient.tolerance and abs(error) <= LARGEST_LOAD_ERROR
            settled = settled and warmer <= max(HEATED * rise, LEAST_KELVIN)
            if number >= LEAST_CYCLES and settled:
                return Settled(cycles=number, change=change, load_error=error, smoother=name)
        raise StepError("stalled", change)

    def _follow_density(self) -> None:
        """Let the squeeze follow what the last temperatures make of the density."""
        level, excess = self.run.finest, self.run.coupling.excess()
        history = level.sources.history
        if excess is None or history is None:
            return
        more = self.squeeze.follow(excess * level.film.rho * level.film.h)
        history += more
        level.sources.reynolds -= more


class Squeeze:
    """Takes dq/dt off the derivative of rho* H along the mean motion, q = (rho* - rho_e) H.

    With it the steps solve

        d(rho* H)/dx + d(rho_e H)/dt = Poiseuille flow,

    though wedge and squeeze are discretised together, as one derivative of rho* H. Where layers of
    the film are stiffer than others, what it lets in moves at rho*/rho_e of the mean speed.

    The derivative is backward of order two. In time, at its place, it is stable where the film is
    slower than the mean motion (q < 0): for what overtakes it, dq/dt is the derivative along the
    motion less that along x, upstream.

    Parameters
    ----------
    mass : (ny, nx) array
        rho* H of the steady film [-].
    excess : (ny, nx) array or None
        (rho* - rho_e)/rho*; None where there is none ever.
    step : (float, float, int)
        Step of time [a_x / u_m], mesh width along x [a_x], and mesh widths per step.
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
        """Return the rate to begin a step with: q goes on along a straight line in time."""
        if not len(self.steady):
            return 0.0
        self.now = 2.0 * self.past[0] - self.past[1]
        self.rate = self._rate(self.now)
        return self.rate

    def follow(self, excess: Array) -> Array:
        """Take q of the present film, (ny, nx); return by how much the rate changes."""
        rate = self._rate(excess)
        more = rate - self.rate
        self.now, self.rate = excess, rate
        return more

    def advance(self) -> None:
        """Let the present be the past of the next step."""
        self.past[1] = self.past[0]
        self.past[0] = self.now

    def _rate(self, now: Array) -> Array:
        """Return dq/dt with the present q."""
        last, before = self.past
        slow = 1.5 * _part(now, -1) - 2.0 * _part(last, -1) + 0.5 * _part(before, -1)
        start = _part(self.steady, 1)  # whose wedge is that of the steady film
        now, last, before = (_part(q, 1) - start for q in (now, last, before))
        fast = 1.5 * now - 2.0 * upstream(last, self.stride)
        fast += 0.5 * upstream(before, 2 * self.stride)
        along = steady_wedge(now, self.spacing, self.wedge_order)
        return (slow + fast) / self.time_step - along


def _part(excess: Array, sign: int) -> Array:
    """Return what has a sign of it."""
    return np.maximum(excess, 0.0) if sign > 0 else np.minimum(excess, 0.0)
