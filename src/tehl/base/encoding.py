"""Encodings of the texts that users write: UTF-8, or those in which Windows saves them."""

from codecs import BOM_UTF16_BE, BOM_UTF16_LE


def encoding_of(start: bytes) -> str:
    """Return the encoding of a text by its first bytes: UTF-16 with its mark, or UTF-8."""
    return "utf-16" if start.startswith((BOM_UTF16_LE, BOM_UTF16_BE)) else "utf-8-sig"


def decoded(content: bytes) -> str:
    """Return a text in UTF-8, UTF-16 or cp1252, in which Excel saves CSV; a UnicodeError if not."""
    try:
        return content.decode(encoding_of(content[:2]))
    except UnicodeDecodeError:
        pass
    try:
        return content.decode("cp1252")
    except UnicodeDecodeError:
        raise UnicodeError("it is not a text") from None
