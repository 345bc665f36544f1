"""What is wrong with the axes and pictures of a study, before any work."""

from collections.abc import Sequence
from itertools import permutations

from tehl.errors import InputError
from tehl.studies.axes import Block
from tehl.studies.columns import is_taken, missing_column
from tehl.studies.pictures import Picture


def check_axes(blocks: Sequence[Block]) -> None:
    """Refuse axes that vary the same thing twice, or have the name of another column.

    Raises
    ------
    InputError
        If two axes are in each other's way, or one cannot be; the message names them.
    """
    paths = [_tidy(path) for block in blocks for path in block.paths]
    names = [name for block in blocks for name in block.names]
    for what, words in (("path", paths), ("name", names)):
        twice = [word for word in words if words.count(word) > 1]
        if twice:
            raise InputError(f"has two axes with the {what} {twice[0]}: {_DIFFERENT[what]}")
    for path in paths:
        if path.split(".")[0] in ("title", "transient"):
            raise InputError(f"axis {path}: a study of steady films does not vary it")
    _check_nesting(paths)
    for name in names:
        if is_taken(name):
            raise InputError(
                f'has an axis with the name "{name}", which is another column of the table: give '
                'a name of its own, name = "my oil"'
            )


def _check_nesting(paths: Sequence[str]) -> None:
    for outer, inner in permutations(paths, 2):
        if inner.startswith(f"{outer}."):
            raise InputError(
                f"has an axis {outer} and an axis {inner}, which is a key of it, so one would "
                "undo the other: vary the key within the tables of the first, or take single keys"
            )


_DIFFERENT = {
    "path": "zip different ones",
    "name": 'give each a name of its own, name = "load"',
}


def _tidy(path: str) -> str:
    return ".".join(part.strip() for part in path.split("."))


def checked_pictures(pictures: Sequence[Picture], blocks: Sequence[Block]) -> tuple[Picture, ...]:
    """Return the pictures, identical ones once.

    Raises
    ------
    InputError
        If one names a column that the table will not have, or two different ones have one file.
    """
    labels = [name for block in blocks for name in block.names]
    files: dict[str, int] = {}
    different = list(dict.fromkeys(pictures))
    for picture in different:
        number, file = pictures.index(picture) + 1, f"{picture.stem}.{picture.format}"
        _check_columns(picture, labels, number)
        if file in files:
            raise InputError(
                f"pictures[{files[file]}] and pictures[{number}] would both be {file}: give one "
                'of them a name of its own, file = "other"'
            )
        files[file] = number
    return tuple(different)


def _check_columns(picture: Picture, labels: Sequence[str], number: int) -> None:
    for key in ("x", "y", "z", "hue", "style"):
        name = getattr(picture, key)
        missing = None if name is None else missing_column(labels, name)
        if missing is not None:
            raise InputError(f'pictures[{number}].{key} = "{name}": {missing}')
