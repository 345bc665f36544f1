"""Both walls of the film: heat flux into the surfaces, and their temperature.

A fast surface is heated by a line source that marches along (Jaeger 1942; Carslaw and Jaeger 1959,
section 10.7),

    T(x) - T_b = factor int q(s)/sqrt(x - s) ds,

and slower rows of a surface that spins by more. The last mesh width is integrated exactly and
implicitly; the rest is a sum of exponentials, each updated by one multiplication per station
(`tehl.operators.line_source`).
"""

from tehl.kernels.compiled import helper
from tehl.kernels.energy.flow import reach
from tehl.kernels.energy.records import BLOCK, GHOSTS, Across, Place, Surface, Work
from tehl.kernels.lanes import Lanes
from tehl.kernels.raw import lanes


@helper
def _carry_modes(surface: Surface, side: int, work: Work, place: Place) -> Lanes:
    """Update the exponentials of a surface to this station; return their sum and the near part.

    ``mode = decay mode + older q(i - 2) + newer q(i - 1)``.
    """
    at, rows = place.i + GHOSTS, lanes(BLOCK * place.block)
    two, one = surface.flux[at - 2, rows], surface.flux[at - 1, rows]
    past = surface.next_ * one
    for m in range(surface.decay.shape[0]):
        mode = surface.decay[m] * work.modes[side, m, rows]
        mode = mode + (surface.older[m] * two + surface.newer[m] * one)
        work.modes[side, m, rows] = mode
        past = past + mode
    return past


@helper
def wall_row(across: Across, surface: Surface, side: int, work: Work, place: Place) -> None:
    """Fill the row of a wall: its temperature is bulk plus the rise by the line source."""
    line, rows = work.lines[place.block], lanes(0)
    wall, sign = side * (across.zeta.shape[0] - 1), 1.0 - 2.0 * side
    past = _carry_modes(surface, side, work, place)
    slowness = surface.slowness[lanes(BLOCK * place.block)]
    over_h = slowness * (line.conductivity / line.h)
    first, stop = reach(across, wall)
    for m in range(first, stop):
        weight = sign * surface.factor * surface.near * across.d1[wall, m]
        unit = 1.0 if m == wall else 0.0
        work.matrix[wall, m, rows] = unit - weight * over_h
    bulk = surface.bulk[place.i, lanes(BLOCK * place.block)]
    work.rhs[wall, rows] = bulk + (surface.factor * slowness) * past


@helper
def keep_wall(side: int, work: Work, block: int) -> None:
    """Fill the row of a wall at its last temperature."""
    layers, rows = work.layers[block], lanes(0)
    wall = side * (layers.shape[0] - 1)
    for m in range(layers.shape[0]):
        work.matrix[wall, m, rows] = 1.0 if m == wall else 0.0
    work.rhs[wall, rows] = layers[wall].t


@helper
def store_flux(across: Across, surface: Surface, side: int, work: Work, place: Place) -> None:
    """Write the heat that flows into a surface, ``k/h T_zeta`` inwards."""
    line, layers = work.lines[place.block], work.layers[place.block]
    wall, sign = side * (layers.shape[0] - 1), 1.0 - 2.0 * side
    flux = 0.0 * line.h
    first, stop = reach(across, wall)
    for m in range(first, stop):
        flux = flux + (sign * across.d1[wall, m]) * layers[m].t
    flux = flux * (line.conductivity / line.h)
    surface.flux[place.i + GHOSTS, lanes(BLOCK * place.block)] = flux
