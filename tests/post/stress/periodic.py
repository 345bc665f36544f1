"""Stress of a half-space under loads that repeat along x and y, by their Fourier series."""

import numpy as np
from scipy.fft import fft2, fftfreq, ifft2

from tehl.base.typing import Array


def periodic_stresses(
    loads: tuple[Array, Array, Array],
    lengths: tuple[float, float],
    depth: float,
    poisson_ratio: float,
) -> Array:
    r"""Return the six components of the stress at a depth, (6, ny, nx), in the unit of the loads.

    With :math:`\zeta^2 = \alpha^2 + \beta^2` each harmonic decays as :math:`e^{-\zeta z}` (Tripp,
    Van Kuilenburg, Morales-Espejel and Lugt 2003). Under a mean pressure the body cannot expand
    sideways.

    Parameters
    ----------
    loads : three (ny, nx) arrays
        Pressure, and traction on the body along x and along y, of one period without its last node.
    lengths : (float, float)
        Period along y and x.
    depth : float
        In the unit of ``lengths``.
    poisson_ratio : float
        Of the body.
    """
    nu, (ny, nx) = poisson_ratio, loads[0].shape
    beta = 2.0 * np.pi * fftfreq(ny, lengths[0] / ny)[:, None]
    alpha = 2.0 * np.pi * fftfreq(nx, lengths[1] / nx)[None, :]
    zeta = np.hypot(alpha, beta)
    zeta[0, 0] = 1.0
    p, qx, qy = (fft2(load) for load in loads)
    a, b, zd = alpha / zeta, beta / zeta, zeta * depth
    along = 1j * (a * qx + b * qy)  # divergence of the traction over zeta
    turn = 2.0 * nu * (p - along)
    bend = zd * (p - along)
    cross = 1j * (qy * a + qx * b)
    stress = np.array(
        [
            (bend - p) * a * a - turn * b * b + 2.0j * a * qx,
            (bend - p) * b * b - turn * a * a + 2.0j * b * qy,
            -p - bend,
            a * b * (bend - p + turn) + cross,
            1j * b * bend - qy,
            1j * a * bend - qx,
        ]
    )
    stress *= np.exp(-zd)
    side = -nu / (1.0 - nu) * p[0, 0]
    stress[:, 0, 0] = side, side, -p[0, 0], 0.0, -qy[0, 0], -qx[0, 0]
    return np.asarray(ifft2(stress).real)
