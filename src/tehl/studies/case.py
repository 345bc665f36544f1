"""A case of a study, the key that it is stored under, and its row: the outcome without fields."""

import hashlib
import json
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any

from tehl.api.problem import ContactProblem
from tehl.api.results import Result, TransientResult
from tehl.base.version import SOLVER_VERSION, __version__
from tehl.contact.options import Options
from tehl.io.case import with_settings
from tehl.io.summary import history_columns
from tehl.result.quantity import SI, ending_of
from tehl.result.solution import Cost, Hint, Settings

Label = float | str
Scalar = float | int | str | bool | None

_SOLVED = ("converged", "not_converged", "diverged", "stalled")
"""Statuses that come with fields."""
_NOT_NUMBERS = ("title", "status", "cause", "message", "hint", "settings")
"""Keys of a summary that a row holds elsewhere."""
_PARTS_OF_ESTIMATES = ("value", "uncertainty", "discretisation", "domain", "values")


@dataclass(frozen=True)
class Case:
    """One contact to be solved."""

    name: str
    """Shown to the user, unique in its study."""
    problem: ContactProblem
    """The contact."""
    options: Options
    """Numerical options."""
    labels: Mapping[str, Label] = field(default_factory=dict)
    """Values along the axes of the study, for tables and curves."""
    certify: bool = False
    """Solve on three grids and a larger domain, for error bars."""
    retry_settings: Settings = field(default_factory=dict)
    """Numerical settings of hints, which a retry takes; not part of the key."""

    @property
    def solved_options(self) -> Options:
        """Options with the settings of hints."""
        return with_settings(self.options, self.retry_settings)

    @cached_property
    def key(self) -> str:
        """SHA-256 of all that the result depends on, as 64 hexadecimal digits.

        That is the problem without its title, measured surfaces by the content of their files, the
        options, whether error bars are wanted, and the version of the solver.
        """
        content = {
            "problem": _with_contents(self.problem.model_dump(mode="json", exclude={"title"})),
            "options": self.options.model_dump(mode="json"),
            "certify": self.certify,
            "solver": [__version__, SOLVER_VERSION],
        }
        text = json.dumps(content, sort_keys=True, allow_nan=False)
        return hashlib.sha256(text.encode()).hexdigest()


def _with_contents(value: Any) -> Any:
    """Replace the names of the files of measured surfaces by what the files contain."""
    if isinstance(value, list | tuple):
        return [_with_contents(item) for item in value]
    if not isinstance(value, dict):
        return value
    inside = {key: _with_contents(item) for key, item in value.items()}
    if value.get("type") == "map" and isinstance(value.get("file"), str):
        file = Path(value["file"]).expanduser()
        with suppress(OSError):  # the solver reports a file that cannot be read
            state = file.stat()
            inside["file"] = _digest(file, state.st_size, state.st_mtime_ns)
    return inside


@lru_cache(maxsize=256)
def _digest(file: Path, _size: int, _written: int) -> str:
    """Return the hash of a file, read again only when its size or its time has changed."""
    with file.open("rb") as content:
        return hashlib.file_digest(content, "sha256").hexdigest()


@dataclass(frozen=True, kw_only=True, slots=True)
class Row:
    """The outcome of one case."""

    key: str
    """Of the case."""
    status: str
    """As of a result; ``"bad_input"`` where the solver rejected the case, ``"failed"`` where it
    returned nothing."""
    cause: str | None = None
    message: str | None = None
    hint: Hint | None = None
    """Why it failed, as a word and in sentences; message and hint also of a converged case whose
    minimum film is uncertain."""
    retry_settings: Settings = field(default_factory=dict)
    """Settings of hints that the solve took."""
    summary: Mapping[str, Scalar] = field(default_factory=dict)
    """Every number and word of the summary, by dotted names: ``"film.h_min_m"``."""
    cost: Cost = Cost(cpu_seconds=0.0, wall_seconds=0.0)  # noqa: RUF009 (frozen)
    """Of the solve."""

    @property
    def converged(self) -> bool:
        """Whether the case converged."""
        return self.status == "converged"

    @property
    def has_fields(self) -> bool:
        """Whether the solver returned fields, converged or not."""
        return self.status in _SOLVED


def retried(case: Case, row: Row) -> Case:
    """Return a failed case with the numerical settings of its hint.

    Parameters
    ----------
    case : Case
        As it was solved.
    row : Row
        Its failure; a hint outside ``numerics`` would change the contact and is ignored.
    """
    found = row.hint.settings if row.hint else {}
    numerical = all(key.startswith("numerics.") for key in found)
    return replace(
        case, retry_settings={**row.retry_settings, **found} if numerical else row.retry_settings
    )


def row_of(case: Case, result: Result | TransientResult) -> Row:
    """Return the row of a result, converged or not.

    Parameters
    ----------
    case : Case
        Gives the key and the settings of the retry.
    result : Result
        Its numbers in SI are flattened to paths; None is left out.
    """
    status, summary = result.status, result.summary()
    numbers = {k: v for k, v in summary.items() if v is not None and k not in _NOT_NUMBERS}
    return Row(
        key=case.key,
        status=status.kind,
        cause=status.cause,
        message=status.message,
        hint=status.hint,
        retry_settings=case.retry_settings,
        summary=dict(flat(numbers)),
        cost=result.cost,
    )


def flat(tree: Mapping[Any, Any]) -> Iterator[tuple[str, Scalar]]:
    """Yield the scalars of nested tables and lists by dotted names, in order."""
    for key, value in tree.items():
        inside = dict(enumerate(value)) if isinstance(value, list | tuple) else value
        if isinstance(inside, Mapping):
            yield from ((f"{key}.{name}", scalar) for name, scalar in flat(inside))
        else:
            yield str(key), value


def unit_of(name: str) -> str:
    """Return the unit of a number of a summary, ``"1"`` where it has none."""
    name = history_columns().get(name, name)
    parts = [part for part in name.split(".") if not part.isdigit()]
    if parts[0] == "uncertainty" and parts[-1] in _PARTS_OF_ESTIMATES:
        parts.pop()
    return "s" if parts[-1].endswith("_seconds") else SI.get(ending_of(parts[-1]), "1")
