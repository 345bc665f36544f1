"""The answer before the solve: what a case means, by formulas alone, at once."""

import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

from tehl.domain import AIM, needed_points, recommended_domain
from tehl.film_formulas import (
    FilmEstimate,
    InletFactor,
    Regime,
    expected_central_film,
    film_estimates,
    inlet_factors,
    inlet_heating_factor,
    regime,
    thermal_loading,
)
from tehl.heat import FilmEnergy, source_form
from tehl.memory import available_memory, needed_memory
from tehl.options import Domain, Options, coarsenable
from tehl.problem import ContactProblem
from tehl.report.asperities import (
    ANSWERS,
    CONVERGES,
    Asperities,
    ExpectedWave,
    asperities,
    odd_asperities,
)
from tehl.report.bodies import BodyEffect, body_effect
from tehl.report.heating import ExpectedHeat, expected_heat
from tehl.report.suspicion import questions
from tehl.report.time import TimePlan, time_plan
from tehl.report.time import as_lines as time_as_lines
from tehl.report.time import as_summary as time_as_summary
from tehl.scaling import Groups, Scales, groups, scales

SECONDS_PER_NODE = 1.5e-6
SECONDS_COUPLED = 6e-6
"""Time of a solve by node of the finest full grid on one core of a usual machine; a guide."""

LEAST_RISE, LEAST_TRACTION = 0.1, 1e-4
"""Rise [K] and traction coefficient below which a number would say nothing."""
UNTITLED = "Lubricated point contact"
"""Title of a case that has none."""

_LENGTHS = ((1e-3, 1e3, "mm"), (1e-6, 1e6, "um"), (0.0, 1e9, "nm"))


@dataclass(frozen=True, kw_only=True, slots=True)
class Explanation:
    """What can be said about a case without solving it.

    Attributes
    ----------
    problem, options : ContactProblem, Options
        The case.
    groups, scales : Groups, Scales
        Its groups and units.
    regime : str
        Lubrication regime.
    central_film : float
        Central film to expect [m].
    films : tuple of FilmEstimate
        By each formula.
    lambda_ratio : float or None
        Central film over roughness of both surfaces [-]; None when no roughness is stated.
    roughness : Asperities or None
        What the heights of the surfaces mean; None where both are smooth.
    peclet : tuple of (float or None)
        ``|u_s| a_x / (2 diffusivity)`` of both solids [-]; None where a property is not stated.
    inlet_heating : float or None
        Factor by which inlet shear heating thins the film, after Wilson and Sheu [-].
    inlet_factors : tuple of InletFactor
        The same by each formula.
    thermal_loading : float or None
        eta_0 b u_m^2 / k [-]; None where a property is not stated.
    bodies : BodyEffect or None
        What bodies do to the film that are not as warm as the oil; None if they are.
    heat : ExpectedHeat or None
        Temperature rises to expect; None where the solids state too little.
    sources : tuple of ({"line", "full"} or None)
        Moving source that either surface takes in a thermal run; None where a property is missing.
    domain : Domain
        The domain that a solve takes: the one stated, else the recommended one.
    recommended_domain : Domain
        From the load.
    needed_points : int
        Nodes per direction that give the central film to about three percent.
    memory, seconds : float
        Estimated peak memory [byte] and time [s] of a solve.
    time : TimePlan or None
        What a transient run will do; None for a steady case.
    questions : tuple of str
        What looks odd.
    """

    problem: ContactProblem
    options: Options
    groups: Groups
    scales: Scales
    regime: Regime
    central_film: float
    films: tuple[FilmEstimate, ...]
    lambda_ratio: float | None
    roughness: Asperities | None
    peclet: tuple[float | None, float | None]
    inlet_heating: float | None
    inlet_factors: tuple[InletFactor, ...]
    thermal_loading: float | None
    bodies: BodyEffect | None
    heat: ExpectedHeat | None
    sources: tuple[str | None, str | None]
    domain: Domain
    recommended_domain: Domain
    needed_points: int
    memory: float
    seconds: float
    time: TimePlan | None
    questions: tuple[str, ...]


