"""The command as a user meets it: output, exit codes, and what it does not load."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from typer._completion_classes import BashComplete
from typer.main import get_command

from tehl.cli import COMMANDS, application, main
from tehl.io.store import save
from tehl.io.templates import template_text, templates

HEAVY = ("numba", "scipy", "xarray", "matplotlib", "h5py", "pandas")


def run(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> int:
    """Return the exit code of ``tehl`` with ``arguments``, in this process."""
    monkeypatch.setattr(sys, "argv", ["tehl", *arguments])
    with pytest.raises(SystemExit) as ended:
        main()
    return int(ended.value.code or 0)


def loaded(*arguments: str) -> set[str]:
    """Return the top-level modules that ``tehl`` loads in a separate process."""
    script = (
        "import sys\n"
        "from tehl.cli import main\n"
        "try:\n    main()\n"
        "except SystemExit as end:\n    assert not end.code, end.code\n"
        "print(*{name.partition('.')[0] for name in sys.modules}, file=sys.stderr)\n"
    )
    command = [sys.executable, "-c", script, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=60)
    return set(done.stderr.split())


@pytest.fixture
def case(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path):
    run(monkeypatch, "new", "ball-on-disc")
    path = tmp_path / "case.toml"
    path.write_text(capsys.readouterr().out, encoding="utf-8")
    return path


def test_help_names_every_subcommand(monkeypatch, capsys):
    assert run(monkeypatch, "--help") == 0
    text = capsys.readouterr().out
    assert all(f"\n  {name} " in text for name in COMMANDS)


def test_help_loads_no_machinery():
    assert not loaded("--help") & {*HEAVY, "numpy", "pydantic", "rich"}


def test_explain_loads_no_machinery(case: Path):
    assert not loaded("explain", str(case)) & {*HEAVY, "rich"}


def test_explain_of_a_wave_loads_no_machinery(tmp_path: Path):
    path = tmp_path / "rough.toml"
    path.write_text(template_text("rough"), encoding="utf-8")
    assert not loaded("explain", str(path)) & {*HEAVY, "rich"}


def test_new_lists_its_templates(monkeypatch, capsys):
    assert run(monkeypatch, "new", "--list") == 0
    assert len(capsys.readouterr().out.splitlines()) == len(templates()) + len(templates("studies"))


def test_explain_prints_text_or_json(monkeypatch, capsys, case: Path):
    assert run(monkeypatch, "explain", str(case)) == 0
    assert capsys.readouterr().out
    assert run(monkeypatch, "explain", str(case), "--json", "--set", "contact.load=100 N") == 0
    assert json.loads(capsys.readouterr().out)["load_n"] == 100.0


def test_the_schema_is_json(monkeypatch, capsys):
    assert run(monkeypatch, "schema") == 0
    assert "contact" in json.loads(capsys.readouterr().out)["properties"]


def test_the_version_is_printed(monkeypatch, capsys):
    assert run(monkeypatch, "--version") == 0
    assert capsys.readouterr().out.startswith("tehl ")


def test_bad_input_is_one_line_and_exit_code_2(monkeypatch, capsys, case: Path):
    assert run(monkeypatch, "explain", str(case), "--set", "contact.load=80 mm") == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert len(printed.err.splitlines()) == 1
    assert "contact.load" in printed.err


def test_bad_input_is_an_object_with_json(monkeypatch, capsys, tmp_path: Path):
    assert run(monkeypatch, "explain", str(tmp_path / "none.toml"), "--json") == 2
    printed = json.loads(capsys.readouterr().out)
    assert printed["status"] == "bad_input"
    assert "case file does not exist" in printed["message"]


@pytest.mark.parametrize("arguments", [("explain",), ("explain", "--nonsense"), ("nonsense",)])
def test_a_wrong_command_line_is_exit_code_2(monkeypatch, arguments: tuple[str, ...]):
    assert run(monkeypatch, *arguments) == 2


@pytest.mark.parametrize(
    ("arguments", "what"),
    [
        (("solve", "--bogus"), "--bogus"),
        (("solve",), "argument"),
        (("nonsense",), "nonsense"),
        (("export", "a.nc"), "--json"),
        (("solve", "--" + "x" * 9999), "..."),
    ],
)
def test_a_wrong_command_line_is_one_line_and_an_object(monkeypatch, capsys, arguments, what):
    assert run(monkeypatch, *arguments, "--json") == 2
    printed = capsys.readouterr()
    assert len(printed.err.splitlines()) == 1
    assert len(printed.err) < 400
    assert "--help" in printed.err
    assert json.loads(printed.out)["status"] == "bad_input"
    assert what in printed.err


def test_a_closed_pipe_is_not_an_error():
    command = f"{sys.executable} -m tehl schema | {sys.executable} -c pass; exit ${{PIPESTATUS[0]}}"
    done = subprocess.run(
        ["bash", "-c", command], capture_output=True, text=True, check=False, timeout=60
    )
    assert done.returncode in (0, 141)  # 0 when all went into the pipe before its end closed
    assert done.stderr == ""


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
def test_a_full_disk_behind_stdout_is_reported_in_one_line():
    command = f"{sys.executable} -m tehl schema > /dev/full"
    done = subprocess.run(
        ["bash", "-c", command], capture_output=True, text=True, check=False, timeout=60
    )
    assert done.returncode == 3
    assert len(done.stderr.splitlines()) == 1
    assert "No space left" in done.stderr


def test_a_broken_environment_is_exit_code_3(monkeypatch, capsys):
    def broken(**_: object) -> None:
        raise PermissionError(13, "Permission denied", "/cache")

    monkeypatch.setattr("tehl.cli.application", lambda: broken)
    assert run(monkeypatch, "doctor") == 3
    assert "Permission denied" in capsys.readouterr().err


def test_a_missing_package_is_exit_code_3(monkeypatch, capsys):
    def broken(**_: object) -> None:
        raise ModuleNotFoundError("No module named 'numba'", name="numba")

    monkeypatch.setattr("tehl.cli.application", lambda: broken)
    assert run(monkeypatch, "doctor") == 3
    assert "numba is not installed" in capsys.readouterr().err


def test_python_runs_the_package_as_the_command():
    command = [sys.executable, "-m", "tehl", "--version"]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=60)
    assert done.stdout.startswith("tehl ")


def _completing(tmp_path: Path, *arguments: str, **environment: str):
    """Run ``tehl`` with another home and no detection of the shell."""
    names = {"HOME": str(tmp_path), "_TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION": "1"}
    command = [sys.executable, "-c", "from tehl.cli import main; main()", *arguments]
    env = os.environ | names | environment
    return subprocess.run(command, capture_output=True, text=True, env=env, check=False, timeout=60)


def completed(*words: str) -> list[str]:
    """Return what the shell offers in place of the last of ``words``."""
    command = get_command(application())
    shell = BashComplete(command, {}, "tehl", "_TEHL_COMPLETE")
    return [one.value for one in shell.get_completions(list(words[:-1]), words[-1])]


def test_the_shell_completes_templates():
    assert completed("new", "st") == ["starved", "stress", "stribeck", "starvation-curve"]
    assert completed("new", "") == [*templates(), *templates("studies")]


def test_the_shell_completes_pictures_of_a_result(result, tmp_path):
    stored = str(tmp_path / "ball.nc")
    save(result, stored)
    assert completed("plot", stored, "--only", "pr") == ["pressure", "pressure_surface"]
    assert completed("plot", "--only", "film,pressure", "--only", "x") == []
    assert completed("plot", stored, "--only", "film,ce") == ["film,centre_lines"]
    assert completed("plot", str(tmp_path / "none.nc"), "--only", "f") == []


def test_the_shell_completes_subcommands_once_installed(tmp_path):
    done = _completing(tmp_path, "--install-completion", "bash")
    assert done.returncode == 0, done.stderr
    assert "_TEHL_COMPLETE" in (tmp_path / ".bash_completions" / "tehl.sh").read_text()
    words = {"COMP_WORDS": "tehl solv", "COMP_CWORD": "1", "_TEHL_COMPLETE": "complete_bash"}
    assert _completing(tmp_path, **words).stdout.split() == ["solve"]
