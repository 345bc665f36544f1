"""Solution of a transient solve: a film that changes with time while its surfaces move."""

from dataclasses import dataclass, field, replace
from typing import Any, Self

from tehl.base.typing import Array, IntArray, SingleArray
from tehl.result.bars import Estimate
from tehl.result.solution import Cost, Provenance, Solution, Status

TIME_OVER = "time_over"
"""Cause of a solve or run that ended early at ``numerics.max_time``."""


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
    speed: Array
    radius: Array
    """Load, entrainment speed and radius along x, over those of the contact [-]."""
    sliding: Array
    """u_1 - u_2 over the entrainment speed of the contact [-]."""
    film_central: Array
    film_minimum: Array
    """Film at the centre, and the least between the nodes, as of a steady film [m]."""
    pressure_max: Array
    """Largest pressure of the oil; of oil and contact together if there is a boundary film [Pa]."""
    traction: Array
    """Mid-film traction coefficient of the film, over the load at that time [-]."""
    traction_across: Array
    """The same along y; zero where nothing slides across the entrainment [-]."""
    drilling_moment: Array
    """Moment of both stresses about the normal through the centre; zero without spin [N m]."""
    rolling_moment: Array
    """Moment of the pressure of a roller, or of one metre of a line contact, about the middle, with
    that of the oil upstream of the grid; zero of other contacts [N m]."""
    asperity_load: Array
    """Load on asperities finer than the grid, and where surfaces touch through a boundary film,
    over the load at that time [-]; zero without."""
    solid_friction: Array
    """Friction of both, positive, over the load at that time [-]."""
    rigid_approach: Array
    """H00 [-]."""
    temperature_rise: Array
    """Largest rise of the film over the oil at the inlet [K]; zero where it is isothermal."""
    nodes: IntArray
    """Nodes along x: a contact that grows may go on with half of them."""
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
    stress: SingleArray | None = None
    """tau_zx of the oil at mid-film, of a case with [stress] [Pa]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class HistoryBars:
    """Half widths of the error bars of a history, at the times that its grids share; (nb,)."""

    time: Array
    """[s]; steps of the history that they belong to."""
    film_central: Array
    film_minimum: Array
    """Of the film at the centre, and of the least between the nodes [m]."""
    pressure_max: Array
    """Of the largest pressure [Pa]. NaN, as ``film_minimum``, without a limit at roller ends."""


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class TransientSolution:
    """Solution of one transient solve."""

    start: Solution
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
    where the film is heated, and of largest magnitude ``"traction_extreme"``, where it is heated or
    thins and slides, ``"traction_across_extreme"`` and ``"drilling_moment_extreme"`` where there
    are these, and ``"rolling_moment_extreme"`` of lines and rollers."""
    bars: HistoryBars | None = None
    """Error bars along the history of a certified run."""

    def but(self, **changes: Any) -> Self:
        """Return the same solution with other fields."""
        return replace(self, **changes)

    @property
    def certified(self) -> dict[str, Estimate]:
        """Extremes of a certified run with their error bars, in SI."""
        return self.uncertainty

    @property
    def x(self) -> Array:
        """Coordinates along entrainment [m], (nx,)."""
        return self.start.x

    @property
    def y(self) -> Array:
        """Coordinates across entrainment [m], (ny,)."""
        return self.start.y
