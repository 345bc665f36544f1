"""Reynolds equation on one grid: the stencil and what the line relaxation needs of the kernel."""

import numpy as np

from tehl.grid import Grid
from tehl.kernels.reynolds import Mesh
from tehl.operators.influence import Influence
from tehl.scaling import Groups
from tehl.typing import Array

REACH = 8


def stencil(grid: Grid, groups: Groups, wedge_order: int) -> Mesh:
    """Return the weights of the discrete Reynolds operator.

    The Poiseuille term is central, of order two; the wedge is taken upstream to order
    ``wedge_order`` (1 or 2).
    """
    weights = {1: (1.0, -1.0, 0.0), 2: (1.5, -2.0, 0.5)}[wedge_order]
    w0, w1, w2 = (w / grid.dx for w in weights)
    return Mesh(
        cx=1.0 / grid.dx**2,
        cy=1.0 / (groups.ellipticity * grid.dy) ** 2,
        w0=w0,
        w1=w1,
        w2=w2,
        mirror=int(grid.mirror),
    )


def step_stencil(mesh: Mesh, time_step: float) -> Mesh:
    """Return the weights of a step of time.

    Wedge and squeeze are one derivative along the mean motion of both surfaces, backward of order
    two: three halves of rho h here and now, less what was upstream one and two steps ago. Of that
    only the first is unknown. On coarser grids it keeps its weight, as the step keeps its length.

    Parameters
    ----------
    mesh : Mesh
        The weights of the steady operator.
    time_step : float
        In units of a_x / u_m [-].
    """
    return mesh._replace(w0=1.5 / time_step, w1=0.0, w2=0.0)


def upstream(field: Array, nodes: int) -> Array:
    """Return the values ``nodes`` upstream of each node; before the first one it goes on linearly.

    Parameters
    ----------
    field : (ny, nx) array
        Mass rho h of a film [-].
    nodes : int
        Mesh widths along x.
    """
    shifted = np.empty_like(field)
    shifted[:, nodes:] = field[:, :-nodes]
    before = np.arange(-nodes, 0.0)
    shifted[:, :nodes] = field[:, :1] + before * (field[:, 1:2] - field[:, :1])
    return shifted


def steady_wedge(mass: Array, spacing: float, order: int) -> Array:
    """Return the upstream difference of a mass rho h along x, of the order of the steady film."""
    if order == 1:
        return (mass - upstream(mass, 1)) / spacing
    return (1.5 * mass - 2.0 * upstream(mass, 1) + 0.5 * upstream(mass, 2)) / spacing


def line_influence(influence: Influence) -> tuple[Array, Array]:
    """Return the film along a line per unit change of one node, and of a dipole.

    A dipole raises one node and lowers its four neighbours by a quarter, so that its far field
    falls off fast: the change of film stays local.
    """
    line = influence(0, slice(0, REACH + 1))
    beside = influence(1, slice(0, REACH))
    point = line[:REACH]
    west = line[[1, *range(REACH - 1)]]
    dipole = point - 0.25 * (west + line[1:] + 2.0 * beside)
    return point.copy(), dipole
