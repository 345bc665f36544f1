"""History of a heated film in a transient run: temperatures, pressures and surface heat.

Time derivatives are backward differences of second order (docs/theory/numerics-thermal.md).
"""

from collections.abc import Sequence

import numpy as np

from tehl.base.typing import Array
from tehl.kernels.energy.records import GHOSTS, Fields, Surface, Surfaces
from tehl.operators.line_source import history
from tehl.operators.trail import Trail


class Rubbing:
    """Heat of asperities into one surface, and its trail; parameters as of `Trail`.

    The march of the energy equation does not carry it, so its whole rise is that of the wall.
    """

    def __init__(self, flux: Array, spacing: float, lag: float) -> None:
        self.flux, self.trail = np.ascontiguousarray(flux), Trail(flux, spacing, lag)
        self.near = history(flux.shape[0], spacing).near

    def rise(self) -> Array:
        """Return the rise by the present flux and that upstream, (nx, ny)."""
        rise: Array = self.trail.update(self.flux) + self.near * self.flux
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
    spacing, time_step : float
        Mesh width [a_x] and step [a_x / u_m].
    paths : sequence of (float, float, float)
        Bulk temperature [K], rise per flux integral, and steps per mesh width of each surface.
    """

    def __init__(
        self,
        fields: Fields,
        surfaces: Surfaces,
        spacing: float,
        time_step: float,
        paths: Sequence[tuple[float, float, float]],
    ) -> None:
        self.fields, self.time_step, self.paths = fields, time_step, paths
        self.fluxes = tuple(surface.flux for surface in surfaces)
        inner = fields.temperature[GHOSTS:-GHOSTS, :, GHOSTS:-GHOSTS]
        self.temperatures = np.stack([inner, inner])
        self.pressures = np.stack([fields.p, fields.p])
        self.stresses = np.stack([fields.tau_x, fields.tau_y])
        self.trails = [
            Trail(surface.flux[GHOSTS:-GHOSTS], spacing, lag)
            for surface, (_, _, lag) in zip(surfaces, paths, strict=True)
        ]
        self.spacing, self.rubbing = spacing, list[Rubbing]()
        self._set_past()

    def begin_rubbing(self, fluxes: tuple[Array, Array]) -> None:
        """Take the heat of asperities into each surface, (nx, ny), as steady history."""
        self.rubbing = [
            Rubbing(flux, self.spacing, lag)
            for flux, (_, _, lag) in zip(fluxes, self.paths, strict=True)
        ]

    def rub(self, fluxes: tuple[Array, Array]) -> None:
        """Set the heat of asperities into each surface, (nx, ny), dimensionless."""
        for rubbing, flux in zip(self.rubbing, fluxes, strict=True):
            rubbing.flux[:] = flux

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
            arrays[f"trail_{k}_modes"], arrays[f"trail_{k}_fluxes"] = trail.modes, trail.fluxes
        for k, rubbing in enumerate(self.rubbing):
            arrays[f"rubbing_{k}"], trail = rubbing.flux, rubbing.trail
            arrays[f"rubbing_{k}_modes"], arrays[f"rubbing_{k}_fluxes"] = trail.modes, trail.fluxes
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
