"""Files that a case on the page may name: those uploaded to it, and those of the case opened."""

import re
from collections.abc import Iterator, Mapping
from copy import deepcopy
from pathlib import Path
from typing import Any

from tehl.base.errors import InputError
from tehl.roughness.files import ENDINGS

LARGEST_UPLOAD = 50_000_000
"""Bytes of an upload."""
_UNSAFE = re.compile(r"[^A-Za-z0-9._-]+")
Place = tuple[str | int, ...]


class Files:
    """The folder of uploads, and what else a case on the page may name.

    Parameters
    ----------
    uploads : Path
        Folder of the files that were uploaded since the page was started.
    beside : Path or None
        Folder of the case given on the command line; files in it may be named without a path.
    stated : set of str
        Names of files in that case, with their paths as the user wrote them.
    """

    def __init__(
        self, uploads: Path, beside: Path | None = None, stated: frozenset[str] = frozenset()
    ) -> None:
        self.uploads, self.beside, self.stated = uploads, beside, stated

    def keep(self, name: str, content: bytes) -> str:
        """Store an upload under a safe name, a new one if another file has it; return the name."""
        plain = _UNSAFE.sub("_", Path(name.replace("\\", "/")).name).lstrip(".")
        ending = plain.rpartition(".")[2].lower()
        if ending not in ENDINGS:
            raise InputError(
                f"{plain or 'the file'}: the ending is not a format of heights; known are "
                f"{', '.join(ENDINGS)}"
            )
        if len(content) > LARGEST_UPLOAD:
            raise InputError(
                f"{plain}: larger than {LARGEST_UPLOAD // 10**6} MB; crop the map before"
            )
        self.uploads.mkdir(parents=True, exist_ok=True)
        name, number = plain, 1
        while (path := self.uploads / name).exists() and path.read_bytes() != content:
            number += 1
            name = f"{number}-{plain}"
        path.write_bytes(content)
        return name

    def resolved(self, tables: Mapping[str, Any]) -> dict[str, Any]:
        """Return the tables of a case with the paths of its files; the tables are not changed.

        Raises
        ------
        InputError
            If a file is neither uploaded nor that of the case given on the command line.
        """
        found = deepcopy(dict(tables))
        for place, name in named_files(tables):
            node: Any = found
            for part in place[:-1]:
                node = node[part]
            node[place[-1]] = str(self._path(".".join(map(str, place)), name))
        return found

    def _path(self, key: str, name: str) -> Path:
        if name in self.stated and self.beside is not None:
            return self.beside / Path(name).expanduser()
        plain = Path(name).name == name and name not in (".", "..") and "\\" not in name
        for folder in (self.uploads, self.beside) if plain else ():
            if folder is not None and (folder / name).is_file():
                return folder / name
        raise InputError(
            f'{key} = "{name[:60]}": not a file of this page; expected an uploaded one'
        )

    def hidden(self, message: str) -> str:
        """Return a message without the folders of this machine."""
        for folder in (self.uploads, self.beside):
            if folder is not None:
                message = message.replace(f"{folder}/", "").replace(str(folder), "")
        return message


def named_files(node: Any, place: Place = ()) -> Iterator[tuple[Place, str]]:
    """Yield where the tables of a case name files, and the names."""
    inside = node.items() if isinstance(node, Mapping) else enumerate(node)
    for key, value in inside:
        here = (*place, key)
        if isinstance(value, str) and (key == "file" or here == ("supply", "profile")):
            yield here, value
        elif isinstance(value, Mapping | list):
            yield from named_files(value, here)
