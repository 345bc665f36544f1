"""What carries load beside the oil: asperities finer than the grid, contact on it, or no solid.

A level has one share, absence included. It says which film follows from the separation of the mean
planes, what the solids carry there, and what coarser grids and the coarsest solver need of it. A
boundary contact lies over another share: where the surfaces touch, the summits below the grid keep
the pressure that they have at the boundary film.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from tehl.base.typing import Array, BoolArray, FlagArray
from tehl.contact.boundary_contact import TOUCHING_MARGIN
from tehl.kernels import summits
from tehl.kernels.properties import Factors, Film
from tehl.operators.dry import dry_pressure
from tehl.operators.summits import AsperityTable
from tehl.operators.transfer import injected
from tehl.solver.cycle.equations import Equations, Sources
from tehl.solver.cycle.relaxation import Smoother
from tehl.solver.judging.film_summary import central_value

FILM_PER_PRESSURE = 1.5
"""Film of a smooth change of the pressure in the contact, over that change and over the approach of
the dry contact, which is one in a circle [-]: 4/pi in the middle of a uniform one, and somewhat
more, as too little only takes longer."""
LARGEST_SHARE_FROM_HERTZ = 0.1
"""Share of the load by formula up to which cycles start from the Hertz pressure. Ten contacts of
shares 1e-9 to 0.04 converge from it and not from the dry contact; one of share 1 takes 27 cycles
from the dry contact and 50 from that of Hertz."""
DRY_STEPS, DRY_PART, DRY_ERROR = 100, 0.5, 1e-4
"""Most steps to a dry contact; change of the rigid approach over the missing part of the load; and
that part and the change of a pressure that end them: it is only a start."""


class Carried(Protocol):
    """What a share needs of its level (`tehl.solver.cycle.level.Level`)."""

    film: Film
    separation: Array
    rigid_approach: float
    is_finest: bool
    sources: Sources
    factors: Factors | None
    smoother: Smoother

    def update(self) -> None:
        """Evaluate the film."""

    def update_properties(self) -> None:
        """Evaluate conductance and density."""

    def set_state(self, pressure: Array, rigid_approach: float, asperity: Array | float) -> None:
        """Set the unknowns."""

    def move(self, change: float) -> None:
        """Change the rigid approach."""

    def load_error(self) -> float:
        """Return the relative error of the load."""


class OilAlone:
    """No solid carries load: the film is the separation of the surfaces.

    Parameters
    ----------
    equations : Equations
        Of the level.
    """

    bounds_film = False
    """Whether the film has a least value by its physics, not as a numerical floor."""
    by_flux = False
    """Whether the orders of the wedge are chosen for each flux."""
    is_steep = False
    """Whether a small change of the film moves much load: corrections are limited."""
    lowest = 0.0
    """Pressure of the oil down to which a correction may take a film that stays wet [-]."""
    combines = False
    """Whether earlier cycles are combined with the last one between smooth surfaces too."""
    largest_part = np.inf
    """Most that the smallest film may be over that of the oil alone, as a part of its error [-]."""
    stays = False
    """Whether the nodes that touch stay as they are: coarser grids of a cycle correct others."""
    reach = 0.0
    """Film of a smooth change of the pressure in the contact, over that change [-]."""

    def __init__(self, equations: Equations) -> None:
        self.equations = equations
        self.response: Response | None = None

    def extend(self, film: Film) -> Film:
        """Return the fields of a film with those that the share needs."""
        return film

    def follow(self, level: Carried, reach: float) -> None:
        """Evaluate film, solids, conductance and density at the present separation.

        Parameters
        ----------
        level : Level
            Its fields are written.
        reach : float
            As for `tehl.kernels.summits.touch`.
        """
        del reach
        level.update_properties()

    def gap(self, level: Carried) -> Array:
        """Return the separation that coarser grids take, ``grid.shape`` [-]."""
        return level.separation

    def error(self, level: Carried) -> float:
        """Return the mean error of the equation of the solids, as a pressure [-]."""
        del level
        return 0.0

    def lower(self, film: Film) -> None:
        """Lower the orders with which nodes pass on oil where solids demand it."""

    def freeze(self, frozen: FlagArray) -> None:
        """Keep the oil pressure at nodes that solids hold."""

    def receive(self, level: Carried) -> None:
        """Evaluate the injected separation: this level corrects a finer one, which decides."""
        self.follow(level, -1.0)

    def raised(self, approach: float) -> Array | float:
        """Return what the rigid approach adds to the film [-]."""
        found = self.response
        return approach if found is None else found.raised(approach)

    def answered(self, level: Carried) -> float:
        """Return by how much more load is missing as the contact yields to oil and approach [-]."""
        found = self.response
        if found is None:
            return 0.0
        pressed = (1.0 - found.lift) * (level.film.p - found.pressure)
        risen = found.stiffness * (level.rigid_approach - found.approach)
        return self.equations.load.integral(pressed) + risen

    def follow_response(self, finer: "OilAlone", level: Carried) -> None:
        """Take the response of a finer level, from the present state on."""
        found = finer.response
        self.response = found and found.injected(level.rigid_approach, level.film.p)

    def meets(self, level: Carried) -> BoolArray:
        """Return the nodes whose load the contact of the surfaces carries, ``grid.shape``."""
        return np.zeros(level.film.p.shape, bool)

    def parts(self, level: Carried) -> dict[str, float]:
        """Return the parts of the load that solids carry, by the names of their quantities [-]."""
        del level
        return {}

    def rubbing(self, level: Carried) -> tuple[Array, Array] | None:
        """Return the friction stress of the solids, and 1 where the oil is sheared, else 0 [-]."""
        del level
        return None

    def widening(self, level: Carried) -> Array:
        """Return d eps/dH by the separation H, ``grid.shape`` [-]."""
        film, floor = level.film, self.equations.floor
        # eps grows as H^3 above the floor and is constant below it
        found: Array = np.where(film.h > floor, 3.0 * film.eps / np.maximum(film.h, floor), 0.0)
        return found

    def changed(self, coarse: Carried) -> Array:
        """Return the pressure whose change a finer grid takes [-]."""
        return coarse.film.p

    def start(self, level: Carried, expected_film: float) -> None:
        """Start from the Hertz pressure, with the rigid approach of the expected central film."""
        level.set_state(dry_pressure(self.equations.grid, self.equations.groups), 0.0, 0.0)
        level.update()
        level.move(expected_film - central_value(self.equations.grid, level.separation))


class Summits(OilAlone):
    """Asperities finer than the grid: oil and they share the pressure at each node.

    Parameters
    ----------
    equations : Equations
        Of the level.
    table : AsperityTable
        Their laws over the separation.
    """

    is_steep, combines, lowest = True, True, -np.inf

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
        """Evaluate the laws; the sum of both pressures stays."""
        self.follow_at(level, reach, level.separation, level.smoother.frozen)

    def follow_at(self, level: Carried, reach: float, separation: Array, frozen: FlagArray) -> None:
        """Evaluate the laws at a separation; the oil of the ``frozen`` nodes stays as well."""
        flow = self.equations.flow
        summits.touch(level.film, separation, self.table.laws, flow, frozen, reach)
        if level.factors is not None:
            level.update_properties()

    def parts(self, level: Carried) -> dict[str, float]:
        """Return the part of the load on asperities [-]."""
        carried = self.equations.load.integral(level.film.asperity)
        return {"load_share": carried / level.sources.load}

    def rubbing(self, level: Carried) -> tuple[Array, Array] | None:
        """Return the friction stress of the asperities; the oil between them is sheared too."""
        film = level.film
        return self.table.friction * film.asperity, np.ones(film.p.shape)

    def widening(self, level: Carried) -> Array:
        """Return d eps/dH by the law of the channel."""
        film = level.film
        found: Array = 3.0 * film.eps * self.table.widening(level.separation) / film.channel
        return found

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
        level.set_state(dry_pressure(self.equations.grid, self.equations.groups), 0.0, 0.0)
        if self.table.pressure(middle) <= LARGEST_SHARE_FROM_HERTZ:
            level.update()
        else:
            self._press_dry(level)
            level.set_state(level.film.asperity, level.rigid_approach, 0.0)
        level.move(middle - central_value(self.equations.grid, level.separation))

    def _pressed(self) -> tuple[Array, float]:
        """Return the Hertz pressure, ``grid.shape``, and the approach under it [-]."""
        equations = self.equations
        pressure = dry_pressure(equations.grid, equations.groups)
        deflection = np.empty_like(pressure)
        equations.deformation.deflect(pressure, deflection)
        return pressure, central_value(equations.grid, deflection)

    def _press_dry(self, level: Carried) -> None:
        """Let dry asperities carry the load, from the Hertz pressure on.

        Where oil is cavitated they follow their law; the rigid approach follows the load, which
        grows as its power 3/2 (Hertz).
        """
        pressure, approach = self._pressed()
        level.set_state(np.zeros_like(pressure), -approach, pressure)
        missing, solids = -level.load_error(), level.film.asperity
        for _ in range(DRY_STEPS):
            before = solids.copy()
            level.move(-DRY_PART * min(max(missing, -1.0), 1.0))
            level.update()
            missing = -level.load_error()
            if max(abs(missing), float(np.abs(solids - before).max())) <= DRY_ERROR:
                return


@dataclass(frozen=True, slots=True)
class Response:
    """How a contact that stays closed responds to the rigid approach c, by its change.

    The contact pressure changes by -c phi with K phi = 1 where the surfaces touch, so that they
    stay together; the film elsewhere by c (1 - K phi), and the load of the contact by -c S. Without
    it oil and contact would both make up for a missing load, and cycles diverge where the contact
    is the stiffer of both.
    """

    lift: Array
    """1 - K phi, ``grid.shape`` [-]."""
    stiffness: float
    """S, integral of phi [-]."""
    approach: float
    """Rigid approach from which c counts [-]."""
    pressure: Array
    """Oil pressure of that state, ``grid.shape`` [-]."""

    def raised(self, approach: float) -> Array:
        """Return what a rigid approach adds to the film, ``grid.shape`` [-]."""
        return self.approach + self.lift * (approach - self.approach)

    def injected(self, approach: float, pressure: Array) -> "Response":
        """Return the response on the next coarser grid, from its present state."""
        lift = injected(self.lift, pressure).copy()
        return Response(lift, self.stiffness, approach, pressure.copy())


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

    def __init__(self, equations: Equations, least: float, beneath: OilAlone) -> None:
        super().__init__(equations)
        shape, self.beneath, self.least = equations.grid.shape, beneath, least
        self.nearest, self.carried = least, 0.0  # separation and pressure of summits at H_c
        if isinstance(beneath, Summits):
            self.nearest = beneath.table.separation(least)
            self.carried = beneath.table.pressure(self.nearest)
        self.is_steep, self.lowest = beneath.is_steep, beneath.lowest
        self.combines, self.reach = beneath.combines, beneath.reach
        self.touching, self.lowered = np.zeros(shape, bool), np.zeros(shape, bool)
        self.held = np.zeros(shape)

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

    def receive(self, level: Carried) -> None:
        """Evaluate the injected separation; the contact pressure is in the source of the film."""
        self.stays, level.film.asperity[:] = True, 0.0
        self.follow(level, -1.0)
        if isinstance(self.beneath, Summits):
            self.beneath.kept = level.film.asperity.copy()

    def follow(self, level: Carried, reach: float) -> None:
        """Find the nodes that touch, and evaluate the film, there the boundary film."""
        self.held[:] = level.separation
        if not self.stays:
            self._find(level)
            np.maximum(level.separation, self.nearest, out=self.held)
        touching = self.touching if level.is_finest else np.zeros_like(self.touching)
        self.held[touching] = self.nearest
        if not isinstance(self.beneath, Summits):
            level.film.h[:] = self.held
            level.update_properties()
            return
        film = level.film
        before = film.asperity[touching]
        frozen = (level.smoother.frozen.astype(bool) | touching).astype(np.uint8)
        self.beneath.follow_at(level, reach, self.held, frozen)
        film.asperity[touching] = before

    def _find(self, level: Carried) -> None:
        inner = self.equations.grid.inner
        gap = (level.separation - self.nearest) / self.equations.influence.self_film
        self.touching[inner] = (level.film.asperity - self.carried > gap)[inner]

    def gap(self, level: Carried) -> Array:
        """Return the separation, that of the boundary film where the surfaces touch."""
        del level
        return self.held

    def error(self, level: Carried) -> float:
        """Return the mean error of H = H_c where the surfaces touch, as a pressure [-]."""
        errors = np.where(self.touching, np.abs(level.separation - self.nearest), 0.0)
        return float(errors.mean()) / self.equations.influence.self_film

    def opened(self, level: Carried) -> Array:
        """Return the change by which nodes that do not touch lose their contact pressure [-]."""
        lost = level.film.asperity - self.carried
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
        if not (level.film.asperity > self.carried).any():  # the oil carries all
            return np.zeros(level.film.p.shape, bool)
        return np.asarray(level.film.h <= (1.0 + TOUCHING_MARGIN) * self.least)

    def parts(self, level: Carried) -> dict[str, float]:
        """Return the parts of the load where the surfaces touch, and on asperities elsewhere."""
        load, (film, meets) = self.equations.load, (level.film, self.meets(level))
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
        stress = np.where(meets, self.equations.friction * (film.p + film.asperity), elsewhere)
        return stress, np.where(meets, 0.0, 1.0)

    def widening(self, level: Carried) -> Array:
        """Return d eps/dH where the surfaces are apart."""
        return self.beneath.widening(level)

    def changed(self, coarse: Carried) -> Array:
        """Return the pressure whose change a finer grid takes."""
        return self.beneath.changed(coarse)

    def start(self, level: Carried, expected_film: float) -> None:
        """Start as without contact, or dry where the oil that enters fills no boundary film."""
        grid, layer = self.equations.grid, self.equations.layer
        if layer is None or layer.max() > self.least:
            self.beneath.start(level, expected_film)
            return
        level.set_state(np.zeros(grid.shape), 0.0, dry_pressure(grid, self.equations.groups))
        level.update()
        level.move(self.nearest - central_value(grid, level.separation))


def share_of(equations: Equations) -> OilAlone:
    """Return the share of a level by its equations."""
    table, least = equations.asperities, equations.contact_film
    beneath = OilAlone(equations) if table is None else Summits(equations, table)
    return beneath if least is None else BoundaryContact(equations, least, beneath)


def contact_of(share: OilAlone) -> BoundaryContact:
    """Return the share of a level whose surfaces may touch through a boundary film."""
    assert isinstance(share, BoundaryContact)
    return share
