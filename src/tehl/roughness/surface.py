"""What a case file may say under ``roughness``: a table, or a list of tables that are added."""

from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field, GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, core_schema

from tehl.roughness.features import Bump, Dimple, Ridge
from tehl.roughness.map import Map
from tehl.roughness.protocol import Roughness, RoughnessModel
from tehl.roughness.random_surface import Random
from tehl.roughness.smooth import Smooth
from tehl.roughness.superposition import Superposition
from tehl.roughness.waves import Crossed, Wave

if TYPE_CHECKING:
    from tehl.typing import Array

OneRoughness = Annotated[
    Smooth | Wave | Crossed | Ridge | Bump | Dimple | Random | Map, Field(discriminator="type")
]
"""A surface that is no sum."""


class Sum(RoughnessModel):
    """The sum of several surfaces; in a case file, a list of tables.

    Attributes
    ----------
    parts : tuple of surfaces
        What is added.
    """

    type: Literal["sum"] = "sum"
    parts: tuple[OneRoughness, ...]

    @property
    def is_smooth(self) -> bool:
        """Return whether all parts are smooth."""
        return self._whole.is_smooth

    @property
    def is_even_in_y(self) -> bool:
        """Return whether the parts mirror at y = 0; waves may do so together."""
        return self._whole.is_even_in_y

    @property
    def shortest_wavelengths(self) -> tuple[float, float]:
        """Return the shortest wavelengths of all parts along x and along y [m]."""
        return self._whole.shortest_wavelengths

    @property
    def shortest_wavelength(self) -> float:
        """Return the shortest wavelength of all parts [m]."""
        return self._whole.shortest_wavelength

    @property
    def rms(self) -> float:
        """Return the root mean square height Sq [m]; that of equal harmonics with their phases."""
        return self._whole.rms

    @property
    def _whole(self) -> Superposition:
        return Superposition(self.parts)

    def _at_rest(self, x: "Array", y: "Array") -> "Array":
        return self._whole.height(x, y)

    def resolved_on(self, dx: float, dy: float) -> Roughness:
        """Return the sum of the parts as a mesh of ``dx`` by ``dy`` [m] carries them."""
        return self._whole.resolved_on(dx, dy)

    def fits(self, width: float, length: float) -> tuple[str, ...]:
        """Return what is odd about the parts beside a contact of ``width`` by ``length`` [m]."""
        return tuple(line for part in self.parts for line in part.fits(width, length))


class _ListIsSum:
    """Metadata of a field: read a list of tables as their sum."""

    def __get_pydantic_core_schema__(
        self, source: object, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Read a list before pydantic looks for its type."""
        return core_schema.no_info_before_validator_function(_as_table, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """Describe the field as a table or a list of tables."""
        table = handler(schema)
        return {"anyOf": [table, {"type": "array", "items": table}]}


def _as_table(value: Any) -> Any:
    """Return a list as the table of a sum, anything else as it is."""
    return {"type": "sum", "parts": value} if isinstance(value, list | tuple) else value


AnyRoughness = Annotated[
    Smooth | Wave | Crossed | Ridge | Bump | Dimple | Random | Map | Sum,
    Field(discriminator="type"),
    _ListIsSum(),
]
"""Type of the field ``roughness``."""
