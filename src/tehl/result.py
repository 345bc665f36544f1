"""The answer: fields, film numbers, status and history of a solve. Frozen; needs no solver."""

from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from tehl.options import Options
from tehl.problem import ContactProblem
from tehl.scaling import Groups, ScaledProblem, Scales
from tehl.typing import Array

if TYPE_CHECKING:
    import xarray as xr

    from tehl.post.heat import Temperature
    from tehl.post.roughness import RoughFilm
    from tehl.post.traction import Traction

StatusKind = Literal["converged", "not_converged", "diverged", "stalled"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Status:
    """How the solve ended, as a word and as sentences.

    Attributes
    ----------
    kind : {"converged", "not_converged", "diverged", "stalled"}
        The outcome.
    cause : str or None
        Name of the cause when not converged, for programs: ``"grid_too_coarse"``.
    message, hint : str or None
        The cause and what to try, for people. A certified result that converged tells in
        ``message`` how its grids ended; one between rough surfaces whose minimum is open says so,
        and in ``hint`` which grid to try.
    """

    kind: StatusKind
    cause: str | None = None
    message: str | None = None
    hint: str | None = None

    @property
    def converged(self) -> bool:
        """Whether the result may be believed."""
        return self.kind == "converged"

    @property
    def is_vague(self) -> bool:
        """Whether the film converged but its minimum, one spot between asperities, is not known."""
        return self.converged and self.hint is not None

    @property
    def outcome(self) -> str:
        """The outcome in words, with the cause where it says more: "stalled"."""
        if self.is_vague:
            return "converged, minimum film open"
        kind = self.kind.replace("_", " ")
        if self.cause in (None, self.kind):
            return kind
        return f"{kind}: {self.cause.replace('_', ' ')}"


@dataclass(frozen=True, kw_only=True, slots=True)
class CycleReport:
    """One multigrid cycle, as shown in the live table and stored in the history.

    Attributes
    ----------
    points : (int, int)
        Nodes (nx, ny) of the grid, of the full domain.
    cycle : int
        Number of the cycle on this grid, from 1.
    residual : float
        Mean of ``|r|`` scaled by the local diagonal, over wet nodes [-].
    change : float
        Largest change of pressure in this cycle, in Hertz pressures [-].
    load_error : float
        Relative error of the load balance [-].
    film_central, film_minimum : float
        H at X = Y = 0 and smallest nodal H after this cycle [-].
    smoother : str
        Setting of the relaxation that was used.
    temperature_change : float
        Largest change of the film temperature in this cycle, where the pressure exceeds a fiftieth
        of the Hertz pressure [K]; zero in an isothermal run.
    temperature_rise : float
        Largest rise of the film temperature over the inlet [K]; zero in an isothermal run.
    mean_change : float
        Sum of the changes of pressure in this cycle over the sum of pressures [-]; not stored.
    """

    points: tuple[int, int]
    cycle: int
    residual: float
    change: float
    load_error: float
    film_central: float
    film_minimum: float
    smoother: str
    temperature_change: float = 0.0
    temperature_rise: float = 0.0
    mean_change: float = 0.0


@dataclass(frozen=True, kw_only=True, slots=True)
class Fields:
    """Dimensionless fields on the full domain, arrays of shape (ny, nx) that cannot be written.

    Attributes
    ----------
    x, y : (nx,) and (ny,) array
        Coordinates in Hertz half-widths [-].
    pressure : (ny, nx) array
        P = p / p_h [-].
    film : (ny, nx) array
        H = h R_x / a_x^2 [-].
    """

    x: Array
    y: Array
    pressure: Array
    film: Array

    def __post_init__(self) -> None:
        for array in (self.x, self.y, self.pressure, self.film):
            array.flags.writeable = False

    def at_origin(self, values: Array) -> float:
        """Return ``values`` at X = Y = 0, by the parabolas through the nearest three nodes."""
        rows, row_weights = _parabola(self.y)
        columns, column_weights = _parabola(self.x)
        return float(row_weights @ values[rows, columns] @ column_weights)


def _parabola(axis: Array) -> tuple[slice, Array]:
    """Return three nodes near 0 and the weights of their values at 0."""
    middle = int(np.clip(np.argmin(np.abs(axis)), 1, axis.size - 2))
    t = -axis[middle] / (axis[middle + 1] - axis[middle])
    weights = np.array([t * (t - 1) / 2, 1 - t**2, t * (t + 1) / 2])
    return slice(middle - 1, middle + 2), weights


@dataclass(frozen=True, kw_only=True, slots=True)
class FilmShear:
    """Shear stress of the film in SI, arrays of shape (ny, nx) that cannot be written.

    The stress is ``eta du/dz`` of the effective viscosity: negative for SRR > 0.

    Attributes
    ----------
    surface_1, mid_film, surface_2 : (ny, nx) array
        tau_zx at z = 0, h/2 and h [Pa].
    across : (ny, nx) array
        tau_zy at mid-film [Pa].
    thinning : (ny, nx) array
        Effective over Newtonian viscosity at mid-film, 1 where the film is Newtonian [-].
    """

    surface_1: Array
    mid_film: Array
    surface_2: Array
    across: Array
    thinning: Array

    def __post_init__(self) -> None:
        for array in (self.surface_1, self.mid_film, self.surface_2, self.across, self.thinning):
            array.flags.writeable = False


@dataclass(frozen=True, kw_only=True, slots=True)
class HeatBalance:
    """Powers of the pressurised film in W; they sum up to nothing but the discretisation error.

    Attributes
    ----------
    shear, compression : float
        Heat generated by shear, and by compression less expansion [W].
    surface_1, surface_2 : float
        Heat conducted into the solids [W].
    carried_out : float
        Enthalpy that the oil carries out of the pressurised film less what it brings in [W].
    """

    shear: float
    compression: float
    surface_1: float
    surface_2: float
    carried_out: float

    @property
    def error(self) -> float:
        """What is missing, over the heat that is turned over [-].

        That is what shear and compression make, or what goes through surfaces and oil if that is
        more, as between bodies that are not as warm as the oil.
        """
        made = self.shear + self.compression
        parts = (self.surface_1, self.surface_2, self.carried_out)
        turned_over = max(abs(self.shear) + abs(self.compression), sum(map(abs, parts)))
        return (made - sum(parts)) / (turned_over or 1.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class FilmHeat:
    """Temperature of the film in SI, arrays that cannot be written.

    Attributes
    ----------
    zeta : (n,) array
        Nodes across the film, z/h from 0 (surface 1) to 1 (surface 2) [-].
    weights : (n,) array
        Of the mean across the film, sum one [-].
    temperature : (n, ny, nx) array
        T; the first and last layer are the surfaces [K].
    flux_1, flux_2 : (ny, nx) array
        Heat conducted into the solids [W/m^2].
    balance : HeatBalance
        Where the heat comes from and goes to.
    solid_peclet : (float, float)
        |u_s| a_x / (2 kappa_s) of both surfaces [-].
    sources : (str, str)
        How the surface temperatures were found: "line" or "full" moving source.
    """

    zeta: Array
    weights: Array
    temperature: Array
    flux_1: Array
    flux_2: Array
    balance: HeatBalance
    solid_peclet: tuple[float, float]
    sources: tuple[str, str]

    def __post_init__(self) -> None:
        for array in (self.zeta, self.weights, self.temperature, self.flux_1, self.flux_2):
            array.flags.writeable = False


@dataclass(frozen=True, kw_only=True, slots=True)
class FilmSummary:
    """Film thickness numbers, all dimensionless H unless said.

    Attributes
    ----------
    central : float
        At X = Y = 0.
    minimum : float
        Sub-grid minimum (local quadratic fit).
    minimum_node : float
        Smallest nodal value.
    minimum_at : (float, float)
        Where the minimum is, in Hertz half-widths (Y >= 0 for a symmetric contact).
    """

    central: float
    minimum: float
    minimum_node: float
    minimum_at: tuple[float, float]


@dataclass(frozen=True, kw_only=True, slots=True)
class Estimate:
    """A value with its error bar.

    Attributes
    ----------
    value : float
        Richardson value.
    uncertainty : float
        Half width of the bar: discretisation and domain parts added in quadrature.
    discretisation, domain : float
        The two parts.
    observed_order : float or None
        Order seen on three grids; None where the grids do not show one.
    values : tuple of float
        What the grids gave, coarse to fine.
    """

    value: float
    uncertainty: float
    discretisation: float
    domain: float
    observed_order: float | None
    values: tuple[float, ...]


@dataclass(frozen=True, kw_only=True, slots=True)
class ErrorEstimate:
    """Estimated errors of the film on the finest grid, without extra runs.

    Attributes
    ----------
    discretisation_central, discretisation_minimum : float
        From the difference to the next coarser grid of the full multigrid, relative [-].
    iteration_central, iteration_minimum : float
        What further cycles would still change, relative [-].
    """

    discretisation_central: float
    discretisation_minimum: float
    iteration_central: float
    iteration_minimum: float


@dataclass(frozen=True, kw_only=True, slots=True)
class Cost:
    """What the solve cost.

    Attributes
    ----------
    cpu_seconds, wall_seconds : float
        Of the solve, without compiling and without files.
    work : float or None
        ``cpu_seconds`` in units of one FFT deformation on the same full grid, if it was measured.
    """

    cpu_seconds: float
    wall_seconds: float
    work: float | None = None


@dataclass(frozen=True, kw_only=True, slots=True)
class Provenance:
    """Where a result comes from: versions by package name, and when it was made (ISO 8601)."""

    versions: dict[str, str]
    created: str


@dataclass(frozen=True, kw_only=True, slots=True)
class SiFilm:
    """Film thickness in metres."""

    central: float
    minimum: float
    minimum_node: float


@dataclass(frozen=True, kw_only=True, slots=True)
class SurfaceHeights:
    """Heights of rough surfaces, positive outwards, as the grid of the result carries them.

    Attributes
    ----------
    surface_1, surface_2 : (ny, nx) array
        Heights [m]: the film is the smooth one less both.
    """

    surface_1: Array
    surface_2: Array

    @property
    def together(self) -> Array:
        """Return the sum of both, (ny, nx) [m]."""
        return self.surface_1 + self.surface_2


@dataclass(frozen=True, kw_only=True, slots=True)
class Result:
    """Answer of one solve.

    Attributes
    ----------
    problem : ContactProblem
        What was asked, in SI.
    options : Options
        How hard to try; ``options.domain`` as stated, the domain used is that of ``scaled``.
    scales, groups : Scales, Groups
        Units removed by the solver, and the dimensionless groups.
    scaled : Fields
        Dimensionless fields.
    rigid_approach : float
        H00 [-].
    film_scaled : FilmSummary
        Film numbers [-].
    status : Status
        How it ended.
    history : tuple of CycleReport
        Each cycle on each grid.
    errors : ErrorEstimate or None
        Estimated errors; None when the solve did not get far enough to tell.
    uncertainty : dict of str to Estimate
        Filled by a certified run: ``film_central``, ``film_minimum``, ``pressure_max`` [-].
    shear : FilmShear or None
        Shear stresses; None when there is no credible film.
    heat : FilmHeat or None
        Temperatures; None in an isothermal run.
    heights : SurfaceHeights or None
        Heights of rough surfaces; None when both are smooth.
    cost, provenance : Cost, Provenance
        Expense and origin.
    """

    problem: ContactProblem
    options: Options
    scales: Scales
    groups: Groups
    scaled: Fields
    rigid_approach: float
    film_scaled: FilmSummary
    status: Status
    history: tuple[CycleReport, ...]
    errors: ErrorEstimate | None
    cost: Cost
    provenance: Provenance
    uncertainty: dict[str, Estimate] = field(default_factory=dict)
    shear: FilmShear | None = None
    heat: FilmHeat | None = None
    heights: SurfaceHeights | None = None

    @property
    def scaled_problem(self) -> ScaledProblem:
        """The problem with its scales and dimensionless groups."""
        return ScaledProblem(problem=self.problem, scales=self.scales, groups=self.groups)

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
        """Film pressure [Pa], shape (ny, nx)."""
        return self.scaled.pressure * self.scales.hertz_pressure

    @property
    def film_thickness(self) -> Array:
        """Film thickness [m], shape (ny, nx)."""
        return self.scaled.film * self.scales.film_thickness

    @property
    def film(self) -> SiFilm:
        """Central and minimum film thickness [m]."""
        scale, film = self.scales.film_thickness, self.film_scaled
        return SiFilm(
            central=film.central * scale,
            minimum=film.minimum * scale,
            minimum_node=film.minimum_node * scale,
        )

    @property
    def central_film_thickness(self) -> float:
        """Film thickness at the centre of the contact [m]."""
        return self.film.central

    @property
    def minimum_film_thickness(self) -> float:
        """Smallest film thickness [m], sub-grid."""
        return self.film.minimum

    @property
    def traction(self) -> "Traction | None":
        """Traction coefficients, None where there are no shear stresses."""
        found: Traction | None = _post("traction").traction(self)
        return found

    @property
    def temperature(self) -> "Temperature | None":
        """Temperatures of the film, None for an isothermal run."""
        found: Temperature | None = _post("heat").temperature(self)
        return found

    @property
    def roughness(self) -> "RoughFilm | None":
        """Film numbers of rough surfaces, None where neither heights nor their Sq are stated."""
        found: RoughFilm | None = _post("roughness").rough_film(self)
        return found

    def save(self, path: str | Path) -> None:
        """Write the result to a NetCDF-4 file; nothing is left behind when writing fails."""
        from tehl.io.store import save  # noqa: PLC0415 (a method users expect here)

        save(self, path)

    def to_xarray(self) -> "xr.Dataset":
        """Return the result as a dataset with dimensions (y, x), units and names."""
        from tehl.io.store import to_dataset  # noqa: PLC0415

        return to_dataset(self)

    def summary(self) -> dict[str, Any]:
        """Return the JSON summary of the run, as ``tehl solve --json`` prints it."""
        from tehl.io.summary import summary  # noqa: PLC0415

        return summary(self)


def _post(name: str) -> Any:
    """Return a module of ``tehl.post``, for the properties that users expect on a result."""
    return import_module(f"tehl.post.{name}")
