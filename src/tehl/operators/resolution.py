"""Which part of the heights of rough surfaces a grid carries.

Waves that are short for a grid, and for the steps of a transient run, are filtered off measured and
random surfaces; formulas are carried whole.
"""

import math
from typing import NamedTuple

import numpy as np

from tehl.base.typing import Array
from tehl.contact.problem import ContactProblem
from tehl.estimate.duration import components
from tehl.roughness import AnyRoughness, Roughness
from tehl.roughness.resolution import Resolution

_SAMPLES_PER_AXIS = 513


class Sample(NamedTuple):
    """Places in a square around the contact, or around what passes it: x and y [m]."""

    x: Array
    y: Array


def resolution_of(problem: ContactProblem, mesh: tuple[float, float]) -> Resolution | None:
    """Return Sq and Sa of surfaces in the contact, and Sq on a mesh; None where both are smooth.

    Parameters
    ----------
    problem : ContactProblem
        Its surfaces are sampled within the Hertz half-widths.
    mesh : (float, float)
        Mesh widths along x and y [m].

    Raises
    ------
    InputError
        If a measured surface cannot be read.
    """
    if not problem.is_rough:
        return None
    found = [
        _one(surface.roughness, problem, (_along(problem, number, mesh[0]), mesh[1]))
        for number, surface in enumerate(problem.surfaces, start=1)
    ]
    sq, sa, kept = zip(*found, strict=True)
    return Resolution(sq=sq, sa=sa, kept=kept)


def _along(problem: ContactProblem, number: int, step: float) -> float:
    """Return the distance of heights along x that grid and time steps resolve [m]."""
    if problem.transient is None:
        return step
    moved = abs(problem.motion.speed_of(number)) / problem.entrainment_speed
    return step * max(problem.transient.stride * moved, 1.0)


def _one(
    roughness: AnyRoughness, problem: ContactProblem, mesh: tuple[float, float]
) -> tuple[float, float, float]:
    """Return Sq and Sa of a surface, and Sq of what a mesh carries of it [m]."""
    if roughness.is_smooth:
        return 0.0, 0.0, 0.0
    place = sample_of(roughness, problem)
    resolved = roughness.resolved_on(*mesh)
    sq, heights = _sq(roughness, place), _heights(roughness, place)
    sa = float(np.abs(heights - heights.mean()).mean()) if sq else 0.0
    return sq, sa, sq if resolved is roughness else min(_sq(resolved, place), sq)


def sample_of(roughness: AnyRoughness, problem: ContactProblem) -> Sample:
    """Return places where a surface lies in the contact, or passes it in a transient run.

    They are uniform but for random shifts, so that no wave is aliased to a constant.

    Parameters
    ----------
    roughness : AnyRoughness
        Surface at time zero; of several positions the one with the largest Sq counts.
    problem : ContactProblem
        Its Hertz half-widths bound the sample [m].
    """
    half = (problem.hertz.half_width_x, problem.hertz.half_width_y)
    if problem.contact.is_line:  # its heights are those at y = 0
        half = half[0], 1e-6 * half[0]
    shifts = np.random.default_rng(0).random((2, _SAMPLES_PER_AXIS))
    x, y = (
        width * (2.0 * (np.arange(_SAMPLES_PER_AXIS) + shift) / _SAMPLES_PER_AXIS - 1.0)
        for width, shift in zip(half, shifts, strict=True)
    )
    samples = [Sample(x[None, :] + centre, y[:, None]) for centre in _centres(roughness, problem)]
    if len(samples) == 1:
        return samples[0]
    return max(samples, key=lambda one: _sq(roughness, one))


def _centres(roughness: AnyRoughness, problem: ContactProblem) -> list[float]:
    """Return the middles along x of what passes the contact: the origin in a steady case [m]."""
    if problem.transient is None:
        return [0.0]
    extents = (part.extent(problem.hertz.half_width_y)[0] for part in components(roughness))
    middles = {0.5 * sum(ends) if math.isfinite(sum(ends)) else 0.0 for ends in extents}
    return sorted(middles)[:8] or [0.0]


def _sq(roughness: Roughness, place: Sample) -> float:
    found = float(np.std(_heights(roughness, place)))
    return found if found > 1e-13 else 0.0  # it is flat


def _heights(roughness: Roughness, place: Sample) -> Array:
    return np.broadcast_to(roughness.height(*place), (_SAMPLES_PER_AXIS, _SAMPLES_PER_AXIS))
