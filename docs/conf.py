"""Sphinx settings; ``make docs`` builds the documentation with warnings as errors."""

import re
import sys
from pathlib import Path
from typing import Any

from sphinx.pycode import ModuleAnalyzer

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))

import figures  # noqa: E402
import gallery  # noqa: E402
import notebook  # noqa: E402
import samples  # noqa: E402

import tehl  # noqa: E402

project = "tehl"
author = "The tehl developers"
project_copyright = author
version = release = tehl.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.mathjax",
    "sphinx-mathjax-offline",  # formulas need no network
]
myst_enable_extensions = ["dollarmath", "amsmath", "deflist", "colon_fence"]
myst_heading_anchors = 3
napoleon_google_docstring = False
napoleon_use_ivar = True
napoleon_use_rtype = False
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
python_maximum_signature_line_length = 90
autodoc_member_order = "bysource"
toc_object_entries_show_parents = "hide"
exclude_patterns = ["_build"]

html_theme = "pydata_sphinx_theme"
html_title = f"tehl {version}"
html_static_path = ["_static"]
html_css_files = ["wide.css"]
html_show_sourcelink = False
html_theme_options = {
    "navigation_with_keys": False,
    "show_prev_next": True,
    "secondary_sidebar_items": ["page-toc"],
}


def fields(thing: type) -> list[str]:
    """Return a section with the fields of a class, which are described where they are declared.

    A description below several fields is that of all of them.
    """
    lines: list[str] = []
    for one in reversed(thing.__mro__):
        if not one.__module__.startswith("tehl"):
            continue
        found = ModuleAnalyzer.for_module(one.__module__)
        found.analyze()
        group: list[str] = []
        for name in getattr(one, "__annotations__", {}):
            group.append(name)
            described = found.attr_docs.get((one.__qualname__, name))
            if described:
                kind = found.annotations.get((one.__qualname__, name), "")
                lines += [f"{', '.join(group)} : {kind}", *(f"    {line}" for line in described)]
                group = []
    return ["", "Attributes", "----------", *lines] if lines else []


def adapt(*arguments: Any) -> None:
    """Adapt a numpydoc docstring to napoleon: references, names that share a line, ``|u_s|``."""
    _, what, _, thing, _, lines = arguments
    if what == "class":
        lines += fields(thing)
    lines[:] = [re.sub(r"(?<![`\w])\|(\w+)\|(?![`\w])", r"\|\1\|", line) for line in lines]
    lines[:] = [re.sub(r"^\.\. \[(\d+)\] ", r"\1. ", line).replace("]_", "]") for line in lines]
    lines[:] = [re.sub(r"(?<=\w), (?=[\w, ]+ : )", ",", line) for line in lines]


def setup(app: Any) -> None:
    """Connect the hooks that run before docstrings are parsed."""
    app.connect("autodoc-process-docstring", adapt, priority=400)
    app.connect(
        "autodoc-process-signature", lambda _app, what, *_: ("", None) if what == "class" else None
    )


figures.make(HERE / "theory" / "figures")
gallery.make(HERE.parent / "examples", HERE / "gallery")
samples.make(HERE / "samples", gallery.newest(HERE / "samples.py"))
samples.make_list(HERE / "samples", gallery.newest(HERE / "samples.py"))
notebook.make(HERE.parent / "examples" / "tutorial.ipynb", HERE / "tutorials" / "notebook.md")
