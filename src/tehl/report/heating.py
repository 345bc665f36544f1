r"""How warm a film will become, by formulas: an estimate within a factor of two.

The film is one of constant thickness h under the mean pressure, with the shear stress tau of its
mean temperature. Its heat ``q = tau |u_1 - u_2|`` flows into both solids, which are warmed as by a
moving source of Hertzian shape (Tian and Kennedy [1]_):

.. math:: \Delta T_{max} = \frac{2.32\, q a}{k \sqrt{\pi (1.234 + Pe)}}, \quad
          \Delta T_{mean} = \frac{1.464\, q a}{k \sqrt{\pi (0.874 + Pe)}}, \quad
          Pe = \frac{|u_s| a}{2 \kappa}

The film adds ``q h / (8 k)`` in its middle and ``q h / (12 k)`` on average, and parts the heat:
half to each side, less what flows to the cooler one.

References
----------
.. [1] X. Tian and F. E. Kennedy, J. Tribology 116 (1994), 167-174.
"""

import math
from dataclasses import dataclass

from tehl.film_formulas import expected_central_film, inlet_heating_factor
from tehl.heat import FilmEnergy
from tehl.problem import ContactProblem
from tehl.report.bodies import body_effect
from tehl.scaling import groups, scales

ASSUMED_TRACTION = 0.05
"""Traction coefficient of an oil whose case tells too little to estimate one."""
USUAL_CONDUCTIVITY = 0.14
"""Of an oil whose case states none [W/m/K]."""
LEAST_SLIDING = 1e-9
"""Sliding speed below which there is no heat [m/s]."""
_PEAK = 1.5  # Hertzian shape: centre over mean
_HALVINGS = 60


@dataclass(frozen=True, kw_only=True, slots=True)
class ExpectedHeat:
    """What the shear of the film will do.

    Attributes
    ----------
    traction : float
        Traction coefficient [-].
    assumed : bool
        Whether it was assumed, for want of a viscosity that knows temperature.
    power : float
        Shear power of the contact [W].
    surface_1, surface_2 : float
        Largest rises of the surfaces over their bulk [K].
    mid_film : float
        Rise of the middle of the film over the oil at the inlet [K], at the centre of the contact.
    """

    traction: float
    assumed: bool
    power: float
    surface_1: float
    surface_2: float
    mid_film: float

    @property
    def largest(self) -> float:
        """Return the largest of the three rises [K]."""
        return max(self.surface_1, self.surface_2, self.mid_film)


@dataclass(frozen=True, kw_only=True, slots=True)
class _Path:
    """The way of the heat: what a flux of 1 W/m^2 does.

    Attributes
    ----------
    resistance : tuple of float
        Rise of either surface by the flux into it [K m^2/W].
    film : float
        h / k of the film [K m^2/W].
    bulk : tuple of float
        Temperatures of the solids [K].
    """

    resistance: tuple[float, float]
    film: float
    bulk: tuple[float, float]

    def surfaces(self, flux: float) -> tuple[float, float]:
        """Return the temperatures [K] of the surfaces of a film that makes ``flux`` [W/m^2]."""
        (first, second), (bulk_1, bulk_2) = self.resistance, self.bulk
        into_first = 0.5 * flux * self.film + bulk_2 - bulk_1 + flux * second
        into_first /= self.film + first + second
        return bulk_1 + first * into_first, bulk_2 + second * (flux - into_first)

    def mean_temperature(self, flux: float) -> float:
        """Return the mean temperature of the film [K]."""
        return sum(self.surfaces(flux)) / 2.0 + flux * self.film / 12.0


def expected_heat(problem: ContactProblem) -> ExpectedHeat | None:
    """Return what the shear of the film will do; None where the solids state too little."""
    mean, largest = _path(problem, 1.464, 0.874), _path(problem, 2.32, 1.234)
    if mean is None or largest is None:
        return None
    hertz, sliding = problem.hertz, abs(problem.motion.sliding_speed)
    assumed = not problem.temperature_coefficient > 0
    pressure = hertz.pressure / _PEAK
    stress = _stress(problem, mean, pressure, assumed=assumed)
    flux = stress * sliding
    first, second = largest.surfaces(flux)
    middle = (first + second) / 2.0 + _PEAK * flux * largest.film / 8.0
    return ExpectedHeat(
        traction=stress / pressure,
        assumed=assumed,
        power=stress / pressure * problem.load * sliding,
        surface_1=first - largest.bulk[0],
        surface_2=second - largest.bulk[1],
        mid_film=middle - problem.inlet_temperature,
    )


def _film(problem: ContactProblem) -> float:
    """Return the central film to expect [m], as bodies and the heat of the inlet leave it."""
    effect = body_effect(problem)
    isothermal = expected_central_film(groups(problem)) * scales(problem).film_thickness
    if effect is not None:
        isothermal = effect.central_film
    return isothermal * (inlet_heating_factor(problem) or 1.0)


def _path(problem: ContactProblem, factor: float, offset: float) -> _Path | None:
    width, (peclet_1, peclet_2) = problem.hertz.half_width_x, problem.solid_peclet
    solid_1, solid_2 = problem.surface_1.material, problem.surface_2.material
    if peclet_1 is None or peclet_2 is None or not solid_1.conductivity or not solid_2.conductivity:
        return None
    first = factor * width / (solid_1.conductivity * math.sqrt(math.pi * (offset + abs(peclet_1))))
    second = factor * width / (solid_2.conductivity * math.sqrt(math.pi * (offset + abs(peclet_2))))
    heat, inlet = problem.heat, problem.inlet_temperature
    conductivity = problem.lubricant.ambient_conductivity or USUAL_CONDUCTIVITY
    return _Path(
        resistance=(first, second),
        film=_film(problem) / conductivity,
        bulk=(heat.bulk_1, heat.bulk_2) if isinstance(heat, FilmEnergy) else (inlet, inlet),
    )


def _stress(problem: ContactProblem, path: _Path, pressure: float, *, assumed: bool) -> float:
    """Return the shear stress [Pa] that the temperature made by it leaves, by bisection."""
    oil, sliding = problem.lubricant, abs(problem.motion.sliding_speed)
    if sliding < LEAST_SLIDING:
        return 0.0
    if assumed:
        return ASSUMED_TRACTION * pressure
    rate = sliding / _film(problem)

    def left(stress: float) -> float:
        temperature = path.mean_temperature(stress * sliding)
        return oil.shear.thinned(oil.viscosity.viscosity_at(pressure, temperature) * rate, pressure)

    low, high = 0.0, min(left(0.0), pressure)
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if left(middle) > middle else (low, middle)
    return high
