"""Measured points: a contact as the rig had it, and the film and traction found in it."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tehl.api.problem import ContactProblem, case_from_tables
from tehl.api.results import Result
from tehl.base.atomic import shortened
from tehl.base.errors import InputError
from tehl.base.lists import lines_of, lines_of_frame
from tehl.base.units import Length, PositiveNumber, Quantity, Share, quantity
from tehl.estimate.film_formulas import likely_film
from tehl.estimate.scaling import ScaledProblem
from tehl.lubricant.fluid import oil_table
from tehl.studies.contacts import (
    columns_and_rows,
    stated_in,
    tables_of,
    template_tables,
)
from tehl.studies.fitting.rig import Probe, rig_lines


def friction(result: Result) -> float | None:
    """Return the friction coefficient of film and solids as a rig measures it, positive [-]."""
    solids = result.load_sharing or result.touching
    if solids is not None:
        return solids.friction
    found = result.traction
    return None if found is None else abs(found.mid_film)


@dataclass(frozen=True, slots=True)
class Kind:
    """A quantity that a rig measures."""

    words: str
    """Headings of its column."""
    read: Quantity
    unit: str
    scale: float
    """The unit in which people read it, in SI."""
    is_relative: bool
    """Whether an estimated noise is a share of the value, or the same for all points."""
    value: Callable[[Result], float | None]
    bar: str
    """Name of its error bar in a summary."""


KINDS = {
    "film": Kind(
        words="film central_film film_thickness central_film_thickness average_film h_c hc",
        read=quantity(Length),
        unit="nm",
        scale=1e-9,
        is_relative=True,
        value=lambda result: result.film.central,
        bar="central",
    ),
    "traction": Kind(
        words="traction friction traction_coeff traction_coefficient friction_coefficient mu cof",
        read=quantity(PositiveNumber),
        unit="",
        scale=1.0,
        is_relative=False,
        value=friction,
        bar="traction_mid_film",
    ),
}
"""What may be measured, by name."""
LARGEST = {"film": 1e-4, "traction": 1.0}
"""What is beyond any film [m] and traction [-]: units or columns are taken for others."""
FASTEST = 1000.0
"""Entrainment speed that no rig reaches [m/s]."""
UNLIKE = 100.0
"""Ratio of a measured film to that of formulas, either way, beyond which a unit is wrong: a first
alpha or viscosity that is ten times off changes films by five."""
_NOISE = "noise"
_WORDS = {word: kind for kind, one in KINDS.items() for word in one.words.split()}
_WORDS |= {
    form.format(word): f"{_NOISE}.{kind}"
    for word, kind in _WORDS.items()
    for form in ("±_{}", "{}_noise", "{}_sd", "{}_standard_deviation")
}


@dataclass(frozen=True, slots=True)
class Point:
    """A contact of a test, and what was measured in it."""

    label: str
    tables: Mapping[str, Any]
    """Of its case; constants of the oil are those before the fit."""
    folder: Path | None
    measured: Mapping[str, tuple[float, float | None]]
    """Value and standard deviation, None if it is not stated, by kind [SI]."""

    def problem(self, lubricant: Mapping[str, Any]) -> ContactProblem:
        """Return the contact with a table of the lubricant; its temperature stays."""
        stated = self.tables["lubricant"]
        kept = {key: stated[key] for key in ("temperature",) if key in stated}
        changed = dict(self.tables) | {"lubricant": dict(lubricant) | kept}
        return case_from_tables(changed, self.folder)[0]


def base_tables(case: Any) -> tuple[dict[str, Any], Path | None]:
    """Return the tables of a base case, with all of its oil, and the folder of its files."""
    if isinstance(case, ContactProblem):
        return case.model_dump(mode="json", exclude_unset=True), None
    is_file = not isinstance(case, Mapping)
    tables, folder = template_tables(Path(case)) if is_file else (dict(case), None)
    try:
        case_from_tables(tables, folder)
    except InputError as error:
        raise InputError(f"{shortened(case)}: {error}" if is_file else str(error)) from None
    oil = oil_table(tables["lubricant"], folder)
    return tables | {"lubricant": dict(oil)}, folder


def points_of(
    data: Any,
    base: dict[str, Any],
    folder: Path | None,
    *,
    noise: Mapping[str, str | float],
    probe: Probe | None,
) -> list[Point]:
    """Return the points of one file or table.

    Parameters
    ----------
    data : str, Path or DataFrame
        As for `tehl.fit`.
    base : dict
        Tables of the case that each row completes.
    folder : Path or None
        Where relative paths of measured surfaces begin.
    noise : Mapping
        Standard deviations by kind where no column states them.
    probe : {"lube", "pot"} or None
        As for `tehl.studies.fitting.rig.rig_lines`.

    Raises
    ------
    InputError
        If a heading or a row is invalid, in one sentence.
    """
    if isinstance(data, str | Path):
        name = shortened(Path(data).name)
        lines = rig_lines(Path(data), probe) or lines_of(Path(data), "file of measurements")
    else:
        name, lines = "table", lines_of_frame(data)
    points, place = list[Point](), name
    try:
        columns, rows = columns_and_rows(lines, _WORDS)
        _check_keys([one.key for one in columns if one.key is not None])
        for number, cells in rows:
            place = f"{name}: row {number}"
            stated = stated_in(columns, cells)
            points.append(_point(f"{name}:{number}", stated, base, folder, noise))
    except InputError as error:
        raise InputError(f"{place}: {error}") from None
    return [point for point in points if point.measured]


def _check_keys(keys: Sequence[str]) -> None:
    """Raise if nothing is measured, or a column states another oil."""
    if not set(keys) & set(KINDS):
        raise InputError(
            "has no measured column: name one film [nm] or traction, or give a text file of an "
            "MTM or EHD2"
        )
    for key in keys:
        if key.startswith("lubricant.") and key != "lubricant.temperature":
            raise InputError(f"a column states {key}, but the fit is for one oil: remove it")


def _point(
    label: str,
    stated: dict[str, Any],
    base: dict[str, Any],
    folder: Path | None,
    noise: Mapping[str, str | float],
) -> Point:
    measured: dict[str, tuple[float, float | None]] = {}
    for kind, one in KINDS.items():
        cell, spread = stated.pop(kind, None), stated.pop(f"{_NOISE}.{kind}", noise.get(kind))
        if cell is not None:
            try:
                value = one.read.parse(cell)
            except ValueError as error:
                raise InputError(f"{kind} = {cell!r}: {error}") from None
            if not value <= LARGEST[kind]:
                most = "0.1 mm" if kind == "film" else f"{LARGEST[kind]:g}"
                raise InputError(f"{kind} = {cell!r}: more than {most}; check the unit")
            measured[kind] = value, None if spread is None else noise_of(kind, spread, value)
    tables = tables_of(base, stated)
    problem = case_from_tables(tables, folder)[0]
    if problem.transient is not None or problem.has_passes:
        raise InputError("a fit is for steady contacts: leave out transient and passes")
    _check_condition(problem, measured["film"][0] if "film" in measured else None)
    return Point(label, tables, folder, measured)


def _check_condition(problem: ContactProblem, film: float | None) -> None:
    """Raise if a rig has no such speed, or no oil such a film there: it would lead the fit."""
    speed = problem.entrainment_speed
    if not speed <= FASTEST:
        raise InputError(
            f"contact.entrainment_speed = {speed:g} m/s: more than {FASTEST:g} m/s; check the unit"
        )
    if film is None:
        return
    expected = likely_film(ScaledProblem.of(problem)).central_m
    if not expected / UNLIKE <= film <= expected * UNLIKE:
        raise InputError(
            f"film = {1e9 * film:.4g} nm: formulas give {1e9 * expected:.3g} nm at {speed:.4g} m/s "
            f"and {1e-9 * problem.hertz.pressure:.3g} GPa; check units of film, speed and load"
        )


def noise_of(kind: str, noise: str | float, value: float) -> float:
    """Return the standard deviation of a measured value [SI].

    Parameters
    ----------
    kind : str
        One of `KINDS`.
    noise : str or float
        "3 %" of the value, or a number with the unit of the kind, "1 nm".
    value : float
        The measured one [SI].

    Raises
    ------
    InputError
        If it is not a positive number.
    """
    part = isinstance(noise, str) and noise.strip().endswith("%")
    try:
        found = quantity(Share).parse(noise) if part else KINDS[kind].read.parse(noise)
    except ValueError as error:
        raise InputError(f"noise of {kind} = {noise!r}: {error}") from None
    return found * value if part else found
