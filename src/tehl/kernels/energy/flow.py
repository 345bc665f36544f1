"""Flow between the surfaces: velocities, mass fluxes, and the mobility of the Reynolds equation.

The rate of shear is fluidity times stress, ``u_zeta = h phi tau_x``. With the moments about
mid-film ``I0(zeta) = int phi`` and ``I1(zeta) = int phi (zeta - 1/2)`` from surface 1 to zeta,

    u = u1 + h tau_m,x I0 + 12/lambda h^2 p_x I1,      v likewise,

and the mid-film stress of a film that does not thin follows from u = u2, v = v2 at the other wall.
"""

from tehl.base.typing import Record, Records
from tehl.kernels.compiled import helper
from tehl.kernels.energy.laws import exponential, is_uniform
from tehl.kernels.energy.records import Across, Model, Place, Terms, Work
from tehl.kernels.energy.shear import set_thinning, thin
from tehl.kernels.lanes import LANES, Lanes
from tehl.kernels.raw import lanes


@helper
def reach(across: Across, k: int) -> tuple[int, int]:
    """Return the first layer in the band of layer ``k``, and one past the last."""
    return max(k - across.band, 0), min(k + across.band, across.zeta.shape[0] - 1) + 1


@helper
def _fluidities(terms: Terms, layers: Records) -> None:
    """Fill the Newtonian fluidity, one over the viscosity."""
    uniform, fluidity = is_uniform(terms, layers), exponential(-layers[0].ln_eta)
    for k in range(layers.shape[0]):
        here = layers[k]
        if k > 0 and not uniform:
            fluidity = exponential(-here.ln_eta)
        here.fluidity = fluidity
        here.exponent = 1.0


@helper
def moments(across: Across, layers: Records) -> None:
    """Fill ``i0, i1``: integrals of ``integrand``, and of ``integrand`` times zeta - 1/2."""
    i0, i1 = 0.0 * layers[0].integrand, 0.0 * layers[0].integrand
    for k in range(layers.shape[0]):
        first, stop = reach(across, k)
        step0, step1 = 0.0 * i0, 0.0 * i0
        for m in range(first, stop):
            value = layers[m].integrand
            step0 = step0 + across.step[k, m] * value
            step1 = step1 + across.turn[k, m] * value
        i0 = i0 + step0
        i1 = i1 + step1
        here = layers[k]
        here.i0 = i0
        here.i1 = i1


@helper
def moments_of_fluidity(across: Across, layers: Records) -> None:
    """Fill the moments of the fluidity."""
    for k in range(layers.shape[0]):
        here = layers[k]
        here.integrand = here.fluidity
    moments(across, layers)


@helper
def velocities(terms: Terms, line: Record, layers: Records) -> None:
    """Fill the velocities, and the mid-film stress of a block that does not thin."""
    h, p_x, p_y, speed = line.h, line.p_x, line.p_y, line.speed_x
    wall = layers[layers.shape[0] - 1]
    over_i0, tilt = 1.0 / wall.i0, terms.poiseuille * h * wall.i1
    tau_x = (line.slide_x / h - tilt * p_x) * over_i0
    tau_y = -1.0 * tilt * p_y * over_i0
    if not terms.plain:
        tau_y = tau_y + line.slide_y / h * over_i0
    if line.thins[0] == 0.0:
        line.tau_x = tau_x
        line.tau_y = tau_y
    for k in range(layers.shape[0]):
        here = layers[k]
        slope = terms.poiseuille * h * h * here.i1
        here.u = speed + h * tau_x * here.i0 + slope * p_x
        here.v = h * tau_y * here.i0 + slope * p_y
    if not terms.plain:
        for k in range(layers.shape[0]):
            here = layers[k]
            here.v = here.v + line.speed_y


@helper
def flow(model: Model, line: Record, layers: Records, steps: int) -> None:
    """Find stress and velocities of a block at its viscosities.

    Whether a block starts to thin is decided by its Newtonian stress, which is larger.
    """
    x, y = 1.0 * line.tau_x, 1.0 * line.tau_y
    _fluidities(model.terms, layers)
    if not set_thinning(model, line):
        moments_of_fluidity(model.across, layers)
        velocities(model.terms, line, layers)
        if not set_thinning(model, line):
            return
        line.tau_x = x
        line.tau_y = y
    thin(model, line, layers, steps)
    moments_of_fluidity(model.across, layers)
    velocities(model.terms, line, layers)


