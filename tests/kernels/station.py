"""The energy equation of the film in plain numpy: one sweep, station after station.

Read this file first: the kernels of `tehl.kernels.energy` compute the same, eight rows at a time.
The equations are those of docs/theory/thermal.md; with the scales there the pressure gradient has
the factor 12/lambda in stress and velocities. Arrays are (n, rows): layers from surface 1
(zeta = 0) to surface 2, and rows along y. Not here: the march back against x, and a film that only
thins (``terms.heat`` = 0). Nothing here is fast.
"""

from dataclasses import dataclass

import numpy as np
from numpy.polynomial.polynomial import polyder, polyval

from tehl.base.typing import Array
from tehl.kernels.energy.column import CONDUCTION
from tehl.kernels.energy.march import (
    LARGEST_FALL,
    LARGEST_FLUIDITY_GROWTH,
    LARGEST_KELVIN_STEP,
    SWINGING_KELVIN,
    SWINGING_PART,
    UNDONE,
    UNDONE_KELVIN,
)
from tehl.kernels.energy.records import ETA_TERMS, GHOSTS, Across, Fields, Laws, Model, Surfaces
from tehl.kernels.energy.shear import LARGEST_THINNING


@dataclass
class Station:
    """What is given at the rows of a station, and what is found: stress and temperature."""

    p: Array  # pressure
    h: Array  # film
    px: Array  # slopes of the pressure along x, along y over kappa, and in time
    py: Array
    climb_x: Array  # those that compress
    climb_y: Array
    pt: Array
    capacity: Array  # rho_0 c and k of the oil over those at ambient pressure
    conductivity: Array
    over_scale: Array  # one over the stress scale of the shear law
    tau_x: Array  # stress at mid-film, found
    tau_y: Array
    slide: tuple[Array, Array]  # (u2 - u1)/u_m and u1/u_m at these places, both components
    speed: tuple[Array, Array]
    t: Array  # temperature (n, rows) [K], found
    step: Array | float = 0.0  # its last mean change


# The oil


def cubic(table: Array, x: Array, last: int) -> tuple[Array, list[Array]]:
    """Return position and coefficients of the Hermite cubics between rows (value, slope)."""
    row = np.clip(x.astype(int), 0, last)
    (a, b), (c, d) = np.moveaxis(table[row], x.ndim, 0), np.moveaxis(table[row + 1], x.ndim, 0)
    return x - row, [a, b, 3.0 * (c - a) - 2.0 * b - d, b + d - 2.0 * (c - a)]


def properties(laws: Laws, p: Array, t: Array) -> tuple[Array, Array, Array, Array]:
    """Return ln eta, gamma = -dln(eta)/dT, rho and drho/dT: polynomials in temperature.

    Their coefficients are interpolated over the pressure.
    """
    x = np.log(1.0 + laws.per_scale * p) * laws.per_row
    position, parts = cubic(laws.fluid, x, laws.last_row)
    terms = polyval(position[:, None], np.array(parts), tensor=False).T
    inverse = 1.0 / (t - laws.pole)
    of_eta, of_rho = (inverse - laws.middle) * laws.over_inverse, (t - laws.inlet) * laws.over_rise
    eta, rho = terms[:ETA_TERMS], terms[ETA_TERMS:]
    ln_eta, slope = (polyval(of_eta, c[:, None, :], tensor=False) for c in (eta, polyder(eta)))
    density, rise = (polyval(of_rho, c[:, None, :], tensor=False) for c in (rho, polyder(rho)))
    return ln_eta, slope * inverse**2 * laws.over_inverse, density, rise * laws.over_rise


