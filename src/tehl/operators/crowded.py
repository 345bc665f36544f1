"""Deflection by the pressure of lines that crowd at the ends of a roller (docs/theory/rollers.md).

Convolution by FFT along x and sums across lines. The transform of 1/r along x decays as exp(-k s)
with the wave number k and the distance s of two lines, so that at most wave numbers only near lines
bend each other. An influence that ends at the largest offset has a kink there, whose transform
hardly decays: even polynomials in x with the same odd derivatives are taken from it, and summed by
moments.
"""

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.fft import dct

from tehl.base.typing import Array
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import Groups
from tehl.operators.influence import influence_of, reciprocal

DECAY = 40.0
"""k s from which a wave number k of the pressure of one line does not bend another: deflections err
by 4e-13, by 5e-12 with 30, which takes a tenth less memory."""
LINES, WAVES, GROWTH = 16, 8, 1.25
"""Lines of a block; its least wave numbers, and those of a block over those of the one before."""


class Block(NamedTuple):
    """Influences of lines ``of`` on lines ``to`` at some wave numbers, (waves, to, of)."""

    waves: slice
    to: slice
    of: slice
    influences: Array

    def has(self, line: int) -> bool:
        """Whether the block contains the influences of a line."""
        return bool(self.of.start <= line < self.of.stop)


class CrowdedDeformation:
    """Convolution by FFT along x and sums across lines that are near for their wave number.

    A twentieth to a tenth of the influences of all pairs of lines is kept on 513 x 257 nodes.

    Parameters
    ----------
    grid, groups : Grid, Groups
        Lines that crowd, and the roller.
    """

    def __init__(self, grid: Grid, groups: Groups) -> None:
        self.period = 2 * (grid.nx - 1)
        self.polynomials = Polynomials(grid, groups)
        self.blocks = _blocks(grid, groups)
        influence, offsets = influence_of(grid, groups), np.arange(grid.nx) / (grid.nx - 1)
        powers = dct(offsets ** self.polynomials.powers[:, None], 1)
        # as by `reciprocal`
        ends, rows = [-1] if grid.mirror else [0, -1], grid.shape[0]
        own = np.full(rows, 0.5)
        own[ends] = 1.0
        for line, width in enumerate(grid.widths):
            others = 0.5 * width / grid.widths
            others[ends] = 0.0
            found = dct(influence.on_line(grid, line), 1)
            found -= self.polynomials.on_lines[:, line].T @ powers
            for block in self.blocks:
                if block.to.start <= line < block.to.stop:
                    part = own[line] * found[block.of, block.waves]
                    block.influences[:, line - block.to.start] += part.T
                if block.has(line):
                    part = others[block.to, None] * found[block.to, block.waves]
                    block.influences[:, :, line - block.of.start] += part.T
        self.polynomials.make_reciprocal(grid)

    def deflect(self, pressure: Array, out: Array) -> None:
        """Write the deflection under ``pressure`` to ``out``."""
        lines = np.ascontiguousarray(np.fft.rfft(pressure, self.period).T)
        parts = lines.view(float).reshape(*lines.shape, 2)  # real and imaginary
        product = np.empty_like(parts)
        for block in self.blocks:
            found = product[block.waves, block.to]
            np.matmul(block.influences, parts[block.waves, block.of], out=found)
        spectrum = product.view(complex)[:, :, 0].T
        out[:] = np.fft.irfft(spectrum, self.period)[:, : pressure.shape[1]]
        out += self.polynomials.deflection(pressure)


def _blocks(grid: Grid, groups: Groups) -> list[Block]:
    """Return empty blocks for all pairs of lines nearer than `DECAY` over a wave number."""
    places, length = groups.ellipticity * grid.y, (grid.nx - 1) * grid.dx
    bounds, found = [0], []
    while bounds[-1] < grid.nx:
        bounds.append(min(max(bounds[-1] + WAVES, int(GROWTH * bounds[-1])), grid.nx))
    for low, high in pairwise(bounds):
        reach = DECAY * length / (math.pi * low) if low else math.inf
        for first in range(0, places.size, LINES):
            last = min(first + LINES, places.size)
            near = places[first] - reach, places[last - 1] + reach
            start, stop = np.searchsorted(places, near)
            shape = high - low, last - first, stop - start
            lines = slice(first, last), slice(int(start), int(stop))
            found.append(Block(slice(low, high), *lines, np.zeros(shape)))
    return found


class Polynomials:
    """Even polynomials in x in place of the influence of each line on each other one.

    Parameters
    ----------
    grid, groups : Grid, Groups
        The lines, and the roller.
    """

    def __init__(self, grid: Grid, groups: Groups) -> None:
        self.powers, degree = np.array([2, 4, 6]), 6
        self.on_lines = np.tensordot(_powers_of(self.powers), _derivatives(grid, groups), 1)
        """Coefficients of the powers of the offset over the largest one, (powers, to, from)."""
        places = np.linspace(-0.5, 0.5, grid.nx)[:, None] ** np.arange(degree + 1)
        self.places = np.ascontiguousarray(places.T)
        # (x - x')^n by the powers of x' and of x
        self.binomials = np.zeros((self.powers.size, degree + 1, degree + 1))
        for number, power in enumerate(self.powers):
            for one in range(power + 1):
                self.binomials[number, one, power - one] = (-1) ** one * math.comb(power, one)

    def make_reciprocal(self, grid: Grid) -> None:
        """Make the work of lines on each other the same both ways."""
        self.on_lines = reciprocal(self.on_lines, grid)

    def deflection(self, pressure: Array) -> Array:
        """Return the deflection by the polynomials under a ``pressure``, of its shape."""
        moments = self.on_lines @ (pressure @ self.places.T)
        return np.asarray(np.einsum("nja,nab->jb", moments, self.binomials) @ self.places)


def _derivatives(grid: Grid, groups: Groups) -> Array:
    """Return odd derivatives of the influence of lines at the largest offset, (n, to, from).

    By offsets over that one. Over a cell of width d the mean of f exceeds it by d^2/24 times its
    second and d^4/1920 times its fourth derivative.
    """
    stretch = groups.ellipticity / ((grid.nx - 1) * grid.dx)
    places, faces = stretch * grid.y[:, None], stretch * grid.faces
    found = np.diff(_of_strip(faces - places))
    if grid.mirror:
        found[:, :, 1:] += np.diff(_of_strip(faces[1:] + places))
    square = 1.0 / (grid.nx - 1) ** 2
    found[0] += square / 24.0 * found[1] + square**2 / 1920.0 * found[2]
    found[1] += square / 24.0 * found[2]
    return np.asarray(groups.deflection_factor * grid.dx * found)


def _of_strip(end: Array) -> Array:
    """Return the first three odd derivatives of asinh(v/x) at x = 1: of the integral of 1/r over v.

    Those are -v times polynomials in 1/r.
    """
    part = 1.0 / np.hypot(1.0, end)
    square = part**2
    fifth = 24.0 + square * (12.0 + square * (9.0 + square * (105.0 * square - 30.0)))
    polynomials = np.array([np.ones_like(end), 2.0 + square + 3.0 * square**2, fifth])
    return np.asarray(-end * part * polynomials)


def _powers_of(powers: Array) -> Array:
    """Return the matrix from odd derivatives at one of an even polynomial to its coefficients."""
    rows = [[math.perm(int(power), n) for power in powers] for n in powers - 1]
    return np.linalg.inv(np.array(rows, float))
