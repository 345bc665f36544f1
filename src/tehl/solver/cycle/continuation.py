"""Continuation in the roughness amplitude, from the smooth film to the rough one.

Full multigrid needs a start near the solution on each grid. Coarse grids do not resolve the
roughness, so their film is that of smooth surfaces; the first grid that resolves it gets the
heights in parts, and finer grids start from the rough film of the next coarser grid
(docs/theory/numerics-rough.md).
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from tehl.base.typing import Array
from tehl.operators.heights import Heights
from tehl.operators.transfer import refine
from tehl.solver.cycle.level import Level
from tehl.solver.cycle.linearised import set_unknowns, unknowns
from tehl.solver.cycle.start import from_dry_pressure
from tehl.solver.judging.convergence import DivergedError

SMOOTH_CYCLES = 2
"""Cycles without heights on the first grid that has them."""
BLURRED = 12.0
"""Nodes per wave below which the full correction of a grid would overshoot."""
COMPARABLE = 8.0
"""Nodes per wave from which the film of a grid is comparable with that of the next finer one."""
RAISED_RESIDUAL = 1e-4
"""Residual at which Newton's method continues with the next part of the heights."""
FIRST_INCREMENT, LEAST_INCREMENT = 0.25, 0.02
"""First increment of the heights in Newton's method, and the smallest one before it fails."""
MOST_NEWTON_STEPS, QUICK_STEPS, SLOW_STEPS, INCREMENT_FACTOR = 12, 6, 9, 0.25
"""Most Newton steps per increment, steps up to which the next increment is larger and beyond which
it is smaller, and the factor on an increment that failed."""


LARGEST_ROUGH_STEP = 10.0
"""Change of pressure per cycle beyond which no iteration between rough surfaces recovers."""


class TouchingError(DivergedError):
    """The film is not positive with only ``part`` of the heights."""

    def __init__(self, part: float) -> None:
        super().__init__(part)
        self.part = part


@dataclass(frozen=True, kw_only=True, slots=True)
class Continuation:
    """Settings of the continuation in the roughness."""

    correction: float = 1.0
    """Factor on the correction of the finest grid that does not resolve the heights [-]."""
    limit: float = np.inf
    """Largest change of a pressure by that correction and the finer ones, over the pressure [-]."""
    ramp: int = 4
    """Cycles over which the heights are raised on the first grid that has them."""
    points: float = 8.0
    """Nodes per wave from which a grid has the heights [-]."""


