"""Time from a move of a slider on the live page to the new map, and memory over many moves.

``python -m benchmarks.explore [--moves 100] [--many 2000]`` starts `tehl explore` and drives the
chromium of this machine. A move counts from the event of the pointer to the frame after the new
image has been decoded.
"""

import argparse
import re
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from playwright.sync_api import Page, sync_playwright
from tests.browser.chromium import ARGUMENTS, FLAT, executable

from tehl.io.templates import template_text

CASES = {
    "isothermal": ("ball-on-disc", "load"),
    "heated": ("thermal", "Hertz pressure"),
}
"""Template and slider, by what is timed."""
QUIET_MS = 400
"""Time without a new image after which a solve counts as shown."""
WATCH = """() => {
    window.shown = [];
    const image = document.querySelector('.slot:last-child img');
    new MutationObserver(async () => {
        try { await image.decode(); } catch { return; }
        requestAnimationFrame(() => window.shown.push(performance.now()));
    }).observe(image, {attributes: true, attributeFilter: ['src']});
    for (const kind of ['pointerdown', 'pointermove', 'pointerup', 'mousemove', 'mouseup'])
        window.addEventListener(kind, () => { window.moved = performance.now(); }, true);
}"""


@contextmanager
def server(name: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """Yield a running page of a template on 257 nodes, and its address."""
    with tempfile.TemporaryDirectory() as folder:
        case = Path(folder) / "case.toml"
        case.write_text(template_text(name).replace('error = "2 %"', "points = 257"))
        command = [sys.executable, "-u", "-m", "tehl", "explore", str(case), "--no-browser"]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
            assert process.stdout is not None
            try:
                yield process, process.stdout.readline().split()[0]
            finally:
                process.terminate()


def opened(browser: Any, address: str) -> Page:
    """Return the page once its first film has been solved and both workers are warm."""
    page: Page = browser.new_page(viewport={"width": 1440, "height": 900})
    page.goto(address)
    page.get_by_text("converged on 257 × 257").wait_for(timeout=300_000)
    page.wait_for_timeout(15_000)
    page.evaluate(WATCH)
    return page


def handle(page: Page, label: str) -> tuple[float, float, float]:
    """Return left, width and height in the page of a slider."""
    box = page.get_by_role("slider", name=label).bounding_box()
    assert box is not None
    return box["x"], box["width"], box["y"] + 0.5 * box["height"]


def wait_for_image(page: Page, after: float, quiet: float) -> float | None:
    """Return when the last image after a time was shown, once none has followed for a while."""
    deadline = time.monotonic() + 20.0
    while time.monotonic() < deadline:
        found = page.evaluate(
            "([after, quiet]) => { const later = window.shown.filter(t => t > after);"
            "return later.length && performance.now() - later.at(-1) > quiet ? later : null; }",
            [after, quiet],
        )
        if found:
            return float(found[-1] if quiet else found[0])
        page.wait_for_timeout(5)
    return None


def moves(page: Page, label: str, count: int) -> tuple[list[float], list[float]]:
    """Return the times [ms] to the coarse map while moving, and to the fine one on release."""
    left, width, y = handle(page, label)
    coarse, fine = [], []
    for number in range(count):
        at = left + width * (0.42 + 0.16 * (number % 10) / 10)
        page.mouse.move(at, y)
        page.mouse.down()
        wait_for_image(page, 0.0, QUIET_MS)
        page.mouse.move(at + 9, y)
        moved = page.evaluate("window.moved")
        shown = wait_for_image(page, moved, 0)
        if shown is not None:
            coarse.append(shown - moved)
        page.mouse.up()
        released = page.evaluate("window.moved")
        shown = wait_for_image(page, released, QUIET_MS)
        if shown is not None:
            fine.append(shown - released)
    return coarse, fine


def memory_of(pid: int) -> float:
    """Return the resident memory of a process and its children [MB]."""
    total = 0.0
    for status in Path("/proc").glob("[0-9]*/status"):
        try:
            text = status.read_text()
        except OSError:
            continue
        ids = [int(number) for number in re.findall(r"^P?Pid:\s+(\d+)", text, re.MULTILINE)]
        if pid in ids and (found := re.search(r"VmRSS:\s+(\d+)", text)):
            total += int(found[1]) / 1e3
    return total


def heap_of(page: Page) -> float:
    """Return what the scripts of the page hold after a collection [MB]."""
    session = page.context.new_cdp_session(page)
    session.send("HeapProfiler.collectGarbage")
    return float(session.send("Runtime.getHeapUsage")["usedSize"]) / 1e6


def memory(page: Page, pid: int, label: str, count: int) -> list[tuple[int, float, float]]:
    """Return moves, memory of the processes and heap of the page [MB] along many moves."""
    left, width, y = handle(page, label)
    found = []
    page.mouse.move(left + 0.5 * width, y)
    page.mouse.down()
    for number in range(1, count + 1):
        page.mouse.move(left + width * (0.4 + 0.2 * ((number * 7) % 20) / 20), y)
        page.wait_for_timeout(30)
        if number % (count // 10) == 0:
            found.append((number, memory_of(pid), heap_of(page)))
    page.mouse.up()
    return found


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--moves", type=int, default=100)
    parser.add_argument("--many", type=int, default=2000)
    chosen = parser.parse_args()
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=executable(), args=[*ARGUMENTS, *FLAT])
        for kind, (template, label) in CASES.items():
            with server(template) as (process, address):
                page = opened(browser, address)
                for what, times in zip(
                    ("65²", "257²"), moves(page, label, chosen.moves), strict=True
                ):
                    sys.stdout.write(row(kind, what, times))
                if kind == "isothermal" and chosen.many:
                    for number, resident, heap in memory(page, process.pid, label, chosen.many):
                        sys.stdout.write(
                            f"{number:6d} moves: {resident:6.0f} MB resident, {heap:5.1f} MB heap\n"
                        )
                page.close()


def row(kind: str, what: str, times: list[float]) -> str:
    """Return the median and the slowest tenth of times [ms]."""
    ordered = sorted(times)
    slow = ordered[int(0.9 * len(ordered))]
    return f"{kind:10s} {what:4s}  median {statistics.median(times):5.0f} ms, 90 % {slow:5.0f} ms\n"


if __name__ == "__main__":
    main()
