"""Explanation of a case as plain text."""

from collections.abc import Iterator
from math import degrees, isfinite

from tehl.domain import AIM
from tehl.film_formulas import regime
from tehl.inlet_heating import inlet_factors, thermal_loading
from tehl.memory import available_memory
from tehl.options import Domain
from tehl.report.asperities import CONVERGES, RESOLVES, Asperities
from tehl.report.explain import Explanation
from tehl.report.readable import UNTITLED, length, seconds
from tehl.report.transient_plan import TransientPlan
from tehl.roughness import WaveVector
from tehl.wave_theory import LinearTheory

LEAST_RISE, LEAST_TRACTION = 0.1, 1e-4
"""Temperature rise [K] and traction coefficient below which no number is shown."""


def as_text(case: Explanation) -> str:
    """Return an explanation in lines of plain text."""
    sections = (
        _case(case),
        _groups(case),
        _film(case),
        *([_roughness(case.roughness)] if case.roughness else []),
        _heat(case),
        _numerics(case),
        *([_transient(case.time)] if case.time else []),
        _questions(case),
    )
    return "\n\n".join("\n".join(section) for section in sections)


def _row(name: str, *values: str) -> str:
    return f"  {name:<22}{'   '.join(value for value in values if value)}"


def _case(case: Explanation) -> Iterator[str]:
    problem, motion = case.scaled.problem, case.scaled.problem.motion
    hertz, oil = problem.hertz, problem.lubricant
    yield problem.title or UNTITLED
    yield _row("load", f"{problem.load:.4g} N")
    yield _row(
        "speeds",
        f"u_m = {problem.entrainment_speed:.4g} m/s",
        f"u_1 = {motion.speed_1:.4g}",
        f"u_2 = {motion.speed_2:.4g}",
        f"SRR = {problem.slide_roll_ratio:g}",
    )
    radii = (f"R_x = {length(problem.radius_x)}", f"R_y = {length(problem.radius_y)}")
    yield _row("reduced radii", *radii)
    modulus = f"E' = {problem.reduced_modulus / 1e9:.4g} GPa"
    yield _row("reduced modulus", modulus, "(2/E' = sum of (1-nu^2)/E)")
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


def _groups(case: Explanation) -> Iterator[str]:
    group = case.scaled.groups
    yield "Groups (mean speed, R_x)"
    yield _row("Moes", f"M = {group.M:.4g}", f"L = {group.L:.4g}")
    yield _row("Hamrock-Dowson", f"U = {group.U:.4g}", f"W = {group.W:.4g}", f"G = {group.G:.4g}")
    reynolds = (f"lambda_bar = {group.lambda_bar:.4g}", f"alpha_bar = {group.alpha_bar:.4g}")
    yield _row("Reynolds", *reynolds)
    yield _row("shape", f"a_y/a_x = {group.ellipticity:.4g}", f"R_x/R_y = {group.radius_ratio:.4g}")
    yield _row("regime", regime(group))


def _film(case: Explanation) -> Iterator[str]:
    inlet, bodies = case.scaled.problem.inlet_temperature - 273.15, case.bodies
    with_oil = "" if bodies is None else f", with oil of {inlet:.4g} degC at the inlet"
    yield f"{'Film by formulas':<28}{'central':<24}minimum{with_oil}"
    for film in case.films:
        central = f"{length(film.central_m)} (H {film.central:.4f})"
        minimum = "-"
        if film.minimum is not None and film.minimum_m is not None:
            minimum = f"{length(film.minimum_m)} (H {film.minimum:.4f})"
        yield f"  {film.formula:<26}{central:<24}{minimum}"
        if film.minimum_remark:
            yield f"      note: {film.minimum_remark}"
        yield from (f"      outside its range: {remark}" for remark in film.remarks)
    if bodies is not None:
        yield f"  {'between these bodies':<26}{length(bodies.central_film)}"
        yield (
            f"      note: with oil of {bodies.temperature - 273.15:.4g} degC, the mean of both "
            f"bodies, {bodies.ratio:.2g} times that of Nijenbanning-Venner-Moes"
        )
    if case.lambda_ratio is not None:
        yield _row("lambda ratio", f"{case.lambda_ratio:.3g} (central film over joint Rq)")


def _roughness(found: Asperities) -> Iterator[str]:
    stands = "without [transient] it stands still in the contact: quasi-steady"
    yield f"Roughness ({stands if found.stands else 'moves with its surfaces'})"
    first, second = map(length, found.sq)
    yield _row("Sq", f"surface 1 {first}", f"surface 2 {second}", f"both {length(found.composite)}")
    yield _row("steepest slope", f"{found.steepest:.2g}")
    yield _row(
        "shortest wave",
        f"{length(found.shortest_wave)} along an axis",
        f"{found.points_per_wave:.3g} nodes on it",
        f"({CONVERGES} to converge: {found.points_to_converge}, "
        f"{RESOLVES} for its ripples: {found.points_to_answer} nodes)",
    )
    for wave, theory in found.waves:
        yield _row("wave", *_wave(wave, theory))


