"""Rough surfaces before the solve: heights, needed grid, waves, plausibility."""

import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np

from tehl.options import Domain, Options, coarsenable
from tehl.problem import ContactProblem
from tehl.roughness import AnyRoughness, Bump, Dimple, Ridge, WaveVector
from tehl.wave_theory import LinearTheory, expected_waves

CONVERGES, ANSWERS = 8, 16
"""Nodes on the shortest wave with which runs converge, and with which ripples are right to 3 %."""
STEEP = 0.1
"""Slope from which on Reynolds' equation is doubted."""
_SAMPLES = (129, 513)
_LARGEST = 16385


@dataclass(frozen=True, kw_only=True, slots=True)
class Asperities:
    """Heights of the surfaces in a contact and on a grid.

    Attributes
    ----------
    sq : (float, float)
        Root mean square height of each surface where |X|, |Y| < 1; ``rms_roughness`` where a
        smooth surface states it [m].
    composite : float
        Of both [m].
    steepest : float
        Largest slope of the heights [-].
    shortest_wave : float
        Shortest wave along either axis [m].
    points_per_wave : float
        Nodes of the grid on it [-].
    points_to_converge, points_to_answer : int
        Nodes per direction that put 8 and 16 on it.
    stands : bool
        Whether the roughness stands still in the contact.
    waves : tuple of (WaveVector, LinearTheory)
        Stated waves of the surfaces, and their ripples by theory.
    remarks : tuple of str
        Sizes of a surface that do not fit the contact.
    """

    sq: tuple[float, float]
    composite: float
    steepest: float
    shortest_wave: float
    points_per_wave: float
    points_to_converge: int
    points_to_answer: int
    stands: bool
    waves: tuple[tuple[WaveVector, LinearTheory], ...]
    remarks: tuple[str, ...]

    def summary(self) -> dict[str, Any]:
        """Return it as JSON can hold it."""
        waves = [
            {
                "wavelength": wave.wavelength,
                "angle": wave.angle,
                "amplitude": wave.amplitude,
                "film_ratio": theory.film_ratio,
                "pressure": theory.pressure,
                "elastic_pressure": theory.elastic_pressure,
            }
            for wave, theory in self.waves
        ]
        return asdict(self) | {"waves": waves}


def asperities(
    problem: ContactProblem, options: Options, domain: Domain, film: float
) -> Asperities | None:
    """Return heights, needed grid and waves of a case; None where both surfaces are smooth.

    Parameters
    ----------
    problem, options : ContactProblem, Options
        The case.
    domain : Domain
        That of the solve.
    film : float
        Central film to expect [m].

    Raises
    ------
    InputError
        If a measured surface cannot be read.
    """
    if not problem.is_rough:
        return None
    mesh = _mesh(problem, options, domain)
    surfaces = (problem.surface_1, problem.surface_2)
    looks = [_look(one.roughness, problem, mesh) for one in surfaces]
    first, second = (
        look.sq or one.rms_roughness for look, one in zip(looks, surfaces, strict=True)
    )
    waves = [min(pair) for pair in zip(*(look.waves for look in looks), strict=True)]
    counts = [wave / step for wave, step in zip(waves, mesh, strict=True)]
    fewest, axis = min((count, number) for number, count in enumerate(counts))
    return Asperities(
        sq=(first, second),
        composite=math.hypot(first, second),
        steepest=max(look.steepest for look in looks),
        shortest_wave=waves[axis],
        points_per_wave=fewest,
        points_to_converge=_needed(options, fewest, axis, CONVERGES),
        points_to_answer=_needed(options, fewest, axis, ANSWERS),
        stands=problem.transient is None,
        waves=tuple(expected_waves(problem, film)),
        remarks=tuple(_remarks(problem)),
    )


