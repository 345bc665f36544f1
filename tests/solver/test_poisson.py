"""`fas.cycle` and `fmg.full_multigrid` on Poisson's equation, with the rates of the textbooks.

The level below has the three methods that a level of the lubricated contact has, and nothing else;
its equation is  -u'' = b  in two dimensions on the unit square, u = 0 on the edges.
"""

import numpy as np
import pytest

from tehl.base.typing import Array
from tehl.solver.cycle.fas import Cycle, Transfers, cycle
from tehl.solver.cycle.fmg import full_multigrid

V11 = Cycle(kind="V", pre_sweeps=1, post_sweeps=1, extra_sweeps=0)


class PoissonLevel:
    """Five-point Laplacian on n x n intervals, red-black Gauss-Seidel, full weighting, bilinear."""

    def __init__(self, intervals: int) -> None:
        self.h = 1.0 / intervals
        self.u, self.b, self.restricted = np.zeros((3, intervals + 1, intervals + 1))
        red = np.indices(self.u.shape).sum(axis=0) % 2 == 0
        self.colours = red, ~red

    def laplacian(self) -> Array:
        """A(u), zero on the edges."""
        u, result = self.u, np.zeros_like(self.u)
        around = u[:-2, 1:-1] + u[2:, 1:-1] + u[1:-1, :-2] + u[1:-1, 2:]
        result[1:-1, 1:-1] = (4.0 * u[1:-1, 1:-1] - around) / self.h**2
        return result

    def residual(self) -> Array:
        """b - A(u), zero on the edges."""
        result = self.b - self.laplacian()
        result[[0, -1]] = result[:, [0, -1]] = 0.0
        return result

    def relax(self, sweeps: int) -> None:
        """Red-black Gauss-Seidel."""
        for _ in range(sweeps):
            for colour in self.colours:
                change = 0.25 * self.h**2 * self.residual()
                self.u[colour] += change[colour]


def restrict(fine: PoissonLevel, coarse: PoissonLevel) -> None:
    """A_c(u_c) = A_c(I u) + R (b - A(u)), I injection, R full weighting."""
    coarse.u[:] = coarse.restricted[:] = fine.u[::2, ::2]
    r, weighted = fine.residual(), np.zeros_like(coarse.u)
    sides = r[1:-2:2, 2:-1:2] + r[3::2, 2:-1:2] + r[2:-1:2, 1:-2:2] + r[2:-1:2, 3::2]
    corners = r[1:-2:2, 1:-2:2] + r[3::2, 3::2] + r[1:-2:2, 3::2] + r[3::2, 1:-2:2]
    weighted[1:-1, 1:-1] = (4.0 * r[2:-1:2, 2:-1:2] + 2.0 * sides + corners) / 16.0
    coarse.b[:] = coarse.laplacian() + weighted


def correct(fine: PoissonLevel, coarse: PoissonLevel) -> None:
    """u += P (u_c - I u), P bilinear."""
    fine.u += bilinear(coarse.u - coarse.restricted)


POISSON = Transfers(restrict, correct)


def bilinear(values: Array) -> Array:
    """Insert midpoints along both axes."""
    fine = np.zeros([2 * n - 1 for n in values.shape])
    fine[::2, ::2] = values
    fine[1::2, ::2] = 0.5 * (values[1:] + values[:-1])
    fine[:, 1::2] = 0.5 * (fine[:, :-1:2] + fine[:, 2::2])
    return fine


def hierarchy(intervals: int) -> list[PoissonLevel]:
    """Levels down to two intervals, whose only unknown one sweep solves for."""
    sizes = [2**k for k in range(1, intervals.bit_length())]
    return [PoissonLevel(n) for n in sizes]


def exact(level: PoissonLevel) -> Array:
    """sin(pi x) sin(2 pi y)."""
    x = np.linspace(0.0, 1.0, len(level.u))
    return np.outer(np.sin(2.0 * np.pi * x), np.sin(np.pi * x))


@pytest.mark.parametrize("intervals", [32, 64, 128])
def test_a_v_cycle_reduces_the_residual_by_ten_on_every_grid(intervals: int) -> None:
    """V(1,1), red-black: 0.06 to 0.12 per cycle (Trottenberg et al. 2001, sections 2.5 and 4.5)."""
    levels = hierarchy(intervals)
    levels[-1].u[1:-1, 1:-1] = np.random.default_rng(1).standard_normal((intervals - 1,) * 2)
    norms = []
    for _ in range(8):
        cycle(levels, lambda: levels[0].relax(1), POISSON, V11)
        norms.append(np.linalg.norm(levels[-1].residual()))
    assert (norms[-1] / norms[2]) ** (1 / 5) < 0.13


def test_w_and_f_cycles_converge_at_least_as_fast() -> None:
    rates = {}
    for kind in "VWF":
        levels = hierarchy(64)
        levels[-1].u[1:-1, 1:-1] = np.random.default_rng(1).standard_normal((63, 63))
        shape = Cycle(kind=kind, pre_sweeps=1, post_sweeps=1, extra_sweeps=0)
        norms = []
        for _ in range(6):
            cycle(levels, lambda levels=levels: levels[0].relax(1), POISSON, shape)
            norms.append(np.linalg.norm(levels[-1].residual()))
        rates[kind] = (norms[-1] / norms[1]) ** (1 / 4)
    assert rates["W"] < rates["V"] * 1.02
    assert rates["F"] < rates["V"] * 1.02


def test_full_multigrid_solves_to_the_discretisation_error_in_one_cycle_per_level() -> None:
    """The algebraic error is below half of the discretisation error, which is of second order."""
    errors = []
    for intervals in (32, 64, 128):
        levels = hierarchy(intervals)
        for level in levels:
            level.b[1:-1, 1:-1] = (5.0 * np.pi**2 * exact(level))[1:-1, 1:-1]
        visits: list[int] = []

        def improve(upto: list[PoissonLevel], visits: list[int] = visits) -> None:
            upto[-1].b[1:-1, 1:-1] = (5.0 * np.pi**2 * exact(upto[-1]))[1:-1, 1:-1]
            visits.append(len(upto))
            cycle(upto, lambda: upto[0].relax(1), POISSON, V11)

        def start(coarse: PoissonLevel, fine: PoissonLevel) -> None:
            fine.u[:] = bilinear(coarse.u)

        full_multigrid(levels, lambda levels=levels: levels[0].relax(1), start, improve)
        assert visits == list(range(2, len(levels) + 1))
        found = levels[-1].u.copy()
        for _ in range(12):
            cycle(levels, lambda levels=levels: levels[0].relax(1), POISSON, V11)
        discretisation = np.abs(levels[-1].u - exact(levels[-1])).max()
        assert np.abs(found - levels[-1].u).max() < 0.5 * discretisation
        errors.append(discretisation)
    assert np.log2(errors[0] / errors[-1]) / 2 == pytest.approx(2.0, abs=0.05)
