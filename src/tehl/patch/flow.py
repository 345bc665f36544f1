"""Flow through the gap of a periodic patch, by pressure and by sliding.

    div(g^3 grad p) = 0,   p - x periodic,   phi_x = mean(g^3 p_x) / mean(g)^3

and the same along y, with the harmonic mean of g^3 on each face: nothing flows through contacts.
Where the rough surface slides over a smooth one, without a mean pressure gradient,

    div(g^3 grad p) = -g_x,   p periodic,   phi_s = -mean(g^3 p_x),

and the flux g + g^3 p_x through a face is that through both half cells one after the other.
"""

from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import splu

from tehl.base.typing import Array


class Flow(NamedTuple):
    """Mean flow through a gap."""

    along: float
    across: float
    """Flux along x and along y per unit gradient of the pressure [gap^3]."""
    carried: float
    """Flux along x beside that of the mean gap, over (u_1 - u_2)/2 of a rough surface 1 [gap]."""


def flow_through(gap: Array, pixel: tuple[float, float]) -> Flow:
    """Return the mean flow through one period of a gap.

    Parameters
    ----------
    gap : (ny, nx) array
        One period of the gap, not negative.
    pixel : (float, float)
        Distances dx, dy.
    """
    cubed = gap**3
    cubed = np.maximum(cubed, 1e-9 * cubed.mean())  # so that closed pools have a pressure
    gap = np.cbrt(cubed)
    (dx, dy), size = pixel, gap.size
    nodes = np.arange(size).reshape(gap.shape)
    rows, columns, values = [], [], []
    faces = []
    for axis, width in ((1, dx), (0, dy)):
        next_ = np.roll(cubed, -1, axis)
        face = 2.0 * cubed * next_ / (cubed + next_)
        here, there = nodes.ravel(), np.roll(nodes, -1, axis).ravel()
        weight = face.ravel() / width**2
        rows += [here, there, here, there]
        columns += [there, here, here, there]
        values += [weight, weight, -weight, -weight]
        faces.append(face)
    matrix = csr_matrix(
        (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), (size, size)
    )
    solver = splu(matrix[1:, 1:].tocsc())  # the pressure of one node is zero

    def flux(axis: int, width: float, face: Array, driven: Array) -> float:
        """Return the mean of a driven flux and the pressure flow that makes it free of sources."""
        source = (driven - np.roll(driven, 1, axis)) / width
        free = np.append(0.0, solver.solve(-source.ravel()[1:])).reshape(gap.shape)
        return float((driven + face * (np.roll(free, -1, axis) - free) / width).mean())

    along, across = faces
    dragged = 0.5 * along * (gap**-2.0 + np.roll(gap, -1, 1) ** -2.0)
    return Flow(
        along=flux(1, dx, along, along),
        across=flux(0, dy, across, across),
        carried=float(gap.mean()) - flux(1, dx, along, dragged),
    )
