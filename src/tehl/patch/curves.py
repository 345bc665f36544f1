"""Pressure, area and flow of a rough patch over the distance of its mean planes.

The patch is pressed by rising loads (`tehl.patch.contact`), and oil flows through each gap
(`tehl.patch.flow`).
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.patch.contact import pressed
from tehl.patch.flow import flow_through

LARGEST_PATCH_NODES = 192
"""Most points of a patch along x and y: of a larger one the middle is taken."""
FLOW = 128
"""Most points along x and y for the flow: of a finer gap every second point, and so on."""
VANISHES = 30.0
"""Gap over Sq from which a sliding patch carries what the gap holds."""


@dataclass(frozen=True, kw_only=True, slots=True)
class PatchCurves:
    """Curves over the mean gap over Sq, which is the distance of the mean planes."""

    gaps: Array
    """Increasing [-]."""
    pressure: Array
    """Over E* [-]."""
    area: Array
    """Part of the area in which the surfaces touch [-]."""
    number: Array
    """Spots in which they touch, per area [1/m^2]."""
    channel: Array
    across: Array
    """Thickness of a smooth gap that conducts as much along x, over Sq, and conductance along y
    over that along x [-]."""
    carried: Array
    """What a sliding patch carries beside the gap, Phi_s over the mean gap [-]."""

    def load(self, gap: Array) -> Array:
        """Return the pressure over E* at gaps, linear below and exponential above the loads."""
        ends = self.gaps[[0, -1]]
        logs = PchipInterpolator(self.gaps, np.log(self.pressure), extrapolate=False)
        inside = logs(np.clip(gap, *ends))
        low, high = (float(logs.derivative()(end)) for end in ends)
        steep = min(high, -2.0 * self.gaps[-1])  # a last contact: a Gaussian tail
        inside = np.exp(np.maximum(inside + steep * np.maximum(gap - ends[1], 0.0), -300.0))
        return inside * (1.0 + low * np.minimum(gap - ends[0], 0.0))

    def mean_gap(self, gap: Array) -> Array:
        """Return the gap itself, below the last load exponential: it stays positive."""
        least = self.gaps[0]
        return np.where(gap >= least, gap, least * np.exp(np.minimum(gap - least, 0.0) / least))

    def conducts(self, gap: Array) -> Array:
        """Return the channel over Sq, in proportion to the mean gap below the last load."""
        ends = self.gaps[[0, -1]]
        part = PchipInterpolator(self.gaps, self.channel / self.gaps)(np.clip(gap, *ends))
        missing = (1.0 - part) * np.exp(-0.56 * np.maximum(gap - ends[1], 0.0))
        return self.mean_gap(gap) * (1.0 - missing)

    def conducts_across(self, gap: Array) -> Array:
        """Return the conductance along y over that along x."""
        ends = self.gaps[[0, -1]]
        part = PchipInterpolator(self.gaps, self.across)(np.clip(gap, *ends))
        return 1.0 + (part - 1.0) * np.exp(-0.56 * np.maximum(gap - ends[1], 0.0))

    def carries(self, gap: Array) -> Array:
        """Return Phi_s over the mean gap, beyond the first load as of low waves: 1 / gap^2."""
        last, end = self.gaps[-1], max(VANISHES, 2.0 * self.gaps[-1])
        inside = PchipInterpolator(self.gaps, self.carried)(np.clip(gap, self.gaps[0], last))
        beyond = (np.clip(gap, last, end) ** -2.0 - end**-2.0) / (last**-2.0 - end**-2.0)
        found: Array = inside * beyond
        return found

    def touching(self, gap: Array) -> Array:
        """Return the part of the area in which the surfaces touch."""
        found: Array = np.interp(gap, self.gaps, self.area)
        return np.where(gap > self.gaps[-1], 0.0, found)

    def spots(self, gap: Array) -> Array:
        """Return the spots per area [1/m^2]."""
        found: Array = np.interp(gap, self.gaps, self.number)
        return np.where(gap > self.gaps[-1], 0.0, found)


def periodic_patch(heights: Array, *, fits: bool) -> Array:
    """Return the middle of a patch about its mean, continued periodically.

    Parameters
    ----------
    heights : Array
        (ny, nx) [m]; at most `LARGEST_PATCH_NODES` points along x and y are taken.
    fits : bool
        Whether opposite edges fit together; otherwise the mirror image is added along x and y.
    """
    (ny, nx), most = heights.shape, LARGEST_PATCH_NODES
    low_y, low_x = max(ny - most, 0) // 2, max(nx - most, 0) // 2
    z = heights[low_y : low_y + most, low_x : low_x + most]
    z = z - z.mean()
    if fits and max(ny, nx) <= most:
        return z
    return np.block([[z, z[:, ::-1]], [z[::-1], z[::-1, ::-1]]])


def patch_curves(z: Array, pixel: tuple[float, float]) -> PatchCurves:
    """Return the curves of a periodic patch.

    Parameters
    ----------
    z : (ny, nx) array
        Heights of both surfaces together about their mean [m].
    pixel : (float, float)
        Distances dx, dy [m].

    Raises
    ------
    InputError
        If the contact of the patch does not converge.
    """
    sigma = float(z.std())
    slopes = (float(np.std(np.diff(z, axis=axis))) / pixel[1 - axis] for axis in (0, 1))
    slope = math.hypot(*slopes)
    stride = max(1, -(-max(z.shape) // FLOW))
    rows: list[tuple[float, ...]] = []
    flows: list[tuple[float, ...]] = []
    pressure, start = 3e-5 * slope, None  # over E*: of the first load
    while True:
        try:
            found = pressed(z, pixel, pressure, start)
        except ArithmeticError as error:
            raise InputError(f"asperities.map: {error}; a lambda_s removes spikes") from None
        gap = found.mean_gap / sigma
        if gap < 0.05:  # of Sq: that was the last load
            break
        number = found.spots / (z.size * pixel[0] * pixel[1])
        if len(rows) % 3 == 0:  # the flow is smoother and takes six times as long
            open_ = found.gap[::stride, ::stride]
            flow, mean = flow_through(open_, (stride * pixel[0], stride * pixel[1])), open_.mean()
            factors = (flow.along ** (1.0 / 3.0), flow.carried)
            flows.append((gap, flow.across / flow.along, *(one / mean for one in factors)))
        rows.append((gap, found.mean_pressure, found.area, number))
        start, pressure = found.pressure, 1.2 * pressure
    gaps, load, area, number = np.array(rows[::-1]).T
    at, *others = np.array(flows[::-1]).T
    inside = np.clip(gaps, at[0], at[-1])
    across, channel, carried = (PchipInterpolator(at, one)(inside) for one in others)
    return PatchCurves(
        gaps=gaps,
        pressure=load,
        area=area,
        number=number,
        channel=channel * gaps,
        across=across,
        carried=carried,
    )
