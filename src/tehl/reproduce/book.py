"""All runs and what was measured in them: where tables, figures and judgements look things up."""

import json
from collections.abc import Iterable, Mapping
from functools import lru_cache
from pathlib import Path

from tehl.errors import InputError
from tehl.io.atomic import replacing
from tehl.reproduce.measures import Measures, measure
from tehl.reproduce.series import Heat, Run, Series, Treatment
from tehl.result import Result
from tehl.studies import Row, Store

_KEPT_OPEN = 16
"""Results in memory at a time."""


class Book:
    """Runs, their measures and their fields.

    Parameters
    ----------
    store : Store
        Where the results are.
    known : mapping of str to Series
        Series by name.
    runs : iterable of Run
        What was computed.
    notes : Path
        Folder in which measures are kept, so that a second look need not read the fields.
    """

    def __init__(
        self, store: Store, known: Mapping[str, Series], runs: Iterable[Run], notes: Path
    ) -> None:
        self.store, self.series, self.notes = store, known, notes
        self.runs = list(runs)
        self._by_place = {(r.series, r.treatment, r.heat, r.value): r for r in self.runs}
        self._measures: dict[str, Measures | None] = {}
        self._rows: dict[str, Row] = store.rows(run.case for run in self.runs)
        self.result = lru_cache(maxsize=_KEPT_OPEN)(self._load)

    def run(self, series: str, treatment: Treatment, heat: Heat, value: float) -> Run | None:
        """Return a run, None where it is not among those computed.

        Where the fine grid has no converged answer and a coarser one has, that is the run.
        """
        run = self._by_place.get((series, treatment, heat, value))
        coarser = self._by_place.get((series, "coarser", heat, value))
        if treatment != "converged" or run is None or coarser is None or self.answers(run):
            return run
        return coarser if self.answers(coarser) else run

    def answers(self, run: Run) -> bool:
        """Whether a run has converged, with a minimum film that is known."""
        row = self.row(run)
        return row is not None and row.converged and row.hint is None

    def line(self, series: str, treatment: Treatment, heat: Heat) -> dict[float, Measures]:
        """Return the measures of a series computed one way, by what varies."""
        found = {}
        for value in self.series[series].values:
            run = self.run(series, treatment, heat, value)
            measures = None if run is None else self.measures(run)
            if measures is not None:
                found[value] = measures
        return found

    def row(self, run: Run) -> Row | None:
        """Return how a run ended, None when it was not made."""
        return self._rows.get(run.case.key)

    def measures(self, run: Run) -> Measures | None:
        """Return what was measured in a run; None where it left no fields."""
        key = run.case.key
        if key not in self._measures:
            self._measures[key] = self._measured(run)
        return self._measures[key]

    def is_measured(self, run: Run) -> bool:
        """Whether the measures of a run are kept, or it left nothing to measure."""
        kept = (self.notes / f"{run.case.key}.json").is_file()
        return kept or not self.store.fields_path(run.case).is_file()

    def _measured(self, run: Run) -> Measures | None:
        path = self.notes / f"{run.case.key}.json"
        if path.is_file() and self.store.fields_path(run.case).is_file():
            try:
                return Measures.from_dict(json.loads(path.read_text(encoding="utf-8")))
            except (ValueError, KeyError, TypeError):
                path.unlink(missing_ok=True)
        result = self.store.result(run.case)
        if result is None:
            return None
        measures = measure(result)
        self.notes.mkdir(parents=True, exist_ok=True)
        with replacing(path) as temporary:
            temporary.write_text(json.dumps(measures.as_dict()), encoding="utf-8")
        return measures

    def _load(self, run: Run) -> Result:
        result = self.store.result(run.case)
        if result is None:
            raise InputError(f"the fields of {run.case.name} are not in {self.store.directory}")
        return result
