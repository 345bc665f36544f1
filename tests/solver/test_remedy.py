"""Hints are settings that were seen to converge."""

from dataclasses import replace
from types import SimpleNamespace

import pytest
from benchmarks.random_contacts import contact

from tehl.errors import InputError
from tehl.options import Options
from tehl.problem import ContactProblem
from tehl.result import ConvergenceError
from tehl.solver import solve, steady
from tehl.solver.diagnosis import error_setting
from tehl.solver.monitor import SILENT
from tehl.solver.remedy import working_hint
from tests.solver.test_status import failure, moes


def test_the_smallest_error_that_converges_is_named():
    failed = replace(failure(100.0, points=33).result, options=Options())

    def only_coarse(problem: ContactProblem, options: Options):
        if options.error < 0.1:
            raise InputError("no memory")
        return solve(problem, options)

    texts: list[str] = []
    hint = working_hint(failed, only_coarse, SimpleNamespace(message=texts.append))
    assert hint.settings == {"numerics.error": "20 %"}
    assert "nodes then converge to an error of" in hint.advice
    assert len(texts) == 3


def test_no_setting_is_named_if_none_converges():
    failed = failure(100.0, points=33).result
    hint = working_hint(failed, lambda *_: failed, SILENT)
    assert hint.settings == {}
    assert "No setting is known" in str(hint)


def test_a_stiff_heated_oil_gets_a_hint_that_works(monkeypatch):
    # Barus, L = 14, pure sliding: the shear stress exceeds any oil's
    problem, _ = contact(12, 225)
    with pytest.raises(ConvergenceError) as caught:
        solve(problem, Options(error=0.1))
    hint = caught.value.result.status.hint
    assert hint.settings
    monkeypatch.setattr(steady, "working_hint", None)
    tables = problem.model_dump(exclude_none=True)
    if "thermal" in hint.settings:
        del tables["thermal"]
    if "lubricant.shear" in hint.settings:
        tables["lubricant"]["shear"] = hint.settings["lubricant.shear"]
    error = hint.settings.get("numerics.error", 0.1)
    assert solve(ContactProblem.model_validate(tables), Options(error=error)).status.converged


def test_stated_nodes_are_not_searched(monkeypatch):
    monkeypatch.setattr(steady, "working_hint", None)
    with pytest.raises(ConvergenceError):
        solve(moes(2000.0), Options(points=33))


def test_a_contact_that_lacks_time_gets_an_error_that_was_reached():
    with pytest.raises(ConvergenceError) as caught:
        solve(moes(100.0), Options(error=1e-4, max_time=0.05))
    status = caught.value.result.status
    assert status.cause in ("error_not_reached", "grid_too_coarse")
    assert "nodes then converge" in str(status.hint)
    assert solve(moes(100.0), Options(error=status.hint.settings["numerics.error"]))


@pytest.mark.parametrize(("reached", "named"), [(0.03, "4 %"), (0.44, "49 %"), (0.47, None)])
def test_an_error_is_named_only_where_it_can_be_asked_for(reached, named):
    found = error_setting(reached)
    assert found == ({} if named is None else {"numerics.error": named})
    Options.model_validate({"error": named})
