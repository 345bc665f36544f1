"""Lanes: eight numbers that a compiled kernel handles as one vector register.

A kernel that applies a formula to many rows takes `LANES` of them at a time and states the formula
as for one number. Interpreted, lanes are numpy arrays of eight numbers. Compiled, each operation is
one vector instruction, so that LLVM has no loop to vectorise, which makes kernels and their
compilation fast (docs/dev/kernels.md).

Lanes support ``+ - * /``, comparisons, ``&`` of masks, ``abs(x)``, ``x[lane]`` and the functions
below, also beside plain numbers. Raw arrays load and store them (`tehl.kernels.raw`).
"""

import operator
from collections.abc import Callable
from itertools import product
from typing import Any

import numpy as np
from llvmlite import ir
from numba.core import types
from numba.core.cgutils import get_or_insert_function
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import lower_builtin, lower_cast, models, register_model

from tehl.base.typing import Array, BoolArray

LANES = 8

Lanes = Array
"""Eight numbers, (8,)."""
Mask = BoolArray
"""Eight truth values, (8,)."""


def where(mask: Mask, yes: Lanes | float, no: Lanes | float) -> Lanes:
    """Return ``yes`` where ``mask`` holds, ``no`` elsewhere."""
    return np.where(mask, yes, no)


def lesser(a: Lanes | float, b: Lanes | float) -> Lanes:
    """Return the smaller one, ``b`` where ``a`` is NaN."""
    return np.where(np.less(a, b), a, b)


def greater(a: Lanes | float, b: Lanes | float) -> Lanes:
    """Return the larger one, ``b`` where ``a`` is NaN."""
    return np.where(np.greater(a, b), a, b)


def root(x: Lanes) -> Lanes:
    """Return the square root."""
    return np.sqrt(x)


def log(x: Lanes) -> Lanes:
    """Return the natural logarithm."""
    return np.log(x)


def truncate(x: Lanes) -> Lanes:
    """Return the integer part."""
    return np.trunc(x)


def power_of_two(shifted: Lanes) -> Lanes:
    """Return 2^n, n being the integer in the low bits of ``shifted`` (1.5 2^52 was added to it)."""
    return ((shifted.view(np.int64) + 1023) << 52).view(np.float64)


def largest(x: Lanes) -> float:
    """Return the largest number."""
    return float(max(x))


def any_of(mask: Mask) -> bool:
    """Return whether the mask holds in any lane."""
    return bool(np.any(mask))


def lookup(table: Array, rows: Lanes) -> tuple[Lanes, Lanes, Lanes, Lanes]:
    """Return both columns of ``table`` (m, 2) in row ``int(rows)``, then in the row behind it."""
    flat, first = table.ravel(), 2 * rows.astype(np.int64)
    return flat[first], flat[first + 1], flat[first + 2], flat[first + 3]


# The low-level extension interface of numba: a typing rule and LLVM instructions for each.

DOUBLE, INT, LONG = ir.DoubleType(), ir.IntType(32), ir.IntType(64)
VECTOR, LONGS = ir.VectorType(DOUBLE, LANES), ir.VectorType(LONG, LANES)
CONTRACT = ("contract",)  # a b + c may be one instruction


class VectorType(types.Type):
    """Type of lanes or of a mask."""

    def __init__(self, name: str, llvm: Any) -> None:
        self.llvm = llvm
        super().__init__(name=name)


class LanesType(VectorType):
    """Type of lanes."""


LANES_TYPE = LanesType("Lanes", VECTOR)
MASK_TYPE = VectorType("Mask", ir.VectorType(ir.IntType(1), LANES))


@register_model(VectorType)
@register_model(LanesType)
class _Model(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, kind.llvm)


def typing_rule(symbol: Any, rule: Callable[..., Any]) -> None:
    """Register ``rule(*operands)``, which returns the type of the result, or None."""

    class Template(AbstractTemplate):
        """Numba's form of the rule."""

        def generic(self, operands: Any, keywords: Any) -> Any:
            """Return the signature, or None."""
            result = None if keywords else rule(*operands)
            return None if result is None else signature(result, *operands)

    infer_global(symbol)(Template)


def _equal_constants(kind: Any, value: float) -> Any:
    """Return a vector of equal constants."""
    return ir.Constant(kind, [value] * LANES)


