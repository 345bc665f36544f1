r"""Least squares through the solver: constants, noise, covariance, and profiles of likelihood.

With the values :math:`f_i` of the solver, those measured :math:`m_i` and their standard deviations
:math:`\sigma_i`, the constants minimise :math:`S = \sum_i ((f_i - m_i)/\sigma_i)^2`. Where noise is
not stated, it is that of each kind, :math:`s^2 = \sum_i r_i^2 / \sum_i (1 - h_{ii})`, with the
leverages :math:`h_{ii}`, repeated with the constants. The covariance of the logarithms is
:math:`(J^T J)^{-1}`; an interval ends where :math:`S`, least over all other constants, has grown by
:math:`t^2` [1]_. The degrees of freedom of :math:`t` are those of the noise of each kind, weighted
with its part in the variance of the constant [2]_.

References
----------
.. [1] D. M. Bates and D. G. Watts, Nonlinear Regression Analysis and Its Applications, Wiley, 1988,
   sections 1.2 and 6.1.
.. [2] F. E. Satterthwaite, Biometrics Bulletin 2 (1946), 110-114.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares
from scipy.special import ndtri, stdtrit

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.studies.fitting.measured import KINDS
from tehl.studies.fitting.model import Model

CONFIDENCE = 0.95
"""Probability of the intervals."""
_NORMAL_DEGREES = 1e6
"""Degrees of freedom from which on t is normal."""
_LEAST_DECREASE = 1e-3
"""Relative decrease of the sum of squares, or change of the constants, at which a fit stops."""
_LARGEST_END_FACTOR = 3.0
"""Largest growth of the distance of an end in one step."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Estimate:
    """Where the sum of squares is least; all over the logarithms of constants over their starts."""

    x: Array
    fitted: Array
    noise: Array
    """Values of the solver and standard deviations, for each measured value [SI]."""
    jacobian: Array
    """Derivatives of the values over the noise."""
    covariance: Array
    ends: Array
    """Lower and upper ends of the intervals, (constants, 2); infinite where they are open."""
    noises: dict[str, float]
    """Estimated noise by kind: a share of the value, or absolute [SI]."""
    scatter: float
    """Sum of squares over the degrees of freedom [-]."""
    grid_errors: Array
    """Changes by the error bars of the solver."""


def estimate(model: Model, measured: Array, stated: Array) -> Estimate:
    """Return the constants of a test with their intervals.

    Parameters
    ----------
    model : Model
        With the nodes of its points.
    measured, stated : Array
        Values and their standard deviations, NaN where these are estimated, for each place of the
        model.

    Raises
    ------
    InputError
        If there are too few values for the constants.
    """
    kinds = np.array([kind for _, kind in model.places])
    unknown = sorted({*kinds[np.isnan(stated)]})
    _check_number(model, kinds, unknown)
    unit = np.where([KINDS[kind].is_relative for kind in kinds], measured, 1.0)
    noises = {kind: _first_noise(kind, measured[kinds == kind]) for kind in unknown}
    x, noise = np.zeros(len(model.constants)), stated
    for _ in range(6):
        drawn = np.array([noises.get(kind, np.nan) for kind in kinds]) * unit
        noise = np.where(np.isnan(stated), drawn, stated)
        x = _minimised(model, x, measured, noise)
        before, noises = noises, _noises(model, x, measured, noise, noises)
        if all(abs(math.log(noises[kind] / before[kind])) < 0.02 for kind in unknown):
            break
    values, jacobian = model.values(x), model.jacobian(x) / noise[:, None]
    residual = (values - measured) / noise
    left = measured.size - x.size
    scatter = float(residual @ residual) / left if left else 1.0
    # with a least curvature, so that constants without effect are open
    inverse = np.linalg.inv(jacobian.T @ jacobian + 1e-8 * np.eye(x.size))
    gain = inverse @ jacobian.T
    found = Estimate(
        x=x,
        fitted=values,
        noise=noise,
        jacobian=jacobian,
        covariance=np.asarray(inverse * max(scatter, 1.0), dtype=float),
        ends=np.empty((x.size, 2)),
        noises=noises,
        scatter=scatter,
        grid_errors=_grid_errors(model, x, gain, values / noise),
    )
    for k, quantile in enumerate(_quantiles(kinds, unknown, gain, _freedom(jacobian))):
        model.report(f"interval of {model.constants[k].name}")
        found.ends[k] = [_end(model, measured, found, k, side * quantile) for side in (-1.0, 1.0)]
    return found


def _quantiles(kinds: Array, unknown: list[str], gain: Array, freedom: Array) -> Array:
    """Return the quantile of t for each constant, by Satterthwaite's degrees of freedom."""
    parts = np.array([np.sum(gain[:, kinds == kind] ** 2, axis=1) for kind in unknown])
    left = np.array([[max(float(freedom[kinds == kind].sum()), 0.5)] for kind in unknown])
    upper = 0.5 * (1.0 + CONFIDENCE)
    if not unknown:
        return np.full(gain.shape[0], ndtri(upper))
    total, lost = np.sum(gain**2, axis=1), np.sum(parts**2 / left, axis=0)
    decided = lost > 0.0  # a constant without effect stays open whatever the quantile
    degrees = np.where(decided, total**2 / np.where(decided, lost, 1.0), math.inf)
    return np.where(
        degrees < _NORMAL_DEGREES,
        stdtrit(np.minimum(degrees, _NORMAL_DEGREES), upper),
        ndtri(upper),
    )


