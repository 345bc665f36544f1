"""The command that opens the live page, until it serves."""

import importlib.util
import socket

import pytest

from tehl.base.errors import InputError
from tehl.cli import explore
from tehl.io.templates import template_text


def test_a_case_that_is_not_valid_is_a_sentence_before_a_page_opens(tmp_path):
    case = tmp_path / "case.toml"
    case.write_text(template_text("ball-on-disc").replace('"80 N"', '"-80 N"'))
    with pytest.raises(InputError, match="must be positive"):
        explore.explore(case, browser=False)


def test_a_missing_extra_says_how_to_install_it(monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name == "nicegui" else 1)
    with pytest.raises(InputError, match=r"needs nicegui: install .* 'tehl\[explore\]'"):
        explore.explore(browser=False)


def test_a_port_that_is_taken_is_a_sentence(run):
    pytest.importorskip("nicegui")
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        found = run("explore", "--no-browser", "--port", str(port))
    assert found.code == 2
    assert found.out == ""
    assert found.err.startswith(f"tehl: port {port} is taken")
