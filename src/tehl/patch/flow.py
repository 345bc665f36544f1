"""Flow through the gap of a periodic patch: what it conducts over a smooth gap of the same mean.

    div(g^3 grad p) = 0,   p - x periodic,   phi_x = mean(g^3 p_x) / mean(g)^3

and the same along y, with the harmonic mean of g^3 on each face: nothing flows through contacts.
"""

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import splu

from tehl.typing import Array

LEAST = 1e-9
"""Least g^3 over its mean, so that closed pools have a pressure."""


def conducted(gap: Array, pixel: tuple[float, float]) -> tuple[float, float]:
    """Return the mean flux along x and along y per unit gradient of the pressure.

    Parameters
    ----------
    gap : (ny, nx) array
        One period of the gap, not negative.
    pixel : (float, float)
        Distances dx, dy.
    """
    cubed = gap**3
    cubed = np.maximum(cubed, LEAST * cubed.mean())
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
    found = []
    for axis, width, face in ((1, dx, faces[0]), (0, dy, faces[1])):
        source = (face - np.roll(face, 1, axis)) / width
        free = np.append(0.0, solver.solve(-source.ravel()[1:])).reshape(gap.shape)
        slope = 1.0 + (np.roll(free, -1, axis) - free) / width
        found.append(float((face * slope).mean()))
    return found[0], found[1]
