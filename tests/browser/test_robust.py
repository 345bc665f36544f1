"""The live page is for one person on one machine, and outlives what goes wrong."""

import os
import re
import signal
import socket
import time
import urllib.error
import urllib.request
from pathlib import Path
from urllib.parse import urlsplit

import pytest

from tests.browser.conftest import (
    PATIENCE,
    Served,
    busy,
    choose,
    number,
    opened,
    solved,
    type_into,
    until,
)


def status_of(address, **headers):
    try:
        with urllib.request.urlopen(urllib.request.Request(address, headers=headers)) as reply:
            return reply.status, reply.read().decode()
    except urllib.error.HTTPError as error:
        return error.code, error.read().decode()


def test_a_wrong_token_is_refused_with_a_sentence(served):
    root = served.address.partition("?")[0]
    for address in (root, f"{root}?token=guess", f"{root}_nicegui/x", f"{root}?case=abc"):
        code, text = status_of(address)
        assert code == 403
        assert "lacks the token" in text


def test_another_name_or_origin_is_refused(served):
    assert status_of(served.address)[0] == 200
    assert status_of(served.address, Host="evil.example")[0] == 403
    assert status_of(served.address, Origin="http://evil.example")[0] == 403


def test_a_request_larger_than_an_upload_is_refused(served):
    root, _, query = served.address.partition("?")
    address = f"{root}_nicegui/client/x/upload/1?{query}"
    request = urllib.request.Request(address, data=b"x", headers={"Content-Length": "99000000"})
    with pytest.raises(urllib.error.HTTPError) as error:
        urllib.request.urlopen(request)
    assert error.value.code == 413
    error.value.close()


def test_the_page_is_on_the_loopback_address_only(served):
    port = urlsplit(served.address).port
    listening = [
        line.split()[1]
        for name in ("/proc/net/tcp", "/proc/net/tcp6")
        for line in Path(name).read_text().splitlines()[1:]
        if line.split()[3] == "0A" and line.split()[1].endswith(f":{port:04X}")
    ]
    assert listening == [f"0100007F:{port:04X}"]


def test_two_tabs_are_independent(page, context, served):
    other = opened(context, served.address)
    first = number(page, "h_central")
    type_into(other, "load", "300")
    until(lambda: number(other, "h_central") != first)
    solved(other)
    assert number(page, "h_central") == first
    assert page.get_by_role("textbox", name="load", exact=True).input_value() == "80"


def test_a_killed_worker_is_a_sentence_and_a_new_one_solves(page, served):
    busy(page)
    for pid in served.workers():
        os.kill(pid, signal.SIGKILL)
    page.locator(".card .what", has_text="has ended").wait_for()
    solved(page, "shown is the last valid case")  # the line moves once more, and a click misses
    choose(page, "accuracy", "129² nodes")
    until(lambda: page.locator(".card:visible").count() == 0)
    solved(page, "converged on 129 × 129")


def test_a_damaged_address_is_a_sentence(context, served):
    page = opened(context, f"{served.address}&case=damaged")
    page.get_by_text("the case in the address is damaged").wait_for()


def test_a_slow_solve_can_be_stopped(page):
    busy(page)
    page.get_by_role("button", name="Stop").click()
    solved(page, "converged on 129 × 129")


def test_a_tab_that_closes_while_it_loads_prints_nothing(served):
    parts = urlsplit(served.address)
    script = re.search(r'/_nicegui/[^"]+\.js', status_of(served.address)[1])[0]
    request = f"GET {script}?{parts.query} HTTP/1.1\r\nHost: {parts.netloc}\r\n\r\n".encode()
    for wait in (0.0, 0.002, 0.004, 0.008):
        with socket.create_connection((parts.hostname, parts.port)) as closed:
            closed.sendall(request)
            time.sleep(wait)
    assert status_of(served.address)[0] == 200
    assert "Traceback" not in served.errors()


def test_a_link_that_is_too_long_is_a_sentence(served):
    for length in (70_000, 1_000_000):
        code, text = status_of(f"{served.address}&case={'a' * length}")
        assert code == 414
        assert "open the case as a file" in text


def test_ctrl_c_leaves_nothing_behind_and_a_tab_names_the_address_of_the_next_page(
    browser, tmp_path, compiled
):
    del compiled
    context = browser.new_context(reduced_motion="reduce")
    context.set_default_timeout(PATIENCE)
    for name in ("first", "second"):
        (tmp_path / name).mkdir()
    first = Served(folder=tmp_path / "first")
    port = str(urlsplit(first.address).port)
    page = opened(context, first.address)
    end(first, tmp_path / "first")
    page.get_by_text("The page has ended").wait_for()
    second = Served("--port", port, folder=tmp_path / "second")
    page.get_by_text("Open the new address").wait_for()
    context.close()
    end(second, tmp_path / "second")


def end(server, folder):
    """End a server by Ctrl-C; its workers and files are gone then."""
    until(server.workers)
    workers = server.workers()
    assert server.end() == 0
    until(lambda: not any(Path(f"/proc/{pid}").exists() for pid in workers), 10)
    assert [path.name for path in folder.iterdir()] == ["explore.log"]
    assert "Traceback" not in server.messages


def test_one_main_and_nothing_to_click_below_24_pixels(page):
    assert page.locator("main").count() == 1
    small = page.evaluate(
        """() => [...document.querySelectorAll(
            'button, .q-slider, [role=tab], [role=switch], .q-field__control, .q-item')]
        .filter(one => one.offsetParent)
        .map(one => [one.getAttribute('aria-label') || one.className,
                     ...['width', 'height'].map(k => one.getBoundingClientRect()[k])])
        .filter(([, width, height]) => Math.min(width, height) < 24)"""
    )
    assert small == []
