"""The oil from a test: from files of films and tractions to the table of a lubricant."""

import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tehl.api.problem import case_from_tables
from tehl.base.atomic import replacing
from tehl.base.errors import InputError
from tehl.base.lazy import lazy
from tehl.base.typing import Array
from tehl.base.units import percentage
from tehl.base.version import __version__
from tehl.base.wording import aligned, toml_value
from tehl.lubricant.fluid import Lubricant
from tehl.studies.engines import engine_of
from tehl.studies.fitting.constants import Fitted, constants_of, default_names, with_value
from tehl.studies.fitting.estimate import CONFIDENCE, Estimate, estimate
from tehl.studies.fitting.measured import KINDS, Point, base_tables, noise_of, points_of
from tehl.studies.fitting.model import FIT_ERROR, Model
from tehl.studies.fitting.remarks import remarks
from tehl.studies.fitting.rig import Probe

if TYPE_CHECKING:
    import pandas as pd
else:
    pd = lazy("pandas")


@dataclass(frozen=True, kw_only=True, slots=True)
class OilFit:
    """Constants of an oil by a test."""

    constants: tuple[Fitted, ...]
    correlation: Array
    """Of the logarithms of the constants, (constants, constants)."""
    noise: Mapping[str, float]
    """Estimated standard deviations by kind, a share or absolute; kinds with stated ones lack."""
    scatter: float
    """Mean square of the residuals in units of the noise [-]."""
    table: "pd.DataFrame"
    """A row per measured value: measured, noise, fitted, the condition of its contact."""
    remarks: tuple[str, ...]
    """What the test does not determine, and what does not fit."""
    lubricant_table: Mapping[str, Any]
    """As a case states it."""
    solves: int

    @property
    def lubricant(self) -> Lubricant:
        """The oil with the fitted constants."""
        return Lubricant.model_validate(self.lubricant_table)

    def __getitem__(self, name: str) -> Fitted:
        """Return a constant by its name."""
        return {one.constant.name: one for one in self.constants}[name]

    def __repr__(self) -> str:
        """Return the text that ``tehl fit`` prints."""
        return self.text()

    def text(self) -> str:
        """Return constants, intervals, noise, remarks and residuals in lines."""
        counts = self.table["kind"].value_counts()
        parts = ", ".join(f"{counts[kind]} of {kind}" for kind in KINDS if kind in counts)
        lines = [f"Fit of {len(self.table)} measured values ({parts}) by {self.solves} solves"]
        head = ("constant", "value", f"{percentage(CONFIDENCE)} interval", "start", "grid")
        rows = [
            (
                one.constant.name,
                one.constant.shown(one.value),
                one.interval,
                one.constant.shown(one.constant.start),
                f"± {percentage(one.grid_error)}",
            )
            for one in self.constants
        ]
        lines += [f"  {line}" for line in aligned([head, *rows])]
        for kind, noise in self.noise.items():
            lines.append(f"  noise of {kind}, estimated: {_noise_text(kind, noise)}")
        if not self.noise or len(self.noise) < len(counts):
            lines.append(f"  scatter over the stated noise: {math.sqrt(self.scatter):.2f}")
        lines += [f"  note: {text}" for text in self.remarks]
        return "\n".join(lines)

    def toml(self) -> str:
        """Return the table ``[lubricant]`` of a case file, with the fit in comments."""
        comments = [f"# {line}" for line in self.text().splitlines()]
        keys = [f"{key} = {toml_value(value)}" for key, value in self.lubricant_table.items()]
        return "\n".join([f"# tehl {__version__}", *comments, "", "[lubricant]", *keys, ""])

    def save(self, path: str | Path) -> None:
        """Write the table of the lubricant as TOML."""
        with replacing(path) as temporary:
            temporary.write_text(self.toml(), encoding="utf-8")

    def as_json(self) -> dict[str, Any]:
        """Return the numbers in SI for programs; None where an interval is open."""
        return {
            "status": "converged",
            "constants": {
                one.constant.name: {
                    "key": one.constant.key,
                    "value": one.value,
                    "low": one.low or None,
                    "high": one.high if math.isfinite(one.high) else None,
                    "start": one.constant.start,
                    "grid_error": one.grid_error,
                }
                for one in self.constants
            },
            "correlation": self.correlation.tolist(),
            "noise": dict(self.noise),
            "scatter": self.scatter,
            "remarks": list(self.remarks),
            "points": json.loads(self.table.to_json(orient="records", double_precision=12)),
            "lubricant": dict(self.lubricant_table),
            "solves": self.solves,
        }


def _noise_text(kind: str, noise: float) -> str:
    """Return an estimated noise, a share or in SI, as people read it."""
    one = KINDS[kind]
    return percentage(noise) if one.is_relative else f"{noise / one.scale:.2g} {one.unit}".strip()


