"""Which finished case is nearest to one that is still to be solved."""

import math
from collections.abc import Iterable

from tehl.studies.case import Case, Label

Kind = tuple[tuple[str, ...], tuple[str, ...], tuple[int, int]]


class Neighbours:
    """Finished cases by their labels.

    Cases are neighbours if they have the same labels, the same words among them, and the same
    number of nodes; they are as far apart as the logarithms of their numbers.
    """

    def __init__(self, finished: Iterable[Case] = ()) -> None:
        self._cases: dict[Kind, list[tuple[tuple[float, ...], Case]]] = {}
        for case in finished:
            self.add(case)

    def add(self, case: Case) -> None:
        """Take a case that is finished, and has an answer."""
        self._cases.setdefault(_kind(case), []).append((_place(case), case))

    def nearest(self, case: Case) -> Case | None:
        """Return the finished case that is nearest, None where there is none of its kind."""
        here, known = _place(case), self._cases.get(_kind(case), [])
        return min(known, key=lambda one: math.dist(here, one[0]))[1] if known else None


def _kind(case: Case) -> Kind:
    words = tuple(value for value in case.labels.values() if isinstance(value, str))
    return tuple(case.labels), words, case.options.shape


def _place(case: Case) -> tuple[float, ...]:
    return tuple(_straight(value) for value in case.labels.values() if not isinstance(value, str))


def _straight(value: Label) -> float:
    """Return a number on a scale where equal ratios far from zero are equal steps."""
    return math.asinh(float(value) / _SMALL)


_SMALL = 1e-12
"""Below this a number is next to zero."""
