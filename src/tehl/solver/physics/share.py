"""What carries load beside the oil, absence included: the base, and oil alone.

A level has one share. It says which film follows from the separation of the mean planes, what the
solids carry there, and what coarser grids and the coarsest solver need of it. Those with solids are
in `tehl.solver.physics.solid_shares`.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from tehl.base.typing import Array, BoolArray, FlagArray
from tehl.kernels.properties import Factors, Film
from tehl.operators.dry import dry_motions
from tehl.operators.transfer import injected
from tehl.solver.cycle.equations import Equations, Sources
from tehl.solver.cycle.relaxation import Smoother
from tehl.solver.judging.film_summary import central_value


class Carried(Protocol):
    """What a share needs of its level (`tehl.solver.cycle.level.Level`)."""

    film: Film
    separation: Array
    is_finest: bool
    sources: Sources
    factors: Factors | None
    smoother: Smoother

    @property
    def rigid_approach(self) -> float:
        """H00."""

    def update(self) -> None:
        """Evaluate the film."""

    def update_properties(self) -> None:
        """Evaluate conductance and density."""

    def set_state(self, pressure: Array, rigid: Array | float, asperity: Array | float) -> None:
        """Set the unknowns."""

    def move(self, change: Array | float) -> None:
        """Change the rigid motions, or the approach alone."""

    def load_error(self) -> float:
        """Return the relative error of the load."""

    def missing_load(self) -> float:
        """Return the load that nothing carries [-]."""


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
    """Whether a small change of the film moves much load: corrections are limited, and earlier
    cycles combined with the last one between smooth surfaces too."""
    lowest = 0.0
    """Pressure of the oil down to which a correction may take a film that stays wet [-]."""
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

    def moves_together(self, level: Carried) -> bool:
        """Return whether asperities that carry alone change together, not each by itself."""
        del level
        return False

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

    def raised(self, film: Array) -> Array:
        """Return what the rigid motions, of which that is the ``film``, add to it [-]."""
        found = self.response
        return film if found is None else found.raised(film)

    def answered(self, level: Carried) -> float:
        """Return by how much more load is missing as the contact yields to oil and approach [-]."""
        found = self.response
        if found is None:
            return 0.0
        # on coarser levels the pressure has the answer too, as well as these resolve the contact
        pressed = (1.0 - found.lift) * (level.film.p - found.pressure) + self.answer(level)
        risen = found.stiffness * (level.rigid_approach - found.approach)
        return self.equations.balances.integral(pressed) + risen

    def follow_response(self, finer: "OilAlone", level: Carried) -> None:
        """Take the response of a finer level, from the present state on."""
        found = finer.response
        self.response = found and found.injected(level.rigid_approach, level.film.p)

    def answer(self, level: Carried) -> Array | float:
        """Return the pressure by which the contact of a coarser level has answered to the oil."""
        del level
        return 0.0

    def take_answer(self, level: Carried, answer: Array | float) -> None:
        """Add what the contact of a coarser level has answered to the oil.

        Parameters
        ----------
        level : Level
            Of this share.
        answer : array of the shape of the coarser grid
            As `answer` returns it.
        """

    def yielding(self, influence: Array) -> Array:
        """Return the film at each node per unit pressure at each node as solids answer, (n, n)."""
        return influence

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
        return found * self.growing(level)

    def growing(self, level: Carried) -> Array | float:
        """Return the part of the conductance that grows as the cube of the film [-]."""
        factors, thickness = level.factors, level.film.conducting(self.equations.floor)
        return 1.0 if factors is None else factors.growing(thickness)

    def changed(self, coarse: Carried) -> Array:
        """Return the pressure whose change a finer grid takes [-]."""
        return coarse.film.p

    def start(self, level: Carried, expected_film: float) -> None:
        """Start from the Hertz pressure, with the rigid approach of the expected central film."""
        grid, groups = self.equations.grid, self.equations.groups
        level.set_state(self.equations.start_pressure(), dry_motions(grid, groups), 0.0)
        level.update()
        level.move(expected_film - central_value(grid, level.separation))


@dataclass(frozen=True, slots=True)
class Response:
    """How a contact that stays closed responds to the rigid approach c, by its change.

    The contact pressure changes by -c phi with K phi = 1 where the surfaces touch, so that they
    stay together; the film elsewhere by c (1 - K phi), and the load of the contact by -c S. Without
    it oil and contact would both make up for a missing load, and cycles diverge where the contact
    is the stiffer of both. On coarser levels the contact answers to the oil too, by a pressure that
    keeps the surfaces together.
    """

    lift: Array
    """1 - K phi, ``grid.shape`` [-]."""
    stiffness: float
    """S, integral of phi [-]."""
    approach: float
    """Rigid approach from which c counts [-]."""
    pressure: Array
    """Oil pressure of that state, ``grid.shape`` [-]."""

    def raised(self, film: Array) -> Array:
        """Return what a rigid approach, of which that is the ``film``, adds to it, (ny, nx) [-]."""
        return self.approach + self.lift * (film - self.approach)

    def injected(self, approach: float, pressure: Array) -> "Response":
        """Return the response on the next coarser grid, from its present state."""
        lift = injected(self.lift, pressure).copy()
        return Response(lift, self.stiffness, approach, pressure.copy())
