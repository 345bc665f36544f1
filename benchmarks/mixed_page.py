"""The part of docs/validation.md on mixed lubrication by asperities below the mesh."""

import math
from collections.abc import Iterator

import numpy as np
from tests.reference import moes_contact, touching_contact

from benchmarks.markdown import head, row
from tehl.api.problem import ContactProblem
from tehl.api.solvers import solve
from tehl.contact.options import Options
from tehl.estimate.scaling import ScaledProblem
from tehl.operators.influence import dense_matrix
from tehl.solver.cycle.level import Level
from tehl.solver.monitor import SILENT
from tehl.solver.steady import try_strategies

DRY = """
## Asperities below the mesh: dry limit

Greenwood and Tripp's asperities at vanishing speed (λ = 0.02 by the film formula, η β σ = 0.1, σ/β
= 0.02), against a damped iteration for the pressure alone, P = P_a(H₀₀ + gap + K P) with the dense
matrix K and the load, on the same nodes. Largest pressure in p_h, H₀₀ in a²/R.
"""
SHARES = """
## Asperities below the mesh: load share

M = 100, L = 8, σ/β = 0.01, η β σ = 0.05; λ is the smooth film by formula over σ. Load on asperities
on three grids, extrapolated at second order. The film is thicker than the smooth one where the
channel between rough surfaces conducts less. Published models agree in trend only: Zhu and Wang
(2012) find practically full films above λ of 0.6 to 1.2; a formula in use has the film carry
1 - exp(-1.8 λ^1.2). The share depends on how stiff the asperities are.
"""
GRIDS = (129, 257, 513)
LAMBDAS = (0.1, 0.3, 0.5, 1.0, 2.0)


def dry() -> Iterator[str]:
    """Yield the comparison of a dry contact."""
    yield DRY
    yield from head("nodes", "share", "p_max", "iteration", "H₀₀", "iteration")
    for points in (33, 49):
        problem = touching_contact(100.0, 8.0, 0.02, steep=0.02, dense=0.1)
        options = Options(points=points, accuracy="tight", half_domain="never")
        attempt, _ = try_strategies(problem, options, monitor=SILENT, rough=False)
        level = attempt.run.finest
        share = level.film.asperity.sum() / level.pressure.sum()
        largest, approach = _iterated(problem, level)
        yield row(
            f"{points}²",
            f"{share:.4f}",
            f"{level.pressure.max():.4f}",
            f"{largest:.4f}",
            f"{level.rigid_approach:.4f}",
            f"{approach:.4f}",
        )


def _iterated(problem: ContactProblem, level: Level) -> tuple[float, float]:
    """Return largest pressure and approach of the dry contact on the nodes of a level."""
    equations, grid, law = level.equations, level.grid, problem.asperities
    assert law is not None
    scales, sigma = ScaledProblem.of(problem).scales, problem.asperity_rms
    influence = dense_matrix(grid.shape, grid.mirror, equations.influence)
    gap, unit = equations.gap.ravel(), sigma / scales.film_thickness
    pressure, approach = np.zeros(gap.size), 6.0 * unit
    for _ in range(400):
        separation = approach + gap + influence @ pressure
        carried = law.pressure(separation / unit, sigma, problem.reduced_modulus)
        pressure += 0.3 * (carried / scales.hertz_pressure - pressure)
        missing = 2.0 * math.pi / 3.0 - pressure.sum() * grid.dx * grid.dy
        approach -= 0.3 * unit * missing
    return float(pressure.max()), approach


def shares() -> Iterator[str]:
    """Yield the load share over lambda."""
    yield SHARES
    smooth = solve(moes_contact(100.0, 8.0), Options(points=GRIDS[-1])).film.central
    names = (f"{points}²" for points in GRIDS)
    yield from head("λ", *names, "extrapolated", "film over smooth film", "by the formula")
    for ratio in LAMBDAS:
        options = (Options(points=points, accuracy="tight", tolerance=1e-5) for points in GRIDS)
        runs = [solve(touching_contact(100.0, 8.0, ratio), one) for one in options]
        found = [run.load_sharing.share for run in runs if run.load_sharing]
        limit = found[-1] + (found[-1] - found[-2]) / 3.0
        yield row(
            f"{ratio:g}",
            *(f"{100.0 * share:.2f} %" for share in found),
            f"{100.0 * limit:.2f} %",
            f"{runs[-1].film.central / smooth:.3f}",
            f"{100.0 * math.exp(-1.8 * ratio**1.2):.1f} %",
        )


def section() -> Iterator[str]:
    """Yield the lines of the part."""
    yield from dry()
    yield from shares()
