"""The axes of a study file: paths of the case and the values that they take."""

import json
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from tehl.studies.numbers import End, between, evenly
from tehl.typing import Array

KINDS = ("values", "linspace", "geomspace", "uniform", "loguniform")
"""Ways to state the values of an axis; the last two are sampled."""
DRAWN = ("uniform", "loguniform")
_LONGEST = 60
"""Letters of a value in a message."""

Steps = tuple[End, End, Annotated[int, Field(ge=1)]]
Ends = tuple[End, End]
Draw = Callable[[int, int], Array]
"""From numbers of dimensions and points to places between 0 and 1, (points, dimensions)."""


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
        What to call the values in the table.
    linspace, geomspace : (first, last, number) or None
        Values with equal steps or equal ratios, both ends included.
    uniform, loguniform : (first, last) or None
        Sampled between two ends, as the table ``sample`` says.
    zip : str or None
        Axes with the same word here go together, value by value.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    path: Annotated[str, Field(min_length=1)]
    name: str | None = None
    values: list[Any] | None = None
    names: list[str] | None = None
    linspace: Steps | None = None
    geomspace: Steps | None = None
    uniform: Ends | None = None
    loguniform: Ends | None = None
    zip: str | None = None

    @model_validator(mode="after")
    def _must_have_values(self) -> Self:
        stated = [kind for kind in KINDS if getattr(self, kind) is not None]
        if len(stated) != 1:
            how = f"states {' and '.join(stated)}" if stated else "has no values"
            raise ValueError(f"{how}: give one of {', '.join(KINDS)}")
        if self.values == []:
            raise ValueError("has an empty list of values")
        if self.names is not None and len(self.names) != len(self.values or ()):
            raise ValueError("names must be as many as values")
        if self.zip is not None and self.is_drawn:
            raise ValueError("is sampled, which goes together with all that is sampled: no zip")
        if not all(part.strip() for part in self.path.split(".")):
            raise ValueError("has no dotted path of a case, such as contact.load")
        self._check_ends(stated[0])
        if self.zip is None:  # zipped values may come again, beside others
            self._check_once()
        return self

    def _check_once(self) -> None:
        """Refuse a value or a name that comes twice."""
        if (steps := self.linspace or self.geomspace) and steps[0] == steps[1] and steps[2] > 1:
            raise ValueError(f"has the value {steps[0]} {steps[2]} times: give two different ends")
        for what, found in (("value", self.values), ("name", self.names)):
            words = Counter(json.dumps(one, default=str, sort_keys=True) for one in found or ())
            if twice := [word for word, count in words.items() if count > 1]:
                raise ValueError(f"has the {what} {twice[0][:_LONGEST]} twice: give each once")

    def _check_ends(self, kind: str) -> None:
        if kind == "values":
            return
        try:
            self._spread()
        except ValueError as error:
            raise ValueError(f"{kind} = {list(getattr(self, kind))} {error}") from None

    @property
    def is_drawn(self) -> bool:
        """Whether its values are sampled."""
        return self.uniform is not None or self.loguniform is not None

    @property
    def count(self) -> int:
        """Number of its values; of an axis that is not sampled."""
        if self.values is not None:
            return len(self.values)
        steps = self.linspace or self.geomspace
        return steps[2] if steps else 0

    def _spread(self) -> Callable[[Array], list[Any]]:
        ends = self.linspace or self.geomspace or self.uniform or self.loguniform
        assert ends is not None
        geometric = self.geomspace is not None or self.loguniform is not None
        return between(ends[0], ends[1], geometric=geometric)

    def settings(self, places: Array | None = None) -> list["Setting"]:
        """Return its values; of a sampled axis those at ``places`` between 0 and 1."""
        if self.values is not None:
            if self.names is None:
                return [Setting(value) for value in self.values]
            named = zip(self.values, self.names, strict=True)
            return [Setting(value, name) for value, name in named]
        where = evenly(self.count) if places is None else places
        return [Setting(value) for value in self._spread()(where)]


class Sample(BaseModel):
    """How sampled axes take their values.

    Attributes
    ----------
    method : {"latin-hypercube", "sobol", "random"}
        Points that fill the box evenly, or independent ones.
    number : int
        How many.
    seed : int
        Another seed, other points.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    method: Literal["latin-hypercube", "sobol", "random"] = "latin-hypercube"
    number: Annotated[int, Field(ge=1)]
    seed: Annotated[int, Field(ge=0)] = 0

    def places(self, dimensions: int) -> Array:
        """Return the points between 0 and 1, (number, dimensions)."""
        import numpy as np  # noqa: PLC0415
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


@dataclass(frozen=True, slots=True)
class Setting:
    """A value along an axis, and what to call it if not by itself."""

    value: Any
    name: str | None = None


@dataclass(frozen=True, kw_only=True, slots=True)
class Block:
    """Columns that vary together; the study is the grid of its blocks.

    Attributes
    ----------
    paths, names : tuple of str
        Of the columns: where in the case, and in the table.
    rows : tuple of tuple of Setting or None
        The values, one per column; None leaves the base case as it is.
    titles : tuple of str
        Names of the rows, empty if they have none.
    """

    paths: tuple[str, ...]
    names: tuple[str, ...]
    rows: tuple[tuple[Setting | None, ...], ...]
    titles: tuple[str, ...] = ()


def groups_of(axes: Sequence[Axis]) -> list[list[Axis]]:
    """Return the axes that go together: zipped ones, all sampled ones, and each other alone."""
    groups: dict[tuple[str, str], list[Axis]] = {}
    for number, axis in enumerate(axes):
        kind = ("drawn", "") if axis.is_drawn else ("zip", axis.zip) if axis.zip else None
        groups.setdefault(kind or ("alone", str(number)), []).append(axis)
    return list(groups.values())


def count_of(group: Sequence[Axis], sample: Sample | None) -> int:
    """Return how many values a group takes.

    Raises
    ------
    ValueError
        If zipped axes have different numbers of values, or nothing says how to sample.
    """
    if group[0].is_drawn:
        if sample is None:
            raise ValueError(
                f"{group[0].path} is sampled, but there is no table [sample] with the number of "
                'points: sample = { method = "latin-hypercube", number = 100 }'
            )
        return sample.number
    counts = {axis.path: axis.count for axis in group}
    if len(set(counts.values())) > 1:
        told = ", ".join(f"{path} {count}" for path, count in counts.items())
        raise ValueError(f'zip = "{group[0].zip}" joins axes of different lengths: {told}')
    return group[0].count


def block_of(group: Sequence[Axis], sample: Sample | None) -> Block:
    """Return the block of a group that was counted."""
    if group[0].is_drawn and sample is not None:
        places = sample.places(len(group))
        columns = [axis.settings(places[:, number]) for number, axis in enumerate(group)]
    else:
        columns = [axis.settings() for axis in group]
    return Block(
        paths=tuple(axis.path for axis in group),
        names=tuple(axis.name or axis.path for axis in group),
        rows=tuple(zip(*columns, strict=True)),
    )
