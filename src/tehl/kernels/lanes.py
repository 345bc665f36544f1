"""Lanes: eight numbers side by side that compiled kernels treat as one.

A kernel that handles the same formula at many points takes them by `LANES` at a time: it loads
lanes from an array, computes with ``+ - * /`` as if they were single numbers (single numbers may
stand beside them), and stores them. The compiler then has vector instructions to begin with and
need not look for loops that it may rewrite, which makes both the program and its compilation fast.

Kernels of lanes know arrays by their `addresses`, as flat (C order), and positions in them as
offsets of the first number: compiled code then counts no references to them. Nothing is checked:
whoever uses lanes pads the arrays to whole lanes.
"""
# ruff: noqa: ARG001 (the compiler states the arguments)

import operator
from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np
from llvmlite import ir  # type: ignore[import-untyped]
from numba import extending
from numba.core import types
from numba.core.cgutils import get_or_insert_function
from numba.extending import lower_builtin, models, register_model, type_callable

LANES = 8

Record = TypeVar("Record")

intrinsic: Any = extending.intrinsic  # what it makes of a function has other arguments

_DOUBLE, _INT, _LONG = ir.DoubleType(), ir.IntType(32), ir.IntType(64)
_VECTOR = ir.VectorType(_DOUBLE, LANES)
_CONTRACT = ("contract",)  # a b + c may be one instruction


def addresses(record: Record) -> Record:
    """Return a record or tuple with the addresses of arrays in their place, however deep.

    Whoever calls a kernel with it holds the arrays meanwhile.
    """
    if isinstance(record, np.ndarray):
        if record.dtype != np.float64 or not record.flags.c_contiguous:
            raise TypeError("lanes need contiguous arrays of float64")
        return record.ctypes.data  # type: ignore[return-value]
    if isinstance(record, tuple):
        parts = [addresses(part) for part in record]
        kind: Any = type(record)
        return kind._make(parts) if hasattr(kind, "_make") else kind(parts)
    return record


class LanesType(types.Type):
    """Type of lanes as the compiler knows it."""

    def __init__(self) -> None:
        super().__init__(name="Lanes")


LANES_TYPE = LanesType()


@register_model(LanesType)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, dmm: Any, fe_type: Any) -> None:
        super().__init__(dmm, fe_type, _VECTOR)


def _spread(builder: Any, number: Any) -> Any:
    """Return lanes that all hold one number."""
    first = builder.insert_element(ir.Constant(_VECTOR, ir.Undefined), number, ir.Constant(_INT, 0))
    mask = ir.Constant(ir.VectorType(_INT, LANES), [0] * LANES)
    return builder.shuffle_vector(first, ir.Constant(_VECTOR, ir.Undefined), mask)


def _lanes(context: Any, builder: Any, kind: Any, value: Any) -> Any:
    """Return any operand as lanes."""
    if isinstance(kind, LanesType):
        return value
    return _spread(builder, context.cast(builder, value, kind, types.float64))


