"""Small quick contacts for studies."""

from functools import cache

import pandas as pd

from tehl.api.problem import ContactProblem
from tehl.contact.options import Options
from tehl.studies import Case
from tests.cases import ball_tables

QUICK = Options(points=65)
"""Enough for light contacts; at M = 300 and L = 2 the grid is too coarse."""


def problem(load: float = 5.0, speed: float = 10.0, **changes) -> ContactProblem:
    contact = {"radius": "20 mm", "moes_load": load, "moes_speed": speed}
    return ContactProblem.model_validate(ball_tables(contact=contact, **changes))


def cases(count: int = 4, options: Options = QUICK) -> list[Case]:
    return [case(5.0 + 0.25 * number, options) for number in range(count)]


@cache
def case(load: float, options: Options) -> Case:
    return Case(f"M = {load:g}", problem(load), options, {"M": load})


def failing() -> Case:
    return Case("too coarse", problem(load=300.0, speed=2.0), QUICK, {"M": 300.0})


def assert_same_numbers(first, second) -> None:
    """Compare tables of two runs; a process that has just compiled rounds its last digit anew."""
    tables = [
        frame.drop(columns=[name for name in frame if name.endswith("_seconds")])
        for frame in (first, second)
    ]
    pd.testing.assert_frame_equal(*tables, check_exact=False, rtol=1e-12)


class Notes:
    """A monitor that remembers."""

    def __init__(self):
        self.messages, self.begun, self.names = [], [], []

    def message(self, text):
        self.messages.append(text)

    def begin(self, total, reused):
        self.begun.append((total, reused))

    def finished(self, case, row):
        self.names.append((case.name, row.status))
