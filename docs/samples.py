"""Run the commands that pages show, and keep what they print, so that samples cannot go stale."""

import runpy
import subprocess
import sys
from pathlib import Path

import pandas as pd

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
    "rib": ("rib", ("--plot", "pictures")),
}
"""By name of the sample: its template, and options of the solve."""
EXAMPLE = Path(__file__).parents[1] / "examples" / "bearing_list.py"
SHOWN = {
    "ring": "ring",
    "radial load": "load",
    "u_m [m/s]": "u_m [m/s]",
    "Hertz pressure [GPa]": "p_h [GPa]",
    "minimum film [nm]": "h_min [nm]",
    "lambda": "lambda",
    "regime": "regime",
}
"""Columns of the answers that the tutorial shows, and their headings there."""


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


def make_list(folder: Path, newest: float) -> None:
    """Write the list of a bearing's contacts and its answers into ``folder``, unless newer."""
    place = folder / "list"
    place.mkdir(parents=True, exist_ok=True)
    done = place / "films.txt"
    if done.exists() and done.stat().st_mtime > newest:
        return
    example = runpy.run_path(str(EXAMPLE))
    contacts = example["rows"]([500.0, 1e3], [3000.0, 9000.0])
    contacts.round(4).to_csv(place / "rings.csv", index=False)
    (place / "case.toml").write_text(printed(place, "new", "bearing"), encoding="utf-8")
    printed(place, "contacts", "rings.csv", "-o", "films.csv", "--template", "case.toml", "--quiet")
    films = pd.read_csv(place / "films.csv")
    shown = films[list(SHOWN)].rename(columns=SHOWN)
    done.write_text(shown.to_string(index=False, float_format="%.4g"), "utf-8")


def printed(place: Path, *words: str) -> str:
    """Return what ``tehl`` prints in a folder, of a solve that does not converge its message."""
    command = [sys.executable, "-m", "tehl", *words]
    done = subprocess.run(command, cwd=place, check=False, capture_output=True, text=True)
    if done.returncode == 1:
        return done.stderr.partition("\n")[2]  # after the name of the written file
    done.check_returncode()
    return done.stdout