def thinning(laws: Laws, s: Array) -> tuple[Array, Array]:
    """Return F, Newtonian over effective viscosity at a stress s, and dln F/dln s."""
    if laws.knee:
        inside = np.minimum(s, laws.knee)
        rate = -np.log1p(-inside)
        slope = 1.0 / ((1.0 - inside) * rate) - 1.0 / inside
        log_f = np.log(rate / inside) + (s - inside) * slope
        return np.exp(np.minimum(log_f, LARGEST_THINNING)), slope * s
    end = (laws.last_stress + 1) / laws.per_stress
    inside = np.minimum(s, end / (1.0 - end))  # beyond the table ln F is linear in s
    t, parts = cubic(laws.thinning, inside / (1.0 + inside) * laws.per_stress, laws.last_stress)
    log_f, slope = (polyval(t, np.array(c), tensor=False) for c in (parts, polyder(parts)))
    slope = slope * laws.per_stress / (1.0 + inside) ** 2
    return np.exp(log_f + (s - inside) * slope), slope * s


# The flow


def stress(model: Model, at: Station, zeta: Array) -> tuple[Array, Array]:
    """Return tau(zeta) = tau_m + 12/lambda h grad p (zeta - 1/2): inertia does not count."""
    arm = model.terms.poiseuille * (zeta[:, None] - 0.5) * at.h
    return at.tau_x + arm * at.px, at.tau_y + arm * at.py


def moments(across: Across, f: Array) -> tuple[Array, Array]:
    """Return I0 = int_0^zeta f and I1 = int_0^zeta f (zeta' - 1/2)."""
    return np.cumsum(across.step @ f, axis=0), np.cumsum(across.turn @ f, axis=0)


def newtonian_stress(model: Model, at: Station, fluid: Array) -> None:
    """Find tau_m such that u goes from u1 to u2 and v from v1 to v2, in closed form."""
    i0, i1 = (moment[-1] for moment in moments(model.across, fluid))
    tilt = model.terms.poiseuille * at.h * i1
    at.tau_x = (at.slide[0] / at.h - tilt * at.px) / i0
    at.tau_y = (at.slide[1] / at.h - tilt * at.py) / i0


def thin(model: Model, at: Station, fluid: Array) -> tuple[Array, Array, Array, Array]:
    """Find tau_m of a film that thins: int phi tau = (u2 - u1)/h, both components.

    Newton's method with halved steps, from the present stress on. Return phi = F/eta, the exponent
    n = 1 + dln F/dln s, and phi of a small change of the stress along x and along y.
    """
    weights, uniform = model.across.weights, model.laws.uniform
    zeta = np.full_like(model.across.zeta, 0.5) if uniform else model.across.zeta

    def rates(tau_x: Array, tau_y: Array) -> tuple[Array, ...]:
        at.tau_x, at.tau_y = tau_x, tau_y
        x, y = stress(model, at, zeta)
        square = x**2 + y**2 + 1e-300
        factor, bend = thinning(model.laws, np.sqrt(square) * at.over_scale)
        phi, more = fluid * factor, bend / square
        missing = [weights @ (phi * z) - s / at.h for z, s in zip((x, y), at.slide, strict=True)]
        slopes = phi * (1.0 + more * x * x), phi * more * x * y, phi * (1.0 + more * y * y)
        return (*missing, *(weights @ s for s in slopes), phi, 1.0 + bend, slopes[0], slopes[2])

    x, y = at.tau_x, at.tau_y
    fx, fy, xx, xy, yy, *rest = rates(x, y)
    for _ in range(60):
        det, step = xx * yy - xy**2, np.ones_like(x)
        dx, dy = (yy * fx - xy * fy) / det, (xx * fy - xy * fx) / det
        for _ in range(40):
            gx, gy, *_ = rates(x - step * dx, y - step * dy)
            worse = gx**2 + gy**2 > fx**2 + fy**2
            if not worse.any():
                break
            step = np.where(worse, 0.5 * step, step)
        if np.max(at.over_scale * np.hypot(dx, dy)) < 1e-14:
            break
        x, y = x - step * dx, y - step * dy
        fx, fy, xx, xy, yy, *rest = rates(x, y)
    phi, exponent, along_x, along_y = rest
    return (phi, exponent, phi, phi) if uniform else (phi, exponent, along_x, along_y)


