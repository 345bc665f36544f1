"""A result as one HTML page that needs nothing else: for a screen, a phone and paper."""

from collections.abc import Iterator
from html import escape
from pathlib import Path

from tehl.fields import FilmHeat, HeatBalance
from tehl.film_formulas import film_estimates
from tehl.io.atomic import check_writable, replacing
from tehl.io.tables import DEFINITIONS
from tehl.plots.save import Picture, pictures_of
from tehl.post.film import no_film
from tehl.post.heat import Temperature
from tehl.post.micro_film import RoughnessEffect
from tehl.post.roughness import rough_film
from tehl.post.thermal_effect import ThermalEffect
from tehl.report.inputs import input_rows
from tehl.report.parts import STYLE, image, section, table
from tehl.report.rough_film import WAVE_HEAD, WAVE_NOTE, effect_rows, film_rows, wave_rows
from tehl.result import ErrorEstimate, Estimate, Result

_CAPTIONS = {
    "film": "Film thickness. The dashed line is the Hertz contact; oil enters at the left.",
    "pressure": "Pressure.",
    "pressure_surface": "Pressure along x, one profile behind another.",
    "centre_lines": "Pressure and film on the centre lines over the dry contact.",
    "residuals": "Convergence, grid after grid.",
    "heights": "Heights of both surfaces together, positive outwards: peaks narrow the film.",
    "micro_film": "Ripples of film and pressure.",
    "rough_centre_line": "Pressure, film and heights along y = 0.",
    "film_distribution": "How the film is distributed over the Hertz contact.",
    "shear_stress": "Shear stress half-way between the surfaces.",
    "temperature": "Temperature rise half-way between the surfaces, over the oil at the inlet.",
    "temperature_layers": "Temperature rise on both surfaces and in the film.",
    "temperature_section": "Temperature rise in the plane y = 0, over z/h and as the film is.",
    "surface_heat": "Temperatures and heat that flows into the solids along y = 0.",
    "interferogram_white": "Synthetic interferogram, white light.",
    "interferogram_dichromatic": "Synthetic interferogram, two lines.",
}


def write_report(
    result: Result,
    path: str | Path,
    *,
    effect: ThermalEffect | None = None,
    roughness: RoughnessEffect | None = None,
    smooth: Result | None = None,
) -> None:
    """Write ``result`` as one HTML file with its pictures inside; whole, or not at all.

    Parameters
    ----------
    result : Result
        What to report, converged or not.
    path : str or Path
        The file; an older one is replaced.
    effect : ThermalEffect or None
        What heat does to the film, from an isothermal twin, if it was solved.
    roughness : RoughnessEffect or None
        What roughness does to the film, from a smooth twin, if it was solved.
    smooth : Result or None
        That twin, for the pictures.

    Raises
    ------
    InputError
        If the file cannot be written there.
    """
    check_writable(path)
    text = report_text(result, effect=effect, roughness=roughness, smooth=smooth)
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def report_text(
    result: Result,
    *,
    dpi: int = 110,
    effect: ThermalEffect | None = None,
    roughness: RoughnessEffect | None = None,
    smooth: Result | None = None,
) -> str:
    """Return the page as text.

    Parameters
    ----------
    result : Result
        What to report.
    dpi : int
        Dots per inch of the pictures.
    effect : ThermalEffect or None
        What heat does to the film, if it is known.
    roughness : RoughnessEffect or None
        What roughness does to the film, if it is known.
    smooth : Result or None
        The film between smooth surfaces, if it is known.
    """
    title = escape(result.problem.title or "Lubricated point contact")
    sections = (
        section("Result", _numbers(result)),
        *_heat_section(result),
        *_effect_section(result, effect),
        *_traction_section(result),
        *_roughness_section(result, roughness, smooth),
        section("Pictures", _pictures(pictures_of(result, smooth), result, dpi)),
        section("Formulas against computed", _formulas(result)),
        section("Inputs", _inputs(result)),
        section("Dimensionless groups", _groups(result)),
        section("Errors", _errors(result)),
        section("Convergence", _convergence(result)),
        section("Conventions", f"<pre>{escape(DEFINITIONS)}</pre>"),
        section("Provenance", _provenance(result)),
    )
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{title}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n"
        f"<h1>{title}</h1>\n{_status(result)}\n{''.join(sections)}</body>\n</html>\n"
    )


def _status(result: Result) -> str:
    status = result.status
    notes = "".join(f"<p>{escape(note)}</p>" for note in (status.message, status.hint) if note)
    if status.converged:
        return f'<div class="status good">converged{notes}</div>'
    return f'<div class="status bad">Not an answer - {escape(result.status.outcome)}{notes}</div>'


