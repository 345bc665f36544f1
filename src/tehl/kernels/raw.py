"""Raw arrays: an address and a shape.

A kernel that is called from Python begins with ``film, out = raw((film, out))``, which turns numpy
arrays, also those in named tuples, into raw ones; interpreted, it does nothing. They are indexed
like numpy arrays, without strides, slices and negative indices. Arrays must be contiguous (C
order). Indices are not checked.

The last index may be ``lanes(j)``: elements j to j + 7 as lanes (`tehl.kernels.lanes`). Elements of
a structured array are records: attributes of eight numbers are lanes, those of shape (m, 8) raw
arrays.

This file uses numba's documented low-level extension interface (`numba.extending`), and from
`numba.core` its types, `cgutils` and `AttributeTemplate`.
"""

import operator
from typing import Any, TypeVar

from llvmlite import ir
from numba.core import cgutils, types
from numba.core.imputils import (
    lower_builtin,
    lower_getattr,
    lower_getattr_generic,
    lower_setattr_generic,
)
from numba.core.typing.templates import AttributeTemplate, infer_getattr
from numba.extending import models, register_model

from tehl.kernels.lanes import (
    DOUBLE,
    INT,
    LANES,
    LANES_TYPE,
    LONG,
    VECTOR,
    LanesType,
    as_lanes,
    lookup,
    typing_rule,
)

Parts = TypeVar("Parts")


def raw(parts: Parts) -> Parts:
    """Return an array, or a tuple, also a named one, with its arrays, as raw arrays."""
    return parts


def lanes(first: int) -> slice:
    """Return the index of eight numbers from ``first`` on."""
    return slice(first, first + LANES)


# Types, typing rules and LLVM instructions.


class RawArray(types.Type):
    """Type of a raw array."""

    def __init__(self, element: Any, ndim: int) -> None:
        self.element, self.ndim = element, ndim
        super().__init__(name=f"RawArray({element}, {ndim})")


class RawRecord(types.Type):
    """Type of an element of a structured array: ``fields`` name their offsets and shapes."""

    def __init__(self, record: Any) -> None:
        self.fields = {
            name: (field.offset // 8, getattr(field.type, "shape", ()))
            for name, field in record.fields.items()
        }
        self.size = record.size // 8
        super().__init__(name=f"RawRecord({record})")


class LanesIndex(types.Type):
    """Type of the index of eight numbers."""


LANES_INDEX = LanesIndex("lanes")


@register_model(RawArray)
class _ArrayModel(models.StructModel):
    """Pointer to the first element, then the shape."""

    def __init__(self, manager: Any, kind: RawArray) -> None:
        element = types.float64 if isinstance(kind.element, RawRecord) else kind.element
        members = [("data", types.CPointer(element))]
        members += [(f"length{axis}", types.intp) for axis in range(kind.ndim)]
        super().__init__(manager, kind, members)


@register_model(RawRecord)
class _RecordModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: RawRecord) -> None:
        super().__init__(manager, kind, DOUBLE.as_pointer())


@register_model(LanesIndex)
class _IndexModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: LanesIndex) -> None:
        super().__init__(manager, kind, LONG)


def _raw_type(kind: Any) -> Any:
    """Return the type that `raw` makes of another one."""
    if isinstance(kind, types.Array):
        if kind.layout != "C":
            raise TypeError("a kernel takes contiguous arrays")
        record = isinstance(kind.dtype, types.Record)
        return RawArray(RawRecord(kind.dtype) if record else kind.dtype, kind.ndim)
    if isinstance(kind, types.BaseTuple):
        parts = [_raw_type(part) for part in kind]
        return types.BaseTuple.from_types(parts, getattr(kind, "instance_class", None))
    return kind


def _raw_value(context: Any, builder: Any, kind: Any, value: Any) -> Any:
    if isinstance(kind, types.Array):
        array = context.make_array(kind)(context, builder, value)
        shape = cgutils.unpack_tuple(builder, array.shape, kind.ndim)
        return _struct(context, builder, _raw_type(kind), [array.data, *shape])
    if isinstance(kind, types.BaseTuple):
        parts = [builder.extract_value(value, at) for at in range(len(kind))]
        pairs = zip(kind, parts, strict=True)
        values = [_raw_value(context, builder, part, value) for part, value in pairs]
        return context.make_tuple(builder, _raw_type(kind), values)
    return value


