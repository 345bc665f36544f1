"""Formulas of heights in x and y, or of numbers in t; units are checked, nothing is executed."""

import ast
import math
import re
from collections.abc import Callable
from typing import Any, NamedTuple

from tehl.base.typing import Array, np
from tehl.roughness.model import metres

_LONGEST_FORMULA, _MOST_NODES, _LARGEST_POWER = 500, 200, 12
_NUMBER = r"(?<![\w.])((?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)(?:\s*({units}|deg|rad)\b)?"
_UNIT = "unit"
"""Name of the unit of numbers in SI, within a formula."""
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
    """A part of a formula: its values at places or times, and its power of a length or time."""

    at: Callable[[Any], Any]
    power: float


class Grammar(NamedTuple):
    """What a formula may be made of, and what it is to give."""

    names: dict[str, Term]
    """Variables."""
    units: dict[str, float]
    """Units of numbers in SI."""
    kinds: tuple[str, str]
    """What has one power of such a unit, and two."""
    power: float
    """Power that the whole formula has."""
    wanted: str
    """What is expected of a formula without that power."""
    example: str

    def called(self, power: float) -> str:
        """Return the name of what has a power of the unit."""
        special = {0.0: "a plain number", 1.0: self.kinds[0], 2.0: self.kinds[1]}
        return special.get(power, f"{self.kinds[0]} to the power {power:g}")