def _numbers(result: Result) -> str:
    if why := no_film(result):
        return f"<p>There is no film to report: {why}.</p>"
    scaled, scales = result.film_scaled, result.scales
    highest, errors = float(result.scaled.pressure.max()), result.errors
    nanometre, gigapascal = scales.film_thickness * 1e9, scales.hertz_pressure * 1e-9
    x, y = scaled.minimum_at
    place = f"{x * scales.half_width_x * 1e6:.4g}, {y * scales.half_width_y * 1e6:.4g} µm"
    grid: tuple[float | None, float | None] = (None, None)
    if errors is not None:
        grid = (errors.discretisation_minimum, errors.discretisation_central)
    bars = result.uncertainty
    rows = [
        _value("minimum film", scaled.minimum, nanometre, "nm", grid[0], bars.get("film_minimum")),
        _value("central film", scaled.central, nanometre, "nm", grid[1], bars.get("film_central")),
        _value("largest pressure", highest, gigapascal, "GPa", None, bars.get("pressure_max")),
    ]
    certified = ["certified"] if bars else []
    shown = [row if bars else (row[0], *row[2:]) for row in rows]
    body = table(("", *certified, "on this grid", "grid error", "dimensionless"), shown)
    return f"{body}<p class=small>The minimum lies at x, y = {place} ({x:.4g}, {y:.4g}).</p>"


def _value(
    name: str, scaled: float, unit: float, word: str, error: float | None, bar: Estimate | None
) -> tuple[str, str, str, str, str]:
    """Return a row: certified value with its bar, value on this grid, its error, scaled value."""
    certified = ""
    if bar is not None:
        certified = f"{bar.value * unit:.5g} ± {bar.uncertainty * unit:.2g} {word}"
    about = "not estimated" if error is None else f"about {_percent(error)}"
    return name, certified, f"{scaled * unit:.4g} {word}", about, f"{scaled:.5g}"


def _heat_section(result: Result) -> Iterator[str]:
    """Yield the section about heat, nothing for an isothermal run."""
    heat, found = result.heat, result.temperature
    if heat is None or found is None:
        return
    yield section(
        "Temperature",
        table(("", f"rise over {_celsius(found.inlet)}", "temperature", ""), _rises(heat, found))
        + "<h3>Heat</h3>"
        + table(("", "power"), _powers(heat.balance))
        + f"<p class=small>The powers balance to {_percent(heat.balance.error)}.</p>",
    )


def _effect_section(result: Result, effect: ThermalEffect | None) -> Iterator[str]:
    """Yield the section about the film without heat, nothing when it was not solved."""
    if effect is None:
        return
    film = result.film
    rows = [
        (
            "central film",
            _nm(film.central),
            _nm(effect.isothermal_central),
            f"{effect.central:.4f}",
        ),
        (
            "minimum film",
            _nm(film.minimum),
            _nm(effect.isothermal_minimum),
            f"{effect.minimum:.4f}",
        ),
    ]
    body = table(("", "with heat", "without", "ratio"), rows)
    if effect.inlet_factors:
        factors = (
            (f"{one.formula} ({one.source})", f"{one.factor:.4f}", "; ".join(one.remarks))
            for one in effect.inlet_factors
        )
        head = ("by heating in the inlet alone, by formula", "ratio", "remarks")
        body += f"<h3>Formulas</h3>{table(head, factors)}"
    note = "Without heat the oil is as warm everywhere as it is at the inlet."
    yield section("Film with heat and without", f"{body}<p class=small>{note}</p>")


def _rises(heat: FilmHeat, found: Temperature) -> list[tuple[str, str, str, str]]:
    x, y, zeta = found.film_rise_max_at
    rows = (
        ("film, at most", found.film_rise_max, f"X = {x:.4g}, Y = {y:.4g}, z/h = {zeta:.3g}"),
        ("mid-film, at X = Y = 0", found.mid_film_rise_central, ""),
        ("mean across the film, at X = Y = 0", found.mean_rise_central, ""),
        ("surface 1, at most", found.surface_1_rise_max, _source(heat, 0)),
        ("surface 2, at most", found.surface_2_rise_max, _source(heat, 1)),
    )
    return [
        (name, f"{rise:.4g} K", _celsius(found.inlet + rise), note) for name, rise, note in rows
    ]


def _celsius(temperature: float) -> str:
    return f"{temperature - 273.15:.4g} °C"