@helper
def mass_fluxes(across: Across, work: Work, place: Place) -> None:
    """Fill the cumulative mass fluxes ``int_0^zeta h rho u`` along x, and along y."""
    layers, i, j = work.layers[place.block], place.i % 3, LANES * place.block
    h = work.lines[place.block].h
    for k in range(layers.shape[0]):
        here = layers[k]
        dense = h * here.rho
        here.mass_x = dense * here.u
        here.mass_y = dense * here.v
    along, sideways = 0.0 * h, 0.0 * h
    for k in range(layers.shape[0]):
        first, stop = reach(across, k)
        east, north = 0.0 * h, 0.0 * h
        for m in range(first, stop):
            east = east + across.step[k, m] * layers[m].mass_x
            north = north + across.step[k, m] * layers[m].mass_y
        along = along + east
        sideways = sideways + north
        work.mass[i, k, lanes(j)] = along
        work.mass_y[k, lanes(j + 1)] = sideways


@helper
def complete_mass(terms: Terms, work: Work, i: int) -> None:
    """Fill the ghost rows of the mass flux, and at the first two stations those before the grid."""
    mass, mass_y = work.mass, work.mass_y
    _, n, ny = mass.shape
    for k in range(n):
        first, second = mass_y[k, 1], mass_y[k, 2]
        mass_y[k, 0] = -second if terms.mirror else 2.0 * first - second
        mass_y[k, ny + 1] = 2.0 * mass_y[k, ny] - mass_y[k, ny - 1]
        if terms.period > 0:
            mass_y[k, 0] = mass_y[k, terms.period]
            mass_y[k, terms.period + 2] = second
    if i > 1:
        return
    here, last, before = i % 3, (i + 2) % 3, (i + 1) % 3
    for k in range(n):
        for j in range(0, ny, LANES):
            rows = lanes(j)
            if i == 0:
                mass[last, k, rows] = mass[here, k, rows]
            mass[before, k, rows] = 2.0 * mass[last, k, rows] - mass[here, k, rows]


@helper
def cross_flow(model: Model, work: Work, place: Place) -> None:
    """Fill ``through`` with rho omega, the mass flux through the layers.

    ``rho omega = -(h int rho u)_x - (h int rho v)_y/kappa`` less zeta times its value at the other
    wall, so that it vanishes at both.
    """
    layers, terms, zeta = work.layers[place.block], model.terms, model.across.zeta
    n, i, j, line = layers.shape[0], place.i, LANES * place.block, work.lines[place.block]
    end = 0.0 * layers[0].through
    for k in range(n):
        now = work.mass[i % 3, k, lanes(j)]
        old, older = work.mass[(i + 2) % 3, k, lanes(j)], work.mass[(i + 1) % 3, k, lanes(j)]
        sideways = work.mass_y[k, lanes(j + 2)] - work.mass_y[k, lanes(j)]
        end = -terms.over_x * (terms.w0 * now + terms.w1 * old + terms.w2 * older)
        end = end - 0.5 * line.over_y * sideways
        here = layers[k]
        here.through = end
    for k in range(n):
        here = layers[k]
        here.through = here.through - zeta[k] * end


@helper
def mobility(across: Across, layers: Records) -> Lanes:
    """Return the generalised mobility ``12 (eta_e rho'_e/eta'_e - rho''_e)``.

    Yang and Wen 1990, equation of the generalised mobility, with moments about mid-film, which
    avoid cancellation.
    """
    wall = layers[layers.shape[0] - 1]
    tilt = wall.i1 / wall.i0
    total = 0.0 * tilt
    for k in range(layers.shape[0]):
        here = layers[k]
        weight = 12.0 * across.weights[k]
        total = total + weight * here.rho * (tilt * here.i0 - here.i1)
    return total
