"""A result, steady or transient, as one self-contained HTML page with its pictures inside."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from tehl.base.errors import InputError
from tehl.contact.moment import Moment, moment_at
from tehl.estimate.film_formulas import film_estimates
from tehl.estimate.wave_theory import waves_of
from tehl.io.tables import DEFINITIONS
from tehl.plots import Pictures, pictures_of
from tehl.post.film import no_film
from tehl.post.heat import UNTRUSTED_HEAT, work_error
from tehl.post.micro_film import RoughnessEffect
from tehl.post.roughness import rough_film
from tehl.post.thermal_effect import ThermalEffect
from tehl.post.transient import largest_change, passing_features
from tehl.post.waves import PassingWave, passing_wave
from tehl.report.explain import explain
from tehl.report.notebook import data_url
from tehl.report.readable import UNTITLED, input_rows
from tehl.report.rendering import FILTERS, UNITS, render
from tehl.report.rows import following, rows_of
from tehl.result.bars import Estimate
from tehl.result.registry import named
from tehl.result.solution import Solution
from tehl.result.transient import TransientSolution

CAPTIONS = {
    "history": "Film, pressure and traction over time.",
    "moments": "Pressure, film and the undeformed rough body along y = 0 at several times.",
    "space_time": "Film and pressure along y = 0 over place and time, with paths of the surfaces.",
    "passage": "Range of film and pressure along y = 0 over the run.",
    "film": "Film thickness. The dashed line is the Hertz contact; oil enters at the left.",
    "pressure": "Pressure.",
    "pressure_surface": "Pressure along x, one profile behind another.",
    "centre_lines": "Pressure and film on the centre lines, with the dry contact.",
    "asperities": "Pressure that asperities finer than the grid carry, averaged over many.",
    "contact": "Pressure where the surfaces touch through the boundary film.",
    "oil": "Part of the gap that is oil, the meniscus where the film begins, stream lines.",
    "passes": "Film and oil pass after pass.",
    "residuals": "Convergence, grid after grid.",
    "heights": "Heights of both surfaces together, positive outwards: peaks narrow the film.",
    "micro_film": "Ripples of film and pressure.",
    "rough_centre_line": "Pressure, film and heights along y = 0.",
    "film_distribution": "Distribution of the film thickness over the Hertz contact.",
    "shear_stress": "Shear stress half-way between the surfaces.",
    "temperature": "Temperature rise half-way between the surfaces, over the oil at the inlet.",
    "temperature_layers": "Temperature rise on both surfaces and in the film.",
    "temperature_section": "Temperature rise in the plane y = 0, over z/h and over z.",
    "dynamics": "Stiffness and damping of the film over frequency, with their error bars.",
    "stress": "Largest shear stress on y = 0 below a surface, and the largest at each depth.",
    "stress_planes": "Largest shear stress on x = 0, and at the depth where it is largest.",
    "moving_stress": "Largest shear stress below a surface: when it is largest, and over time.",
    "surface_heat": "Temperatures and heat fluxes into the solids along y = 0.",
    "interferogram_white": "Synthetic interferogram, white light.",
    "interferogram_dichromatic": "Synthetic interferogram, two lines.",
}
"""Pictures of a report, in its order."""


def report_text(
    result: Solution | TransientSolution,
    *,
    dpi: int = 110,
    effect: ThermalEffect | None = None,
    roughness: RoughnessEffect | None = None,
    smooth: Solution | None = None,
) -> str:
    """Return ``result`` as one HTML page with its pictures inside.

    Parameters
    ----------
    result : Solution or TransientSolution
        Converged or not.
    dpi : int
        Dots per inch of the pictures.
    effect : ThermalEffect or None
        Effect of heat on a steady film, from an isothermal reference run.
    roughness : RoughnessEffect or None
        Effect of roughness on a steady film, from a smooth reference run.
    smooth : Solution or None
        That reference run, for the pictures.
    """
    content = _shared(result, pictures_of(result, smooth), dpi)
    if isinstance(result, TransientSolution):
        return render("transient.html", **content, **_transient(result))
    content |= {
        "effect": effect,
        "heat": result.heat,
        "longest": 12,  # cycles that a report lists
        "main_rows": list(rows_of(result, "report")),
        "rises": list(rows_of(result, "rises")),
        "rough": rough_film(result, smooth),
        "roughness_effect": roughness,
        "untrusted": UNTRUSTED_HEAT,
        "work_error": work_error(result),
    }
    return render("steady.html", **content)


def _shared(result: Solution | TransientSolution, pictures: Pictures, dpi: int) -> dict[str, Any]:
    """Return the content of both kinds of page."""
    start = result.start if isinstance(result, TransientSolution) else result
    bars = result.certified
    return {
        "bars": bars,
        "certified": list(_certified(bars)),
        "conventions": DEFINITIONS,
        "as_stated": replace(moment_at(start.problem, 0.0), sliding=0.0, across=0.0) == Moment(),
        "formulas": film_estimates(start.groups, start.scales),
        "inputs": _inputs(start),
        "no_film": no_film(start),
        "rough": rough_film(start),
        "questions": explain(start.problem, start.options).questions,
        "pictures": [
            (caption, data_url(pictures[name](result), dpi))
            for name, caption in CAPTIONS.items()
            if name in pictures
        ],
        "result": result,
        "following": following(result),
        "start": start,
        "title": start.problem.title or UNTITLED,
    }


def _inputs(result: Solution) -> dict[str, list[tuple[str, str]]]:
    """Return key and value of each input, by table of the case file."""
    tables: dict[str, list[tuple[str, str]]] = {}
    for path, value in (*input_rows(result.problem), *input_rows(result.options, "numerics.")):
        tables.setdefault(path.split(".")[0].replace("_", " "), []).append((path, value))
    tables.pop("title", None)
    return tables


def _certified(certified: dict[str, Estimate]) -> Iterator[tuple[str, ...]]:
    """Yield a row for each value with an error bar."""
    for name, one in certified.items():
        factor, word = UNITS[FILTERS[named(name).unit]]
        parts = (one.uncertainty, one.discretisation, one.domain)
        yield (
            name.replace("_", " "),
            f"{one.value * factor:.5g}{word}",
            *(f"{part * factor:.2g}{word}" for part in parts),
            _order(one),
            ", ".join(f"{value * factor:.5g}" for value in one.values),
        )


def _order(estimate: Estimate) -> str:
    """Return the observed order, marked where the value is not extrapolated with it."""
    if len(estimate.values) < 3:
        return ""
    order = estimate.observed_order
    shown = "none" if order is None else f"{order:.2f}"
    return shown if estimate.is_second_order else f"{shown} (not 2: not extrapolated)"


def _transient(run: TransientSolution) -> dict[str, Any]:
    """Return the effect of the roughness on a transient film."""
    changes = (
        ("thinning", "nm", "film", -1),
        ("thickening", "nm", "film", 1),
        ("pressure drop", "gpa", "pressure", -1),
        ("pressure rise", "gpa", "pressure", 1),
    )
    return {
        "changes": [
            (label, unit, largest_change(run, name, sign)) for label, unit, name, sign in changes
        ],
        "features": list(passing_features(run)),
        "waves": list(_waves(run)),
    }


def _waves(run: TransientSolution) -> Iterator[tuple[int, PassingWave | str]]:
    """Yield surface and passing wave of each wavy surface, or why it cannot be evaluated."""
    for number in (1, 2):
        if any(waves_of(getattr(run.start.problem, f"surface_{number}").roughness)):
            try:
                yield number, passing_wave(run, number)
            except InputError as error:
                yield number, str(error)
