"""Files of heights for tests."""

import hashlib
import struct
import zipfile

import numpy as np
from scipy import ndimage

X3P = """<?xml version="1.0" encoding="{encoding}"?>
{doctype}<p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2">
<Record1><Revision>ISO5436 - 2000</Revision><FeatureType>{feature}</FeatureType><Axes>
<CX><AxisType>I</AxisType><DataType>D</DataType><Increment>{dx}</Increment><Offset>0</Offset></CX>
<CY><AxisType>I</AxisType><DataType>D</DataType><Increment>{dy}</Increment><Offset>0</Offset></CY>
<CZ><AxisType>A</AxisType><DataType>{letter}</DataType>{increment}</CZ></Axes></Record1>
<Record3><MatrixDimension><SizeX>{nx}</SizeX><SizeY>{ny}</SizeY><SizeZ>1</SizeZ></MatrixDimension>
<DataLink><PointDataLink>bindata/data.bin</PointDataLink>
<MD5ChecksumPointData>{md5}</MD5ChecksumPointData>{valid}</DataLink></Record3>
<Record4><ChecksumFile>md5checksum.hex</ChecksumFile></Record4></p:ISO5436_2>
"""
TYPES = {"D": "<f8", "F": "<f4", "L": "<i4", "I": "<i2"}


def relief(ny=24, nx=32, sq=2e-7, seed=0):
    """Return rough heights on a plane [m]."""
    noise = np.random.default_rng(seed).standard_normal((ny, nx))
    heights = ndimage.gaussian_filter(noise, 1.5, mode="wrap")
    x, y = np.linspace(-1, 1, nx)[None, :], np.linspace(-1, 1, ny)[:, None]
    return sq * (heights / heights.std() + 2 * x - 3 * y)


def write_x3p(path, heights, letter="D", scale=1.0, **changes):
    """Write an x3p file; ``changes`` make it a wrong one."""
    ny, nx = heights.shape
    data = np.nan_to_num(heights) / scale
    data = data.round() if letter in "IL" else data
    content = data.astype(TYPES[letter]).tobytes()
    keys = {"nx": nx, "ny": ny, "dx": 2e-6, "dy": 3e-6, "letter": letter, "feature": "SUR"}
    keys |= {"md5": hashlib.md5(content).hexdigest(), "valid": "", "doctype": "", "increment": ""}
    keys["encoding"] = "UTF-8"
    if scale != 1.0:
        keys["increment"] = f"<Increment>{scale}</Increment>"
    missing = ~np.isfinite(heights)
    if missing.any():
        keys["valid"] = "<ValidPointsLink>bindata/valid.bin</ValidPointsLink>"
    cut = changes.pop("cut", 0)
    checksum = changes.pop("checksum", None)
    method = changes.pop("method", zipfile.ZIP_DEFLATED)
    header = X3P.format(**(keys | changes)).encode()
    with zipfile.ZipFile(path, "w", method) as archive:
        archive.writestr("main.xml", header)
        archive.writestr("bindata/data.bin", content[: len(content) - cut])
        archive.writestr(
            "md5checksum.hex", checksum or f"{hashlib.md5(header).hexdigest()} *main.xml"
        )
        if missing.any():
            archive.writestr(
                "bindata/valid.bin", np.packbits(~missing, bitorder="little").tobytes()
            )
    return path


def write_xyz(path, heights, dx=2.0, dy=3.0, mark=" "):
    """Write columns x, y, z in an order of their own."""
    rows, columns = np.nonzero(np.isfinite(heights))
    order = np.random.default_rng(1).permutation(rows.size)
    table = np.column_stack((columns * dx, rows * dy, heights[rows, columns]))[order]
    np.savetxt(path, table, delimiter=mark, fmt="%.9g")
    return path


def write_metropro(path, heights, *, pixel=2e-6, resolution=1):
    """Write a file of Zygo MetroPro, format 1, with heights [m]."""
    ny, nx = heights.shape
    scale, wavelength = 0.5, 633e-9
    counts = heights / (scale * wavelength) * (4096, 32768, 131072)[resolution]
    header = bytearray(834)
    fields = {
        0: (">I", 0x881B036F),
        4: (">H", 1),
        6: (">I", 834),
        68: (">HH", nx, ny),
        72: (">I", 4 * nx * ny),
        164: (">ff", scale, wavelength),
        176: (">f", 1.0),
        184: (">f", pixel),
        218: (">h", resolution),
    }
    for place, (form, *values) in fields.items():
        struct.pack_into(form, header, place, *values)
    data = np.where(np.isfinite(heights), np.nan_to_num(counts).round(), 2147483640)
    path.write_bytes(bytes(header) + data.astype(">i4").tobytes())
    return path
