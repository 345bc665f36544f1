"""The energy equation of a contact on any grid: dimensionless numbers, laws, surfaces, units."""

import math

import numpy as np

from tehl.base.typing import Array
from tehl.contact.heat import FilmEnergy
from tehl.contact.problem import ContactProblem
from tehl.estimate.entering import film_peclet
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import Groups, ScaledProblem, Scales
from tehl.kernels.energy.records import BLOCK, GHOSTS, Model, Surface, Terms
from tehl.operators.across import SCHEMES
from tehl.operators.law_table import law_table
from tehl.operators.line_source import history
from tehl.operators.reynolds import UPSTREAM
from tehl.operators.surfaces import Side, sides

MEANS = {"generalised": 0, "mean": 1, "mean-all": 2}


class HeatedFilm:
    """The energy equation of a contact, on any grid.

    Parameters
    ----------
    scaled : ScaledProblem
        Laws, motion and heat.
    """

    def __init__(self, scaled: ScaledProblem) -> None:
        self.scaled, self.heat = scaled, film_energy(scaled.problem)
        self.sides = sides(scaled, self.heat)
        self.across = SCHEMES[self.heat.scheme](self.heat.layers)
        self.laws = law_table(scaled.problem.lubricant, scaled.scales)

    @property
    def ambient_conductivity(self) -> float:
        """Return the conductivity of the oil at ambient pressure [W/m/K]."""
        return self.scaled.problem.lubricant.ambient_conductivity or 1.0

    @property
    def flux_unit(self) -> float:
        """Return one unit of the dimensionless heat flux, k R_x / a_x^2 per kelvin [W/m^2]."""
        return self.ambient_conductivity / self.scaled.scales.film_thickness

    @property
    def solid_peclet(self) -> tuple[float, float]:
        """Return ``|u_s| a_x / (2 diffusivity)`` of both solids [-]."""
        first, second = (math.hypot(side.peclet, side.peclet_y) for side in self.sides)
        return first, second

    def model(self, grid: Grid, wedge_order: int) -> Model:
        """Return the constants of the kernels on a grid.

        Parameters
        ----------
        grid : Grid
            For its mesh widths and symmetry.
        wedge_order : int
            Order of the upstream differences.
        """
        return Model(self.across, self.laws, _film_terms(grid, self.scaled, wedge_order))

    def surface(self, grid: Grid, side: Side) -> Surface:
        """Return one surface on a grid with its line source, if any.

        Parameters
        ----------
        grid : Grid
            Decides the number of nodes and the mesh width of the marching weights.
        side : Side
            Its bulk temperature [K] holds at first; without a line source the factor is zero.
        """
        nx, ny = grid.nx, padded_rows(grid)
        factor = side.line_factor(self.scaled.scales, self.flux_unit) if side.marches else 0.0
        return Surface(
            bulk=np.full((nx, ny), side.bulk),
            factor=factor,
            slowness=side.slowness(places_across(grid, self.scaled.groups)),
            flux=np.zeros((nx + 2 * GHOSTS, ny)),
            **history(nx, grid.dx)._asdict(),
        )


def padded_rows(grid: Grid) -> int:
    """Return the rows of ``grid``, rounded up to whole blocks."""
    return -(-grid.shape[0] // BLOCK) * BLOCK


def places_across(grid: Grid, groups: Groups) -> Array:
    """Return y of the padded rows in a_x; zero for a line contact.

    Parameters
    ----------
    grid, groups : Grid, Groups
        Rows, and the ellipticity.
    """
    if grid.ny == 1:
        return np.zeros(padded_rows(grid))
    y = groups.ellipticity * grid.y
    beyond = np.arange(1.0, padded_rows(grid) - y.size + 1.0)
    return np.concatenate([y, y[-1] + (y[-1] - y[-2]) * beyond])


def closeness(grid: Grid) -> Array:
    """Return the mean distance of rows over that at each of the padded rows [-].

    Differences along y are those of uniform rows times it.

    Parameters
    ----------
    grid : Grid
        Whose lines may crowd.
    """
    found = np.ones(padded_rows(grid))
    if grid.crowding:
        found[: grid.shape[0]] = grid.dy / np.gradient(grid.y, edge_order=2)
    return found


def stress_unit(scales: Scales) -> float:
    """Return one unit of the dimensionless shear stress, eta_0 u_m R_x / a_x^2 [Pa]."""
    return scales.viscosity * scales.speed / scales.film_thickness


def film_energy(problem: ContactProblem) -> FilmEnergy:
    """Return the heat problem, for an isothermal film a placeholder that is never solved."""
    inlet = problem.inlet_temperature
    return problem.heat or FilmEnergy(temperature=inlet, bulk_1=inlet, bulk_2=inlet)


def _film_terms(grid: Grid, scaled: ScaledProblem, wedge_order: int) -> Terms:
    """Return the dimensionless numbers of the energy equation (docs/theory/thermal.md, scaled)."""
    problem, scales, groups = scaled.problem, scaled.scales, scaled.groups
    conductivity = problem.lubricant.ambient_conductivity or 1.0
    across = scales.film_thickness**2 / conductivity
    along = scales.speed / scales.half_width_x
    w0, w1, w2 = UPSTREAM[min(wedge_order, 2)]
    motion, slide, slide_y = problem.motion, -scaled.moment.sliding, -scaled.moment.across
    per_spin = scales.half_width_x / scales.speed
    return Terms(
        peclet=film_peclet(scaled),
        compression=scales.hertz_pressure * along * across,
        brinkman=scales.viscosity * scales.speed**2 / conductivity,
        poiseuille=12.0 / groups.lambda_bar,
        slide=slide,
        slide_y=slide_y,
        speed=scaled.moment.speed - 0.5 * slide,
        speed_y=-0.5 * slide_y,
        spin=(motion.spin_2 - motion.spin_1) * per_spin,
        spin_1=motion.spin_1 * per_spin,
        plain=int(motion.is_plain),
        over_x=1.0 / grid.dx,
        over_y=1.0 / (groups.ellipticity * grid.dy),
        over_t=0.0,
        w0=w0,
        w1=w1,
        w2=w2,
        mirror=int(grid.mirror),
        period=grid.shape[0] - 1 if grid.wraps else 0,
        mean=MEANS[film_energy(problem).reynolds],
        inlet=scales.temperature,
        heat=int(isinstance(problem.heat, FilmEnergy)),
    )
