"""Film and asperities that share a load: what to expect before the solve.

Asperities carry the part s of the load, the film the rest [1]_, as in a contact of load (1 - s) w
between bodies of modulus (1 - s) E', which has the same Hertz area. That film is the mean gap of
the surfaces, at which the asperities carry s. Against 71 solved contacts (lambda 0.05 to 3) the
share is 0.98 times the solved one in the median, 0.4 to 1.25 times for eight of ten.

References
----------
.. [1] K. L. Johnson, J. A. Greenwood and S. Y. Poon, Wear 19 (1972), 91-108.
"""

from dataclasses import dataclass, replace
from functools import cache, lru_cache

import numpy as np

from tehl.base.typing import Array
from tehl.contact.summits import Asperities, GreenwoodTripp, gaussian_integral, mean_gap
from tehl.estimate.film_formulas import expected_central_film
from tehl.estimate.scaling import Groups, ScaledProblem
from tehl.estimate.starvation import supplied_film

NEGLIGIBLE_ASPERITY_PRESSURE = 1e-9
"""Pressure of the asperities, over that of Hertz, below which they are apart."""
LEAST_SEPARATION, LAST_SEPARATION = -6.0, 30.0
"""Separations of the mean planes over sigma between which their laws are used."""
_SEPARATIONS = np.arange(LEAST_SEPARATION, LAST_SEPARATION, 0.01)


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
    pressure = asperities.unit(sigma, modulus) / scales.hertz_pressure
    if isinstance(asperities, GreenwoodTripp):
        return _shared_by_summits(scaled.entering, film, unit, pressure)
    return _shared(scaled.entering, film, unit, pressure, _laws(asperities))


@lru_cache(maxsize=32)
def _shared_by_summits(entering: Groups, film: float, unit: float, pressure: float) -> SharedLoad:
    """Return `_shared` of Greenwood and Tripp: a plan asks for it on each grid."""
    return _shared(entering, film, unit, pressure, _summits())


def _shared(
    entering: Groups, film: float, unit: float, pressure: float, laws: tuple[Array, Array]
) -> SharedLoad:
    """Return the load that is shared.

    ``film`` is that without asperities, ``unit`` their sigma [-], ``pressure`` the unit of their
    loads over the Hertz pressure [-], and ``laws`` are those of `_laws`.
    """
    flooded = expected_central_film(entering)
    gaps, loads = laws
    carried = pressure * loads

    def rest(share: float) -> float:
        """Return the film that carries the rest: the mean gap over sigma."""
        softer = expected_central_film(_softer(entering, 1.0 - share))
        return film / flooded * softer / unit

    if float(np.interp(rest(0.0), gaps, carried)) < NEGLIGIBLE_ASPERITY_PRESSURE:
        return SharedLoad(separation=film, gap=film, share=0.0)
    low, high = 0.0, 1.0 - NEGLIGIBLE_ASPERITY_PRESSURE
    for _ in range(30):
        share = 0.5 * (low + high)
        # at the gap of such a film the asperities would carry more, or less, than their share
        is_more = float(np.interp(rest(share), gaps, carried)) > share
        low, high = (share, high) if is_more else (low, share)
    share = 0.5 * (low + high)
    separation = float(np.interp(-share, -carried, _SEPARATIONS))
    gap = float(np.interp(separation, _SEPARATIONS, gaps))
    return SharedLoad(separation=separation * unit, gap=gap * unit, share=share)


@cache
def _summits() -> tuple[Array, Array]:
    """Return `_laws` of Greenwood and Tripp, the same for all summits."""
    return mean_gap(_SEPARATIONS), gaussian_integral(2.5, _SEPARATIONS)


def _laws(asperities: Asperities) -> tuple[Array, Array]:
    """Return mean gap over sigma, and load over its unit, at all separations."""
    return asperities.mean_gap(_SEPARATIONS), asperities.load(_SEPARATIONS)


def _softer(groups: Groups, part: float) -> Groups:
    """Return the groups for a part of load and of modulus: M and L with its power 3/4."""
    return replace(
        groups,
        M=groups.M * part**0.75,
        L=groups.L * part**0.75,
        U=groups.U / part,
        G=groups.G * part,
    )
