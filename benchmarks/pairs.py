"""Each physics with each other on small grids: what converges, and what is refused and why."""

from collections.abc import Callable
from itertools import combinations_with_replacement
from typing import Any

from benchmarks.table import Table
from tehl.api.problem import ContactProblem, case_from_tables
from tehl.api.results import ConvergenceError
from tehl.api.solvers import certify, certify_transient, solve, solve_transient
from tehl.base.errors import InputError
from tehl.contact.options import Options
from tehl.explore.jobs import Ask, Desk, Part
from tehl.explore.tasks import Transient
from tehl.report.page import report_text
from tehl.result.solution import Status
from tehl.solver.judging.certify import certifiable
from tehl.studies.file import study

Tables = dict[str, Any]

WAVE = {"type": "wave", "amplitude": "0.1 um", "wavelength": "120 um", "angle": "90 deg"}
FEATURES: dict[str, Tables] = {
    "heat": {"thermal": {}},
    "thinning": {"lubricant": {"shear": {"law": "eyring", "stress": "5 MPa"}}},
    "standing": {"surface_1": {"roughness": WAVE}},
    "moving": {"surface_2": {"roughness": WAVE}, "transient": {"duration": "3 ms"}},
    "starved": {"supply": {"layer": "0.4 um"}},
    "conserving": {"cavitation": {"model": "conserving"}},
    "asperities": {
        "asperities": {
            "model": "greenwood-tripp",
            "rms": "0.1 um",
            "summit_radius": "20 um",
            "summit_density": "2e10 1/m^2",
        }
    },
    "boundary": {"contact_film": {"thickness": "60 nm"}},
    "ellipse": {
        "contact": {"radius_x": "20 mm", "radius_y": "40 mm", "entrainment_angle": "30 deg"}
    },
    "load": {"transient": {"duration": "3 ms", "load": [["0 ms", 1.0], ["3 ms", 1.2]]}},
}
"""Tables of each physics, laid over `BASE`."""
BASE: Tables = {
    "contact": {"load": "10 N", "entrainment_speed": "0.4 m/s", "slide_roll_ratio": 0.3},
    "surface_1": {"material": "steel"},
    "surface_2": {"material": "steel"},
    "lubricant": {
        "viscosity": {"law": "roelands", "eta_0": "0.04 Pa s", "alpha": "22 1/GPa",
                      "gamma": "0.04 1/K"},
        "density": {"law": "dowson-higginson", "rho_0": "890 kg/m^3"},
        "conductivity": "0.14 W/(m K)",
        "heat_capacity": "2000 J/(kg K)",
    },
}  # fmt: skip


def contact(*features: str) -> ContactProblem:
    """Return a ball on a disc with some of `FEATURES`."""
    return case_from_tables(tables_of(*features))[0]


def tables_of(*features: str) -> Tables:
    """Return the tables of a ball on a disc with some of `FEATURES`."""
    tables = {"contact": {"radius": "20 mm"}} if "ellipse" not in features else {}
    for part in (BASE, *(FEATURES[name] for name in features)):
        tables = _laid_over(tables, part)
    return tables


def _laid_over(below: Tables, above: Tables) -> Tables:
    both = dict(below)
    for key, value in above.items():
        old = below.get(key)
        nested = isinstance(old, dict) and isinstance(value, dict)
        both[key] = _laid_over(old, value) if nested else value
    return both


class Quiet:
    """A connection of the page that listens to nothing."""

    def send(self, message: object) -> None:
        """Drop a message."""

    def poll(self) -> bool:
        """Say that nothing has come."""
        return False


def _solved(features: tuple[str, ...], options: Options) -> str | None:
    """Solve, and write the report."""
    problem = contact(*features)
    found = (solve if problem.transient is None else solve_transient)(problem, options)
    report_text(found, dpi=30)
    return _fault(found.status)


def _certified(features: tuple[str, ...], options: Options) -> str | None:
    problem = contact(*features)
    work = certify if problem.transient is None else certify_transient
    return _fault(work(problem, certifiable(options)).status)


def _studied(features: tuple[str, ...], options: Options) -> str | None:
    (row,) = study(contact(*features), {"contact.load": ["9 N"]}, options).itertuples()
    return None if row.status == "converged" else row.message


def _on_the_page(features: tuple[str, ...], options: Options) -> str | None:
    """Solve as the page does: the film at time zero, and the movie of a transient run."""
    tables, desk = tables_of(*features) | {"numerics": {"points": options.points}}, Desk(Quiet())
    words = [one.shown.outcome.words for one in desk.solve(Ask(tables=tables)) if is_last(one)]
    if "transient" in tables:
        words += [one.words for one in Transient(tables)(desk)]
    return next((word for word in words if word != "converged"), None)


def is_last(message: object) -> bool:
    """Whether a message of the page is the result on the grid of the case."""
    return isinstance(message, Part) and message.final


def _fault(status: Status) -> str | None:
    return None if status.converged else status.message


WAYS: dict[str, Callable[[tuple[str, ...], Options], str | None]] = {
    "solve": _solved,
    "certify": _certified,
    "study": _studied,
    "page": _on_the_page,
}
"""Ways to a result; each returns a sentence if it did not converge."""


def outcome(features: tuple[str, ...], points: int, way: str = "solve") -> str:
    """Solve a contact with some features; return "works", or why not in words.

    Parameters
    ----------
    features : tuple of str
        Of `FEATURES`.
    points : int
        Nodes per direction.
    way : str
        Of `WAYS`.
    """
    try:
        message = WAYS[way](features, Options(points=points))
    except InputError as error:
        return f"refused: {error}"
    except ConvergenceError as error:
        message = str(error)
    return f"fails: {message}" if message else "works"


def table(points: int, *, quick: bool = False) -> Table:
    """Return a row for each physics, a column for each one and for each further way."""
    names, (_, *ways) = list(FEATURES)[: 3 if quick else None], WAYS
    found = {
        frozenset(pair): outcome(pair, points) for pair in combinations_with_replacement(names, 2)
    }
    rows = {
        name: [found[frozenset((name, other))] for other in names]
        + [outcome((name,), points, way) for way in ways]
        for name in names
    }
    notes = sorted({text for row in rows.values() for text in row if text != "works"})
    return Table(
        title=f"Physics that work together, {points} x {points} nodes",
        columns=("physics", *names, *ways),
        rows=[
            (name, *(notes.index(text) + 1 if text in notes else text for text in row))
            for name, row in rows.items()
        ],
        notes=[f"{number}: {note}" for number, note in enumerate(notes, start=1)],
    )
