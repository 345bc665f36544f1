"""Solids that carry load beside the oil: asperities finer than the grid, contact on the grid.

A boundary contact lies over another share: where the surfaces touch, the summits below the grid
keep the pressure that they have at the boundary film.
"""

from functools import cached_property
from typing import NamedTuple

import numpy as np

from tehl.base.typing import Array, BoolArray, FlagArray
from tehl.contact.boundary_contact import TOUCHING_MARGIN
from tehl.kernels import summits, transfer
from tehl.kernels.properties import Film
from tehl.operators.deformation import Flattening
from tehl.operators.dry import dry_motions, dry_pressure
from tehl.operators.summits import AsperityTable, change_together
from tehl.operators.transfer import midpoints
from tehl.solver.cycle.equations import Equations
from tehl.solver.judging.film_summary import central_value
from tehl.solver.physics.share import Carried, OilAlone

FILM_PER_PRESSURE = 1.5
"""Film of a smooth change of the pressure in the contact, over that change and over the approach of
the dry contact, which is one in a circle [-]: 4/pi in the middle of a uniform one, and somewhat
more, as too little only takes longer."""
LARGEST_SHARE_FROM_HERTZ = 0.1
"""Share of the load by formula up to which cycles start from the Hertz pressure. Ten contacts of
shares 1e-9 to 0.04 converge from it and not from the dry contact; one of share 1 takes 27 cycles
from the dry contact and 50 from that of Hertz."""
DRY_STEPS, DRY_PART, DRY_ERROR, RIGID_HALVINGS = 100, 0.5, 1e-4, 40
"""Most steps to a dry contact; part of a Newton step of the rigid approach that is taken; and the
missing part of the load and the change of a pressure that end them: it is only a start. Halvings of
the separation of asperities on bodies that do not yield."""

LONGEST_TOGETHER, NEGLIGIBLE_LACKING = 0.3, 1e-12
"""Largest change of asperities that carry alone by their slope, beyond which each node follows its
law: with 0.1 to 1 a line (M = 29) takes the same cycles. And what they may lack without a step,
which is rounding [-]."""
MOST_TOUCH = 0.75
"""Full weighting of the fine nodes that touch from which on a coarse one does: it is inside of a
patch, or on a straight rim. Patches of few nodes would be too stiff: with those at its own place,
films of random surfaces alternate (share 0.5, 257 nodes: 0.9 of each change is left), and with a
half a time step with four nodes that touch stands still at a wrong load."""


