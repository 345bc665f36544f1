"""Deflection by the pressure of lines that crowd at the ends of a roller (docs/theory/rollers.md).

Convolution by FFT along x and sums across lines. The transform of 1/r along x decays as exp(-k s)
with the wave number k and the distance s of two lines, so that at most wave numbers only near lines
bend each other. An influence that ends at the largest offset has a kink there, whose transform
hardly decays: even polynomials in x with the same odd derivatives are taken from it, and summed by
moments.
"""

import math
from collections.abc import Iterator
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
by 4e-13, by 5e-12 with 30, which takes a tenth less memory; with samples by up to 7e-12."""
LINES, WAVES, GROWTH = 16, 8, 1.25
"""Lines of a block; its least wave numbers, and those of a block over those of the one before."""
AT_ONCE = 4
"""Lines whose influences are computed together: with more they take more memory than is kept."""
POWERS = np.array([2, 4, 6])
"""Of the polynomials."""


class Block(NamedTuple):
    """Influences of lines ``of`` on lines ``to`` at some wave numbers, (waves, to, of)."""

    waves: slice
    to: slice
    of: slice
    influences: Array


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
        self.blocks = _blocks(grid, groups)
        spectra = Spectra(grid, groups)
        # as by `reciprocal`
        ends, rows, widths = [-1] if grid.mirror else [0, -1], grid.shape[0], grid.widths
        own = np.full(rows, 0.5)
        own[ends] = 1.0
        others = 0.5 * widths / widths[:, None]  # on a line, of another one
        others[ends] = 0.0
        for first in range(0, rows, LINES):
            group = slice(first, min(first + LINES, rows))
            found = spectra.on(group)
            for block in self.blocks:
                if block.to == group:
                    part = own[group, None, None] * found[:, block.of, block.waves]
                    block.influences[:] += part.transpose(2, 0, 1)
                low, high = max(block.of.start, group.start), min(block.of.stop, group.stop)
                if low < high:
                    part = found[low - first : high - first, block.to, block.waves]
                    part = others[block.to, low:high].T[:, :, None] * part
                    of = slice(low - block.of.start, high - block.of.start)
                    block.influences[:, :, of] += part.transpose(2, 1, 0)
        self.polynomials = Polynomials(grid, spectra.on_lines)

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


class Spectra:
    """Transforms along x of the influences of lines on each other, less their polynomials.

    That of lines at a distance s is smooth along x: it is sampled at offsets up to pi s/`DECAY`
    apart, where the waves that samples do not tell apart have decayed.

    Parameters
    ----------
    grid, groups : Grid, Groups
        The lines, and the roller.
    """

    def __init__(self, grid: Grid, groups: Groups) -> None:
        self.grid, self.influence = grid, influence_of(grid, groups)
        self.y, self.faces = groups.ellipticity * grid.y, groups.ellipticity * grid.faces
        self.images = grid.shape[0] - 1 if grid.mirror else 0
        if grid.mirror:
            self.faces = np.append(-self.faces[:1:-1], self.faces)
        most = (grid.nx - 1) // 32  # what is left of the kink decays as k^-8
        strides = [1 << n for n in range(most.bit_length()) if (grid.nx - 1) % (1 << n) == 0]
        self.strides = strides or [1]
        derivatives = _derivatives(grid, groups, self.y, self.faces)
        self.of_images = np.tensordot(_powers_of(POWERS), derivatives, 1)
        """Coefficients of the powers of the offset over the largest one, (powers, to, from)."""

    @property
    def on_lines(self) -> Array:
        """Those of stored lines with their images, whose work on each other is the same."""
        found = self.of_images[:, :, self.images :].copy()
        found[:, :, 1:] += self.of_images[:, :, self.images - 1 :: -1] if self.images else 0.0
        return reciprocal(found, self.grid)

    def on(self, group: slice) -> Array:
        """Return the transforms of the influence of all lines on a group, (group, lines, waves)."""
        grid, rows = self.grid, range(group.start, group.stop)
        found = np.zeros((len(rows), grid.shape[0], grid.nx))
        for first in rows[::AT_ONCE]:
            some = slice(first, min(first + AT_ONCE, group.stop))
            self._add(some, found[some.start - group.start : some.stop - group.start])
        return found

    def _add(self, group: slice, out: Array) -> None:
        """Add those on a group of few lines to ``out``."""
        grid, places = self.grid, self.y[group]
        offsets = np.arange(grid.nx) / (grid.nx - 1)
        for first, last, stride in self._runs(places[0], places[-1]):
            cells = self.influence.on_lines(grid, places, self.faces[first : last + 1], stride)
            coefficients = self.of_images[:, group, first:last].transpose(1, 2, 0)
            cells -= coefficients @ offsets[::stride] ** POWERS[:, None]
            spectrum = stride * dct(cells, 1)
            waves = slice(spectrum.shape[2])
            if first < self.images:
                lines = slice(self.images - last + 1, self.images - first + 1)
                out[:, lines, waves] += spectrum[:, ::-1]
            else:
                out[:, first - self.images : last - self.images, waves] += spectrum

    def _runs(self, low: float, high: float) -> Iterator[tuple[int, int, int]]:
        """Yield first and last line, images before others, and the stride of their samples."""
        apart = np.maximum(np.maximum(self.faces[:-1] - high, low - self.faces[1:]), 0.0)
        reaches = DECAY / math.pi * self.grid.dx * np.array(self.strides[1:])
        numbers = np.searchsorted(reaches, apart, "right")
        changes = np.flatnonzero(np.diff(numbers)) + 1
        bounds = np.unique([0, self.images, apart.size, *changes])
        for first, last in pairwise(bounds.tolist()):
            yield first, last, self.strides[numbers[first]]


class Polynomials:
    """Even polynomials in x in place of the influence of each line on each other one.

    Parameters
    ----------
    grid : Grid
        The lines.
    on_lines : Array
        Coefficients of the powers of the offset over the largest one, (powers, to, from).
    """

    def __init__(self, grid: Grid, on_lines: Array) -> None:
        self.on_lines, degree = on_lines, int(POWERS[-1])
        places = np.linspace(-0.5, 0.5, grid.nx)[:, None] ** np.arange(degree + 1)
        self.places = np.ascontiguousarray(places.T)
        # (x - x')^n by the powers of x' and of x
        self.binomials = np.zeros((POWERS.size, degree + 1, degree + 1))
        for number, power in enumerate(POWERS):
            for one in range(power + 1):
                self.binomials[number, one, power - one] = (-1) ** one * math.comb(power, one)

    def deflection(self, pressure: Array) -> Array:
        """Return the deflection by the polynomials under a ``pressure``, of its shape."""
        moments = self.on_lines @ (pressure @ self.places.T)
        return np.asarray(np.einsum("nja,nab->jb", moments, self.binomials) @ self.places)


def _derivatives(grid: Grid, groups: Groups, places: Array, faces: Array) -> Array:
    """Return odd derivatives of the influence of lines at the largest offset, (n, to, from).

    By offsets over that one. Over a cell of width d the mean of f exceeds it by d^2/24 times its
    second and d^4/1920 times its fourth derivative.
    """
    length = (grid.nx - 1) * grid.dx
    found = np.diff(_of_strip((faces - places[:, None]) / length))
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