class Roughness:
    """The heights on ``levels``, coarsest first, and the smooth film from which they are raised.

    ``first`` is the number of the first level that has the heights, ``len(levels)`` for smooth
    surfaces, and ``first_comparable`` that of the first level whose film is comparable with that of
    the next finer one.
    """

    def __init__(
        self, levels: list[Level], heights: Heights | None, settings: Continuation
    ) -> None:
        self.levels, self.settings, self.heights = levels, settings, heights
        self.first = self.first_comparable = len(levels)
        # level, pressure and rigid approach of the smooth film before the heights were raised
        self.smooth: tuple[int, Array, float, Array] | None = None
        self.points, self.amplitude = np.inf, 0.0
        if heights is not None:
            fields = heights.on([level.grid for level in levels])
            points, last = self._points(heights), len(levels) - 1
            self.first = next((k for k in range(1, last) if points[k] >= settings.points), last)
            for level, field in zip(levels[self.first :], fields[self.first :], strict=True):
                level.heights = field
            self._compare(heights)

    def refine(self, heights: Heights | None) -> None:
        """Set ``heights`` of a level that was appended; coarser ones keep theirs."""
        self.heights = heights
        if heights is None:
            self.first = self.first_comparable = len(self.levels)
            return
        self.levels[-1].heights = heights.together
        self._compare(heights)

    def _points(self, heights: Heights) -> list[float]:
        return [heights.points_per_wave(level.grid) for level in self.levels]

    def _compare(self, heights: Heights) -> None:
        """Set which levels are comparable, and how much of their corrections is taken.

        The correction of the finest level with fewer than `BLURRED` nodes per wave is damped: it
        represents waves of another shape, and its full correction would overshoot.
        """
        levels, last, points = self.levels, len(self.levels) - 1, self._points(heights)
        # error estimates compare grids that resolve the heights
        later = (k for k in range(self.first, last) if points[k] >= COMPARABLE)
        self.first_comparable = next(later, last)
        blurred = max((k for k in range(last) if points[k] < BLURRED), default=last)
        for k, level in enumerate(levels[blurred:last], start=blurred):
            part = self.settings.correction if k == blurred else 1.0
            level.correction = (part, self.settings.limit)
        # size of the waves in the contact, for the error estimate of a single grid
        finest = levels[-1].grid
        shape = self.levels[-1].equations.groups.shape
        inside = shape.radius_squared(finest.x, finest.y[:, None]) < 1.0
        self.points, self.amplitude = points[-1], 0.5 * float(np.ptp(heights.together[inside]))

    @property
    def is_rough(self) -> bool:
        """Whether the surfaces have heights."""
        return self.first < len(self.levels)

    @property
    def largest_step(self) -> float:
        """Change of a pressure per cycle beyond which no iteration recovers, in Hertz pressures."""
        return LARGEST_ROUGH_STEP if self.is_rough else math.inf

    @property
    def serves_others(self) -> bool:
        """Whether another strategy may go on from its grids: it raises no heights on another."""
        return not self.is_rough

    def spare(self, allowed: float) -> float:
        """Return the iteration error that may stay: none between rough surfaces, else ``allowed``.

        Their error bars are those of grids that differ in much.
        """
        return 0.0 if self.is_rough else allowed

    def film_part(self, minimum: float, smooth: float) -> float:
        """Return the minimum film over the film to which its error is relative [-].

        Parameters
        ----------
        minimum, smooth : float
            Minimum film, and the central one of the smooth contact: itself between smooth surfaces,
            the other between rough ones.
        """
        return max(minimum, 0.0) / smooth if self.is_rough else 1.0

    def is_on(self, levels: Sequence[Level]) -> bool:
        """Return whether the last of ``levels`` has the heights."""
        return len(levels) > self.first

    def restart(self, number: int, expected_film: float) -> bool:
        """Restart a level from the smooth film; the heights are raised there again.

        Parameters
        ----------
        number : int
            Of the level, zero is the coarsest.
        expected_film : float
            Central film H from which the Hertz pressure starts.

        Returns
        -------
        bool
            Whether a smooth film is available; if not, the level starts from the Hertz pressure.
        """
        self.first = number
        self.first_comparable = max(self.first_comparable, number)
        if self.smooth is None:
            from_dry_pressure(self.levels[number], expected_film)
            return False
        known, pressure, approach, asperity = self.smooth
        for level in self.levels[known + 1 : number + 1]:
            pressure = refine(pressure, level.grid)
            asperity = refine(asperity, level.grid) if asperity.size else asperity
        self.levels[number].set_state(pressure, approach, asperity)
        return True


def raise_by_newton(
    level: Level, iterate: Callable[[], float], refresh: Callable[[], None], *, finest: bool
) -> None:
    """Raise the heights of ``level`` by increments, each solved by Newton's method.

    The increment adapts to the number of Newton steps. Each solve starts from a linear
    extrapolation of the last two films in the amplitude (a secant predictor).

    Parameters
    ----------
    level : Level
        Starts from the smooth film.
    iterate : callable
        Performs and reports a Newton step; returns the residual.
    refresh : callable
        Discards the preconditioner, so that the next step computes a new one.
    finest : bool
        Whether this is the finest level. On a coarser one a film that is not positive is accepted:
        it may be positive on the next.

    Raises
    ------
    TouchingError
        When the film of the finest level is not positive with part of the heights.
    DivergedError
        When an increment of `LEAST_INCREMENT` does not converge.
    """
    before, known, size = None, (0.0, unknowns(level)), FIRST_INCREMENT
    while known[0] < 1.0:
        part = min(known[0] + size, 1.0)
        level.apply_heights(part)
        set_unknowns(level, known[1] if before is None else _extrapolate(before, known, part))
        steps = _steps_to(RAISED_RESIDUAL, iterate)
        if steps is None:
            refresh()  # the preconditioner belongs to the film that diverged
            size *= INCREMENT_FACTOR
        else:
            before, known = known, (part, unknowns(level))
            size *= 1.5 if steps <= QUICK_STEPS else 0.7 if steps > SLOW_STEPS else 1.0
            if finest and part < 1.0 and not level.film.h.min() > 0.0:
                raise TouchingError(part)
        if size < LEAST_INCREMENT:
            raise DivergedError


def _steps_to(residual: float, iterate: Callable[[], float]) -> int | None:
    """Iterate until ``residual`` is reached; return the number of steps, None on failure."""
    for number in range(1, MOST_NEWTON_STEPS + 1):
        try:
            if iterate() < residual:
                return number
        except ArithmeticError:
            return None
    return None


def _extrapolate(before: tuple[float, Array], known: tuple[float, Array], part: float) -> Array:
    """Return the unknowns at ``part`` by linear extrapolation; cavities stay."""
    slope = (known[1] - before[1]) / (known[0] - before[0])
    onward = known[1] + (part - known[0]) * slope
    return np.where(known[1] == 0.0, 0.0, onward)