class Summits(OilAlone):
    """Asperities finer than the grid: oil and they share the pressure at each node.

    Parameters
    ----------
    equations : Equations
        Of the level.
    table : AsperityTable
        Their laws over the separation.
    """

    is_steep, lowest = True, -np.inf

    def __init__(self, equations: Equations, table: AsperityTable) -> None:
        super().__init__(equations)
        self.table = table
        self.reach = FILM_PER_PRESSURE * max(1.0, self._pressed()[1])
        self.kept = np.zeros(equations.grid.shape)  # what they carried in the injected state

    def extend(self, film: Film) -> Film:
        """Return the film with the fields of `tehl.kernels.summits.touch`."""
        shape = film.p.shape
        q, s, opening, channel = (np.zeros(shape) for _ in range(4))
        film = film._replace(asperity=q, stiffness=s, opening=opening, channel=channel)
        if self.table.is_anisotropic:
            film = film._replace(across=np.ones(shape), eps_y=np.zeros(shape))
        return film._replace(carried=np.ones(shape)) if self.table.slides else film

    def follow(self, level: Carried, reach: float) -> None:
        """Evaluate the laws; the sum of both pressures stays where there is oil."""
        film, separation, frozen = level.film, level.separation, level.smoother.frozen
        if reach < 0.0 or not self.moves_together(level):
            self.follow_at(level, reach, separation, frozen)
            return
        self.follow_at(level, np.inf, separation, frozen)
        alone = (film.p == 0.0) | (frozen > 0)
        lacking = np.zeros_like(separation)
        lacking[alone] = self.table.carried(separation[alone]) - film.asperity[alone]
        if np.abs(lacking).max() > NEGLIGIBLE_LACKING:  # not of NaN
            stiffness = np.where(alone, film.stiffness, 0.0)
            step, moved = change_together(self.equations.deformation, lacking, stiffness)
            if float((stiffness * np.abs(moved)).max()) <= LONGEST_TOGETHER:
                film.asperity[:] += step
                separation[:] += moved
                reach = np.inf
            self.follow_at(level, reach, separation, frozen)

    def moves_together(self, level: Carried) -> bool:
        """Return whether they do, unless a strategy changes each by itself."""
        return self.equations.solids.together and level.smoother.relaxation.together

    def follow_at(self, level: Carried, reach: float, separation: Array, frozen: FlagArray) -> None:
        """Evaluate the laws at a separation; the oil of the ``frozen`` nodes stays as well."""
        flow = self.equations.flow
        summits.touch(level.film, separation, self.table.laws, flow, frozen, reach)
        if level.factors is not None:
            level.update_properties()

    def parts(self, level: Carried) -> dict[str, float]:
        """Return the part of the load on asperities [-]."""
        carried = self.equations.balances.integral(level.film.asperity)
        return {"load_share": carried / level.sources.load}

    def rubbing(self, level: Carried) -> tuple[Array, Array] | None:
        """Return the friction stress of the asperities; the oil between them is sheared too."""
        film = level.film
        return self.table.friction * film.asperity, np.ones(film.p.shape)

    def widening(self, level: Carried) -> Array:
        """Return d eps/dH by the law of the channel."""
        film = level.film
        found: Array = 3.0 * film.eps * self.table.widening(level.separation) / film.channel
        return found * self.growing(level)

    def receive(self, level: Carried) -> None:
        """Evaluate the injected separation, and note what the asperities carry there."""
        self.follow(level, -1.0)
        self.kept = level.film.asperity.copy()

    def changed(self, coarse: Carried) -> Array:
        """Return the pressure with the change of both: it is smooth."""
        return coarse.film.p + coarse.film.asperity - self.kept

    def start(self, level: Carried, expected_film: float) -> None:
        """Start at the separation of the expected film.

        Where asperities carry much there, from the pressure of the dry contact. Soft ones would be
        pressed far into each other in it.
        """
        middle = self.table.separation(expected_film)
        grid, groups = self.equations.grid, self.equations.groups
        level.set_state(self.equations.start_pressure(), dry_motions(grid, groups), 0.0)
        if self.table.pressure(np.asarray(middle)) <= LARGEST_SHARE_FROM_HERTZ:
            level.update()
        else:
            self._press_dry(level)
            rigid = dry_motions(grid, groups, level.rigid_approach)
            level.set_state(level.film.asperity, rigid, 0.0)
        level.move(middle - central_value(grid, level.separation))

    def _pressed(self) -> tuple[Array, float]:
        """Return the Hertz pressure, ``grid.shape``, and the approach under it [-]."""
        equations = self.equations
        pressure = dry_pressure(equations.grid, equations.groups)
        return pressure, self._deflection(pressure)

    def _deflection(self, pressure: Array) -> float:
        """Return the deflection in the middle [-]."""
        deflection = np.empty_like(pressure)
        self.equations.deformation.deflect(pressure, deflection)
        return central_value(self.equations.grid, deflection)

    def _pressed_rigid(self, level: Carried) -> tuple[Array, float]:
        """Return the pressure of asperities on bodies that hardly yield, and the approach [-]."""
        low, high = 0.0, float(self.table.separations[-1])
        for _ in range(RIGID_HALVINGS):
            middle = 0.5 * (low + high)
            pressure = self.table.pressure(level.sources.film + middle)
            carries = self.equations.balances.integral(pressure) > level.sources.load
            low, high = (middle, high) if carries else (low, middle)
        return pressure, self._deflection(pressure) - middle

    def _press_dry(self, level: Carried) -> None:
        """Let dry asperities carry the load.

        From the Hertz pressure on, or, where they are higher than the bodies are pressed in, from
        that of asperities on bodies that hardly yield: pressed in as by Hertz they would carry a
        million times the load. Where oil is cavitated they follow their law; the rigid approach
        follows the load by damped Newton steps, on bodies that yield by `reach`.
        """
        pressure, approach = self._pressed()
        longest = approach + self.table.sigma
        if self.table.sigma > approach:
            pressure, approach = self._pressed_rigid(level)
        rigid = dry_motions(self.equations.grid, self.equations.groups, -approach)
        level.set_state(np.zeros_like(pressure), rigid, pressure)
        level.update()
        solids = level.film.asperity
        for _ in range(DRY_STEPS):
            before, stiffness = solids.copy(), level.film.stiffness
            slope = self.equations.balances.integral(stiffness / (1.0 + self.reach * stiffness))
            change = DRY_PART * level.missing_load() / max(slope, 1e-300)
            level.move(-min(max(change, -longest), longest))
            level.update()
            error = abs(level.load_error())
            if max(error, float(np.abs(solids - before).max())) <= DRY_ERROR:
                return