def velocities(model: Model, at: Station, phi: Array) -> tuple[Array, Array]:
    """Return u = u1 + h int phi tau_x, and v likewise, with the stress that fits phi."""
    i0, i1 = moments(model.across, phi)
    tilt, h = model.terms.poiseuille * at.h, at.h
    tau_x = (at.slide[0] / h - tilt * at.px * i1[-1]) / i0[-1]
    tau_y = (at.slide[1] / h - tilt * at.py * i1[-1]) / i0[-1]
    u = at.speed[0] + h * (tau_x * i0 + tilt * at.px * i1)
    return u, at.speed[1] + h * (tau_y * i0 + tilt * at.py * i1)


def mobility(across: Across, rho: Array, phi: Array) -> Array:
    """Return 12 (eta_e rho'_e/eta'_e - rho''_e) of the generalised Reynolds equation.

    Yang and Wen 1990, with moments about mid-film.
    """
    i0, i1 = moments(across, phi)
    return 12.0 * across.weights @ (rho * (i1[-1] / i0[-1] * i0 - i1))


# The energy


def through_layers(model: Model, masses: list[Array], sideways: Array) -> Array:
    """Return rho omega = -(h int rho u)_x - (h int rho v)_y/kappa, zero at both walls.

    ``masses``: int_0^zeta h rho u here, at the last station and at the one before;
    ``sideways``: int_0^zeta h rho v.
    """
    terms, (now, old, older) = model.terms, masses
    before = -sideways[:, 1] if terms.mirror else 2.0 * sideways[:, 0] - sideways[:, 1]
    wide = np.column_stack([before, sideways, 2.0 * sideways[:, -1] - sideways[:, -2]])
    through = -terms.over_x * (terms.w0 * now + terms.w1 * old + terms.w2 * older)
    through = through - 0.5 * terms.over_y * (wide[:, 2:] - wide[:, :-2])
    return through - model.across.zeta[:, None] * through[-1]


def upstream(one: Array, two: Array, second: Array) -> tuple[Array, Array]:
    """Return the factor of T here, and what neighbours bring, of an upstream difference.

    ``(1 + w) T - one - w (2 one - two)``: of second order for w = 1/2, of first for w = 0.
    """
    return 1.0 + second, one + second * (2.0 * one - two)


def hold(flow: Array) -> Array:
    """Return the part of second order that conduction across the film allows, 0 to 1."""
    return np.clip(2.0 - flow / CONDUCTION, 0.0, 1.0)


def convection(
    model: Model, t: Array, here: tuple[int, slice], u: Array, v: Array
) -> tuple[Array, ...]:
    """Return the diagonal of u T_x + v T_y/kappa, what neighbours bring, and what v carries.

    ``u, v`` are times h^2/k and the heat capacity; ``t`` (nx + 4, n, ny + 4) has the stations
    before as they are solved, all else as it was.
    """
    (i, rows), terms = here, model.terms

    def near(stations: int, shift: int = 0) -> Array:
        return t[i + stations, :, rows.start + shift : rows.stop + shift]

    one, two = (np.where(u > 0.0, near(-s), near(s)) for s in (1, 2))
    flow = np.abs(u) * terms.over_x
    factor, brought = upstream(one, two, terms.w2 * np.where(u > 0.0, 1.0, hold(flow)))
    diagonal, rest = factor * flow, brought * flow
    one, two = (np.where(v > 0.0, near(0, -s), near(0, s)) for s in (1, 2))
    flow = np.abs(v) * terms.over_y
    factor, brought = upstream(one, two, terms.w2 * hold(flow))
    return diagonal + factor * flow, rest + brought * flow, np.where(v > 0.0, flow, -flow)


@dataclass
class Column:
    """Properties and flow at the layers of a station."""

    ln_eta: Array
    gamma: Array
    rho: Array
    rho_t: Array
    phi: Array
    exponent: Array
    along_x: Array
    along_y: Array
    u: Array
    v: Array

    def share(self, across: Across) -> Array:
        """Return s_m = w_m phi_m gamma_m / sum w phi n: relative fall of the stress per kelvin."""
        weights = across.weights[:, None]
        return weights * self.phi * self.gamma / (across.weights @ (self.phi * self.exponent))


