"""Compiled point Gauss-Seidel relaxation of pressure, as a textbook would first try it.

Each node in turn is moved to make its own residual vanish, with the film of the last evaluation.
It smooths where the conductance is large and fails where the deflection rules.
"""

from numba import njit

from tehl.kernels.reynolds import Film, Mesh
from tehl.typing import Array


@njit(cache=True)
def relax_points(film: Film, mesh: Mesh, rhs: Array, self_film: Array, omega: float) -> None:
    """Sweep once in marching order; ``self_film[m]`` is the film at distance m per unit p."""
    ny, nx = film.p.shape
    p, eps_x, eps_y = film.p, film.eps_x, film.eps_y
    for j in range(0 if mesh.mirror else 1, ny - 1):
        south = j - 1 if j > 0 else 1
        for i in range(1, nx - 1):
            east = 0.5 * mesh.cx * (eps_x[j, i] + eps_x[j, i + 1])
            west = 0.5 * mesh.cx * (eps_x[j, i] + eps_x[j, i - 1])
            north = 0.5 * mesh.cy * (eps_y[j, i] + eps_y[j + 1, i])
            below = 0.5 * mesh.cy * (eps_y[j, i] + eps_y[south, i])
            mass = film.rho[j, i] * film.h[j, i]
            mass_w = film.rho[j, i - 1] * film.h[j, i - 1]
            if i == 1:
                wedge = (mesh.w0 - mesh.w2) * mass + (mesh.w1 + 2.0 * mesh.w2) * mass_w
            else:
                mass_ww = film.rho[j, i - 2] * film.h[j, i - 2]
                wedge = mesh.w0 * mass + mesh.w1 * mass_w + mesh.w2 * mass_ww
            flow = (
                east * (p[j, i + 1] - p[j, i])
                + west * (p[j, i - 1] - p[j, i])
                + north * (p[j + 1, i] - p[j, i])
                + below * (p[south, i] - p[j, i])
            )
            r = rhs[j, i] - flow + wedge
            slope = -(east + west + north + below)
            slope -= mesh.w0 * film.rho[j, i] * self_film[0]
            slope -= mesh.w1 * film.rho[j, i - 1] * self_film[1]
            p[j, i] = max(p[j, i] + omega * r / slope, 0.0)