def _struct(context: Any, builder: Any, kind: Any, values: list[Any]) -> Any:
    """Return a raw array or tuple of its parts."""
    llvm = context.get_value_type(kind)
    result = ir.Constant(llvm, ir.Undefined)
    for at, (part, value) in enumerate(zip(llvm.elements, values, strict=True)):
        pointer = isinstance(part, ir.PointerType)
        result = builder.insert_value(
            result, builder.bitcast(value, part) if pointer else value, at
        )
    return result


typing_rule(raw, _raw_type)
typing_rule(lanes, lambda first: LANES_INDEX if isinstance(first, types.Integer) else None)


@lower_builtin(raw, types.Any)
def _lower_raw(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return _raw_value(context, builder, signature.args[0], arguments[0])


@lower_builtin(lanes, types.Integer)
def _lower_lanes(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return context.cast(builder, arguments[0], signature.args[0], types.intp)


_INDEX = (types.Integer, types.BaseTuple, LanesIndex)


def _indices(index: Any) -> tuple[Any, ...]:
    return tuple(index) if isinstance(index, types.BaseTuple) else (index,)


def _item_type(array: Any, index: Any) -> Any:
    """Return the type of an item, None if this is not a raw array."""
    if isinstance(array, LanesType) and isinstance(index, types.Integer):
        return types.float64
    if not isinstance(array, RawArray) or not isinstance(index, _INDEX):
        return None
    if len(_indices(index)) < array.ndim:
        return RawArray(array.element, array.ndim - len(_indices(index)))
    return LANES_TYPE if isinstance(_indices(index)[-1], LanesIndex) else array.element


def _set_type(array: Any, index: Any, value: Any) -> Any:
    """Return the type of an assignment, None if this is not a raw array."""
    del value
    known = isinstance(array, RawArray) and _item_type(array, index) is not None
    return types.none if known else None


typing_rule(operator.getitem, _item_type)
typing_rule(operator.setitem, _set_type)


def _shape_of(builder: Any, kind: Any, value: Any) -> list[Any]:
    return [builder.extract_value(value, 1 + axis) for axis in range(kind.ndim)]


def _pointer(builder: Any, kind: Any, value: Any, index: Any) -> Any:
    """Return the pointer to the element at ``index``, a list of integers."""
    index = index + [ir.Constant(LONG, 0)] * (kind.ndim - len(index))
    shape = _shape_of(builder, kind, value)
    at = index[0]
    for length, i in zip(shape[1:], index[1:], strict=True):
        at = builder.add(builder.mul(at, length, flags=["nsw"]), i, flags=["nsw"])
    if isinstance(kind.element, RawRecord):
        at = builder.mul(at, ir.Constant(LONG, kind.element.size), flags=["nsw"])
    return builder.gep(builder.extract_value(value, 0), [at], inbounds=True)


def _integers(context: Any, builder: Any, kind: Any, index: Any) -> list[Any]:
    """Return integer indices as 64-bit integers, others unchanged."""
    values = cgutils.unpack_tuple(builder, index) if isinstance(kind, types.BaseTuple) else [index]
    return [
        context.cast(builder, value, part, types.intp) if isinstance(part, types.Integer) else value
        for part, value in zip(_indices(kind), values, strict=True)
    ]


def _vector_pointer(builder: Any, pointer: Any) -> Any:
    return builder.bitcast(pointer, VECTOR.as_pointer())


def _get(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    kind, index_kind = signature.args
    index = _integers(context, builder, index_kind, arguments[1])
    pointer = _pointer(builder, kind, arguments[0], index)
    if isinstance(signature.return_type, RawArray):
        lengths = _shape_of(builder, kind, arguments[0])[len(index) :]
        return _struct(context, builder, signature.return_type, [pointer, *lengths])
    if isinstance(kind.element, RawRecord):
        return pointer
    if isinstance(signature.return_type, LanesType):
        return builder.load(_vector_pointer(builder, pointer), align=8)
    return context.unpack_value(builder, kind.element, pointer)


def _set(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    (kind, index_kind, value_kind), value = signature.args, arguments[2]
    index = _integers(context, builder, index_kind, arguments[1])
    pointer = _pointer(builder, kind, arguments[0], index)
    if isinstance(_indices(index_kind)[-1], LanesIndex):
        vector = as_lanes(context, builder, value_kind, value)
        builder.store(vector, _vector_pointer(builder, pointer), align=8)
    else:
        number = context.cast(builder, value, value_kind, kind.element)
        context.pack_value(builder, kind.element, number, pointer)
    return context.get_dummy_value()


def _get_lane(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    lane = context.cast(builder, arguments[1], signature.args[1], types.intp)
    return builder.extract_element(arguments[0], lane)


lower_builtin(operator.getitem, RawArray, types.Any)(_get)
lower_builtin(operator.setitem, RawArray, types.Any, types.Any)(_set)
lower_builtin(operator.getitem, LanesType, types.Integer)(_get_lane)


@infer_getattr
class _ArrayAttributes(AttributeTemplate):
    """Typing rule of the attributes of a raw array."""

    key = RawArray

    def resolve_shape(self, array: RawArray) -> Any:
        """Return the type of the shape."""
        return types.UniTuple(types.intp, array.ndim)


@lower_getattr(RawArray, "shape")
def _shape(context: Any, builder: Any, kind: Any, value: Any) -> Any:
    shape = _shape_of(builder, kind, value)
    return context.make_tuple(builder, types.UniTuple(types.intp, kind.ndim), shape)


@infer_getattr
class _RecordAttributes(AttributeTemplate):
    """Typing rule of the attributes of a record."""

    key = RawRecord

    def generic_resolve(self, record: RawRecord, name: str) -> Any:
        """Return the type of an attribute."""
        _, shape = record.fields[name]
        return LANES_TYPE if shape == (LANES,) else RawArray(types.float64, len(shape))


@lower_getattr_generic(RawRecord)
def _get_attribute(context: Any, builder: Any, kind: Any, value: Any, name: str) -> Any:
    offset, shape = kind.fields[name]
    pointer = builder.gep(value, [ir.Constant(LONG, offset)], inbounds=True)
    if shape == (LANES,):
        return builder.load(_vector_pointer(builder, pointer), align=8)
    lengths = [ir.Constant(LONG, length) for length in shape]
    return _struct(context, builder, RawArray(types.float64, len(shape)), [pointer, *lengths])


@lower_setattr_generic(RawRecord)
def _set_attribute(context: Any, builder: Any, signature: Any, arguments: Any, name: str) -> None:
    kind, value_kind = signature.args
    pointer = builder.gep(arguments[0], [ir.Constant(LONG, kind.fields[name][0])], inbounds=True)
    lanes = as_lanes(context, builder, value_kind, arguments[1])
    builder.store(lanes, _vector_pointer(builder, pointer), align=8)


def _lookup_type(table: Any, rows: Any) -> Any:
    fits = isinstance(table, RawArray) and isinstance(rows, LanesType)
    return types.UniTuple(LANES_TYPE, 4) if fits else None


typing_rule(lookup, _lookup_type)


@lower_builtin(lookup, RawArray, LanesType)
def _lower_lookup(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    """Load four numbers per lane, then turn rows into columns."""
    four = ir.VectorType(DOUBLE, 4)
    indices = builder.fptosi(arguments[1], ir.VectorType(INT, LANES))
    parts = []
    for lane in range(LANES):
        row = builder.sext(builder.extract_element(indices, ir.Constant(INT, lane)), LONG)
        index = [row, ir.Constant(LONG, 0)]
        at = _pointer(builder, signature.args[0], arguments[0], index)
        parts.append(builder.load(builder.bitcast(at, four.as_pointer()), align=8))
    while len(parts) > 1:  # one behind the other
        parts = [
            _shuffle(builder, first, second, range(2 * first.type.count))
            for first, second in zip(parts[::2], parts[1::2], strict=True)
        ]
    columns = [_shuffle(builder, parts[0], parts[0], range(c, 4 * LANES, 4)) for c in range(4)]
    return context.make_tuple(builder, signature.return_type, columns)


def _shuffle(builder: Any, first: Any, second: Any, order: range) -> Any:
    mask = ir.Constant(ir.VectorType(INT, len(order)), list(order))
    return builder.shuffle_vector(first, second, mask)
