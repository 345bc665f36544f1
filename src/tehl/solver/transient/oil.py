"""Oil that former films bring to a time step: its mass along the mean motion, and corrections."""

import math

import numpy as np

from tehl.base.typing import Array
from tehl.contact.moment import Moment
from tehl.estimate.grid import Grid
from tehl.estimate.schedule import Schedule
from tehl.operators.carrying import carrier_of, slope_across
from tehl.operators.reynolds import (
    carried,
    of_second_order,
    steady_flux,
    steady_wedge,
    upstream,
)
from tehl.operators.turning import turning_wedge
from tehl.solver.cycle.level import Level
from tehl.solver.physics.cavity import around, oil_flow

FOLLOWING_TIME = 1.0
"""Time in which the mass that keeps its own wedge follows the film [a_x/u_m]: a part of a passage.
Pure motion stays stable, as the fast changes that pass a node are averaged out."""


class Oil:
    """Masses rho H of the last two films, and what they bring to the next.

    Parameters
    ----------
    level : Level
        The finest one, with the steady film and its stencil.
    stride, order : int
        Mesh widths that the motion of the contact passes per step, and order of the steady wedge.
    schedule : Schedule
        Motion and time step.
    """

    def __init__(self, level: Level, stride: int, order: int, schedule: Schedule) -> None:
        self.level, self.stride, self.schedule = level, stride, schedule
        self.order, self.follows = order, 0.0
        self.fastest = max(abs(one.speed) for one in schedule.moments)
        self.steady, self.wedge = _steady_oil(level, order)
        varies = any(one != schedule.moments[0] for one in schedule.moments)
        if varies and not level.stencil.conserves and level.equations.solids.contact_film is None:
            self.follows = min(schedule.step / FOLLOWING_TIME, 1.0)
        self.against = self._wedge_against()
        self.now, self.before = self.steady.copy(), self.steady.copy()

    def _wedge_against(self) -> Array:
        """Return the wedge where the film moves against x."""
        return steady_wedge(self.steady, self.level.grid, self.order, backwards=True)

    def brought(self, number: int) -> Array:
        """Return the known terms of wedge and squeeze in a step, (ny, nx).

        The mass of the steady film, or of one that follows the film where load or motion vary,
        keeps its own wedge, whatever the stride; only the difference to it is differentiated along
        the motion.
        """
        steady, wedge, passed = self.steady, self.wedge, self.schedule.passed(number)
        conserves = self.level.stencil.conserves > 0
        steps = float(self.stride), 2.0 * self.stride
        if passed is not None:
            speed, spacing = self.schedule.moments[number].speed, self.level.grid.dx
            steps = passed[0].along / spacing, passed[1].along / spacing
            wedge = speed * (self.against if speed < 0.0 and not conserves else wedge)
        limited = passed is not None and conserves
        last = 2.0 * carried(self.now - steady, steps[0], limited=limited)
        before = 0.5 * carried(self.before - steady, steps[1], limited=limited)
        return (last - before + 1.5 * steady) / self.schedule.step - wedge

    def accept(self, moment: Moment) -> None:
        """Take the oil of the present film; on the edges where it enters that of the steady one.

        Where the film moves against x the supply enters at the other edge.
        """
        level, film = self.level, self.level.film
        held = level.cavity.held(level)
        if level.stencil.conserves:
            starved = film.partial[:, 0] > 0
            held[starved, 0] = self.steady[starved, 0]
            outlet, last = (-1, -2) if moment.speed > 0.0 else (0, 1)
            held[:, outlet] = np.minimum(held[:, outlet], held[:, last])
            if moment.speed < 0.0:
                held[:, -1] = np.minimum(film.rho[:, -1] * film.h[:, -1], film.layer)
            for edge in level.grid.edge_rows:
                held[edge] = self.steady[edge]
        self.before, self.now = self.now, held
        if self.follows:
            self.follow(self.steady + self.follows * (self._resolved(held) - self.steady))

    def _resolved(self, mass: Array) -> Array:
        """Return a mass without the waves that the fastest step moves by their whole length."""
        nodes = max(math.ceil(self.stride * self.fastest), 1)
        window = np.convolve(np.full(nodes, 1.0 / nodes), np.full(nodes, 1.0 / nodes))
        wider = np.pad(mass, ((0, 0), (nodes - 1, nodes - 1)), mode="edge")
        found = np.zeros_like(mass)
        for shift, weight in enumerate(window):
            found += weight * wider[:, shift : shift + mass.shape[1]]
        return found

    def follow(self, steady: Array) -> None:
        """Take another mass, (ny, nx), as the steady one that keeps its own wedge.

        Both differences of a kink, as at the end of the film, err by other amounts. At the place of
        one that has gone the oil of each step would keep that error, and single nodes of every
        stride one of their own.
        """
        self.steady = steady
        self.wedge = steady_wedge(steady, self.level.grid, self.order)
        self.against = self._wedge_against()


