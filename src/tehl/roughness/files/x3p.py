"""Heights in x3p: a zip archive with an XML header and binary heights, always in metres.

The header is read without document types and entities; nothing of it is ever looked up elsewhere.
"""

import hashlib
import lzma
import zipfile
import zlib
from functools import partial
from pathlib import Path
from typing import Any
from xml.etree import ElementTree
from xml.parsers import expat

import numpy as np

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.roughness.files.raw import RawMap, check_bytes, check_count

_MAIN, _CHECKSUM = "main.xml", "md5checksum.hex"
_DAMAGE = (
    zipfile.BadZipFile,
    zlib.error,
    lzma.LZMAError,
    EOFError,
    OSError,
    ValueError,
    NotImplementedError,
)
_md5 = partial(hashlib.md5, usedforsecurity=False)
_TYPES = {"I": "<i2", "L": "<i4", "F": "<f4", "D": "<f8"}


def read_x3p(path: Path) -> RawMap:
    """Return the heights of an x3p file (ISO 25178-72).

    Raises InputError if it is damaged, its checksums do not match, or it holds no map.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            return _map_of(archive)
    except _DAMAGE as error:
        raise InputError(f"is not a complete x3p file: {str(error)[:100]}") from None


def _map_of(archive: zipfile.ZipFile) -> RawMap:
    header = _member(archive, _MAIN, 10**7)  # bytes
    root = _parsed(header)
    _check_header(archive, header)
    if (feature := _text(root, "Record1/FeatureType")) not in ("SUR", None):
        raise InputError(f"holds a feature of type {feature[:20]}, but a map is SUR")
    shape = (_whole(root, "SizeY"), _whole(root, "SizeX"))
    check_count(shape)
    if _whole(root, "SizeZ") != 1:
        raise InputError("holds several heights per point, which is not a map")
    heights = _heights(archive, root, shape)
    pixel = tuple(_number(root, f"Record1/Axes/{axis}/Increment", None) for axis in ("CX", "CY"))
    if not all(step > 0 and np.isfinite(step) for step in pixel):
        raise InputError("has increments along x and y that are not positive numbers")
    return RawMap(
        heights=heights,
        kind="x3p",
        unit="m",
        pixel=(pixel[0], pixel[1]),
        pixel_units=("m", "m"),
    )


def _heights(archive: zipfile.ZipFile, root: Any, shape: tuple[int, int]) -> Array:
    """Return the heights [m], NaN where nothing was measured."""
    letter = _text(root, "Record1/Axes/CZ/DataType") or "D"
    if letter not in _TYPES:
        raise InputError(f"has heights of the type {letter[:20]}: known are {', '.join(_TYPES)}")
    kind = np.dtype(_TYPES[letter])
    link = "Record3/DataLink/"
    name = _text(root, f"{link}PointDataLink")
    if name is None:
        return _listed(root, shape)
    needed = shape[0] * shape[1] * kind.itemsize
    stored = _member(archive, name, needed)
    check_bytes(len(stored), needed, shape)
    _check_sum(stored, _text(root, f"{link}MD5ChecksumPointData"), name)
    heights = np.frombuffer(stored, dtype=kind).astype(np.float64).reshape(shape)
    if kind.kind == "i":
        heights *= _number(root, "Record1/Axes/CZ/Increment", 1.0)
    heights += _number(root, "Record1/Axes/CZ/Offset", 0.0)
    valid = _text(root, f"{link}ValidPointsLink")
    if valid is not None:
        bits = _member(archive, valid, (heights.size + 7) // 8)
        check_bytes(len(bits), (heights.size + 7) // 8, shape)
        _check_sum(bits, _text(root, f"{link}MD5ChecksumValidPoints"), valid)
        flags = np.unpackbits(np.frombuffer(bits, np.uint8), bitorder="little")[: heights.size]
        heights[flags.reshape(shape) == 0] = np.nan
    return heights


def _listed(root: Any, shape: tuple[int, int]) -> Array:
    """Return heights that stand in the header itself, three numbers per point."""
    found = [node.text or "" for node in root.iterfind("{*}Record3/{*}DataList/{*}Datum")]
    if len(found) < shape[0] * shape[1]:
        raise InputError(f"is truncated: it lists {len(found)} heights of {shape[0] * shape[1]}")
    heights = [float(text.split(";")[-1]) if text.strip() else np.nan for text in found]
    return np.array(heights[: shape[0] * shape[1]], dtype=np.float64).reshape(shape)


# ---- archive


def _member(archive: zipfile.ZipFile, name: str, most: int) -> bytes:
    """Return at most ``most`` bytes of a member, whatever the archive claims."""
    try:
        with archive.open(name) as file:
            content = file.read(most + 1)
    except KeyError:
        raise InputError(f"is an x3p file without {name[:60]}") from None
    except RuntimeError:  # as zipfile reports a password
        raise InputError("is an x3p file that is locked with a password") from None
    if len(content) > most:
        raise InputError(f"has a member {name[:60]} that is larger than its header allows")
    return content


def _check_header(archive: zipfile.ZipFile, header: bytes) -> None:
    """Compare the header with its checksum, where the archive has one."""
    if _CHECKSUM not in archive.namelist():
        return
    stated = _member(archive, _CHECKSUM, 1000).split()
    known = [_md5(header).hexdigest()]
    points = next((name for name in archive.namelist() if name.endswith("data.bin")), None)
    if points is not None:  # of which a widespread program writes the checksum instead
        digest = _md5()
        with archive.open(points) as file:
            for _ in range(600):  # at most 600 MB, whatever the archive claims
                digest.update(file.read(10**6))
        known.append(digest.hexdigest())
    if not stated or stated[0].decode("ascii", "replace").lower() not in known:
        raise InputError("is damaged: the checksum of its header does not match")


def _check_sum(content: bytes, stated: str | None, name: str) -> None:
    found = _md5(content).hexdigest()
    if stated and stated.lower() != found:
        raise InputError(f"is damaged: the checksum of {name[:60]} does not match")


# ---- header


def _parsed(header: bytes) -> ElementTree.Element:
    """Return the root of an XML text that declares no types and no entities."""

    def reject(*_: object) -> None:
        raise InputError("has a header with a document type or entities, which x3p has not")

    scout = expat.ParserCreate()
    scout.StartDoctypeDeclHandler = reject
    scout.EntityDeclHandler = reject
    try:
        scout.Parse(header, True)
        return ElementTree.fromstring(header)
    except (expat.ExpatError, ElementTree.ParseError) as error:
        raise InputError(f"has a header that is not XML: {error}") from None
    except (LookupError, ValueError) as error:  # as codecs report an unknown name
        reason = str(error).split(";", maxsplit=1)[0][:60]
        raise InputError(
            f"has a header in an encoding that cannot be read, {reason}: it must be UTF-8"
        ) from None


def _text(root: Any, path: str) -> str | None:
    """Return the text at a path, whatever the namespaces."""
    node = root.find("/".join(f"{{*}}{part}" for part in path.split("/")))
    return (node.text or "").strip() or None if node is not None else None


def _number(root: Any, path: str, absent: float | None) -> float:
    text = _text(root, path)
    if text is None and absent is not None:
        return absent
    try:
        return float(text or "")
    except ValueError:
        raise InputError(f"lacks a number at {path} of its header") from None


def _whole(root: Any, name: str) -> int:
    text = _text(root, f"Record3/MatrixDimension/{name}")
    if text is None:
        raise InputError("holds a profile or a cloud of points, which is not a map")
    if not (text.isascii() and text.isdigit() and len(text) < 12):
        raise InputError(f"has no count at {name} of its header")
    return int(text)