def _wave(wave: WaveVector, theory: LinearTheory) -> Iterator[str]:
    yield f"{length(wave.wavelength)} at {degrees(wave.angle) + 0.0:.3g} deg"
    if theory.left_to_inlet:
        yield "its amplitude depends on the inlet"
    elif theory.film_ratio is None or theory.pressure is None:
        yield "no theory of its amplitude in the film: it covers isothermal Newtonian films"
    else:
        yield f"{100 * theory.film_ratio:.3g} % left in the film"
        yield f"pressure +-{theory.pressure * 1e-9:.2g} GPa"
    yield f"({theory.elastic_pressure * 1e-9:.2g} GPa flatten it)"


def _heat(case: Explanation) -> Iterator[str]:
    problem, thermal = case.scaled.problem, case.scaled.problem.thermal
    loading, formulas = thermal_loading(problem), inlet_factors(problem)
    fall = problem.temperature_coefficient
    yield f"Heat ({'computed' if thermal else 'not computed: an isothermal film'})"
    yield _row(
        "oil at the inlet",
        f"{problem.inlet_temperature - 273.15:.4g} degC",
        problem.lubricant.viscosity.temperature_law,
        f"-d ln eta/dT = {fall:.3g} 1/K" if fall > 0 else "",
    )
    if thermal:
        across = f"{thermal.nodes} {thermal.scheme} nodes across the film"
        yield _row("model", f"{thermal.reynolds} Reynolds equation", across)
    if loading is not None:
        yield _row("thermal loading", f"eta_0 b u_m^2 / k = {loading:.3g}")
    if formulas:
        yield _row("film by inlet heat", *(f"{one.factor:.3f} {one.formula}" for one in formulas))
    for one in formulas:
        yield from (f"      {one.formula}: {remark}" for remark in one.remarks)
    yield from _rises(case)
    numbers = []
    for value, source in zip(case.peclet, case.sources, strict=True):
        name = "not stated" if value is None else f"{value:.3g}"
        numbers.append(name if source is None else f"{name} ({source} source)")
    yield _row("solid Peclet numbers", *numbers)


def _rises(case: Explanation) -> Iterator[str]:
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
    if heat.traction > LEAST_TRACTION:
        how = "assumed" if heat.assumed else "expected"
        yield _row("traction", f"{heat.traction:.2g} {how}", f"{heat.power:.3g} W")


def _kelvin(rise: float) -> str:
    return f"below {LEAST_RISE:g} K" if abs(rise) < LEAST_RISE else f"{rise:.2g} K"


def _numerics(case: Explanation) -> Iterator[str]:
    nodes_y, nodes_x = case.options.shape
    stated = isinstance(case.options.domain, Domain)
    yield "Solve"
    how = "stated" if stated else "recommended"
    yield _row("domain", f"{_edges(case.domain)} Hertz half-widths, {how}")
    if stated and case.domain != case.recommended_domain:
        yield _row("recommended", _edges(case.recommended_domain))
    enough = f"{case.needed_points} give the central film to about {100 * AIM:.0f} %"
    yield _row("grid", f"{nodes_x} x {nodes_y} nodes", enough)
    available, memory = available_memory(), f"about {case.memory / 1e6:.0f} MB"
    if available is not None and case.memory > available:
        memory += f", but {available / 1e6:.0f} MB are available"
    yield _row("memory, time", memory, f"about {case.seconds:.2g} s once loaded")


def _edges(domain: Domain) -> str:
    (west, east), (south, north) = domain.x, domain.y
    return f"[{west:.4g}, {east:.4g}] x [{south:.4g}, {north:.4g}]"


def _transient(plan: TransientPlan) -> Iterator[str]:
    yield "Time"
    distance = f"the mean of both surfaces moves on by {plan.distance:.3g} half-widths"
    yield _row("duration", f"{seconds(plan.duration)}: {distance}")
    yield _row("steps", f"{plan.steps} of {seconds(plan.step)}")
    yield _row("time of the run", f"about {plan.seconds:.2g} s once loaded")
    for number, waves in enumerate(plan.points_per_wave):
        rough = f"{waves:.3g} points per wave" if isfinite(waves) else "smooth"
        yield _row(
            f"surface {number + 1}",
            f"{plan.speeds[number]:.4g} m/s, {plan.shift[number]:.3g} mesh widths per step, "
            f"{rough}",
        )


def _questions(case: Explanation) -> Iterator[str]:
    if case.questions:
        yield "Please check"
        yield from (f"  - {question}" for question in case.questions)
    elif any(film.valid for film in case.films):
        yield "All values are plausible."
    else:
        yield "All values are plausible, but no film formula covers this contact."
