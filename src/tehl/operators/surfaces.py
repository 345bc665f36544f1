"""Temperatures of the two surfaces: line sources, full moving sources, and their coupling.

A surface of high solid Peclet number is heated by a line source, which the march of the energy
equation carries along (`tehl.operators.line_source`). At moderate ones it carries the line too, and
what the full source adds follows after each sweep. A surface that is slow, at rest or runs against
x has no line to march along: its temperature is a given field during a sweep, and is found
afterwards together with the flux that changes with it, since the film conducts far better than the
solid beneath. So is that of a surface whose points leave the lines along x.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.sparse.linalg import LinearOperator, gmres

from tehl.base.typing import Array
from tehl.contact.heat import LEAST_LINE, FilmEnergy, rubbing_parts, source_form
from tehl.contact.point_contact import PointContact
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import ScaledProblem, Scales
from tehl.estimate.ways import Velocity
from tehl.operators.full_source import WRAPS, FullSource
from tehl.operators.line_source import line_rise
from tehl.operators.stream_source import StreamSource, row_speed
from tehl.operators.transfer import midpoints

STEEPEST_PATH = 2.0
"""Slope of paths to x up to which they are followed from station to station."""
COARSENED_FROM = 128
"""Intervals from which the full source is summed on every second node: its field is smooth."""
SURFACE_TOLERANCE, SURFACE_ITERATIONS = 0.02, 30
"""Of the coupled surface temperatures after each sweep; the next sweep improves them again."""
SURFACE_KELVIN, SURFACE_RISE = 1e-3, 2e-4
"""Error of surface temperatures that is left as it is, in K and over the largest rise, the larger
one; a film changes by 5e-5 with the first. Without it the surfaces of a test rig (M = 5,300), which
warm by 0.03 K, take a third of its CPU time."""
STREAM_ITERATIONS = 4
"""The same where a surface is heated along paths that turn, as a product follows them from station
to station. Ten take more time and as many sweeps; without any, the temperature of a surface that
spins diverges in the thick film of the inlet, which conducts well along paths longer than those of
the march."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Side:
    """One solid in the heat problem.

    Attributes
    ----------
    bulk : float
        Temperature far from the contact [K].
    speed, across : float
        u_s, positive along x, and v_s along y at the centre [m/s].
    spin : float
        Angular velocity times a_x over u_s, from x to y [-].
    conductivity, capacity : float
        k_s [W/m/K] and rho_s c_s [J/m^3/K]; zero where the film is isothermal.
    peclet, peclet_y : float
        u_s a_x / (2 diffusivity), along x and y, signed [-].
    form : {"line", "full"}
        The source that is to be used.
    """

    bulk: float
    speed: float
    across: float
    spin: float
    conductivity: float
    capacity: float
    peclet: float
    peclet_y: float
    form: Literal["line", "full"]

    @property
    def marches(self) -> bool:
        """Whether a line source is carried along by the energy equation."""
        least = LEAST_LINE if self.form == "full" else 0.0
        return self.conductivity > 0.0 and self.speed > 0.0 and least <= self.peclet

    @property
    def streams(self) -> bool:
        """Whether heat goes along paths that a march along x, or a full source, lacks."""
        turned = self.spin != 0.0 or (self.across != 0.0 and self.form == "line")
        return self.marches and turned

    def slowness(self, y: Array) -> Array:
        """Return the root of the speed along x at the centre over that of each row ``y`` [a_x]."""
        return np.asarray(1.0 / np.sqrt(row_speed(self.spin, y)))

    @property
    def needs_full(self) -> bool:
        """Whether the full source is summed."""
        return self.conductivity > 0.0 and (self.form == "full" or not self.marches)

    def line_factor(self, scales: Scales, flux_unit: float) -> float:
        """Return the rise per dimensionless flux integrated over the root of the distance [K].

        Parameters
        ----------
        scales : Scales
            For the Hertz half-width along x [m].
        flux_unit : float
            Heat flux [W/m^2] of the dimensionless flux one.
        """
        effusivity = np.pi * self.conductivity * self.capacity * self.speed
        return float(flux_unit * np.sqrt(scales.half_width_x / effusivity))