def _mesh(problem: ContactProblem, options: Options, domain: Domain) -> tuple[float, float]:
    """Return the mesh widths of the finest grid [m]."""
    (ny, nx), hertz = options.shape, problem.hertz
    return (
        (domain.x[1] - domain.x[0]) / (nx - 1) * hertz.half_width_x,
        (domain.y[1] - domain.y[0]) / (ny - 1) * hertz.half_width_y,
    )


class _Look(NamedTuple):
    """Sq, largest slope and shortest waves of a surface in the contact, as a mesh carries it."""

    sq: float
    steepest: float
    waves: tuple[float, float]


def _look(roughness: AnyRoughness, problem: ContactProblem, mesh: tuple[float, float]) -> _Look:
    if roughness.is_smooth:
        return _Look(0.0, 0.0, (math.inf, math.inf))
    if problem.transient is not None and isinstance(roughness, Bump | Dimple | Ridge):
        roughness = roughness.model_copy(update={"x": 0.0})  # when it is in the middle
    resolved, hertz = roughness.resolved_on(*mesh), problem.hertz
    widths, waves = (hertz.half_width_x, hertz.half_width_y), resolved.shortest_wavelengths
    finest = max(2.0 * width / wave for width, wave in zip(widths, waves, strict=True))
    count = int(min(max(_SAMPLES[0], ANSWERS * finest), _SAMPLES[1]))
    x, y = (np.linspace(-width, width, count) for width in widths)
    heights = np.broadcast_to(resolved.height(x[None, :], y[:, None]), (count, count))
    slopes = np.hypot(*np.gradient(heights, y, x))
    return _Look(float(np.std(heights)), float(slopes.max()), waves)


def _needed(options: Options, fewest: float, axis: int, wanted: int) -> int:
    """Return the nodes per direction that put ``wanted`` of them on the shortest wave."""
    nodes = options.shape[1 - axis]
    intervals = math.ceil((nodes - 1) * wanted / fewest)
    return coarsenable(min(intervals, 2 * _LARGEST) - 1)[1]


def _remarks(problem: ContactProblem) -> Iterator[str]:
    width, length = 2.0 * problem.hertz.half_width_x, 2.0 * problem.hertz.half_width_y
    for name in ("surface_1", "surface_2"):
        for sentence in getattr(problem, name).roughness.fits(width, length):
            yield f"{name}: {sentence}"


def odd_asperities(
    found: Asperities | None, problem: ContactProblem, options: Options, film: float
) -> Iterator[str]:
    """Yield what is not plausible about rough surfaces, a sentence each.

    Parameters
    ----------
    found : Asperities or None
        As of :func:`asperities`; None yields nothing.
    problem, options : ContactProblem, Options
        The case.
    film : float
        Central film to expect [m].
    """
    if found is None:
        return
    yield from found.remarks
    if found.points_per_wave < CONVERGES:
        yield (
            f"numerics.points = {min(options.shape)}: {found.points_per_wave:.2g} nodes on the "
            f"shortest wave of the surfaces ({found.shortest_wave * 1e6:.3g} um), so a run may not "
            f"converge; {_nodes(found.points_to_converge)} put {CONVERGES} on it, "
            f"{_nodes(found.points_to_answer)} the {ANSWERS} that its ripples need"
        )
    if found.steepest > STEEP:
        yield (
            f"the surfaces have slopes up to {found.steepest:.2g}: Reynolds' equation needs gentle "
            "ones, check the units of height and length"
        )
    if film < found.composite:
        yield (
            f"the film is {film / found.composite:.2g} times Sq: asperities may touch, and the "
            "result shows where there is no film"
        )
    pressures = (t.elastic_pressure if t.pressure is None else t.pressure for _, t in found.waves)
    largest = max(pressures, default=0.0)
    if largest > problem.hertz.pressure:
        yield (
            f"flattening a wave needs {largest / problem.hertz.pressure:.2g} Hertz pressures: its "
            "valleys will cavitate, and a run may not converge"
        )


def _nodes(points: int) -> str:
    return f"more than {_LARGEST} nodes" if points > _LARGEST else f"{points} nodes"