def oil_of(level: Level, stride: int, order: int, schedule: Schedule) -> Oil:
    """Return the oil of a run, before the films of its levels are those of time steps.

    Parameters
    ----------
    level, stride, order, schedule : Level, int, int, Schedule
        As of `Oil`.
    """
    turns = level.equations.entrainment.speed.size > 0
    return (TurningOil if turns else Oil)(level, stride, order, schedule)


class TurningOil(Oil):
    """Oil of a mean motion that spins: each node follows its circle.

    The motion has no divergence, so that the wedge is the derivative along it here too.

    Parameters
    ----------
    level, stride, order, schedule : Level, int, int, Schedule
        As of `Oil`.
    """

    def __init__(self, level: Level, stride: int, order: int, schedule: Schedule) -> None:
        self.carrier = carrier_of(level.grid, level.equations.groups.ellipticity)
        self.ways, self.first = level.equations.entrainment, schedule.moments[0].speed
        self.weights = level.balance if order > 2 else of_second_order(level.balance)
        film = level.film
        kept = {name: getattr(film, name).copy() for name in ("rho", "h", "partial", "second")}
        self.marks = film._replace(**kept)
        super().__init__(level, stride, order, schedule)

    def brought(self, number: int) -> Array:
        """Return the known terms of wedge and squeeze in a step, as of `Oil`."""
        passed, speed = self.schedule.passed(number), self.schedule.moments[number].speed
        assert passed is not None  # no surface that spins moves along x alone
        fronts = around(self.level.film.p == 0.0) if self.level.stencil.conserves else None
        last, before = (
            part * self.carrier.carried(mass - self.steady, way, fronts)
            for part, mass, way in zip((2.0, 0.5), (self.now, self.before), passed, strict=True)
        )
        wedge = self._wedge_at(speed)
        return (last - before + 1.5 * self.steady) / self.schedule.step - wedge

    def follow(self, steady: Array) -> None:
        """Take another mass, (ny, nx), as the steady one that keeps its own wedge."""
        self.steady = steady

    def _wedge_against(self) -> Array:
        return self.wedge  # `_wedge_at` has each direction

    def _wedge_at(self, speed: float) -> Array:
        """Return the steady wedge at an entrainment speed over that of the contact."""
        ways = self.ways._replace(speed=self.ways.speed + (speed - self.first))
        return turning_wedge(self.steady, ways, self.weights, self.marks)


def _steady_oil(level: Level, order: int) -> tuple[Array, Array]:
    """Return oil and upstream difference of its flux in a steady film, (ny, nx) each [-]."""
    if not level.stencil.conserves:
        mass = level.film.rho * level.film.h
        if level.equations.solids.contact_film is not None:
            return mass, steady_flux(level.film, mass, level.grid, order)
        return mass, steady_wedge(mass, level.grid, order)
    held, _ = oil_flow(level)
    for edge in level.grid.edge_rows:  # nothing is solved there
        held[edge] = np.minimum(held[edge], level.film.layer[edge])
    return held, steady_flux(level.film, held, level.grid, order)


