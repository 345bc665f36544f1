"""Film and asperities that share a load: what to expect before the solve.

Both have the same separation of the surfaces and together carry the load [1]_: asperities with the
part s of it, the film with the rest, as in a contact of load (1 - s) w between bodies of modulus
(1 - s) E', which has the same Hertz area.

References
----------
.. [1] K. L. Johnson, J. A. Greenwood and S. Y. Poon, Wear 19 (1972), 91-108.
"""

from dataclasses import dataclass, replace

import numpy as np

from tehl.film_formulas import expected_central_film
from tehl.scaling import Groups, ScaledProblem
from tehl.starvation import supplied_film

HALVINGS = 60
APART = 1e-9
"""Pressure of the asperities, over that of Hertz, below which they are apart."""


@dataclass(frozen=True, kw_only=True, slots=True)
class SharedLoad:
    """Separation of the mean planes in the middle and part of the load on asperities."""

    separation: float
    """H [-]; below zero the mean planes cross."""
    gap: float
    """Mean gap there, the film [-]."""
    share: float
    """Load of the asperities over the load [-]."""


def shared_load(scaled: ScaledProblem) -> SharedLoad:
    """Return how film and asperities share the load, by formula."""
    film, problem, scales = supplied_film(scaled), scaled.problem, scaled.scales
    asperities = problem.asperities
    if asperities is None:
        return SharedLoad(separation=film, gap=film, share=0.0)
    sigma, modulus = problem.asperity_rms, problem.reduced_modulus
    unit = sigma / scales.film_thickness
    flooded = expected_central_film(scaled.entering)

    def carried(gap: float) -> float:
        found = asperities.pressure(np.array([gap]), sigma, modulus)
        return float(found[0]) / scales.hertz_pressure

    def rest(share: float) -> float:
        """Return the separation of the film that carries the rest."""
        return film / flooded * expected_central_film(_softer(scaled.entering, 1.0 - share))

    if carried(film / unit) < APART:
        return SharedLoad(separation=film, gap=film, share=0.0)
    low, high = 0.0, 1.0 - APART
    for _ in range(HALVINGS):
        share = 0.5 * (low + high)
        # of a film this thick the asperities would carry more, or less, than their share
        low, high = (share, high) if carried(rest(share) / unit) > share else (low, share)
    share = 0.5 * (low + high)
    gap = _gap(carried, share)
    film = float(asperities.mean_gap(np.array([gap]))[0]) * unit
    return SharedLoad(separation=gap * unit, gap=film, share=share)


def _gap(carried: object, share: float) -> float:
    """Return the gap over sigma at which the asperities carry a share in the middle."""
    low, high = -6.0, 30.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if carried(middle) > share else (low, middle)  # type: ignore[operator]
    return 0.5 * (low + high)


def _softer(groups: Groups, part: float) -> Groups:
    """Return the groups for a part of load and of modulus: M and L with its power 3/4."""
    return replace(
        groups,
        M=groups.M * part**0.75,
        L=groups.L * part**0.75,
        U=groups.U / part,
        G=groups.G * part,
    )