def as_lanes(context: Any, builder: Any, kind: Any, value: Any) -> Any:
    """Return an operand as a vector: a number in all lanes."""
    if isinstance(kind, VectorType):
        return value
    number = context.cast(builder, value, kind, types.float64)
    empty = ir.Constant(VECTOR, ir.Undefined)
    first = builder.insert_element(empty, number, ir.Constant(INT, 0))
    return builder.shuffle_vector(first, empty, _equal_constants(ir.VectorType(INT, LANES), 0))


@lower_cast(types.Number, LanesType)
def _cast(context: Any, builder: Any, kind: Any, _target: Any, value: Any) -> Any:
    return as_lanes(context, builder, kind, value)


def _define(symbol: Any, result: Any, code: Callable[..., Any], operands: int = 2) -> None:
    """Define ``symbol`` for vectors and numbers; ``code(builder, *vectors)`` emits it."""

    def rule(*kinds: Any) -> Any:
        known = all(isinstance(kind, VectorType | types.Number) for kind in kinds)
        vectors = any(isinstance(kind, VectorType) for kind in kinds)
        return result if known and vectors and len(kinds) == operands else None

    def lower(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        pairs = zip(signature.args, arguments, strict=True)
        return code(builder, *(as_lanes(context, builder, kind, value) for kind, value in pairs))

    typing_rule(symbol, rule)
    for kinds in product((VectorType, types.Number), repeat=operands):
        if VectorType in kinds:  # numba looks the code up by classes
            lower_builtin(symbol, *kinds)(lower)


def _call(name: str) -> Callable[..., Any]:
    """Return the code of a function of LLVM on lanes."""

    def code(builder: Any, *values: Any) -> Any:
        kind = ir.FunctionType(VECTOR, [VECTOR] * len(values))
        function = get_or_insert_function(builder.module, kind, f"llvm.{name}.v{LANES}f64")
        return builder.call(function, values)

    return code


def _arithmetic(instruction: str) -> Callable[..., Any]:
    return lambda builder, a, b: getattr(builder, instruction)(a, b, flags=CONTRACT)


def _choice(predicate: str) -> Callable[..., Any]:
    return lambda builder, a, b: builder.select(builder.fcmp_ordered(predicate, a, b), a, b)


def _comparison(predicate: str) -> Callable[..., Any]:
    return lambda builder, a, b: builder.fcmp_ordered(predicate, a, b)


def _power_of_two(builder: Any, shifted: Any) -> Any:
    biased = builder.add(builder.bitcast(shifted, LONGS), _equal_constants(LONGS, 1023))
    return builder.bitcast(builder.shl(biased, _equal_constants(LONGS, 52)), VECTOR)


def _largest(builder: Any, x: Any) -> Any:
    result = builder.extract_element(x, ir.Constant(INT, 0))
    for lane in range(1, LANES):
        value = builder.extract_element(x, ir.Constant(INT, lane))
        result = builder.select(builder.fcmp_ordered(">", value, result), value, result)
    return result


def _any_of(builder: Any, mask: Any) -> Any:
    bits = builder.bitcast(mask, ir.IntType(LANES))
    return builder.icmp_unsigned("!=", bits, ir.Constant(ir.IntType(LANES), 0))


for _symbol, _instruction in (
    (operator.add, "fadd"),
    (operator.iadd, "fadd"),
    (operator.sub, "fsub"),
    (operator.isub, "fsub"),
    (operator.mul, "fmul"),
    (operator.imul, "fmul"),
    (operator.truediv, "fdiv"),
    (operator.itruediv, "fdiv"),
):
    _define(_symbol, LANES_TYPE, _arithmetic(_instruction))
for _function, _name in ((abs, "fabs"), (root, "sqrt"), (log, "log"), (truncate, "trunc")):
    _define(_function, LANES_TYPE, _call(_name), operands=1)
for _symbol, _predicate in (
    (operator.lt, "<"),
    (operator.gt, ">"),
    (operator.le, "<="),
    (operator.ge, ">="),
    (operator.eq, "=="),
):
    _define(_symbol, MASK_TYPE, _comparison(_predicate))
_define(operator.neg, LANES_TYPE, lambda builder, x: builder.fneg(x), operands=1)
_define(operator.and_, MASK_TYPE, lambda builder, a, b: builder.and_(a, b))
_define(lesser, LANES_TYPE, _choice("<"))
_define(greater, LANES_TYPE, _choice(">"))
_define(where, LANES_TYPE, lambda builder, *operands: builder.select(*operands), operands=3)
_define(power_of_two, LANES_TYPE, _power_of_two, operands=1)
_define(largest, types.float64, _largest, operands=1)
_define(any_of, types.boolean, _any_of, operands=1)
