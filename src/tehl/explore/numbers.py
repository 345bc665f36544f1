"""The numbers beside the pictures: each with its error bar, and film formulas to compare."""

from collections.abc import Iterator
from dataclasses import dataclass

from tehl.api.results import Result
from tehl.estimate.film_formulas import FilmEstimate
from tehl.report.explain import Explanation

KAPPA = 1.3
"""Exponent of the viscosity ratio kappa of ISO 281 over lambda."""
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
    return (
        *_film(result, explanation),
        *_film_over_roughness(result, explanation),
        _pressure(result, explanation),
        _temperature(result, explanation),
        *_friction(result, explanation),
        *_load_share(result, explanation),
    )


def value_of(found: tuple[Number, ...], key: str) -> Number | None:
    """Return the number called ``key``."""
    return next((one for one in found if one.key == key), None)


def _film(result: Result, explanation: Explanation) -> Iterator[Number]:
    film, errors, part = result.film, result.errors, explanation.starved_part
    for key, name, symbol, value in (
        ("h_central", "central film", "h_c", film.central),
        ("h_min", "minimum film", "h_min", film.minimum),
    ):
        central = key == "h_central"
        yield Number(
            key=key,
            name=name,
            symbol=symbol,
            value=value * 1e9 if value > 0 else None,
            unit="nm",
            error=None if errors is None else errors.central if central else errors.minimum,
            formulas=film_formulas(explanation.films, part, central=central),
            remark="" if value > 0 else NO_FILM,
        )


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


def _film_over_roughness(result: Result, explanation: Explanation) -> Iterator[Number]:
    rough, composite = result.roughness, explanation.composite
    error = None if result.errors is None else result.errors.central
    ratio = None
    if composite > 0 and result.film.central > 0:
        ratio = rough.lambda_central if rough else result.film.central / composite
    formula = explanation.lambda_central
    missing = "" if ratio is not None else "state the roughness of the surfaces"
    if composite > 0 and not result.film.central > 0:
        missing = NO_FILM
    for key, name, symbol, power in (
        ("lambda", "film over roughness", "λ", 1.0),
        ("kappa", "viscosity ratio (ISO 281), from λ", "κ", KAPPA),
    ):
        yield Number(
            key=key,
            name=name,
            symbol=symbol,
            value=None if ratio is None else ratio**power,
            unit="",
            error=None if error is None or ratio is None else power * error,
            formulas=() if formula is None else (("by formula", formula**power),),
            remark=missing,
        )


def _pressure(result: Result, explanation: Explanation) -> Number:
    errors, shared = result.errors, result.load_sharing
    highest = float(result.pressure.max()) if shared is None else shared.pressure_max
    resolved = errors is None or errors.spike_resolved
    return Number(
        key="p_max",
        name="largest pressure",
        symbol="p_max",
        value=highest * 1e-9,
        unit="GPa",
        error=None if errors is None else errors.pressure_max,
        formulas=(("Hertz", explanation.scaled.problem.hertz.pressure * 1e-9),),
        remark="" if resolved else "the spike is narrower than the mesh and may be higher",
    )


def _temperature(result: Result, explanation: Explanation) -> Number:
    found, heat = result.temperature, explanation.heat
    inlet = result.problem.inlet_temperature - 273.15
    rise = None if found is None else found.film_rise_max
    error = None if result.errors is None else result.errors.film_rise_max
    return Number(
        key="t_max",
        name="largest temperature",
        symbol="T_max",
        value=None if rise is None else inlet + rise,
        unit="°C",
        error=None if error is None or rise is None else abs(error * rise / (inlet + rise or 1.0)),
        formulas=() if heat is None else (("by formula", inlet + heat.largest),),
        remark="" if found is not None else "isothermal; switch the heat on",
    )


def _friction(result: Result, explanation: Explanation) -> Iterator[Number]:
    forces, shared, heat = result.traction, result.load_sharing, explanation.heat
    error = None if result.errors is None else result.errors.traction_mid_film
    friction = power = None
    remark = "no valid film"
    if forces is not None:
        friction, power = abs(forces.mid_film), forces.friction_power
        remark = "" if forces.credible else "more than an oil can transmit: state a shear law"
    touched = result.touching
    if touched is not None:
        friction, error = touched.friction, None
        power = (power or 0.0) + touched.power_boundary
        if friction is None:
            power, remark = None, "more than an oil can transmit: take less sliding"
    if shared is not None:
        friction = shared.friction
        power = (power or 0.0) + shared.power_boundary
    sliding = result.problem.slide_roll_ratio != 0
    compared = heat is not None and sliding
    yield Number(
        key="friction",
        name="friction coefficient",
        symbol="μ",
        value=friction,
        unit="",
        error=error if sliding else None,
        formulas=(("by formula", heat.traction),) if heat is not None and compared else (),
        remark=remark if sliding else "pure rolling: set a slide-to-roll ratio",
    )
    yield Number(
        key="power",
        name="power loss",
        symbol="P",
        value=power,
        unit="W",
        error=error if sliding else None,
        formulas=(("by formula", heat.power),) if heat is not None and compared else (),
        remark=remark if forces is None or not forces.credible else "",
    )


def _load_share(result: Result, explanation: Explanation) -> Iterator[Number]:
    shared, formula, touched = result.load_sharing, explanation.shared, result.touching
    if touched is not None:
        share, bar = touched.share, touched.share_error
        yield Number(
            key="load_share",
            name="load where surfaces touch",
            symbol="w_c/w",
            value=100.0 * share,
            unit="%",
            error=bar / share if share > 0 else None,
            remark="" if touched.is_share_known else f"not known: {touched.why_unknown}",
        )
    if shared is None:
        return
    error = shared.share_error
    yield Number(
        key="load_share",
        name="load on asperities",
        symbol="w_a/w",
        value=100.0 * shared.share,
        unit="%",
        error=error / shared.share if error is not None and shared.share > 0 else None,
        formulas=() if formula is None else (("by formula", 100.0 * formula.share),),
    )