def sides(scaled: ScaledProblem, heat: FilmEnergy) -> tuple[Side, Side]:
    """Return both solids.

    Parameters
    ----------
    scaled : ScaledProblem
        With the materials and the speeds of both surfaces.
    heat : FilmEnergy
        With the bulk temperatures [K] and the form of the source.
    """
    problem, scales = scaled.problem, scaled.scales
    _, first, second = scaled.moment.velocities
    return (
        _side(problem, 1, first, heat, scales),
        _side(problem, 2, second, heat, scales),
    )


def _side(
    problem: PointContact, number: int, velocity: Velocity, heat: FilmEnergy, scales: Scales
) -> Side:
    """Return one solid, with its velocity at the moment over u_m."""
    first, motion = number == 1, problem.motion
    bulk, spin = (heat.bulk_1, motion.spin_1) if first else (heat.bulk_2, motion.spin_2)
    solid = problem.surface_1.material if first else problem.surface_2.material
    is_heated = problem.thermal is not None
    speed, across = (scales.speed * part for part in velocity)
    stated = (solid.conductivity, solid.density, solid.heat_capacity)
    conductivity, density, capacity = (is_heated * (value or 0.0) for value in stated)
    peclet = peclet_y = 0.0
    if conductivity > 0.0:
        peclet = 0.5 * speed * scales.half_width_x * density * capacity / conductivity
        peclet_y = 0.5 * across * scales.half_width_x * density * capacity / conductivity
    # paths leave a piece and come back at its other end: their full sources have images
    steep = abs(across) > STEEPEST_PATH * speed or problem.shape.wraps
    return Side(
        bulk=bulk,
        speed=speed,
        across=across,
        spin=spin * scales.half_width_x / speed if spin != 0.0 else 0.0,
        conductivity=conductivity,
        capacity=density * capacity,
        peclet=peclet,
        peclet_y=peclet_y,
        form="full" if steep and across != 0.0 else source_form(heat.sources, peclet),
    )


