"""Stiffness and damping: what a film adds to a rotor.

Bearings of rotors are often modelled with the stiffness of their dry contacts and a guessed
damping. The film gives both, over the frequency of the vibration.

**At low frequencies** the film is softer than the dry contact, because it thins under load, and it
damps: oil is squeezed out of the inlet and drawn in again.

**When the surfaces pass the contact in less than a period**, at omega a/u of about one, the inlet
no longer follows. The damping falls, and the film is as stiff as the dry contact; at higher
frequencies it is stiffer, as the oil around the contact cannot escape.
"""

import sys
from functools import cache
from pathlib import Path

import tehl
from tehl import plots


@cache
def solved(points: int = 129) -> tehl.Result:
    """Return the film of a ball on a disc with its stiffness and damping."""
    problem = tehl.ContactProblem(
        title="Ball on disc, stiffness and damping of the film",
        contact=tehl.Contact(radius=0.02, load=80.0, entrainment_speed=1.5),
        surface_1=tehl.Surface(material="steel"),
        surface_2=tehl.Surface(material="steel"),
        lubricant="mineral-oil",
        dynamics={},
    )
    return tehl.solve(problem, tehl.Options(points=points))


def main() -> list[tuple[float, float, float]]:
    """Return frequency [Hz], stiffness [N/um] and damping [N s/m]."""
    film = solved().dynamics
    columns = film.frequency, 1e-6 * film.stiffness, film.damping
    return [(float(f), float(k), float(c)) for f, k, c in zip(*columns, strict=True)]


if __name__ == "__main__":
    out = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    out.mkdir(parents=True, exist_ok=True)
    for frequency, stiffness, damping in main()[::3]:
        print(f"{frequency:8.0f} Hz   {stiffness:6.2f} N/um   {damping:5.0f} N s/m")
    plots.dynamics_curves(solved()).savefig(out / "film_dynamics.png", dpi=100)
