"""Quantities of the stress below the surfaces, part of the table of `tehl.result.quantities`."""

from collections.abc import Callable, Iterator
from operator import attrgetter
from typing import Any

from tehl.result.quantity import Numbers, Quantity

_KEYS = {
    "shear_max_pa": "shear",
    "shear_max_error": "shear_error",
    "shear_max_depth_m": "shear_depth",
    "shear_max_x_m": "shear_x",
    "shear_max_y_m": "shear_y",
    "shear_max_ratio": "shear_ratio",
    "von_mises_max_pa": "von_mises",
    "von_mises_max_depth_m": "von_mises_depth",
    "orthogonal_shear_pa": "orthogonal",
    "orthogonal_shear_depth_m": "orthogonal_depth",
    "dang_van_pa": "dang_van",
    "dang_van_ratio": "dang_van_ratio",
    "life_ratio": "life_ratio",
    "life_ratio_error": "life_ratio_error",
    "at_shallowest": "at_shallowest",
    "traction": "traction",
    "thermal_pa": "thermal",
}
"""Keys of the numbers of a body, and what `tehl.post.stress.numbers` calls them."""
_SHOWN: dict[str, dict[str, Any]] = {
    "shear_max_pa": {
        "unit": "GPa",
        "symbol": "τ_max",
        "words": dict.fromkeys(
            ("axis", "list", "notebook", "report", "page"), "largest shear stress"
        ),
    },
    "shear_max_depth_m": {
        "unit": "um",
        "digits": "0.0",
        "words": dict.fromkeys(("axis", "list", "report"), "depth of the largest shear stress"),
    },
    "shear_max_ratio": {"words": {"axis": "largest shear stress over that of dry contact"}},
    "von_mises_max_pa": {
        "unit": "GPa",
        "words": dict.fromkeys(("axis", "report"), "largest stress of von Mises"),
    },
    "thermal_pa": {
        "unit": "GPa",
        "words": {"axis": "thermal stress of the surface", "report": "thermal stress"},
    },
    "life_ratio": {
        "words": dict.fromkeys(("axis", "list", "report"), "life over that of dry smooth contact")
    },
}
_BARS = {"shear_max_pa": "shear_max_error", "life_ratio": "life_ratio_error"}


def _error(path: str) -> Callable[[Numbers], float | None]:
    return lambda numbers: numbers.get(path)


def stress_quantities() -> Iterator[Quantity]:
    """Yield the quantities of the more stressed body, and of each body beside it."""
    for key, name in _KEYS.items():
        bar = _error(f"stress.{_BARS[key]}") if key in _BARS else None
        shown = _SHOWN.get(key, {})
        yield Quantity(f"stress.{key}", attrgetter(f"worse.{name}"), error=bar, **shown)
    yield Quantity("stress.body", attrgetter("worse.body"))
    for key in ("shallowest_m", "traction_left_out", "heat_left_out", "counts_roughness"):
        yield Quantity(f"stress.{key}")
    for body in (1, 2):
        for key, name in _KEYS.items():
            yield Quantity(f"stress.body_{body}.{key}", attrgetter(name))
