"""Output of a solved block: properties for the Reynolds equation, powers and heat fluxes.

See docs/theory/thermal.md on the generalised Reynolds equation and the heat balance.
"""

from tehl.base.typing import Record, Records
from tehl.kernels.compiled import helper
from tehl.kernels.energy.column import heat_sources
from tehl.kernels.energy.flow import mobility, moments
from tehl.kernels.energy.laws import exponential, look_up, mean_temperature
from tehl.kernels.energy.records import BLOCK, Fields, Model, Place, Surfaces, Work
from tehl.kernels.energy.walls import store_flux
from tehl.kernels.raw import lanes

NEGLIGIBLE_EXCESS = 0.03  # excess of the tangent along y that does not change convergence


@helper
def _reynolds_fields(
    model: Model, fields: Fields, line: Record, layers: Records, place: Place
) -> None:
    """Write mobility and density of the Reynolds equation, mean density, 1/n and viscosity ratio.

    The density is that of the Couette flux over h u_m, ``rho* = int rho (u1 + slide I0/I0(1))``,
    the mean density and slide times the odd one, ``int rho (I0/I0(1) - 1/2)``.
    """
    across, n = model.across, layers.shape[0]
    i, rows = place.i, lanes(BLOCK * place.block)
    middle = layers[n // 2]
    fields.mobility[i, rows] = mobility(across, layers)
    per_i0 = line.slide_x / layers[n - 1].i0
    density, mean = 0.0 * per_i0, 0.0 * per_i0
    for k in range(n):
        here = layers[k]
        density = density + across.weights[k] * here.rho * (line.speed_x + per_i0 * here.i0)
        mean = mean + across.weights[k] * here.rho
    fields.density[i, rows] = density
    fields.mean_density[i, rows] = mean
    if not model.terms.plain:
        odd, over_i0 = 0.0 * mean, 1.0 / layers[n - 1].i0
        for k in range(n):
            here = layers[k]
            odd = odd + across.weights[k] * here.rho * (over_i0 * here.i0 - 0.5)
        fields.odd_density[i, rows] = odd
        fields.density[i, rows] = mean + line.slide_x * odd
    fields.over_exponent[i, rows] = 1.0 / middle.exponent
    fields.effective[i, rows] = exponential(-middle.ln_eta) / middle.fluidity


@helper
def _stretches(model: Model, fields: Fields, line: Record, layers: Records, place: Place) -> None:
    """Write the mobility of a small change of the pressure gradient over the mobility.

    Along x and y at constant sliding, from the tangents of the fluidity (`thin`).
    """
    i, rows = place.i, lanes(BLOCK * place.block)
    fields.stretch_x[i, rows] = 1.0
    fields.stretch_y[i, rows] = 1.0
    if line.thins[0] == 0.0:
        return
    for k in range(layers.shape[0]):
        here = layers[k]
        here.integrand = here.tangent_x
    moments(model.across, layers)
    whole = fields.mobility[i, rows]
    fields.stretch_x[i, rows] = mobility(model.across, layers) / whole
    if line.excess_y[0] > NEGLIGIBLE_EXCESS:
        for k in range(layers.shape[0]):
            here = layers[k]
            here.integrand = here.tangent_y
        moments(model.across, layers)
        fields.stretch_y[i, rows] = mobility(model.across, layers) / whole


@helper
def _mean_fields(model: Model, fields: Fields, line: Record, layers: Records, place: Place) -> None:
    """Write mobility and density at the mean temperature, with the thinning of mid-film."""
    i, rows = place.i, lanes(BLOCK * place.block)
    first = layers[0]
    look_up(model.laws, line, first, mean_temperature(model.across, layers))
    fluid = exponential(-first.ln_eta)
    fields.mobility[i, rows] = first.rho * fluid / fields.effective[i, rows]
    fields.density[i, rows] = first.rho
    if model.terms.plain:
        fields.density[i, rows] = (line.speed_x + 0.5 * line.slide_x) * first.rho
    fields.mean_density[i, rows] = first.rho
    fields.odd_density[i, rows] = 0.0


@helper
def _powers(model: Model, fields: Fields, line: Record, layers: Records, place: Place) -> None:
    """Write mid-film stress, shear power, compression power and enthalpy fluxes."""
    terms, i, rows = model.terms, place.i, lanes(BLOCK * place.block)
    fields.tau_x[i, rows] = line.tau_x
    fields.tau_y[i, rows] = line.tau_y
    if not terms.heat:
        return
    h, capacity = line.h, terms.peclet * line.capacity
    shear, compression, along, sideways = 0.0 * h, 0.0 * h, 0.0 * h, 0.0 * h
    for k in range(layers.shape[0]):
        here = layers[k]
        weight = model.across.weights[k] * h
        power, rise = heat_sources(model, line, here, k)
        shear = shear + weight * power
        compression = compression + weight * rise
        excess = weight * capacity * here.rho * (here.t - terms.inlet)
        along = along + excess * here.u
        sideways = sideways + excess * here.v
    fields.shear[i, rows] = shear
    fields.work[i, rows] = compression
    fields.enthalpy_x[i, rows] = along
    fields.enthalpy_y[i, rows] = sideways


@helper
def write_block(model: Model, fields: Fields, surfaces: Surfaces, work: Work, place: Place) -> None:
    """Write all results of the block."""
    line, layers = work.lines[place.block], work.layers[place.block]
    if model.terms.heat:
        store_flux(model.across, surfaces.first, 0, work, place)
        store_flux(model.across, surfaces.second, 1, work, place)
    _powers(model, fields, line, layers, place)
    _reynolds_fields(model, fields, line, layers, place)
    _stretches(model, fields, line, layers, place)
    if model.terms.mean == 1:
        _mean_fields(model, fields, line, layers, place)
