"""The problem as users have it, which explains what to expect before the solve."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tehl.base.errors import InputError
from tehl.base.lazy import lazy
from tehl.contact import problem as plain
from tehl.contact.options import Options, check_nodes

if TYPE_CHECKING:
    from tehl.io import case
    from tehl.report import explain as explanations
else:
    case, explanations = lazy("tehl.io.case"), lazy("tehl.report.explain")


class ContactProblem(plain.ContactProblem):
    """A lubricated contact.

    Its fields are the tables of the case file, so that reading a case is validating the parsed
    file.
    """

    @classmethod
    def of(cls, problem: plain.ContactProblem) -> "ContactProblem":
        """Return a checked problem as one that can explain itself."""
        if isinstance(problem, cls):
            return problem
        values = {name: getattr(problem, name) for name in type(problem).model_fields}
        return cls.model_construct(problem.model_fields_set, **values)

    def explain(self, options: Options | None = None) -> "explanations.Explanation":
        """Return what ``tehl explain`` prints, a :class:`tehl.report.explain.Explanation`.

        ``options`` are the :class:`tehl.Options` of the solve; the defaults if left out.
        """
        return explanations.explain(self, options)


def read_case(path: str | Path) -> ContactProblem:
    """Return the problem of a case file as :func:`read_case_and_options`, without its options."""
    return read_case_and_options(path)[0]


def read_case_and_options(
    path: str | Path, overrides: Sequence[str] = ()
) -> tuple[ContactProblem, Options]:
    """Return problem and numerical options of a case file.

    Parameters
    ----------
    path : str or Path
        TOML file.
    overrides : sequence of str
        Overrides such as ``"numerics.points=513"`` or ``"contact.load=100 N"``, applied before
        anything is checked.

    Raises
    ------
    InputError
        If the file is not a valid case file or an override is invalid; the message names key,
        value, unit and what is expected.
    """
    problem, options = case.read_case_and_options(path, overrides)
    return ContactProblem.of(problem), options


def case_from_tables(
    tables: Mapping[str, Any], folder: Path | None = None
) -> tuple[ContactProblem, Options]:
    """Return problem and options of the parsed tables of a case, checked as those of a file.

    Parameters
    ----------
    tables : Mapping
        As of the TOML of a case file; quantities are texts with a unit, or numbers in SI.
    folder : Path or None
        Where relative paths of measured surfaces begin; None is the working directory.

    Raises
    ------
    InputError
        If a key or a value is invalid, in one sentence.
    """
    problem, options = case.case_from_tables(tables, folder)
    return ContactProblem.of(problem), options


def check_call(problem: object, options: object = None) -> None:
    """Check that a function got a case and options, not the name of a file or a table.

    Parameters
    ----------
    problem, options : object
        What a user passed to a solver or a study; None are the default options.

    Raises
    ------
    InputError
        If they are something else.
    """
    if not isinstance(problem, plain.ContactProblem):
        kind = type(problem).__name__
        raise InputError(f"problem: must be a ContactProblem, not {kind}; tehl.read_case reads one")
    if not isinstance(options, Options | None):
        kind = type(options).__name__
        raise InputError(f"options: must be tehl.Options, not {kind}: Options(error=0.01)")
    if options is not None:
        check_nodes(options)
