"""Axes of a study: paths of the case and the values that they take."""

import json
import math
import re
from collections import Counter
from dataclasses import dataclass
from itertools import zip_longest
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_validator

from tehl.typing import Array

End = float | int | str
Ends = tuple[End, End]
Steps = tuple[End, End, Annotated[int, Field(ge=1)]]

_KINDS = ("values", "linspace", "geomspace", "uniform", "loguniform")
"""Ways to state the values of an axis."""
_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+|inf|nan)(?:[eE][+-]?\d+)?)\s*(.*?)\s*")
_DIGITS = 12
"""Significant digits of a value: 0.3, not 0.30000000000000004."""
_LONGEST = 60
"""Characters of a value in a message."""


@dataclass(frozen=True, slots=True)
class Setting:
    """A value along an axis, and its name in the table if it has one."""

    value: Any
    name: str | None = None


class Axis(BaseModel):
    """One path of the case file with the values that it takes.

    Attributes
    ----------
    path : str
        Dotted path: ``"contact.load"``.
    name : str or None
        Of its column in the table; the path if left out.
    values : list or None
        Numbers, words, quantities or tables; ``false`` leaves the key out of the case.
    names : list of str or None
        Names of the values in the table.
    linspace, geomspace : (first, last, number) or None
        Values with equal steps or equal ratios, both ends included.
    uniform, loguniform : (first, last) or None
        Sampled between two ends, as the table ``sample`` states.
    zip : str or None
        Axes with the same word here vary together, value by value.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    path: str
    name: str | None = None
    values: list[Any] | None = None
    names: list[str] | None = None
    linspace: Steps | None = None
    geomspace: Steps | None = None
    uniform: Ends | None = None
    loguniform: Ends | None = None
    zip: str | None = None

    @model_validator(mode="after")
    def _check(self) -> Self:
        stated = [kind for kind in _KINDS if getattr(self, kind) is not None]
        if len(stated) != 1:
            how = f"states {' and '.join(stated)}" if stated else "has no values"
            raise ValueError(f"{how}: give one of {', '.join(_KINDS)}")
        if self.values == []:
            raise ValueError("has an empty list of values")
        if self.names is not None and len(self.names) != len(self.values or ()):
            raise ValueError("must have as many names as values")
        if self.zip is not None and self.is_sampled:
            raise ValueError("is sampled, and all sampled axes vary together: remove zip")
        if not all(part.strip() for part in self.path.split(".")):
            raise ValueError("is not a dotted path of a case, such as contact.load")
        try:
            self.settings(np.zeros(0))
        except ValueError as error:
            kind = stated[0]
            raise ValueError(f"{kind} = {list(getattr(self, kind))}: {error}") from None
        if self.zip is None:  # zipped values may repeat, beside others
            self._check_repeated()
        return self

    def _check_repeated(self) -> None:
        if (steps := self.linspace or self.geomspace) and steps[0] == steps[1] and steps[2] > 1:
            raise ValueError(f"has the value {steps[0]} {steps[2]} times: give two different ends")
        for what, found in (("value", self.values), ("name", self.names)):
            words = Counter(json.dumps(one, default=str, sort_keys=True) for one in found or ())
            word, count = next(iter(words.most_common(1)), ("", 0))
            if count > 1:
                raise ValueError(f"has the {what} {word[:_LONGEST]} twice: give each once")

    @property
    def is_sampled(self) -> bool:
        """Whether its values are sampled."""
        return self.uniform is not None or self.loguniform is not None

    @property
    def count(self) -> int:
        """Number of its values, if it is not sampled."""
        steps = self.linspace or self.geomspace
        return steps[2] if steps else len(self.values or ())

    def settings(self, places: Array | None = None) -> list[Setting]:
        """Return its values; those of a sampled axis at ``places`` between 0 and 1."""
        ends = self.linspace or self.geomspace or self.uniform or self.loguniform
        if ends is None:
            return [Setting(*one) for one in zip_longest(self.values or (), self.names or ())]
        geometric = self.geomspace is not None or self.loguniform is not None
        places = np.linspace(0.0, 1.0, self.count) if places is None else places
        return [Setting(value) for value in _spread(ends[0], ends[1], places, geometric=geometric)]


def _spread(first: End, last: End, places: Array, *, geometric: bool) -> list[End]:
    """Return values at places from 0 to 1 between two ends, by equal ratios if ``geometric``.

    Messages of errors continue a sentence about the ends.
    """
    (low, unit), (high, other) = _split(first), _split(last)
    if unit != other:
        raise ValueError(f"has the units {unit or 'none'} and {other or 'none'}: give one unit")
    if geometric and not (low > 0 and high > 0):
        raise ValueError("must have two positive ends to be geometric")
    rest = 1.0 - places  # so that both ends are exact
    numbers = low**rest * high**places if geometric else low * rest + high * places
    return [_stated(float(f"{number:.{_DIGITS}g}"), unit) for number in numbers]


def _stated(number: float, unit: str) -> End:
    """Return a number as a case file states it."""
    if unit:
        return f"{number!r} {unit}"
    return int(number) if number.is_integer() and abs(number) < 1e9 else number


def _split(end: End) -> tuple[float, str]:
    """Return number and unit of an end."""
    match = _NUMBER.fullmatch(str(end))
    if not match:
        raise ValueError(f'has an end "{str(end)[:40]}" that does not begin with a number')
    if not math.isfinite(float(match[1])):
        raise ValueError("must have finite ends")
    return float(match[1]), match[2]


class Sample(BaseModel):
    """How sampled axes take their values.

    Attributes
    ----------
    method : {"latin-hypercube", "sobol", "random"}
        Points that fill the box evenly, or independent ones.
    number : int
        Number of points.
    seed : int
        Of the random numbers.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    method: Literal["latin-hypercube", "sobol", "random"] = "latin-hypercube"
    number: Annotated[int, Field(ge=1)]
    seed: Annotated[int, Field(ge=0)] = 0

    def places(self, dimensions: int) -> Array:
        """Return the points between 0 and 1, (number, dimensions)."""
        from scipy.stats import qmc  # noqa: PLC0415 (half a second, for sampled studies only)

        generator = np.random.default_rng(self.seed)
        if self.method == "random":
            return generator.random((self.number, dimensions))
        if self.method == "latin-hypercube":
            found = qmc.LatinHypercube(dimensions, seed=generator).random(self.number)
        else:
            doublings = max(self.number - 1, 1).bit_length()
            found = qmc.Sobol(dimensions, seed=generator).random_base2(doublings)
        places: Array = np.asarray(found[: self.number], np.float64)
        return places
