"""Sweeps of the page are studies in memory: same numbers, cancelled at once, known points kept."""

import asyncio
import os

import pytest

pytest.importorskip("tomlkit", reason="needs pip install 'tehl[explore]'")

from tehl.api.problem import case_from_tables
from tehl.api.solvers import solve
from tehl.explore.case_text import CaseText
from tehl.explore.jobs import Failure
from tehl.explore.sweeps import Sweep, Sweeps, Swept
from tehl.io.case import changed
from tehl.io.templates import template_text
from tests.explore.test_worker import Inbox

CASE = CaseText(template_text("ball-on-disc"))
TABLES = CASE.tables | {"numerics": {"points": 65}}


def sweep(*loads, tables=TABLES):
    return Sweep(tables, "contact.load", tuple((load, f"{load} N") for load in loads))


async def swept(sweeps, job):
    inbox = Inbox(asyncio.get_running_loop())
    sweeps.submit("tab", job, inbox)
    await asyncio.wait_for(inbox.ended, 240)
    return inbox


async def scenario():
    sweeps = Sweeps(asyncio.get_running_loop())
    try:
        first = await swept(sweeps, sweep(20.0, 80.0))
        pids = [worker.process.pid for worker in sweeps._pool._idle]
        again = await swept(sweeps, sweep(20.0, 40.0, 80.0))
        wrong = await swept(sweeps, sweep(30.0, -1.0))
        slow = Inbox(asyncio.get_running_loop())
        sweeps.submit("tab", sweep(25.0, tables=TABLES | {"numerics": {"points": 2049}}), slow)
        await asyncio.sleep(0.3)
        sweeps.cancel("tab")
        await asyncio.wait_for(slow.ended, 10)
        after = await swept(sweeps, sweep(60.0))
    finally:
        sweeps.close()
    check_points(first, again)
    assert [one.x for one in wrong.of(Swept)] == [30.0]
    assert "must be positive" in wrong.of(Failure)[0].text
    assert slow.ended.result().cancelled
    assert not slow.of(Swept)
    assert after.of(Swept)[0].numbers
    with pytest.raises(ProcessLookupError):
        os.kill(pids[0], 0)


def check_points(first, again):
    assert {one.x for one in first.of(Swept)} == {20.0, 80.0}
    assert [one.x for one in again.of(Swept)] == [20.0, 80.0, 40.0]  # the known ones at once
    assert again.of(Swept)[:2] == sorted(first.of(Swept), key=lambda one: one.x)
    for one in again.of(Swept):
        expected = solve(*case_from_tables(changed(TABLES, "contact.load", f"{one.x} N")))
        assert one.numbers[0].value == expected.film.central * 1e9


def test_a_sweep_is_a_study_in_memory():
    asyncio.run(scenario())
