"""Crowned gear teeth: an elliptical contact.

Two crowned teeth touch on an ellipse, with a radius of 12 mm along the entrainment and of 60 mm
across it: the template `gear-ellipse`. Lengths are scaled with the half-width of their direction,
so the solver treats circles and ellipses alike.

Oil that enters a wide ellipse can hardly escape sideways: the smallest film, still in the side
lobes, is much nearer to the central film than in a circular contact.
"""

import sys
import tempfile
from functools import cache
from pathlib import Path

import tehl
from tehl import plots
from tehl.io.templates import template_text


@cache
def solved() -> tehl.Result:
    """Return the film between the teeth."""
    with tempfile.TemporaryDirectory() as folder:
        case = Path(folder) / "gear.toml"
        case.write_text(template_text("gear-ellipse"), encoding="utf-8")
        problem, options = tehl.read_case_and_options(case)
    return tehl.solve(problem, options)


def main() -> dict[str, float]:
    """Return the shape of the contact and its films."""
    result = solved()
    return {
        "a_y / a_x": result.groups.ellipticity,
        "central film [nm]": result.film.central * 1e9,
        "minimum film [nm]": result.film.minimum * 1e9,
        "X of the minimum": result.film_scaled.minimum_at[0],
        "Y of the minimum": result.film_scaled.minimum_at[1],
    }


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    for name, value in main().items():
        print(f"{name:<22}{value:.4g}")
    plots.film_map(solved()).savefig(folder / "film.png", dpi=100)
    plots.pressure_map(solved()).savefig(folder / "pressure.png", dpi=100)
