"""Encodings of the texts that users write: UTF-8, or UTF-16 as editors of Windows save it."""

from codecs import BOM_UTF16_BE, BOM_UTF16_LE


def encoding_of(start: bytes) -> str:
    """Return the encoding of a text by its first bytes: UTF-16 with its mark, or UTF-8."""
    return "utf-16" if start.startswith((BOM_UTF16_LE, BOM_UTF16_BE)) else "utf-8-sig"
