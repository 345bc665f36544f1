"""Rough surfaces before the solve: heights, needed grid, waves."""

import math
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from tehl.contact.options import MOST_NODES_PER_AXIS, Options, coarsenable
from tehl.contact.problem import ContactProblem
from tehl.estimate.wave_theory import LinearTheory, expected_waves
from tehl.operators.resolution import resolution_of, sample_of
from tehl.roughness import AnyRoughness, Sum, WaveVector
from tehl.roughness.resolution import Resolution

CONVERGES, RESOLVES = 8, 16
"""Nodes on the shortest wave with which runs converge, and with which ripples are right to 3 %."""
_THEORY = ("film_ratio", "pressure", "elastic_pressure")


@dataclass(frozen=True, kw_only=True, slots=True)
class Asperities:
    """Heights of the surfaces in a contact and on a grid."""

    sq: tuple[float, float]
    """Root mean square height of each full surface where |X|, |Y| < 1, as it passes the contact in
    a transient run; ``rms_roughness`` where a smooth surface states it [m]."""
    composite: float
    """Of both [m]."""
    resolution: Resolution
    """Which part of the stated heights the grid carries."""
    steepest: float
    """Largest slope of the heights [-]."""
    flattening: float
    """Root mean square of the dry pressure that flattens the heights of both surfaces [Pa]: a
    height of wave number q takes E' q / 4 of it, so that E'/4 times the slope is left of all."""
    shortest_wave: float
    """Shortest wave along either axis of the full surfaces [m]."""
    points_per_wave: float
    """Nodes of the grid on it [-]."""
    points_to_converge: int
    points_to_resolve: int
    """Nodes per direction that put 8 and 16 on it."""
    stands: bool
    """Whether the roughness stands still in the contact."""
    waves: tuple[tuple[WaveVector, LinearTheory], ...]
    """Stated waves of the surfaces, and their ripples by theory."""
    remarks: tuple[str, ...]
    """Sizes of a surface that do not fit the contact."""

    def summary(self) -> dict[str, Any]:
        """Return it as JSON can hold it."""
        waves = [
            {name: getattr(wave, name) for name in ("wavelength", "angle", "amplitude")}
            | {name: getattr(theory, name) for name in _THEORY}
            for wave, theory in self.waves
        ]
        lost = {"lost_share": self.resolution.lost_share, "warning": self.resolution.warning}
        found = asdict(self) | {"waves": waves}
        return found | {"resolution": found["resolution"] | lost}


def asperities(
    problem: ContactProblem, options: Options, mesh: tuple[float, float], film: float
) -> Asperities | None:
    """Return heights, needed grid and waves of a case; None where both surfaces are smooth.

    Parameters
    ----------
    problem, options : ContactProblem, Options
        Surfaces and motion, and the error to reach.
    mesh : (float, float)
        Mesh widths of the finest grid along x and y [m].
    film : float
        Central film to expect [m].

    Raises
    ------
    InputError
        If a measured surface cannot be read.
    """
    resolution = resolution_of(problem, mesh)
    if resolution is None:
        return None
    surfaces = {"surface_1": problem.surface_1, "surface_2": problem.surface_2}
    roughs = [one.roughness for one in surfaces.values()]
    first, second = (
        sq or one.rms_roughness for sq, one in zip(resolution.sq, surfaces.values(), strict=True)
    )
    waves = [min(pair) for pair in zip(*(one.shortest_wavelengths for one in roughs), strict=True)]
    counts = [wave / step for wave, step in zip(waves, mesh, strict=True)]
    is_line = problem.contact.is_line
    fewest, axis = min(
        (count, number) for number, count in enumerate(counts[: 1 if is_line else 2])
    )
    steepest, slopes = zip(*(_slopes(one, problem, mesh) for one in roughs), strict=True)
    size = (2.0 * problem.hertz.half_width_x, 0.0 if is_line else 2.0 * problem.hertz.half_width_y)
    return Asperities(
        sq=(first, second),
        composite=math.hypot(first, second),
        resolution=resolution,
        steepest=max(steepest),
        flattening=0.25 * problem.reduced_modulus * math.hypot(*slopes),
        shortest_wave=waves[axis],
        points_per_wave=fewest,
        points_to_converge=_needed(options, fewest, axis, CONVERGES),
        points_to_resolve=_needed(options, fewest, axis, RESOLVES),
        stands=problem.transient is None,
        waves=tuple(expected_waves(problem, film)),
        remarks=tuple(
            f"{name}: {sentence}"
            for name, one in surfaces.items()
            for sentence in _as_it_passes(one.roughness, problem).fits(*size)
        ),
    )


def _slopes(
    roughness: AnyRoughness, problem: ContactProblem, mesh: tuple[float, float]
) -> tuple[float, float]:
    """Return largest and rms slope of a surface in the contact, as a mesh carries it [-]."""
    if roughness.is_smooth:
        return 0.0, 0.0
    resolved, place = roughness.resolved_on(*mesh), sample_of(roughness, problem)
    heights = np.broadcast_to(resolved.height(*place), (place.y.size, place.x.size))
    slopes = np.gradient(heights, place.y[:, 0], place.x[0])
    squares = np.square(slopes).sum(axis=0)
    return math.sqrt(squares.max()), math.sqrt(squares.mean())


def _as_it_passes(roughness: AnyRoughness, problem: ContactProblem) -> AnyRoughness:
    """Return a surface with its parts in the middle of the contact, if they move through it."""
    if problem.transient is None:
        return roughness
    if isinstance(roughness, Sum):
        parts = tuple(_as_it_passes(part, problem) for part in roughness.parts)
        return roughness.model_copy(update={"parts": parts})
    return roughness.model_copy(update={"x": 0.0}) if hasattr(roughness, "x") else roughness


def _needed(options: Options, fewest: float, axis: int, wanted: int) -> int:
    """Return the nodes per direction that put ``wanted`` of them on the shortest wave."""
    nodes = options.shape[1 - axis]
    intervals = math.ceil((nodes - 1) * wanted / fewest)
    return coarsenable(min(intervals, 2 * MOST_NODES_PER_AXIS))[1]
