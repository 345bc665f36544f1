"""Arguments and scratch of the kernels of the energy equation.

Unlike elsewhere y is the last axis: the sweep marches along x and treats all rows of a station
alike. Dimensionless, except for temperatures [K].
"""

from typing import NamedTuple

import numpy as np

from tehl.base.typing import Array, Records
from tehl.kernels.lanes import LANES

GHOSTS = 2
"""Ghost stations and rows on each side of the temperature."""
BLOCK = LANES
"""Rows per block."""
ETA_TERMS, RHO_TERMS = 16, 8
"""Coefficients of the polynomials in temperature."""
TERMS = ETA_TERMS + RHO_TERMS

LINE = np.dtype(
    [
        (name, np.float64, (LANES,))
        for name in (
            *("p", "h", "p_x", "p_y", "p_t", "capacity", "conductivity", "h2_over_k", "over_scale"),
            *("climb_x", "climb_y", "sheared", "tau_x", "tau_y", "thins", "excess_y", "pull"),
            *("slide_x", "slide_y", "speed_x", "speed_y", "over_y"),
        )
    ]
    + [("terms", np.float64, (TERMS, LANES))]
)
"""A block of rows: pressure, film, slopes of the pressure along x, y and in time, heat capacity and
conductivity over those at ambient pressure, h^2/k, one over the stress scale; slopes that compress;
part of the shear heat; mid-film stress; whether the oil thins; largest relative excess of the
tangent fluidity along y; sum of share times temperature; (u2 - u1)/u_m and u1/u_m at these places,
both components; one over the distance of rows; coefficients of the laws at these pressures."""
LAYER = np.dtype(
    [
        (name, np.float64, (LANES,))
        for name in (
            *("t", "new_t", "ln_eta", "slope", "rho", "rho_t", "u", "v", "through"),
            *("fluidity", "exponent", "tangent_x", "tangent_y", "integrand", "i0", "i1"),
            *("mass_x", "mass_y", "share", "sideways"),
        )
    ]
)
"""A layer of a block: temperature and the new one (later the change), ln eta and -dln(eta)/dT,
density and its slope, velocities along x and y, mass flux rho omega through the layer; fluidity,
n = dln(rate)/dln(stress), fluidities of a small change along x and y; moments of ``integrand``
from the wall to here; mass fluxes; share in the fall of the stress; convection along y."""
T, NEW_T, SIDEWAYS = ((LAYER.names or ()).index(name) for name in ("t", "new_t", "sideways"))


class Across(NamedTuple):
    """Nodes across the film and the matrices that differentiate and integrate.

    ``zeta`` (n,), ``d1, d2`` (n, n) first and second derivative, ``step[k]`` weights of the
    integral from node k-1 to k, ``turn[k]`` those of the integral of a function times
    ``zeta - 1/2``, ``weights`` of the integral from 0 to 1; ``band`` is the half-bandwidth of these
    matrices.
    """

    zeta: Array
    d1: Array
    d2: Array
    step: Array
    turn: Array
    weights: Array
    band: int


class Laws(NamedTuple):
    """Tables of the lubricant.

    ``fluid`` (rows, 2, TERMS): over ln(1 + per_scale p) the coefficients, and their slopes times
    the step, of ln eta as a polynomial in ``(1/(T - pole) - middle) over_inverse`` and of rho in
    ``(T - inlet) over_rise``, for T of ``coldest`` to ``hottest``. ``thinning`` (rows, 2): ln F
    and its slope times the step over s/(1 + s), ``per_stress`` rows per unit. ``last_row,
    last_stress``: rows where the last interval of either begins. ``newtonian_limit`` is the
    dimensionless stress below which ln F is negligible; ``newtonian`` is 1 if it always is,
    ``uniform`` if the stress at mid-film determines the thinning of all layers, with ``most`` the
    largest such stress. ``knee``: the part of a limiting stress from which on ln F is a straight
    line, 0 of other laws.
    """

    fluid: Array
    per_scale: float
    per_row: float
    pole: float
    middle: float
    over_inverse: float
    inlet: float
    over_rise: float
    coldest: float
    hottest: float
    thinning: Array
    per_stress: float
    last_row: int
    last_stress: int
    newtonian_limit: float
    newtonian: int
    uniform: int
    most: float
    knee: float


class Terms(NamedTuple):
    """Dimensionless numbers of the equations.

    ``peclet, compression, brinkman``: factors of convection, compression and shear heat;
    ``poiseuille`` is 12/lambda; ``slide, slide_y`` (u2 - u1)/u_m and ``speed, speed_y`` u1/u_m at
    the centre; ``spin`` (omega_2 - omega_1) a_x/u_m, ``spin_1`` that of surface 1; ``plain`` 1
    where all of it is along x; ``over_x, over_y`` 1/dx and the mean 1/(kappa dy); ``over_t`` weight
    of the present in the time derivative, 0 if steady; ``w0, w1, w2`` upstream weights; ``mirror``
    whether row 0 is a symmetry line; ``period`` rows after which the film wraps, zero if it does
    not; ``mean`` 0 local properties, 1 mean ones in Reynolds, 2 mean
    ones everywhere; ``inlet`` temperature; ``heat`` 0 keeps the temperature.
    """

    peclet: float
    compression: float
    brinkman: float
    poiseuille: float
    slide: float
    slide_y: float
    speed: float
    speed_y: float
    spin: float
    spin_1: float
    plain: int
    over_x: float
    over_y: float
    over_t: float
    w0: float
    w1: float
    w2: float
    mirror: int
    period: int
    mean: int
    inlet: float
    heat: int


