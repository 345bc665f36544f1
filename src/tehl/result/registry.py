"""How the table of quantities is read: what a place shows, error bars, columns, numbers."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from tehl.result import quantities
from tehl.result.quantity import FILMS, Certified, Quantity

LISTS = ("roughness.waves", "roughness.film_quantiles", "dynamics.over_frequency")
"""Blocks that are lists of blocks."""
OWNERS: dict[str, Callable[[Any], Any]] = {
    "laws": lambda found: found.solution.problem,
    "domain": lambda found: found.solution.scaled,
    "groups": lambda found: found.solution,
    "film": lambda found: found,
    "pressure": lambda found: found.solution,
    "temperature": lambda found: found.temperature,
    "traction": lambda found: found.traction,
    "traction.surroundings": lambda found: found.traction and found.traction.surroundings,
    "rolling": lambda found: found.rolling,
    "heat": lambda found: found.solution.heat,
    "bodies": lambda found: found.bodies,
    "roughness": lambda found: found.rough,
    "roughness.film_quantiles": lambda found: found.rough and found.rough.quantiles,
    "roughness.ripples_x": lambda found: found.rough and found.rough.ripples_x,
    "roughness.ripples_y": lambda found: found.rough and found.rough.ripples_y,
    "roughness.waves": lambda found: found.rough and found.rough.waves,
    "load_sharing": lambda found: found.load_sharing,
    "load_sharing.spots": lambda found: found.load_sharing and found.load_sharing.spots,
    "touching": lambda found: found.touching,
    "touching.patches": lambda found: (
        found.touching.patches if found.touching and found.touching.is_share_known else None
    ),
    "starvation": lambda found: found.starvation,
    "stress": lambda found: found.stress,
    "stress.body_1": lambda found: found.stress and found.stress.of(1),
    "stress.body_2": lambda found: found.stress and found.stress.of(2),
    "dynamics": lambda found: found.solution.dynamics,
    "dynamics.over_frequency": lambda found: (
        found.solution.dynamics and found.solution.dynamics.rows
    ),
    "convergence": lambda found: found,
    "errors": lambda found: found.solution.errors,
    "cost": lambda found: found.solution,
}
"""Owner of each block, from a result with what follows from it; a block without one is null. A
list of owners gives a list of blocks."""
_FIRST: dict[str, tuple[str, ...]] = {
    "list": (
        *("groups.hertz_pressure_pa", "groups.hertz_half_width_m", "groups.hertz_half_width_y_m"),
        *("groups.M", "groups.L", "film.h_central_m", "film.h_min_m", "pressure.max_pa"),
        *("roughness.lambda_central", "kappa", "friction", "power"),
    ),
    "notebook": ("film.h_central_m", "film.h_min_m", "pressure.max_pa", "traction.mid_film"),
    "line": ("film.h_central_m",),
    "report": ("film.h_min_m", "film.h_central_m", "pressure.max_pa", "traction.mid_film"),
    "page": (
        *("film.h_central_m", "film.h_min_m", "roughness.lambda_central", "kappa"),
        "pressure.max_pa",
    ),
}
"""Quantities that stand first in a place, in this order; the others follow their block, or all, in
the order of the table."""
_BARS_OF = (
    "pressure",
    "traction",
    "rolling",
    "temperature",
    "load_sharing",
    "touching",
    "roughness",
    "heat",
)
"""Blocks in the order of their error bars in the summary."""


def bar_names() -> tuple[str, ...]:
    """Return the names of the error bars beside those of the film, in their order."""
    found = {
        one.name: _BARS_OF.index(block) if (block := one.block) in _BARS_OF else len(_BARS_OF)
        for one in reversed(quantities.QUANTITIES)
        if one.name and one.name not in FILMS
    }
    names = dict.fromkeys(one.name for one in quantities.QUANTITIES if one.name in found)
    return tuple(sorted(names, key=found.__getitem__))


def in_summary() -> Iterator[Quantity]:
    """Yield the quantities of the summary in its order, with all error bars."""
    for one in quantities.QUANTITIES:
        if one.path == "errors.extrapolated":
            for name in bar_names():
                yield Quantity(f"errors.{name}", partial(_bar, name))
        if one.block:
            yield one


def _bar(name: str, errors: Any) -> float | None:
    known: float | None = errors.bars.get(name)
    return known


def columns() -> tuple[str, ...]:
    """Return the names that the numbers of a summary may have in a table; ``.0`` is any index."""
    lists = [f"{block}." for block in LISTS]
    return tuple(
        next((f"{block}0.{one.key}" for block in lists if one.path.startswith(block)), one.path)
        for one in in_summary()
    )


def shown_in(place: str) -> tuple[Quantity, ...]:
    """Return the quantities that a place shows, in its order."""
    known = {one.path: one for one in quantities.QUANTITIES if place in one.words}
    ordered = [known.pop(path) for path in _FIRST.get(place, ()) if path in known]
    for one in known.values():
        of_block = [
            k for k, other in enumerate(ordered, 1) if one.block and other.block == one.block
        ]
        ordered.insert(of_block[-1] if of_block else len(ordered), one)
    return tuple(ordered)


def at(path: str) -> Quantity:
    """Return the quantity at a place of the summary, or one that follows from others."""
    return next(one for one in quantities.QUANTITIES if one.path == path)


def named(name: str) -> Quantity:
    """Return the quantity in SI of an estimate of a certified result, steady or transient."""
    known = [one for one in (*quantities.QUANTITIES, *quantities.TRANSIENT) if one.name == name]
    return next((one for one in known if one.unit), known[0])


def dimensionless(one: Quantity) -> Quantity | None:
    """Return the same quantity over its scale, None where the summary does not have it."""
    if not (one.name and one.unit):
        return None
    others = (
        other
        for other in quantities.QUANTITIES
        if (other.name, other.block) == (one.name, one.block)
    )
    return next((other for other in others if other.certified and not other.unit), None)


def certified(*kinds: Certified) -> tuple[Quantity, ...]:
    """Return the quantities with a bar in a certified result, all or those of some kinds."""
    return tuple(
        one
        for one in quantities.QUANTITIES
        if one.certified and (one.certified in kinds or not kinds)
    )


class NumbersOf:
    """Numbers of a result by path, each computed when it is asked for."""

    def __init__(self, found: Any) -> None:
        """Take a result with what follows from it (`tehl.post.following.Following`)."""
        self._found = found
        self._known = {one.path: one for one in in_summary()}
        self._known |= {one.path: one for one in quantities.QUANTITIES if not one.block}

    def get(self, path: str, /) -> Any:
        """Return a number in SI, None where the result does not have it."""
        one = self._known.get(path)
        if one is None:
            return None
        return one.of(OWNERS[one.block](self._found) if one.block else self)
