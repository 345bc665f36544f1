"""What ``tehl solve`` prints: a steady or transient result in a few lines."""

from functools import partial

from tehl.api.results import Result, TransientResult
from tehl.cli.lazily import explanations
from tehl.cli.reference_runs import Comparisons
from tehl.post.film import no_film
from tehl.post.heat import UNTRUSTED_HEAT, work_error
from tehl.post.traction import LARGEST_CREDIBLE
from tehl.report.readable import UNTITLED, error_text, length_unit
from tehl.report.rendering import render
from tehl.report.rows import following, rows_of
from tehl.result.quantity import UNITS
from tehl.result.registry import at, named, shown_in
from tehl.result.solution import Status


def as_text(result: Result | TransientResult, compared: Comparisons | None = None) -> str:
    """Return the main numbers of a result and its comparisons with reference runs, one per line."""
    compared = compared or Comparisons()
    transient = isinstance(result, TransientResult)
    start = result.start if isinstance(result, TransientResult) else result
    return render(
        "transient.txt" if transient else "steady.txt",
        bar=partial(_bar, result),
        compared=compared,
        expected=_expected_traction(start),
        no_film=no_film(start),
        result=result,
        following=following(result),
        main_rows=() if transient else list(rows_of(start, "text")),
        rises=() if transient else list(rows_of(start, "rises")),
        quantities=shown_in("text"),
        share=at("load_sharing.share"),
        rough=compared.rough_film or start.roughness,
        title=start.problem.title or UNTITLED,
        untrusted=UNTRUSTED_HEAT,
        work_error=work_error(start),
    ).rstrip()


def _expected_traction(result: Result) -> float | None:
    """Return the traction that `tehl explain` expects, if the computed one is not credible."""
    if result.traction is None or result.traction.credible:
        return None

    heat = explanations.explain(result.problem).heat
    return None if heat is None else min(heat.traction, LARGEST_CREDIBLE)


def failure_text(status: Status, reason: str | None) -> str:
    """Return why a result did not converge, and the hint in a second line if there is one."""
    message = f"tehl: not converged ({status.cause or status.kind}): {status.message or reason}"
    return f"{message}\nhint: {status.hint}" if status.hint else message


def _bar(result: Result | TransientResult, name: str) -> str:
    """Return the error bar of a certified value, else the estimated error if known."""
    estimate = result.certified.get(name)
    if estimate is not None:
        one = named(name)
        words = one.words.get("bar")
        factor, unit = (1.0, words) if words else (UNITS[one.unit][0], one.unit)
        if unit == "nm":
            factor, unit = length_unit(estimate.value)
        parts = (
            f"grid {estimate.discretisation * factor:.2g}, domain {estimate.domain * factor:.2g}"
        )
        bar = f"{estimate.value * factor:.5g} +- {estimate.uncertainty * factor:.2g} {unit}"
        return f"   certified {bar} ({parts})"
    errors = None if isinstance(result, TransientResult) else result.errors
    error = None if errors is None else errors.of(name)
    return "" if error is None else f"   error {error_text(error)}"
