"""Energy equation of the film on one grid: the temperature, and what it makes of the flow."""

import numpy as np

from tehl.grid import Grid
from tehl.heat import FilmEnergy
from tehl.kernels import energy
from tehl.operators.across import SCHEMES
from tehl.operators.film_in_time import FilmInTime
from tehl.operators.law_table import law_table
from tehl.operators.line_source import history
from tehl.operators.surfaces import Side, Solids, sides
from tehl.operators.transfer import midpoints
from tehl.problem import ContactProblem
from tehl.scaling import Groups, ScaledProblem, Scales
from tehl.typing import Array

GHOSTS = energy.GHOSTS
FAR_FILM = 1e3
"""Film of the rows that only fill the last block of columns: it hardly warms."""
MIXED = 20.0
"""Peclet number of the film times H^2 beyond which a thick film conducts as if it were mixed: far
out in the inlet, where the nodes across it could not show the layers at the walls. From 5 to never,
it moves the film by 2e-5 and the mid-film rise by 0.0015 K (0.5 and 0.8 GPa, SRR 0 and 0.5)."""
STIFFER, FLOWING = 2.0, 10.0
"""Conductance of the film: over that of its oil at rest, for a warmer film makes less heat as well;
and what the flow of a thick film adds to its square, over the Peclet number."""
MEANS = {"generalised": 0, "mean": 1, "mean-all": 2}


class HeatedFilm:
    """What the energy equation knows of a contact, whatever the grid.

    Parameters
    ----------
    scaled : ScaledProblem
        Laws, motion and heat.
    """

    def __init__(self, scaled: ScaledProblem) -> None:
        problem, scales = scaled.problem, scaled.scales
        self.scaled, self.heat = scaled, film_energy(problem)
        self.sides = sides(scaled, self.heat)
        self.across = SCHEMES[self.heat.scheme](self.heat.layers)
        self.laws = law_table(problem.lubricant, scales)


