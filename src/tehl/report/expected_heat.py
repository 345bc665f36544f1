r"""Temperatures and film to expect before the solve, by formulas: within a factor of two.

The film has constant thickness h under the mean pressure, with the shear stress tau at its mean
temperature. Its heat ``q = tau |u_1 - u_2|`` flows into both solids, whose surfaces are heated as
by a moving source of Hertzian shape (Tian and Kennedy [1]_):

.. math:: \Delta T_{max} = \frac{2.32\, q a}{k \sqrt{\pi (1.234 + Pe)}}, \quad
          \Delta T_{mean} = \frac{1.464\, q a}{k \sqrt{\pi (0.874 + Pe)}}, \quad
          Pe = \frac{|u_s| a}{2 \kappa}

The film adds ``q h / (8 k)`` in its middle and ``q h / (12 k)`` on average. Half of the heat flows
to each side, less the flux towards the cooler one.

The oil takes the temperature of the bodies on its way in, so the film between bodies that are not
at inlet temperature is about that of oil at their mean temperature. For a steel ball on a disc
(0.8 GPa, SRR = 0.5, oil of 40 degC) and one body of 0, 60, 100 or 150 degC this deviates by 1 to
12 % from solves on 257 nodes.

References
----------
.. [1] X. Tian and F. E. Kennedy, J. Tribology 116 (1994), 167-174.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

from tehl.contact.problem import ContactProblem
from tehl.estimate.bodies import NotBalancedError, balanced
from tehl.estimate.film_formulas import expected_film
from tehl.estimate.inlet_heating import inlet_heating_factor
from tehl.estimate.scaling import Groups, ScaledProblem
from tehl.estimate.summits import shared_load
from tehl.post.thermal_effect import isothermal_reference

ASSUMED_TRACTION = 0.05
"""Traction coefficient where the viscosity does not depend on temperature."""
NOTICEABLE = 3.0
"""Difference between a body and the oil at the inlet that is reported [K]."""
_PEAK = 1.5  # Hertzian shape: centre over mean


@dataclass(frozen=True, kw_only=True, slots=True)
class BodyEffect:
    """Effect of the temperatures of the bodies on the film."""

    surface_1: float
    surface_2: float
    """Temperatures of the bodies less that of the oil at the inlet [K]."""
    temperature: float
    """Mean temperature of the bodies [K]."""
    central_film: float
    """Central film to expect with oil of that temperature [m]."""
    ratio: float
    """The same over the film with oil of inlet temperature [-]."""
    groups: Groups
    """Dimensionless groups with oil of that temperature."""


def body_effect(scaled: ScaledProblem) -> BodyEffect | None:
    """Return the effect of the bodies on the film; None within 3 K of the inlet temperature."""
    heat = scaled.problem.heat
    if heat is None:
        return None
    first, second = heat.bulk_1 - heat.temperature, heat.bulk_2 - heat.temperature
    if max(abs(first), abs(second)) < NOTICEABLE:
        return None
    temperature = 0.5 * (heat.bulk_1 + heat.bulk_2)
    between = ScaledProblem.of(_at_temperature(scaled.problem, temperature))
    film = expected_film(between)
    return BodyEffect(
        surface_1=first,
        surface_2=second,
        temperature=temperature,
        central_film=film,
        ratio=film / expected_film(scaled),
        groups=between.groups,
    )


def _at_temperature(problem: ContactProblem, temperature: float) -> ContactProblem:
    """Return the isothermal contact with oil of ``temperature`` [K], same load and speed."""
    same = {"load": problem.load, "entrainment_speed": problem.entrainment_speed}
    others = dict.fromkeys(("hertz_pressure", "moes_load", "moes_speed"))
    isothermal = isothermal_reference(problem)
    return isothermal.model_copy(
        update={
            "contact": problem.contact.model_copy(update=same | others),
            "lubricant": isothermal.lubricant.model_copy(update={"temperature": temperature}),
        }
    )


@dataclass(frozen=True, kw_only=True, slots=True)
class ExpectedHeat:
    """Effect of shear heating."""

    traction: float
    """Traction coefficient [-]."""
    assumed: bool
    """Whether it is assumed because the viscosity does not depend on temperature."""
    power: float
    """Shear power of the contact [W]."""
    surface_1: float
    surface_2: float
    """Largest rises of the surfaces over their bulk [K]."""
    heat_1: float
    heat_2: float
    """Heat into both bodies, with that of asperities [W]."""
    mid_film: float
    """Rise of mid-film over the oil at the inlet [K], at the centre of the contact."""

    @property
    def largest(self) -> float:
        """Return the largest of the three rises [K]."""
        return max(self.surface_1, self.surface_2, self.mid_film)


class _HeatPath(NamedTuple):
    """Thermal resistances by flux of both surfaces and of the film (h / k) [K m^2/W], bulk [K]."""

    resistance: tuple[float, float]
    film: float
    bulk: tuple[float, float]

    def surfaces(self, flux: float) -> tuple[float, float]:
        """Return the surface temperatures [K] where the film generates ``flux`` [W/m^2]."""
        (first, second), (bulk_1, bulk_2) = self.resistance, self.bulk
        into_first = self.into_first(flux)
        return bulk_1 + first * into_first, bulk_2 + second * (flux - into_first)

    def into_first(self, flux: float) -> float:
        """Return the part of ``flux`` that flows into surface 1 [W/m^2]."""
        (first, second), (bulk_1, bulk_2) = self.resistance, self.bulk
        into_first = 0.5 * flux * self.film + bulk_2 - bulk_1 + flux * second
        return into_first / (self.film + first + second)

    def mean_temperature(self, flux: float) -> float:
        """Return the mean temperature of the film [K]."""
        return sum(self.surfaces(flux)) / 2.0 + flux * self.film / 12.0


def expected_heat(scaled: ScaledProblem, bodies: BodyEffect | None) -> ExpectedHeat | None:
    """Return the effect of shear heating; None where the solids state too little.

    Parameters
    ----------
    scaled : ScaledProblem
        With the thermal properties of oil and solids.
    bodies : BodyEffect or None
        Film at the temperature of the bodies; None if they are as warm as the oil.
    """
    problem = scaled.problem
    film = expected_film(scaled) if bodies is None else bodies.central_film
    film *= inlet_heating_factor(problem) or 1.0
    mean, largest = _heat_path(problem, film, 1.464, 0.874), _heat_path(problem, film, 2.32, 1.234)
    if mean is None or largest is None:
        return None
    sliding, pressure = problem.sliding_speed, problem.hertz.pressure / _PEAK
    assumed = not problem.temperature_coefficient > 0
    stress = ASSUMED_TRACTION * pressure
    if sliding < 1e-9:  # [m/s], without heat
        stress = 0.0
    elif not assumed:
        stress = _shear_stress(problem, mean, pressure, sliding / film)
    flux = stress * sliding
    first, second = largest.surfaces(flux)
    rubbed, area = _rubbed(scaled), problem.load / pressure
    into = mean.into_first(flux)
    middle = (first + second) / 2.0 + _PEAK * flux * largest.film / 8.0
    return ExpectedHeat(
        traction=stress / pressure,
        assumed=assumed,
        power=stress / pressure * problem.load * sliding,
        surface_1=first - largest.bulk[0],
        surface_2=second - largest.bulk[1],
        heat_1=into * area + rubbed[0],
        heat_2=(flux - into) * area + rubbed[1],
        mid_film=middle - problem.inlet_temperature,
    )


def expected_bodies(problem: ContactProblem) -> ContactProblem | None:
    """Return the contact between bodies as warm as to expect; None if they have no balance.

    Temperatures that are stated stay.
    """
    if not problem.computes_bodies:
        return problem

    def heats(first: float, second: float) -> tuple[float, float] | None:
        scaled = ScaledProblem.of(problem.with_bodies(first, second))
        found = expected_heat(scaled, body_effect(scaled))
        return None if found is None else (found.heat_1, found.heat_2)

    try:
        return problem.with_bodies(*balanced(problem, heats))
    except NotBalancedError:
        return None


def _rubbed(scaled: ScaledProblem) -> tuple[float, float]:
    """Return the heat of asperities into both bodies [W]."""
    problem, law = scaled.problem, scaled.problem.asperities
    if law is None:
        return 0.0, 0.0
    force = law.friction * shared_load(scaled).share * problem.load
    parts = problem.rubbing_parts
    power = force * problem.sliding_speed
    return parts[0] * power, parts[1] * power


def _heat_path(
    problem: ContactProblem, film: float, factor: float, offset: float
) -> _HeatPath | None:
    """Return the resistances with Tian and Kennedy's ``factor`` and ``offset`` of Pe."""
    width, heat, inlet = problem.hertz.half_width_x, problem.heat, problem.inlet_temperature
    resistance = []
    for surface, peclet in zip(problem.surfaces, problem.solid_peclet, strict=True):
        conductivity = surface.material.conductivity
        if peclet is None or not conductivity:
            return None
        root = math.sqrt(math.pi * (offset + abs(peclet)))
        resistance.append(factor * width / (conductivity * root))
    return _HeatPath(
        resistance=(resistance[0], resistance[1]),
        film=film / (problem.lubricant.ambient_conductivity or 0.14),  # of a usual oil [W/m/K]
        bulk=(inlet, inlet) if heat is None else (heat.bulk_1, heat.bulk_2),
    )


def _shear_stress(problem: ContactProblem, path: _HeatPath, pressure: float, rate: float) -> float:
    """Return the stress [Pa] that agrees with the temperature it causes, by bisection."""
    oil, sliding = problem.lubricant, problem.sliding_speed

    def remaining(stress: float) -> float:
        temperature = path.mean_temperature(stress * sliding)
        return oil.shear.thinned(oil.viscosity.viscosity(pressure, temperature) * rate, pressure)

    low, high = 0.0, min(remaining(0.0), pressure)
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if remaining(middle) > middle else (low, middle)
    return high