def sources(model: Model, at: Station, column: Column) -> tuple[Array, Array]:
    """Return shear heat Br phi tau^2 and compression -Cp T rho_T/rho (u.grad p + p_t)."""
    x, y = stress(model, at, model.across.zeta)
    rise = -model.terms.compression * at.t / column.rho * column.rho_t
    work = column.u * at.climb_x + column.v * at.climb_y + at.pt
    return model.terms.brinkman * (x**2 + y**2) * column.phi, rise * work


def energy_matrix(
    model: Model, at: Station, column: Column, through: Array, convected: tuple[Array, ...]
) -> tuple[Array, Array, Array]:
    """Return matrices (rows, n, n) and right-hand sides of inner layers, and their sideways parts.

    ``Pe c (rho u T_x + rho v T_y/kappa + rho omega T_zeta/h) = k T_zeta,zeta/h^2 + sources`` times
    h^2/k. The change of the shear heat with the temperature, ``dq_k = q_k (gamma_k dT_k -
    (1 + n_k) sum s_m dT_m)``, has ``theta = min(CONDUCTION/(q gamma h^2/k), 1)`` as a factor on
    gamma and in place of the 1, so as not to outweigh conduction; a banded matrix has ``-q gamma
    dT`` in its place.
    """
    across, terms, share = model.across, model.terms, column.share(model.across)
    per, zeta, n = at.h**2 / at.conductivity, across.zeta, len(across.zeta)
    diagonal, rest, sideways = convected
    shear, compression = (per * heat for heat in sources(model, at, column))
    gain = column.gamma * shear
    full = across.band == n - 1
    part = -np.minimum(CONDUCTION / (gain + 1e-300), 1.0) if full else np.ones_like(gain)
    shared = shear * (column.exponent - part) if full else np.zeros_like(shear)
    through = through * terms.peclet * at.capacity * at.h / at.conductivity
    matrix = np.einsum("kj,km->jkm", through, across.d1) - across.d2
    matrix += np.einsum("kj,mj->jkm", shared, share)
    for k in range(n):
        matrix[:, k, k] += (diagonal + part * gain)[k]
    rest = rest + shear + compression + part * gain * at.t + shared * np.sum(share * at.t, axis=0)
    gap = np.ones(n)
    gap[1:-1] = zeta[2:] - zeta[:-2]
    out = diagonal + (2.0 * np.abs(through).T / gap - np.diag(across.d2)).T
    return matrix, rest.T, sideways / out


def carry_sideways(new: Array, old: Array, part: Array) -> None:
    """Let the rows follow the change of the row that the oil comes from, outwards, then inwards."""
    n, ny = new.shape
    for step, rows in ((1, range(ny)), (-1, range(ny - 1, -1, -1))):
        change = np.zeros(n)
        for j in rows:
            new[1:-1, j] += (np.maximum(step * part[:, j], 0.0) * change)[1:-1]
            change = new[:, j] - old[:, j]


def solve_columns(matrix: Array, right: Array) -> Array:
    """Return the temperatures, (n, rows)."""
    return np.asarray(np.linalg.solve(matrix, right[:, :, None])[:, :, 0].T)


# The sweep