def explain(problem: ContactProblem, options: Options) -> Explanation:
    """Return what can be said about a case without solving it."""
    case_groups, case_scales = groups(problem), scales(problem)
    film = expected_central_film(case_groups) * case_scales.film_thickness
    wanted = recommended_domain(case_groups)
    nodes = options.shape[0] * options.shape[1]
    first, second = problem.solid_peclet
    domain = options.domain if isinstance(options.domain, Domain) else wanted
    heights = asperities(problem, options, domain, film)
    rough = problem.rms_roughness if heights is None else heights.composite
    heat, bodies = expected_heat(problem), body_effect(problem)
    plan = time_plan(problem, options)
    thinnest = bodies.groups if bodies is not None and bodies.ratio < 1 else case_groups
    return Explanation(
        problem=problem,
        options=options,
        groups=case_groups,
        scales=case_scales,
        regime=regime(case_groups),
        central_film=film,
        films=film_estimates(case_groups, case_scales),
        lambda_ratio=film / rough if rough > 0 else None,
        roughness=heights,
        peclet=(None if first is None else abs(first), None if second is None else abs(second)),
        inlet_heating=inlet_heating_factor(problem),
        inlet_factors=inlet_factors(problem),
        thermal_loading=thermal_loading(problem),
        bodies=bodies,
        heat=heat,
        sources=(_source(problem, first), _source(problem, second)),
        domain=domain,
        recommended_domain=wanted,
        needed_points=coarsenable(needed_points(thinnest) - 2)[1],
        memory=needed_memory(options, problem),
        seconds=(SECONDS_COUPLED if problem.is_coupled else SECONDS_PER_NODE) * nodes,
        time=plan,
        questions=(
            *questions(problem, options, case_groups, film, heat=heat),
            *odd_asperities(heights, problem, options, film),
            *(plan.questions if plan else ()),
        ),
    )


def _source(problem: ContactProblem, peclet: float | None) -> str | None:
    heat = problem.heat
    stated = heat.sources if isinstance(heat, FilmEnergy) else "auto"
    return None if peclet is None else source_form(stated, peclet)


def as_summary(explanation: Explanation) -> dict[str, Any]:
    """Return an explanation as one JSON object."""
    case, hertz = explanation, explanation.problem.hertz
    return {
        "title": case.problem.title,
        "groups": asdict(case.groups)
        | {"hertz_pressure_pa": hertz.pressure, "hertz_half_width_m": hertz.half_width_x},
        "hertz": asdict(hertz),
        "load_n": case.problem.load,
        "entrainment_speed_m_s": case.problem.entrainment_speed,
        "reduced_modulus_pa": case.problem.reduced_modulus,
        "radius_x_m": case.problem.radius_x,
        "radius_y_m": case.problem.radius_y,
        "regime": case.regime,
        "central_film_m": case.central_film,
        "films": [asdict(film) | {"valid": film.valid} for film in case.films],
        "lambda_ratio": case.lambda_ratio,
        "roughness": None if case.roughness is None else asdict(case.roughness),
        "solid_peclet": list(case.peclet),
        "inlet_heating_factor": case.inlet_heating,
        "inlet_factors": [asdict(factor) for factor in case.inlet_factors],
        "thermal_loading": case.thermal_loading,
        "bodies": None if case.bodies is None else asdict(case.bodies),
        "expected_heat": None if case.heat is None else asdict(case.heat),
        "sources": list(case.sources),
        "thermal": case.problem.thermal is not None,
        "temperature_law": case.problem.lubricant.viscosity.temperature_law,
        "inlet_temperature_k": case.problem.inlet_temperature,
        "domain": case.domain.model_dump(mode="json"),
        "recommended_domain": case.recommended_domain.model_dump(mode="json"),
        "points": list(reversed(case.options.shape)),
        "needed_points": case.needed_points,
        "memory_bytes": case.memory,
        "seconds": case.seconds,
        "time": None if case.time is None else time_as_summary(case.time),
        "questions": list(case.questions),
    }


def as_text(explanation: Explanation) -> str:
    """Return an explanation for people, in lines of plain text."""
    sections = (
        _about_case(explanation),
        _about_groups(explanation),
        _about_film(explanation),
        *([_about_roughness(explanation.roughness)] if explanation.roughness else []),
        _about_heat(explanation),
        _about_numerics(explanation),
        *([time_as_lines(explanation.time)] if explanation.time else []),
        _about_questions(explanation),
    )
    return "\n\n".join("\n".join(section) for section in sections)


def _row(name: str, *values: str) -> str:
    return f"  {name:<22}{'   '.join(value for value in values if value)}"


