"""The kernels of a solve and the types of their arguments, for which numba compiles them.

The types follow from the annotations: an array has two axes and the element of its annotation,
unless the sample gives the number of axes, or an array of the same type, by name. A test checks
that no solve compiles more.
"""

from collections.abc import Callable
from typing import Any, NamedTuple, get_args, get_type_hints

import numpy as np
from numba import typeof, types

from tehl.kernels import (
    cavities,
    coarsest,
    properties,
    relaxation,
    reynolds,
    summation,
    summits,
    transfer,
)
from tehl.kernels.energy import march, records, streams, trail

NUMBERS = {int: types.int64, float: types.float64, bool: types.boolean}


class Sample(NamedTuple):
    """A kernel, about how long it takes to compile [s], and its array types by name."""

    kernel: Any
    seconds: float
    arrays: dict[str, Any]

    @property
    def name(self) -> str:
        """Name of the kernel."""
        return str(self.kernel.__name__)

    def compile(self) -> None:
        """Load the machine code from the cache; compile it if it is missing."""
        hints = get_type_hints(self.kernel.py_func, include_extras=True)
        hints.pop("return")
        self.kernel.compile(
            tuple(_type_of(hint, name, self.arrays) for name, hint in hints.items())
        )


def _type_of(hint: Any, name: str, arrays: dict[str, Any]) -> Any:
    """Return the type of an argument, or of a part of it.

    Parameters
    ----------
    hint : type
        Annotation.
    name : str
        Name of the argument or of the part.
    arrays : dict
        By name: the number of axes, or an array of the same type.
    """
    given = arrays.get(name, 2)
    if not isinstance(given, int):
        return typeof(given)
    if hasattr(hint, "__metadata__"):  # an array (`tehl.base.typing`)
        return types.Array(getattr(types, hint.__metadata__[0]), given, "C")
    if hint in NUMBERS:
        return NUMBERS[hint]
    fields = getattr(hint, "_fields", None)
    if fields is None:
        parts = [_type_of(part, name, arrays) for part in get_args(hint)]
        return types.BaseTuple.from_types(parts)
    hints = get_type_hints(hint, include_extras=True)
    return types.BaseTuple.from_types([_type_of(hints[one], one, arrays) for one in fields], hint)


def _axes(count: int, *names: str) -> dict[str, int]:
    return dict.fromkeys(names, count)


def _sample(kernel: Callable[..., Any], seconds: float, **arrays: Any) -> Sample:
    lines = _axes(1, "layer", "ends", "speed", "south", "north")
    return Sample(kernel, seconds, lines | arrays)


_SURFACE = _axes(1, "decay", "older", "newer", "slowness")
_COMPLEX = np.empty((0, 0), complex)
_NODES = relaxation.empty_systems(0).nodes
_SCRATCH = records.scratch(1, records.BLOCK, 1)
ISOTHERMAL = (
    _sample(
        relaxation.relax_lines, 2.4, nodes=_NODES, **_axes(3, "point", "dipole", "parts", "cells")
    ),
    *(
        _sample(
            step,
            1.0,
            **_axes(
                1,
                *coarsest.Coarse._fields,
                *coarsest.Conductance._fields,
                *coarsest.Work._fields,
                *("residual", "frozen", "area", "missing"),
            )
            | _axes(2, "matrix"),
        )
        for step in (coarsest.fill_step, coarsest.take_step)
    ),
    _sample(summation.spread_columns, 0.9),
    _sample(summation.spread_rows, 0.7),
    _sample(reynolds.residual, 0.5),
    _sample(properties.properties, 0.4),
    _sample(summation.gather_rows, 0.3),
    _sample(reynolds.operator, 0.3),
    _sample(transfer.restrict_pressure, 0.3),
    _sample(summation.gather_columns, 0.3),
    _sample(summation.sum_across, 0.3, lines=_COMPLEX, out=_COMPLEX),
    _sample(summation.direct, 0.3, flat=1),
    _sample(summation.split_columns, 0.2),
    _sample(transfer.restrict_residual, 0.2),
    _sample(transfer.correct, 0.2),
    _sample(transfer.freeze, 0.2),
)
"""Of all films."""
COUPLED = (
    _sample(
        march.sweep,
        6.0,
        lines=_SCRATCH.lines,
        layers=_SCRATCH.layers,
        numbers=4,
        **_axes(1, "zeta", "weights", "changes", "change", "back", "x", "y", "closer") | _SURFACE,
        **_axes(3, "fluid", "temperature", "past", "matrix", "mass", "modes"),
    ),
    _sample(reynolds.tangent_source, 0.4),
    _sample(properties.factors_of, 0.4),
    _sample(properties.heated_properties, 0.4),
    _sample(
        streams.follow, 0.4, **_axes(1, "weight", "rate"), **_axes(3, "rows", "weights", "carried")
    ),
    _sample(trail.carry, 0.4, modes=4, fluxes=3, **_SURFACE),
)
"""Of heated and shear-thinning films, besides."""
RARE = (
    _sample(summits.touch, 0.7, grid=1),
    _sample(relaxation.stiffen, 0.4),
    _sample(relaxation.relax_points, 0.4, self_film=1),
    _sample(reynolds.diagonal, 0.3),
    _sample(cavities.mark_partial, 0.5),
    _sample(cavities.mark_second_order, 0.2),
    _sample(cavities.keep_to_fronts, 0.2),
    _sample(cavities.oil_flow, 0.3),
    _sample(transfer.keep_residual, 0.2),
    _sample(transfer.correct_fronts, 0.2),
    _sample(trail.carry_varying, 0.4, modes=4, fluxes=4, weights=1, **_SURFACE),
)
"""Of relaxation settings and starved films that few need; compiled when a solve first calls one."""