class Walls:
    """Both surfaces as line sources: sums of exponentials that march along."""

    def __init__(self, model: Model, surfaces: Surfaces) -> None:
        self.across, self.surfaces = model.across, surfaces
        ny = surfaces.first.bulk.shape[1]
        self.modes = [np.zeros((len(surface.decay), ny)) for surface in surfaces]

    def rows(self, i: int, at: Station, matrix: Array, right: Array) -> None:
        """Fill the wall rows: T = T_b + factor int q(s)/sqrt(x - s) ds, its own heat implicit."""
        for side, (surface, wall, sign) in enumerate(
            zip(self.surfaces, (0, -1), (1, -1), strict=True)
        ):
            two, one = surface.flux[i], surface.flux[i + 1]  # two ghost stations
            old, new = surface.older[:, None] * two, surface.newer[:, None] * one
            self.modes[side] = surface.decay[:, None] * self.modes[side] + old + new
            past = surface.next_ * one + np.sum(self.modes[side], axis=0)
            over_h = (surface.slowness * at.conductivity / at.h)[:, None]
            matrix[:, wall] = -sign * surface.factor * surface.near * self.across.d1[wall] * over_h
            matrix[:, wall, wall] += 1.0
            right[:, wall] = surface.bulk[i] + surface.factor * surface.slowness * past

    def store(self, i: int, at: Station) -> None:
        """Keep the heat k/h T_zeta that flows into each surface."""
        for surface, wall, sign in zip(self.surfaces, (0, -1), (1, -1), strict=True):
            surface.flux[i + GHOSTS] = sign * (self.across.d1[wall] @ at.t) * at.conductivity / at.h


def flow(model: Model, at: Station) -> Column:
    """Return properties and flow at the present temperature, and find the mid-film stress."""
    mean = model.across.weights @ at.t
    ln_eta, gamma, rho, rho_t = properties(
        model.laws, at.p, np.broadcast_to(mean, at.t.shape) if model.terms.mean == 2 else at.t
    )
    fluid = np.exp(-ln_eta)
    if model.laws.newtonian:
        newtonian_stress(model, at, fluid)
        phi, exponent, along_x, along_y = fluid, np.ones_like(fluid), fluid, fluid
    else:
        phi, exponent, along_x, along_y = thin(model, at, fluid)
    u, v = velocities(model, at, phi)
    return Column(ln_eta, gamma, rho, rho_t, phi, exponent, along_x, along_y, u, v)


def follow(model: Model, at: Station, column: Column, new: Array) -> None:
    """Take the new temperatures; laws and stress follow to first order."""
    step = np.clip(new - at.t, -LARGEST_KELVIN_STEP, LARGEST_KELVIN_STEP)
    mean = model.across.weights @ step
    if model.terms.over_t == 0.0:
        most = np.abs(step).max(axis=0)
        swings = (column.u.min(axis=0) < 0.0) & (most > SWINGING_KELVIN)
        swings |= (mean * at.step < -UNDONE * at.step**2) & (most > UNDONE_KELVIN)
        part = np.where(swings, SWINGING_PART, 1.0)
        step, mean = part * step, part * mean
    at.t, at.step = at.t + step, mean
    fall = np.sum(column.share(model.across) * step, axis=0)
    fall = np.clip(fall, -LARGEST_FALL, LARGEST_FALL)
    at.tau_x, at.tau_y = at.tau_x * (1.0 - fall), at.tau_y * (1.0 - fall)
    if model.terms.mean == 2:
        step = np.broadcast_to(model.across.weights @ step, step.shape)
    column.ln_eta = column.ln_eta - column.gamma * step
    column.rho = column.rho + column.rho_t * step
    growth = column.gamma * step - (column.exponent - 1.0) * fall
    growth = np.exp(np.clip(growth, -LARGEST_FLUIDITY_GROWTH, LARGEST_FLUIDITY_GROWTH))
    column.phi, column.along_x = column.phi * growth, column.along_x * growth
    column.along_y = column.along_y * growth
    column.u, column.v = velocities(model, at, column.phi)
    if model.laws.newtonian:
        newtonian_stress(model, at, column.phi)