def _about_case(case: Explanation) -> Iterator[str]:
    problem, hertz = case.problem, case.problem.hertz
    oil = problem.lubricant
    yield problem.title or UNTITLED
    yield _row("load", f"{problem.load:.4g} N")
    yield _row(
        "speeds",
        f"u_m = {problem.entrainment_speed:.4g} m/s",
        f"u_1 = {problem.motion.speed_1:.4g}",
        f"u_2 = {problem.motion.speed_2:.4g}",
        f"SRR = {problem.slide_roll_ratio:g}",
    )
    yield _row(
        "reduced radii", f"R_x = {length(problem.radius_x)}", f"R_y = {length(problem.radius_y)}"
    )
    yield _row(
        "reduced modulus",
        f"E' = {problem.reduced_modulus / 1e9:.4g} GPa",
        "(2/E' = sum of (1-nu^2)/E)",
    )
    yield _row(
        "oil",
        f"{oil.viscosity.law}, {oil.density.law}, {oil.shear.law}",
        f"eta_0 = {problem.ambient_viscosity:.4g} Pa s",
        f"alpha = {problem.pressure_coefficient * 1e9:.4g} 1/GPa",
    )
    yield _row(
        "Hertz contact",
        f"p_h = {hertz.pressure / 1e9:.4g} GPa",
        f"a_x = {length(hertz.half_width_x)}",
        f"a_y = {length(hertz.half_width_y)}",
        f"approach {length(hertz.approach)}",
    )


def _about_groups(case: Explanation) -> Iterator[str]:
    group = case.groups
    yield "Groups (mean speed, R_x)"
    yield _row("Moes", f"M = {group.M:.4g}", f"L = {group.L:.4g}")
    yield _row("Hamrock-Dowson", f"U = {group.U:.4g}", f"W = {group.W:.4g}", f"G = {group.G:.4g}")
    yield _row(
        "Reynolds", f"lambda_bar = {group.lambda_bar:.4g}", f"alpha_bar = {group.alpha_bar:.4g}"
    )
    yield _row("shape", f"a_y/a_x = {group.ellipticity:.4g}", f"R_x/R_y = {group.radius_ratio:.4g}")
    yield _row("regime", case.regime)


def _about_film(case: Explanation) -> Iterator[str]:
    inlet = case.problem.inlet_temperature - 273.15
    with_oil = "" if case.bodies is None else f", with oil of {inlet:.4g} degC as it enters"
    yield f"{'Film by formulas':<28}{'central':<24}minimum{with_oil}"
    for film in case.films:
        central = f"{length(film.central_m)} (H {film.central:.4f})"
        minimum = "-"
        if film.minimum is not None and film.minimum_m is not None:
            minimum = f"{length(film.minimum_m)} (H {film.minimum:.4f})"
        yield f"  {film.formula:<26}{central:<24}{minimum}"
        if film.minimum_remark:
            yield f"      note: {film.minimum_remark}"
        for remark in film.remarks:
            yield f"      outside its range: {remark}"
    if case.bodies is not None:
        yield from _about_bodies(case.bodies)
    if case.lambda_ratio is not None:
        yield _row("lambda ratio", f"{case.lambda_ratio:.3g} (central film over joint Rq)")


def _about_bodies(bodies: BodyEffect) -> Iterator[str]:
    yield f"  {'between these bodies':<26}{length(bodies.central_film)}"
    yield (
        f"      note: with oil of {bodies.temperature - 273.15:.4g} degC, the mean of both bodies, "
        f"{bodies.ratio:.2g} times that of Nijenbanning-Venner-Moes"
    )


def _about_roughness(found: Asperities) -> Iterator[str]:
    if found.stands:
        yield "Roughness (without [transient] it stands still in the contact: quasi-steady)"
    else:
        yield "Roughness (moves with its surfaces)"
    first, second = map(length, found.sq)
    yield _row("Sq", f"surface 1 {first}", f"surface 2 {second}", f"both {length(found.composite)}")
    yield _row("steepest slope", f"{found.steepest:.2g}")
    enough = (found.points_to_converge, found.points_to_answer)
    yield _row(
        "shortest wave",
        f"{length(found.shortest_wave)} along an axis",
        f"{found.points_per_wave:.3g} nodes on it",
        f"({CONVERGES} to converge: {enough[0]}, {ANSWERS} for its ripples: {enough[1]} nodes)",
    )
    for wave in found.waves:
        yield _row("wave", *_about_wave(wave))


def _about_wave(wave: ExpectedWave) -> Iterator[str]:
    yield f"{length(wave.wavelength)} at {math.degrees(wave.angle) + 0.0:.3g} deg"
    giga = 1e-9
    if wave.left_to_inlet:
        yield "the inlet decides what is left of it"
    elif wave.film_ratio is None or wave.pressure is None:
        yield "no theory of what is left: it is for isothermal Newtonian films"
    else:
        yield f"{100 * wave.film_ratio:.3g} % left in the film"
        yield f"pressure +-{wave.pressure * giga:.2g} GPa"
    yield f"({wave.elastic_pressure * giga:.2g} GPa flatten it)"