_LENGTHS = ("nm", "um", "µm", "μm", "mm", "cm", "m")
HEIGHTS = Grammar(
    names={
        "x": Term(lambda place: place.x, 1.0),
        "y": Term(lambda place: place.y, 1.0),
        "r": Term(lambda place: np.hypot(*place), 1.0),
    },
    units={unit: metres(unit) or 1.0 for unit in _LENGTHS},
    kinds=("a length", "an area"),
    power=1.0,
    wanted="heights are a length: give its numbers units, 0.2 um",
    example="0.2 um * cos(2*pi*x/(0.1 mm))",
)
"""Formulas of heights at a `Place`."""
NUMBERS_IN_TIME = Grammar(
    names={"t": Term(lambda time: time, 1.0)},
    units={"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0, "min": 60.0},
    kinds=("a time", "a time squared"),
    power=0.0,
    wanted="a plain number is expected: give its times units, t / (2 ms)",
    example="1 + 0.5*sin(2*pi*t/(2 ms))",
)
"""Formulas of plain numbers at times [s]."""


def read_formula(text: str, grammar: Grammar = HEIGHTS) -> Callable[[Any], Any]:
    """Return the function that a formula such as ``0.2 um * cos(x / 1 mm)`` states.

    Parameters
    ----------
    text : str
        The formula.
    grammar : Grammar
        Its variables and units, and what it is to give.

    Raises
    ------
    ValueError
        If it is not a formula, or if its units do not give what is wanted.
    """
    if len(text) > _LONGEST_FORMULA:
        raise ValueError(f"has more than {_LONGEST_FORMULA} characters")

    def with_unit(match: re.Match[str]) -> str:
        """Return a number with its unit as a product, in SI or radians."""
        number, unit = match.groups()
        if unit is None or unit in _ANGLES:
            return f"({float(number) * _ANGLES.get(unit or 'rad', 1.0)!r})"
        return f"({float(number) * grammar.units[unit]!r}*{_UNIT})"

    number = _NUMBER.format(units="|".join(grammar.units))
    plain = re.sub(number, with_unit, text.replace("^", "**")).strip()
    try:
        tree = ast.parse(plain, mode="eval").body
        if sum(1 for _ in ast.walk(tree)) > _MOST_NODES:
            raise ValueError(f"has more than {_MOST_NODES} parts")
        term = _term(tree, grammar)
    except (SyntaxError, MemoryError, RecursionError):
        raise ValueError(f"is not a formula: write one such as {grammar.example}") from None
    if term.power != grammar.power:
        raise ValueError(f"is {grammar.called(term.power)}, but {grammar.wanted}")
    return term.at


def _term(node: ast.expr, grammar: Grammar) -> Term:
    """Return the part of a formula that a node of its syntax tree states."""
    match node:
        case ast.Constant(value=float(value)):
            found = Term(lambda _: value, 0.0)
        case ast.Name(id=name):
            found = _name(name, grammar)
        case ast.UnaryOp(op=ast.USub() | ast.UAdd() as operator, operand=one):
            term, sign = _term(one, grammar), -1.0 if isinstance(operator, ast.USub) else 1.0
            found = Term(lambda place: sign * term.at(place), term.power)
        case ast.BinOp(left=left, op=ast.Pow(), right=right):
            found = _raised(_term(left, grammar), right, grammar)
        case ast.BinOp(left=left, op=operator, right=right):
            found = _combined(_term(left, grammar), operator, _term(right, grammar), grammar)
        case ast.Call(func=ast.Name(id=name), args=list(given), keywords=[]) if given:
            found = _called(name, [_term(one, grammar) for one in given], grammar)
        case _:
            raise ValueError(f"has {ast.unparse(node)[:40]!r}, which is not allowed in a formula")
    return found


def _name(name: str, grammar: Grammar) -> Term:
    known = grammar.names | {"pi": Term(lambda _: math.pi, 0.0), _UNIT: Term(lambda _: 1.0, 1.0)}
    if name not in known:
        *first, last = (one for one in known if one != _UNIT)
        raise ValueError(
            f"has the unknown name {name[:40]!r}: known are {', '.join(first)} and {last}"
        )
    return known[name]


def _raised(base: Term, exponent: ast.expr, grammar: Grammar) -> Term:
    term = _term(exponent, grammar)
    names = {one.id for one in ast.walk(exponent) if isinstance(one, ast.Name)}
    if term.power or names & set(grammar.names):
        raise ValueError("has an exponent that is not a constant number")
    value = float(term.at(None))
    if not abs(value) <= _LARGEST_POWER:
        raise ValueError(f"has the exponent {value:g}, but at most {_LARGEST_POWER} is allowed")
    return Term(lambda place: base.at(place) ** value, base.power * value)


def _combined(left: Term, operator: ast.operator, right: Term, grammar: Grammar) -> Term:
    match operator:
        case ast.Mult():
            return Term(lambda place: left.at(place) * right.at(place), left.power + right.power)
        case ast.Div():
            return Term(
                lambda place: np.divide(left.at(place), right.at(place)), left.power - right.power
            )
        case ast.Add() | ast.Sub():
            if left.power != right.power:
                both = grammar.called(left.power), grammar.called(right.power)
                raise ValueError(f"adds {both[0]} and {both[1]}")
            sign = 1.0 if isinstance(operator, ast.Add) else -1.0
            return Term(lambda place: left.at(place) + sign * right.at(place), left.power)
    raise ValueError("has an operator other than + - * / and **")


def _called(name: str, given: list[Term], grammar: Grammar) -> Term:
    powers = {term.power for term in given}
    if name in _PLAIN and len(given) == 1:
        if powers != {0.0}:
            raise ValueError(
                f"takes {name} of {grammar.called(given[0].power)}, but it needs a plain number: "
                f"divide by {grammar.kinds[0]} with its unit"
            )
        plain = given[0].at
        return Term(lambda place: getattr(np, name)(plain(place)), 0.0)
    if name == "sqrt" and len(given) == 1:
        return Term(lambda place: np.sqrt(given[0].at(place)), 0.5 * given[0].power)
    if name in _KEEP and len(given) == (1 if name == "abs" else 2):
        if len(powers) > 1:
            both = grammar.called(given[0].power), grammar.called(given[1].power)
            raise ValueError(f"takes {name} of {both[0]} and {both[1]}")
        kept = _KEEP[name]
        return Term(
            lambda place: getattr(np, kept)(*(one.at(place) for one in given)), powers.pop()
        )
    raise ValueError(
        f"has the function {name[:40]!r} of {len(given)}: known are {', '.join(_PLAIN)}, sqrt and "
        "abs of one, min, max and hypot of two"
    )
