"""The last solution scaled to another contact by the film formula, until that one is solved."""

from dataclasses import dataclass, replace

from tehl.api.problem import ContactProblem
from tehl.estimate.film_formulas import expected_film, film_estimates
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.starvation import starved_part, supply_ratio
from tehl.explore.numbers import Number, film_formulas
from tehl.explore.shown import Line, Lines, Maps, Shown
from tehl.result.derived import KAPPA


@dataclass(frozen=True, kw_only=True, slots=True)
class Ratios:
    """A contact over the one that was solved [-]."""

    film: float
    """Of central films, by the formula of Nijenbanning, Venner and Moes and the law of supply."""
    pressure: float
    """Of Hertz pressures."""
    x: float
    y: float
    """Of Hertz half-widths."""
    skew: float
    """s of the rim of the wanted contact."""
    roughness: float
    """Of the roughness of both surfaces; one where none is stated."""


def scaled_by_formula(shown: Shown, solved: ContactProblem, wanted: ContactProblem) -> Shown:
    """Return what is shown of a solved contact, scaled to the wanted one.

    Film, pressure and places along x and y are scaled, and the numbers that follow from them; the
    others, temperature, interferogram, stress and stiffness are those of the solved contact.
    """
    ratios = _ratios(solved, wanted)
    lines = shown.lines
    return replace(
        shown,
        numbers=_numbers(shown.numbers, ratios, wanted),
        maps=_maps(shown.maps, ratios),
        lines=Lines(x=_line(lines.x, ratios.x, ratios), y=_line(lines.y, ratios.y, ratios)),
        section=shown.section and replace(shown.section, x=shown.section.x * ratios.x),
    )


def _ratios(solved: ContactProblem, wanted: ContactProblem) -> Ratios:
    before, after = solved.hertz, wanted.hertz
    rough = [problem.asperity_rms or problem.rms_roughness for problem in (solved, wanted)]
    return Ratios(
        film=_film(wanted) / _film(solved),
        pressure=after.pressure / before.pressure,
        x=after.half_width_x / before.half_width_x,
        y=after.half_width_y / before.half_width_y,
        skew=after.skew,
        roughness=rough[1] / rough[0] if min(rough) > 0 else 1.0,
    )


def _film(problem: ContactProblem) -> float:
    """Return the central film to expect [m]."""
    scaled = ScaledProblem.of(problem)
    return starved_part(supply_ratio(scaled)) * expected_film(scaled)


def _maps(maps: Maps, ratios: Ratios) -> Maps:
    (left, right), (bottom, top) = maps.window
    return replace(
        maps,
        x=maps.x * ratios.x,
        y=maps.y * ratios.y,
        window=((left * ratios.x, right * ratios.x), (bottom * ratios.y, top * ratios.y)),
        half_widths=(maps.half_widths[0] * ratios.x, maps.half_widths[1] * ratios.y),
        film=maps.film * ratios.film,
        pressure=maps.pressure * ratios.pressure,
        central=maps.central * ratios.film,
        top=maps.top * ratios.pressure,
        minimum=tuple((x * ratios.x, y * ratios.y) for x, y in maps.minimum),
        skew=ratios.skew,
    )


def _line(line: Line, along: float, ratios: Ratios) -> Line:
    place, film, pressure, hertz = line
    return place * along, film * ratios.film, pressure * ratios.pressure, hertz * ratios.pressure


def _numbers(
    found: tuple[Number, ...], ratios: Ratios, wanted: ContactProblem
) -> tuple[Number, ...]:
    scaled = ScaledProblem.of(wanted)
    films = film_estimates(scaled.groups, scaled.scales)
    part = starved_part(supply_ratio(scaled))
    over_roughness = ratios.film / ratios.roughness
    factors = {
        **{one.key: ratios.film for one in found if one.unit == "nm"},
        "lambda": over_roughness,
        "kappa": over_roughness**KAPPA,
        "p_max": ratios.pressure,
    }
    formulas = {
        "h_central": film_formulas(films, part, central=True),
        "h_min": film_formulas(films, part, central=False),
        "p_max": (("Hertz", wanted.hertz.pressure * 1e-9),),
    }
    return tuple(
        replace(
            one,
            value=one.value * factors[one.key],
            error=None,
            formulas=formulas.get(one.key, ()),
            by_formula=True,
        )
        if one.key in factors and one.value is not None
        else one
        for one in found
    )
