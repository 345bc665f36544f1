"""``tehl reproduce`` on the command line, and a run that is killed."""

import os
import re
import signal
import subprocess
import sys

import pytest

COMMAND = [sys.executable, "-m", "tehl", "reproduce"]


def told(*arguments, folder):
    return subprocess.run(
        [*COMMAND, "-o", "out", *arguments], cwd=folder, capture_output=True, text=True, check=False
    )


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--only", "T9"], "T9 is no table, figure or statement"),
        (["--only", "T2,Z1"], "Z1 is no table, figure or statement"),
        (["--points", "66", "--only", "T1"], "points = 66: cannot be coarsened"),
    ],
)
def test_bad_input_is_one_sentence_and_writes_nothing(tmp_path, arguments, words):
    ended = told(*arguments, folder=tmp_path)
    assert ended.returncode == 2
    assert ended.stdout == ""
    assert len(ended.stderr.splitlines()) == 1
    assert words in ended.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_a_killed_run_goes_on_where_it_was(tmp_path):
    arguments = [*COMMAND, "-o", "out", "--only", "T2", "--points", "65", "--jobs", "2"]
    finished = 0
    with subprocess.Popen(
        arguments, cwd=tmp_path, stderr=subprocess.PIPE, text=True, start_new_session=True
    ) as first:
        assert first.stderr is not None
        for line in first.stderr:
            finished += "/35" in line
            if finished == 6:
                break
        os.killpg(first.pid, signal.SIGKILL)
    ended = told("--only", "T2", "--points", "65", "--jobs", "2", folder=tmp_path)
    assert ended.returncode == 0, ended.stderr
    before = re.search(r"35 contacts, (\d+) of them solved before", ended.stderr)
    assert before is not None
    assert 6 <= int(before[1]) < 35
    assert (tmp_path / "out" / "index.html").is_file()
