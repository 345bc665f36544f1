"""Run the commands that pages show, and keep what they print, so that samples cannot go stale."""

import subprocess
import sys
from pathlib import Path

COMMANDS = {
    "ball": ("ball-on-disc", ("--plot", "pictures")),
    "certified": ("ball-on-disc", ("--certify",)),
    "failure": ("ball-on-disc", ("--set", "numerics.points=33")),
    "thermal": ("thermal", ("--with-isothermal",)),
    "rough": ("rough", ("--with-smooth",)),
    "starved": ("starved", ()),
    "mixed": ("mixed", ()),
    "bearing": ("bearing", ("--plot", "pictures")),
    "gear": ("gear-ellipse", ("--plot", "pictures")),
}
"""By name of the sample: its template, and options of the solve."""


def make(folder: Path, newest: float) -> None:
    """Write case, explanation and result of each sample into ``folder``, unless they are newer."""
    for name, (template, options) in COMMANDS.items():
        place = folder / name
        place.mkdir(parents=True, exist_ok=True)
        done = place / "solve.txt"
        if done.exists() and done.stat().st_mtime > newest:
            continue
        (place / "case.toml").write_text(printed(place, "new", template), encoding="utf-8")
        explained = printed(place, "explain", "case.toml")
        (place / "explain.txt").write_text(explained, encoding="utf-8")
        solved = printed(place, "solve", "case.toml", "-o", "film.nc", "--quiet", *options)
        done.write_text(solved, encoding="utf-8")


def printed(place: Path, *words: str) -> str:
    """Return what ``tehl`` prints in a folder, of a solve that does not converge its message."""
    command = [sys.executable, "-m", "tehl", *words]
    done = subprocess.run(command, cwd=place, check=False, capture_output=True, text=True)
    if done.returncode == 1:
        return done.stderr.partition("\n")[2]  # after the name of the written file
    done.check_returncode()
    return done.stdout
