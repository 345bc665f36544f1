"""Result of a transient solve: a film that changes with time while its surfaces move."""

from contextlib import suppress
from dataclasses import dataclass, field

from tehl.base.errors import InputError
from tehl.base.typing import Array, IntArray, SingleArray
from tehl.estimate.duration import whole_passing
from tehl.estimate.scaling import ScaledProblem
from tehl.post.boundary_contact import largest_patches, why_unknown
from tehl.result.result import Result
from tehl.result.saved import Saved
from tehl.result.solution import Cost, Estimate, Provenance, Status

LATE, NOTICED, FEW_STEPS = 0.1, 0.01, 20
"""Last part of a run in which an extreme is late, by which part of it it must then have grown, and
fewest steps that show it."""
LONGER, ROUNDING = 2.0, 1e-9
"""Duration to try over that of a run whose extremes are late, and equal durations."""


@dataclass(frozen=True, kw_only=True, slots=True)
class StepReport:
    """One time step, as reported to a monitor."""

    step: int
    steps: int
    """Number of the step, and total number of steps."""
    time: float
    """[s]."""
    cycles: int
    """Multigrid cycles of the step."""
    change: float
    load_error: float
    """Of P in the last of them, and of the load balance [-]."""
    film_central: float
    film_minimum: float
    """H at the centre, and the least between the nodes [-]."""
    pressure_max: float
    """Largest P [-]."""
    smoother: str
    """Setting of the relaxation that converged."""


@dataclass(frozen=True, kw_only=True, slots=True)
class History:
    """Numbers of each step, beginning with the steady film at time zero; all of shape (nt,)."""

    time: Array
    """[s]."""
    load: Array
    """Over that of the contact [-]."""
    film_central: Array
    film_minimum: Array
    """Film at the centre, and the least between the nodes, as of a steady film [m]."""
    pressure_max: Array
    """Largest pressure of the oil; of oil and contact together if there is a boundary film [Pa]."""
    traction: Array
    """Mid-film traction coefficient of the film, over the load at that time [-]."""
    asperity_load: Array
    """Load on asperities finer than the grid, or where surfaces touch through a boundary film, over
    the load at that time [-]; zero without."""
    rigid_approach: Array
    """H00 [-]."""
    temperature_rise: Array
    """Largest rise of the film over the oil at the inlet [K]; zero where it is isothermal."""
    cycles: IntArray
    """Multigrid cycles of the step."""
    change: Array
    """Largest change of P in the last of them [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Profiles:
    """The line y = 0 at each step, (nt, nx)."""

    pressure: Array
    film: Array
    """[Pa] and [m]."""
    height_1: Array
    height_2: Array
    """Heights of both surfaces, positive outwards [m]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Frames:
    """Fields at chosen times, (nf, ny, nx) in single precision."""

    step: IntArray
    """Steps of the history that they belong to, (nf,)."""
    pressure: SingleArray
    film: SingleArray
    height: SingleArray
    """[Pa], with that of the contact if there is a boundary film; [m]; and the heights of both
    surfaces together [m]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class HistoryBars:
    """Half widths of the error bars of a history, at the times that its grids share; (nb,)."""

    time: Array
    """[s]; steps of the history that they belong to."""
    film_central: Array
    film_minimum: Array
    """Of the film at the centre, and of the least between the nodes [m]."""
    pressure_max: Array
    """Of the largest pressure [Pa]."""


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class TransientResult(Saved):
    """Result of one transient solve."""

    start: Result
    """The steady film at time zero; its problem and options are those of the run."""
    history: History
    """Numbers of each step."""
    profiles: Profiles
    """The line y = 0 at each step."""
    frames: Frames
    """Fields at chosen times."""
    time_step: float
    """[s]."""
    status: Status
    """How the run ended."""
    cost: Cost
    provenance: Provenance
    """Computing cost, including the start, and origin; of a certified run that of all grids."""
    uncertainty: dict[str, Estimate] = field(default_factory=dict)
    """Of a certified run, extremes over time in SI with their error bars: ``"film_minimum"``,
    ``"film_central_least"``, ``"film_central_largest"``, ``"pressure_max"``, ``"film_rise_max"``
    where the film is heated, and ``"traction_extreme"``, that of largest magnitude, where it is
    heated or thins and slides."""
    bars: HistoryBars | None = None
    """Error bars along the history of a certified run."""

    @property
    def friction(self) -> Array | None:
        """Friction of film and solid contact together over the load at that time, positive [-].

        None without asperities or a boundary film, and where the share of these is not known.
        """
        problem = self.start.problem
        solid = problem.asperities or problem.contact_film
        if solid is None or (problem.contact_film is not None and self.why_share_unknown):
            return None
        slides = problem.slide_roll_ratio != 0.0
        rubbed = solid.friction * self.history.asperity_load if slides else 0.0
        return abs(self.history.traction) + rubbed

    @property
    def late_extremes(self) -> tuple[str, ...]:
        """Extremes that were reached at the end of a run whose duration is not stated.

        They may grow in a longer one: a periodic or mirrored map goes on to pass the contact.
        """
        transient, time = self.start.problem.transient, self.history.time
        if transient is None or transient.duration is not None or time.size < FEW_STEPS:
            return ()
        early = time <= (1.0 - LATE) * time[-1]
        extremes = (
            ("minimum film", "film_minimum", -self.history.film_minimum),
            ("largest pressure", "pressure_max", self.history.pressure_max),
        )
        bars = {name: one.uncertainty for name, one in self.uncertainty.items()}
        return tuple(
            words
            for words, name, values in extremes
            if values.max() - values[early].max()
            > max(NOTICED * abs(values.max()), bars.get(name, 0.0))
        )

    @property
    def longer_duration(self) -> float | None:
        """Duration to state where the default one ended early [s]; None where it did not.

        It lasts until maps that repeat at their edges have passed whole, or twice as long where
        extremes changed at the end.
        """
        transient, end = self.start.problem.transient, float(self.history.time[-1])
        if transient is None or transient.duration is not None or not self.status.converged:
            return None
        needed = LONGER * end if self.late_extremes else 0.0
        with suppress(InputError):  # the file of a map that a stored result need not have
            needed = max(needed, whole_passing(ScaledProblem.of(self.start.problem)))
        return needed if needed > (1.0 + ROUNDING) * end else None

    @property
    def patch_cells(self) -> float:
        """Largest mean diameter, or width, of patches of contact in the frames [mesh widths].

        Zero where surfaces do not touch through a boundary film in any of them.
        """
        film, frames = self.start.problem.contact_film, self.frames
        return (
            0.0 if film is None else largest_patches(film.thickness, frames.film, frames.pressure)
        )

    @property
    def why_share_unknown(self) -> str:
        """Why the share where surfaces touch means nothing, in words; empty if it is known."""
        start = self.start.touching
        return why_unknown(self.patch_cells, start.share_error if start else 0.0)

    @property
    def x(self) -> Array:
        """Coordinates along entrainment [m], (nx,)."""
        return self.start.x

    @property
    def y(self) -> Array:
        """Coordinates across entrainment [m], (ny,)."""
        return self.start.y
