"""Boundary film between surfaces that touch: the ``[contact_film]`` table of a case.

Where the oil would leave less than this thickness, solid contact carries what the film does not
(docs/theory/contact.md).
"""

from typing import Annotated, ClassVar

from pydantic import Field

from tehl.base.table import Table
from tehl.base.typing import Array, BoolArray
from tehl.base.units import BoundaryFilm, Quantity

Friction = Annotated[float, Quantity("a plain number", "-", "0.1", "non-negative")]

THINNEST_BOUNDARY_FILM, THICKEST_BOUNDARY_FILM = 1e-12, 1e-6
"""Limits of the boundary film [m]: beyond both the unit is wrong."""
TOUCHING_MARGIN = 0.05
"""Film above the boundary film, over it, up to which surfaces count as touching."""


class ContactFilm(Table):
    """A film that no pressure removes; the surfaces touch where it is all that is left."""

    synonyms: ClassVar = {
        "thickness": "film h height",
        "friction": "mu friction_coefficient",
    }

    thickness: BoundaryFilm
    """Least film thickness [m]."""
    friction: Annotated[Friction, Field(le=2.0)] = 0.1
    """Friction coefficient where they touch [-]."""

    def meets(self, film: Array) -> BoolArray:
        """Return where a film [m] exceeds the boundary film by at most `TOUCHING_MARGIN`."""
        return film <= (1.0 + TOUCHING_MARGIN) * self.thickness
