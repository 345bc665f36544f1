"""When a transient run goes on with half the nodes, as a contact that grows needs fewer."""

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from tehl.base.typing import Array
from tehl.contact.moment import SAMPLES, moments_of
from tehl.contact.options import Options
from tehl.estimate.domain import domain_of
from tehl.estimate.duration import duration_of
from tehl.estimate.in_time import Posed, films_of
from tehl.estimate.line import line_error
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.settled import settled

EACH = SAMPLES // 50
"""Of the sampled moments those whose error is estimated."""
LEAST_HALVED, LEAST_AFTER = 256, 20
"""Least intervals after a halving, and steps that follow it."""
PART_OF_ERROR = 0.7
"""Part of the error to reach within which a film on half the nodes is expected."""


def halvings(
    scaled: ScaledProblem,
    options: Options,
    start: tuple[int, float | None],
    stride: int,
    steps: int,
) -> tuple[int, ...]:
    """Return the time steps before which the mesh width is doubled, in the same time step.

    From then on the error that is expected stays below `PART_OF_ERROR`: that of the start, which is
    known, times what the formula says of other moments and nodes. Smooth lines do so, where oil is
    not conserved in cavities and nothing but the oil carries load.

    Parameters
    ----------
    scaled, options : ScaledProblem, Options
        A transient problem, and the error to reach.
    start : (int, float or None)
        Nodes of the start along x, and error bar of its film; None before it is solved [-].
    stride, steps : int
        Mesh widths per step, and steps of the run.
    """
    problem, (nodes, bar) = scaled.problem, start
    others = problem.is_rough or problem.conserves_oil or problem.contact_film is not None
    if others or problem.asperities is not None or not problem.contact.is_line or stride % 2:
        return ()
    options, intervals, found = settled(problem, options), nodes - 1, list[int]()
    moments = moments_of(problem, duration_of(scaled))[::EACH]
    films = films_of(scaled, domain_of(scaled, options), moments)
    if films[0] is None:  # the schedule refuses it
        return ()
    of_start = _errors(films, nodes)[0]
    most = PART_OF_ERROR * options.target
    known = most if bar is None else bar
    while stride % 2 == 0 and intervals % 2 == 0 and intervals >= 2 * LEAST_HALVED:
        stride, intervals = stride // 2, intervals // 2
        errors = _errors(films, intervals + 1) / of_start
        enough = known * np.maximum.accumulate(errors[::-1])[::-1] <= most
        first = math.ceil(int(np.argmax(enough)) * steps / (enough.size - 1))
        if not enough.any() or steps - first < LEAST_AFTER:
            break
        found.append(max(first, 1))
    return tuple(found)


def parts_of_run(
    nodes: int, stride: int, steps: int, halved: Sequence[int]
) -> Iterator[tuple[int, int, int]]:
    """Yield nodes along x, mesh widths per step and number of steps of each part of a run.

    Parameters
    ----------
    nodes, stride, steps : int
        As of `halvings`.
    halved : sequence of int
        The steps that it returns.
    """
    for first, end in pairwise((1, *halved, steps + 1)):
        yield nodes, stride, end - first
        nodes, stride = (nodes - 1) // 2 + 1, stride // 2


def _errors(films: Sequence[Posed | None], nodes: int) -> Array:
    """Return the errors by formula of the films of some moments, infinite where there is none."""
    return np.array(
        [math.inf if one is None else line_error(one[0].groups, one[1], nodes) for one in films]
    )
