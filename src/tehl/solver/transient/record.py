"""Record of a transient run, step by step, and its conversion to arrays in SI."""

from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np

from tehl.errors import InputError
from tehl.scaling import Scales
from tehl.solver.film_summary import film_summary
from tehl.solver.level import Level
from tehl.transient import Transient
from tehl.transient_result import Frames, History, Profiles
from tehl.typing import Array

Heights = tuple[Array, Array]
COLUMNS = tuple(one.name for one in fields(History))


@dataclass(slots=True)
class Record:
    """Numbers, profiles and fields of the steps so far, scaled.

    Attributes
    ----------
    rows : list of tuple
        Per step, the columns of `tehl.transient_result.History`.
    profiles : list of (4, nx) array
        Per step, pressure, film and both heights along y = 0.
    frame_steps : list of int
        Steps whose fields are stored.
    frames : list of (3, ny, nx) array
        Their pressure, film and height.
    """

    rows: list[tuple[float, ...]] = field(default_factory=list)
    profiles: list[Array] = field(default_factory=list)
    frame_steps: list[int] = field(default_factory=list)
    frames: list[Array] = field(default_factory=list)

    def note(
        self, level: Level, heights: Heights, numbers: dict[str, float], *, keep: bool
    ) -> None:
        """Append a step.

        Parameters
        ----------
        level : Level
            The finest level after the step.
        heights : (array, array)
            Heights of both surfaces, ``grid.shape`` [-].
        numbers : dict of str to float
            Columns of the history besides film, pressure and rigid approach.
        keep : bool
            Whether to store the fields.
        """
        film = film_summary(level.grid, level.film.h)
        row = numbers | {
            "film_central": film.central,
            "film_minimum": film.minimum,
            "pressure_max": float(level.film.p.max()),
            "rigid_approach": level.rigid_approach,
        }
        self.rows.append(tuple(float(row[name]) for name in COLUMNS))
        line = 0 if level.grid.mirror else level.grid.shape[0] // 2
        lines = (level.film.p, level.film.h, *heights)
        self.profiles.append(np.stack([one[line] for one in lines]))
        if keep:
            self.frame_steps.append(len(self.rows) - 1)
            together = heights[0] + heights[1]
            whole = [level.grid.unfold(one) for one in (level.film.p, level.film.h, together)]
            self.frames.append(np.stack(whole).astype(np.float32))

    def copy(self) -> "Record":
        """Return a copy that later steps do not change."""
        return Record(
            rows=self.rows.copy(),
            profiles=self.profiles.copy(),
            frame_steps=self.frame_steps.copy(),
            frames=self.frames.copy(),
        )

    def history(self, scales: Scales) -> History:
        """Return the numbers of all steps, in SI."""
        units = {
            "film_central": scales.film_thickness,
            "film_minimum": scales.film_thickness,
            "pressure_max": scales.hertz_pressure,
        }
        columns: dict[str, Any] = {
            name: column * units.get(name, 1.0)
            for name, column in zip(COLUMNS, np.array(self.rows).T, strict=True)
        }
        return History(**columns | {"cycles": columns["cycles"].astype(np.int64)})

    def lines(self, scales: Scales) -> Profiles:
        """Return the profiles of all steps, in SI."""
        pressure, film, first, second = np.moveaxis(np.stack(self.profiles), 1, 0)
        thickness = scales.film_thickness
        return Profiles(
            pressure=pressure * scales.hertz_pressure,
            film=film * thickness,
            height_1=first * thickness,
            height_2=second * thickness,
        )

    def fields(self, scales: Scales, shape: tuple[int, int]) -> Frames:
        """Return the stored fields, in SI; ``shape`` is that of the full domain."""
        stack = np.stack(self.frames) if self.frames else np.zeros((0, 3, *shape), np.float32)
        units = (scales.hertz_pressure, scales.film_thickness, scales.film_thickness)
        pressure, film, height = (
            np.asarray(stack[:, k] * np.float32(unit), np.float32) for k, unit in enumerate(units)
        )
        return Frames(
            step=np.array(self.frame_steps, np.int64), pressure=pressure, film=film, height=height
        )


def kept_steps(transient: Transient, steps: int, seconds: float) -> set[int]:
    """Return the steps whose fields are stored: evenly spaced, or nearest to stated times.

    Parameters
    ----------
    transient : Transient
        ``frames`` is their number, or their times [s].
    steps : int
        Number of steps of the run.
    seconds : float
        Time step [s].

    Raises
    ------
    InputError
        If a stated time is after the end.
    """
    if isinstance(transient.frames, int):
        every = steps / max(transient.frames - 1, 1)
        return {round(n * every) for n in range(transient.frames)}
    late = [time for time in transient.frames if time > (steps + 0.5) * seconds]
    if late:
        raise InputError(
            f"transient.frames = {late[0]:g} s: after the end of the run at {steps * seconds:.4g} s"
        )
    return {min(round(time / seconds), steps) for time in transient.frames}
