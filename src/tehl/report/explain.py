"""Explain a case before the solve, by formulas alone."""

import math
from dataclasses import asdict, dataclass
from html import escape
from typing import TYPE_CHECKING, Any

from tehl.base.errors import InputError
from tehl.base.lazy import lazy
from tehl.contact.heat import source_form
from tehl.contact.options import Domain, Options
from tehl.contact.problem import HOTTEST_TEMPERATURE, ContactProblem
from tehl.estimate.cpu_time import expected_seconds, seconds_range
from tehl.estimate.domain import domain_of, proposed_domain
from tehl.estimate.film_formulas import (
    FilmEstimate,
    Lubrication,
    film_estimates,
    likely_film,
    lubrication,
    lubrication_by_share,
    regime,
)
from tehl.estimate.grid import Grid
from tehl.estimate.inlet_heating import inlet_factors, inlet_heating_factor
from tehl.estimate.memory import available_memory, needed_memory
from tehl.estimate.nodes import planned
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.settled import settled
from tehl.estimate.starvation import check_supply, starved_degree, supply_ratio
from tehl.estimate.summits import SharedLoad, shared_load
from tehl.lubricant.pressure import UNCERTAINTY
from tehl.operators.heights import check_ends, units_of
from tehl.report.expected_heat import (
    BodyEffect,
    ExpectedHeat,
    body_effect,
    expected_bodies,
    expected_heat,
)
from tehl.report.plausibility import questions
from tehl.report.readable import UNTITLED
from tehl.report.rendering import render
from tehl.report.roughness import CONVERGES, RESOLVES, Asperities, asperities
from tehl.report.transient_plan import BYTES_IN_STEP, TransientPlan, transient_plan

if TYPE_CHECKING:
    from tehl.estimate import stiffness
else:
    stiffness = lazy("tehl.estimate.stiffness")

