"""What a heated film remembers of former steps of time: temperatures, pressures and wall heat."""

from collections.abc import Sequence

import numpy as np

from tehl.kernels.energy.records import GHOSTS, Fields, Surface, Surfaces
from tehl.operators.trail import Trail
from tehl.typing import Array


class TransientFilm:
    """Former temperatures and pressures of a film, and the trails of both surfaces.

    The change at a place is backward of order two. What the density does to the flow through the
    layers when it changes in time differently in each is left out: it is of the order of the
    thermal expansion.

    Parameters
    ----------
    fields : Fields
        Of the film, whose ``past`` and ``pressing`` are filled.
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
        self._remember()

    def set_pressure(self) -> None:
        """Fill the change of the pressure with time."""
        fields, (last, before) = self.fields, self.pressures
        fields.pressing[:] = (1.5 * fields.p - 2.0 * last + 0.5 * before) / self.time_step

    def heat_surfaces(self, surfaces: Surfaces) -> None:
        """Give both surfaces the temperature that the heat upstream has made by now."""
        for surface, trail, (bulk, factor, _) in zip(
            surfaces, self.trails, self.paths, strict=True
        ):
            surface.bulk[:] = bulk + factor * trail.update(surface.flux[GHOSTS:-GHOSTS])

    def advance(self) -> None:
        """Let the present be the past of the next step."""
        self.temperatures[1] = self.temperatures[0]
        self.temperatures[0] = self._inner()
        self.pressures[1] = self.pressures[0]
        self.pressures[0] = self.fields.p
        self.stresses[:] = self.fields.tau_x, self.fields.tau_y
        for trail in self.trails:
            trail.advance()
        self._remember()

    def go_back(self) -> None:
        """Take the temperature and stress of the last step again."""
        self._inner()[:] = self.temperatures[0]
        self.fields.tau_x[:], self.fields.tau_y[:] = self.stresses

    def pack(self) -> dict[str, Array]:
        """Return all of it, by name."""
        trails = {
            f"trail_{k}_{name}": getattr(trail, name)
            for k, trail in enumerate(self.trails)
            for name in ("modes", "fluxes")
        }
        fluxes = {f"flux_{k}": flux for k, flux in enumerate(self.fluxes)}
        return {
            **fluxes,
            "temperatures": self.temperatures,
            "pressures": self.pressures,
            "stresses": self.stresses,
            **trails,
        }

    def unpack(self, known: dict[str, Array]) -> None:
        """Take back what `pack` has returned."""
        for name in ("temperatures", "pressures", "stresses"):
            getattr(self, name)[:] = known[name]
        for k, trail in enumerate(self.trails):
            self.fluxes[k][:] = known[f"flux_{k}"]
            for name in ("modes", "fluxes"):
                getattr(trail, name)[:] = known[f"trail_{k}_{name}"]
        self._remember()

    def _inner(self) -> Array:
        return self.fields.temperature[GHOSTS:-GHOSTS, :, GHOSTS:-GHOSTS]

    def _remember(self) -> None:
        """Fill what former temperatures bring to the derivative."""
        last, before = self.temperatures
        self.fields.past[:] = (2.0 * last - 0.5 * before) / self.time_step


def without_history(surface: Surface) -> Surface:
    """Return a surface without a line source to march: ``bulk`` is its whole temperature."""
    nothing = np.zeros_like(surface.decay)
    return surface._replace(next_=0.0, decay=nothing, older=nothing, newer=nothing)
