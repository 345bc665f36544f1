"""Stress below the surfaces of a result, depth by depth; only one depth is in memory at a time."""

from collections.abc import Callable, Sequence
from functools import cache, partial
from typing import Any, NamedTuple

import numpy as np

from tehl.base.typing import Array
from tehl.contact.roller import Ends
from tehl.contact.stress import Stress
from tehl.post.stress.heated import (
    ThermalBody,
    heated_body,
    surface_stress,
    thermal_stress_of,
)
from tehl.post.stress.influence import COMPONENTS, HalfSpace, Space, Spectra, Steps
from tehl.post.stress.loads import SurfaceLoads, left_out, loads_on, on_even_lines, parts_of_cells
from tehl.post.stress.measures import Worst, largest_shear, worst
from tehl.post.stress.repeating import RepeatingHalfSpace
from tehl.post.stress.thermal import Heated
from tehl.post.stress.window import Window, cut, depths_of, halved, middle_row, wake, window_of
from tehl.result.fields import BodyStress
from tehl.result.solution import Solution


class Case(NamedTuple):
    """Loads on a half-space of one material, and the heat that it takes."""

    loads: SurfaceLoads
    poisson_ratio: float
    heat: Heated | None = None


Body = tuple[Callable[[Steps], Spectra], Case, ThermalBody | None]
"""Spectra of the loads by the nodes that a depth needs, the case, and its thermal stress."""


