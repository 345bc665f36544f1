"""Bodies that are not as warm as the oil: what they do to the film, by formulas.

The oil takes the temperature of the walls on its way in, so the film is about that of oil at the
mean temperature of both bodies. For a steel ball on a disc (0.8 GPa, SRR = 0.5, oil of 40 degC) and
one body of 0, 60, 100 or 150 degC this is 1 to 12 % off solves on 257 nodes.
"""

from dataclasses import dataclass

from tehl.film_formulas import expected_central_film
from tehl.heat import FilmEnergy
from tehl.post.thermal_effect import isothermal_twin
from tehl.problem import ContactProblem
from tehl.scaling import Groups, groups, scales

NOTICED = 3.0
"""Kelvin between a body and the oil at the inlet that are worth a word."""


@dataclass(frozen=True, kw_only=True, slots=True)
class BodyEffect:
    """What the temperatures of the bodies do to the film.

    Attributes
    ----------
    surface_1, surface_2 : float
        Temperatures of the bodies less that of the oil at the inlet [K].
    temperature : float
        Mean temperature of the bodies [K].
    central_film : float
        Central film to expect with oil of that temperature [m].
    ratio : float
        The same over the film with oil as it enters [-].
    groups : Groups
        Dimensionless groups with oil of that temperature.
    """

    surface_1: float
    surface_2: float
    temperature: float
    central_film: float
    ratio: float
    groups: Groups


def body_effect(problem: ContactProblem) -> BodyEffect | None:
    """Return what the bodies do to the film; None where they are as warm as the oil, nearly."""
    heat = problem.heat
    if not isinstance(heat, FilmEnergy):
        return None
    first, second = heat.bulk_1 - heat.temperature, heat.bulk_2 - heat.temperature
    if max(abs(first), abs(second)) < NOTICED:
        return None
    temperature = 0.5 * (heat.bulk_1 + heat.bulk_2)
    between, before = at_temperature(problem, temperature), groups(problem)
    film = _central_film(between)
    return BodyEffect(
        surface_1=first,
        surface_2=second,
        temperature=temperature,
        central_film=film,
        ratio=film / (expected_central_film(before) * scales(problem).film_thickness),
        groups=groups(between),
    )


def _central_film(problem: ContactProblem) -> float:
    return expected_central_film(groups(problem)) * scales(problem).film_thickness


def at_temperature(problem: ContactProblem, temperature: float) -> ContactProblem:
    """Return the isothermal contact with oil of ``temperature`` [K], under the same load and speed.

    Parameters
    ----------
    problem : ContactProblem
        Of a thermal run.
    temperature : float
        Of the oil [K].
    """
    same = {"load": problem.load, "entrainment_speed": problem.entrainment_speed}
    others = dict.fromkeys(("hertz_pressure", "moes_load", "moes_speed"))
    twin = isothermal_twin(problem)
    return twin.model_copy(
        update={
            "contact": problem.contact.model_copy(update=same | others),
            "lubricant": twin.lubricant.model_copy(update={"temperature": temperature}),
        }
    )
