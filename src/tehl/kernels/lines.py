"""Compiled sum across lines whose transforms along x are known."""

from numba import njit

from tehl.kernels.lanes import LANES, load, number, put, store
from tehl.typing import Array


@njit(cache=True)
def sum_across(
    lines: Array, kernel: Array, scratch: Array, out: Array, sizes: tuple[int, int, int, int]
) -> None:
    """Write the transforms of w = K * p: for each wavenumber a sum over the lines.

    Arrays are given by their addresses. ``lines, out`` (rows, modes) complex: transforms of p and
    of w; ``kernel`` (modes, width): that of the kernel at row offsets -(rows - 1), ..., real, for
    it is even; ``scratch`` (2 rows + 2 LANES,); ``sizes``: rows, modes, width, and one if row 0 is
    a symmetry line: then the image of each other row counts too.
    """
    rows, modes, width, mirror = sizes
    real, imaginary = 2 * rows, 2 * rows + LANES
    for k in range(modes):
        for j in range(rows):
            at = 2 * (j * modes + k)
            put(scratch, 2 * j, number(lines, at))
            put(scratch, 2 * j + 1, number(lines, at + 1))
        here = k * width + rows - 1
        for first in range(0, rows, LANES):
            weight = load(kernel, here + first)
            re, im = weight * number(scratch, 0), weight * number(scratch, 1)
            for j in range(1, rows):
                weight = load(kernel, here + first - j)
                if mirror:
                    weight += load(kernel, here + first + j)
                re += weight * number(scratch, 2 * j)
                im += weight * number(scratch, 2 * j + 1)
            store(scratch, real, re)
            store(scratch, imaginary, im)
            for lane in range(min(LANES, rows - first)):
                at = 2 * ((first + lane) * modes + k)
                put(out, at, number(scratch, real + lane))
                put(out, at + 1, number(scratch, imaginary + lane))