class FilmState:
    """Temperature and shear stress of the film on one grid.

    Arrays have y last, as the march goes along x; see `tehl.kernels.energy`.

    Parameters
    ----------
    grid : Grid
        The nodes.
    film : HeatedFilm
        The contact.
    wedge_order : int
        Order of the upstream differences.
    finest : bool
        Sum the full source also of surfaces that a line source heats nearly as well.
    thorough : bool
        March against x as well where oil flows back, in each sweep.
    """

    def __init__(
        self,
        grid: Grid,
        film: HeatedFilm,
        wedge_order: int,
        *,
        finest: bool = True,
        thorough: bool = False,
    ) -> None:
        scaled, heat = film.scaled, film.heat
        problem, scales, groups = scaled.problem, scaled.scales, scaled.groups
        self.grid, self.problem, self.scales, self.groups = grid, problem, scales, groups
        self.across, self.sides = film.across, film.sides
        side_1, side_2 = film.sides
        nodes = heat.layers
        nx, ny = grid.nx, padded_rows(grid)
        shape = (nx, ny)
        temperature = np.full((nx + 2 * GHOSTS, nodes, ny + 2 * GHOSTS), scales.temperature)
        # a thin film at rest: steps at the walls would give fluxes that no later sweep takes back
        across = heat.bulk_1 + (heat.bulk_2 - heat.bulk_1) * film.across.zeta
        temperature[GHOSTS:-GHOSTS, :, GHOSTS:-GHOSTS] = across[None, :, None]
        others = {
            name: np.zeros(shape)
            for name in energy.Fields._fields
            if name not in ("temperature", "capacity", "conductivity", "past", "pressing")
        }
        self.fields = energy.Fields(
            temperature=temperature,
            capacity=np.ones(shape),
            conductivity=np.ones(shape),
            past=np.zeros(1),
            pressing=np.zeros(1),
            **others,
        )
        self.fields.h[:] = FAR_FILM
        self.surfaces = (
            line_surface(grid, scales, side_1, self.flux_unit),
            line_surface(grid, scales, side_2, self.flux_unit),
        )
        self.model = energy.Model(
            across=self.across,
            laws=film.laws,
            terms=film_terms(grid, scaled, wedge_order),
        )
        self.solids = Solids(
            grid,
            groups,
            scales,
            film.sides,
            self.flux_unit,
            finest=finest,
        )
        self.thorough, self.finest, self.sweeps = thorough, finest, 0
        self.refined = False
        self.time: FilmInTime | None = None
        modes = len(self.surfaces[0].decay)
        self.work = energy.scratch(nodes, ny, modes)
        self.known = energy.known(self.model, self.fields, self.surfaces, self.work)

    def view(self, name: str) -> Array:
        """Return a field of the film without the rows that only fill the last block, (nx, ny)."""
        field: Array = getattr(self.fields, name)
        return field[:, : self.grid.shape[0]]

    @property
    def temperature(self) -> Array:
        """The temperature without ghosts and filling rows, (nx, n, ny) [K]."""
        rows = slice(GHOSTS, GHOSTS + self.grid.shape[0])
        return self.fields.temperature[GHOSTS:-GHOSTS, :, rows]

    @property
    def fluxes(self) -> tuple[Array, Array]:
        """Heat flux into both surfaces, (nx, ny), dimensionless."""
        rows = slice(0, self.grid.shape[0])
        first, second = (surface.flux[GHOSTS:-GHOSTS, rows] for surface in self.surfaces)
        return first, second

    @property
    def walls(self) -> tuple[Array, Array]:
        """Temperature of both surfaces less what a line source does, (nx, ny) [K]."""
        rows = slice(0, self.grid.shape[0])
        first, second = (surface.bulk[:, rows] for surface in self.surfaces)
        return first, second

    @property
    def ambient_conductivity(self) -> float:
        """Return the conductivity of the oil at ambient pressure [W/m/K]."""
        return self.problem.lubricant.ambient_conductivity or 1.0

    @property
    def flux_unit(self) -> float:
        """Return one unit of the dimensionless heat flux, k R_x / a_x^2 per kelvin [W/m^2]."""
        return self.ambient_conductivity / self.scales.film_thickness

    @property
    def solid_peclet(self) -> tuple[float, float]:
        """Return ``|u_s| a_x / (2 diffusivity)`` of both solids [-]."""
        first, second = (abs(side.peclet) for side in self.sides)
        return first, second

    def set_film(self, pressure: Array, film: Array, floor: float = 0.0) -> None:
        """Take pressure and film of shape ``grid.shape``, no film thinner than ``floor``."""
        grid, fields, scales = self.grid, self.fields, self.scales
        held = slice(0, pressure.shape[0])
        fields.p[:, held], fields.h[:, held] = pressure.T, np.maximum(film.T, floor)
        slope_x, slope_y = pressure_slopes(grid, self.groups, pressure)
        fields.px[:, held], fields.py[:, held] = slope_x.T, slope_y.T
        lubricant = self.problem.lubricant
        si = scales.hertz_pressure * fields.p
        fields.stress[:] = stress_unit(scales) / lubricant.shear.stress_scale(si)
        if self.model.terms.heat:
            fields.conductivity[:] = lubricant.conductivity_at(si) / self.ambient_conductivity
            mixed = self.model.terms.peclet / MIXED * fields.h**2
            fields.conductivity[:] *= np.maximum(mixed, 1.0)
            ambient = lubricant.ambient_heat_capacity or 1.0
            fields.capacity[:] = lubricant.heat_capacity_at(si) / ambient
        if self.time is not None:
            self.time.set_pressure(fields)

    def refine_from(self, coarse: "FilmState") -> None:
        """Take temperature and stress of a coarser grid by linear interpolation."""
        self.refined = True
        self.temperature[:] = midpoints(coarse.temperature)
        for name in ("tau_x", "tau_y"):
            self.view(name)[:] = midpoints(coarse.view(name))
        for mine, theirs in zip(self.fluxes, coarse.fluxes, strict=True):
            mine[:] = midpoints(theirs)
        for wall, coarser in zip(self.walls, coarse.walls, strict=True):
            wall[:] = midpoints(coarser)

    def slide(self, part: float) -> None:
        """Let the surfaces slide at a part of their speed, at the same mean."""
        full = -part * self.problem.slide_roll_ratio
        terms = self.model.terms._replace(slide=full, speed=1.0 - 0.5 * full)
        if terms != self.model.terms:
            self.model = self.model._replace(terms=terms)
            self.prepare()

    def prepare(self) -> None:
        """Tell the sweep of other arrays or numbers."""
        self.known = energy.known(self.model, self.fields, self.surfaces, self.work)

    def sweep(self, steps: int) -> float:
        """March once; return the largest change of temperature [K].

        Oil flows back in the inlet and along a counter-moving surface: the march would carry it on
        by one station per sweep.

        Parameters
        ----------
        steps : int
            Newton steps for the shear stress of a thinning film.
        """
        if self.model.terms.heat and (self.thorough or self._is_second_of_many()):
            energy.sweep_back(self.known)
        if self.time is not None:
            self.time.heat_surfaces(self.surfaces)
        change = energy.sweep(self.known, self.work, steps)
        self.sweeps += 1
        self.update_surfaces()
        return change

    def _is_second_of_many(self) -> bool:
        """Whether to march back once: the finer grids take it from the first one."""
        return self.sweeps == 1 and not (self.finest or self.refined)

    def begin_time(self, time_step: float) -> None:
        """Let time pass from here: the present film has been the same for ever.

        Parameters
        ----------
        time_step : float
            In units of a_x / u_m [-].
        """
        nx, ny = self.fields.p.shape
        shape = (nx, self.model.across.zeta.size, ny)
        self.fields = self.fields._replace(past=np.zeros(shape), pressing=np.zeros((nx, ny)))
        speed = self.scales.speed
        paths = [
            (side.bulk, surface.factor, self.grid.dx * speed / (side.speed * time_step))
            for side, surface in zip(self.sides, self.surfaces, strict=True)
        ]
        self.time = FilmInTime(self.fields, self.surfaces, self.grid.dx, time_step, paths)
        self.surfaces = (alone(self.surfaces[0]), alone(self.surfaces[1]))
        terms = self.model.terms._replace(over_t=1.5 / time_step)
        self.model = self.model._replace(terms=terms)
        self.prepare()

    def update_surfaces(self) -> None:
        """Let the surfaces follow the heat that flows into them, as far as no line source does."""
        if self.model.terms.heat:
            still = self.view("conductivity") / self.view("h")
            moving = FLOWING * self.model.terms.peclet
            conductance = STIFFER * np.sqrt(still**2 + moving)
            self.solids.update(conductance, self.walls, self.fluxes)


