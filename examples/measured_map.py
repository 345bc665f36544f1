"""A measured surface on a ball.

The script makes a honed surface and writes it as a table of micrometres, as instruments export it.
The case then states unit and point distance, which the file does not contain, removes the mean
plane, and filters out waves shorter than 10 um.

`tehl surface honed.csv --unit um --pixel "2 um"` shows the map and what a grid resolves of it. In
the contact, grooves along the entrainment remain in the film, and asperities across it are
flattened.
"""

import sys
import tempfile
from functools import cache
from pathlib import Path

import numpy as np

import tehl
from tehl import plots
from tehl.roughness import Map

PIXEL = 2e-6
DOMAIN = tehl.Domain(x=(-4.5, 1.5), y=(-3.0, 3.0))


def honed(columns: int = 280, rows: int = 240) -> np.ndarray:
    """Return heights of grooves along x with noise on a tilted plane [m]."""
    generator = np.random.default_rng(3)
    x, y = np.meshgrid(PIXEL * np.arange(columns), PIXEL * np.arange(rows))
    heights = np.zeros_like(x)
    for _ in range(40):
        wavelength, phase = generator.uniform(30e-6, 90e-6), generator.uniform(0.0, 2.0 * np.pi)
        lean = generator.normal(0.0, 0.1)
        heights += np.cos(2.0 * np.pi * (y + lean * x) / wavelength + phase)
    heights *= 20e-9 / heights.std()
    return heights + generator.normal(0.0, 5e-9, x.shape) + 2e-3 * x - 1e-3 * y


@cache
def solved(*, rough: bool) -> tehl.Result:
    """Return the film with the map on the ball, or without it."""
    ball = tehl.Surface(material="steel")
    with tempfile.TemporaryDirectory() as folder:
        if rough:
            path = Path(folder) / "honed.csv"
            np.savetxt(path, honed() * 1e6, delimiter=",", fmt="%.5f")
            measured = Map(file=str(path), unit="um", pixel=PIXEL, level="plane", lambda_s=10e-6)
            ball = ball.model_copy(update={"roughness": measured})
        problem = tehl.ContactProblem(
            title="Honed ball on a disc" if rough else "Smooth ball on a disc",
            contact=tehl.Contact(radius="20 mm", load="80 N", entrainment_speed="1.5 m/s"),
            surface_1=ball,
            surface_2=tehl.Surface(material="steel"),
            lubricant="mineral-oil",
        )
        return tehl.solve(problem, tehl.Options(points=129, domain=DOMAIN))


def main() -> dict[str, float]:
    """Return Sq of the map in the contact [nm] and its effect on the film."""
    rough, smooth = solved(rough=True), solved(rough=False)
    if rough.heights is None:
        raise RuntimeError("the surface is smooth")
    x, y = rough.scaled.x[None, :], rough.scaled.y[:, None]
    inside = x**2 + y**2 < 1.0
    ripple = (rough.film_thickness - smooth.film_thickness)[inside]
    return {
        "Sq [nm]": float(rough.heights.surface_1[inside].std() * 1e9),
        "Sq of the film ripple [nm]": float(ripple.std() * 1e9),
        "central film over smooth": rough.film.central / smooth.film.central,
        "minimum film over smooth": rough.film.minimum / smooth.film.minimum,
    }


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    for name, value in main().items():
        print(f"{name:<28} {value:.4g}")
    plots.film_map(solved(rough=True)).savefig(folder / "film.png", dpi=90)
    ripples = plots.micro_film_map(solved(rough=True), solved(rough=False))
    ripples.savefig(folder / "ripple.png", dpi=90)