def outputs(model: Model, at: Station, column: Column) -> dict[str, Array]:
    """Return what the Reynolds equation takes, powers and fluxes."""
    across, terms, weights, middle = model.across, model.terms, model.across.weights, len(at.t) // 2
    i0, _ = moments(across, column.phi)
    odd = weights @ (column.rho * (i0 / i0[-1] - 0.5))
    whole = mobility(across, column.rho, column.phi)
    shear, compression = sources(model, at, column)
    carried = terms.peclet * at.capacity * column.rho * (at.t - terms.inlet)
    out = {
        "mobility": whole,
        "density": weights @ column.rho + at.slide[0] * odd,
        "mean_density": weights @ column.rho,
        "odd_density": np.zeros_like(odd) if terms.plain else odd,
        "over_exponent": 1.0 / column.exponent[middle],
        "effective": np.exp(-column.ln_eta[middle]) / column.phi[middle],
        "stretch_x": mobility(across, column.rho, column.along_x) / whole,
        "stretch_y": mobility(across, column.rho, column.along_y) / whole,
        "excess_y": np.max(column.along_y / column.phi - 1.0, axis=0),
        "shear": at.h * (weights @ shear),
        "work": at.h * (weights @ compression),
        "enthalpy_x": at.h * (weights @ (carried * column.u)),
        "enthalpy_y": at.h * (weights @ (carried * column.v)),
        "tau_x": at.tau_x,
        "tau_y": at.tau_y,
    }
    if terms.mean == 1:
        mean = np.broadcast_to(weights @ at.t, (1, len(at.p)))
        ln_eta, _, rho, _ = properties(model.laws, at.p, mean)
        out["mobility"] = rho[0] * np.exp(-ln_eta[0]) / out["effective"]
        out["density"] = out["mean_density"] = rho[0]
        out["odd_density"] = np.zeros_like(odd)
    return out


def sweep(model: Model, fields: Fields, surfaces: Surfaces) -> dict[str, Array]:
    """March once along x; return all results, (nx, ny). Temperatures and fluxes are changed."""
    terms, t, walls = model.terms, fields.temperature, Walls(model, surfaces)
    rows, masses, found = slice(GHOSTS, t.shape[2] - GHOSTS), [], []
    for i in range(len(fields.p)):
        if terms.mirror:
            t[i + GHOSTS, :, :GHOSTS] = t[i + GHOSTS, :, 2 * GHOSTS : GHOSTS : -1]
        given = ("p", "h", "px", "py", "climb_x", "climb_y", "capacity", "conductivity")
        given += ("over_scale", "tau_x", "tau_y", "step")
        x, y = fields.x[i], fields.y
        at = Station(
            **{name: getattr(fields, name)[i] for name in given},
            slide=(terms.slide - terms.spin * y, terms.slide_y + terms.spin * x + 0.0 * y),
            speed=(terms.speed - terms.spin_1 * y, terms.speed_y + terms.spin_1 * x + 0.0 * y),
            pt=fields.pressing[i] if terms.over_t else np.zeros_like(fields.p[i]),
            t=t[i + GHOSTS, :, rows].copy(),
        )
        column = flow(model, at)
        mass = np.cumsum(model.across.step @ (at.h * column.rho * column.u), axis=0)
        sideways = np.cumsum(model.across.step @ (at.h * column.rho * column.v), axis=0)
        masses = [mass, *(masses or [mass, mass])[:2]]
        if i < 2:  # before the grid the mass flux goes on linearly
            masses[2] = 2.0 * masses[1] - masses[0]
        through = through_layers(model, masses, sideways)
        dense = at.h**2 / at.conductivity * terms.peclet * at.capacity * column.rho
        convected = convection(model, t, (i + GHOSTS, rows), dense * column.u, dense * column.v)
        if terms.over_t:
            diagonal, rest, flow_y = convected
            convected = diagonal + dense * terms.over_t, rest + dense * fields.past[i], flow_y
        matrix, right, part = energy_matrix(model, at, column, through, convected)
        walls.rows(i, at, matrix, right)
        new = solve_columns(matrix, right)
        carry_sideways(new, at.t, part)
        follow(model, at, column, new)
        t[i + GHOSTS, :, rows] = at.t
        walls.store(i, at)
        found.append(outputs(model, at, column))
    return {name: np.stack([one[name] for one in found]) for name in found[0]}
