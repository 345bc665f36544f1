"""Explain a case before the solve, by formulas alone."""

from dataclasses import asdict, dataclass
from math import isfinite
from typing import Any

from tehl.domain import needed_points, recommended_domain
from tehl.film_formulas import (
    FilmEstimate,
    Regime,
    expected_film,
    film_estimates,
    regime,
)
from tehl.heat import FilmEnergy, source_form
from tehl.inlet_heating import InletFactor, inlet_factors, inlet_heating_factor, thermal_loading
from tehl.memory import needed_memory
from tehl.options import Domain, Options, coarsenable
from tehl.problem import ContactProblem
from tehl.report.asperities import Asperities, asperities, odd_asperities
from tehl.report.expected_heat import BodyEffect, ExpectedHeat, body_effect, expected_heat
from tehl.report.plausibility import questions
from tehl.report.transient_plan import TransientPlan, transient_plan
from tehl.scaling import Groups, ScaledProblem, Scales

SECONDS_PER_NODE = 1.5e-6
SECONDS_COUPLED = 6e-6
"""CPU time of a solve per node of the finest full grid on one core of a usual machine; a guide."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Explanation:
    """What formulas say about a case.

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
        Heights of the surfaces in this contact; None where both are smooth.
    peclet : tuple of (float or None)
        ``|u_s| a_x / (2 diffusivity)`` of both solids [-]; None where a property is not stated.
    inlet_heating : float or None
        Factor by which inlet shear heating thins the film, after Wilson and Sheu [-].
    inlet_factors : tuple of InletFactor
        The same by each formula.
    thermal_loading : float or None
        eta_0 b u_m^2 / k [-]; None where a property is not stated.
    bodies : BodyEffect or None
        Effect of bodies that are not at the temperature of the oil; None if they are.
    heat : ExpectedHeat or None
        Temperature rises to expect; None where the solids state too little.
    sources : tuple of ({"line", "full"} or None)
        Moving source of either surface in a thermal run; None where a property is missing.
    domain : Domain
        The domain of the solve: the one stated, else the recommended one.
    recommended_domain : Domain
        From the load.
    needed_points : int
        Nodes per direction that give the central film to about three percent.
    memory, seconds : float
        Estimated peak memory [byte] and time [s] of a solve.
    time : TransientPlan or None
        Plan of a transient run; None for a steady case.
    questions : tuple of str
        Values that are not plausible.
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
    time: TransientPlan | None
    questions: tuple[str, ...]


def explain(problem: ContactProblem, options: Options) -> Explanation:
    """Return what formulas say about a case, without solving it."""
    scaled = ScaledProblem.of(problem)
    groups, film, wanted = scaled.groups, expected_film(scaled), recommended_domain(scaled.groups)
    domain = options.domain if isinstance(options.domain, Domain) else wanted
    heights = asperities(problem, options, domain, film)
    rough = problem.rms_roughness if heights is None else heights.composite
    bodies, plan = body_effect(scaled), transient_plan(scaled, options, domain)
    heat = expected_heat(scaled, bodies)
    thinnest = bodies.groups if bodies is not None and bodies.ratio < 1 else groups
    seconds_per_node = SECONDS_COUPLED if problem.is_coupled else SECONDS_PER_NODE
    suspects = questions(scaled, options, heat, bodies)
    suspects += tuple(odd_asperities(heights, problem, options, film))
    return Explanation(
        problem=problem,
        options=options,
        groups=groups,
        scales=scaled.scales,
        central_film=film,
        lambda_ratio=film / rough if rough > 0 else None,
        roughness=heights,
        bodies=bodies,
        heat=heat,
        domain=domain,
        recommended_domain=wanted,
        needed_points=coarsenable(needed_points(thinnest) - 2)[1],
        memory=needed_memory(options, problem),
        seconds=seconds_per_node * (options.shape[0] * options.shape[1]),
        time=plan,
        questions=suspects + (plan.questions if plan else ()),
        **_by_formulas(scaled),
    )


def _by_formulas(scaled: ScaledProblem) -> dict[str, Any]:
    """Return the fields of an explanation that follow from published formulas alone."""
    problem = scaled.problem
    first, second = problem.solid_peclet
    return {
        "regime": regime(scaled.groups),
        "films": film_estimates(scaled.groups, scaled.scales),
        "peclet": tuple(None if one is None else abs(one) for one in (first, second)),
        "inlet_heating": inlet_heating_factor(problem),
        "inlet_factors": inlet_factors(problem),
        "thermal_loading": thermal_loading(problem),
        "sources": (_source(problem, first), _source(problem, second)),
    }


def _source(problem: ContactProblem, peclet: float | None) -> str | None:
    heat = problem.heat
    stated = heat.sources if isinstance(heat, FilmEnergy) else "auto"
    return None if peclet is None else source_form(stated, peclet)


def as_summary(case: Explanation) -> dict[str, Any]:
    """Return an explanation as one JSON object."""
    problem, roughness = case.problem, case.roughness
    bodies, heat = (None if one is None else asdict(one) for one in (case.bodies, case.heat))
    return {
        **_contact_as_summary(case),
        "regime": case.regime,
        "central_film_m": case.central_film,
        "films": [asdict(film) | {"valid": film.valid} for film in case.films],
        "lambda_ratio": case.lambda_ratio,
        "roughness": None if roughness is None else roughness.summary(),
        "solid_peclet": list(case.peclet),
        "inlet_heating_factor": case.inlet_heating,
        "inlet_factors": [asdict(factor) for factor in case.inlet_factors],
        "thermal_loading": case.thermal_loading,
        "bodies": bodies,
        "expected_heat": heat,
        "sources": list(case.sources),
        "thermal": problem.thermal is not None,
        "temperature_law": problem.lubricant.viscosity.temperature_law,
        "inlet_temperature_k": problem.inlet_temperature,
        "domain": case.domain.model_dump(mode="json"),
        "recommended_domain": case.recommended_domain.model_dump(mode="json"),
        "points": list(reversed(case.options.shape)),
        "needed_points": case.needed_points,
        "memory_bytes": case.memory,
        "seconds": case.seconds,
        "time": None if case.time is None else _plan_as_summary(case.time),
        "questions": list(case.questions),
    }


def _contact_as_summary(case: Explanation) -> dict[str, Any]:
    problem, hertz = case.problem, case.problem.hertz
    groups = {"hertz_pressure_pa": hertz.pressure, "hertz_half_width_m": hertz.half_width_x}
    return {
        "title": problem.title,
        "groups": asdict(case.groups) | groups,
        "hertz": asdict(hertz),
        "load_n": problem.load,
        "entrainment_speed_m_s": problem.entrainment_speed,
        "reduced_modulus_pa": problem.reduced_modulus,
        "radius_x_m": problem.radius_x,
        "radius_y_m": problem.radius_y,
    }


def _plan_as_summary(plan: TransientPlan) -> dict[str, Any]:
    return {
        "duration_s": plan.duration,
        "step_s": plan.step,
        "steps": plan.steps,
        "seconds": plan.seconds,
        "distance": plan.distance,
        "speeds_m_s": list(plan.speeds),
        "points_per_wave": [one if isfinite(one) else None for one in plan.points_per_wave],
        "shift_per_step": list(plan.shift),
    }
