"""The series of the paper and those added to it, as their files state them."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from tehl.io.case import case_from_tables
from tehl.options import Options, coarsenings
from tehl.problem import ContactProblem
from tehl.studies import Case

Treatment = Literal["paper", "converged", "domain", "mean", "coarser"]
Heat = Literal["isothermal", "thermal"]
Tables = Mapping[str, Any]

NAMES = (
    "A",
    "B",
    "C",
    "D",
    "D-smooth",
    "D-prime",
    "D-prime-wavy",
    "C-eyring",
    "glass-1",
    "glass-2",
    "hot",
)
"""Series, those of the paper first."""
LEAST_CERTIFIED = 3
"""Coarsenings that a certified grid needs."""
_HERE = Path(__file__).parent


@dataclass(frozen=True, kw_only=True, slots=True)
class RunKind:
    """How all contacts of a series are computed once.

    Attributes
    ----------
    treatment : {"paper", "converged", "domain", "mean", "coarser"}
        As the paper did; as well as can be; that on the domain of the paper; that with the
        equation of the paper; or on a coarser grid, where the fine one may not settle.
    heat : {"isothermal", "thermal"}
        Whether heat is computed.
    numerics, thermal : mapping
        Tables of a case.
    certify : bool
        With error bars from three grids and a larger domain.
    """

    treatment: Treatment
    heat: Heat
    numerics: Tables
    thermal: Tables = field(default_factory=dict)
    certify: bool = False


@dataclass(frozen=True, kw_only=True, slots=True)
class Series:
    """Contacts that differ by one number.

    Attributes
    ----------
    name, title, source : str
        Short name, subject, and what of the paper it makes.
    parameters : str
        Name of the reference parameter set.
    contact : mapping
        What all contacts share.
    key, symbol : str
        Key of the case that varies, and how it is written.
    values : tuple of float
        What it takes.
    surfaces : mapping
        Tables ``surface_1`` and ``surface_2``, where they are not of smooth steel.
    runs : tuple of RunKind
        How they are computed.
    """

    name: str
    title: str
    source: str
    parameters: str
    contact: Tables
    key: str
    symbol: str
    values: tuple[float, ...]
    surfaces: Tables
    runs: tuple[RunKind, ...]

    @property
    def is_rough(self) -> bool:
        """Whether a surface is wavy."""
        return any("roughness" in table for table in self.surfaces.values())


@dataclass(frozen=True, slots=True, eq=False)
class Run:
    """One contact, computed one way.

    Attributes
    ----------
    series : str
        Name of its series.
    treatment, heat : str
        As in :class:`RunKind`.
    value : float
        Of what varies.
    case : Case
        What is solved.
    """

    series: str
    treatment: Treatment
    heat: Heat
    value: float
    case: Case


def series(name: str) -> Series:
    """Return a series by its name."""
    tables = _read(f"series/{name}.toml")
    varies = tables["varies"]
    return Series(
        name=name,
        title=tables["title"],
        source=tables["source"],
        parameters=tables["parameters"],
        contact=tables["contact"],
        key=varies["key"],
        symbol=varies["symbol"],
        values=tuple(float(value) for value in varies["values"]),
        surfaces={key: tables[key] for key in ("surface_1", "surface_2") if key in tables},
        runs=tuple(RunKind(**run) for run in tables["runs"]),
    )


def all_series() -> dict[str, Series]:
    """Return all series by name."""
    return {name: series(name) for name in NAMES}


def parameter_set(name: str) -> dict[str, Any]:
    """Return the tables of a reference parameter set: title, contact and lubricant."""
    sets = parameters()
    found = sets[name]
    like = sets[found["like"]] if "like" in found else {}
    merged = ("contact", "lubricant")
    return {**like, **found} | {key: like.get(key, {}) | found.get(key, {}) for key in merged}


def parameters() -> dict[str, Any]:
    """Return the file of parameter sets and solids."""
    return _read("parameters.toml")


def problem_of(one: Series, kind: RunKind, value: float) -> ContactProblem:
    """Return a contact of a series."""
    chosen, solids = parameter_set(one.parameters), parameters()["solids"]
    tables: dict[str, Any] = {
        "title": title_of(one, kind, value),
        "contact": {**chosen["contact"], **one.contact, one.key: value},
        "lubricant": chosen["lubricant"],
    }
    for key in ("surface_1", "surface_2"):
        stated = dict(one.surfaces.get(key, {}))
        tables[key] = {"material": solids[stated.pop("solid", "steel")], **stated}
    if kind.heat == "thermal":
        tables["thermal"] = kind.thermal
    return case_from_tables(tables)[0]


def title_of(one: Series, kind: RunKind, value: float) -> str:
    """Return the title of a run."""
    return f"{one.name}: {one.symbol} = {value:g}, {kind.heat}, {kind.treatment}"


def runs_of(one: Series, points: int | None = None) -> list[Run]:
    """Return the runs of a series.

    Parameters
    ----------
    one : Series
        Which.
    points : int or None
        Nodes per direction of the grids that are not the paper's, in place of those of the file.
    """
    return [_run(one, kind, value, points) for kind in one.runs for value in one.values]


def _run(one: Series, kind: RunKind, value: float, points: int | None) -> Run:
    numerics = dict(kind.numerics)
    if points is not None and kind.treatment in ("converged", "domain", "mean"):
        numerics["points"] = points
    options = Options.model_validate(numerics)
    certify = kind.certify and min(map(coarsenings, options.shape)) >= LEAST_CERTIFIED
    labels: dict[str, float | str] = {
        "series": one.name,
        "treatment": kind.treatment,
        "heat": kind.heat,
        one.symbol: value,
    }
    case = Case(title_of(one, kind, value), problem_of(one, kind, value), options, labels, certify)
    return Run(one.name, kind.treatment, kind.heat, value, case)


def _read(name: str) -> dict[str, Any]:
    with (_HERE / name).open("rb") as file:
        return tomllib.load(file)
