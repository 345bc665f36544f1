"""Stress below the surfaces of a result, depth by depth; only one depth is in memory at a time."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tehl.base.typing import Array
from tehl.contact.stress import Stress
from tehl.post.stress.influence import COMPONENTS, HalfSpace
from tehl.post.stress.loads import SurfaceLoads, left_out, loads_on
from tehl.post.stress.measures import Worst, worst
from tehl.result.fields import BodyStress
from tehl.result.solution import Solution

LEAST_PRESSURE = 1e-2
"""Pressure over the largest below which nodes at the edges of the domain are left out."""
LEAST_WINDOW = 1.25
"""Half-widths of the Hertz contact on each side in which stresses are always computed."""
LEAST_DEPTH = 2.0
"""Least depth [mesh widths]: above it a rough pressure is not resolved."""


class Window(NamedTuple):
    """Part of the nodes whose loads and stresses count, of an odd number along x and y."""

    rows: slice
    columns: slice
    spacing: tuple[float, float]
    """Mesh widths along y and x [m]."""


class Case(NamedTuple):
    """Loads on a half-space of one material."""

    loads: SurfaceLoads
    poisson_ratio: float


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
    loads = [loads_on(result, body) for body in settings.bodies]
    window = window_of(result, loads[0].pressure)
    depths = depths_of(result, settings, window)
    cases = [
        Case(cut(one, window), poisson_ratio(result, body))
        for one, body in zip(loads, settings.bodies, strict=True)
    ]
    dry = [
        Case(_dry(result, window), nu) for nu in dict.fromkeys(one.poisson_ratio for one in cases)
    ]
    which = [[one.poisson_ratio for one in dry].index(case.poisson_ratio) for case in cases]
    scale = result.scales.hertz_pressure
    march = March(depths, settings, scale)
    fine, planes = march.through([*cases, *dry], window.spacing, row=middle_row(result, window))
    coarse, _ = march.through(
        [Case(_halved(one.loads), one.poisson_ratio) for one in (*cases, *dry)],
        (2.0 * window.spacing[0], 2.0 * window.spacing[1]),
    )
    n = len(cases)
    dry_part, x, y = fine[n:][which], result.x[window.columns], result.y[window.rows]
    life = march.life(fine[:n], dry_part)
    return BodyStress(
        body=np.array(settings.bodies, float),
        depth=depths,
        x=x,
        **{name: planes[:n, k] for k, name in enumerate(COMPONENTS)},
        shear=_column(fine[:n], "shear"),
        shear_x=x[_column(fine[:n], "column").astype(int)],
        shear_y=y[_column(fine[:n], "row").astype(int)],
        von_mises=_column(fine[:n], "von_mises"),
        orthogonal=_column(fine[:n], "orthogonal"),
        dang_van=_column(fine[:n], "dang_van"),
        shear_coarse=_column(coarse[:n], "shear"),
        shear_dry=_column(dry_part, "shear"),
        orthogonal_dry=_column(dry_part, "orthogonal"),
        dang_van_dry=_column(dry_part, "dang_van"),
        life=life,
        life_coarse=march.life(coarse[:n], coarse[n:][which]),
        traction=np.array([one.loads.traction_x.sum() / one.loads.pressure.sum() for one in cases]),
        left_out=np.array(float(left_out(result))),
    )


def with_stress(result: Solution) -> Solution:
    """Return a result with the stress that its case asks for."""
    if result.problem.stress is None or result.stress is not None:
        return result
    return result.but(stress=stress_below(result))


class March:
    """Goes through the depths, and keeps of each what is largest and the plane y = 0."""

    def __init__(self, depths: Array, settings: Stress, scale: float) -> None:
        self.depths, self.settings, self.scale = depths, settings, scale
        points = np.array(settings.residual or ((0.0, 0.0),))
        self._residual = np.interp(depths, *points.T)

    def through(
        self, cases: Sequence[Case], spacing: tuple[float, float], row: int | None = None
    ) -> tuple[Array, Array]:
        """Return `Worst` of each case and depth, and the components along one row of the nodes.

        Parameters
        ----------
        cases : sequence of Case
            On the same nodes.
        spacing : (float, float)
            Mesh widths along y and x [m].
        row : int or None
            Which row is kept.

        Returns
        -------
        found : (n, nz, 7) array
            In the order of `Worst` [Pa], places in nodes; ``risk`` in the pressure scale.
        planes : (n, 6, nz, nx) array
            [Pa]; of no depth without ``row``.
        """
        ny, nx = cases[0].loads.pressure.shape
        space = HalfSpace((ny, nx), spacing, single=True)
        spectra = [space.spectra_of(*(load / self.scale for load in one.loads)) for one in cases]
        found = np.empty((len(cases), self.depths.size, len(Worst._fields)))
        planes = np.empty((len(cases), 6, 0 if row is None else self.depths.size, nx))
        limit = self.settings.fatigue_limit / self.scale
        for k, depth in enumerate(self.depths):
            influence = space.influence(float(depth))
            for number, (case, spectrum) in enumerate(zip(cases, spectra, strict=True)):
                stress = space.stresses(spectrum, influence, case.poisson_ratio)
                stress[:2] += self._residual[k] / self.scale
                found[number, k] = worst(stress, self.settings, limit)
                if row is not None:
                    planes[number, :, k] = stress[:, row] * self.scale
        found[..., :4] *= self.scale
        found[..., 4] *= spacing[0]
        return found, planes

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


def window_of(result: Solution, pressure: Array) -> Window:
    """Return the nodes around the contact that carry its load.

    Parameters
    ----------
    result : Solution
        Gives the nodes.
    pressure : (ny, nx) array
        Of all that carries load [Pa].
    """
    scaled, slices, least = result.scaled, [], LEAST_PRESSURE * float(pressure.max())
    for axis, along in ((scaled.y, 1), (scaled.x, 0)):
        inside = np.flatnonzero((pressure.max(axis=along) > least) | (np.abs(axis) <= LEAST_WINDOW))
        first, last = int(inside[0]), int(inside[-1])
        if (last - first) % 2:  # every second node is one of the window
            first, last = (first, last + 1) if last + 1 < axis.size else (first + 1, last)
        slices.append(slice(first, last + 1))
    widths = result.scales.half_width_y, result.scales.half_width_x
    steps = [
        width * (float(axis[1] - axis[0]) if axis.size > 1 else 1.0)
        for axis, width in zip((scaled.y, scaled.x), widths, strict=True)
    ]
    return Window(slices[0], slices[1], (steps[0], steps[1]))


def depths_of(result: Solution, settings: Stress, window: Window) -> Array:
    """Return the depths [m], from two mesh widths on, of rough pressures the larger ones.

    Parameters
    ----------
    result : Solution
        Gives the half-widths.
    settings : Stress
        Number of depths and the deepest.
    window : Window
        With the mesh widths.
    """
    smaller = min(result.scales.half_width_x, result.scales.half_width_y)
    rough = result.heights is not None or result.contact is not None
    is_line = result.scaled.y.size == 1
    step = max(window.spacing) if rough and not is_line else min(window.spacing)
    shallowest = LEAST_DEPTH * step
    deepest = max(settings.deepest * smaller, 4.0 * shallowest)
    return np.geomspace(shallowest, deepest, settings.depths)


def cut(loads: SurfaceLoads, window: Window) -> SurfaceLoads:
    """Return the loads on the nodes of a window, of a part of those on all nodes."""
    return SurfaceLoads(*(load[window.rows, window.columns] for load in loads))


def poisson_ratio(result: Solution, body: int) -> float:
    """Return Poisson's ratio of a body, 1 or 2."""
    surface = result.problem.surface_1 if body == 1 else result.problem.surface_2
    return surface.material.poisson_ratio


