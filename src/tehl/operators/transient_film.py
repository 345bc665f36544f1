"""History of a heated film in a transient run: temperatures, pressures and surface heat.

Time derivatives are backward differences of second order (docs/theory/numerics-thermal.md).
"""

from collections.abc import Callable, Sequence

import numpy as np

from tehl.base.typing import Array
from tehl.estimate.ways import Way
from tehl.kernels.energy.records import GHOSTS, Fields, Surface, Surfaces
from tehl.operators.trail import Trail, TurningTrail, VaryingTrail

MakeTrail = Callable[[Array], Trail | VaryingTrail | TurningTrail]
"""Returns the history of a surface from its flux, (nx, ny)."""

Path = tuple[float, float, MakeTrail]
"""Bulk temperature [K], rise per flux integral, and history of a surface."""


class Rubbing:
    """Heat of asperities into one surface, and its trail.

    The march of the energy equation does not carry it, so its whole rise is that of the wall.
    """

    def __init__(self, flux: Array, trail: MakeTrail) -> None:
        self.flux = np.ascontiguousarray(flux)
        self.trail = trail(self.flux)

    def rise(self) -> Array:
        """Return the rise by the present flux and that upstream, (nx, ny)."""
        rise: Array = self.trail.update(self.flux) + self.trail.near * self.flux
        return rise


class TransientFilm:
    """Former temperatures and pressures of a film, and the trails of both surfaces.

    The flow through the layers that results from density changes in time is neglected; it is of the
    order of the thermal expansion.

    Parameters
    ----------
    fields : Fields
        Of the film; ``past`` and ``pressing`` are output.
    surfaces : Surfaces
        With the steady flux.
    time_step : float
        Step [a_x / u_m].
    paths : sequence of Path
        Of each surface.
    """

    def __init__(
        self,
        fields: Fields,
        surfaces: Surfaces,
        time_step: float,
        paths: Sequence[Path],
    ) -> None:
        self.fields, self.time_step, self.paths = fields, time_step, paths
        self.fluxes = tuple(surface.flux for surface in surfaces)
        inner = fields.temperature[GHOSTS:-GHOSTS, :, GHOSTS:-GHOSTS]
        self.temperatures = np.stack([inner, inner])
        self.pressures = np.stack([fields.p, fields.p])
        self.stresses = np.stack([fields.tau_x, fields.tau_y])
        self.trails = [
            trail(surface.flux[GHOSTS:-GHOSTS])
            for surface, (_, _, trail) in zip(surfaces, paths, strict=True)
        ]
        self.rubbing = list[Rubbing]()
        self._set_past()

    def begin_rubbing(self, fluxes: tuple[Array, Array]) -> None:
        """Take the heat of asperities into each surface, (nx, ny), as steady history."""
        self.rubbing = [
            Rubbing(flux, trail) for flux, (_, _, trail) in zip(fluxes, self.paths, strict=True)
        ]

    def rub(self, fluxes: tuple[Array, Array]) -> None:
        """Set the heat of asperities into each surface, (nx, ny), dimensionless."""
        for rubbing, flux in zip(self.rubbing, fluxes, strict=True):
            rubbing.flux[:] = flux

    def move(self, ways: Sequence[Way]) -> None:
        """Begin a step in which each surface moves by its way."""
        for trails in (self.trails, [one.trail for one in self.rubbing]):
            for trail, way in zip(trails, ways, strict=bool(trails)):
                trail.move(way)

    def set_pressure(self) -> None:
        """Fill the time derivative of the pressure."""
        fields, (last, before) = self.fields, self.pressures
        fields.pressing[:] = (1.5 * fields.p - 2.0 * last + 0.5 * before) / self.time_step

    def heat_surfaces(self, surfaces: Surfaces) -> None:
        """Set the temperature of both surfaces from bulk and the heat upstream."""
        for surface, trail, (bulk, factor, _) in zip(
            surfaces, self.trails, self.paths, strict=True
        ):
            surface.bulk[:] = bulk + factor * trail.update(surface.flux[GHOSTS:-GHOSTS])
        for k, rubbing in enumerate(self.rubbing):
            _, factor, _ = self.paths[k]
            surfaces[k].bulk[:, : rubbing.flux.shape[1]] += factor * rubbing.rise()

    def advance(self) -> None:
        """Accept the present as the last time level of the next step."""
        self.temperatures[1] = self.temperatures[0]
        self.temperatures[0] = self._inner()
        self.pressures[1] = self.pressures[0]
        self.pressures[0] = self.fields.p
        self.stresses[:] = self.fields.tau_x, self.fields.tau_y
        for trail in (*self.trails, *(one.trail for one in self.rubbing)):
            trail.advance()
        self._set_past()

    def go_back(self) -> None:
        """Restore temperature and stress of the last step."""
        self._inner()[:] = self.temperatures[0]
        self.fields.tau_x[:], self.fields.tau_y[:] = self.stresses

    def pack(self) -> dict[str, Array]:
        """Return all arrays of the history by name."""
        arrays = {name: getattr(self, name) for name in ("temperatures", "pressures", "stresses")}
        for k, (flux, trail) in enumerate(zip(self.fluxes, self.trails, strict=True)):
            arrays[f"flux_{k}"] = flux
            arrays |= {f"trail_{k}_{name}": one for name, one in trail.arrays().items()}
        for k, rubbing in enumerate(self.rubbing):
            arrays[f"rubbing_{k}"] = rubbing.flux
            held = rubbing.trail.arrays()
            arrays |= {f"rubbing_{k}_{name}": one for name, one in held.items()}
        return arrays

    def unpack(self, known: dict[str, Array]) -> None:
        """Restore the arrays that `pack` returned."""
        for name, array in self.pack().items():
            array[:] = known[name]
        self._set_past()

    def _inner(self) -> Array:
        return self.fields.temperature[GHOSTS:-GHOSTS, :, GHOSTS:-GHOSTS]

    def _set_past(self) -> None:
        """Fill the contribution of former temperatures to the time derivative."""
        last, before = self.temperatures
        self.fields.past[:] = (2.0 * last - 0.5 * before) / self.time_step


def without_history(surface: Surface) -> Surface:
    """Return a surface without a line source to march: ``bulk`` is its whole temperature."""
    nothing = np.zeros_like(surface.decay)
    return surface._replace(next_=0.0, decay=nothing, older=nothing, newer=nothing)


class KeptStresses:
    """Stresses of the last step of a film that thins without heat: a failed one may leave NaN."""

    def __init__(self, fields: Fields) -> None:
        self.fields = fields
        self.advance()

    def advance(self) -> None:
        """Accept the present as the last step."""
        self.stresses = self.fields.tau_x.copy(), self.fields.tau_y.copy()

    def go_back(self) -> None:
        """Restore those of the last step."""
        self.fields.tau_x[:], self.fields.tau_y[:] = self.stresses

    def pack(self) -> dict[str, Array]:
        """Return no arrays: a checkpoint has the fields of the film."""
        return {}

    def unpack(self, known: dict[str, Array]) -> None:
        """Accept the fields that were restored."""
        del known
        self.advance()
