"""Rough surfaces before the solve: heights, needed grid, waves."""

import math
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np

from tehl.options import Options, coarsenable
from tehl.problem import ContactProblem
from tehl.roughness import AnyRoughness, WaveVector
from tehl.roughness.features import FeatureModel
from tehl.wave_theory import LinearTheory, expected_waves

CONVERGES, RESOLVES = 8, 16
"""Nodes on the shortest wave with which runs converge, and with which ripples are right to 3 %."""
LARGEST = 16385
"""Nodes per direction beyond which no number is proposed."""
_SAMPLES = (129, 513)
_THEORY = ("film_ratio", "pressure", "elastic_pressure")


@dataclass(frozen=True, kw_only=True, slots=True)
class Asperities:
    """Heights of the surfaces in a contact and on a grid."""

    sq: tuple[float, float]
    """Root mean square height of each surface where |X|, |Y| < 1; ``rms_roughness`` where a smooth
    surface states it [m]."""
    composite: float
    """Of both [m]."""
    steepest: float
    """Largest slope of the heights [-]."""
    shortest_wave: float
    """Shortest wave along either axis [m]."""
    points_per_wave: float
    """Nodes of the grid on it [-]."""
    points_to_converge: int
    points_to_answer: int
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
        return asdict(self) | {"waves": waves}


def asperities(
    problem: ContactProblem, options: Options, mesh: tuple[float, float], film: float
) -> Asperities | None:
    """Return heights, needed grid and waves of a case; None where both surfaces are smooth.

    Parameters
    ----------
    problem, options : ContactProblem, Options
        The case.
    mesh : (float, float)
        Mesh widths of the finest grid along x and y [m].
    film : float
        Central film to expect [m].

    Raises
    ------
    InputError
        If a measured surface cannot be read.
    """
    if not problem.is_rough:
        return None
    surfaces = {"surface_1": problem.surface_1, "surface_2": problem.surface_2}
    looks = [_look(one.roughness, problem, mesh) for one in surfaces.values()]
    first, second = (
        look.sq or one.rms_roughness for look, one in zip(looks, surfaces.values(), strict=True)
    )
    waves = [min(pair) for pair in zip(*(look.waves for look in looks), strict=True)]
    counts = [wave / step for wave, step in zip(waves, mesh, strict=True)]
    fewest, axis = min((count, number) for number, count in enumerate(counts))
    size = (2.0 * problem.hertz.half_width_x, 2.0 * problem.hertz.half_width_y)
    return Asperities(
        sq=(first, second),
        composite=math.hypot(first, second),
        steepest=max(look.steepest for look in looks),
        shortest_wave=waves[axis],
        points_per_wave=fewest,
        points_to_converge=_needed(options, fewest, axis, CONVERGES),
        points_to_answer=_needed(options, fewest, axis, RESOLVES),
        stands=problem.transient is None,
        waves=tuple(expected_waves(problem, film)),
        remarks=tuple(
            f"{name}: {sentence}"
            for name, one in surfaces.items()
            for sentence in one.roughness.fits(*size)
        ),
    )


class _Look(NamedTuple):
    """Sq, largest slope and shortest waves of a surface in the contact, as a mesh carries it."""

    sq: float
    steepest: float
    waves: tuple[float, float]


def _look(roughness: AnyRoughness, problem: ContactProblem, mesh: tuple[float, float]) -> _Look:
    if roughness.is_smooth:
        return _Look(0.0, 0.0, (math.inf, math.inf))
    if problem.transient is not None and isinstance(roughness, FeatureModel):
        roughness = roughness.model_copy(update={"x": 0.0})  # when it is in the middle
    resolved, hertz = roughness.resolved_on(*mesh), problem.hertz
    widths, waves = (hertz.half_width_x, hertz.half_width_y), resolved.shortest_wavelengths
    finest = max(2.0 * width / wave for width, wave in zip(widths, waves, strict=True))
    count = int(min(max(_SAMPLES[0], RESOLVES * finest), _SAMPLES[1]))
    x, y = (np.linspace(-width, width, count) for width in widths)
    heights = np.broadcast_to(resolved.height(x[None, :], y[:, None]), (count, count))
    slopes = np.hypot(*np.gradient(heights, y, x))
    return _Look(float(np.std(heights)), float(slopes.max()), waves)


def _needed(options: Options, fewest: float, axis: int, wanted: int) -> int:
    """Return the nodes per direction that put ``wanted`` of them on the shortest wave."""
    nodes = options.shape[1 - axis]
    intervals = math.ceil((nodes - 1) * wanted / fewest)
    return coarsenable(min(intervals, 2 * LARGEST) - 1)[1]
