"""Anderson acceleration of the multigrid cycle: a step combined of what earlier cycles did."""

import numpy as np

from tehl.typing import Array

WORSE = 3.0
"""Change by a cycle, over the least one remembered, at which the memory is of another state."""
INDEPENDENT = 1e-6
"""Relative size of a combination of changes below which it says nothing."""


class Anderson:
    """The minimiser of the change by a cycle among the combinations of the last cycles.

    A cycle that is unstable in a few modes, because a coarse grid sees rough surfaces of another
    shape, converges with it (D. G. Anderson 1965; as a Krylov method, Walker and Ni 2011).

    Parameters
    ----------
    memory : int
        Cycles to remember besides the last.
    """

    def __init__(self, memory: int) -> None:
        self.memory = memory
        self.states: list[Array] = []
        self.changes: list[Array] = []

    def combine(self, before: Array, after: Array) -> Array:
        """Return the state to go on from.

        Parameters
        ----------
        before, after : (n,) array
            The state that the last cycle began with and the one it ended with.
        """
        change = after - before
        size = np.linalg.norm(change)
        if self.changes and not size <= WORSE * min(map(np.linalg.norm, self.changes)):
            self.states, self.changes = [], []
        self.states = [*self.states, before][-self.memory - 1 :]
        self.changes = [*self.changes, change][-self.memory - 1 :]
        if len(self.changes) == 1:
            return after
        by_state = np.stack([before - earlier for earlier in self.states[:-1]], axis=1)
        by_change = np.stack([change - earlier for earlier in self.changes[:-1]], axis=1)
        weights = np.linalg.lstsq(by_change, change, rcond=INDEPENDENT)[0]
        combined: Array = after - (by_state + by_change) @ weights
        return combined