class _Rate:
    """Rate of a mass q that the step of the film leaves out, from q of the last steps."""

    steady: Array

    def begin(self, rate: Array) -> None:
        """Begin with the steady q and its rate."""
        self.past = np.stack([self.steady, self.steady])
        self.now, self.rate = self.steady, rate

    def onward(self) -> Array | float:
        """Return the rate at the start of a step, with q extrapolated linearly in time."""
        if not self.steady.size:
            return 0.0
        self.now = 2.0 * self.past[0] - self.past[1]
        self.rate = self._rate(self.now)
        return self.rate

    def update(self, now: Array) -> Array:
        """Set q of the present film, as `steady` has it; return the change of its rate."""
        rate = self._rate(now)
        more = rate - self.rate
        self.now, self.rate = now, rate
        return more

    def advance(self) -> None:
        """Accept the present q as the previous one of the next step."""
        self.past[1] = self.past[0]
        self.past[0] = self.now

    def _rate(self, now: Array) -> Array:
        """Return the rate of the present q."""
        raise NotImplementedError


class Squeeze(_Rate):
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
    step : (float, Grid, int)
        Time step [a_x / u_m], nodes, and mesh widths per step.
    wedge_order : int
        Order of the upstream difference along x: two at most, as that along the motion.
    """

    def __init__(
        self, mass: Array, excess: Array | None, step: tuple[float, Grid, int], wedge_order: int
    ) -> None:
        (self.time_step, self.grid, self.stride), self.wedge_order = step, min(wedge_order, 2)
        self.steady = mass[:0] if excess is None else excess * mass
        self.begin(np.zeros_like(self.steady))

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
        along = steady_wedge(now, self.grid, self.wedge_order)
        return (slow + fast) / self.time_step - along


def _part(excess: Array, sign: int) -> Array:
    """Return the positive or the negative part."""
    return np.maximum(excess, 0.0) if sign > 0 else np.minimum(excess, 0.0)


class Lead(_Rate):
    """The same of films whose motion varies: they carry rho_e H, of the oil that they store.

    The flux by the motion of both surfaces leads that of the mean motion u by q = F H - u rho_e H,
    with F = int rho (u_1 + ...) d zeta: its difference along x is subtracted. It is small where the
    oil is nearly the same across the film, and does not vanish with u where the surfaces slide.

    Parameters
    ----------
    lead : (parts, ny, nx) array or None
        q of the steady film along x, and perhaps along y [-]; None if it is always zero.
    grid, wedge_order : Grid, int
        Nodes, and order of the upstream difference of the steady film.
    stretch : float
        kappa = a_y/a_x.
    follows : float
        Part of the way to the film of each step by which the q that keeps its own difference goes.
    """

    def __init__(
        self,
        lead: Array | None,
        grid: Grid,
        wedge_order: int,
        stretch: float,
        follows: float = 0.0,
    ) -> None:
        self.grid, self.wedge_order, self.stretch, self.follows = (
            grid,
            wedge_order,
            stretch,
            follows,
        )
        self.follow(np.zeros((0, 0, 0)) if lead is None else lead)
        self.begin(-self.own)

    def follow(self, steady: Array) -> None:
        """Take another q, (parts, ny, nx), as the one that keeps its own difference."""
        self.steady = self.own = steady
        if steady.size:
            along, *across = steady
            self.own = steady_wedge(along, self.grid, self.wedge_order) + self._across(across)

    def advance(self) -> None:
        """Accept the present q as the previous one of the next step, and follow it."""
        super().advance()
        if self.follows and self.steady.size:
            self.follow(self.steady + self.follows * (self.now - self.steady))

    def _rate(self, now: Array) -> Array:
        """Return -dq/dx: the steady film keeps its own difference, the change has a central one."""
        along, *across = now - self.steady
        change = np.gradient(along, self.grid.dx, axis=1) + self._across(across)
        return np.asarray(-self.own - change)

    def _across(self, parts: list[Array]) -> Array | float:
        """Return the central difference along y of what there is of q along it."""
        return sum(slope_across(part, self.grid, self.stretch) for part in parts)
