"""The clock of the benchmark of heated films."""

from benchmarks.measure import attempt
from benchmarks.thermal import EYRING, speed_contact, timed_parts

from tehl.contact.options import Options
from tehl.solver.cycle.hierarchy import Hierarchy
from tests.reference import DOMAIN


def test_the_parts_of_a_solve_are_timed_and_the_solver_is_left_as_it_was() -> None:
    """Sweeps and cycles on the finest grid count, and add up to less than all."""
    step, options = Hierarchy.cycle, Options(points=129, domain=DOMAIN)
    problem = speed_contact("generalised", EYRING)
    attempt(problem, options)  # compiles, which the cost of a solve leaves out
    with timed_parts(129) as clock:
        run = attempt(problem, options)
    assert 0.0 < clock.finest_sweeps < clock.sweeps < run.cost.cpu_seconds
    assert 0.0 < clock.finest_cycles < run.cost.cpu_seconds
    assert Hierarchy.cycle is step