def padded_rows(grid: Grid) -> int:
    """Return the rows of ``grid``, filled up to whole blocks of columns."""
    return -(-grid.shape[0] // energy.BLOCK) * energy.BLOCK


def pressure_slopes(grid: Grid, groups: Groups, pressure: Array) -> tuple[Array, Array]:
    """Return dP/dX and dP/(kappa dY) by central differences, one-sided ones on the edges."""
    slope_x = slope_along(pressure.T, grid.dx).T
    slope_y = slope_along(pressure, groups.ellipticity * grid.dy)
    if grid.mirror:
        slope_y[0] = 0.0
    return slope_x, slope_y


def slope_along(field: Array, spacing: float) -> Array:
    """Return the derivative along the first axis, of second order; `numpy.gradient` is slower."""
    slope = np.empty_like(field)
    np.subtract(field[2:], field[:-2], out=slope[1:-1])
    slope[0] = 4.0 * field[1] - 3.0 * field[0] - field[2]
    slope[-1] = 3.0 * field[-1] - 4.0 * field[-2] + field[-3]
    slope *= 0.5 / spacing
    return slope


def stress_unit(scales: Scales) -> float:
    """Return one unit of the dimensionless shear stress, eta_0 u_m R_x / a_x^2 [Pa]."""
    return scales.viscosity * scales.speed / scales.film_thickness


def film_terms(grid: Grid, scaled: ScaledProblem, wedge_order: int) -> energy.Terms:
    """Return the dimensionless numbers of the energy equation."""
    problem, scales, groups = scaled.problem, scaled.scales, scaled.groups
    lubricant = problem.lubricant
    conductivity = lubricant.ambient_conductivity or 1.0
    capacity = lubricant.ambient_heat_capacity or 0.0
    across = scales.film_thickness**2 / conductivity
    along = scales.speed / scales.half_width_x
    w0, w1, w2 = (1.5, -2.0, 0.5) if wedge_order == 2 else (1.0, -1.0, 0.0)
    slide = -problem.slide_roll_ratio
    return energy.Terms(
        peclet=scales.density * capacity * along * across,
        compression=scales.hertz_pressure * along * across,
        brinkman=scales.viscosity * scales.speed**2 / conductivity,
        poiseuille=12.0 / groups.lambda_bar,
        slide=slide,
        speed=1.0 - 0.5 * slide,
        over_x=1.0 / grid.dx,
        over_y=1.0 / (groups.ellipticity * grid.dy),
        over_t=0.0,
        w0=w0,
        w1=w1,
        w2=w2,
        mirror=int(grid.mirror),
        mean=MEANS[film_energy(problem).reynolds],
        inlet=scales.temperature,
        heat=int(isinstance(problem.heat, FilmEnergy)),
    )


def film_energy(problem: ContactProblem) -> FilmEnergy:
    """Return the heat problem, for an isothermal film a placeholder that is never solved."""
    inlet = problem.inlet_temperature
    return problem.heat or FilmEnergy(temperature=inlet, bulk_1=inlet, bulk_2=inlet)


def line_surface(grid: Grid, scales: Scales, side: Side, flux_unit: float) -> energy.Surface:
    """Return one surface and its line source, if it has one."""
    nx, ny = grid.nx, padded_rows(grid)
    return energy.Surface(
        bulk=np.full((nx, ny), side.bulk),
        factor=side.line_factor(scales, flux_unit) if side.marches else 0.0,
        flux=np.zeros((nx + 2 * GHOSTS, ny)),
        **history(nx, grid.dx)._asdict(),
    )


def alone(surface: energy.Surface) -> energy.Surface:
    """Return a surface whose history the march need not carry along: ``bulk`` will have it."""
    return surface._replace(
        next_=0.0,
        decay=np.zeros_like(surface.decay),
        older=np.zeros_like(surface.older),
        newer=np.zeros_like(surface.newer),
    )