def _about_heat(case: Explanation) -> Iterator[str]:
    problem, viscosity = case.problem, case.problem.lubricant.viscosity
    thermal = problem.thermal
    yield f"Heat ({'computed' if thermal else 'left out: an isothermal film'})"
    fall = problem.temperature_coefficient
    yield _row(
        "oil at the inlet",
        f"{problem.inlet_temperature - 273.15:.4g} degC",
        viscosity.temperature_law,
        f"-d ln eta/dT = {fall:.3g} 1/K" if fall > 0 else "",
    )
    if thermal:
        across = f"{thermal.nodes} {thermal.scheme} nodes across the film"
        yield _row("model", f"{thermal.reynolds} Reynolds equation", across)
    if case.thermal_loading is not None:
        yield _row("thermal loading", f"eta_0 b u_m^2 / k = {case.thermal_loading:.3g}")
    yield from _about_inlet(case)
    yield from _about_rise(case)
    names = ("not stated" if value is None else f"{value:.3g}" for value in case.peclet)
    numbers = [
        name if source is None else f"{name} ({source} source)"
        for name, source in zip(names, case.sources, strict=True)
    ]
    yield _row("solid Peclet numbers", *numbers)


def _about_inlet(case: Explanation) -> Iterator[str]:
    if case.inlet_factors:
        factors = (f"{one.factor:.3f} {one.formula}" for one in case.inlet_factors)
        yield _row("film by inlet heat", *factors)
    for one in case.inlet_factors:
        for remark in one.remarks:
            yield f"      {one.formula}: {remark}"


def _about_rise(case: Explanation) -> Iterator[str]:
    heat, bodies = case.heat, case.bodies
    if heat is None or not (heat.power > 0 or bodies is not None):
        return
    offsets = (0.0, 0.0) if bodies is None else (bodies.surface_1, bodies.surface_2)
    rises = (heat.mid_film, heat.surface_1 + offsets[0], heat.surface_2 + offsets[1])
    if max(map(abs, rises)) < LEAST_RISE:
        yield _row("expected rise", f"below {LEAST_RISE:g} K: there is hardly any sliding")
        return
    names = ("mid-film", "surface 1", "surface 2")
    shown = (f"{name} {_kelvin(rise)}" for name, rise in zip(names, rises, strict=True))
    over = "" if bodies is None else "over the oil at the inlet, "
    yield _row("expected rise", *shown, f"({over}within a factor of two)")
    if not heat.traction > LEAST_TRACTION:
        return
    how = "assumed" if heat.assumed else "expected"
    yield _row("traction", f"{heat.traction:.2g} {how}", f"{heat.power:.3g} W")


def _kelvin(rise: float) -> str:
    return f"below {LEAST_RISE:g} K" if abs(rise) < LEAST_RISE else f"{rise:.2g} K"


def _about_numerics(case: Explanation) -> Iterator[str]:
    nodes_y, nodes_x = case.options.shape
    how = "stated" if isinstance(case.options.domain, Domain) else "recommended"
    domain, best = case.domain, case.recommended_domain
    yield "Solve"
    yield _row("domain", f"{_edges(domain)} Hertz half-widths, {how}")
    if how == "stated" and domain != best:
        yield _row("recommended", _edges(best))
    yield _row(
        "grid",
        f"{nodes_x} x {nodes_y} nodes",
        f"{case.needed_points} give the central film to about {100 * AIM:.0f} %",
    )
    yield _row(
        "memory, time",
        f"about {case.memory / 1e6:.0f} MB{_more_than_there_is(case.memory)}",
        f"about {case.seconds:.2g} s once loaded",
    )


def _more_than_there_is(memory: float) -> str:
    available = available_memory()
    if available is None or memory <= available:
        return ""
    return f", but {available / 1e6:.0f} MB are available"


def _edges(domain: Domain) -> str:
    (west, east), (south, north) = domain.x, domain.y
    return f"[{west:.4g}, {east:.4g}] x [{south:.4g}, {north:.4g}]"


def _about_questions(case: Explanation) -> Iterator[str]:
    if not case.questions:
        if not any(film.valid for film in case.films):
            yield "No value looks odd, but no film formula was made for this contact."
        else:
            yield "Nothing looks odd."
        return
    yield "Please check"
    for question in case.questions:
        yield f"  ? {question}"


def length(metres: float) -> str:
    """Return a length in the unit in which it reads well."""
    factor, unit = length_unit(metres)
    return f"{metres * factor:.4g} {unit}"


def length_unit(metres: float) -> tuple[float, str]:
    """Return the factor from metres to the unit in which a length reads well, and that unit."""
    return next(
        ((factor, unit) for limit, factor, unit in _LENGTHS if abs(metres) >= limit), (1.0, "m")
    )