def _freedom(jacobian: Array) -> Array:
    """Return one minus the leverage of each value: what it leaves for the noise."""
    basis = np.linalg.svd(jacobian, full_matrices=False)[0]
    return 1.0 - np.sum(basis**2, axis=1)


def _check_number(model: Model, kinds: Array, unknown: list[str]) -> None:
    """Raise if there are too few values to decide the constants, and the noise if it is sought."""
    least = len(model.constants) + bool(unknown)
    if kinds.size < least:
        advice = " or state the noise" if unknown else ""
        raise InputError(
            f"{kinds.size} measured values for {len(model.constants)} constants: at least {least} "
            f"are needed; fit fewer constants{advice}"
        )


def _first_noise(kind: str, values: Array) -> float:
    """Return the noise with which the fit begins: 3 % of the value, or of the largest one."""
    return 0.03 * (1.0 if KINDS[kind].is_relative else float(np.abs(values).max()) or 1.0)


def _minimised(model: Model, start: Array, measured: Array, noise: Array) -> Array:
    """Return the place of the least sum of squares, from ``start`` on."""
    low, high = limits(model)

    def residual(x: Array) -> Array:
        before = model.solves
        found = (model.values(x) - measured) / noise
        if model.solves > before:
            model.report(f"{model.shown(x)}: scatter {math.sqrt(np.mean(found**2)):.3g}")
        return found

    model.check(start)
    found = least_squares(
        residual,
        start,
        jac=lambda x: model.jacobian(x) / noise[:, None],
        bounds=(low, high),
        ftol=_LEAST_DECREASE,
        xtol=_LEAST_DECREASE,
        max_nfev=40,
    )
    return np.asarray(found.x)


def limits(model: Model) -> tuple[Array, Array]:
    """Return the least and the largest logarithms of the constants."""
    return (
        np.array([math.log(one.least / one.start) for one in model.constants]),
        np.array([math.log(one.most / one.start) for one in model.constants]),
    )


def _noises(
    model: Model, x: Array, measured: Array, noise: Array, known: dict[str, float]
) -> dict[str, float]:
    """Return the noise of each kind by the residuals at ``x``."""
    residual = (model.values(x) - measured) / noise
    freedom = _freedom(model.jacobian(x) / noise[:, None])
    kinds = np.array([kind for _, kind in model.places])
    found = {}
    for kind, before in known.items():
        chosen = kinds == kind
        left = max(float(freedom[chosen].sum()), 0.5)
        noisy = before * math.sqrt(float(residual[chosen] @ residual[chosen]) / left)
        largest = 1.0 if KINDS[kind].is_relative else float(np.abs(measured[chosen]).max())
        found[kind] = max(noisy, 1e-4 * largest)  # less is that of the solver
    return found


def _end(model: Model, measured: Array, found: Estimate, k: int, quantile: float) -> float:
    """Return an end of the interval of constant ``k``; infinite if the sum does not grow to it."""
    scale = max(found.scatter, 1.0)
    target = quantile**2 * scale
    least = float(np.sum(((found.fitted - measured) / found.noise) ** 2))
    along = found.covariance[:, k] / found.covariance[k, k]
    step = math.copysign(math.sqrt(found.covariance[k, k]), quantile) * abs(quantile)
    low, high = limits(model)
    grown = 0.0
    for _ in range(6):
        place = min(max(found.x[k] + step, low[k]), high[k])
        step = place - found.x[k]
        grown = _profile(model, measured, found, k, found.x + step * along) - least
        if not math.isfinite(grown):  # no film there
            step *= 0.5
            continue
        if grown < target and place in (low[k], high[k]):
            break
        ratio = math.sqrt(target / grown) if grown > 0 else _LARGEST_END_FACTOR
        step *= min(ratio, _LARGEST_END_FACTOR)
        if abs(ratio - 1.0) < 0.1:  # this step has removed the rest
            return float(found.x[k] + step)
    return float(found.x[k] + step) if grown > target else math.copysign(math.inf, quantile)


def _profile(model: Model, measured: Array, found: Estimate, k: int, x: Array) -> float:
    """Return the least sum of squares over the constants other than ``k``, by a Gauss-Newton step.

    The derivatives are those at the least sum: at ``x``, which lies on the ridge of the linear
    problem, they have changed little.
    """
    low, high = limits(model)
    x = np.clip(x, low, high)
    residual = (model.values(x) - measured) / found.noise
    others = np.arange(x.size) != k
    first = float(residual @ residual)
    if not others.any() or not math.isfinite(first):
        return first
    moved = x.copy()
    moved[others] -= np.linalg.lstsq(found.jacobian[:, others], residual, rcond=None)[0]
    residual = (model.values(np.clip(moved, low, high)) - measured) / found.noise
    second = float(residual @ residual)
    return min(first, second) if math.isfinite(second) else first


def _grid_errors(model: Model, x: Array, gain: Array, values: Array) -> Array:
    """Return the changes of the constants if each kind is off by its error bars, all one way."""
    answers = model.answers(x)[0]
    bars = np.array([getattr(answers[k], "bars", {}).get(kind, 0.0) for k, kind in model.places])
    kinds = np.array([kind for _, kind in model.places])
    parts = [np.abs(gain[:, kinds == kind] @ (bars * values)[kinds == kind]) for kind in {*kinds}]
    return np.asarray(np.sum(parts, axis=0))
