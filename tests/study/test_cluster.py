"""A running dask cluster finds what one process finds, and survives a killed worker."""

import pytest

from tehl.studies import Store, run, runner, table
from tests.study import mishaps
from tests.study.contacts import Notes, assert_same_numbers, cases

distributed = pytest.importorskip("distributed")

pytestmark = pytest.mark.filterwarnings("ignore")  # those of distributed are not ours

COUNT = 6


@pytest.fixture(scope="module")
def cluster():
    options = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    options["scheduler_kwargs"] = {"allowed_failures": 0}  # a lost worker takes its tasks along
    with distributed.LocalCluster(processes=True, silence_logs=50, **options) as found:
        yield found.scheduler_address


def test_a_cluster_finds_what_one_process_finds_and_keeps_fields(cluster, tmp_path):
    here, there = Store(tmp_path / "here"), Store(tmp_path / "there", keep="fields")
    run(cases(COUNT), here)
    notes = Notes()
    outcome = run(cases(COUNT), there, scheduler=cluster, monitor=notes)
    assert outcome.converged == COUNT
    assert len(notes.names) == COUNT
    assert_same_numbers(table(cases(COUNT), there), table(cases(COUNT), here))
    assert there.result(cases(1)[0]).status.converged


@pytest.mark.slow
def test_a_case_that_kills_its_workers_fails_alone(cluster, tmp_path, monkeypatch):
    monkeypatch.setattr(runner, "work", mishaps.deadly)
    store = Store(tmp_path)
    outcome = run(cases(COUNT), store, scheduler=cluster)
    assert [(c.labels["M"], r.cause) for c, r in outcome.failed] == [(5.5, "worker_died")]


def test_an_address_without_a_scheduler_is_an_error(tmp_path, monkeypatch):
    monkeypatch.setattr("tehl.studies.engines._CONNECT", 1.0)
    with pytest.raises(OSError, match="no dask scheduler replies at tcp"):
        run(cases(1), Store(tmp_path), scheduler="tcp://127.0.0.1:1")
