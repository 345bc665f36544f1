"""The state of a transient run: what it needs to go on, and what it has cost so far."""

import time
from dataclasses import dataclass, replace

from tehl.result import Cost
from tehl.solver.record import Record
from tehl.typing import Array

NOTHING = Cost(cpu_seconds=0.0, wall_seconds=0.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class Snapshot:
    """All that a run needs to go on as if it had not been interrupted.

    Attributes
    ----------
    setting : int
        Number of the setting of the relaxation.
    rigid_approach : float
        H00 [-].
    fields : dict of str to array
        Pressure, mass of the last two films and what of it moves without being there, what the
        pressure of the last four steps differed by from that of the beginning, and what the
        coupling remembers.
    record : Record
        What has been noted so far.
    cost : Cost
        Expense so far, that of the start included.
    """

    setting: int
    rigid_approach: float
    fields: dict[str, Array]
    record: Record
    cost: Cost = NOTHING

    def copy(self) -> "Snapshot":
        """Return a snapshot that the run does not change any more."""
        fields = {name: field.copy() for name, field in self.fields.items()}
        return replace(self, fields=fields, record=self.record.copy())


class Clock:
    """Measures what a run costs from now on, on top of what its earlier parts have cost."""

    def __init__(self) -> None:
        self.before = NOTHING
        self._wall, self._cpu = time.perf_counter(), time.process_time()

    def cost(self) -> Cost:
        """Return the expense so far."""
        return Cost(
            cpu_seconds=self.before.cpu_seconds + time.process_time() - self._cpu,
            wall_seconds=self.before.wall_seconds + time.perf_counter() - self._wall,
        )