def _powers(balance: HeatBalance) -> list[tuple[str, str]]:
    rows = (
        ("generated by shear", balance.shear),
        ("generated by compression less expansion", balance.compression),
        ("conducted into surface 1", balance.surface_1),
        ("conducted into surface 2", balance.surface_2),
        ("carried out by the oil", balance.carried_out),
    )
    return [(name, f"{power:.4g} W") for name, power in rows]


def _source(heat: FilmHeat, side: int) -> str:
    return f"{heat.sources[side]} moving source, solid Péclet number {heat.solid_peclet[side]:.3g}"


def _traction_section(result: Result) -> Iterator[str]:
    """Yield the section about traction, nothing where there are no shear stresses."""
    found = result.traction
    if found is None:
        return
    rows = [
        ("on surface 1", f"{found.surface_1:.5g}", f"{found.surface_1 * found.load:.4g} N"),
        ("at mid-film: the sliding part", f"{found.sliding:.5g}", f"{found.sliding_force:.4g} N"),
        ("on surface 2", f"{found.surface_2:.5g}", f"{found.surface_2 * found.load:.4g} N"),
        ("rolling part", f"{found.rolling:.5g}", f"{found.rolling * found.load:.4g} N"),
    ]
    law = result.problem.lubricant.shear.law
    doubt = "" if found.credible else f"<p>More than any oil bears: the shear law is {law}.</p>"
    yield section(
        "Traction",
        table(("integral of tau = eta du/dz", "coefficient", "force"), rows)
        + doubt
        + "<p class=small>Negative where surface 1 is the faster: the film holds it back. The "
        f"surfaces spend {found.friction_power:.4g} W. Forces on the film balance to "
        f"{_percent(found.closure_error)} of the traction.</p>",
    )


def _roughness_section(
    result: Result, effect: RoughnessEffect | None, smooth: Result | None
) -> Iterator[str]:
    """Yield the section about rough surfaces, nothing for smooth ones."""
    found = rough_film(result, smooth)
    if found is None:
        return
    body = table(("", "", ""), film_rows(found))
    if found.waves:
        body += "<h3>Waves of the surfaces, in the middle of the contact</h3>"
        body += table(WAVE_HEAD, wave_rows(found.waves))
        body += f"<p class=small>{escape(WAVE_NOTE)}</p>"
    if effect is not None:
        body += "<h3>Film with roughness and without</h3>"
        body += table(("", "rough", "smooth", "ratio"), effect_rows(result, effect))
    yield section("Roughness", body)


def _pictures(known: dict[str, Picture], result: Result, dpi: int) -> str:
    figures = [
        f'<figure><img alt="{escape(caption)}" src="{image(known[name](result), dpi)}">'
        f"<figcaption>{escape(caption)}</figcaption></figure>"
        for name, caption in _CAPTIONS.items()
        if name in known
    ]
    return f'<div class="pictures">\n{chr(10).join(figures)}\n</div>'


def _formulas(result: Result) -> str:
    computed, none = result.film_scaled, bool(no_film(result))
    central, minimum = (0.0, 0.0) if none else (computed.central, computed.minimum)
    rows = []
    if not none:
        rows = [("this solve", _nm(result.film.central), "", _nm(result.film.minimum), "", "")]
    rows += [
        (
            f"{estimate.formula} ({estimate.source})",
            _nm(estimate.central_m),
            _off(estimate.central, central),
            _nm(estimate.minimum_m),
            _off(estimate.minimum, minimum),
            "; ".join(estimate.remarks),
        )
        for estimate in film_estimates(result.groups, result.scales)
    ]
    return table(
        ("", "central film", "formula - solve", "minimum film", "formula - solve", "remarks"), rows
    )


def _nm(metres: float | None) -> str:
    return "" if metres is None else f"{metres * 1e9:.4g} nm"


def _off(formula: float | None, computed: float) -> str:
    """Return by how many percent of the solve a formula lies off."""
    if formula is None or not computed > 0:
        return ""
    return f"{100 * (formula / computed - 1):+.1f} %"


def _inputs(result: Result) -> str:
    """Return one table for each part of the case: contact, surfaces, lubricant, numerics."""
    rows = (*input_rows(result.problem), *input_rows(result.options, "numerics."))
    parts: dict[str, list[tuple[str, str]]] = {}
    for row in rows:
        value = f"{row.value} {row.unit}".strip()
        parts.setdefault(row.path.split(".")[0], []).append((row.path, value))
    return "\n".join(
        f"<h3>{escape(part.replace('_', ' '))}</h3>\n{table(('key', 'value'), part_rows)}"
        for part, part_rows in parts.items()
        if part != "title"
    )