def fit(  # noqa: PLR0913 (keywords with defaults)
    data: Any,
    case: Any,
    names: Sequence[str] | None = None,
    *,
    noise: Mapping[str, str | float] | None = None,
    probe: Probe | None = None,
    jobs: int = 1,
    forked: bool = False,
    report: Callable[[str], None] = lambda _: None,
) -> OilFit:
    """Fit constants of an oil to measured films and tractions, through the solver.

    Parameters
    ----------
    data : str, Path, DataFrame, or list of them
        Text files of an MTM or EHD2, lists in CSV, Excel or Parquet, or tables. Columns are those
        of `tehl.solve_contacts`, further ``"film [nm]"``, ``"traction"``, and their standard
        deviations, ``"± film [nm]"``.
    case : str, Path, Mapping, ContactProblem, or list of them
        Case file, its tables, or a contact, with the bodies and the oil before the fit: one for all
        data, or one for each. The oil is that of the first.
    names : sequence of str or None
        Constants: ``"alpha"``, ``"eyring_stress"``, ``"carreau_modulus"``, ``"carreau_exponent"``,
        ``"limiting_stress"``, ``"limiting_slope"``, or keys of the lubricant. If left out, alpha
        for films and the constants of the shear law for traction.
    noise : Mapping or None
        Standard deviations by kind, ``{"film": "3 %", "traction": 0.001}``, where no column states
        them; without, they are estimated by the residuals.
    probe : {"lube", "pot"} or None
        Which temperature of a rig is that of the oil.
    jobs : int
        Processes. With more than one, a script needs ``if __name__ == "__main__":``.
    forked : bool
        As in `tehl.studies.run`.
    report : callable
        Takes a line on each step.

    Returns
    -------
    OilFit
        Constants with intervals, what the data do not determine, and the table of the lubricant.

    Raises
    ------
    InputError
        If a file, a row, a name or the case is invalid, or a film of the test does not converge.
    """
    points, table = _points(data, case, noise or {}, probe)
    problem = points[0][0].problem(table)
    if not names:
        names = default_names((kind for one, _ in points for kind in one.measured), problem)
    constants, table = constants_of(names, table, problem)
    with engine_of(jobs, len(points), forked=forked) as engine:
        model = Model(points, constants, table, engine, report)
        report(f"{len(points)} points, {', '.join(names)}: the grids")
        model.fix_nodes()
        values = [model.points[k].measured[kind] for k, kind in model.places]
        measured, stated = np.array(values, dtype=float).T  # None becomes NaN
        return _result(model, measured, estimate(model, measured, stated))


def _points(
    data: Any, case: Any, noise: Mapping[str, str | float], probe: Probe | None
) -> tuple[list[tuple[Point, Any]], dict[str, Any]]:
    """Return the points of all data with the options of their cases, and the oil of the first."""
    sources = list(data) if isinstance(data, list | tuple) else [data]
    cases = list(case) if isinstance(case, list | tuple) else [case]
    if not sources or len(cases) not in (1, len(sources)):
        raise InputError(
            f"{len(sources)} files of data and {len(cases)} cases: give one case for all files, or "
            "one for each"
        )
    for kind, value in noise.items():
        if kind not in KINDS:
            raise InputError(f"noise of {kind}: is not measured; known are {', '.join(KINDS)}")
        noise_of(kind, value, 1.0)
    bases = [base_tables(one) for one in cases]
    oil = bases[0][0]["lubricant"]
    found = []
    for source, (tables, folder) in zip(sources, bases * (len(sources) // len(bases)), strict=True):
        base = tables | {"lubricant": oil}
        options = case_from_tables(base, folder)[1]
        if options.points == "auto" and options.error is None:
            options = options.model_copy(update={"error": FIT_ERROR})
        found += [
            (one, options) for one in points_of(source, base, folder, noise=noise, probe=probe)
        ]
    if not found:
        raise InputError("no row has a measured value: fill a column film [nm] or traction")
    return found, oil


def _result(model: Model, measured: Array, found: Estimate) -> OilFit:
    starts = np.array([one.start for one in model.constants])
    with np.errstate(over="ignore"):
        low, high = starts * np.exp(found.ends.T)
    spread = np.sqrt(np.diag(found.covariance))
    constants = tuple(
        Fitted(one, float(value), float(low[k]), float(high[k]), float(found.grid_errors[k]))
        for k, (one, value) in enumerate(
            zip(model.constants, starts * np.exp(found.x), strict=True)
        )
    )
    correlation = found.covariance / np.outer(spread, spread)
    rows = [
        _row(model, place, kind, numbers)
        for (place, kind), numbers in zip(
            model.places, zip(measured, found.noise, found.fitted, strict=True), strict=True
        )
    ]
    table = model.at(found.x)
    for one in constants:
        text = one.constant.shown(one.value)  # to as many digits
        stated = text if one.constant.unit else float(f"{one.value:.4g}")
        table = with_value(table, one.constant, stated)
    answers = model.answers(found.x)[0]
    reached = max((getattr(one, "reached", 0.0) for one in answers), default=0.0)
    frame = pd.DataFrame(rows)
    return OilFit(
        constants=constants,
        correlation=correlation,
        noise=found.noises,
        scatter=found.scatter,
        table=frame,
        remarks=tuple(remarks(constants, correlation, frame, found, reached)),
        lubricant_table=table,
        solves=model.solves,
    )


def _row(model: Model, place: int, kind: str, numbers: Any) -> dict[str, Any]:
    """Return the row of a measured value in the table of a fit."""
    measured, noise, fitted = map(float, numbers)
    point = model.points[place]
    problem = point.problem(model.lubricant)
    return {
        "point": point.label,
        "kind": kind,
        "measured": measured,
        "noise": noise,
        "fitted": fitted,
        "residual": (measured - fitted) / noise,
        "u_m [m/s]": problem.entrainment_speed,
        "SRR": problem.slide_roll_ratio,
        "p_h [GPa]": 1e-9 * problem.hertz.pressure,
        "T [°C]": problem.inlet_temperature - 273.15,
    }
