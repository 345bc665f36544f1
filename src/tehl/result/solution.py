"""The solution of a steady problem: fields, film numbers, status, error bars; frozen."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from operator import attrgetter
from typing import Any, Generic, Literal, Self, TypeVar, overload

from tehl.base.errors import TehlError
from tehl.base.typing import Array
from tehl.base.wording import toml_value
from tehl.contact.moment import moment_at
from tehl.contact.options import Options
from tehl.contact.problem import ContactProblem
from tehl.estimate.scaling import Groups, ScaledProblem, Scales
from tehl.result.bars import ErrorEstimate, Estimate
from tehl.result.fields import (
    BodyStress,
    Fields,
    FilmAsperities,
    FilmContact,
    FilmDynamics,
    FilmHeat,
    FilmOil,
    FilmShear,
    FilmSummary,
    PassHistory,
    SurfaceHeights,
)
from tehl.roughness.resolution import Resolution

Value = TypeVar("Value")
StatusKind = Literal["converged", "not_converged", "diverged", "stalled"]
Settings = Mapping[str, bool | int | float | str | dict[str, str]]
"""Values to set in a case, by dotted keys: ``{"numerics.points": 257}``; False removes a key."""


@dataclass(frozen=True, slots=True)
class Hint:
    """What to try after a failure: settings and the reason for them, or advice alone."""

    advice: str = ""
    settings: Settings = field(default_factory=dict)

    def __str__(self) -> str:
        text = settings_text(self.settings)
        text = f"{text[:1].upper()}{text[1:]}"
        return f"{text}: {self.advice}" if text and self.advice else self.advice or f"{text}."


def settings_text(settings: Settings) -> str:
    """Return settings in words: set numerics.points = 257 and remove numerics.domain."""
    return " and ".join(
        f"remove {key}" if value is False else f"set {key} = {toml_value(value)}"
        for key, value in settings.items()
    )


@dataclass(frozen=True, kw_only=True, slots=True)
class Status:
    """How a solve ended, for programs and for people."""

    kind: StatusKind
    """The outcome."""
    cause: str | None = None
    """Name of the cause when not converged, for programs: ``"grid_too_coarse"``."""
    message: str | None = None
    hint: Hint | None = None
    """The cause and what to try. In a converged certified result ``message`` says how its grids
    ended; a ``hint`` in a converged result means that its minimum film is uncertain, and names the
    grid to try."""

    @property
    def converged(self) -> bool:
        """Whether the solve converged."""
        return self.kind == "converged"

    @property
    def is_vague(self) -> bool:
        """Whether a film converged but is uncertain: its minimum between peaks, or ``cause``."""
        return self.converged and self.hint is not None

    @property
    def outcome(self) -> str:
        """The outcome in words, with the cause if it adds to the kind."""
        if self.is_vague:
            return f"converged, {(self.cause or 'minimum film open').replace('_', ' ')}"
        kind = self.kind.replace("_", " ")
        if self.cause in (None, self.kind):
            return kind
        return f"{kind}: {self.cause.replace('_', ' ')}"


@dataclass(frozen=True, kw_only=True, slots=True)
class CycleReport:
    """One multigrid cycle, as shown in the live table and stored in the history."""

    points: tuple[int, int]
    """Nodes (nx, ny) of the grid, of the full domain."""
    cycle: int
    """Number of the cycle on this grid, from 1."""
    residual: float
    """Mean of ``|r|`` scaled by the local diagonal, over wet nodes [-]."""
    change: float
    """Largest change of pressure in this cycle, in Hertz pressures [-]."""
    load_error: float
    """Relative error of the load balance [-]."""
    film_central: float
    film_minimum: float
    """H at X = Y = 0 and smallest H after this cycle, at nodes, between lines that crowd [-]."""
    smoother: str
    """Setting of the relaxation that was used."""
    temperature_change: float = 0.0
    """Largest change of the film temperature in this cycle, where the pressure exceeds a fiftieth
    of the Hertz pressure [K]; zero in an isothermal run."""
    temperature_rise: float = 0.0
    """Largest rise of the film temperature over the inlet, or largest fall, negative, if that is
    larger [K]; zero in an isothermal run; not stored."""
    mean_change: float = 0.0
    """Sum of the changes of pressure in this cycle over the sum of pressures [-]; not stored."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Cost:
    """Computing cost of a solve."""

    cpu_seconds: float
    wall_seconds: float
    """Of the solve, without compiling and without files."""
    work: float | None = None
    """``cpu_seconds`` in units of one FFT deformation on the same full grid, if it was measured."""

    def __add__(self, other: "Cost") -> "Cost":
        """Return the sum of the seconds of two solves."""
        return Cost(
            cpu_seconds=self.cpu_seconds + other.cpu_seconds,
            wall_seconds=self.wall_seconds + other.wall_seconds,
        )


