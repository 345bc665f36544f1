"""Continuation: from the smooth film to the rough one, in parts of the heights.

Full multigrid needs on each grid a start that is near the solution. Coarse grids do not resolve the
roughness, so their film is that of smooth surfaces; the first grid that resolves it gets the
heights in parts, and finer grids start from the rough film of the grid before.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from tehl.operators.heights import Heights
from tehl.operators.transfer import refine
from tehl.solver.level import Correction, Level
from tehl.solver.state import DivergedError, TouchingError, state_of, take_state
from tehl.typing import Array

SMOOTH_CYCLES = 2
"""Cycles without heights on the first grid that gets them."""
BLURRED = 12.0
"""Nodes per wave below which a grid does not resolve it well enough for its whole correction."""
COMPARABLE = 8.0
"""Nodes per wave from which the film of a grid is comparable with that of the next finer one."""
RAISED = 1e-4
"""Residual at which Newton's method goes on to the next part of the heights."""
FIRST_PART, LEAST_PART = 0.25, 0.02
"""First part of the heights for Newton's method, and the least one before the grid is given up."""
MOST_STEPS, QUICK, SLUGGISH, SMALLER = 12, 6, 9, 0.25
"""Newton steps for one part; those up to which the next part is larger, and from which smaller; and
what is left of a part that failed."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Continuation:
    """Settings of the continuation in the roughness.

    Attributes
    ----------
    correction : float
        Part of its correction that the finest grid that does not resolve the heights gives [-].
    limit : float
        Largest change of a pressure by that correction and those above it, over the pressure [-].
    ramp : int
        Cycles over which the heights are raised on the first grid that has them.
    points : float
        Nodes per wave from which a grid has the heights [-].
    """

    correction: float = 1.0
    limit: float = np.inf
    ramp: int = 4
    points: float = 8.0


class Roughness:
    """The heights on a hierarchy of levels, and the smooth film to start them from.

    Attributes
    ----------
    first : int
        Number of the first level that has the heights; that of levels if surfaces are smooth.
    first_comparable : int
        Number of the first level whose film is comparable with that of the next finer one.
    smooth : (int, array, float) or None
        Level, pressure and rigid approach of the smooth film before the heights were raised.
    points, amplitude : float
        Nodes per wave on the finest level, and half the range of the heights in the contact [-].

    Parameters
    ----------
    levels : list of Level
        Coarsest first.
    heights : Heights or None
        On the finest grid; None for smooth surfaces.
    settings : Continuation
        Settings.
    """

    def __init__(
        self, levels: list[Level], heights: Heights | None, settings: Continuation
    ) -> None:
        self.levels, self.settings = levels, settings
        self.first = self.first_comparable = len(levels)
        self.smooth: tuple[int, Array, float] | None = None
        self.points, self.amplitude = np.inf, 0.0
        if heights is not None:
            self._distribute(heights)

    def _distribute(self, heights: Heights) -> None:
        """Give the heights to the levels that resolve them.

        The finest level that does not resolve them well has its correction damped: it represents
        waves of another shape, and its whole correction would overshoot.
        """
        levels, last = self.levels, len(self.levels) - 1
        fields = heights.on([level.grid for level in levels])
        points = [heights.points_per_wave(level.grid) for level in levels]
        enough, comparable = self.settings.points, COMPARABLE
        self.first = next((k for k in range(1, last) if points[k] >= enough), last)
        later = (k for k in range(self.first, last) if points[k] >= comparable)
        self.first_comparable = next(later, last)
        for level, field in zip(levels[self.first :], fields[self.first :], strict=True):
            level.heights = field
        blurred = max((k for k in range(last) if points[k] < BLURRED), default=last)
        for k, level in enumerate(levels[blurred:last], start=blurred):
            part = self.settings.correction if k == blurred else 1.0
            level.correction = Correction(part=part, limit=self.settings.limit)
        finest = levels[-1].grid
        inside = np.hypot.outer(finest.y, finest.x) < 1.0
        self.points, self.amplitude = points[-1], 0.5 * float(np.ptp(fields[-1][inside]))

    @property
    def is_rough(self) -> bool:
        """Whether the surfaces have heights."""
        return self.first < len(self.levels)

    def is_on(self, levels: Sequence[Level]) -> bool:
        """Return whether the last of ``levels`` has the heights."""
        return len(levels) > self.first

    def begins_on(self, levels: Sequence[Level]) -> bool:
        """Return whether the last of ``levels`` is the first that has the heights."""
        return len(levels) - 1 == self.first

    def restart(self, number: int, expected_film: float) -> bool:
        """Start level ``number`` from the smooth film and raise the heights there once more.

        Return whether a smooth film was known; else the level starts from the Hertz pressure.
        """
        self.first = number
        self.first_comparable = max(self.first_comparable, number)
        if self.smooth is None:
            self.levels[number].start_from_hertz(expected_film)
            return False
        known, pressure, approach = self.smooth
        for level in self.levels[known + 1 : number + 1]:
            pressure = refine(pressure, level.grid)
        self.levels[number].set_state(pressure, approach)
        return True

    def remember_smooth_film(self, levels: Sequence[Level]) -> None:
        """Keep the film of the last of ``levels``, which does not have its heights yet."""
        fine = levels[-1]
        self.smooth = (len(levels) - 1, fine.film.p.copy(), fine.rigid_approach)


def raise_by_cycles(level: Level, ramp: int, iterate: Callable[[], float]) -> None:
    """Raise the heights of ``level`` in ``ramp`` equal parts, one iteration each but the last."""
    for number in range(1, ramp):
        level.apply_heights(number / ramp)
        iterate()


def raise_by_newton(
    level: Level, iterate: Callable[[], float], refresh: Callable[[], None], *, finest: bool
) -> None:
    """Raise the heights of ``level`` from none to all, in parts as large as Newton's method takes.

    Each part starts on the line through the films of the last two.

    Parameters
    ----------
    level : Level
        Starts from the smooth film.
    iterate : callable
        Performs and reports a Newton step and returns the residual.
    refresh : callable
        Makes the next step set up its preconditioner anew.
    finest : bool
        Whether this is the finest level. A film that is not positive on a coarser one is a start
        for the next, where it may be.

    Raises
    ------
    TouchingError
        When the film of the finest level is not positive with a part of the heights.
    DivergedError
        When even a small part more does not converge.
    """
    before, known, size = None, (0.0, state_of(level)), FIRST_PART
    while known[0] < 1.0:
        part = min(known[0] + size, 1.0)
        level.apply_heights(part)
        take_state(level, known[1] if before is None else _extrapolate(before, known, part))
        steps = _steps_to(RAISED, iterate)
        if steps is None:
            refresh()
            size *= SMALLER
        else:
            before, known = known, (part, state_of(level))
            size *= 1.5 if steps <= QUICK else 0.7 if steps > SLUGGISH else 1.0
            if finest and part < 1.0 and not level.film.h.min() > 0.0:
                raise TouchingError(part)
        if size < LEAST_PART:
            raise DivergedError


def _steps_to(residual: float, iterate: Callable[[], float]) -> int | None:
    """Iterate down to a residual; return the number of steps, None if it is not reached."""
    for number in range(1, MOST_STEPS + 1):
        try:
            if iterate() < residual:
                return number
        except ArithmeticError:
            return None
    return None


def _extrapolate(before: tuple[float, Array], known: tuple[float, Array], part: float) -> Array:
    """Return the state at ``part`` on the line through two others; cavities stay."""
    slope = (known[1] - before[1]) / (known[0] - before[0])
    onward = known[1] + (part - known[0]) * slope
    return np.where(known[1] == 0.0, 0.0, onward)
