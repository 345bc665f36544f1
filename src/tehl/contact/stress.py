"""Stress below the surfaces: the ``[stress]`` table of a case, how it is computed and judged."""

from itertools import pairwise
from typing import Annotated, ClassVar, Literal, Self

from pydantic import Field, model_validator

from tehl.base.table import Table
from tehl.base.units import Height, NonNegativeStress, Number, Quantity

SolidStress = Annotated[float, Quantity("a stress", "Pa", '"-300 MPa"', "any")]

FAST_PECLET = 10.0
"""Solid Peclet number |u_s| a_x/(2 kappa_s) from which a stress is found without that at rest: the
wake left out changes it by 0.7 %, and below it short waves by less than 0.1 %."""


class Stress(Table):
    """Stress below both surfaces, and measures of fatigue over those of the dry smooth contact."""

    synonyms: ClassVar = {
        "residual": "residual_stress profile",
        "body": "surface bodies",
        "deepest": "depth max_depth",
        "thermal": "heat thermal_stress",
    }

    body: Literal[1, 2, "both"] = "both"
    """Body whose stress is computed; both if left out."""
    depths: Annotated[int, Field(ge=8, le=200)] = 20
    """Number of depths, evenly spaced on a logarithmic scale."""
    deepest: Annotated[Number, Field(ge=1.0, le=20.0)] = 3.0
    """The deepest of them over the smaller half-width of the Hertz contact [-]. The shallowest is
    two mesh widths."""
    residual: tuple[tuple[Height, SolidStress], ...] = ()
    """Depths [m] and residual stresses along x and y [Pa], tension positive, linear between and
    constant beyond; the dry smooth contact has them too."""
    thermal: bool = False
    """Whether the heat of the film stresses the bodies too; needs ``[thermal]`` and the
    ``expansion`` of their materials."""
    criterion: Literal["orthogonal-shear", "dang-van"] = "orthogonal-shear"
    """Stress that decides the relative life: amplitude of tau_zx as Lundberg and Palmgren have it,
    or that of Dang Van."""
    fatigue_limit: NonNegativeStress = 0.0
    """Stress of the criterion below which there is no fatigue [Pa]."""
    stress_exponent: Annotated[Number, Field(ge=1.0, le=40.0)] = 31.0 / 3.0
    """c of the relative life [-]."""
    depth_exponent: Annotated[Number, Field(ge=0.0, le=10.0)] = 7.0 / 3.0
    """h of the relative life [-]."""
    weibull_slope: Annotated[Number, Field(ge=0.2, le=10.0)] = 10.0 / 9.0
    """e of the relative life [-]."""
    dang_van_slope: Annotated[Number, Field(ge=0.0, le=1.0)] = 0.232
    """Part of the hydrostatic tension that counts as shear in the criterion of Dang Van [-]."""

    @model_validator(mode="after")
    def _must_deepen(self) -> Self:
        if any(later <= earlier for (earlier, _), (later, _) in pairwise(self.residual)):
            raise ValueError("residual must have depths that increase")
        return self

    @property
    def bodies(self) -> tuple[int, ...]:
        """Return the numbers of the bodies whose stress is computed."""
        return (1, 2) if self.body == "both" else (self.body,)
