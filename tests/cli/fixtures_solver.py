"""A solver that returns at once, so that the commands can be tested alone."""

import sys
from dataclasses import replace
from types import ModuleType, SimpleNamespace

import pytest

from tehl.api.results import ConvergenceError
from tests.fixtures_result import make_result


class FakeSolver:
    """Stands for ``tehl.api.solvers``; ``outcome`` is a status or an exception to raise.

    ``cold`` is the outcome of isothermal cases after another one.
    """

    def __init__(self) -> None:
        self.outcome: object = None
        self.cold: object = None
        self.calls: list[SimpleNamespace] = []

    def solve(self, problem, options, *, monitor=None):
        return self._result("solve", problem, options, monitor or Silent())

    def certify(self, problem, options, *, monitor=None):
        return self._result("certify", problem, options, monitor)

    def _result(self, kind, problem, options, monitor):
        self.calls.append(SimpleNamespace(kind=kind, problem=problem, options=options))
        result = replace(make_result(33), problem=problem, options=options)
        monitor.message("hello")
        for report in result.history:
            monitor.cycle(report)
        if isinstance(self.outcome, BaseException):
            raise self.outcome
        outcome = self.outcome if len(self.calls) == 1 else self.cold
        if outcome is not None:
            raise ConvergenceError("it did not converge", replace(result, status=outcome))
        return result


class Silent:
    """A monitor that says nothing."""

    def message(self, text):
        pass

    def cycle(self, report):
        pass


@pytest.fixture
def solver(monkeypatch) -> FakeSolver:
    fake = FakeSolver()
    module = ModuleType("tehl.api.solvers")
    module.solve, module.certify = fake.solve, fake.certify
    module.with_work = lambda result: result
    monkeypatch.setitem(sys.modules, "tehl.api.solvers", module)
    monkeypatch.setattr("tehl.api.solvers", module, raising=False)
    monitor = SimpleNamespace(SILENT=Silent())
    monkeypatch.setitem(sys.modules, "tehl.solver.monitor", monitor)
    monkeypatch.setitem(
        sys.modules,
        "tehl.kernels.cache",
        SimpleNamespace(is_cold=lambda **_: False, folder=lambda: None),
    )
    return fake
