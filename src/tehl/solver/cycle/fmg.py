"""Full multigrid (FMG): from the coarsest grid up, each grid starts from the coarser solution.

Brandt 1977; Trottenberg, Oosterlee and Schüller 2001, section 2.6; Venner and Lubrecht 2000.
"""

from collections.abc import Callable, Sequence
from typing import TypeVar

AnyLevel = TypeVar("AnyLevel")


def full_multigrid(
    levels: Sequence[AnyLevel],
    solve_coarsest: Callable[[], None],
    start: Callable[[AnyLevel, AnyLevel], None],
    improve: Callable[[Sequence[AnyLevel]], None],
    solved: int = 0,
) -> None:
    """Solve on the coarsest level; then level by level interpolate and improve by cycles.

    With second-order discretisation and interpolation of higher order one or two cycles per level
    reduce the error of the iteration below that of the discretisation, in O(n) operations.

    Parameters
    ----------
    levels : sequence
        Coarsest first. ``improve`` may append finer ones, or drop the finest.
    solve_coarsest : callable
        Solves the problem on ``levels[0]``.
    start : callable
        Called as ``start(coarse, fine)``: first approximation on the next finer level.
    improve : callable
        Called with the levels up to the next finer one: multigrid cycles.
    solved : int
        Levels that are solved already.
    """
    if not solved:
        solve_coarsest()
    finest = max(solved, 1)
    while finest < len(levels):
        start(levels[finest - 1], levels[finest])
        improve(levels[: finest + 1])
        finest += 1
