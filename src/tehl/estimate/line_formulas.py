"""Film thickness of line contacts by published formulas.

References
----------
.. [1] H. Moes, Lubrication and Beyond, University of Twente (2000); Venner and Lubrecht (2000).
.. [2] D. Dowson and G. R. Higginson, Elastohydrodynamic Lubrication, Pergamon (1966).
.. [3] D. Dowson and S. Toyoda, Proc. 5th Leeds-Lyon Symposium on Tribology (1979), 60-65.
"""

import math
from typing import get_args

from tehl.estimate.formula import Asymptotes, FilmRatio, Formula, Regime
from tehl.estimate.scaling import Groups

CENTRAL, MINIMUM = (3.0, 2.621, 1.287, 1.311), (2.45, 2.05, 1.05, 0.96)
"""Factors of the four limits of Moes: rigid and elastic isoviscous, rigid and elastic
piezoviscous. The exact one of the rigid isoviscous minimum is 2.447484 (Martin 1916)."""


def line_asymptotes(groups: Groups) -> Asymptotes:
    """Return the four limits of the central film of Moes [1]_."""
    return _limits(groups, CENTRAL)


def _limits(groups: Groups, factors: tuple[float, float, float, float]) -> Asymptotes:
    load, speed, (rigid, elastic, piezoviscous, stiff) = groups.M, groups.L, factors
    return Asymptotes(
        rigid_isoviscous=rigid / load,
        elastic_isoviscous=elastic * load**-0.2,
        rigid_piezoviscous=piezoviscous * speed ** (2 / 3),
        elastic_piezoviscous=stiff * load**-0.125 * speed**0.75,
        unloaded=math.inf,
    )


def moes_line(groups: Groups) -> FilmRatio:
    """Return the film of Moes [1]_, which covers all regimes."""
    unit = math.sqrt(2.0 * groups.U)
    central, minimum = (unit * _blend(_limits(groups, one)) for one in (CENTRAL, MINIMUM))
    return FilmRatio(central=central, minimum=minimum)


def _blend(limits: Asymptotes) -> float:
    rigid, elastic = limits.rigid_isoviscous, limits.elastic_isoviscous
    thick, stiff = limits.rigid_piezoviscous, limits.elastic_piezoviscous
    s = 0.2 * (7.0 + 8.0 * math.exp(-2.0 * elastic / rigid))
    isoviscous = (rigid ** (7 / 3) + elastic ** (7 / 3)) ** (3 / 7)
    piezoviscous = 0.0
    if min(thick, stiff) > 1e-30:
        piezoviscous = stiff * (1.0 + (stiff / thick) ** 3.5) ** (-2 / 7)
    return (isoviscous**s + piezoviscous**s) ** (1.0 / s)


def dowson_higginson(groups: Groups) -> FilmRatio:
    """Return the film of Dowson and Higginson [2]_, and for its centre that of Toyoda [3]_."""
    u, g, w = groups.U, groups.G, groups.W
    return FilmRatio(
        central=3.06 * u**0.69 * g**0.56 * w**-0.10,
        minimum=2.65 * u**0.70 * g**0.54 * w**-0.13,
    )


LINE_FORMULAS = (
    Formula(
        name="Moes, line",
        source="Lubrication and Beyond, University of Twente (2000)",
        film=moes_line,
        limits=("M", 0.0, math.inf),
        regimes=get_args(Regime),
    ),
    Formula(
        name="Dowson-Higginson-Toyoda",
        source="Elastohydrodynamic Lubrication (1966); Leeds-Lyon 5 (1979) 60-65",
        film=dowson_higginson,
        limits=("W", 3e-5, 3e-4),
    ),
)
