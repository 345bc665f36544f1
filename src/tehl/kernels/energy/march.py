"""The march along x: one sweep of the energy equation over the film.

At each station: laws and flow at the last temperatures, columns of the energy equation, and laws
and flow at the new temperatures for the Reynolds equation. `tests.kernels.station` states the same
in plain numpy.
"""

from tehl.base.typing import Array, Records
from tehl.kernels.compiled import helper, kernel
from tehl.kernels.energy.column import carry_sideways, inner_rows, join_ends, solve_block
from tehl.kernels.energy.flow import (
    complete_mass,
    flow,
    mass_fluxes,
    moments_of_fluidity,
    velocities,
)
from tehl.kernels.energy.laws import evaluate_laws, exponential, limited
from tehl.kernels.energy.outputs import write_block
from tehl.kernels.energy.records import BLOCK, GHOSTS, Fields, Model, Place, Surfaces, Terms, Work
from tehl.kernels.energy.walls import keep_wall, wall_row
from tehl.kernels.lanes import Lanes, greater, largest, lesser, where
from tehl.kernels.raw import lanes, raw

LARGEST_KELVIN_STEP = 40.0  # [K] per solution of a column
LARGEST_FALL = 0.5  # of the stress with it, relative
LARGEST_FLUIDITY_GROWTH = 6.0  # of the logarithm of the fluidity with it
PRESSURISED = 0.02  # pressure above which a change of temperature counts
SWINGING_PART, SWINGING_KELVIN = 0.5, 0.5
"""Part of a change of temperature that is taken where oil flows back, and the change [K] from which
on: such oil comes from hotter places, and where it is warmer more of it does. On fine grids whole
changes grow from sweep to sweep, up to 170 K where 92 K are right (traction drives, M = 60 to
1,000, L = 17 to 21). Time steps, which have few sweeps, take all."""
UNDONE, UNDONE_KELVIN = 0.5, 5.0
"""Part of the last mean change that the present one undoes, and change [K], from which on that part
is taken too: cold oil reaches a limiting stress, and heats to where it does not, which no tangent
shows. A ball on glass (M = 295) swings by 25 to 35 K from sweep to sweep without. From 0.5 K on it
rests as well, but a bearing (M = 1302, L = 16) takes 21 cycles in place of 5."""


@helper
def _load_block(model: Model, fields: Fields, work: Work, place: Place) -> None:
    """Copy the fields of a block to its records."""
    line, layers = work.lines[place.block], work.layers[place.block]
    i, j = place.i, BLOCK * place.block
    rows = lanes(j)
    h, conductivity = fields.h[i, rows], fields.conductivity[i, rows]
    line.p = fields.p[i, rows]
    line.h = h
    line.h2_over_k = h * h / conductivity
    line.p_x = fields.px[i, rows]
    line.p_y = fields.py[i, rows]
    line.climb_x = fields.climb_x[i, rows]
    line.climb_y = fields.climb_y[i, rows]
    line.p_t = 0.0
    if model.terms.over_t > 0.0:
        line.p_t = fields.pressing[i, rows]
    line.capacity = fields.capacity[i, rows]
    line.conductivity = conductivity
    line.over_scale = fields.over_scale[i, rows]
    line.sheared = fields.sheared[i, rows]
    line.tau_x = fields.tau_x[i, rows]
    line.tau_y = fields.tau_y[i, rows]
    terms, x, y = model.terms, fields.x[i], fields.y[rows]
    line.over_y = terms.over_y * fields.closer[rows]
    line.slide_x = terms.slide - terms.spin * y
    line.slide_y = terms.slide_y + terms.spin * x
    line.speed_x = terms.speed - terms.spin_1 * y
    line.speed_y = terms.speed_y + terms.spin_1 * x
    for k in range(layers.shape[0]):
        here = layers[k]
        here.t = fields.temperature[i + GHOSTS, k, lanes(j + GHOSTS)]


