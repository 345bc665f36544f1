"""Constants of an oil that a test may decide: their names, keys, units and limits."""

import difflib
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tehl.base.errors import InputError
from tehl.contact.options import Options
from tehl.contact.problem import ContactProblem
from tehl.io.case import changed, found_at
from tehl.lubricant.shear import LEAST_EYRING, LEAST_LIMIT

_PREFIX = "lubricant."
_SEARCH_FACTOR = 100.0
"""Factor around its start within which a constant without limits of its own is sought."""


@dataclass(frozen=True, slots=True)
class _Named:
    """A constant with a name of its own."""

    key: str
    unit: str
    scale: float
    least: float
    most: float
    law: str = ""
    """Shear law that has it; it is taken if the case states another one."""
    start: float | None = None
    """Where the case does not state it."""


_NAMED = {
    "alpha": _Named("viscosity.alpha", "1/GPa", 1e-9, 1e-9, 1e-7),
    "eyring_stress": _Named("shear.stress", "MPa", 1e6, LEAST_EYRING, 1e9, "eyring", 5e6),
    # 1e10 Pa is far above every measured stress
    "carreau_modulus": _Named("shear.modulus", "MPa", 1e6, 1e3, 1e10, "carreau", 5e6),
    "carreau_exponent": _Named("shear.exponent", "", 1.0, 0.02, 0.99, "carreau", 0.5),
    "limiting_stress": _Named("shear.stress", "MPa", 1e6, LEAST_LIMIT, 1e9, "limiting", 5e6),
    "limiting_slope": _Named("shear.slope", "", 1.0, 1e-3, 0.5, "limiting", 0.05),
}


@dataclass(frozen=True, slots=True)
class Constant:
    """A constant that is fitted; numbers are SI."""

    name: str
    key: str
    unit: str
    scale: float
    start: float
    least: float
    most: float

    def shown(self, value: float) -> str:
        """Return a value with the unit in which people read it."""
        return f"{value / self.scale:.4g} {self.unit}".strip()


@dataclass(frozen=True, slots=True)
class Fitted:
    """A constant with its interval; numbers are SI."""

    constant: Constant
    value: float
    low: float
    high: float
    """95 % interval by the scatter of the test: zero or infinite where it is open."""
    grid_error: float
    """Relative change if the solver is off by its error bars."""

    @property
    def interval(self) -> str:
        """The interval as people read it."""
        one = self.constant
        if self.low > 0 and math.isfinite(self.high):
            return f"{one.shown(self.low).removesuffix(one.unit).strip()} to {one.shown(self.high)}"
        if self.low > 0:
            return f"above {one.shown(self.low)}"
        return f"below {one.shown(self.high)}" if math.isfinite(self.high) else "any"


def default_names(kinds: Iterable[str], problem: ContactProblem) -> list[str]:
    """Return the constants that are fitted if none are stated.

    Parameters
    ----------
    kinds : iterable of str
        What was measured: alpha if films were, the constants of the shear law if traction was.
    problem : ContactProblem
        Its shear law; a Newtonian one is replaced by that of Eyring.
    """
    law = problem.lubricant.shear.law
    shear = [name for name, one in _NAMED.items() if one.law == law] or ["eyring_stress"]
    kinds = set(kinds)
    return ["alpha"] * bool(kinds - {"traction"}) + shear * ("traction" in kinds)


def constants_of(
    names: Sequence[str], lubricant: Mapping[str, Any], problem: ContactProblem
) -> tuple[tuple[Constant, ...], dict[str, Any]]:
    """Return the constants by their names, and the lubricant with their laws and starts.

    Parameters
    ----------
    names : sequence of str
        Names, or key paths of the lubricant such as ``lubricant.viscosity.eta_0``.
    lubricant : Mapping
        Its table in the base case.
    problem : ContactProblem
        The base case, whose values are the starts.

    Raises
    ------
    InputError
        If a name is not known or stands twice, laws conflict, or the case has no such number.
    """
    if not names or len({*names}) < len(names):
        raise InputError(f"--fit {','.join(names)}: name each constant once, such as alpha")
    laws = {_NAMED[name].law for name in names if name in _NAMED} - {""}
    if len(laws) > 1:
        raise InputError(
            f"--fit {','.join(names)}: constants of the laws {' and '.join(sorted(laws))}, but an "
            "oil has one shear law: fit them one after the other and compare the scatter"
        )
    table, law = dict(lubricant), problem.lubricant.shear.law
    if laws and laws != {law}:
        table["shear"] = {"law": laws.pop()}
    found = tuple(_constant(name, problem) for name in names)
    for one in found:
        table = with_value(table, one, one.start)
    return found, table


def with_value(
    lubricant: Mapping[str, Any], constant: Constant, value: float | str
) -> dict[str, Any]:
    """Return the table of a lubricant with another value of a constant.

    Parameters
    ----------
    lubricant : Mapping
        Is not changed.
    constant : Constant
        Says where it stands; the index z, which alpha replaces, is removed.
    value : float or str
        In SI, or with its unit.
    """
    after = changed({"lubricant": lubricant}, constant.key, value)["lubricant"]
    if constant.name == "alpha":
        after["viscosity"].pop("z", None)
    return dict(after)


def _constant(name: str, problem: ContactProblem) -> Constant:
    one = _NAMED.get(name)
    if one is None:
        return _of_key(name, problem)
    key = f"{_PREFIX}{one.key}"
    stated, _ = found_at(problem, Options(), key)
    if one.law and problem.lubricant.shear.law != one.law:
        stated = None
    if name == "alpha":
        stated = _alpha(problem)
    start = one.start if not isinstance(stated, float) or stated <= 0 else stated
    if start is None:
        raise InputError(
            f"--fit {name}: the viscosity law {problem.lubricant.viscosity.law} has no {name}; "
            "take the law roelands, barus or walther, or fit a constant of its own by its key"
        )
    start = min(max(start, 1.01 * one.least), 0.99 * one.most)
    return Constant(name, key, one.unit, one.scale, start, one.least, one.most)


def _alpha(problem: ContactProblem) -> float | None:
    """Return the pressure coefficient [1/Pa] where the key alpha holds; None without that key."""
    law = problem.lubricant.viscosity
    if "alpha" not in type(law).model_fields:
        return None
    return law.pressure_coefficient_at(getattr(law, "alpha_temperature", law.reference_temperature))


def _of_key(name: str, problem: ContactProblem) -> Constant:
    """Return the constant of a key path."""
    value, kind = found_at(problem, Options(), name)
    if name.startswith(_PREFIX) and isinstance(value, float) and value > 0 and kind is not None:
        unit = "" if kind.unit == "-" else kind.unit
        return Constant(
            name, name, unit, 1.0, value, value / _SEARCH_FACTOR, value * _SEARCH_FACTOR
        )
    close = difflib.get_close_matches(name, _NAMED, n=1)
    guess = f"did you mean {close[0]}? " if close else ""
    raise InputError(
        f"--fit {name}: is not a constant; {guess}known are {', '.join(_NAMED)}, or the key of a "
        "positive number of the lubricant that the case states, such as lubricant.viscosity.eta_0"
    )
