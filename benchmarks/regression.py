"""Cases over all features, stored by one checkout and compared with another.

``python -m benchmarks.regression store DIR`` runs them through the ``tehl`` command of this
environment and keeps the JSON summary and all fields of each; ``python -m benchmarks.regression
compare DIR`` runs them again and prints the largest difference of each. A refactoring that keeps
behaviour leaves all of them at round-off. Only the command line, the case-file keys, the JSON keys
and the variables of the NetCDF files are used, so that any two versions can be compared.
"""

import argparse
import csv
import json
import math
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np

ROUND_OFF = 1e-9
"""Largest difference, relative to the largest magnitude of the same field, that counts as equal.
Iterations amplify the last bit of a sum by three to six digits."""
STUDIES = ("traction-curve", "moes-map")
VOLATILE = ("cost", "message", "hint", "versions", "created", "title")
"""Parts of a summary that change from run to run, or that are sentences."""


@dataclass(frozen=True, slots=True)
class Case:
    """One run of the command: template, overrides of its keys, flags."""

    name: str
    template: str
    overrides: tuple[str, ...]
    flags: tuple[str, ...]

    @property
    def is_study(self) -> bool:
        """Whether the template is a study."""
        return self.template in STUDIES


def all_cases() -> list[Case]:
    """Return the cases of ``regression.toml``."""
    tables = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
    return [
        Case(name, one["template"], tuple(one.get("set", ())), tuple(one.get("flags", ())))
        for name, one in tables.items()
    ]


