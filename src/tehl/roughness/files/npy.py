"""Arrays as numpy writes them. Objects are never unpickled."""

import math
from pathlib import Path

import numpy as np

from tehl.errors import InputError
from tehl.roughness.files.raw import RawMap, check_bytes, check_count

_READERS = {
    (1, 0): np.lib.format.read_array_header_1_0,
    (2, 0): np.lib.format.read_array_header_2_0,
}


def read_npy(path: Path) -> RawMap:
    """Return the heights of a ``.npy`` file.

    Raises
    ------
    InputError
        If it holds no table of real numbers, or less than its header claims.
    """
    with path.open("rb") as file:
        try:
            version = np.lib.format.read_magic(file)
            shape, _, dtype = _READERS[version](file)
            told = str(shape)[:60]
        except Exception:  # its header is parsed as Python is, with all that may go wrong
            raise InputError("is no file of numpy: its header cannot be read") from None
        if dtype.kind not in "fiu":
            raise InputError(f"holds {_kind(dtype)}, but heights are real numbers")
        if not all(type(side) is int and side >= 0 for side in shape):
            raise InputError(f"is no file of numpy: its header claims a table of shape {told}")
        check_count(shape)
        needed = math.prod(shape) * dtype.itemsize
        check_bytes(path.stat().st_size - file.tell(), needed, shape)
    with np.errstate(over="ignore"):  # wider numbers than these become infinite: missing points
        heights = np.load(path, allow_pickle=False).astype(np.float64)
    return RawMap(heights=heights, kind="numpy array")


def _kind(dtype: np.dtype) -> str:
    words = {"O": "objects", "c": "complex numbers", "b": "truth values", "V": "records"}
    return words.get(dtype.kind, "text" if dtype.kind in "SU" else "times")
