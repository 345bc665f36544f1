"""Continuation in the roughness amplitude, from the smooth film to the rough one.

Full multigrid needs a start near the solution on each grid. Coarse grids do not resolve the
roughness, so their film is that of smooth surfaces; the first grid that resolves it gets the
heights in parts, and finer grids start from the rough film of the next coarser grid
(docs/theory/numerics-rough.md).
"""

import math
from collections.abc import Callable
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
MOST_NEWTON_STEPS = 12
"""Most steps of Newton's method per increment of the heights."""
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
        # level, pressure and rigid motions of the smooth film before the heights were raised
        self.smooth: tuple[int, Array, Array, Array] | None = None
        self.points, self.amplitude = np.inf, 0.0
        if heights is not None:
            fields = heights.on([level.grid for level in levels])
            points, last = self._points(heights), len(levels) - 1
            self.first = next((k for k in range(1, last) if points[k] >= settings.points), last)
            for level, field in zip(levels[self.first :], fields[self.first :], strict=True):
                level.sources.heights = field
            self._compare(heights)

    def refine(self, heights: Heights | None) -> None:
        """Set ``heights`` of a level that was appended; coarser ones keep theirs."""
        self.heights = heights
        if heights is None:
            self.first = self.first_comparable = len(self.levels)
            return
        self.levels[-1].sources.heights = heights.together
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
            level.correction = level.correction._replace(part=part, limit=self.settings.limit)
        # size of the waves in the contact, for the error estimate of a single grid
        finest = levels[-1].grid
        shape = self.levels[-1].equations.groups.shape
        inside = shape.radius_squared(finest.x, finest.y[:, None]) < 1.0
        self.points = heights.points_per_wave(finest, rarest=True)
        self.amplitude = 0.5 * float(np.ptp(heights.together[inside]))

    @property
    def is_rough(self) -> bool:
        """Whether the surfaces have heights."""
        return self.first < len(self.levels)

    @property
    def largest_step(self) -> float:
        """Change of a pressure per cycle beyond which no iteration recovers, in Hertz pressures."""
        return LARGEST_ROUGH_STEP if self.is_rough else math.inf

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
        known, pressure, rigid, asperity = self.smooth
        for level in self.levels[known + 1 : number + 1]:
            pressure = refine(pressure, level.grid)
            asperity = refine(asperity, level.grid) if asperity.size else asperity
        self.levels[number].set_state(pressure, rigid, asperity)
        return True


class Homotopy:
    """Raises the heights of a level by increments, each of them solved by Newton's method.

    The increment adapts to the number of Newton steps. Each solve starts from a linear
    extrapolation of the last two films in the amplitude (a secant predictor).

    Parameters
    ----------
    level : Level
        Starts from the smooth film.
    refresh : callable
        Discards what Newton's method keeps of earlier steps.
    finest : bool
        Whether this is the finest level. On a coarser one a film that is not positive is accepted:
        it may be positive on the next.
    """

    first, least = 0.25, 0.02
    """First increment of the heights, and the smallest one before it fails."""
    most_steps, quick, slow = MOST_NEWTON_STEPS, 6, 9
    """Most steps per increment, steps up to which the next one is larger, and beyond which it is
    smaller."""
    larger, smaller, failed = 1.5, 0.7, 0.25
    """Factors on the next increment then, and on one that failed."""

    def __init__(self, level: Level, refresh: Callable[[], None], *, finest: bool = False) -> None:
        self.level, self.refresh, self.finest = level, refresh, finest
        self.known = self.before = (0.0, unknowns(level))

    def run(self, iterate: Callable[[], float]) -> None:
        """Raise all heights by ``iterate``, which performs a step and returns the residual.

        Raises
        ------
        TouchingError
            When the film of the finest level is not positive with part of the heights.
        DivergedError
            When the smallest increment does not converge.
        """
        part, size = 0.0, self.first
        while part < 1.0:
            wanted = min(part + size, 1.0)
            self.level.apply_heights(wanted)
            self.begin(wanted)
            steps = self._steps(iterate)
            if steps is None:
                self.refresh()  # they belong to the film that diverged
                size *= self.failed
            else:
                part = wanted
                self.keep(part)
                size *= self.larger if steps <= self.quick else 1.0
                size *= self.smaller if steps > self.slow else 1.0
            if size < self.least:
                raise DivergedError

    def begin(self, part: float) -> None:
        """Set the start with a part of the heights."""
        set_unknowns(self.level, self.predicted(part))

    def predicted(self, part: float) -> Array:
        """Return the unknowns with a part of the heights by the secant; cavities stay."""
        (earlier, first), (later, last) = self.before, self.known
        if later == 0.0:
            return last
        onward = last + (part - later) * (last - first) / (later - earlier)
        return np.where(last == 0.0, 0.0, onward)

    def keep(self, part: float) -> None:
        """Note the solution with a part of the heights."""
        self.before, self.known = self.known, (part, unknowns(self.level))
        if self.finest and part < 1.0 and not self.level.film.h.min() > 0.0:
            raise TouchingError(part)

    def _steps(self, iterate: Callable[[], float]) -> int | None:
        """Iterate until `RAISED_RESIDUAL`; return the number of steps, None on failure."""
        for number in range(1, self.most_steps + 1):
            try:
                if iterate() < RAISED_RESIDUAL:
                    return number
            except ArithmeticError:
                return None
        return None