def command(*arguments: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run the ``tehl`` command in ``folder``."""
    return subprocess.run(
        [sys.executable, "-m", "tehl", *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )


def run(case: Case, folder: Path) -> dict[str, Any]:
    """Run a case; return exit code, numbers by path, and fields by name."""
    source = folder / "case.toml"
    source.write_text(command("new", case.template, folder=folder).stdout, encoding="utf-8")
    sets = [part for one in case.overrides for part in ("--set", one)]
    if case.is_study:
        ended = command("study", "case.toml", "-o", "out", "--jobs", "1", *sets, folder=folder)
        numbers = dict(rows_of(folder / "out"))
        return {"code": ended.returncode, "numbers": numbers, "fields": {}, "words": {}}
    ended = command(
        "solve", "case.toml", "-o", "out.nc", "--json", *sets, *case.flags, folder=folder
    )
    if ended.returncode not in (0, 1):
        raise SystemExit(f"{case.name}: {ended.stdout}{ended.stderr}")
    summary = json.loads(ended.stdout)
    leaves = dict(leaves_of(summary))
    return {
        "code": ended.returncode,
        "numbers": {key: value for key, value in leaves.items() if isinstance(value, int | float)},
        "words": {
            key: value for key, value in leaves.items() if not isinstance(value, int | float)
        },
        "fields": dict(fields_of(folder)),
    }


def leaves_of(node: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Yield each value of a nested summary with its path."""
    if isinstance(node, dict):
        for key, value in node.items():
            if key not in VOLATILE:
                yield from leaves_of(value, f"{path}.{key}" if path else key)
    elif isinstance(node, list):
        for number, value in enumerate(node):
            yield from leaves_of(value, f"{path}[{number}]")
    else:
        yield path, node


def rows_of(folder: Path) -> Iterator[tuple[str, Any]]:
    """Yield the numbers of the table of a study."""
    with (folder / "table.csv").open(encoding="utf-8") as file:
        for number, row in enumerate(csv.DictReader(file)):
            for name, text in row.items():
                if "cost" in name or name.endswith(VOLATILE) or "second" in name:
                    continue
                try:
                    yield f"[{number}].{name}", float(text)
                except ValueError:
                    continue


def fields_of(folder: Path) -> Iterator[tuple[str, np.ndarray]]:
    """Yield the variables of all NetCDF files of a run."""
    for path in sorted(folder.glob("*.nc")):
        with h5py.File(path) as file:
            found: list[tuple[str, np.ndarray]] = []

            def visit(name: str, item: Any, found: list[tuple[str, np.ndarray]] = found) -> None:
                if isinstance(item, h5py.Dataset) and item.dtype.kind == "f":
                    found.append((name, item[()]))

            file.visititems(visit)
            yield from ((f"{path.name}:{name}", field) for name, field in found)


def store(folder: Path, names: list[str]) -> None:
    """Run the cases and store their results."""
    folder.mkdir(parents=True, exist_ok=True)
    for case in chosen(names):
        with tempfile.TemporaryDirectory() as scratch:
            found = run(case, Path(scratch))
        np.savez_compressed(folder / f"{case.name}.npz", **found.pop("fields"))
        (folder / f"{case.name}.json").write_text(json.dumps(found, indent=1), encoding="utf-8")
        show(case.name, f"exit code {found['code']}, {len(found['numbers'])} numbers")


def compare(folder: Path, names: list[str]) -> int:
    """Run the cases again; print the largest difference of each and return how many differ."""
    different = 0
    for case in chosen(names):
        with tempfile.TemporaryDirectory() as scratch:
            now = run(case, Path(scratch))
        before = json.loads((folder / f"{case.name}.json").read_text(encoding="utf-8"))
        with np.load(folder / f"{case.name}.npz") as arrays:
            before["fields"] = dict(arrays)
        worst, faults = differences(before, now)
        different += bool(faults) or worst > ROUND_OFF
        show(case.name, f"{worst:.1e}  " + "; ".join(faults[:6]))
    show("cases that differ", str(different))
    return different


def differences(before: dict[str, Any], now: dict[str, Any]) -> tuple[float, list[str]]:
    """Return the largest relative difference, and what is missing, new or far off."""
    faults = []
    if before["code"] != now["code"]:
        faults.append(f"exit code {before['code']} -> {now['code']}")
    for part in ("numbers", "words", "fields"):
        missing = before[part].keys() - now[part].keys()
        faults += [f"missing {key}" for key in sorted(missing)]
        faults += [f"new {key}" for key in sorted(now[part].keys() - before[part].keys())]
    shared = sorted(before["words"].keys() & now["words"].keys())
    pairs = ((key, before["words"][key], now["words"][key]) for key in shared)
    faults += [f"{key}: {old} -> {new}" for key, old, new in pairs if old != new]
    apart = dict(distances(before["numbers"], now["numbers"]))
    apart |= dict(distances(before["fields"], now["fields"]))
    faults += [f"{key} {size:.1e}" for key, size in apart.items() if size > ROUND_OFF]
    return max(apart.values(), default=0.0), faults


def distances(before: dict[str, Any], now: dict[str, Any]) -> Iterator[tuple[str, float]]:
    """Yield the relative difference of each quantity that both runs have."""
    for key in before.keys() & now.keys():
        if not is_iteration_error(key):
            yield key, difference(np.asarray(before[key]), np.asarray(now[key]))


def is_iteration_error(key: str) -> bool:
    """Whether a quantity is a small difference without meaningful last digits."""
    return any(word in key for word in ("residual", "load_error", "iteration", "change", "balance"))


def difference(before: np.ndarray, now: np.ndarray) -> float:
    """Return the largest difference over the largest magnitude; infinite if shapes differ."""
    if before.shape != now.shape:
        return math.inf
    if not before.size:
        return 0.0
    if (np.isnan(before) != np.isnan(now)).any():
        return math.inf
    apart = float(np.nanmax(np.abs(now.astype(float) - before), initial=0.0))
    return apart / (float(np.nanmax(np.abs(before), initial=0.0)) or 1.0)


def chosen(names: list[str]) -> list[Case]:
    """Return the named cases, all if none is named."""
    return [case for case in all_cases() if not names or case.name in names]


def show(name: str, text: str) -> None:
    """Print one line."""
    sys.stdout.write(f"{name:26s} {text}\n")
    sys.stdout.flush()


def main() -> None:
    """Store or compare, by the command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.regression", description=__doc__)
    parser.add_argument("action", choices=("store", "compare"))
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="*", help="of the cases; all if left out")
    given = parser.parse_args()
    if given.action == "store":
        store(given.folder, given.names)
        return
    raise SystemExit(1 if compare(given.folder, given.names) else 0)


if __name__ == "__main__":
    main()
