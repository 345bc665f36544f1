"""The table of a study: a row per case, a column per label and per number of the summary."""

import difflib
import re
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from tehl.base.lazy import lazy
from tehl.result.solution import settings_text
from tehl.studies.case import Case, Scalar, unit_of
from tehl.studies.store import Store

if TYPE_CHECKING:
    import pandas as pd

    from tehl.studies import frame as frames
else:
    frames = lazy("tehl.studies.frame")

OPEN = "open"
"""Status of a case that is not finished."""
_OUTCOME = ("status", "cause", "message")
_BUILT_IN = ("name", *_OUTCOME, "hint", "retry_settings", "key")
"""Columns that every table has, the hint of a case, and the settings of a retry."""

_WAVE = (
    "wavelength_m angle_rad amplitude_m points_per_wave film_amplitude_m film_phase_rad film_ratio "
    "pressure_amplitude_pa pressure_phase_rad carried_amplitude_m theory_film_ratio "
    "theory_pressure_pa elastic_pressure_pa compressibility"
)
_BLOCKS = {
    "laws": "viscosity viscosity_temperature density shear reynolds",
    "domain": "x.0 y.0",
    "groups": "M L U W G lambda_bar alpha_bar ellipticity radius_ratio hertz_pressure_pa "
    "hertz_half_width_m hertz_half_width_y_m",
    "film": "h_min_m h_central_m H_min H_min_node H_central H_min_moes H_central_moes "
    "minimum_at.0 rigid_approach",
    "pressure": "max_pa P_max P_central",
    "temperature": "film_rise_max_k film_rise_max_at.0 mid_film_rise_central_k "
    "mean_rise_central_k surface_1_rise_max_k surface_2_rise_max_k inlet_k",
    "traction": "surface_1 mid_film surface_2 sliding rolling rolling_by_film closure_error "
    "credible friction_power_w surroundings.surface_1 surroundings.mid_film surroundings.surface_2 "
    "surroundings.friction_power_w surroundings.radius_m",
    "heat": "shear_w compression_w surface_1_w surface_2_w carried_out_w solid_peclet.0 sources.0",
    "roughness": "surface_1_sq_m surface_2_sq_m composite_sq_m surface_1_sa_m surface_2_sa_m "
    "surface_1_sq_on_grid_m surface_2_sq_on_grid_m composite_sq_on_grid_m lost_share warning "
    "lambda_central lambda_minimum lambda_by_formula lubrication film_quantiles.0.part "
    "film_quantiles.0.h_m area_below_composite_sq area_below_half_median minimum_at.0 P_max "
    "ripple_film_m ripple_pressure_pa ripples_x.count ripples_x.depth_m ripples_y.count "
    "ripples_y.depth_m " + " ".join(f"waves.0.{key}" for key in _WAVE.split()),
    "load_sharing": "share share_error friction friction_film friction_boundary area_m2 area_part "
    "asperity_pressure_max_pa pressure_max_pa separation_central_m separation_ratio "
    "power_boundary_w balance spots.number spots.radius_m spots.pressure_pa "
    "spots.elastic_pressure_pa spots.flash_rise_k",
    "touching": "share share_error margin_m friction friction_film friction_boundary area_m2 "
    "area_part contact_pressure_max_pa pressure_max_pa power_boundary_w balance patches.number "
    "patches.area_mean_m2 patches.area_largest_m2 patches.pressure_mean_pa patches.pressure_max_pa "
    "patches.cells",
    "starvation": "ratio degree degree_error degree_by_law flooded_film_m meniscus_m "
    "inlet_distance_m entering_m leaving_m leaving_each_m balance",
    "convergence": "cycles residual change load_error heat_balance_error work_balance_error",
    "errors": "central minimum discretisation_central discretisation_minimum iteration_central "
    "iteration_minimum domain supply load_share pressure_max traction_mid_film film_rise_max "
    "mid_film_rise_central surface_1_rise_max surface_2_rise_max ripple_film ripple_pressure "
    "heat_shear heat_compression heat_surface_1 heat_surface_2 heat_carried_out extrapolated "
    "spike_resolved",
    "cost": "points.0 cpu_seconds wall_seconds work",
}
"""Columns of the summary by their blocks; of a list, those of its first entry."""
_MIRROR = "uncertainty"
"""Block that repeats the names of others."""
_NUMBERS = tuple(f"{block}.{key}" for block, keys in _BLOCKS.items() for key in keys.split())
_INDEX = re.compile(r"\.\d+(?=\.|$)")


def table(
    cases: Iterable[Case], store: Store, units: Mapping[str, str] | None = None
) -> "pd.DataFrame":
    """Return the outcome of each case, those that are not finished as ``status = "open"``.

    Parameters
    ----------
    cases : iterable of Case
        The study; the table has their order.
    store : Store
        Where their rows are.
    units : mapping of str to str
        Units of the labels, ``"1"`` where they have none.

    Returns
    -------
    pandas.DataFrame
        A notebook shows its main columns and a curve.
        Columns ``name``, the labels, ``status``, ``cause``, ``message``, every scalar of the
        summary by its dotted name: ``film.h_min_m``, and ``key``, under which fields are kept.
        ``attrs["units"]`` has the unit of each column of numbers.
    """
    cases = list(cases)
    rows = store.rows(cases)
    lines: list[dict[str, Scalar]] = []
    for case in cases:
        line: dict[str, Scalar] = {"name": case.name, **case.labels}
        row = rows.get(case.key)
        if row is None:
            line |= {"status": OPEN, "cause": None, "message": None}
        else:
            line |= {name: getattr(row, name) for name in _OUTCOME} | dict(row.summary)
            if row.retry_settings:
                line["retry_settings"] = settings_text(row.retry_settings)
        lines.append(line | {"key": case.key})
    labels = [label for case in cases for label in case.labels]
    names = dict.fromkeys(["name", *labels, *_OUTCOME, *(name for line in lines for name in line)])
    frame = frames.StudyTable(lines, columns=[*(name for name in names if name != "key"), "key"])
    numbers = frame.select_dtypes("number").columns
    known = units or {}
    frame.attrs["units"] = {name: known.get(name) or unit_of(name) for name in numbers}
    return frame


def is_reserved(name: str) -> bool:
    """Return whether a column of this name has another meaning in every table."""
    block, dot, _ = name.partition(".")
    return name in _BUILT_IN or bool(dot and (block in _BLOCKS or block == _MIRROR))


def is_number(name: str) -> bool:
    """Return whether a summary may have a column of this full name."""
    return _INDEX.sub(".0", name) in _NUMBERS or name.partition(".")[0] == _MIRROR


def missing_column(labels: Iterable[str], name: str) -> str | None:
    """Return why a table with these axes cannot have a column, None where it can.

    A picture names the column in full or by its last part, optionally with a minus before it.
    """
    wanted = name.removeprefix("-")
    known = [*labels, *_BUILT_IN, *_NUMBERS]
    endings = (f".{wanted}", f".{_INDEX.sub('.0', wanted)}")
    if is_number(wanted) or any(f".{column}".endswith(endings) for column in known):
        return None
    last = [column.rpartition(".")[2] for column in known]
    close = difflib.get_close_matches(wanted, [*known, *last], n=1, cutoff=0.6)
    hint = f"did you mean {close[0]}?" if close else f"it has {', '.join(known[:8])} ..."
    return f"the table will have no column {wanted}: {hint}"
