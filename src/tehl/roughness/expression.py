"""Formulas of heights: a few functions of x and y, whose units are checked; nothing is executed."""

import ast
import math
import re
from collections.abc import Callable
from typing import Any, NamedTuple

from tehl.base.typing import Array, np
from tehl.roughness.model import metres

_LONGEST_FORMULA, _MOST_NODES, _LARGEST_POWER = 500, 200, 12
_NUMBER = re.compile(
    r"(?<![\w.])((?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)(?:\s*(nm|um|µm|μm|mm|cm|m|deg|rad)\b)?"
)
_ANGLES = {"deg": math.pi / 180.0, "rad": 1.0}
_PLAIN = ("sin", "cos", "tan", "sinh", "cosh", "tanh", "exp", "log", "arctan")
"""Functions of a plain number."""
_KEEP = {"abs": "abs", "hypot": "hypot", "min": "minimum", "max": "maximum"}
"""Functions whose result has the unit of what they take, and their names in numpy."""


class Place(NamedTuple):
    """Coordinates that broadcast [m]."""

    x: Array
    y: Array


class Term(NamedTuple):
    """A part of a formula: its values at places, and its power of a length."""

    at: Callable[[Place], Any]
    power: float


def read_formula(text: str) -> Callable[[Place], Any]:
    """Return the function of a place that a formula such as ``0.2 um * cos(x / 1 mm)`` states.

    Raises ValueError if it is not one, or if its units do not give a length.
    """
    if len(text) > _LONGEST_FORMULA:
        raise ValueError(f"has more than {_LONGEST_FORMULA} characters")
    plain = _NUMBER.sub(_with_unit, text.replace("^", "**")).strip()
    try:
        tree = ast.parse(plain, mode="eval").body
        if sum(1 for _ in ast.walk(tree)) > _MOST_NODES:
            raise ValueError(f"has more than {_MOST_NODES} parts")
        term = _term(tree)
    except (SyntaxError, MemoryError, RecursionError):
        raise ValueError(
            "is not a formula: write one such as 0.2 um * cos(2*pi*x/(0.1 mm))"
        ) from None
    if term.power != 1.0:
        raise ValueError(
            f"is {_kind(term.power)}, but heights are a length: give its numbers units, 0.2 um"
        )
    return term.at


def _with_unit(match: re.Match[str]) -> str:
    """Return a number with its unit as a product, in metres or radians."""
    number, unit = match.groups()
    if unit is None or unit in _ANGLES:
        return f"({float(number) * _ANGLES.get(unit or 'rad', 1.0)!r})"
    return f"({float(number) * (metres(unit) or 1.0)!r}*metre)"


def _term(node: ast.expr) -> Term:
    """Return the part of a formula that a node of its syntax tree states."""
    match node:
        case ast.Constant(value=float(value)):
            found = Term(lambda _: value, 0.0)
        case ast.Name(id=name):
            found = _name(name)
        case ast.UnaryOp(op=ast.USub() | ast.UAdd() as operator, operand=one):
            term, sign = _term(one), -1.0 if isinstance(operator, ast.USub) else 1.0
            found = Term(lambda place: sign * term.at(place), term.power)
        case ast.BinOp(left=left, op=ast.Pow(), right=right):
            found = _raised(_term(left), right)
        case ast.BinOp(left=left, op=operator, right=right):
            found = _combined(_term(left), operator, _term(right))
        case ast.Call(func=ast.Name(id=name), args=list(given), keywords=[]) if given:
            found = _called(name, [_term(one) for one in given])
        case _:
            raise ValueError(f"has {ast.unparse(node)[:40]!r}, which is not allowed in a formula")
    return found


def _name(name: str) -> Term:
    known = {
        "x": Term(lambda place: place.x, 1.0),
        "y": Term(lambda place: place.y, 1.0),
        "r": Term(lambda place: np.hypot(*place), 1.0),
        "pi": Term(lambda _: math.pi, 0.0),
        "metre": Term(lambda _: 1.0, 1.0),
    }
    if name not in known:
        raise ValueError(f"has the unknown name {name[:40]!r}: known are x, y, r and pi")
    return known[name]


def _raised(base: Term, exponent: ast.expr) -> Term:
    term = _term(exponent)
    if term.power or any(
        isinstance(one, ast.Name) and one.id in "xyr" for one in ast.walk(exponent)
    ):
        raise ValueError("has an exponent that is not a constant number")
    value = float(term.at(Place(np.zeros(1), np.zeros(1))))
    if not abs(value) <= _LARGEST_POWER:
        raise ValueError(f"has the exponent {value:g}, but at most {_LARGEST_POWER} is allowed")
    return Term(lambda place: base.at(place) ** value, base.power * value)


def _combined(left: Term, operator: ast.operator, right: Term) -> Term:
    match operator:
        case ast.Mult():
            return Term(lambda place: left.at(place) * right.at(place), left.power + right.power)
        case ast.Div():
            return Term(
                lambda place: np.divide(left.at(place), right.at(place)), left.power - right.power
            )
        case ast.Add() | ast.Sub():
            if left.power != right.power:
                raise ValueError(f"adds {_kind(left.power)} and {_kind(right.power)}")
            sign = 1.0 if isinstance(operator, ast.Add) else -1.0
            return Term(lambda place: left.at(place) + sign * right.at(place), left.power)
    raise ValueError("has an operator other than + - * / and **")


def _called(name: str, given: list[Term]) -> Term:
    powers = {term.power for term in given}
    if name in _PLAIN and len(given) == 1:
        if powers != {0.0}:
            raise ValueError(
                f"takes {name} of {_kind(given[0].power)}, but it needs a plain number: divide by "
                "a length with its unit"
            )
        plain = given[0].at
        return Term(lambda place: getattr(np, name)(plain(place)), 0.0)
    if name == "sqrt" and len(given) == 1:
        return Term(lambda place: np.sqrt(given[0].at(place)), 0.5 * given[0].power)
    if name in _KEEP and len(given) == (1 if name == "abs" else 2):
        if len(powers) > 1:
            raise ValueError(f"takes {name} of {_kind(given[0].power)} and {_kind(given[1].power)}")
        kept = _KEEP[name]
        return Term(
            lambda place: getattr(np, kept)(*(one.at(place) for one in given)), powers.pop()
        )
    raise ValueError(
        f"has the function {name[:40]!r} of {len(given)}: known are {', '.join(_PLAIN)}, sqrt and "
        "abs of one, min, max and hypot of two"
    )


def _kind(power: float) -> str:
    """Return the name of what has a power of a length."""
    return {0.0: "a plain number", 1.0: "a length", 2.0: "an area"}.get(power, f"m^{power:g}")
