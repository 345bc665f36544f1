"""Load, friction and area of surfaces that touch through a boundary film.

Which part of the pressure at a node is that of the contact follows from the oil that is trapped
there, and hardly from anything that one can measure. The load is therefore shared by the film:
what is carried where the film exceeds the boundary film by at most `TOUCHING_MARGIN` counts as
carried by the contact.
"""

import math
from dataclasses import dataclass

import numpy as np

from tehl.base.typing import Array, BoolArray, SingleArray
from tehl.contact.boundary_contact import TOUCHING_MARGIN, ContactFilm
from tehl.estimate.domain import domain_of
from tehl.estimate.film_formulas import expected_central_film
from tehl.estimate.nodes import expected_bar
from tehl.estimate.scaling import ScaledProblem
from tehl.post.solids import SolidContact, carried_by_solids
from tehl.post.traction import cell_widths, traction
from tehl.result import registry
from tehl.result.solution import Solution

LEAST_CELLS = 8.0
"""Mesh widths across the patches of contact below which a share of the load is not known: of
standing roughness that four cells per summit press into contact, eight may leave none."""
BAR_OF_FILM, LARGEST_SHARE_BAR = 4.0, 0.2
"""Error bar of the share over the relative error of the film to expect, and largest one of a share
that is known. Where the film is as thin as the boundary film, the error of the film decides what
touches, though its thickness there does not show it (docs/theory/contact.md, resolution)."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Patches:
    """Patches on which the surfaces touch: nodes that are neighbours along x or y."""

    number: int
    area_mean: float
    area_largest: float
    """Area of a patch [m^2]."""
    pressure_mean: float
    pressure_max: float
    """Pressure of film and contact together on them [Pa]."""
    cells: float
    """Mean diameter, or width of long ones, in mesh widths, weighted by their loads [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Touching(SolidContact):
    """How film and contact share load and friction."""

    share_error: float
    margin: float
    """Film above the boundary film up to which surfaces count as touching [m]."""
    is_certified: bool
    """Whether error bars from three grids belong to the share."""
    solid_share: float
    """Load of the contact pressure alone over the load [-]."""
    contact_pressure_max: float
    """Largest contact pressure [Pa]."""
    patches: Patches | None
    """None where nothing touches."""

    @property
    def is_share_known(self) -> bool:
        """Whether the share means anything: patches and film are resolved, or it is certified."""
        return not self.why_unknown

    @property
    def why_unknown(self) -> str:
        """Why the share means nothing, in words; empty if it is known."""
        if self.patches is None or self.is_certified:
            return ""
        return why_unknown(self.patches.cells, self.share_error)


def why_unknown(cells: float, error: float) -> str:
    """Return why a share of the load is not resolved by the grid; an empty text if it is.

    Parameters
    ----------
    cells : float
        Mesh widths across the patches; zero if no stored field has one.
    error : float
        Error bar of the share [-].
    """
    if not cells:
        return "surfaces touch in no stored field, so its patches are not known (transient.frames)"
    if cells < LEAST_CELLS:
        return f"its patches are {cells:.2g} cells across, {LEAST_CELLS:g} are needed"
    return (
        f"the grid is too coarse for the oil, +- {error:.0%}" if error > LARGEST_SHARE_BAR else ""
    )


def touching(result: Solution) -> Touching | None:
    """Return how film and contact share load and friction; None without a boundary film.

    Sums over the nodes; the friction of the contact is the stated coefficient times the load where
    the surfaces touch.
    """
    found, film = result.contact, result.problem.contact_film
    if found is None or film is None or result.status.kind == "diverged":
        return None
    cells = np.outer(cell_widths(result.y), cell_widths(result.x))
    both = result.pressure + found.pressure
    meet = touching_nodes(result)
    load = np.where(meet, cells * both, 0.0)
    carried = carried_by_solids(
        result, load, film.friction, float(cells[meet].sum()), found.pressure
    )
    return Touching(
        **carried,
        margin=TOUCHING_MARGIN * film.thickness,
        share_error=_error_bar(result, film, carried["share"]),
        is_certified=registry.at("touching.share").name in result.uncertainty,
        solid_share=float((cells * found.pressure).sum()) / result.load,
        contact_pressure_max=float(found.pressure.max()),
        friction_film=_film_friction(result),
        patches=_patches(result, meet, cells, both),
        balance=float(found.balance),
    )


def _error_bar(result: Solution, film: ContactFilm, share: float) -> float:
    """Return the error bar of the share: by grids, or more by the error in the film of the oil [-].

    Nothing depends on a film that is thin beside the boundary film: oil flows as its cube.
    """
    scaled = ScaledProblem.of(result.problem)
    groups, domain = scaled.entering, domain_of(scaled, result.options)
    alone, least = expected_central_film(groups), film.thickness / scaled.scales.film_thickness
    error = expected_bar(groups, domain, result.x.size, film=max(alone, least))
    by_film = BAR_OF_FILM * min(error, 1.0) * min(alone / least, 1.0) ** 3
    by_grids = None if result.errors is None else result.errors.at("touching.share")
    return max(min(by_film, 1.0), share * (by_grids or 0.0))


def touching_nodes(result: Solution) -> BoolArray:
    """Return the nodes at which the surfaces touch, (ny, nx)."""
    film, found = result.problem.contact_film, result.contact
    if film is None or found is None or not found.pressure.any():  # the oil carries all
        return np.zeros(result.scaled.film.shape, bool)
    return film.meets(result.film_thickness)


def largest_patches(
    least: float, films: SingleArray, pressures: SingleArray, *, wraps: bool = False
) -> float:
    """Return the largest mean diameter of patches of contact in some fields [mesh widths].

    Parameters
    ----------
    least : float
        Thickness of the boundary film [m].
    films, pressures : array, (n, ny, nx)
        Thickness [m] and pressure [Pa].
    wraps : bool
        Whether the last row is the first one again.

    Returns
    -------
    float
        Zero where nothing touches.
    """
    cells = 0.0
    for film, pressure in zip(films, pressures, strict=True):
        meet = film <= (1.0 + TOUCHING_MARGIN) * least
        if meet.any():
            cells = max(cells, _diameters(meet, pressure, pressure, wraps=wraps)[-1])
    return cells


def _film_friction(result: Solution) -> float | None:
    forces = traction(result)
    return forces.size if forces is not None and forces.credible else None


def _patches(result: Solution, meet: BoolArray, area: Array, both: Array) -> Patches | None:
    if not meet.any():
        return None
    wraps = result.groups.shape.wraps
    areas, cells = _diameters(meet, area * both, area, wraps=wraps)
    return Patches(
        number=areas.size,
        area_mean=float(areas.mean()),
        area_largest=float(areas.max()),
        pressure_mean=float(np.average(both[meet], weights=area[meet])),
        pressure_max=float(both[meet].max()),
        cells=cells,
    )


def _diameters(meet: BoolArray, loads: Array, areas: Array, *, wraps: bool) -> tuple[Array, float]:
    """Return the area of each patch, and the mean diameter weighted by load [mesh widths].

    The diameter is that of a circle of its area, or the width of the patch where it is broadest if
    that is less: a long patch is resolved if its width is. In a line contact it is its length.
    A patch across both ends of a film that wraps is one.
    """
    # 0.1 s, for contacts that touch only
    from scipy.ndimage import distance_transform_edt, label, maximum  # noqa: PLC0415

    if wraps:
        meet = meet[:-1]
        loads, areas = (np.concatenate([one[:1] + one[-1:], one[1:-1]]) for one in (loads, areas))
    labels, number = label(meet)
    beside = np.pad(meet, ((0, 0), (1, 1)))
    around = len(meet) if wraps else 1
    beside = np.pad(beside, ((around, around), (0, 0)), mode="wrap" if wraps else "constant")
    depth = distance_transform_edt(beside)[around:-around, 1:-1]
    if wraps:
        for south, north in zip(labels[-1], labels[0], strict=True):
            if south and north:
                labels[labels == north] = south
        known = np.unique(np.append(0, labels), return_inverse=True)[1][1:]
        labels = known.reshape(labels.shape)
        number = int(labels.max())
    nodes = np.bincount(labels.ravel())[1:]
    carried = np.bincount(labels.ravel(), weights=loads.ravel())[1:]
    widths = 2.0 * np.asarray(maximum(depth, labels, np.arange(1, number + 1)))
    across = np.minimum(2.0 * np.sqrt(nodes / math.pi), widths) if len(meet) > 1 else nodes
    weights = carried if carried.sum() > 0.0 else np.ones(number)
    covered = np.bincount(labels.ravel(), weights=areas.ravel())[1:]
    return np.asarray(covered, float), float((weights * across).sum() / weights.sum())