class Boundary(NamedTuple):
    """What there is where surfaces touch."""

    film: float
    """Boundary film H_c [-]."""
    separation: float
    """Of the mean planes [-]."""
    carried: float = 0.0
    """Pressure of the summits [-]."""


class BoundaryContact(OilAlone):
    """Surfaces that touch where the film is that of the boundary.

    Which nodes touch follows from the sign of P_c - (H - H_c)/K_00 (primal-dual active set:
    Hintermüller, Ito and Kunisch 2002).

    Parameters
    ----------
    equations : Equations
        Of the level.
    least : float
        Boundary film H_c [-].
    beneath : OilAlone
        The share where the surfaces are apart.
    """

    bounds_film, by_flux = True, True
    largest_part = 1.0  # a boundary film may be thicker than any that the oil would form
    answers = True
    """Whether the contact answers to the oil on coarser levels."""

    def __init__(self, equations: Equations, least: float, beneath: OilAlone) -> None:
        super().__init__(equations)
        shape, self.beneath = equations.grid.shape, beneath
        self.boundary = Boundary(film=least, separation=least)
        if isinstance(beneath, Summits):
            separation = beneath.table.separation(least)
            carried = float(beneath.table.pressure(np.asarray(separation)))
            self.boundary = Boundary(least, separation, carried)
        self.is_steep, self.lowest, self.reach = beneath.is_steep, beneath.lowest, beneath.reach
        self.touching, self.lowered = np.zeros(shape, bool), np.zeros(shape, bool)
        self.held, self.injected = np.zeros(shape), np.zeros(shape)
        self.jumped = np.zeros(shape)
        """Change of the pressure since the separation was evaluated: without oil summits that part
        take what their law gives [-]."""

    def extend(self, film: Film) -> Film:
        """Return the film with the pressure of the solids and the orders of the fluxes."""
        film, shape = self.beneath.extend(film), film.p.shape
        if not film.partial.size:
            partial, second = np.zeros(shape, np.uint8), np.zeros(shape, np.uint8)
            film = film._replace(partial=partial, second=second)
        return film if film.asperity.size else film._replace(asperity=np.zeros(shape))

    def lower(self, film: Film) -> None:
        """Lower the orders to second, and to first where surfaces touch."""
        np.minimum(film.second, 1, out=film.second)
        film.second[self.lowered] = 0

    @cached_property
    def lines(self) -> Array:
        """Lines that each stored one stands for, (ny, 1): by them K is symmetric."""
        grid = self.equations.grid
        return np.asarray(grid.widths[:, None] / grid.dy)

    @cached_property
    def flattening(self) -> Flattening:
        """An approximate inverse of the deflection."""
        return Flattening(self.equations.grid, self.equations.groups)

    def receive(self, level: Carried) -> None:
        """Evaluate the injected separation; the contact pressure is in the source of the film."""
        self.stays, self.touching[:], level.film.asperity[:] = True, False, 0.0
        self.follow(level, -1.0)
        self.injected = level.film.asperity.copy()
        if isinstance(self.beneath, Summits):
            self.beneath.kept = self.injected

    def follow(self, level: Carried, reach: float) -> None:
        """Find the nodes that touch, and evaluate the film, there the boundary film."""
        touching = self.touching
        if not level.is_finest:
            self._answer(level)
        self.held[:] = level.separation
        if not self.stays:
            self._find(level)
            np.maximum(level.separation, self.boundary.separation, out=self.held)
        if level.is_finest:
            self.held[touching] = self.boundary.separation
        if not isinstance(self.beneath, Summits):
            level.film.h[:] = self.held
            level.update_properties()
            return
        film = level.film
        np.add(film.p, film.asperity, out=self.jumped)
        before = film.asperity[touching]
        frozen = (level.smoother.frozen.astype(bool) | touching).astype(np.uint8)
        self.beneath.follow_at(level, reach, self.held, frozen)
        film.asperity[touching] = before
        np.subtract(film.p + film.asperity, self.jumped, out=self.jumped)

    def _find(self, level: Carried) -> None:
        inner = self.equations.grid.inner
        gap = (level.separation - self.boundary.separation) / self.equations.influence.self_film
        self.touching[inner] = (level.film.asperity - self.boundary.carried > gap)[inner]

    def follow_response(self, finer: OilAlone, level: Carried) -> None:
        """Take the response, and the nodes most of whose fine ones touch: these stay together."""
        super().follow_response(finer, level)
        self.answers, parts = contact_of(finer).answers, self.held
        if self.answers:
            fine = contact_of(finer).touching.astype(float)
            transfer.restrict_residual(fine, self.equations.stencil.mirror, parts)
            np.greater_equal(parts, MOST_TOUCH, out=self.touching)

    def _answer(self, level: Carried) -> None:
        """Let the contact answer to the oil of a coarser level, by a step of steepest descent.

        It brings the nodes that touch back to the boundary film. The flattening preconditions it,
        so one step for each change of the oil is enough: more of them save no cycles.
        """
        if self.response is None or not self.touching.any():
            return
        missing, pressed = self.boundary.separation - level.separation, self.held
        gap = np.where(self.touching, missing, 0.0)
        if not gap.any():
            return
        self.flattening.deflect(gap, pressed)
        pressed[~self.touching] = 0.0
        moved = np.empty_like(gap)
        self.equations.deformation.deflect(pressed, moved)
        part = (self.lines * gap * pressed).sum() / (self.lines * moved * pressed).sum()
        level.film.asperity[:] += part * pressed
        level.separation[:] += part * moved

    def answer(self, level: Carried) -> Array | float:
        """Return what nodes that touch have taken since the injection; zero on the finest level."""
        if level.is_finest:
            return 0.0
        return np.where(self.touching, level.film.asperity - self.injected, 0.0)

    def take_answer(self, level: Carried, answer: Array | float) -> None:
        """Add what the contact of a coarser level has answered, where the surfaces touch here."""
        if self.response is not None:
            fine = midpoints(np.asarray(answer), self.touching.shape)
            level.film.asperity[self.touching] += fine[self.touching]

    def yielding(self, influence: Array) -> Array:
        """Return K - K_T (K_TT)^-1 K_T', T the nodes that touch: there the film stays."""
        if self.response is None:
            return influence
        touching = self.touching.ravel()
        if self.equations.grid.wraps:  # the last row is the first one again
            touching = touching & (
                np.arange(touching.size) < touching.size - self.equations.grid.nx
            )
        held = np.linalg.solve(influence[np.ix_(touching, touching)], influence[touching])
        return np.ascontiguousarray(influence - influence[:, touching] @ held)

    def gap(self, level: Carried) -> Array:
        """Return the separation, that of the boundary film where the surfaces touch."""
        del level
        return self.held

    def error(self, level: Carried) -> float:
        """Return the mean error of H = H_c where the surfaces touch, as a pressure [-]."""
        errors = np.where(self.touching, np.abs(level.separation - self.boundary.separation), 0.0)
        return float(errors.mean()) / self.equations.influence.self_film

    def opened(self, level: Carried) -> Array:
        """Return the change by which nodes that do not touch lose their contact pressure [-]."""
        lost = level.film.asperity - self.boundary.carried
        if isinstance(self.beneath, Summits):  # apart from the boundary film summits carry less
            lost = np.maximum(lost, 0.0)
        return np.where(self.touching, 0.0, -lost)

    def freeze(self, frozen: FlagArray) -> None:
        """Keep the oil pressure of the nodes that touch."""
        frozen[self.touching] = 1

    def meets(self, level: Carried) -> BoolArray:
        """Return the nodes that count as touching: all whose film exceeds H_c by a margin or less.

        How much of the pressure there is that of the oil depends on how it was trapped
        (docs/theory/contact.md, shares).
        """
        if not (level.film.asperity > self.boundary.carried).any():  # the oil carries all
            return np.zeros(level.film.p.shape, bool)
        return np.asarray(level.film.h <= (1.0 + TOUCHING_MARGIN) * self.boundary.film)

    def parts(self, level: Carried) -> dict[str, float]:
        """Return the parts of the load where the surfaces touch, and on asperities elsewhere."""
        load, (film, meets) = self.equations.balances, (level.film, self.meets(level))
        touching = load.integral(np.where(meets, film.p + film.asperity, 0.0))
        found = {"contact_share": touching / level.sources.load}
        if isinstance(self.beneath, Summits):
            apart = load.integral(np.where(meets, 0.0, film.asperity))
            found["load_share"] = apart / level.sources.load
        return found

    def rubbing(self, level: Carried) -> tuple[Array, Array] | None:
        """Return the friction stress where the surfaces touch, in place of that of the oil."""
        film, meets = level.film, self.meets(level)
        apart = self.beneath.rubbing(level)
        elsewhere = np.zeros(film.p.shape) if apart is None else apart[0]
        rubbed = self.equations.solids.friction * (film.p + film.asperity)
        stress = np.where(meets, rubbed, elsewhere)
        return stress, np.where(meets, 0.0, 1.0)

    def widening(self, level: Carried) -> Array:
        """Return d eps/dH where the surfaces are apart."""
        return self.beneath.widening(level)

    def changed(self, coarse: Carried) -> Array:
        """Return the pressure whose change a finer grid takes, without the answer."""
        found = self.beneath.changed(coarse)
        return found - self.answer(coarse) if isinstance(self.beneath, Summits) else found

    def start(self, level: Carried, expected_film: float) -> None:
        """Start as without contact, or dry where the oil that enters fills no boundary film."""
        grid, layer = self.equations.grid, self.equations.outside.layer
        if layer is None or layer.max() > self.boundary.film:
            self.beneath.start(level, expected_film)
            return
        oil, dry = np.zeros(grid.shape), self.equations.start_pressure()
        level.set_state(oil, 0.0, dry)
        level.update()
        level.move(self.boundary.separation - central_value(grid, level.separation))
        level.set_state(oil, level.rigid_approach, dry)  # far apart, summits have taken its place


def share_of(equations: Equations) -> OilAlone:
    """Return the share of a level by its equations."""
    table, least = equations.solids.asperities, equations.solids.contact_film
    beneath = OilAlone(equations) if table is None else Summits(equations, table)
    return beneath if least is None else BoundaryContact(equations, least, beneath)


def contact_of(share: OilAlone) -> BoundaryContact:
    """Return the share of a level whose surfaces may touch through a boundary film."""
    assert isinstance(share, BoundaryContact)
    return share
