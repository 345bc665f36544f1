"""VTK XML files for the plane of a film, its volume, and collections of planes over time."""

import base64
import xml.etree.ElementTree as ET
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tehl.base.typing import Array

Maps = dict[str, NDArray[Any]]


def rectilinear_grid(
    coordinates: tuple[Array, Array, Array], point_data: Maps, *, converged: bool
) -> str:
    """Return the text of a ``.vtr`` file, numbers as base64 of little-endian doubles.

    Parameters
    ----------
    coordinates : (nx,), (ny,) and (nz,) array
        Grid lines.
    point_data : dict of str to (nz * ny * nx) array
        Arrays by name, x running fastest.
    converged : bool
        Stored as field data, 1 or 0.
    """
    sizes = [axis.size for axis in coordinates]
    root, piece = _grid("RectilinearGrid", sizes, point_data, converged)
    lines = ET.SubElement(piece, "Coordinates")
    for name, axis in zip("xyz", coordinates, strict=True):
        _array(lines, name, axis)
    return _text(root)


def structured_grid(points: Array, point_data: Maps, *, converged: bool) -> str:
    """Return the text of a ``.vts`` file, otherwise as :func:`rectilinear_grid`.

    Parameters
    ----------
    points : (nz, ny, nx, 3) array
        Places of the nodes.
    point_data, converged
        As for a ``.vtr`` file.
    """
    root, piece = _grid("StructuredGrid", list(points.shape[2::-1]), point_data, converged)
    _array(ET.SubElement(piece, "Points"), "points", points).set("NumberOfComponents", "3")
    return _text(root)


def collection(times: dict[str, float]) -> str:
    """Return the text of a ``.pvd`` file that lists files beside it with their times [s]."""
    root = ET.Element("VTKFile", type="Collection", version="1.0", byte_order="LittleEndian")
    listed = ET.SubElement(root, "Collection")
    for name, time in times.items():
        ET.SubElement(listed, "DataSet", timestep=repr(time), part="0", file=name)
    return _text(root)


def _grid(
    kind: str, sizes: list[int], point_data: Maps, converged: bool
) -> tuple[ET.Element, ET.Element]:
    """Return the root of a file and the piece that takes its nodes."""
    extent = " ".join(f"0 {size - 1}" for size in sizes)
    root = ET.Element(
        "VTKFile", type=kind, version="1.0", byte_order="LittleEndian", header_type="UInt64"
    )
    grid = ET.SubElement(root, kind, WholeExtent=extent)
    general = ET.SubElement(grid, "FieldData")
    _array(general, "converged", np.array([converged])).set("NumberOfTuples", "1")
    piece = ET.SubElement(grid, "Piece", Extent=extent)
    values = ET.SubElement(piece, "PointData", Scalars=next(iter(point_data)))
    for name, field in point_data.items():
        _array(values, name, field)
    return root, piece


def _text(root: ET.Element) -> str:
    ET.indent(root)
    return '<?xml version="1.0"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def _array(parent: ET.Element, name: str, values: NDArray[Any]) -> ET.Element:
    """Add one DataArray: the length as eight bytes, then the numbers, together in base64."""
    data = np.ascontiguousarray(values, "<f8").tobytes()
    element = ET.SubElement(parent, "DataArray", type="Float64", Name=name, format="binary")
    header = np.array([len(data)], "<u8").tobytes()
    element.text = base64.b64encode(header + data).decode("ascii")
    return element
