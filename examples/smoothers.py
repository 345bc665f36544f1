"""Why plain Gauss-Seidel fails in a loaded contact.

The simplest relaxation changes the pressure of one node until its residual vanishes, then that of
the next. This converges while the film is hardly deformed. Under load the film at a node depends on
all pressures: each change increases the residual of the neighbours by more than it reduces that of
the node, and the iteration does not converge.

The hybrid line relaxation solves whole lines with the film that changes along, and changes the
pressure in the contact by dipoles, whose effect is local. Both run in the same multigrid cycle on
the same grid; only `smoother` differs.
"""

import sys
from functools import cache
from pathlib import Path

from matplotlib.figure import Figure

import tehl

LOADS = (5.0, 20.0)
SMOOTHERS = ("gauss-seidel", "fast")


@cache
def residuals(load: float, smoother: str) -> tuple[float, ...]:
    """Return the residual after each cycle on 65 x 65 nodes."""
    problem = tehl.ContactProblem(
        contact=tehl.Contact(radius="20 mm", moes_load=load, moes_speed=10.0),
        surface_1=tehl.Surface(material="steel"),
        surface_2=tehl.Surface(material="steel"),
        lubricant="mineral-oil",
    )
    domain = tehl.Domain(x=(-4.5, 1.5), y=(-3.0, 3.0))
    options = tehl.Options(points=65, domain=domain, smoother=smoother, accuracy="tight")
    try:
        result = tehl.solve(problem, options)
    except tehl.ConvergenceError as error:
        result = error.result
    return tuple(report.residual for report in result.history if report.points == (65, 65))


def main() -> dict[tuple[float, str], float]:
    """Return the last residual for each load and smoother [-]."""
    return {(load, name): residuals(load, name)[-1] for load in LOADS for name in SMOOTHERS}


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    figure = Figure(figsize=(6.0, 4.2), layout="constrained")
    axes = figure.add_subplot(xlabel="V-cycle on 65 x 65", ylabel="scaled residual", yscale="log")
    for (load, name), last in main().items():
        history, style = residuals(load, name), "o-" if name == "fast" else "s--"
        axes.plot(range(1, len(history) + 1), history, style, label=f"{name}, M = {load:g}")
        print(f"M = {load:<4g}{name:<14}last residual {last:.1e}")
    axes.legend()
    figure.savefig(folder / "residuals.png", dpi=100)