NO_BALANCE = (
    "thermal_resistance or cooling of a surface: by formulas the heat of the contact warms a body "
    f"beyond {HOTTEST_TEMPERATURE:g} K; check their units"
)
FILMS = 6
"""Films that are solved until the heat of the bodies is balanced: 5 to 10."""


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class Explanation:
    """What formulas say about a case; shown as ``tehl explain`` prints it."""

    scaled: ScaledProblem
    """The contact with its groups and scales."""
    asked: Options
    """Its numerics as the case states them."""
    expected: Options
    """The same with the number of nodes on which the error to reach is expected."""
    roughness: Asperities | None
    """Heights of the surfaces in this contact; None where both are smooth."""
    bodies: BodyEffect | None
    """Effect of bodies that are not at the temperature of the oil; None if they are."""
    heat: ExpectedHeat | None
    """Temperature rises to expect; None where the solids state too little."""
    resistances: tuple[float | None, float | None]
    """Thermal resistances of the bodies whose temperature is computed [K/W]."""
    seconds: float
    """Estimated time of a solve [s]."""
    time: TransientPlan | None
    """Plan of a transient run; None for a steady case."""
    questions: tuple[str, ...]
    """Values that are not plausible."""

    def __repr__(self) -> str:
        """Return the text of ``tehl explain``."""
        return as_text(self)

    def _repr_html_(self) -> str:
        """Return the same for notebooks."""
        return f'<pre style="font-family: monospace">{escape(as_text(self))}</pre>'

    @property
    def options(self) -> Options:
        """Numerics of the solve, with the nodes to expect if an error is to be reached."""
        return self.expected if self.follows else settled(self.scaled.problem, self.asked)

    @property
    def follows(self) -> bool:
        """Whether the number of nodes follows from the error to reach."""
        return self.asked.points == "auto"

    @property
    def central_film(self) -> float:
        """Central film to expect [m], by the first formula in its range."""
        return likely_film(self.scaled).central_m

    @property
    def formula(self) -> str:
        """The authors of that formula."""
        return likely_film(self.scaled).formula

    @property
    def films(self) -> tuple[FilmEstimate, ...]:
        """The film by each formula."""
        return film_estimates(self.scaled.groups, self.scaled.scales)

    @property
    def composite(self) -> float:
        """Sq of both surfaces together [m]; zero when no roughness is stated."""
        problem, heights = self.scaled.problem, self.roughness
        return heights.composite if heights else problem.asperity_rms or problem.rms_roughness

    @property
    def peclet(self) -> tuple[float | None, ...]:
        """``|u_s| a_x / (2 diffusivity)`` of both solids [-]; None where a property is missing."""
        return tuple(None if one is None else abs(one) for one in self.scaled.problem.solid_peclet)

    @property
    def sources(self) -> tuple[str | None, ...]:
        """Moving source of either surface in a thermal run; None where a property is missing."""
        problem = self.scaled.problem
        stated = "auto" if problem.heat is None else problem.heat.sources
        return tuple(
            None if one is None else source_form(stated, one) for one in problem.solid_peclet
        )

    @property
    def domain(self) -> Domain:
        """The domain of the solve, stated or recommended."""
        return domain_of(self.scaled, self.options)

    @property
    def recommended_domain(self) -> Domain:
        """The domain recommended for the load."""
        return proposed_domain(self.scaled, self.asked)

    @property
    def expected_shape(self) -> tuple[int, int]:
        """Nodes (ny, nx) on which the error to reach is expected."""
        return self.expected.shape

    @property
    def expected_error(self) -> float:
        """The error to reach [-]."""
        return self.expected.target

    @property
    def memory(self) -> float:
        """Estimated peak memory of a solve [byte]."""
        kept = BYTES_IN_STEP * self.options.shape[1] * self.time.steps if self.time else 0.0
        return needed_memory(self.options, self.scaled.problem) + kept

    @property
    def seconds_range(self) -> tuple[float, float]:
        """Least and largest time of the solve to expect [s]."""
        return seconds_range(self.scaled, self.seconds)

    @property
    def stiffness(self) -> "stiffness.FilmStiffness | None":
        """Stiffness and damping at rest by the table, if they are asked for and it has them."""
        if self.scaled.problem.dynamics is None:
            return None
        try:
            return stiffness.film_stiffness(self.scaled.problem, [0.0])
        except InputError:
            return None

    @property
    def supply_ratio(self) -> float:
        """Oil that enters over that of the flooded contact, infinite if flooded [-]."""
        return supply_ratio(self.scaled)

    @property
    def starved_part(self) -> float:
        """Central film over that of the flooded contact, by the table or the film law [-]."""
        return self._starved[0]

    @property
    def starved_error(self) -> float | None:
        """Error bar of ``starved_part`` by the table [-]; None by the film law."""
        return self._starved[1]

    @property
    def _starved(self) -> tuple[float, float | None]:
        return starved_degree(self.scaled.groups, self.supply_ratio)

    @property
    def starved_film(self) -> float:
        """Central film with the oil that is supplied, by formula and film law [m]."""
        return self.starved_part * self.central_film

    @property
    def shared(self) -> SharedLoad | None:
        """How film and asperities share the load by formula; None without asperities."""
        return shared_load(self.scaled) if self.scaled.problem.asperities else None

    @property
    def lambda_central(self) -> float | None:
        """Central film over ``composite`` [-]; None without roughness."""
        return self.starved_film / self.composite if self.composite > 0 else None

    @property
    def lambda_minimum(self) -> float | None:
        """Minimum film, by a formula in its range if there is one, over ``composite`` [-]."""
        films = sorted(self.films, key=lambda film: not film.valid)
        minimum = next(film.minimum_m for film in films if film.minimum_m is not None)
        return self.starved_part * minimum / self.composite if self.composite > 0 else None

    @property
    def share(self) -> float | None:
        """Part of the load on asperities by formula [-]; None where they are not computed."""
        return self.shared.share if self.shared else None

    @property
    def lubrication(self) -> Lubrication | None:
        """Boundary, mixed or full film, by ``share`` or else ``lambda_central``; None if smooth."""
        if self.share is not None:
            return lubrication_by_share(self.share)
        return None if self.lambda_central is None else lubrication(self.lambda_central)


def explain(problem: ContactProblem, options: Options | None = None) -> Explanation:
    """Return what formulas say about a case, without solving it.

    Parameters
    ----------
    problem : ContactProblem
        Steady or transient.
    options : Options or None
        With ``points = "auto"`` those expected to reach the error; None is the defaults.
    """
    asked = options or Options()
    warm = expected_bodies(problem)
    scaled = ScaledProblem.of(warm or problem)
    expected = planned(scaled, asked.model_copy(update={"points": "auto"}))
    options = expected if asked.points == "auto" else settled(problem, asked)
    domain, (ny, nx) = domain_of(scaled, options), options.shape
    check_supply(scaled, domain)
    grid = Grid(nx=nx, ny=ny, domain=domain, mirror=False)
    check_ends(scaled, grid)
    along, across = units_of(grid, scaled.scales)
    mesh = (grid.dx * along, grid.dy * across)
    heights = asperities(problem, options, mesh, likely_film(scaled).central_m)
    plan = transient_plan(scaled, options, mesh, halves=asked.points == "auto")
    bodies = body_effect(scaled)
    heat = expected_heat(scaled, bodies)
    return Explanation(
        scaled=scaled,
        asked=asked,
        expected=expected,
        roughness=heights,
        bodies=bodies,
        heat=heat,
        resistances=problem.resistances,
        seconds=expected_seconds(scaled, asked) * (FILMS if problem.computes_bodies else 1),
        time=plan,
        questions=questions(
            scaled, asked, heat, None if problem.computes_bodies else bodies, heights
        )
        + (plan.questions if plan else ())
        + (() if warm else (NO_BALANCE,)),
    )


