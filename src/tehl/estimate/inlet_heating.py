"""Reduction of the film by shear heating of the inlet, by published formulas.

References
----------
.. [1] W. R. D. Wilson and S. Sheu, J. Lubrication Technology 105 (1983), 187-188.
.. [2] L. E. Murch and W. R. D. Wilson, J. Lubrication Technology 97 (1975), 212-216.
.. [3] P. K. Gupta, H. S. Cheng, D. Zhu, N. H. Forster and J. B. Schrand, Tribology Transactions 35
   (1992), 621-626.
"""

from dataclasses import dataclass

from tehl.contact.problem import ContactProblem


@dataclass(frozen=True, kw_only=True, slots=True)
class InletFactor:
    """Reduction of the film by shear heating of the inlet, by one formula."""

    formula: str
    source: str
    """Authors, and publication."""
    factor: float
    """Film over the isothermal film [-]."""
    remarks: tuple[str, ...]
    """Limits of validity that the contact exceeds."""


def murch_wilson(loading: float) -> float:
    """Return the factor of Murch and Wilson [2]_ on the film of pure rolling [-]."""
    return 1.0 / (1.0 + 0.254 * loading**0.62)


def wilson_sheu(loading: float, slide_roll_ratio: float) -> float:
    """Return the factor of Wilson and Sheu [1]_ on the film of rolling and sliding [-].

    Parameters
    ----------
    loading : float
        Thermal loading of the inlet, `ContactProblem.thermal_loading` [-].
    slide_roll_ratio : float
        (u_1 - u_2)/u_m [-]; its sign has no effect.
    """
    slip = 0.5 * abs(slide_roll_ratio)
    return 1.0 / (1.0 + 0.241 * (1.0 + 14.8 * slip**0.83) * loading**0.64)


def gupta(loading: float, slide_roll_ratio: float, relative_pressure: float) -> float:
    """Return the factor of Gupta and others [3]_ on the film of rolling and sliding [-].

    Parameters
    ----------
    loading, slide_roll_ratio, relative_pressure : float
        Thermal loading parameter, (u_1 - u_2) / u_m, and p_h / E' [-].
    """
    compressed = max(1.0 - 13.2 * relative_pressure * loading**0.42, 0.0)
    sliding = 1.0 + 2.23 * abs(slide_roll_ratio) ** 0.83
    return compressed / (1.0 + 0.213 * sliding * loading**0.64)


def inlet_factors(problem: ContactProblem) -> tuple[InletFactor, ...]:
    """Return the inlet heating factor by each formula; none if the oil lacks a property.

    The formulas are fits to rolling contacts with moderate sliding, accurate to 10 to 15 %.
    """
    loading = problem.thermal_loading
    if loading is None:
        return ()
    slip = problem.slide_roll_ratio
    squeezed = problem.hertz.pressure / problem.reduced_modulus
    term = 13.2 * squeezed * loading**0.42
    sliding = "valid for pure rolling" if abs(slip) > 0.05 else ""
    opposite = "valid for surfaces that move in one direction" if abs(slip) > 2 else ""
    large = f"the term 13.2 p_h/E' L^0.42 = {term:.2g} is not small" if term > 0.5 else ""
    journal = "J. Lubrication Technology"
    found = (
        ("Murch-Wilson", f"{journal} 97 (1975) 212-216", murch_wilson(loading), sliding),
        ("Wilson-Sheu", f"{journal} 105 (1983) 187-188", wilson_sheu(loading, slip), opposite),
        (
            "Gupta",
            "Tribology Transactions 35 (1992) 621-626",
            gupta(loading, slip, squeezed),
            opposite,
            large,
        ),
    )
    return tuple(
        InletFactor(
            formula=name, source=source, factor=factor, remarks=tuple(filter(None, remarks))
        )
        for name, source, factor, *remarks in found
    )


def inlet_heating_factor(problem: ContactProblem) -> float | None:
    """Return the factor of Wilson and Sheu [1]_ on the isothermal film [-].

    None if the case states no conductivity or no temperature coefficient of the oil, or if the
    surfaces move in opposite directions.
    """
    loading = problem.thermal_loading
    if loading is None or abs(problem.slide_roll_ratio) > 2.0:
        return None
    return wilson_sheu(loading, problem.slide_roll_ratio)