class Solids:
    """Full moving sources of the surfaces that need them.

    Parameters
    ----------
    grid : Grid
        Its cells are the sources.
    scaled : ScaledProblem
        For the half-widths [m] and the temperature rise per flux.
    both : (Side, Side)
        The solids.
    flux_unit : float
        One unit of the dimensionless flux [W/m^2/K].
    finest : bool
        Sum the full source also of surfaces that march a line source.
    """

    def __init__(
        self,
        grid: Grid,
        scaled: ScaledProblem,
        both: tuple[Side, Side],
        flux_unit: float,
        *,
        finest: bool,
    ) -> None:
        self.both, groups, scales = both, scaled.groups, scaled.scales
        rows, columns = (n - 1 for n in grid.shape)
        fine = min(columns, 2 * rows if grid.mirror else rows) >= COARSENED_FROM
        self.stride = 2 if fine and rows % 2 == 0 and columns % 2 == 0 else 1
        shape = (rows // self.stride + 1, columns // self.stride + 1)
        self.between = _between(grid, shape[0]) if grid.crowding else None
        behind = WRAPS if grid.wraps else 2
        mirrors = behind if groups.shape.goes_on else int(grid.mirror)
        cell = (self.stride * groups.ellipticity * grid.dy, self.stride * grid.dx)
        self.sources = tuple(
            FullSource(
                shape,
                mirrors,
                cell,
                (side.peclet, side.peclet_y),
                flux_unit * scales.half_width_x / (2.0 * np.pi * side.conductivity),
                side.line_factor(scales, flux_unit) if side.marches else 0.0,
            )
            if side.needs_full and (finest or not side.marches)
            else None
            for side in both
        )

        self.spacing, self.factors = (
            grid.dx,
            [side.line_factor(scales, flux_unit) if side.marches else 0.0 for side in both],
        )
        x, y = grid.x[:: self.stride], (groups.ellipticity * grid.y if grid.ny > 1 else grid.y)
        places = np.linspace(y[0], y[-1], shape[0]) if self.between else y[:: self.stride]
        self.slowness = [side.slowness(y) for side in both]
        self.slowness_of_sources = [side.slowness(places) for side in both]
        self.streams = [
            _streams(x, places, side, factor, full=source is not None)
            for side, factor, source in zip(both, self.factors, self.sources, strict=True)
        ]
        still = np.zeros(grid.shape[::-1])
        self.rubbing, self.rises = (still, still), (still, still)

    def rub(self, heat: Array) -> None:
        """Heat both surfaces by asperities that rub, in place of what they did before.

        Each takes the part by which both would become as warm, by conductivity and solid Peclet
        number.

        Parameters
        ----------
        heat : (nx, ny) array
            Dimensionless flux into both together.
        """
        conductivities = [side.conductivity for side in self.both]
        first, second = rubbing_parts(conductivities, [side.peclet for side in self.both])
        self.rubbing = first * heat, second * heat

    def warm(self, walls: tuple[Array, Array]) -> None:
        """Add the present rise by rubbing to the walls: the line source of a sweep has it not.

        Parameters
        ----------
        walls : pair of (nx, ny) array
            Temperature of each surface less what its line source does [K].
        """
        before = self.rises
        first, second = (
            factor * slow * line_rise(flux, self.spacing) if factor else np.zeros_like(flux)
            for factor, slow, flux in zip(self.factors, self.slowness, self.rubbing, strict=True)
        )
        self.rises = first, second
        for wall, now, old in zip(walls, self.rises, before, strict=True):
            np.add(wall, now - old, out=wall)

    @property
    def forms(self) -> tuple[str, str]:
        """Return which source each surface takes."""
        first, second = ("full" if source else "line" for source in self.sources)
        return first, second

    def update(
        self,
        conductance: Array,
        walls: tuple[Array, Array],
        fluxes: tuple[Array, Array],
        *,
        exactly: bool = False,
    ) -> None:
        """Bring the given parts of the surface temperatures up to date, in place.

        Parameters
        ----------
        conductance : (nx, ny) array
            Dimensionless, of the film between the surfaces.
        walls : pair of (nx, ny) array
            Temperature of each surface less what its line source does [K].
        fluxes : pair of (nx, ny) array
            Dimensionless heat flux into each surface.
        exactly : bool
            Also where what changes is below `SURFACE_KELVIN` or `SURFACE_RISE`.
        """
        whole = zip(fluxes, self.rubbing, strict=True)
        coarse = [self._coarse(flux + rubbed) for flux, rubbed in whole]
        misfits: list[Array | None] = [None, None]
        for number, (side, source) in enumerate(zip(self.both, self.sources, strict=True)):
            if source is None and not self.streams[number]:
                continue
            wanted = side.bulk + (source.rise(coarse[number]) if source else 0.0)
            wanted = wanted + self._turned(number, coarse[number])
            if side.marches and not self.streams[number]:
                walls[number][:] = self._fine(wanted) + self.rises[number]
            else:
                wanted = wanted + self._coarse(self.rises[number])
                misfit = wanted - self._coarse(walls[number])
                rise = float(np.abs(wanted - side.bulk).max())
                left = 0.0 if exactly else max(SURFACE_KELVIN, SURFACE_RISE * rise)
                misfits[number] = misfit if np.abs(misfit).max() > left else None
        if any(misfit is not None for misfit in misfits):
            changes = self._coupled(self._coarse(conductance), misfits)
            for number, change in changes.items():
                walls[number][:] += self._fine(change)

    def _turned(self, number: int, flux: Array) -> Array:
        """Return what paths other than lines along x add to the rise of a surface, y first [K]."""
        streams, spacing = self.streams[number], self.stride * self.spacing
        if not streams:
            return np.zeros_like(flux)
        turned, *straight = (stream.rise(flux.T) for stream in streams)
        slow = self.slowness_of_sources[number]
        if straight:  # the line along x is part of the full source
            turned, slow = turned - straight[0], slow - 1.0
        marched = self.factors[number] * slow * line_rise(flux.T, spacing)
        return np.asarray(turned - marched).T

    def _coupled(self, conductance: Array, misfits: list[Array | None]) -> dict[int, Array]:
        """Return changes of the given parts of the surfaces that leave no misfit, to first order.

        A warmer surface takes less heat, by the conductance of the film, and the other one more.
        With conductance G, response S to the flux and part L of it that the march carries, a misfit
        m of the given part changes the temperature by (1 + S G)^-1 m, and the given part by 1 + L G
        times this. A surface without misfit follows: beside a thin film both are as warm.
        """
        shape, zero = conductance.shape, np.zeros(conductance.size)

        def less(change: dict[int, Array], number: int) -> Array:
            return conductance * (change[number] - change[1 - number])

        def respond(vector: Array) -> Array:
            change = dict(enumerate(vector.reshape(2, *shape)))
            parts = []
            for number in range(2):
                flux, source = less(change, number), self.sources[number]
                lost = (source.rise(flux) if source else 0.0) + self._turned(number, flux)
                parts.append(change[number] + lost + self._marched(number, flux))
            return np.concatenate([part.ravel() for part in parts])

        right = np.concatenate([zero if m is None else m.ravel() for m in misfits])
        size = right.size
        operator = LinearOperator((size, size), matvec=respond, dtype=np.float64)
        most = STREAM_ITERATIONS if any(self.streams) else SURFACE_ITERATIONS
        solution, _ = gmres(operator, right, rtol=SURFACE_TOLERANCE, restart=most, maxiter=1)
        change = dict(enumerate(solution.reshape(2, *shape)))
        return {
            number: change[number] + self._marched(number, less(change, number))
            for number in range(2)
            if misfits[number] is not None
        }

    def _marched(self, number: int, flux: Array) -> Array:
        """Return the rise of a surface by the line that the sweep carries along, y first [K]."""
        factor, slow = self.factors[number], self.slowness_of_sources[number]
        spacing = self.stride * self.spacing
        return np.asarray(factor * slow * line_rise(flux.T, spacing)).T if factor else 0.0 * flux

    def _coarse(self, field: Array) -> Array:
        """Return every ``stride``-th node of a field with y last, with y first, on uniform rows."""
        if self.between:
            return self.between[0] @ field[:: self.stride].T
        return np.ascontiguousarray(field[:: self.stride, :: self.stride].T)

    def _fine(self, field: Array) -> Array:
        """Return a field of the coarser nodes on all of them, with y last."""
        if self.between:
            on_rows = (self.between[1] @ field).T
            return midpoints(on_rows, self.rubbing[0].shape) if self.stride == 2 else on_rows
        return midpoints(field.T) if self.stride == 2 else field.T


def _between(grid: Grid, rows: int) -> tuple[Array, Array]:
    """Return the linear interpolation to uniform rows, on which sources sum, and back."""
    y = grid.y
    uniform = np.linspace(y[0], y[-1], rows)
    there, back = (
        np.array([np.interp(wanted, places, one) for one in np.eye(places.size)]).T
        for wanted, places in ((uniform, y), (y, uniform))
    )
    return there, back


def _streams(
    x: Array, y: Array, side: Side, factor: float, *, full: bool
) -> tuple[StreamSource, ...]:
    """Return the source along the paths of a surface; with a full source also that of its centre.

    A line needs none, as nothing changes along y.
    """
    if y.size == 1 or not side.streams or (full and side.spin == 0.0):
        return ()
    slope = side.across / side.speed
    spins = (side.spin, 0.0) if full else (side.spin,)
    return tuple(StreamSource(x, y, factor, slope, spin) for spin in spins)
