"""Keys, values and suggestions as messages have them: shortened, as a file would show them."""

import difflib
import json
import re
from collections.abc import Mapping, Sequence


def toml_value(value: object) -> str:
    """Return a value as TOML, tables and lists in one line."""
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{key} = {toml_value(one)}' for key, one in value.items())} }}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(toml_value, value))}]"
    return json.dumps(value, ensure_ascii=False)


def aligned(rows: Sequence[Sequence[str]]) -> list[str]:
    """Return rows of text as lines whose columns stand below one another."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return ["  ".join(map(str.ljust, row, widths)).rstrip() for row in rows]


def grid_size(points: tuple[int, int]) -> str:
    """Return the nodes along x and y of a grid in words, of a line contact those along x."""
    nx, ny = points
    return f"{nx} nodes" if ny == 1 else f"{nx} x {ny} nodes"


def duration(seconds: float) -> str:
    """Return a time with its unit: 40 s, 12 min, 3.5 h."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"


def suggestion_for(word: str, known: list[str]) -> str:
    """Return the question after the word that is most alike, or all known ones.

    Parameters
    ----------
    word : str
        What was found.
    known : list of str
        All valid words, listed if none is alike (ratio of `difflib` below 0.55).
    """
    return closest(word, known, 0.55) or f"known are {', '.join(known)}"


def closest(word: str, known: list[str], alike: float) -> str:
    """Return the question after the only word that begins alike, or is most alike; empty if none.

    Parameters
    ----------
    word : str
        What was found; its first 100 characters are compared.
    known : list of str
        All valid words.
    alike : float
        Least ratio of `difflib`, 0 to 1.
    """
    begun = [one for one in known if len(word) > 2 and one.startswith(word.lower())]
    alone = begun if len(begun) == 1 else []
    close = alone or difflib.get_close_matches(word[:100], known, n=1, cutoff=alike)
    return "".join(f"did you mean {one}?" for one in close)


def key_text(part: str | int) -> str:
    """Return a part of a key path as the file would show it, shortened."""
    text = str(part)
    bare = re.fullmatch(r"[A-Za-z0-9_-]+", text)
    return short(text if bare else json.dumps(text), 60)


def shown(value: object) -> str:
    """Return a value as the file would show it, shortened."""
    try:
        text = json.dumps(value, ensure_ascii=False)
    except RecursionError:
        text = "a deeply nested table or list"
    except TypeError:  # a type that JSON does not have
        text = str(value)
    except ValueError:  # an integer of thousands of digits
        text = "a number of thousands of digits"
    return short("".join(c if c.isprintable() else "?" for c in text), 60)


def short(text: str, length: int = 40) -> str:
    """Return a text for a message, its end replaced by dots if it is long.

    Parameters
    ----------
    text : str
        Of any length.
    length : int
        Most characters, the dots included; at least three.
    """
    return text if len(text) <= length else f"{text[: length - 3]}..."
