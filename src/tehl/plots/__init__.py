"""Pictures of a result; each function returns a matplotlib figure and touches no global state."""

from tehl.plots.convergence import residual_history
from tehl.plots.interferogram import Optics, interferogram
from tehl.plots.lines import centre_lines, film_distribution, pressure_surface, rough_centre_line
from tehl.plots.maps import (
    film_map,
    heights_map,
    micro_film_map,
    pressure_map,
    shear_stress_map,
)
from tehl.plots.save import save_all
from tehl.plots.table_curves import curves
from tehl.plots.table_maps import contour_map, film_deviations, moes_map
from tehl.plots.temperature import (
    mid_film_temperature,
    surface_heat,
    temperature_layers,
    temperature_section,
)
from tehl.plots.traction import traction_curve

__all__ = [
    "Optics",
    "centre_lines",
    "contour_map",
    "curves",
    "film_deviations",
    "film_distribution",
    "film_map",
    "heights_map",
    "interferogram",
    "micro_film_map",
    "mid_film_temperature",
    "moes_map",
    "pressure_map",
    "pressure_surface",
    "residual_history",
    "rough_centre_line",
    "save_all",
    "shear_stress_map",
    "surface_heat",
    "temperature_layers",
    "temperature_section",
    "traction_curve",
]
