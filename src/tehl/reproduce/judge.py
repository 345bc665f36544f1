"""From what numbers say of statements to a verdict."""

from dataclasses import dataclass
from typing import Literal

Word = Literal["reproduced", "trend only", "cannot be"]
RANK: dict[Word, int] = {"reproduced": 0, "trend only": 1, "cannot be": 2}


@dataclass(frozen=True, slots=True)
class Finding:
    """What the numbers of one treatment say of a statement.

    Attributes
    ----------
    holds : bool
        Whether it is so.
    numbers : str
        That decide.
    """

    holds: bool
    numbers: str


@dataclass(frozen=True, slots=True)
class Check:
    """A statement of the paper, held against both treatments.

    Attributes
    ----------
    statement : str
        In words.
    paper, converged : Finding or None
        On the paper's grid, and converged; None where it does not apply.
    """

    statement: str
    paper: Finding | None
    converged: Finding | None


@dataclass(frozen=True, slots=True)
class Verdict:
    """What can be said of a table or figure.

    Attributes
    ----------
    word : {"reproduced", "trend only", "cannot be"}
        In short.
    why : str
        In a sentence.
    checks : tuple of Check
        What it was judged by.
    """

    word: Word
    why: str
    checks: tuple[Check, ...]


def judged(checks: list[Check], open_runs: str = "") -> Verdict:
    """Return the verdict that follows from statements.

    Reproduced: all of them hold, on the paper's grid and converged. Trend only: some of the
    converged findings hold, or all of them but not on the paper's grid, or some run has no
    converged answer. Cannot be: none of the converged findings holds.

    Parameters
    ----------
    checks : list of Check
        Statements of the paper.
    open_runs : str
        Which converged runs are no answer, in words; empty if all are.
    """
    fine = [check for check in checks if check.converged is not None]
    wrong = [c.statement for c in fine if c.converged is not None and not c.converged.holds]
    torn = [c.statement for c in checks if c.paper is not None and not c.paper.holds]
    torn = [statement for statement in torn if statement not in wrong]
    right = [c.statement for c in fine if c.statement not in (*wrong, *torn)]
    reasons = [
        f"{words} {_list(statements)}"
        for words, statements in (
            ("so:", right if wrong or torn else []),
            ("not so:", wrong),
            ("so when converged, but not on the paper's grid:", torn),
        )
        if statements
    ]
    if open_runs:
        reasons.append(open_runs)
    word: Word = "trend only" if wrong or torn or open_runs else "reproduced"
    if not fine or len(wrong) == len(fine):
        word = "cannot be"
    both = ", on both grids" if any(check.paper is not None for check in checks) else ""
    why = "; ".join(reasons) or f"all that is said of it holds{both}"
    return Verdict(word, f"{why[0].upper()}{why[1:]}.", tuple(checks))


def _list(words: list[str]) -> str:
    return ", ".join(f"“{word}”" for word in words)
