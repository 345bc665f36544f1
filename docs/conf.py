"""Settings of the documentation; ``make docs`` builds it with warnings as errors."""

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))

import figures  # noqa: E402
import gallery  # noqa: E402

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
]
myst_enable_extensions = ["dollarmath", "amsmath", "deflist", "colon_fence"]
myst_heading_anchors = 3
napoleon_google_docstring = False
napoleon_use_ivar = True
napoleon_use_rtype = False
autodoc_typehints = "none"
autodoc_member_order = "bysource"
autodoc_class_signature = "separated"
add_module_names = False
exclude_patterns = ["_build"]

html_theme = "pydata_sphinx_theme"
html_title = f"tehl {version}"
html_static_path = ["_static"]
html_show_sourcelink = False
html_theme_options = {
    "navigation_with_keys": False,
    "show_prev_next": True,
    "secondary_sidebar_items": ["page-toc"],
}

figures.make(HERE / "theory" / "figures")
gallery.make(HERE.parent / "examples", HERE / "gallery")
