"""Result of a transient solve: a film that changes with time while its surfaces move."""

from dataclasses import dataclass, field

from tehl.result import Cost, Estimate, Provenance, Result, Status
from tehl.saved import Saved
from tehl.typing import Array, IntArray, SingleArray


@dataclass(frozen=True, kw_only=True, slots=True)
class StepReport:
    """One time step, as reported to a monitor.

    Attributes
    ----------
    step, steps : int
        Number of the step, and total number of steps.
    time : float
        [s].
    cycles : int
        Multigrid cycles of the step.
    change, load_error : float
        Of P in the last of them, and of the load balance [-].
    film_central, film_minimum : float
        H at the centre, and the least between the nodes [-].
    pressure_max : float
        Largest P [-].
    smoother : str
        Setting of the relaxation that converged.
    """

    step: int
    steps: int
    time: float
    cycles: int
    change: float
    load_error: float
    film_central: float
    film_minimum: float
    pressure_max: float
    smoother: str


@dataclass(frozen=True, kw_only=True, slots=True)
class History:
    """Numbers of each step, beginning with the steady film at time zero; all of shape (nt,).

    Attributes
    ----------
    time : array
        [s].
    load : array
        Over that of the contact [-].
    film_central, film_minimum : array
        Film at the centre, and the least between the nodes, as of a steady film [m].
    pressure_max : array
        Largest pressure [Pa].
    traction : array
        Mid-film traction coefficient, over the load at that time [-].
    rigid_approach : array
        H00 [-].
    temperature_rise : array
        Largest rise of the film over the oil at the inlet [K]; zero where it is isothermal.
    cycles : array of int
        Multigrid cycles of the step.
    change : array
        Largest change of P in the last of them [-].
    """

    time: Array
    load: Array
    film_central: Array
    film_minimum: Array
    pressure_max: Array
    traction: Array
    rigid_approach: Array
    temperature_rise: Array
    cycles: IntArray
    change: Array


@dataclass(frozen=True, kw_only=True, slots=True)
class Profiles:
    """The line y = 0 at each step, (nt, nx).

    Attributes
    ----------
    pressure, film : array
        [Pa] and [m].
    height_1, height_2 : array
        Heights of both surfaces, positive outwards [m].
    """

    pressure: Array
    film: Array
    height_1: Array
    height_2: Array


@dataclass(frozen=True, kw_only=True, slots=True)
class Frames:
    """Fields at chosen times, (nf, ny, nx) in single precision.

    Attributes
    ----------
    step : array of int
        Steps of the history that they belong to, (nf,).
    pressure, film, height : array
        [Pa], [m] and the heights of both surfaces together [m].
    """

    step: IntArray
    pressure: SingleArray
    film: SingleArray
    height: SingleArray


@dataclass(frozen=True, kw_only=True, slots=True)
class HistoryBars:
    """Half widths of the error bars of a history, at the times that its grids share; (nb,).

    Attributes
    ----------
    time : array
        [s]; steps of the history that they belong to.
    film_central, film_minimum : array
        Of the film at the centre, and of the least between the nodes [m].
    pressure_max : array
        Of the largest pressure [Pa].
    """

    time: Array
    film_central: Array
    film_minimum: Array
    pressure_max: Array


@dataclass(frozen=True, kw_only=True, slots=True)
class TransientResult(Saved):
    """Result of one transient solve.

    Attributes
    ----------
    start : Result
        The steady film at time zero; its problem and options are those of the run.
    history : History
        Numbers of each step.
    profiles : Profiles
        The line y = 0 at each step.
    frames : Frames
        Fields at chosen times.
    time_step : float
        [s].
    status : Status
        How the run ended.
    cost, provenance : Cost, Provenance
        Computing cost, including the start, and origin; of a certified run that of all grids.
    uncertainty : dict of str to Estimate
        Of a certified run, extremes over time in SI with their error bars: ``"film_minimum"``,
        ``"film_central_least"``, ``"film_central_largest"``, ``"pressure_max"``,
        ``"film_rise_max"`` where the film is heated, and ``"traction_extreme"``, that of largest
        magnitude, where it is heated or thins and slides.
    bars : HistoryBars or None
        Error bars along the history of a certified run.
    """

    start: Result
    history: History
    profiles: Profiles
    frames: Frames
    time_step: float
    status: Status
    cost: Cost
    provenance: Provenance
    uncertainty: dict[str, Estimate] = field(default_factory=dict)
    bars: HistoryBars | None = None

    @property
    def x(self) -> Array:
        """Coordinates along entrainment [m], (nx,)."""
        return self.start.x

    @property
    def y(self) -> Array:
        """Coordinates across entrainment [m], (ny,)."""
        return self.start.y
