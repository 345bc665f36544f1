"""VTK XML files, as far as a film needs them: its plane and its volume."""

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
    root, grid, extent = _frame("RectilinearGrid", [axis.size for axis in coordinates], field_data)
    piece = _piece(grid, extent, point_data)
    lines = ET.SubElement(piece, "Coordinates")
    for name, axis in zip("xyz", coordinates, strict=True):
        _array(lines, name, axis)
    return _text(root)


def structured_grid(
    points: Array, point_data: dict[str, Array], *, field_data: dict[str, float]
) -> str:
    """Return the text of a ``.vts`` file, numbers as base64 of little-endian doubles.

    Parameters
    ----------
    points : (nz, ny, nx, 3) array
        Places of the nodes.
    point_data : dict of str to (nz, ny, nx) array
        Arrays by name.
    field_data : dict of str to float
        Numbers about the whole grid.
    """
    sizes = list(points.shape[2::-1])
    root, grid, extent = _frame("StructuredGrid", sizes, field_data)
    piece = _piece(grid, extent, point_data)
    _array(ET.SubElement(piece, "Points"), "points", points).set("NumberOfComponents", "3")
    return _text(root)


def _frame(
    kind: str, sizes: list[int], field_data: dict[str, float]
) -> tuple[ET.Element, ET.Element, str]:
    """Return the root of a file, its grid with the numbers about it, and the extent."""
    extent = " ".join(f"0 {size - 1}" for size in sizes)
    root = ET.Element(
        "VTKFile", type=kind, version="1.0", byte_order="LittleEndian", header_type="UInt64"
    )
    grid = ET.SubElement(root, kind, WholeExtent=extent)
    general = ET.SubElement(grid, "FieldData")
    for name, value in field_data.items():
        _array(general, name, np.array([value])).set("NumberOfTuples", "1")
    return root, grid, extent


def _piece(grid: ET.Element, extent: str, point_data: dict[str, Array]) -> ET.Element:
    piece = ET.SubElement(grid, "Piece", Extent=extent)
    values = ET.SubElement(piece, "PointData", Scalars=next(iter(point_data)))
    for name, field in point_data.items():
        _array(values, name, field)
    return piece


def _text(root: ET.Element) -> str:
    ET.indent(root)
    return '<?xml version="1.0"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def _array(parent: ET.Element, name: str, values: Array) -> ET.Element:
    """Add one DataArray: eight bytes with the length, then the numbers, together in base64."""
    data = np.ascontiguousarray(values, "<f8").tobytes()
    element = ET.SubElement(parent, "DataArray", type="Float64", Name=name, format="binary")
    header = np.array([len(data)], "<u8").tobytes()
    element.text = base64.b64encode(header + data).decode("ascii")
    return element
