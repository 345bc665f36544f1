"""One contact of a study, and the name under which its answer is kept."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any

from tehl import SOLVER_VERSION, __version__
from tehl.options import Options
from tehl.problem import ContactProblem

Label = float | str


@dataclass(frozen=True)
class Case:
    """One contact to be solved.

    Attributes
    ----------
    name : str
        For people, unique in its study.
    problem : ContactProblem
        What is asked.
    options : Options
        How hard to try.
    labels : mapping of str to float or str
        What tells it from its neighbours, for tables and curves: values along the axes.
    certify : bool
        Solve on three grids and a larger domain, for error bars.
    """

    name: str
    problem: ContactProblem
    options: Options
    labels: Mapping[str, Label] = field(default_factory=dict)
    certify: bool = False

    @cached_property
    def key(self) -> str:
        """Name of the answer: SHA-256 of all that it depends on, as 64 hexadecimal digits.

        That is the problem without its title, measured surfaces by what their files hold, the
        options, whether error bars are wanted, and the version of the solver.
        """
        text = json.dumps(canonical(self), sort_keys=True, allow_nan=False)
        return hashlib.sha256(text.encode()).hexdigest()


def canonical(case: Case) -> dict[str, Any]:
    """Return all that the answer of a case depends on, as JSON can hold it."""
    problem = case.problem.model_dump(mode="json", exclude={"title"})
    return {
        "problem": _with_contents(problem),
        "options": case.options.model_dump(mode="json"),
        "certify": case.certify,
        "solver": [__version__, SOLVER_VERSION],
    }


def _with_contents(value: Any) -> Any:
    """Put the contents of measured surfaces in place of the names of their files."""
    if isinstance(value, list | tuple):
        return [_with_contents(item) for item in value]
    if not isinstance(value, dict):
        return value
    inside = {key: _with_contents(item) for key, item in value.items()}
    if value.get("type") == "map" and isinstance(value.get("file"), str):
        inside["file"] = _fingerprint(value["file"])
    return inside


def _fingerprint(file: str) -> str:
    """Return what a file holds as hexadecimal digits; its name where it cannot be read."""
    try:
        state = Path(file).expanduser().stat()
        return _digest(file, state.st_size, state.st_mtime_ns)
    except OSError:
        return file


@lru_cache(maxsize=256)
def _digest(file: str, size: int, written: int) -> str:
    """Read a file once, as long as neither its size nor its time changes."""
    del size, written
    with Path(file).expanduser().open("rb") as content:
        return hashlib.file_digest(content, "sha256").hexdigest()
