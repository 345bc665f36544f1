"""The text of a case: edited key by key, checked, and packed into an address."""

import base64
import zlib
from collections.abc import Mapping
from typing import Any

import tomlkit

from tehl.base.errors import InputError
from tehl.contact.materials import SOLIDS
from tehl.io.case import REPLACED, tables_of_text, text_of
from tehl.io.templates import template_text
from tehl.lubricant.fluid import OILS

_LAWS = ("lubricant.viscosity.", "lubricant.density.")
LARGEST_TEXT = 200_000
"""Characters of the text of a case; one with more is not a case that a person wrote."""
LONGEST_ADDRESS = 60_000
"""Characters of a case in an address; servers and mail programs cut longer ones."""
_WITHOUT = ("name", "source", "limits")
"""Keys of a named solid or oil that do not hold any more once it is edited."""
_SHEAR = {"law": "limiting", "slope": 0.05}
"""Shear law of the page where a template states the Newtonian one."""


def template_case(name: str) -> "CaseText":
    """Return a template for the page: a Newtonian oil gets a limiting shear stress.

    One move of the slider of the sliding would otherwise give the friction of an oil that transmits
    any stress, a coefficient of five. Without sliding the film is that of the Newtonian oil.
    """
    case = CaseText(template_text(name))
    if case.get("lubricant.shear.law") == "newtonian":
        case.set("lubricant.shear", _SHEAR)
    return case


class CaseText:
    """The text of a case file; a change of a key keeps comments, order and all other keys.

    Parameters
    ----------
    text : str
        A case file. Each change replaces the text whole, so that an earlier one can be kept.

    Raises
    ------
    InputError
        If the text is not TOML.
    """

    def __init__(self, text: str) -> None:
        if len(text) > LARGEST_TEXT:
            raise InputError(f"larger than {LARGEST_TEXT // 1000} kB, so not a case file")
        self.tables: dict[str, Any] = tables_of_text(text)
        self.text = text

    @classmethod
    def of_bytes(cls, content: bytes) -> "CaseText":
        """Return the case of the content of a file."""
        return cls(text_of(content))

    @classmethod
    def unpacked(cls, packed: str) -> "CaseText":
        """Return the case of an address, as `packed` makes it."""
        try:
            padded = packed + "=" * (-len(packed) % 4)
            stream = zlib.decompressobj()
            content = stream.decompress(base64.urlsafe_b64decode(padded), LARGEST_TEXT)
            if not stream.eof:
                raise ValueError(packed)
            return cls(content.decode("utf-8"))
        except (ValueError, zlib.error):
            raise InputError("the case in the address is damaged; open the case file") from None

    @property
    def packed(self) -> str:
        """The text in letters, digits, hyphens and underscores, for an address."""
        content = zlib.compress(self.text.encode("utf-8"), 9)
        return base64.urlsafe_b64encode(content).decode("ascii").rstrip("=")

    @property
    def link(self) -> str:
        """The address of the case on the page; empty if it were too long."""
        packed = self.packed
        return f"/?case={packed}" if len(packed) <= LONGEST_ADDRESS else ""

    def get(self, path: str) -> Any:
        """Return the value at a dotted path as the text states it; None if it does not."""
        node: Any = self.tables
        for key in path.split("."):
            if not isinstance(node, Mapping) or key not in node:
                return None
            node = node[key]
        return node

    def set(self, path: str, value: Any) -> None:
        """State ``value`` at a dotted path, None removes the key; as :meth:`update`."""
        self.update({path: value})

    def update(self, values: Mapping[str, Any]) -> None:
        """State values at their dotted paths, one after the other; None removes a key.

        A named oil or solid on the way is replaced by its table. Of ``numerics.points`` and
        ``numerics.error``, which exclude each other, the other one is removed.
        """
        document = tomlkit.parse(self.text)  # takes longer than all changes
        for path, value in values.items():
            _change(document, path, value)
        text = tomlkit.dumps(document)
        self.tables, self.text = tables_of_text(text), text


def _change(document: Any, path: str, value: Any) -> None:
    if path.startswith(_LAWS):
        _expand_oil(document)
    *above, last = path.split(".")
    node = document
    for depth, key in enumerate(above):
        if not isinstance(node.get(key), Mapping):
            if value is None:
                return
            node[key] = _table(above[: depth + 1], node.get(key))
        node = node[key]
    node.pop(REPLACED.get(last, ""), None)
    if value is None:
        node.pop(last, None)
    else:
        _put(node, last, value)


def _put(node: Any, key: str, value: Any) -> None:
    """Set a value in a table; a table within an inline table, or of a law, is inline too."""
    if isinstance(value, Mapping):
        is_table = isinstance(node, tomlkit.TOMLDocument)
        made: Any = tomlkit.table() if is_table else tomlkit.inline_table()
        made.update(value)
        value = made
    node[key] = value


def _table(path: list[str], stated: Any) -> Any:
    """Return the table that replaces a name, or an empty one where nothing is stated."""
    content: dict[str, Any] = {}
    if isinstance(stated, str):
        content = named_table(path[-1], stated)
    made: Any = tomlkit.table() if len(path) == 1 else tomlkit.inline_table()
    for key, value in content.items():
        _put(made, key, value)
    return made


def named_table(key: str, name: str) -> dict[str, Any]:
    """Return the properties of a named oil (key ``lubricant``) or solid, to be edited."""
    try:
        found = (OILS if key == "lubricant" else SOLIDS).find(name).table
    except ValueError as error:
        raise InputError(f'{key} = "{name}" {error}') from None
    return {key: value for key, value in found.items() if key not in _WITHOUT}


def _expand_oil(document: Any) -> None:
    """Write the laws of an oil that is stated by its name and additions, before one is edited."""
    oil = document.get("lubricant")
    if not isinstance(oil, Mapping) or "name" not in oil or {"viscosity", "density"} & set(oil):
        return
    table: Any = oil
    for key, value in named_table("lubricant", str(table.pop("name"))).items():
        if key not in table:
            _put(table, key, value)
