"""A sliding ball on a disc: heat and traction.

The template `thermal`: a steel ball on a steel disc at a Hertz pressure of 0.8 GPa, the ball faster
than the disc by half the mean speed. The Eyring law limits the shear stress, and its heat warms the
film and both surfaces.

The traction is negative because the film brakes surface 1, the faster one. Nearly all of the heat
goes into the solids. The missing heat is the error of the mesh.

The film is warmest at mid-film. The surfaces heat up on their way through the contact, the slower
one more, and are warmest towards the outlet. In the inlet the oil is still cold: the film is hardly
thinner than without heat.
"""

import sys
import tempfile
from functools import cache
from pathlib import Path

import tehl
from tehl import plots
from tehl.io.templates import template_text
from tehl.post.thermal_effect import isothermal_reference


@cache
def solved(*, heat: bool = True) -> tehl.Result:
    """Return the film of the contact, with or without heat."""
    with tempfile.TemporaryDirectory() as folder:
        case = Path(folder) / "thermal.toml"
        case.write_text(template_text("thermal"), encoding="utf-8")
        problem, options = tehl.read_case_and_options(case)
    return tehl.solve(problem if heat else isothermal_reference(problem), options)


def main() -> dict[str, float]:
    """Return films [nm], temperature rises [K], traction [-] and powers [W]."""
    result = solved()
    found, traction, balance = result.temperature, result.traction, result.heat.balance
    return {
        "central film [nm]": result.film.central * 1e9,
        "the same without heat [nm]": solved(heat=False).film.central * 1e9,
        "minimum film [nm]": result.film.minimum * 1e9,
        "mid-film rise, centre [K]": found.mid_film_rise_central,
        "largest rise, film [K]": found.film_rise_max,
        "largest rise, surface 1 [K]": found.surface_1_rise_max,
        "largest rise, surface 2 [K]": found.surface_2_rise_max,
        "traction at mid-film [-]": traction.mid_film,
        "shear heat [W]": balance.shear,
        "compression [W]": balance.compression,
        "heat into surface 1 [W]": balance.surface_1,
        "heat into surface 2 [W]": balance.surface_2,
        "carried out by the oil [W]": balance.carried_out,
        "missing [%]": 100 * balance.error,
    }


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    for name, value in main().items():
        print(f"{name:<30}{value:.4g}")
    for draw in (plots.mid_film_temperature, plots.temperature_section, plots.surface_heat):
        draw(solved()).savefig(folder / f"{draw.__name__}.png", dpi=100)
    plots.shear_stress_map(solved()).savefig(folder / "shear_stress.png", dpi=100)