class Model(NamedTuple):
    """Constants of a run: nodes across the film, laws and dimensionless numbers."""

    across: Across
    laws: Laws
    terms: Terms


class Surface(NamedTuple):
    """One surface and the line source that heats it.

    Its temperature is ``bulk`` (nx, ny) plus ``factor`` times the integral of the flux over the
    root of the distance, with the weights of `tehl.operators.line_source.History`; ``factor`` is
    zero if ``bulk`` is the whole temperature. ``slowness`` (ny,) is the root of the speed along x
    at the centre over that of the row. ``flux`` (nx + 4, ny) into the surface is output.
    """

    bulk: Array
    factor: float
    slowness: Array
    near: float
    next_: float
    decay: Array
    older: Array
    newer: Array
    flux: Array


class Surfaces(NamedTuple):
    """Both surfaces: the lower wall, zeta = 0, and the upper one."""

    first: Surface
    second: Surface


class Fields(NamedTuple):
    """Fields of the film.

    In: places ``x`` (nx,) and ``y`` (ny,) in a_x; ``closer`` (ny,) mean distance of rows over that
    here; ``p, h`` (nx, ny); ``px, py`` slopes of the
    pressure that drive the flow, ``climb_x, climb_y`` those that compress the oil; ``capacity,
    conductivity`` ratios to those at ambient pressure, ``over_scale`` one over the stress scale,
    ``sheared`` 1, or 0 where surfaces rub in place of the oil. In and out:
    ``temperature`` (nx + 4, n, ny + 4), ``step`` (nx, ny) its last mean change across the film,
    ``tau_x, tau_y`` mid-film stress (nx, ny). In, in a
    transient run: ``past`` (nx, n, ny) contribution of former temperatures to the time derivative,
    ``pressing`` (nx, ny) time derivative of the pressure. Out: ``mobility, density`` of the
    Reynolds equation, ``mean_density`` across the film, ``odd_density`` (nx, ny) what sliding adds
    to it per slide, where not all is along x, ``enthalpy_x, enthalpy_y`` fluxes, ``shear, work``
    powers, ``effective`` viscosity ratio, ``over_exponent`` 1/n at mid-film (`Heated`),
    ``stretch_x, stretch_y``: mobility of a small change along x or y over ``mobility``.
    """

    x: Array
    y: Array
    closer: Array
    p: Array
    h: Array
    px: Array
    py: Array
    climb_x: Array
    climb_y: Array
    capacity: Array
    conductivity: Array
    over_scale: Array
    sheared: Array
    temperature: Array
    step: Array
    tau_x: Array
    tau_y: Array
    mobility: Array
    density: Array
    mean_density: Array
    odd_density: Array
    enthalpy_x: Array
    enthalpy_y: Array
    shear: Array
    work: Array
    effective: Array
    over_exponent: Array
    stretch_x: Array
    stretch_y: Array
    past: Array
    pressing: Array


class Work(NamedTuple):
    """Scratch of one station.

    ``lines`` (blocks,) and ``layers`` (blocks, n): records `LINE` and `LAYER`; ``numbers`` (blocks,
    n, fields, BLOCK) is a view of ``layers``; ``matrix`` (n, n, BLOCK) and ``rhs`` (n, BLOCK): the
    columns of a block; ``terms`` (BLOCK, TERMS): coefficients of the laws. ``mass`` (3, n, ny):
    cumulative mass flux along x at the last three stations, ``mass_y`` (n, ny + 2) that along y
    here with a ghost row on each side; ``modes`` (2, m, ny): the exponentials of both surfaces;
    ``changes`` (n,) of the row before; ``change`` (BLOCK,): largest change of temperature; ``back``
    (1,): number of stations up to the last one with backflow.
    """

    lines: Records
    layers: Records
    numbers: Array
    matrix: Array
    rhs: Array
    terms: Array
    mass: Array
    mass_y: Array
    modes: Array
    changes: Array
    change: Array
    back: Array


class Place(NamedTuple):
    """One block of rows of one station."""

    i: int
    block: int


def scratch(nodes: int, rows: int, modes: int) -> Work:
    """Return the scratch for these numbers of nodes across the film, rows and exponentials."""
    blocks = rows // BLOCK
    numbers = np.zeros((blocks, nodes, len(LAYER.names or ()), BLOCK))
    return Work(
        lines=np.zeros(blocks, LINE).view(np.recarray),
        layers=numbers.reshape(blocks, nodes, -1).view(LAYER)[..., 0].view(np.recarray),
        numbers=numbers,
        matrix=np.zeros((nodes, nodes, BLOCK)),
        rhs=np.zeros((nodes, BLOCK)),
        terms=np.zeros((BLOCK, TERMS)),
        mass=np.zeros((3, nodes, rows)),
        mass_y=np.zeros((nodes, rows + 2)),
        modes=np.zeros((2, modes, rows)),
        changes=np.zeros(nodes),
        change=np.zeros(BLOCK),
        back=np.zeros(1),
    )
