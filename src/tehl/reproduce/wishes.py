"""What is to be reproduced: names of tables, figures and statements."""

import difflib
from collections.abc import Iterable
from dataclasses import dataclass

from tehl.errors import InputError
from tehl.reproduce.figures import FigureSpec, figures
from tehl.reproduce.propositions import PROPOSITIONS
from tehl.reproduce.series import NAMES
from tehl.reproduce.tables import TABLES


@dataclass(frozen=True, slots=True)
class Wishes:
    """What is to be made, in the order of the paper.

    Attributes
    ----------
    tables, propositions : tuple of str
        Names.
    figures : tuple of FigureSpec
        Figures.
    """

    tables: tuple[str, ...]
    figures: tuple[FigureSpec, ...]
    propositions: tuple[str, ...]

    @property
    def series(self) -> tuple[str, ...]:
        """Return the series that they need."""
        needed = {name for table in self.tables for name in TABLES[table][1]}
        needed |= {name for spec in self.figures for name in spec.needs}
        needed |= {name for one in self.propositions for name in PROPOSITIONS[one][1]}
        return tuple(name for name in NAMES if name in needed)


def wishes(only: Iterable[str] = ()) -> Wishes:
    """Return what is asked for, all if nothing is named.

    Parameters
    ----------
    only : iterable of str
        Names such as "T2", "F7", "C4", "P2" or "X1", in any case.

    Raises
    ------
    InputError
        If there is no such table, figure or statement.
    """
    specs = figures()
    known = (*TABLES, *specs, *PROPOSITIONS)
    asked = [name.strip().upper() for name in only]
    for name in asked:
        if name not in known:
            raise InputError(_unknown(name, known))
    wanted = set(asked or known)
    return Wishes(
        tables=tuple(name for name in TABLES if name in wanted),
        figures=tuple(spec for name, spec in specs.items() if name in wanted),
        propositions=tuple(name for name in PROPOSITIONS if name in wanted),
    )


def _unknown(name: str, known: tuple[str, ...]) -> str:
    near = difflib.get_close_matches(name, known, n=1, cutoff=0.5)
    guess = f"did you mean {near[0]}? " if near else ""
    return (
        f"{name or '(nothing)'} is no table, figure or statement: {guess}known are T1 to T3, F1 to "
        "F24, X1 to X4 (added figures), C1 to C5 (conclusions), P0 to P3 (added statements)"
    )