class Grid(NamedTuple):
    """Nodes of the loads, and those of them at which stresses are kept."""

    spacing: tuple[float, float]
    """Mesh widths along y and x [m]."""
    kept: slice
    """Columns: the others carry a wake of heat."""
    row: int
    column: int
    """Kept nodes nearest to the axes."""
    ends: Ends = "open"
    """What lies beyond the first and last row."""

    @property
    def coarser(self) -> "Grid":
        """Return the grid of every second node."""
        (dy, dx), kept = self.spacing, self.kept
        columns = slice(kept.start // 2, (kept.stop + 1) // 2)
        return Grid((2.0 * dy, 2.0 * dx), columns, self.row // 2, self.column // 2, self.ends)


def stress_below(result: Solution, settings: Stress | None = None) -> BodyStress:
    """Return the stress below the surfaces of a steady result.

    All values are computed again with loads on every second node: the difference is the error bar.

    Parameters
    ----------
    result : Solution
        Steady, computed or loaded.
    settings : Stress or None
        The table ``[stress]``; that of the case by default, or the defaults.
    """
    settings = settings or result.problem.stress or Stress()
    result, without_shear = on_even_lines(result), left_out(result)
    loads = [loads_on(result, body, without_shear=without_shear) for body in settings.bodies]
    window = window_of(result, loads[0].pressure)
    depths, sides = depths_of(result, settings, window), wake(result, settings, window)
    heats = [heated_body(result, body, window, sides) for body in settings.bodies]
    if not settings.thermal:
        heats = [None] * len(loads)
    cases = [
        Case(_beside(cut(one, window), sides), poisson_ratio(result, body), heat)
        for one, body, heat in zip(loads, settings.bodies, heats, strict=True)
    ]
    traction = np.array([one.loads.traction_x.sum() / one.loads.pressure.sum() for one in cases])
    cases, same = _distinct(cases)
    dry_load = _beside(_dry(result, window), sides)
    dry = [Case(dry_load, nu) for nu in dict.fromkeys(one.poisson_ratio for one in cases)]
    which = [[one.poisson_ratio for one in dry].index(case.poisson_ratio) for case in cases]
    x, y = result.x[window.columns], result.y[window.rows]
    kept = slice(sides[0], sides[0] + x.size)
    row, column = middle_row(result, window), int(np.argmin(np.abs(x)))
    grid = Grid(window.spacing, kept, row, column, result.problem.contact.ends)
    march = March(depths, settings, result.scales.hertz_pressure)
    fine = march.through([*cases, *dry], grid, len(cases))
    coarse = march.through([_coarser(one, grid.ends) for one in (*cases, *dry)], grid.coarser).found
    n = len(cases)
    level = [int(np.argmax(one)) for one in _column(fine.found[:n], "shear")]
    floors = [march.shear_at(case, grid, k) for case, k in zip(cases, level, strict=True)]
    found, coarse_found = fine.found[:n][same], coarse[:n][same]
    dry_part, coarse_dry = fine.found[n:][which][same], coarse[n:][which][same]
    along = fine.along[same]
    return BodyStress(
        body=np.array(settings.bodies, float),
        depth=depths,
        x=x,
        y=y,
        **{name: along[:, k] for k, name in enumerate(COMPONENTS)},
        across=fine.across[same],
        floor=np.array(floors)[same],
        floor_depth=depths[level][same],
        shear=_column(found, "shear"),
        shear_x=x[_column(found, "column").astype(int)],
        shear_y=y[_column(found, "row").astype(int)],
        von_mises=_column(found, "von_mises"),
        orthogonal=_column(found, "orthogonal"),
        dang_van=_column(found, "dang_van"),
        shear_coarse=_column(coarse_found, "shear"),
        shear_dry=_column(dry_part, "shear"),
        orthogonal_dry=_column(dry_part, "orthogonal"),
        dang_van_dry=_column(dry_part, "dang_van"),
        life=march.life(found, dry_part),
        life_coarse=march.life(coarse_found, coarse_dry),
        traction=traction,
        left_out=np.array(float(without_shear)),
        thermal=np.array([0.0 if one is None else surface_stress(one) for one in heats]),
    )


class Marched(NamedTuple):
    """What is kept of all depths."""

    found: Array
    """(n, nz, 7): `Worst` of each case and depth [Pa], places in nodes; ``risk`` in the pressure
    scale."""
    along: Array
    """(planes, 6, nz, nx): Components along the row nearest to y = 0 [Pa]."""
    across: Array
    """(planes, nz, ny): Largest shear stress along the column nearest to x = 0 [Pa]."""


class March:
    """Goes through the depths, and keeps of each what is largest and two planes."""

    def __init__(self, depths: Array, settings: Stress, scale: float) -> None:
        self.depths, self.settings, self.scale = depths, settings, scale
        points = np.array(settings.residual or ((0.0, 0.0),))
        self._residual = np.interp(depths, *points.T)

    def through(self, cases: Sequence[Case], grid: Grid, planes: int = 0) -> Marched:
        """Go through the depths.

        Parameters
        ----------
        cases : sequence of Case
            On the same nodes.
        grid : Grid
            Those nodes.
        planes : int
            Number of cases, the first ones, of which planes are kept.
        """
        ny, wide = cases[0].loads.pressure.shape
        heats = [None if case.heat is None else thermal_stress_of(case.heat) for case in cases]
        loads = [_with_heat(case.loads, heat) for case, heat in zip(cases, heats, strict=True)]
        space = _space(loads, grid)
        bodies = [self._body(*one, space) for one in zip(cases, loads, heats, strict=True)]
        nx, size = len(range(*grid.kept.indices(wide))), self.depths.size
        found = np.empty((len(cases), size, len(Worst._fields)))
        along, across = np.empty((planes, 6, size, nx)), np.empty((planes, 6, size, ny))
        limit = self.settings.fatigue_limit / self.scale
        for k, depth in enumerate(self.depths):
            steps = space.steps(float(depth))
            influence, rows = space.influence(float(depth), steps), space.rows(steps)
            weights = space.weights(steps)
            for number, body in enumerate(bodies):
                stress = self._stress(body, space, influence, grid, k)
                rest = float(self._residual[k]) / self.scale
                one = worst(stress, self.settings, limit, weights, rest)
                found[number, k] = one._replace(row=rows.start + rows.step * one.row)
                if number < planes:
                    along[number, :, k] = stress[:, (grid.row - rows.start) // rows.step]
                    across[number, :, k] = space.on_all_rows(stress[:, :, grid.column], steps)
        found[..., :4] *= self.scale
        found[..., 4] *= grid.spacing[0]
        across = largest_shear(np.moveaxis(across, 1, 0)) * self.scale
        return Marched(found, along * self.scale, across)

    def shear_at(self, case: Case, grid: Grid, level: int) -> Array:
        """Return the largest shear stress at one of the depths, (ny, nx) [Pa].

        Parameters
        ----------
        case, grid : Case, Grid
            The body and its nodes.
        level : int
            Which depth.
        """
        heat = None if case.heat is None else thermal_stress_of(case.heat)
        loads = _with_heat(case.loads, heat)
        space = _space([loads], grid)
        influence = space.influence(float(self.depths[level]))
        body = self._body(case, loads, heat, space)
        shear = largest_shear(self._stress(body, space, influence, grid, level)) * self.scale
        return np.concatenate([shear[:0:-1], shear]) if space.mirror else shear

    def _body(
        self,
        case: Case,
        loads: SurfaceLoads,
        heat: ThermalBody | None,
        space: Space,
    ) -> Body:
        """Return the spectra of the loads of a body, itself, and its thermal stress."""
        spectra = space.spectra_of(*(load / self.scale for load in loads))
        return cache(partial(space.thinned, spectra)), case, heat

    def _stress(
        self,
        body: Body,
        space: Space,
        influence: Any,
        grid: Grid,
        level: int,
    ) -> Array:
        """Return the components at a depth, over the pressure scale."""
        spectra, case, heat = body
        steps = space.steps_of(influence)
        stress = space.stresses(spectra(steps), influence, case.poisson_ratio)[..., grid.kept]
        if heat is not None:
            added = heat.stresses(float(self.depths[level]), space.rows(steps))
            stress += added[..., grid.kept] / self.scale
        stress[:2] += self._residual[level] / self.scale
        return stress

    def life(self, found: Array, dry: Array) -> Array:
        r"""Return the life over that of the dry smooth contact, (n,) [-].

        .. math:: \frac{L}{L_H} = \left(\frac{\iint \tau_H^c z^{-h} dy dz}
                  {\iint \tau^c z^{-h} dy dz}\right)^{1/e}

        Zero where one of both has no stress above the fatigue limit.

        Parameters
        ----------
        found, dry : (n, nz, 7) array
            Of the bodies, and of the dry contact.
        """
        at = Worst._fields.index("risk")
        weight = (self.depths / self.depths[-1]) ** (1.0 - self.settings.depth_exponent)
        weight[[0, -1]] *= 0.5  # trapezoidal rule over ln z
        risk, least = (one[..., at] @ weight for one in (found, dry))
        known = (risk > 0.0) & (least > 0.0)
        ratio = np.divide(least, risk, out=np.zeros_like(risk), where=known)
        return np.asarray(ratio ** (1.0 / self.settings.weibull_slope))


def _distinct(cases: Sequence[Case]) -> tuple[list[Case], list[int]]:
    """Return the cases without repetitions, and which of them each one is.

    Two bodies of one material that roll without sliding and heat are one case.
    """
    found: list[Case] = []
    same = []
    for case in cases:
        equal = [k for k, one in enumerate(found) if _are_equal(case, one)]
        same.append(equal[0] if equal else len(found))
        if not equal:
            found.append(case)
    return found, same


def _are_equal(one: Case, other: Case) -> bool:
    if one.heat is not None or other.heat is not None or one.poisson_ratio != other.poisson_ratio:
        return False
    return all(np.array_equal(a, b) for a, b in zip(one.loads, other.loads, strict=True))


def poisson_ratio(result: Solution, body: int) -> float:
    """Return Poisson's ratio of a body, 1 or 2."""
    return result.problem.surfaces[body - 1].material.poisson_ratio


def _dry(result: Solution, window: Window) -> SurfaceLoads:
    """Return the pressure of the dry smooth contact under the same load."""
    x, y = result.scaled.x[window.columns], result.scaled.y[window.rows]
    pressure = result.scales.hertz_pressure * result.groups.shape.dry_pressure(x, y[:, None])
    pressure = pressure * parts_of_cells(result)[window.rows]
    nothing = np.zeros_like(pressure)
    return SurfaceLoads(pressure, nothing, nothing)


def _beside(loads: SurfaceLoads, sides: tuple[int, int]) -> SurfaceLoads:
    """Return loads with unloaded nodes before and behind them along x."""
    return SurfaceLoads(*(np.pad(load, ((0, 0), sides)) for load in loads))


def _coarser(case: Case, ends: Ends) -> Case:
    """Return a case on every second node."""
    (pressure, *tractions), heat = case.loads, case.heat
    along, across = (halved(one, ends, odd=k > 0) for k, one in enumerate(tractions))
    loads = SurfaceLoads(halved(pressure, ends), along, across)
    return Case(
        loads,
        case.poisson_ratio,
        None if heat is None else heat.coarser(partial(halved, ends=ends)),
    )


def _with_heat(loads: SurfaceLoads, heat: ThermalBody | None) -> SurfaceLoads:
    """Return loads with those that free the surface of thermal stress."""
    if heat is None:
        return loads
    return SurfaceLoads(*(one + more for one, more in zip(loads, heat.loads(), strict=True)))


def _space(loads: Sequence[SurfaceLoads], grid: Grid) -> Space:
    """Return the half-space under loads; of those that are symmetric only one side is computed."""
    shape = loads[0].pressure.shape
    if grid.ends != "open":
        return RepeatingHalfSpace(shape, grid.spacing, grid.ends)
    mirror = all(_symmetric(one, grid.row) for one in loads)
    return HalfSpace(shape, grid.spacing, single=True, row=grid.row, mirror=mirror)


def _symmetric(loads: SurfaceLoads, row: int) -> bool:
    """Whether loads have the same stresses on both sides of a row."""
    if row == 0 or loads.pressure.shape[0] != 2 * row + 1:
        return False
    least = 1e-6 * float(loads.pressure.max())  # that of single precision
    *even, odd = loads
    return all(
        np.abs(one - sign * one[::-1]).max() <= least
        for one, sign in ((even[0], 1.0), (even[1], 1.0), (odd, -1.0))
    )


def _column(found: Array, name: str) -> Array:
    return np.ascontiguousarray(found[..., Worst._fields.index(name)])