def _define(symbol: Callable[..., Any], instruction: str) -> None:
    """Let the compiler know an arithmetic operation on lanes, also with numbers beside them."""

    @type_callable(symbol)
    def typed(context: Any) -> Callable[[Any, Any], Any]:
        def check(a: Any, b: Any) -> Any:
            known = (LanesType, types.Float, types.Integer)
            if LANES_TYPE in (a, b) and isinstance(a, known) and isinstance(b, known):
                return LANES_TYPE
            return None

        return check

    def lower(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        a, b = (
            _lanes(context, builder, kind, value)
            for kind, value in zip(signature.args, arguments, strict=True)
        )
        return getattr(builder, instruction)(a, b, flags=_CONTRACT)

    for first, second in (
        (LanesType, LanesType),
        (LanesType, types.Float),
        (types.Float, LanesType),
        (LanesType, types.Integer),
        (types.Integer, LanesType),
    ):
        lower_builtin(symbol, first, second)(lower)


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
    _define(_symbol, _instruction)


def _pointer(builder: Any, address: Any, offset: Any) -> Any:
    """Return where the number at ``offset`` of the array at ``address`` lies."""
    return builder.gep(builder.inttoptr(address, _DOUBLE.as_pointer()), [offset])


def _call(builder: Any, name: str, *values: Any) -> Any:
    """Call a function of LLVM on lanes."""
    kind = ir.FunctionType(_VECTOR, [_VECTOR] * len(values))
    function = get_or_insert_function(builder.module, kind, f"llvm.{name}.v{LANES}f64")
    return builder.call(function, values)


@intrinsic
def load(typing: Any, array: Any, offset: Any) -> Any:
    """Return the lanes that begin at ``offset``."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        at = _pointer(builder, *arguments)
        return builder.load(builder.bitcast(at, _VECTOR.as_pointer()), align=8)

    return LANES_TYPE(types.intp, types.intp), code


@intrinsic
def store(typing: Any, array: Any, offset: Any, value: Any) -> Any:
    """Write lanes, or one number to all of them, from ``offset`` on."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        lanes = _lanes(context, builder, signature.args[2], arguments[2])
        at = _pointer(builder, *arguments[:2])
        builder.store(lanes, builder.bitcast(at, _VECTOR.as_pointer()), align=8)
        return context.get_dummy_value()

    return types.void(types.intp, types.intp, value), code


@intrinsic
def number(typing: Any, array: Any, offset: Any) -> Any:
    """Return the single number at ``offset``."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.load(_pointer(builder, *arguments))

    return types.float64(types.intp, types.intp), code


@intrinsic
def put(typing: Any, array: Any, offset: Any, value: Any) -> Any:
    """Write a single number at ``offset``."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        builder.store(arguments[2], _pointer(builder, *arguments[:2]))
        return context.get_dummy_value()

    return types.void(types.intp, types.intp, types.float64), code


@intrinsic
def gather(typing: Any, table: Any, rows: Any) -> Any:
    """Return the four numbers from ``table[2 int(rows)]`` on, each lane by its own row of two."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        four = ir.VectorType(_DOUBLE, 4)
        table, rows = arguments
        indices = builder.fptosi(rows, ir.VectorType(_INT, LANES))
        parts = []
        for lane in range(LANES):
            row = builder.sext(builder.extract_element(indices, ir.Constant(_INT, lane)), _LONG)
            at = _pointer(builder, table, builder.shl(row, ir.Constant(_LONG, 1)))
            parts.append(builder.load(builder.bitcast(at, four.as_pointer()), align=8))
        while len(parts) > 1:  # one behind the other
            parts = [
                _shuffle(builder, first, second, range(2 * first.type.count))
                for first, second in zip(parts[::2], parts[1::2], strict=True)
            ]
        columns = [_shuffle(builder, parts[0], parts[0], range(c, 4 * LANES, 4)) for c in range(4)]
        return context.make_tuple(builder, signature.return_type, columns)

    return types.UniTuple(LANES_TYPE, 4)(types.intp, LANES_TYPE), code


def _shuffle(builder: Any, first: Any, second: Any, order: Any) -> Any:
    mask = ir.Constant(ir.VectorType(_INT, len(order)), list(order))
    return builder.shuffle_vector(first, second, mask)


def _choice(predicate: str) -> Callable[[Any, Any, Any, Any], Any]:
    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        a, b = (
            _lanes(context, builder, kind, value)
            for kind, value in zip(signature.args, arguments, strict=True)
        )
        return builder.select(builder.fcmp_ordered(predicate, a, b), a, b)

    return code


@intrinsic
def lower(typing: Any, a: Any, b: Any) -> Any:
    """Return the smaller one of ``a`` and ``b``, each lanes or a number; b where a is no number."""
    return LANES_TYPE(a, b), _choice("<")


@intrinsic
def upper(typing: Any, a: Any, b: Any) -> Any:
    """Return the larger one of ``a`` and ``b``, each lanes or a number; b where a is no number."""
    return LANES_TYPE(a, b), _choice(">")


@intrinsic
def if_positive(typing: Any, test: Any, yes: Any, no: Any) -> Any:
    """Return ``yes`` where ``test`` is positive, ``no`` elsewhere."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        test, yes, no = (
            _lanes(context, builder, kind, value)
            for kind, value in zip(signature.args, arguments, strict=True)
        )
        return builder.select(
            builder.fcmp_ordered(">", test, _spread(builder, _DOUBLE(0.0))), yes, no
        )

    return LANES_TYPE(test, yes, no), code


@intrinsic
def root(typing: Any, x: Any) -> Any:
    """Return the square root of lanes."""
    return LANES_TYPE(x), lambda _c, builder, _s, values: _call(builder, "sqrt", values[0])


@intrinsic
def size(typing: Any, x: Any) -> Any:
    """Return the absolute value of lanes."""
    return LANES_TYPE(x), lambda _c, builder, _s, values: _call(builder, "fabs", values[0])


@intrinsic
def whole(typing: Any, x: Any) -> Any:
    """Return lanes without their fractions."""
    return LANES_TYPE(x), lambda _c, builder, _s, values: _call(builder, "trunc", values[0])


@intrinsic
def shifted_power(typing: Any, shifted: Any) -> Any:
    """Return 2^n, n in the low bits of ``shifted``: 1.5 2^52 has been added to it."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        longs = ir.VectorType(_LONG, LANES)
        bits = builder.bitcast(arguments[0], longs)
        biased = builder.add(bits, ir.Constant(longs, [1023] * LANES))
        return builder.bitcast(builder.shl(biased, ir.Constant(longs, [52] * LANES)), _VECTOR)

    return LANES_TYPE(shifted), code


@intrinsic
def largest(typing: Any, x: Any) -> Any:
    """Return the largest one of lanes as a number."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        result = builder.extract_element(arguments[0], ir.Constant(_INT, 0))
        for lane in range(1, LANES):
            value = builder.extract_element(arguments[0], ir.Constant(_INT, lane))
            result = builder.select(builder.fcmp_ordered(">", value, result), value, result)
        return result

    return types.float64(x), code
