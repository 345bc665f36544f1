"""A measured surface at a glance: what it is, and what a mesh sees of it."""

from dataclasses import dataclass

from tehl.errors import InputError
from tehl.roughness.files import RawMap, read
from tehl.roughness.files.raw import shown
from tehl.roughness.form import question_of_form
from tehl.roughness.loading import found_file
from tehl.roughness.map import Map
from tehl.roughness.prepare import Heights
from tehl.roughness.statistics import Spectrum, Statistics, share_beyond, spectrum, statistics


@dataclass(frozen=True, kw_only=True, slots=True)
class Mesh:
    """A grid of the solver around a contact.

    Attributes
    ----------
    spacing : (dx, dy)
        [m]
    half_widths : (a_x, a_y)
        Of the Hertz contact [m].
    points : (nx, ny)
        Nodes along x and y.
    """

    spacing: tuple[float, float]
    half_widths: tuple[float, float]
    points: tuple[int, int]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Preview:
    """What a file holds, and what becomes of it.

    Attributes
    ----------
    surface : Map
        How it is prepared and placed.
    file, kind : str
        Name and format.
    raw_shape : (ny, nx)
        Rows and columns of the file.
    missing : int
        Points of the file without a height.
    heights : Heights
        As they are prepared.
    statistics : Statistics
        Of the prepared heights.
    spectrum : Spectrum
        Of the prepared heights.
    shortest_wavelength : float
        2 pi Sq / Sq' where it is shortest [m].
    mesh : Mesh or None
        The grid that is compared.
    lost : float or None
        Share of the variance that the mesh cannot carry.
    sentences : tuple of str
        What is odd about the map, and beside the contact.
    """

    surface: Map
    file: str
    kind: str
    raw_shape: tuple[int, int]
    missing: int
    heights: Heights
    statistics: Statistics
    spectrum: Spectrum
    shortest_wavelength: float
    mesh: Mesh | None
    lost: float | None
    sentences: tuple[str, ...]


def preview(surface: Map, mesh: Mesh | None = None) -> Preview:
    """Return a measured surface at a glance.

    Parameters
    ----------
    surface : Map
        The file and how it is prepared.
    mesh : Mesh or None
        The grid to compare with.

    Raises
    ------
    InputError
        As :meth:`tehl.roughness.Map.load`.
    """
    import numpy as np  # noqa: PLC0415 (beside the arrays only)

    raw = _raw(surface)
    heights = surface.load()
    lost: float | None = None
    if mesh is not None:
        lost = share_beyond(heights.values, heights.pixel, mesh.spacing)
    return Preview(
        surface=surface,
        file=shown(surface.file),
        kind=raw.kind,
        raw_shape=(raw.heights.shape[0], raw.heights.shape[1]),
        missing=int(np.sum(~np.isfinite(raw.heights))),
        heights=heights,
        statistics=statistics(heights.values, heights.pixel),
        spectrum=spectrum(heights.values, heights.pixel),
        shortest_wavelength=surface.shortest_wavelength,
        mesh=mesh,
        lost=lost,
        sentences=_questions(surface, heights, mesh),
    )


def _questions(surface: Map, heights: Heights, mesh: Mesh | None) -> tuple[str, ...]:
    if mesh is not None:
        return surface.fits(2.0 * mesh.half_widths[0], 2.0 * mesh.half_widths[1])
    bent = question_of_form(heights, surface.level)
    return () if bent is None else (bent,)


def _raw(surface: Map) -> RawMap:
    path = found_file(surface)
    try:
        return read(path, layout=surface.layout, variable=surface.variable)
    except InputError as error:
        raise InputError(f"map {shown(surface.file)} {error}") from None
