"""The chromium of the system, which the browser tests and the benchmark of the page drive."""

import os
import shutil

NAMES = ("chromium", "chromium-browser", "google-chrome")
ARGUMENTS = (
    "--no-sandbox",  # in containers, where tests run as root
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)
"""A browser that calls nobody."""
FLAT = ("--disable-gpu", "--enable-unsafe-swiftshader")
"""It draws pages without a graphics card and without emulating one, which takes most of the time;
what is drawn in three dimensions is emulated."""


def executable() -> str | None:
    """Return the path of the browser, that of the variable CHROMIUM first; None without one."""
    stated = os.environ.get("CHROMIUM")
    return stated or next(filter(None, map(shutil.which, NAMES)), None)
