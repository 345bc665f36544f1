"""Questions about a case: values that are possible, but seldom meant."""

import math
from collections.abc import Iterator

from tehl.domain import (
    AIM,
    NEARLY_RIGID,
    domain_error,
    grid_error,
    needed_points,
    recommended_domain,
)
from tehl.heat import FAR_BODY, LAYERS, Thermal
from tehl.options import Domain, Options, coarsenable
from tehl.problem import ContactProblem
from tehl.report.bodies import NOTICED, body_effect
from tehl.report.heating import ExpectedHeat
from tehl.report.usual import ROUNDING, usual
from tehl.scaling import Groups

SLIDING = 0.02
"""Slide-roll ratio from which on surfaces count as sliding."""
WARM = 5.0
"""Temperature rise from which on an isothermal film is questioned [K]."""
UNPHYSICAL = 0.8e9
"""Hertz pressure from which on a sliding Newtonian film is questioned [Pa]."""
FEW_LAYERS = 15
"""Uniform layers below which a temperature profile is not resolved."""
SLOWEST_LINE = 5.0
"""Solid Peclet number below which a line source is off by more than four per cent."""


def questions(
    problem: ContactProblem,
    options: Options,
    groups: Groups,
    central_film: float,
    *,
    heat: ExpectedHeat | None = None,
) -> tuple[str, ...]:
    """Return what a careful reader would ask about a case, a sentence each.

    Parameters
    ----------
    problem, options : ContactProblem, Options
        The case.
    groups : Groups
        Its dimensionless groups.
    central_film : float
        Central film to expect [m].
    heat : ExpectedHeat or None
        Temperature rises to expect.
    """
    effect = body_effect(problem)
    thinner = effect.groups if effect is not None and effect.ratio < 1 else None
    unusual = (one.question() for one in usual(problem, groups))
    return (
        *(question for question in unusual if question),
        *_of_film(problem, central_film),
        *_of_sliding(problem),
        *_of_heat(problem, heat),
        *_of_numerics(options, groups, thinner),
    )


def _of_film(problem: ContactProblem, central_film: float) -> Iterator[str]:
    if central_film < 5e-9:
        yield (
            f"the film will be about {central_film * 1e9:.2g} nm, a few molecules: the oil is no "
            "continuum there, is speed or viscosity too small?"
        )
    if problem.rms_roughness > 0 and central_film / problem.rms_roughness < 3:
        yield (
            f"the film is {central_film / problem.rms_roughness:.2g} times the roughness: below 3 "
            "asperities touch, which a smooth calculation does not show"
        )


def _of_sliding(problem: ContactProblem) -> Iterator[str]:
    slip = abs(problem.slide_roll_ratio)
    if slip > 2:
        yield (
            f"slide_roll_ratio = {problem.slide_roll_ratio:g} moves the surfaces in opposite "
            "directions: is it meant? It is (u_1 - u_2) / u_m, with u_m the mean speed"
        )
    high = problem.hertz.pressure >= UNPHYSICAL * (1.0 - ROUNDING)
    if slip > SLIDING and high and problem.lubricant.shear.is_newtonian:
        yield (
            f"a Newtonian film slides at {problem.hertz.pressure / 1e9:.2g} GPa, but traction "
            "coefficients above 0.1 are not physical: state an Eyring or limiting shear stress, "
            'such as shear = { law = "eyring", stress = "5 MPa" }'
        )


def _of_heat(problem: ContactProblem, heat: ExpectedHeat | None) -> Iterator[str]:
    if problem.thermal is not None:
        yield from _of_thermal(problem, problem.thermal)
        return
    newtonian = problem.lubricant.shear.is_newtonian
    if heat is not None and heat.largest > WARM:
        yield (
            f"[thermal] is missing, but shear will warm the film by about {heat.largest:.2g} K: an "
            f"isothermal {'Newtonian ' if newtonian else ''}film does not know of it"
        )
    elif newtonian and abs(problem.slide_roll_ratio) > SLIDING:
        yield (
            "surfaces slide, but an isothermal Newtonian film does not depend on it: heat would "
            "thin the film, and traction would be far too high"
        )


def _of_bodies(problem: ContactProblem) -> Iterator[str]:
    """Ask about bodies that are not as warm as the oil, which no film formula knows of."""
    effect = body_effect(problem)
    if effect is None:
        return
    for name, offset in (("surface_1", effect.surface_1), ("surface_2", effect.surface_2)):
        if abs(offset) >= NOTICED:
            yield (
                f"{name}.temperature is {abs(offset):.3g} K {'above' if offset > 0 else 'below'} "
                "the oil at the inlet, and the oil takes it on the way in: is it meant?"
                + (
                    f" Beyond {FAR_BODY:g} K a run may not converge"
                    if abs(offset) > FAR_BODY
                    else ""
                )
            )


def _of_thermal(problem: ContactProblem, thermal: Thermal) -> Iterator[str]:
    yield from _of_bodies(problem)
    if thermal.scheme == "uniform" and thermal.nodes < FEW_LAYERS:
        yield (
            f"thermal.layers = {thermal.nodes} are few for uniform layers: take "
            f'{LAYERS["uniform"]} or more, or scheme = "chebyshev"'
        )
    for name, peclet in zip(("surface_1", "surface_2"), problem.solid_peclet, strict=True):
        if thermal.sources == "line" and peclet is not None and peclet < SLOWEST_LINE:
            yield (
                'thermal.sources = "line" holds for fast surfaces, but the Peclet number of '
                f'{name} is {peclet:.2g}: take "auto"'
            )


def _of_numerics(options: Options, groups: Groups, thinner: Groups | None) -> Iterator[str]:
    """Ask about domain and grid; ``thinner`` are the groups of a film between warm bodies."""
    if isinstance(options.domain, Domain):
        yield from _of_domain(options.domain, recommended_domain(groups))
    elif groups.M < NEARLY_RIGID:
        left_out = domain_error(groups, recommended_domain(groups))
        yield (
            f"M = {groups.M:.3g} is a nearly rigid contact, with part of its load far outside: the "
            f"proposed domain leaves out {_part(left_out)} of the film; --certify measures it"
        )
    yield from _of_grid(options, thinner or groups)


def _of_grid(options: Options, groups: Groups) -> Iterator[str]:
    needed, nodes = needed_points(groups), min(options.shape)
    if nodes >= needed:
        return
    _, more = coarsenable(needed - 2)
    off = min(grid_error(groups, nodes), 1.0)
    percent = float(f"{100 * off:.1g}")
    yield (
        f"numerics.points = {nodes} is coarse for so thin a film: the central film may be "
        f"{percent:g} % off, the minimum several times as much, or the run may not converge; "
        f"{more} nodes keep the central film within about {100 * AIM:.0f} %"
    )


def _part(part: float) -> str:
    return "more than half" if part > 0.5 else f"about {100 * part:.2g} %"


def _of_domain(stated: Domain, wanted: Domain) -> Iterator[str]:
    edges = (
        ("inlet edge x", stated.x[0], wanted.x[0]),
        ("outlet edge x", stated.x[1], wanted.x[1]),
        ("side edge y", stated.y[0], wanted.y[0]),
        ("side edge y", stated.y[1], wanted.y[1]),
    )
    for name, here, there in edges:
        if abs(here) < 0.99 * abs(there) and not math.isclose(here, there):
            yield (
                f"numerics.domain has its {name} at {here:g}, recommended is {there:.3g}: the "
                "error of the film from the domain may exceed 0.3 %"
            )