@helper
def _fill_ghosts(terms: Terms, temperature: Array, i: int) -> None:
    """Fill the ghost rows of a symmetry line, or beyond both ends of a film that wraps."""
    for k in range(temperature.shape[1]):
        for ghost in range(1, GHOSTS + 1):
            if terms.mirror:
                temperature[i, k, GHOSTS - ghost] = temperature[i, k, GHOSTS + ghost]
            elif terms.period > 0:
                last = GHOSTS + terms.period
                temperature[i, k, GHOSTS - ghost] = temperature[i, k, last - ghost]
                temperature[i, k, last + ghost] = temperature[i, k, GHOSTS + ghost]


@helper
def _slowest(layers: Records) -> Lanes:
    """Return the least velocity along x across the film."""
    slowest = layers[0].u
    for k in range(1, layers.shape[0]):
        slowest = lesser(slowest, layers[k].u)
    return slowest


@helper
def _flow_of_block(model: Model, fields: Fields, work: Work, place: Place, steps: int) -> None:
    """Evaluate laws, flow and mass fluxes of a block at its last temperature."""
    line, layers = work.lines[place.block], work.layers[place.block]
    _load_block(model, fields, work, place)
    evaluate_laws(model, work.terms, line, layers)
    flow(model, line, layers, steps)
    if not model.terms.heat:
        return
    mass_fluxes(model.across, work, place)
    if largest(-_slowest(layers)) > 0.0:
        work.back[0] = max(work.back[0], place.i + 1.0)


@helper
def _heat_block(model: Model, fields: Fields, surfaces: Surfaces, work: Work, place: Place) -> None:
    """Solve the energy equation in the columns of a block."""
    inner_rows(model, fields, work, place)
    wall_row(model.across, surfaces.first, 0, work, place)
    wall_row(model.across, surfaces.second, 1, work, place)
    solve_block(model, work, work.layers[place.block])


@helper
def _take_temperatures(
    model: Model, fields: Fields, work: Work, place: Place
) -> tuple[Lanes, Lanes]:
    """Take the new temperatures; return their mean change and the relative fall of the stress.

    No temperature changes by more than `LARGEST_KELVIN_STEP`, and where oil of a steady film flows
    back or swings large changes are taken by `SWINGING_PART`. ``new_t`` becomes the change. Changes
    at pressures below `PRESSURISED` do not count as the largest one.
    """
    line, layers, weights = work.lines[place.block], work.layers[place.block], model.across.weights
    rows = lanes(BLOCK * place.block + GHOSTS)
    mean, most, fall = 0.0 * line.p, 0.0 * line.p, 0.0 * line.p
    for k in range(layers.shape[0]):
        here = layers[k]
        step = lesser(greater(here.new_t - here.t, -LARGEST_KELVIN_STEP), LARGEST_KELVIN_STEP)
        here.new_t = step
        most = greater(most, abs(step))
        mean = mean + weights[k] * step
    i, inner = place.i, lanes(BLOCK * place.block)
    part, last = 1.0 + 0.0 * mean, fields.step[i, inner]
    if model.terms.over_t == 0.0:
        back = (_slowest(layers) < 0.0) & (most > SWINGING_KELVIN)
        undone = (mean * last < -UNDONE * last * last) & (most > UNDONE_KELVIN)
        part = where(back, SWINGING_PART * part, where(undone, SWINGING_PART * part, part))
    mean = part * mean
    fields.step[i, inner] = mean
    for k in range(layers.shape[0]):
        here = layers[k]
        step = part * here.new_t
        here.new_t = step
        here.t = here.t + step
        fields.temperature[i + GHOSTS, k, rows] = here.t
        fall = fall + here.share * step
    counts = where(line.p - PRESSURISED > 0.0, most, 0.0)
    work.change[lanes(0)] = greater(work.change[lanes(0)], counts)
    return mean, lesser(greater(fall, -LARGEST_FALL), LARGEST_FALL)


