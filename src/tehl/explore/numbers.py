"""The numbers beside the pictures: each with its error bar, and film formulas to compare."""

from collections.abc import Iterator
from dataclasses import dataclass

from tehl.api.results import Result
from tehl.estimate.film_formulas import FilmEstimate
from tehl.post.following import Following
from tehl.report.explain import Explanation
from tehl.result.bars import ErrorEstimate
from tehl.result.derived import KAPPA, has_solids
from tehl.result.quantity import Quantity, without_unit
from tehl.result.registry import NumbersOf, shown_in

Formulas = tuple[tuple[str, float], ...]
"""Authors of formulas, and their values."""
NO_FILM = "no film (h ≤ 0)"


@dataclass(frozen=True, kw_only=True, slots=True)
class Number:
    """A quantity of a result."""

    key: str
    """Its name for programs."""
    name: str
    symbol: str
    """Its name and symbol for people."""
    value: float | None
    """In ``unit``; None where the contact does not have it."""
    unit: str
    error: float | None = None
    """Relative error bar [-]; None if it is not known."""
    formulas: tuple[tuple[str, float], ...] = ()
    """Authors of formulas, and their values in ``unit``."""
    remark: str = ""
    """Why there is no value, or what limits it."""
    by_formula: bool = False
    """Whether it is scaled by a formula from the contact before."""


def numbers(result: Result, explanation: Explanation) -> tuple[Number, ...]:
    """Return the numbers of a result beside those of formulas."""
    found = Following(result)
    formulas, remarks = _formulas(result, explanation), _remarks(found, explanation)
    names = {} if found.touching is None else {"share": ("load where surfaces touch", "w_c/w")}
    return tuple(_numbers(found.numbers, formulas, remarks, names))


def _numbers(
    found: NumbersOf,
    formulas: dict[str, Formulas],
    remarks: dict[str, str],
    names: dict[str, tuple[str, str]],
) -> Iterator[Number]:
    """Yield the quantities of the registry that the page shows."""
    for one in shown_in("page"):
        value = found.get(one.path)
        if one.path == "share" and not has_solids(found):
            continue
        name, symbol = names.get(one.path, (one.words["page"], one.symbol))
        yield Number(
            key=key_of(one),
            name=name,
            symbol=symbol,
            value=None if value is None else one.shown(value),
            unit=one.unit,
            error=None if value is None else one.error_in(found),
            formulas=formulas.get(one.path, ()),
            remark=remarks.get(one.path, ""),
        )


def key_of(one: Quantity) -> str:
    """Return the key of a quantity on the page, its heading in tables of sweeps."""
    return one.words.get("key", without_unit(one.key))


def value_of(found: tuple[Number, ...], key: str) -> Number | None:
    """Return the number called ``key``."""
    return next((one for one in found if one.key == key), None)


def _formulas(result: Result, explanation: Explanation) -> dict[str, Formulas]:
    """Return the formulas to compare by the paths of the quantities."""
    films, part, heat = explanation.films, explanation.starved_part, explanation.heat
    found: dict[str, Formulas] = {
        "film.h_central_m": film_formulas(films, part, central=True),
        "film.h_min_m": film_formulas(films, part, central=False),
        "pressure.max_pa": (("Hertz", explanation.scaled.problem.hertz.pressure * 1e-9),),
    }
    if (ratio := explanation.lambda_central) is not None:
        found["roughness.lambda_central"] = (("by formula", ratio),)
        found["kappa"] = (("by formula", ratio**KAPPA),)
    if heat is not None:
        inlet = result.problem.inlet_temperature - 273.15
        found["temperature_max"] = (("by formula", inlet + heat.largest),)
        if result.problem.motion.slides:
            found["friction"] = (("by formula", heat.traction),)
            found["power"] = (("by formula", heat.power),)
    if explanation.shared is not None:
        found["share"] = (("by formula", 100.0 * explanation.shared.share),)
    return found


def _why_pressure_is_open(errors: ErrorEstimate | None) -> str:
    if errors is None or (errors.pressure_has_limit and errors.spike_resolved):
        return ""
    if not errors.pressure_has_limit:
        return "open, at an end of the roller"
    return "the spike is narrower than the mesh and may be higher"


def _remarks(found: Following, explanation: Explanation) -> dict[str, str]:
    """Return why there is no value, or what limits it, by the paths of the quantities."""
    result, no_film = found.solution, not found.solution.film.minimum > 0
    remarks = {"film.h_central_m": NO_FILM if not result.film.central > 0 else ""}
    remarks["film.h_min_m"] = NO_FILM if no_film else ""
    if found.numbers.get("roughness.lambda_central") is None:
        rough = explanation.composite > 0
        missing = NO_FILM if rough else "state the roughness of the surfaces"
        remarks |= dict.fromkeys(("roughness.lambda_central", "kappa"), missing)
    remarks["pressure.max_pa"] = _why_pressure_is_open(result.errors)
    if found.temperature is None:
        remarks["temperature_max"] = "isothermal; switch the heat on"
    unknown = found.touching is not None and not found.touching.is_share_known
    why = f"not known: {found.touching.why_unknown}" if found.touching and unknown else ""
    remarks["share"] = remarks["friction"] = remarks["power"] = why
    if found.traction is None:
        remarks["friction"] = remarks["power"] = "no valid film"
    elif not found.traction.credible:
        touches = found.touching is not None
        remedy = "take less sliding" if touches else "state a shear law"
        words = f"more than an oil can transmit: {remedy}"
        remarks["friction"] = remarks["power"] = words
    if not result.problem.motion.slides:
        remarks["friction"] = "pure rolling: set a slide-to-roll ratio"
    if result.problem.contact.is_line and not remarks["power"]:
        remarks["power"] = "of one metre"
    return remarks


def film_formulas(
    films: tuple[FilmEstimate, ...], part: float, *, central: bool
) -> tuple[tuple[str, float], ...]:
    """Return the authors of film formulas and their central or minimum films [nm].

    ``part`` is the film over that of the flooded contact.
    """
    return tuple(
        (one.formula, part * metres * 1e9)
        for one in films
        if (metres := one.central_m if central else one.minimum_m) is not None
    )
