"""The worker of the page solves the newest request, can be cancelled, and is replaced."""

import asyncio
import multiprocessing
import os
import signal
from dataclasses import replace

import pytest

pytest.importorskip("tomlkit", reason="needs pip install 'tehl[explore]'")

from tehl.api.problem import case_from_tables
from tehl.api.solvers import solve
from tehl.explore.case_text import CaseText
from tehl.explore.curves import response_charts, values_at_frequency
from tehl.explore.jobs import Ask, Desk, End, Explained, Failure, Part, TooCoarse, with_stiffness
from tehl.explore.worker import DIED, Solver
from tehl.io.templates import template_text
from tests.cases import ball_tables

CASE = CaseText(template_text("ball-on-disc"))


class Inbox:
    """Messages of a job, until its end."""

    def __init__(self, loop):
        self.messages, self.ended = [], loop.create_future()

    def __call__(self, message):
        self.messages.append(message)
        if isinstance(message, End) and not self.ended.done():
            self.ended.set_result(message)

    def of(self, kind):
        return [message for message in self.messages if isinstance(message, kind)]


async def scenario():
    loop = asyncio.get_running_loop()
    solver = Solver(loop)
    try:
        await refines(solver, Inbox(loop))
        await sentence(solver, Inbox(loop))
        await newest(solver, [Inbox(loop) for _ in range(5)])
        await cancelled(solver, Inbox(loop), Inbox(loop))
        await killed(solver, Inbox(loop), Inbox(loop))
        await killed_while_it_starts(solver, Inbox(loop), Inbox(loop))
        pid = solver.pid
    finally:
        solver.close()
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)


async def refines(solver, inbox):
    tables = CASE.tables | {"numerics": {"error": 0.004}}  # one grid is enough for the usual error
    solver.submit("tab", Ask(tables=tables), inbox)
    await asyncio.wait_for(inbox.ended, 240)
    parts = inbox.of(Part)
    assert [part.final for part in parts] == [False, True]
    assert len(inbox.of(Explained)) == 1
    coarse, fine = (part.shown.numbers[0] for part in parts)
    assert fine.error < 0.5 * coarse.error
    expected = solve(*case_from_tables(tables))
    assert fine.value == expected.film.central * 1e9
    assert parts[-1].shown.maps.film.shape == parts[-1].shown.maps.pressure.shape


async def sentence(solver, inbox):
    faulty = CASE.tables | {"numerics": {"points": 16385}}
    solver.submit("tab", Ask(tables=faulty), inbox)
    await asyncio.wait_for(inbox.ended, 60)
    assert "memory" in inbox.of(Failure)[0].text


async def newest(solver, inboxes):
    for inbox in inboxes:
        solver.submit("tab", Ask(tables=CASE.tables, quick=True), inbox)
    await asyncio.wait_for(inboxes[-1].ended, 60)
    assert inboxes[-1].of(Part)
    assert sum(bool(inbox.messages) for inbox in inboxes) <= 2


async def cancelled(solver, inbox, after):
    slow = CASE.tables | {"numerics": {"points": 1025}}
    solver.submit("tab", Ask(tables=slow), inbox)
    while not inbox.of(Part):
        await asyncio.sleep(0.01)
    solver.submit("tab", Ask(tables=CASE.tables, quick=True), after)
    await asyncio.wait_for(after.ended, 30)
    assert inbox.ended.result().cancelled
    assert after.of(Part)


async def killed(solver, inbox, after):
    slow = CASE.tables | {"numerics": {"points": 1025}}
    solver.submit("tab", Ask(tables=slow), inbox)
    while not inbox.of(Part):
        await asyncio.sleep(0.01)
    os.kill(solver.pid, signal.SIGKILL)
    await asyncio.wait_for(inbox.ended, 30)
    assert "has ended" in inbox.of(Failure)[0].text
    solver.submit("tab", Ask(tables=CASE.tables, quick=True), after)
    await asyncio.wait_for(after.ended, 60)
    assert after.of(Part)


async def killed_while_it_starts(solver, inbox, after):
    before = solver.pid
    os.kill(before, signal.SIGKILL)  # idle: replaced without a sentence
    while before in [process.pid for process in multiprocessing.active_children()]:
        await asyncio.sleep(0.01)
    solver.submit("tab", Ask(tables=CASE.tables | {"numerics": {"points": 1025}}), inbox)
    while solver.pid == before:
        await asyncio.sleep(0.01)
    os.kill(solver.pid, signal.SIGKILL)
    await asyncio.wait_for(inbox.ended, 30)
    assert [message.text for message in inbox.of(Failure)] == [DIED]
    solver.submit("tab", Ask(tables=CASE.tables, quick=True), after)
    await asyncio.wait_for(after.ended, 60)
    assert after.of(Part)
    assert not after.of(Failure)


class Silent:
    """A connection over which nothing comes."""

    def send(self, message):
        pass

    def poll(self):
        return False


@pytest.mark.parametrize(
    ("quick", "words"),
    [
        (False, "129 × 129 is too coarse, solving 769 × 769, about "),
        (True, "65 × 65 is too coarse: solved when the slider is released"),
    ],
)
def test_a_coarse_grid_on_which_the_film_did_not_converge_is_a_sentence(quick, words, stalled):
    desk = Desk(Silent())
    desk.warm.add(False)
    desk.result = lambda *_: stalled
    case = CaseText(CASE.text)
    case.set("numerics.points", 769)
    messages = list(desk.solve(Ask(tables=case.tables, quick=quick)))
    assert next(one.text for one in messages if isinstance(one, TooCoarse)).startswith(words)
    assert [one.final for one in messages if isinstance(one, Part)] == [True] * (not quick)


def test_stiffness_is_solved_for_its_view_and_drawn_over_frequency():
    desk = Desk(Silent())
    tables = ball_tables(numerics={"points": 65})
    parts = [
        one for one in desk.solve(Ask(tables=tables, view="dynamics")) if isinstance(one, Part)
    ]
    shown = parts[-1].shown
    found = shown.dynamics
    assert (found.damping > 0.0).all()
    charts = response_charts(shown, (700.0, 500.0))
    assert [one.overlay.count('class="point"') for one in charts] == 2 * [found.frequency.size - 1]
    place = charts[0].frame.x(found.frequency[3])
    read = f"{found.frequency[3]:.4g} Hz:  k = {found.stiffness[3] * 1e-6:.4g} N/µm"
    assert values_at_frequency(shown, charts, place).startswith(read)
    assert not values_at_frequency(shown, charts, -100.0)
    of_a_line = response_charts(replace(shown, is_line=True), (700.0, 500.0))
    assert "per mm [N/µm]" in of_a_line[0].overlay
    assert with_stiffness(tables | {"contact_film": {"thickness": "2 nm"}}).dynamics is None


@pytest.mark.skipif(os.name == "nt", reason="kills a process by a signal")
def test_requests_are_refined_replaced_cancelled_and_survive_a_killed_worker():
    asyncio.run(scenario())
