"""What a film formula is: films over R_x from dimensionless groups, and a range of validity."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from tehl.estimate.scaling import Groups

Regime = Literal[
    "rigid-isoviscous", "elastic-isoviscous", "rigid-piezoviscous", "elastic-piezoviscous"
]


@dataclass(frozen=True, kw_only=True, slots=True)
class FilmRatio:
    """Film over R_x by a formula; ``minimum`` is None if the formula has none."""

    central: float
    minimum: float | None


@dataclass(frozen=True, kw_only=True, slots=True)
class Formula:
    """A film formula and its range of validity."""

    name: str
    """Its authors."""
    source: str
    film: Callable[[Groups], FilmRatio]
    """From groups to :class:`FilmRatio`."""
    limits: tuple[str, float, float]
    """Field of :class:`tehl.estimate.scaling.Groups`, its least and its largest value."""
    regimes: tuple[Regime, ...] = ("elastic-piezoviscous",)
    """Regimes for which it was derived."""
    minimum_limit: float = math.inf
    """Moes load above which its minimum film is known to be too thick, except in wide contacts."""
    at_angles: bool = False
    """Whether it holds for entrainment at an angle to the axes of the ellipse."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Asymptotes:
    """The four limits of the Nijenbanning-Venner-Moes formula, in Moes form [-]."""

    rigid_isoviscous: float
    elastic_isoviscous: float
    rigid_piezoviscous: float
    elastic_piezoviscous: float
    unloaded: float
