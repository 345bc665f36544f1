"""A running page and a browser for the tests in this folder; skipped where there is no browser.

Each process of the tests has one server, one browser, and one page that most of its tests share.
"""

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tehl.explore.case_text import CaseText, template_case
from tehl.io.templates import template_text
from tehl.kernels.cache import is_cold
from tests.browser.chromium import ARGUMENTS, FLAT, executable

pytest.importorskip("nicegui", reason="needs pip install 'tehl[explore]'")
api = pytest.importorskip("playwright.sync_api", reason="needs pip install playwright")

PATIENCE = 60_000
"""Milliseconds for what is expected; a busy machine is slow."""
DESK = {"width": 1440, "height": 900}
"""The window."""
BALL = template_case("ball-on-disc").text
"""The case that a page has at first."""


class Served:
    """A process of `tehl explore`."""

    def __init__(self, *arguments, folder):
        self.log = (folder / "explore.log").open("w+")
        command = [sys.executable, "-u", "-m", "tehl", "explore", "--no-browser"]
        command += arguments
        environment = os.environ | {"TMPDIR": str(folder)}
        environment.pop("PYTEST_CURRENT_TEST", None)  # NiceGUI would not serve
        self.process = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=self.log, text=True, env=environment
        )
        line = self.process.stdout.readline()
        assert line, self.errors()
        self.address = line.split()[0]

    def errors(self):
        self.log.seek(0)
        return self.log.read()

    def children(self):
        """Return the numbers of the processes that it has started."""
        tasks = Path(f"/proc/{self.process.pid}/task")
        return [int(n) for one in tasks.glob("*/children") for n in one.read_text().split()]

    def workers(self):
        """Return its processes that solve."""
        return [
            pid
            for pid in self.children()
            if b"spawn_main" in Path(f"/proc/{pid}/cmdline").read_bytes()
        ]

    def end(self):
        """End it as Ctrl-C does; return its exit code."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        try:
            return self.process.wait(20)
        finally:
            self.process.kill()
            self.process.stdout.close()
            self.messages = self.errors()
            self.log.close()


@pytest.fixture(scope="session")
def browser():
    path = executable()
    if path is None:
        pytest.skip("chromium is not installed")
    with api.sync_playwright() as playwright:
        yield playwright.chromium.launch(executable_path=path, args=[*ARGUMENTS, *FLAT])


@pytest.fixture(scope="session")
def compiled():
    """The kernels in the cache: a page that compiles them first may need more than `PATIENCE`."""
    if is_cold(coupled=True):
        subprocess.run([sys.executable, "-m", "tehl", "doctor", "--warm"], check=True)


@pytest.fixture(scope="session")
def served(tmp_path_factory, compiled):
    del compiled
    server = Served(folder=tmp_path_factory.mktemp("served"))
    yield server
    code, errors = server.end(), server.messages
    assert code == 0
    assert "Traceback" not in errors, errors


@pytest.fixture(scope="session")
def shared_context(browser):
    made = browser.new_context(viewport=DESK, accept_downloads=True, reduced_motion="reduce")
    made.set_default_timeout(PATIENCE)
    made.kept = None
    made.failures = []
    made.requests = []
    made.on("request", lambda request: made.requests.append(request.url))
    made.on("weberror", lambda error: made.failures.append(str(error.error)))
    yield made
    made.close()


@pytest.fixture
def context(shared_context):
    """The context of all pages, so that they share the cache of the browser."""
    shared_context.failures.clear()
    yield shared_context
    for page in shared_context.pages:
        if page is not shared_context.kept:
            page.close()
    assert shared_context.failures == []


@pytest.fixture
def page(context, served, request):
    """The shared page with the first case, whatever a test before has made of it.

    A page is opened anew where a test has failed since, so that others do not fail with it.
    """
    failed = request.session.testsfailed
    if context.kept is None or context.failed != failed:
        context.kept, context.failed = opened(context, served.address), failed
    restore(context.kept)
    return context.kept


def restore(page):
    """Take the first case and its film, without dialogs and notices."""
    page.bring_to_front()
    page.set_viewport_size(DESK)
    page.emulate_media(color_scheme="light")
    page.keyboard.press("Escape")
    page.locator(".q-dialog").first.wait_for(state="detached")
    notes = page.get_by_role("alert").get_by_role("button", name="close")
    notes.evaluate_all("all => all.forEach(one => one.click())")  # some are closing by themselves
    page.get_by_role("tab", name="Film", exact=True).click()
    if case_of(page) != BALL or page.locator(".light.bad").count():
        page.get_by_role("button", name="Templates").click()
        page.locator(".menu-name", has_text=re.compile("^ball-on-disc$")).click()
        until(lambda: case_of(page) == BALL)
    solved(page)


def case_of(page):
    """Return the text of the case in the address of a page."""
    packed = page.evaluate("location.href").partition("case=")[2]
    return CaseText.unpacked(packed).text if packed else None


def take(page, text, name="case.toml"):
    """Open a case as a file."""
    page.get_by_role("button", name="Open", exact=True).click()
    file = {"name": name, "mimeType": "text/plain", "buffer": text.encode()}
    page.locator("input[type=file]").set_input_files(file)


def opened(context, address):
    """Return a page with its first film solved."""
    page = context.new_page()
    page.goto(address)
    solved(page)
    return page


def busy(page):
    """Show 129² nodes of a contact whose worker solves 1025², for seconds."""
    take(page, template_text("thermal").replace('error = "2 %"', "points = 1025"))
    finer = re.compile("(257|513|1025) nodes, cycle")
    page.locator(".status-words", has_text=finer).wait_for()


def solved(page, words="converged on"):
    """Wait until nothing is being solved, and the status has words."""
    page.locator(".light.good, .light.bad").wait_for()
    page.locator(".status-words", has_text=words).first.wait_for()


def number(page, key):
    """Return the value of a number as the page shows it."""
    return page.locator(f'[data-key="{key}"] b').inner_text()


def type_into(page, name, words):
    """Type a value into a control, and wait for its film."""
    entry = page.get_by_role("textbox", name=name, exact=True)
    entry.fill(words)
    entry.press("Enter")


def choose(page, name, words):
    """Choose an option of a list; open it again if the line moves under the mouse and closes it."""

    def chosen():
        page.get_by_role("combobox", name=name).click()
        try:
            page.get_by_role("option", name=words).click(timeout=5_000)
        except api.TimeoutError:
            return False
        return True

    until(chosen)


def until(condition, seconds=60.0):
    """Wait until a condition holds."""
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, "timed out"
        time.sleep(0.05)