def _groups(result: Result) -> str:
    groups, scales = result.groups, result.scales
    rows = [
        ("M", f"{groups.M:.6g}", "Moes load"),
        ("L", f"{groups.L:.6g}", "Moes speed (lubricant)"),
        ("U", f"{groups.U:.6g}", "eta_0 u_m / (E' R_x)"),
        ("W", f"{groups.W:.6g}", "w / (E' R_x²)"),
        ("G", f"{groups.G:.6g}", "alpha E'"),
        ("lambda_bar", f"{groups.lambda_bar:.6g}", "12 eta_0 u_m R_x² / (a_x³ p_h)"),
        ("alpha_bar", f"{groups.alpha_bar:.6g}", "alpha p_h"),
        ("ellipticity", f"{groups.ellipticity:.6g}", "a_y / a_x"),
        ("p_h", f"{scales.hertz_pressure * 1e-9:.6g} GPa", "Hertz pressure"),
        ("a_x", f"{scales.half_width_x * 1e6:.6g} µm", "Hertz half-width along entrainment"),
        ("a_y", f"{scales.half_width_y * 1e6:.6g} µm", "Hertz half-width across entrainment"),
        ("w", f"{scales.load:.6g} N", "load"),
        ("u_m", f"{scales.speed:.6g} m/s", "entrainment speed"),
    ]
    return table(("group", "value", ""), rows)


def _errors(result: Result) -> str:
    parts = [_error_bars(result)] if result.uncertainty else []
    if result.errors is not None:
        parts.append(_estimates(result.errors))
    return "\n".join(parts) or "<p>No error could be estimated.</p>"


def _error_bars(result: Result) -> str:
    film = (result.scales.film_thickness * 1e9, "nm")
    units = {
        "pressure_max": (result.scales.hertz_pressure * 1e-9, "GPa"),
        "film_rise_max": (1.0, "K"),
        "mid_film_rise_central": (1.0, "K"),
        "traction_mid_film": (1.0, ""),
    }
    rows = [
        _certified(name, estimate, *units.get(name, film))
        for name, estimate in result.uncertainty.items()
    ]
    head = ("certified", "value", "± all", "± grid", "± domain", "order", "on the grids")
    return table(head, rows)


def _estimates(errors: ErrorEstimate) -> str:
    grid = (errors.discretisation_central, errors.discretisation_minimum)
    iteration = (errors.iteration_central, errors.iteration_minimum)
    rows = [("grid", *map(_percent, grid)), ("iteration", *map(_percent, iteration))]
    return table(("estimated, relative", "central film", "minimum film"), rows)


def _certified(name: str, estimate: Estimate, unit: float, word: str) -> tuple[str, ...]:
    order = "" if estimate.observed_order is None else f"{estimate.observed_order:.2f}"
    return (
        name.replace("_", " "),
        f"{estimate.value * unit:.5g} {word}",
        f"{estimate.uncertainty * unit:.2g} {word}",
        f"{estimate.discretisation * unit:.2g} {word}",
        f"{estimate.domain * unit:.2g} {word}",
        order,
        ", ".join(f"{value * unit:.5g}" for value in estimate.values),
    )


def _percent(value: float) -> str:
    return f"{100 * value:.2g} %"


def _convergence(result: Result) -> str:
    thermal = result.heat is not None
    warming = ("ΔT [K]",) if thermal else ()
    head = ("grid", "cycle", "residual", "change", "load error", "H central", "H min")
    rows = [
        (
            "{} × {}".format(*report.points),
            str(report.cycle),
            f"{report.residual:.2e}",
            f"{report.change:.2e}",
            f"{report.load_error:.1e}",
            f"{report.film_central:.6f}",
            f"{report.film_minimum:.6f}",
            *([f"{report.temperature_change:.2e}"] if thermal else []),
            report.smoother,
        )
        for report in result.history
    ]
    body = table((*head, *warming, "sweeps"), rows)
    return body if rows else "<p>No cycles were recorded.</p>"


def _provenance(result: Result) -> str:
    cost = result.cost
    rows = [
        ("made", result.provenance.created),
        ("solve", f"{cost.cpu_seconds:.3g} s of one processor, {cost.wall_seconds:.3g} s in all"),
        ("grid", f"{result.scaled.x.size} × {result.scaled.y.size} nodes"),
        *sorted(result.provenance.versions.items()),
    ]
    return table(("", ""), rows)
