"""A study in one call, without a study file."""

from collections.abc import Mapping, Sequence
from contextlib import closing, nullcontext
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError

from tehl.errors import InputError
from tehl.options import Options
from tehl.problem import ContactProblem
from tehl.studies.axes import Axis, Sample
from tehl.studies.file import StudyFile, first_mistake, plan_of
from tehl.studies.plan import Study, study_of
from tehl.studies.runner import run
from tehl.studies.store import Store
from tehl.studies.tables import table

if TYPE_CHECKING:
    import pandas as pd

Axes = Mapping[str, Sequence[Any]] | Sequence[Axis]


def cases_of(
    problem: ContactProblem,
    axes: Axes,
    options: Options | None = None,
    *,
    sample: Sample | None = None,
    certify: bool = False,
) -> Study:
    """Return the cases of a problem along axes, and the units of their labels.

    Parameters
    ----------
    problem : ContactProblem
        The base case.
    axes : mapping of str to sequence, or sequence of Axis
        Dotted paths of the case with their values, numbers in SI or strings with units:
        ``{"contact.load": ["20 N", "50 N"]}``. The cases are their grid, the last axis the
        fastest. An :class:`Axis` can be sampled and zipped too.
    options : Options
        Numerical options; paths that begin with ``numerics`` change them.
    sample : Sample or None
        How sampled axes take their values.
    certify : bool
        Error bars for each case.

    Raises
    ------
    InputError
        If an axis is not valid; the message names it.
    """
    base = problem.model_dump(mode="json", exclude_unset=True)
    base["numerics"] = (options or Options()).model_dump(mode="json", exclude_unset=True)
    try:
        if isinstance(axes, Mapping):
            axes = [Axis(path=path, values=list(values)) for path, values in axes.items()]
        stated = StudyFile(
            case=base, axes=list(axes), sample=sample, certify=certify, title=problem.title
        )
        return study_of(plan_of(stated, Path(), unlimited=True))
    except ValidationError as error:
        raise InputError(first_mistake(error, {})) from None
    except ValueError as error:
        raise InputError(str(error)) from None


def study(
    problem: ContactProblem,
    axes: Axes,
    options: Options | None = None,
    *,
    store: Store | str | Path | None = None,
    jobs: int = 1,
    certify: bool = False,
) -> "pd.DataFrame":
    """Solve a problem along axes; return one row per case.

    For clusters, sampled axes and kept fields, take its parts :func:`cases_of`, :func:`run` and
    :func:`table`.

    Parameters
    ----------
    problem, axes, options, certify
        As in :func:`cases_of`.
    store : Store, str, Path or None
        Where finished cases are kept and found again; nowhere if left out.
    jobs : int
        Processes. With more than one, a script needs ``if __name__ == "__main__":``.

    Returns
    -------
    pandas.DataFrame
        As :func:`table` returns it: ``frame.attrs["units"]`` has the units. Of a full grid,
        ``frame.set_index(list(axes)).to_xarray()`` is the dataset over the axes.

    Raises
    ------
    InputError
        If an axis is not valid; the message names it.
    """
    found = cases_of(problem, axes, options, certify=certify)
    with TemporaryDirectory() if store is None else nullcontext(store) as place:
        kept = place if isinstance(place, Store) else Store(place)
        with closing(kept):
            run(found.cases, kept, jobs=jobs)
            return table(found.cases, kept, found.units)
