"""Checkpoints: the state of an unfinished transient run on disk, and the run it belongs to."""

import hashlib
import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tehl.base.atomic import replacing
from tehl.base.errors import FileFormatError, InputError
from tehl.base.version import SOLVER_VERSION, __version__
from tehl.contact.options import Options
from tehl.contact.problem import ContactProblem
from tehl.roughness import Map

_LABEL, _LAYOUT = "tehl_checkpoint", 4
"""Array that marks such a file; version, to be raised when the arrays of a state change."""


class Fingerprint(NamedTuple):
    """The run of a checkpoint: version of this package, SHA-256 sum of the input."""

    version: str
    input: str


def fingerprint(problem: ContactProblem, options: Options) -> Fingerprint:
    """Return the fingerprint of case, options and measured surfaces, however they are written.

    Parameters
    ----------
    problem : ContactProblem
        Its measured surfaces count by the content of their files.
    options : Options
        All of them count, also those that do not change the result, but ``max_time``: more of it
        continues a run that it ended.
    """
    maps = [one.fingerprint for one in _maps(problem)]
    limitless = options.model_dump(mode="json", exclude={"max_time"})
    content = [problem.model_dump(mode="json"), limitless, maps]
    text = json.dumps(content, sort_keys=True)
    version = f"{__version__} (solver {SOLVER_VERSION}, state {_LAYOUT})"
    return Fingerprint(version, hashlib.sha256(text.encode()).hexdigest())


def _maps(problem: ContactProblem) -> Iterator[Map]:
    for surface in problem.surfaces:
        yield from (part for part in surface.roughness.summands if isinstance(part, Map))


def checkpoint_of(output: str | Path) -> Path:
    """Return the checkpoint beside an output file."""
    return Path(f"{output}.checkpoint")


def write_checkpoint(path: str | Path, owner: Fingerprint, arrays: Mapping[str, Any]) -> None:
    """Write the state of a run; on an error the older file stays.

    Parameters
    ----------
    path : str or Path
        The file.
    owner : Fingerprint
        Of the run.
    arrays : mapping
        Numbers and arrays by name; no objects.
    """
    label = np.array([owner.version, owner.input])
    with replacing(path) as temporary, temporary.open("wb") as file:
        np.savez(file, allow_pickle=False, **{_LABEL: label}, **arrays)


def read_checkpoint(path: str | Path, owner: Fingerprint) -> dict[str, NDArray[Any]]:
    """Return the state of a run from its checkpoint, numbers and arrays by name.

    Parameters
    ----------
    path : str or Path
        File that a run wrote beside its output.
    owner : Fingerprint
        Of the run that continues.

    Raises
    ------
    InputError
        If the file does not exist, or is of another version of this package or of another case.
    FileFormatError
        If it is not a complete checkpoint.
    """
    if not Path(path).is_file():
        raise InputError(f"checkpoint {path} does not exist")
    try:
        with Path(path).open("rb") as opened, np.load(opened, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        version, case = (str(word) for word in arrays.pop(_LABEL))
    except Exception:  # a flipped bit makes zip and array headers raise anything
        raise FileFormatError(
            f"{path} is not a complete checkpoint: remove it to start again"
        ) from None
    if version != owner.version:
        raise InputError(
            f"{path} was written by tehl {version}, and this is {owner.version}: continue "
            "with that version, or remove the checkpoint to start again"
        )
    if case != owner.input:
        raise InputError(
            f"{path} belongs to another case, other options or another measured surface: continue "
            "with the unchanged case, or remove the checkpoint to start again"
        )
    return arrays