NO_COST = Cost(cpu_seconds=0.0, wall_seconds=0.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class Provenance:
    """Where a result comes from: versions by package name, and when it was made (ISO 8601)."""

    versions: dict[str, str]
    created: str


@dataclass(frozen=True, kw_only=True, slots=True)
class Supplied:
    """Oil of a contact whose cavities conserve it, beside that of the flooded contact."""

    flooded_film: float | None
    flooded_oil: float | None
    """Central film H, and rho H there, of the same contact fully flooded and smooth, on its own
    grid [-]; None if that did not converge, or is this contact."""
    flooded_error: float
    """Relative error bar of both [-]."""
    balance: float
    """Largest change of the oil flux over the sections across the flow, relative [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Account:
    """How a solve went: outcome, cycles, errors, heights that the grid resolves, cost."""

    status: Status
    """How it ended."""
    history: tuple[CycleReport, ...]
    """Each cycle on each grid."""
    errors: ErrorEstimate | None
    """Estimated errors; None if the solve ended too early for them."""
    cost: Cost
    provenance: Provenance
    """Computing cost and origin."""
    resolution: Resolution | None = None
    """Which part of the stated heights the grid carries; None when both surfaces are smooth."""
    uncertainty: dict[str, Estimate] = field(default_factory=dict)
    """Of a certified result, dimensionless as the solver has them, rises in kelvin; ``certified``
    has them in SI."""
    time: float | None = None
    """When this film of a transient run was [s]; None of a steady one, and of that at the start."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Extras:
    """What only some contacts have beside pressure and film; None without."""

    shear: FilmShear | None = None
    """Shear stresses; None without a valid film."""
    heat: FilmHeat | None = None
    """Temperatures; None in an isothermal run."""
    heights: SurfaceHeights | None = None
    """Heights of rough surfaces; None when both are smooth."""
    asperities: FilmAsperities | None = None
    """Asperities finer than the grid; None without."""
    contact: FilmContact | None = None
    """Contact through a boundary film; None without."""
    oil: FilmOil | None = None
    """Where the oil is; None if cavities do not conserve it."""
    supplied: Supplied | None = None
    """Supply over that of the flooded contact, and balance of the oil; None like ``oil``."""
    bodies: tuple[float, float] | None = None
    """Temperatures of both bodies that follow from their heat [K]; None where all are stated."""
    tilt: float | None = None
    """Tilt of a roller that follows from the moment of its load [rad]; None where it is stated."""
    passes: PassHistory | None = None
    """Earlier passes of the same surfaces and this one; None of a single film."""
    stress: BodyStress | None = None
    """Stress below the surfaces; None if the case does not ask for it."""
    dynamics: FilmDynamics | None = None
    """Stiffness and damping; None unless the case states ``[dynamics]``."""


class _Of(Generic[Value]):
    """An attribute of a solution that is one of its ``account`` or of its ``extras``."""

    def __init__(self, part: str) -> None:
        self._part = part

    def __set_name__(self, owner: type, name: str) -> None:
        self._get = attrgetter(f"{self._part}.{name}")

    @overload
    def __get__(self, solution: None, owner: type) -> Self: ...

    @overload
    def __get__(self, solution: "Solution", owner: type) -> Value: ...

    def __get__(self, solution: "Solution | None", owner: type) -> Self | Value:
        return self if solution is None else self._get(solution)


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class Solution:
    """Fields and numbers of one steady solve; `tehl.Result` adds what follows from them.

    The parts of ``account`` and ``extras`` are attributes of the solution too, and may be given by
    their own names, also to `dataclasses.replace`.
    """

    problem: ContactProblem
    """The case, in SI."""
    options: Options
    """Numerical options; ``options.domain`` as stated, the domain used is that of ``scaled``."""
    scales: Scales
    groups: Groups
    """Units removed by the solver, and the dimensionless groups."""
    scaled: Fields
    """Dimensionless fields."""
    rigid_approach: float
    """H00 [-]."""
    film_scaled: FilmSummary
    """Film numbers [-]."""
    account: Account
    """How the solve went."""
    extras: Extras
    """What only some contacts have."""

    def __init__(self, **given: Any) -> None:
        for name, kind in (("account", Account), ("extras", Extras)):
            own = {one.name: given.pop(one.name) for one in fields(kind) if one.name in given}
            whole = given.get(name)
            given[name] = kind(**own) if whole is None else replace(whole, **own)
        names = [one.name for one in fields(Solution)]
        if set(names) != given.keys():
            odd = ", ".join(sorted(set(names) ^ given.keys()))
            raise TypeError(f"a solution has missing or unexpected fields: {odd}")
        for name in names:
            object.__setattr__(self, name, given[name])

    def but(self, **changes: Any) -> Self:
        """Return the same solution with other fields, also of ``account`` and ``extras``."""
        return type(self)(**{one.name: getattr(self, one.name) for one in fields(self)} | changes)

    status = _Of[Status]("account")
    history = _Of[tuple[CycleReport, ...]]("account")
    errors = _Of[ErrorEstimate | None]("account")
    cost = _Of[Cost]("account")
    provenance = _Of[Provenance]("account")
    resolution = _Of[Resolution | None]("account")
    uncertainty = _Of[dict[str, Estimate]]("account")
    time = _Of[float | None]("account")
    shear = _Of[FilmShear | None]("extras")
    heat = _Of[FilmHeat | None]("extras")
    heights = _Of[SurfaceHeights | None]("extras")
    asperities = _Of[FilmAsperities | None]("extras")
    contact = _Of[FilmContact | None]("extras")
    oil = _Of[FilmOil | None]("extras")
    supplied = _Of[Supplied | None]("extras")
    bodies = _Of[tuple[float, float] | None]("extras")
    tilt = _Of[float | None]("extras")
    passes = _Of[PassHistory | None]("extras")
    stress = _Of[BodyStress | None]("extras")
    dynamics = _Of[FilmDynamics | None]("extras")

    @property
    def certified(self) -> dict[str, Estimate]:
        """Values of a certified result with their error bars: films [m], pressure [Pa], rises [K].

        ``film_central``, ``film_minimum``, ``pressure_max``, and what the table of
        `tehl.result.quantities` marks as certified, where the contact has it.
        """
        film, pressure = self.scales.film_thickness, self.scales.hertz_pressure
        units = {"film_central": film, "film_minimum": film, "pressure_max": pressure}
        return {name: one.scaled(units.get(name, 1.0)) for name, one in self.uncertainty.items()}

    @property
    def load(self) -> float:
        """Return the load of the film [N]; of a transient run that of its time."""
        return self.scales.load * moment_at(self.problem, self.time or 0.0).load

    @property
    def solved_problem(self) -> ContactProblem:
        """The problem between bodies of the temperatures that were computed, if any were."""
        return self.problem if self.bodies is None else self.problem.with_bodies(*self.bodies)

    @property
    def scaled_problem(self) -> ScaledProblem:
        """The problem with its scales and dimensionless groups."""
        problem = self.solved_problem
        scaled = ScaledProblem(
            problem=problem,
            scales=self.scales,
            groups=self.groups,
            moment=moment_at(problem, self.time or 0.0),
        )
        known = self.supplied
        if known is None:
            return scaled
        return replace(scaled, flooded_oil=known.flooded_oil, flooded_error=known.flooded_error)

    @property
    def x(self) -> Array:
        """Coordinates along entrainment [m], shape (nx,)."""
        return self.scaled.x * self.scales.half_width_x

    @property
    def y(self) -> Array:
        """Coordinates across entrainment [m], shape (ny,)."""
        return self.scaled.y * self.scales.half_width_y

    @property
    def pressure(self) -> Array:
        """Film pressure, without that of asperities [Pa], shape (ny, nx)."""
        return self.scaled.pressure * self.scales.hertz_pressure

    @property
    def film_thickness(self) -> Array:
        """Film thickness [m], shape (ny, nx)."""
        return self.scaled.film * self.scales.film_thickness

    @property
    def grid_options(self) -> Options:
        """The options of the solve, with the nodes of this result stated."""
        return self.options.on_points(self.scaled.x.size, self.scaled.y.size)

    @property
    def film(self) -> FilmSummary:
        """Central and minimum film thickness, and place of the minimum [m].

        Those of a certified result are its extrapolated values, ``film_scaled`` those of its grid.
        """
        scales, film, known = self.scales, self.film_scaled, self.certified
        certain = {name.removeprefix("film_"): one.value for name, one in known.items()}
        return FilmSummary(
            central=certain.get("central", film.central * scales.film_thickness),
            minimum=certain.get("minimum", film.minimum * scales.film_thickness),
            minimum_node=film.minimum_node * scales.film_thickness,
            minimum_at=(
                film.minimum_at[0] * scales.half_width_x,
                film.minimum_at[1] * scales.half_width_y,
            ),
        )

    @property
    def central_film_thickness(self) -> float:
        """Film thickness at the centre of the contact [m]."""
        return self.film.central

    @property
    def minimum_film_thickness(self) -> float:
        """Smallest film thickness, between the nodes too [m]."""
        return self.film.minimum


class ConvergenceError(TehlError):
    """The solver did not converge; ``result`` is the last finite state, with its history."""

    def __init__(self, message: str, result: Solution) -> None:
        super().__init__(message)
        self.result = result

    def __reduce__(self) -> tuple[type["ConvergenceError"], tuple[str, Solution]]:
        """Pickle with the result, so that worker processes can raise it."""
        return type(self), (str(self), self.result)