def _dry(result: Solution, window: Window) -> SurfaceLoads:
    """Return the pressure of the dry smooth contact under the same load."""
    x, y = result.scaled.x[window.columns], result.scaled.y[window.rows]
    pressure = result.scales.hertz_pressure * result.problem.shape.dry_pressure(x, y[:, None])
    nothing = np.zeros_like(pressure)
    return SurfaceLoads(pressure, nothing, nothing)


def _halved(loads: SurfaceLoads) -> SurfaceLoads:
    """Return loads on every second node, by full weighting."""
    return SurfaceLoads(*(_weighted(_weighted(load).T).T for load in loads))


def _weighted(field: Array) -> Array:
    """Return [1, 2, 1]/4 over every second row; of a single one the row itself."""
    if field.shape[0] == 1:
        return field
    wide = np.pad(field, ((1, 1), (0, 0)))
    return np.asarray(0.25 * wide[:-2:2] + 0.5 * field[::2] + 0.25 * wide[2::2])


def middle_row(result: Solution, window: Window) -> int:
    """Return the row of the window nearest to y = 0."""
    return int(np.argmin(np.abs(result.scaled.y[window.rows])))


def _column(found: Array, name: str) -> Array:
    return np.ascontiguousarray(found[..., Worst._fields.index(name)])
