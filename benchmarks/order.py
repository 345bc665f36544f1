"""Errors of the film with a wedge of second and of third order on the same nodes."""

from tests.reference import heated_contact, moes_contact

from benchmarks.machines import contact
from benchmarks.measure import attempt
from benchmarks.table import Cell, Table
from tehl.api.problem import ContactProblem
from tehl.contact.options import Options

NODES, FINE = (65, 129, 257), 513
LOADS = ((20.0, 10.0), (200.0, 10.0), (1000.0, 10.0))
"""M and L of circular contacts."""
MACHINES = ((1, 0), (1, 2), (1, 5), (1, 7), (1, 11))
"""Seed and number of contacts of machines."""


def films(problem: ContactProblem, points: int, order: int) -> tuple[float, float] | None:
    """Return central and minimum film on a grid [-]; None if it does not converge."""
    options = Options(points=points, extrapolate=False, wedge_order=order)
    found = attempt(problem, options)
    if not found.status.converged:
        return None
    return found.film_scaled.central, found.film_scaled.minimum


def table(*, quick: bool = False) -> Table:
    """Return the errors of the central and the minimum film on `NODES` nodes per direction [%].

    The reference is the film with third order on `FINE` nodes plus a third of its last change.
    """
    cases = {f"M = {load:g}, L = {speed:g}": moes_contact(load, speed) for load, speed in LOADS}
    cases["heated, SRR 0.5"] = heated_contact(0.5)
    for seed, number in () if quick else MACHINES:
        kind, features, problem = contact(seed, number)
        cases[f"{kind} {number}{' '.join(['', *sorted(features)])}"] = problem
    made = Table(
        title="Error of the film by the mesh, central / minimum [%]",
        columns=("contact", *(f"order {order}, {n}" for order in (2, 3) for n in NODES)),
        notes=["- is a grid on which the film does not converge or is too coarse"],
    )
    for name, problem in cases.items():
        finest = films(problem, FINE, 3), films(problem, (FINE + 1) // 2, 3)
        if None in finest:
            continue
        limit = [a + (a - b) / 3.0 for a, b in zip(*finest, strict=True)]  # type: ignore[arg-type]
        row: list[Cell] = [name]
        for order in (2, 3):
            for nodes in NODES:
                found = films(problem, nodes, order)
                pair = zip(found or (), limit, strict=False)
                errors = [f"{100.0 * (value / there - 1.0):.2f}" for value, there in pair]
                row.append(" / ".join(errors) or "-")
        made.rows.append(tuple(row))
    return made