@helper
def _follow_temperature(model: Model, fields: Fields, work: Work, place: Place) -> None:
    """Take the new temperatures, and update laws and stress to first order."""
    line, layers = work.lines[place.block], work.layers[place.block]
    mean, fall = _take_temperatures(model, fields, work, place)
    line.tau_x = line.tau_x * (1.0 - fall)
    line.tau_y = line.tau_y * (1.0 - fall)
    for k in range(layers.shape[0]):
        here = layers[k]
        step = mean if model.terms.mean == 2 else here.new_t
        thinner = here.slope * step
        here.ln_eta = limited(here.ln_eta - thinner)
        here.rho = here.rho + here.rho_t * step
        growth = thinner - (here.exponent - 1.0) * fall
        growth = exponential(
            lesser(greater(growth, -LARGEST_FLUIDITY_GROWTH), LARGEST_FLUIDITY_GROWTH)
        )
        here.fluidity = here.fluidity * growth
        here.tangent_x = here.tangent_x * growth
        here.tangent_y = here.tangent_y * growth


@helper
def _march_station(
    model: Model, fields: Fields, surfaces: Surfaces, work: Work, i: int, steps: int
) -> None:
    """Solve a station.

    New temperatures are taken after all blocks are solved, as blocks use their neighbours.
    """
    blocks = work.lines.shape[0]
    for block in range(blocks):
        _flow_of_block(model, fields, work, Place(i, block), steps)
    if model.terms.heat:
        complete_mass(model.terms, work, i)
        for block in range(blocks):
            _heat_block(model, fields, surfaces, work, Place(i, block))
        carry_sideways(model.terms, work)
        join_ends(model.terms, work)
    for block in range(blocks):
        line, layers = work.lines[block], work.layers[block]
        if model.terms.heat:
            _follow_temperature(model, fields, work, Place(i, block))
            moments_of_fluidity(model.across, layers)
            velocities(model.terms, line, layers)
        write_block(model, fields, surfaces, work, Place(i, block))


@helper
def _back_station(model: Model, fields: Fields, work: Work, i: int, first: bool) -> None:
    """Solve a station of the march back, after the flow at the stations upstream."""
    blocks = work.lines.shape[0]
    for station in (i - 1, i - 2, i):
        if station >= 0 and (first or station != i - 1):
            for block in range(blocks):
                _flow_of_block(model, fields, work, Place(station, block), 1)
    complete_mass(model.terms, work, i)
    for block in range(blocks):
        inner_rows(model, fields, work, Place(i, block))
        for side in range(2):
            keep_wall(side, work, block)
        solve_block(model, work, work.layers[block])
    for block in range(blocks):
        _follow_temperature(model, fields, work, Place(i, block))


@helper
def _march_back(model: Model, fields: Fields, work: Work) -> None:
    """Solve the stations against the march, from the last one with backflow on.

    The march along x alone would carry heat upstream by one station per sweep. The walls keep
    their temperature.
    """
    last = int(work.back[0]) - 1
    for i in range(last, -1, -1):
        _fill_ghosts(model.terms, fields.temperature, i + GHOSTS)
        _back_station(model, fields, work, i, i == last)


@kernel
def sweep(
    model: Model,
    fields: Fields,
    surfaces: Surfaces,
    work: Work,
    settings: tuple[int, bool],
) -> float:
    """March once along x; return the largest change of temperature [K].

    Without heat (``terms.heat``) only laws and flow are evaluated.

    Parameters
    ----------
    model, fields, surfaces, work
        See `tehl.kernels.energy.records`.
    settings : (int, bool)
        Most Newton steps for the stress of a thinning film; whether to march against x first,
        from the last station with backflow in the last sweep.
    """
    model, fields, surfaces, work = raw((model, fields, surfaces, work))
    steps, back = settings
    if back:
        _march_back(model, fields, work)
    clear(work)
    for i in range(fields.p.shape[0]):
        _fill_ghosts(model.terms, fields.temperature, i + GHOSTS)
        _march_station(model, fields, surfaces, work, i, steps)
    return largest(work.change[lanes(0)])


@helper
def clear(work: Work) -> None:
    """Reset the exponentials of the surfaces and the results of the last sweep."""
    sides, count, ny = work.modes.shape
    for side in range(sides):
        for m in range(count):
            for j in range(ny):
                work.modes[side, m, j] = 0.0
    work.change[lanes(0)] = 0.0
    work.back[0] = 0.0
