"""From checked statements to a verdict on a table or figure."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal, NamedTuple

Word = Literal["reproduced", "trend only", "cannot be reproduced"]
WORDS: tuple[Word, ...] = ("reproduced", "trend only", "cannot be reproduced")


class Finding(NamedTuple):
    """Whether a statement holds, and the numbers that decide."""

    holds: bool
    numbers: str


class Statement(NamedTuple):
    """A statement with findings on the paper's grid and converged, None if it does not apply."""

    text: str
    paper: Finding | None
    converged: Finding | None


@dataclass(frozen=True, slots=True)
class Verdict:
    """The verdict on a table or figure, its reason, and the statements that decide."""

    word: Word
    reason: str
    statements: tuple[Statement, ...]


def judge(statements: Iterable[Statement], unconverged: str = "") -> Verdict:
    """Return the verdict that follows from statements.

    Reproduced: all hold, on the paper's grid and converged. Trend only: some hold when converged;
    or all do, but not on the paper's grid, or some run did not converge. Cannot be reproduced:
    none holds when converged.

    Parameters
    ----------
    statements : iterable of Statement
        Statements of the paper.
    unconverged : str
        Which converged runs failed, in words; empty if none did.
    """
    statements = tuple(statements)
    fine = [s for s in statements if s.converged is not None]
    wrong = [s.text for s in fine if s.converged and not s.converged.holds]
    on_grid = [s.text for s in statements if s.paper and not s.paper.holds and s.text not in wrong]
    right = [s.text for s in fine if s.text not in (*wrong, *on_grid)]
    reasons = [
        f"{words}: {', '.join(f'“{text}”' for text in texts)}"
        for words, texts in (
            ("holds", right if wrong or on_grid else []),
            ("does not hold", wrong),
            ("holds when converged, but not on the paper's grid", on_grid),
        )
        if texts
    ]
    reasons += [unconverged] if unconverged else []
    both = ", on both grids" if any(s.paper for s in statements) else ""
    reason = "; ".join(reasons) or f"all statements hold{both}"
    word: Word = "trend only" if reasons else "reproduced"
    if len(wrong) == len(fine):
        word = "cannot be reproduced"
    return Verdict(word, f"{reason[0].upper()}{reason[1:]}.", statements)


def counted(verdicts: Iterable[Verdict]) -> str:
    """Return how often each verdict occurs, in words."""
    count = Counter(verdict.word for verdict in verdicts)
    return ", ".join(f"{count[word]} {word}" for word in WORDS)
