"""VTK XML files, as far as a film on a rectangular grid needs them."""

import base64
import xml.etree.ElementTree as ET

import numpy as np

from tehl.typing import Array


def rectilinear_grid(
    coordinates: tuple[Array, Array, Array],
    point_data: dict[str, Array],
    *,
    field_data: dict[str, float],
) -> str:
    """Return the text of a ``.vtr`` file, numbers as base64 of little-endian doubles.

    Parameters
    ----------
    coordinates : (nx,), (ny,) and (nz,) array
        Grid lines.
    point_data : dict of str to (nz * ny * nx) array
        Arrays by name, x running fastest.
    field_data : dict of str to float
        Numbers about the whole grid.
    """
    extent = " ".join(f"0 {axis.size - 1}" for axis in coordinates)
    root = ET.Element(
        "VTKFile",
        type="RectilinearGrid",
        version="1.0",
        byte_order="LittleEndian",
        header_type="UInt64",
    )
    grid = ET.SubElement(root, "RectilinearGrid", WholeExtent=extent)
    general = ET.SubElement(grid, "FieldData")
    for name, value in field_data.items():
        _array(general, name, np.array([value])).set("NumberOfTuples", "1")
    piece = ET.SubElement(grid, "Piece", Extent=extent)
    points = ET.SubElement(piece, "PointData", Scalars=next(iter(point_data)))
    for name, values in point_data.items():
        _array(points, name, values)
    lines = ET.SubElement(piece, "Coordinates")
    for name, axis in zip("xyz", coordinates, strict=True):
        _array(lines, name, axis)
    ET.indent(root)
    return '<?xml version="1.0"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def _array(parent: ET.Element, name: str, values: Array) -> ET.Element:
    """Add one DataArray: eight bytes with the length, then the numbers, together in base64."""
    data = np.ascontiguousarray(values, "<f8").tobytes()
    element = ET.SubElement(parent, "DataArray", type="Float64", Name=name, format="binary")
    header = np.array([len(data)], "<u8").tobytes()
    element.text = base64.b64encode(header + data).decode("ascii")
    return element
