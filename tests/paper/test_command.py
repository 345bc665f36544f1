"""``python -m paper`` on the command line, and a run that is killed."""

import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from paper.__main__ import main

import paper

ROOT = Path(paper.__file__).parents[1]
COMMAND = [sys.executable, "-m", "paper", "-o"]


def run(folder, *arguments):
    return subprocess.run(
        [*COMMAND, str(folder / "out"), *arguments],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["T9"], "T9 is not a table, figure or conclusion"),
        (["T2", "Z1"], "Z1 is not a table, figure or conclusion"),
        (["--points", "66", "T1"], "points = 66: cannot be coarsened"),
    ],
)
def test_bad_input_is_one_sentence_and_writes_nothing(
    tmp_path, monkeypatch, capsys, arguments, words
):
    monkeypatch.setattr(sys, "argv", ["paper", "-o", str(tmp_path / "out"), *arguments])
    assert main() == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert len(printed.err.splitlines()) == 1
    assert words in printed.err
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_a_killed_run_continues(tmp_path):
    arguments = ["T2", "--points", "65", "--jobs", "2"]
    finished = 0
    with subprocess.Popen(
        [*COMMAND, str(tmp_path / "out"), *arguments],
        cwd=ROOT,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as first:
        assert first.stderr is not None
        for line in first.stderr:
            finished += "/35" in line
            if finished == 6:
                break
        os.killpg(first.pid, signal.SIGKILL)
    ended = run(tmp_path, *arguments)
    assert ended.returncode == 0, ended.stderr
    before = re.search(r"35 runs, (\d+) of them solved before", ended.stderr)
    assert before is not None
    assert 6 <= int(before[1]) < 35
    assert (tmp_path / "out" / "index.html").is_file()