def as_text(case: Explanation) -> str:
    """Return an explanation in lines of plain text."""
    problem = case.scaled.problem
    return render(
        "explain.txt",
        case=case,
        angle=math.degrees(problem.contact.entrainment_angle),
        axes=problem.radii_of_axes,
        available=available_memory(),
        converges=CONVERGES,
        inlet_factors=inlet_factors(problem),
        least_rise=0.1,  # [K], below which no number is shown
        least_traction=1e-4,
        loading=problem.thermal_loading,
        regime=regime(case.scaled.groups),
        resolves=RESOLVES,
        uncertainty=UNCERTAINTY,
        stated=isinstance(case.options.domain, Domain),
        untitled=UNTITLED,
    ).rstrip()


def as_summary(case: Explanation) -> dict[str, Any]:
    """Return an explanation as one JSON object."""
    problem, roughness = case.scaled.problem, case.roughness
    bodies, heat, plan = (one and asdict(one) for one in (case.bodies, case.heat, case.time))
    if plan:
        del plan["questions"]
    return {
        **_contact_as_summary(case),
        "regime": regime(case.scaled.groups),
        "central_film_m": case.central_film,
        "central_film_formula": case.formula,
        "supply": None
        if problem.supply is None
        else {
            "ratio": case.supply_ratio,
            "degree": case.starved_part,
            "degree_error": case.starved_error,
            "film_m": case.starved_film,
        },
        "load_sharing": asdict(case.shared) if case.shared else None,
        "films": [asdict(film) | {"valid": film.valid} for film in case.films],
        "lambda_central": case.lambda_central,
        "lambda_minimum": case.lambda_minimum,
        "lubrication": case.lubrication,
        "roughness": None if roughness is None else roughness.summary(),
        "solid_peclet": list(case.peclet),
        "inlet_heating_factor": inlet_heating_factor(problem),
        "inlet_factors": [asdict(factor) for factor in inlet_factors(problem)],
        "thermal_loading": problem.thermal_loading,
        "bodies": bodies,
        "thermal_resistances": list(case.resistances),
        "expected_heat": heat,
        "sources": list(case.sources),
        "thermal": problem.thermal is not None,
        "pressure_coefficient_1_pa": problem.pressure_coefficient,
        "pressure_coefficient_estimated": problem.lubricant.viscosity.is_estimated,
        "temperature_law": problem.lubricant.viscosity.temperature_law,
        "inlet_temperature_k": problem.inlet_temperature,
        "domain": case.domain.model_dump(mode="json"),
        "recommended_domain": case.recommended_domain.model_dump(mode="json"),
        "points": list(reversed(case.options.shape)),
        "expected_points": case.expected_shape[1],
        "memory_bytes": case.memory,
        "seconds": case.seconds,
        "seconds_range": list(case.seconds_range),
        "time": plan,
        "questions": list(case.questions),
    }


def _contact_as_summary(case: Explanation) -> dict[str, Any]:
    problem, hertz = case.scaled.problem, case.scaled.problem.hertz
    profile, roller = problem.contact.profile, case.scaled.groups.roller
    groups = {"hertz_pressure_pa": hertz.pressure, "hertz_half_width_m": hertz.half_width_x}
    return {
        "title": problem.title,
        "groups": _finite(asdict(case.scaled.groups)) | groups,
        "hertz": _finite(asdict(hertz)),
        "load_n_per_m" if problem.contact.is_line else "load_n": problem.load,
        "entrainment_speed_m_s": problem.entrainment_speed,
        "reduced_modulus_pa": problem.reduced_modulus,
        "radius_x_m": problem.radius_x,
        "radius_y_m": None if problem.contact.has_lines else problem.radius_y,
        "profile": None
        if profile is None or roller is None
        else {
            "shape": profile.shape,
            "drop_at_ends_m": roller.drops,
            "largest_slice_over_hertz": roller.widest,
            "loaded_part": roller.loaded_part,
        },
    }


def _finite(numbers: dict[str, Any]) -> dict[str, float | None]:
    """Return numbers, None for those that a line contact does not have."""
    return {
        name: one if math.isfinite(one) else None
        for name, one in numbers.items()
        if isinstance(one, float)
    }
