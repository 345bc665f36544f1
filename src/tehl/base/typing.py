"""Names for array types, and ``np`` for modules that also work without arrays.

Numpy takes 0.17 s to load, and a case is stated and explained without it: modules that both do so
import ``np`` and ``Array`` from here, and numpy is loaded when ``np`` is first used.
"""

import importlib
from typing import TYPE_CHECKING, Annotated, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    SingleArray = NDArray[np.float32]
    IntArray = NDArray[np.int64]
    BoolArray = NDArray[np.bool_]
    FlagArray = NDArray[np.uint8]
    Record = np.record
    Records = np.recarray[Any, Any]
else:

    class _Numpy:
        """The module numpy, imported by the first use of a function."""

        def __getattr__(self, name: str) -> object:
            return getattr(importlib.import_module("numpy"), name)

    np = _Numpy()
    Array, SingleArray = Annotated[Any, "float64"], Annotated[Any, "float32"]
    IntArray, BoolArray, FlagArray = (
        Annotated[Any, "int64"], Annotated[Any, "bool"], Annotated[Any, "uint8"]
    )  # fmt: skip
    Record = Records = Any  # an element of a structured array, and the array
