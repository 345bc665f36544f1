"""The command, run in the process of the tests."""

import sys
from types import SimpleNamespace

import pytest

from tehl import cli


@pytest.fixture
def run(monkeypatch, capsys):
    def call(*words: str) -> SimpleNamespace:
        monkeypatch.setattr(sys, "argv", ["tehl", *words])
        with pytest.raises(SystemExit) as end:
            cli.main()
        captured = capsys.readouterr()
        return SimpleNamespace(code=end.value.code or 0, out=captured.out, err=captured.err)

    return call
