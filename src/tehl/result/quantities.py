"""The table of all quantities of a result: a new one is a line here.

Summary, JSON, tables of studies, lists of contacts, reports, pictures and the live page read it by
`tehl.result.registry` (docs/dev/adding-a-quantity.md).
"""

import math
from collections.abc import Callable, Iterator
from operator import attrgetter, itemgetter
from typing import Any

from tehl.result.derived import (
    KAPPA,
    body_error,
    friction,
    friction_error,
    kappa,
    lambda_error,
    largest_temperature,
    largest_temperature_error,
    power_loss,
    share,
    share_error,
)
from tehl.result.quantity import Quantity, without_unit
from tehl.result.stress_quantities import stress_quantities

_EVERYWHERE = "list notebook line text report page"


def _words(name: str, places: str, **others: str) -> dict[str, str]:
    """Return the words of a quantity that has one name in several places."""
    return dict.fromkeys(places.split(), name) | others


def _plain(block: str, keys: str) -> Iterator[Quantity]:
    """Yield quantities that are attributes of the owner of a block, and shown nowhere else."""
    for key in keys.split():
        yield Quantity(f"{block}.{key}")


def _of_part(block: str, part: str, keys: str) -> Iterator[Quantity]:
    """Yield quantities that are attributes of a part of the owner of a block."""
    for key in keys.split():
        yield Quantity(f"{block}.{key}", attrgetter(f"{part}.{key}"))


def _of_body(number: int) -> Iterator[Quantity]:
    """Yield the quantities of a body that is heated by the contact."""
    name = f"temperature of body {number}"
    yield Quantity(
        f"bodies.temperature_{number}_k",
        error=body_error(number),
        symbol=f"T_{number}",
        unit="°C",
        digits="0.0",
        words=_words(name, "axis list page", key=f"t_{number}"),
    )
    yield Quantity(
        f"bodies.heat_{number}_w",
        error=lambda numbers: numbers.get(f"errors.heat_surface_{number}"),
        unit="W",
        words=_words(f"heat into body {number}", "axis list"),
    )
    yield Quantity(f"bodies.resistance_{number}")


def _lists(block: str, keys: str) -> Iterator[Quantity]:
    for key in keys.split():
        yield Quantity(f"{block}.{key}.0")


def _finite(value: float) -> float | None:
    """Return a number, None where it is infinite: that of an ellipse which is a line."""
    return value if math.isfinite(value) else None


def _positive(value: float) -> float | None:
    """Return a film, None where it is not positive."""
    return value if value > 0 else None


def moes_film_factor(solution: Any) -> float:
    """Return what turns H into the Moes film ``(h/R_x) (2U)^(-1/2)``.

    For a circle this is ``(3M/2)^(2/3)``.
    """
    scales, groups = solution.scales, solution.groups
    # h = H a_x^2/R_x with R_x = a_x^2 / (a_x^2/R_x), so h/R_x = H (film_thickness/a_x)^2.
    return float((scales.film_thickness / scales.half_width_x) ** 2 / math.sqrt(2.0 * groups.U))


def _scaled(which: str, *, moes: bool = False) -> Callable[[Any], Any]:
    """Return a film over its scale, or as Moes has it."""

    def value(found: Any) -> float | None:
        film = getattr(found.solution.film, which) / found.solution.scales.film_thickness
        return _positive(film * moes_film_factor(found.solution) if moes else film)

    return value


def _if_known(name: str) -> Callable[[Any], Any]:
    """Return what follows from the share where surfaces touch: nothing if that is not known."""
    return lambda found: getattr(found, name) if found.is_share_known else None


def _last(name: str) -> Callable[[Any], Any]:
    """Return a number of the last cycle."""
    return lambda found: getattr(found.solution.history[-1], name) if found.finest else None


DYNAMICS = (
    "frequency_hz stiffness_n_per_m damping_n_s_per_m stiffness_error_n_per_m "
    "damping_error_n_s_per_m amplitude_m load_by_speed_n_s_per_m "
    "load_by_acceleration_n_s2_per_m "
    "rolling_stiffness_n_per_m rolling_damping_n_s_per_m rolling_by_speed_n_s_per_m "
    "rolling_by_acceleration_n_s2_per_m"
)
"""Keys of a row over frequency: fields of `tehl.result.fields.FilmDynamics` with their units."""
QUANTITIES: tuple[Quantity, ...] = (
    Quantity("laws.oil", lambda problem: problem.lubricant.name),
    Quantity("laws.viscosity", lambda problem: problem.lubricant.viscosity.law),
    Quantity(
        "laws.viscosity_temperature",
        lambda problem: getattr(problem.lubricant.viscosity, "temperature_law", None),
    ),
    Quantity("laws.density", lambda problem: problem.lubricant.density.law),
    Quantity("laws.shear", lambda problem: problem.lubricant.shear.law),
    Quantity("laws.reynolds", lambda problem: getattr(problem.heat, "reynolds", "isothermal")),
    Quantity("domain.x.0", lambda scaled: scaled.x[[0, -1]].tolist()),
    Quantity("domain.y.0", lambda scaled: scaled.y[[0, -1]].tolist()),
    Quantity(
        "groups.M",
        lambda result: result.groups.M,
        digits="0.0",
        words={"axis": "M", "list": "Moes M"},
    ),
    Quantity(
        "groups.L",
        lambda result: result.groups.L,
        digits="0.00",
        words={"axis": "L", "list": "Moes L"},
    ),
    *_of_part("groups", "groups", "U W G lambda_bar alpha_bar"),
    Quantity("groups.ellipticity", lambda result: _finite(result.groups.ellipticity)),
    *_of_part("groups", "groups", "radius_ratio"),
    Quantity(
        "groups.hertz_pressure_pa",
        lambda result: result.scales.hertz_pressure,
        unit="GPa",
        words={"axis": "Hertz pressure $p_h$", "list": "Hertz pressure"},
    ),
    Quantity(
        "groups.hertz_half_width_m",
        lambda result: result.scales.half_width_x,
        unit="um",
        digits="0.0",
        words={"list": "a_x"},
    ),
    Quantity(
        "groups.hertz_half_width_y_m",
        lambda result: None if result.problem.contact.is_line else result.scales.half_width_y,
        unit="um",
        digits="0.0",
        words={"list": "a_y"},
    ),
    Quantity(
        "film.h_min_m",
        lambda found: _positive(found.solution.film.minimum),
        name="film_minimum",
        certified="film",
        symbol="h_min",
        unit="nm",
        digits="0.0",
        words=_words("minimum film", _EVERYWHERE, axis="minimum film thickness $h_{min}$"),
    ),
    Quantity(
        "film.h_central_m",
        lambda found: _positive(found.solution.film.central),
        name="film_central",
        certified="film",
        symbol="h_c",
        unit="nm",
        digits="0.0",
        words=_words("central film", _EVERYWHERE, axis="central film thickness $h_c$"),
    ),
    Quantity(
        "film.H_min",
        _scaled("minimum"),
        name="film_minimum",
        certified="film",
        words={"axis": "minimum film $H_{min}$"},
    ),
    Quantity("film.H_min_node", lambda found: _positive(found.solution.film_scaled.minimum_node)),
    Quantity(
        "film.H_central",
        _scaled("central"),
        name="film_central",
        certified="film",
        words={"axis": "central film $H_c$"},
    ),
    Quantity(
        "film.H_min_moes",
        _scaled("minimum", moes=True),
        name="film_minimum",
        words={"axis": "minimum film $H_{min}$ (Moes)"},
    ),
    Quantity(
        "film.H_central_moes",
        _scaled("central", moes=True),
        name="film_central",
        words={"axis": "central film $H_c$ (Moes)"},
    ),
    Quantity(
        "film.h_mean_m",
        lambda found: found.mean_film,
        name="film_mean",
        symbol="h_m",
        unit="nm",
        digits="0.0",
        words=_words("mean film in the Hertz contact", "axis report page", list="mean film"),
    ),
    Quantity("film.minimum_at.0", lambda found: found.solution.film_scaled.minimum_at),
    Quantity("film.rigid_approach", lambda found: found.solution.rigid_approach),
    Quantity(
        "pressure.max_pa",
        lambda result: float(result.scaled.pressure.max()) * result.scales.hertz_pressure,
        name="pressure_max",
        certified="film",
        symbol="p_max",
        unit="GPa",
        words=_words("largest pressure", "axis list notebook line report page", key="p_max"),
    ),
    Quantity(
        "pressure.P_max",
        lambda result: float(result.scaled.pressure.max()),
        name="pressure_max",
        certified="film",
    ),
    Quantity("pressure.P_central", lambda result: result.scaled.at_origin(result.scaled.pressure)),
    Quantity("temperature.film_rise_max_at.0"),
    Quantity(
        "temperature.film_rise_max_k",
        name="film_rise_max",
        certified="shown",
        unit="K",
        digits="0.0",
        words={
            "axis": "largest temperature rise of the film",
            "list": "film rise",
            "notebook": "temperature rise",
            "report": "film temperature rise, largest",
            "rises": "film, at most",
        },
    ),
    Quantity(
        "temperature.mid_film_rise_central_k",
        name="mid_film_rise_central",
        certified="following",
        unit="K",
        words={
            "axis": "central temperature rise at mid-film",
            "report": "mid-film temperature rise, central",
            "rises": "mid-film, at X = Y = 0",
        },
    ),
    Quantity(
        "temperature.mean_rise_central_k",
        words={"rises": "mean across the film, at X = Y = 0"},
    ),
    Quantity(
        "temperature.surface_1_rise_max_k",
        name="surface_1_rise_max",
        unit="K",
        digits="0.0",
        words={"list": "rise of surface 1", "rises": "surface 1, at most"},
    ),
    Quantity(
        "temperature.surface_2_rise_max_k",
        name="surface_2_rise_max",
        unit="K",
        digits="0.0",
        words={"list": "rise of surface 2", "rises": "surface 2, at most"},
    ),
    Quantity("temperature.inlet_k"),
    Quantity("traction.sliding", lambda found: found.mid_film),
    *_plain("traction", "surface_1"),
    Quantity(
        "traction.mid_film",
        name="traction_mid_film",
        certified="following",
        words={
            "axis": "traction coefficient",
            "notebook": "traction",
            "report": "traction at mid-film",
            "bar": "at mid-film",
        },
    ),
    *_plain("traction", "surface_2 rolling rolling_by_film closure_error credible"),
    *_plain("traction", "friction_power_w"),
    Quantity(
        "traction.across",
        name="traction_across",
        certified="following",
        words={
            "axis": "traction coefficient across the entrainment",
            "list": "traction across",
            "report": "traction across, at mid-film",
            "bar": "across, at mid-film",
        },
    ),
    *_plain("traction", "rolling_across"),
    Quantity(
        "traction.drilling_moment_n_m",
        name="drilling_moment",
        certified="following",
        unit="N mm",
        words=_words("drilling moment", "axis list report", key="m_z", bar="drilling moment"),
    ),
    *_plain("traction.surroundings", "surface_1 mid_film surface_2 friction_power_w radius_m"),
    Quantity(
        "rolling.moment_n_m",
        lambda rolling: rolling.moment,
        name="rolling",
        certified="following",
        words={"axis": "rolling moment of one metre"},
    ),
    Quantity("rolling.force_n", lambda rolling: rolling.force, name="rolling"),
    *_plain("rolling", "shift_m tail_share closure_error T"),
    Quantity("heat.shear_w", lambda heat: heat.balance.shear, name="heat_shear"),
    Quantity("heat.compression_w", lambda heat: heat.balance.compression, name="heat_compression"),
    Quantity("heat.surface_1_w", lambda heat: heat.balance.surface_1, name="heat_surface_1"),
    Quantity("heat.surface_2_w", lambda heat: heat.balance.surface_2, name="heat_surface_2"),
    Quantity("heat.carried_out_w", lambda heat: heat.balance.carried_out, name="heat_carried_out"),
    *_lists("heat", "solid_peclet sources"),
    *_of_body(1),
    *_of_body(2),
    *_plain("bodies", "balance"),
    Quantity("roughness.surface_1_sq_m", lambda rough: rough.sq[0]),
    Quantity("roughness.surface_2_sq_m", lambda rough: rough.sq[1]),
    Quantity("roughness.composite_sq_m", lambda rough: rough.composite),
    Quantity("roughness.surface_1_sa_m", lambda rough: rough.resolution and rough.resolution.sa[0]),
    Quantity("roughness.surface_2_sa_m", lambda rough: rough.resolution and rough.resolution.sa[1]),
    Quantity("roughness.surface_1_sq_on_grid_m", lambda rough: rough.sq_on_grid[0]),
    Quantity("roughness.surface_2_sq_on_grid_m", lambda rough: rough.sq_on_grid[1]),
    Quantity("roughness.composite_sq_on_grid_m", lambda rough: math.hypot(*rough.sq_on_grid)),
    Quantity(
        "roughness.lost_share",
        lambda rough: rough.resolution.lost_share if rough.resolution else 0.0,
    ),
    Quantity("roughness.warning", lambda rough: rough.resolution and rough.resolution.warning),
    Quantity(
        "roughness.lambda_central",
        error=lambda_error(1.0),
        symbol="λ",
        digits="0.00",
        words={
            "axis": "central film over roughness λ",
            "list": "lambda",
            "page": "film over roughness",
            "key": "lambda",
        },
    ),
    Quantity("roughness.lambda_minimum", words={"axis": "minimum film over roughness λ"}),
    *_plain("roughness", "lambda_by_formula lubrication"),
    Quantity("roughness.film_quantiles.part", lambda pair: pair[0]),
    Quantity("roughness.film_quantiles.h_m", lambda pair: pair[1]),
    Quantity("roughness.area_below_composite_sq", lambda rough: rough.below_composite),
    Quantity("roughness.area_below_half_median", lambda rough: rough.below_half),
    *_lists("roughness", "minimum_at"),
    Quantity("roughness.P_max", lambda rough: rough.largest_pressure),
    Quantity("roughness.ripple_film_m", name="ripple_film"),
    Quantity("roughness.ripple_pressure_pa", name="ripple_pressure"),
    *_plain("roughness.ripples_x", "count depth_m"),
    *_plain("roughness.ripples_y", "count depth_m"),
    *_plain("roughness.waves", "wavelength_m angle_rad amplitude_m points_per_wave"),
    *_plain("roughness.waves", "film_amplitude_m film_phase_rad film_ratio"),
    *_plain("roughness.waves", "pressure_amplitude_pa pressure_phase_rad carried_amplitude_m"),
    Quantity("roughness.waves.theory_film_ratio", lambda wave: wave.theory.film_ratio),
    Quantity("roughness.waves.theory_pressure_pa", lambda wave: wave.theory.pressure),
    Quantity("roughness.waves.elastic_pressure_pa", lambda wave: wave.theory.elastic_pressure),
    Quantity("roughness.waves.compressibility", lambda wave: wave.theory.compressibility),
    Quantity("roughness.wave_notes.0", lambda rough: list(rough.wave_notes)),
    Quantity(
        "load_sharing.share",
        name="load_share",
        certified="following",
        unit="%",
        words={
            "axis": "load on asperities over the load",
            "notebook": "load on asperities",
            "bar": "of the load",
        },
    ),
    *_plain("load_sharing", "share_error"),
    Quantity("load_sharing.friction", words={"axis": "friction coefficient"}),
    Quantity("load_sharing.friction_film", words={"axis": "friction coefficient of the film"}),
    Quantity(
        "load_sharing.friction_boundary", words={"axis": "friction coefficient of asperities"}
    ),
    *_plain("load_sharing", "area_m2 area_part asperity_pressure_max_pa pressure_max_pa"),
    *_plain("load_sharing", "separation_central_m"),
    Quantity(
        "load_sharing.separation_ratio",
        words={"axis": "separation of the mean planes over σ"},
    ),
    *_plain("load_sharing", "power_boundary_w balance"),
    *_plain("load_sharing.spots", "number radius_m pressure_pa elastic_pressure_pa flash_rise_k"),
    Quantity(
        "touching.share",
        _if_known("share"),
        name="contact_share",
        certified="following",
        unit="%",
    ),
    Quantity("touching.share_error", _if_known("share_error")),
    *_plain("touching", "margin_m"),
    Quantity("touching.friction", _if_known("friction")),
    *_plain("touching", "friction_film"),
    Quantity("touching.friction_boundary", _if_known("friction_boundary")),
    *_plain("touching", "area_m2 area_part contact_pressure_max_pa pressure_max_pa"),
    Quantity("touching.power_boundary_w", _if_known("power_boundary")),
    *_plain("touching", "balance"),
    *_plain("touching.patches", "number area_mean_m2 area_largest_m2 pressure_mean_pa"),
    *_plain("touching.patches", "pressure_max_pa cells"),
    Quantity(
        "kappa",
        kappa,
        error=lambda_error(KAPPA),
        symbol="κ",
        digits="0.00",
        words={"list": "kappa, as lambda^1.3", "page": "viscosity ratio (ISO 281), from λ"},
    ),
    Quantity(
        "temperature_max",
        largest_temperature,
        error=largest_temperature_error,
        symbol="T_max",
        unit="°C",
        words={"page": "largest temperature", "key": "t_max"},
    ),
    Quantity(
        "friction",
        friction,
        error=friction_error,
        symbol="μ",
        digits="0.0000",
        words={"list": "friction", "page": "friction coefficient"},
    ),
    Quantity(
        "power",
        power_loss,
        error=friction_error,
        symbol="P",
        unit="W",
        words={"list": "friction loss", "page": "power loss"},
    ),
    Quantity(
        "share",
        share,
        error=share_error,
        unit="%",
        digits="0.0",
        symbol="w_a/w",
        words=_words("load on asperities", "list page", key="load_share"),
    ),
    Quantity("starvation.ratio", words={"axis": "supply over that of the flooded contact r"}),
    Quantity(
        "starvation.degree",
        words={"axis": "film over flooded film", "list": "degree of starvation"},
    ),
    *_plain("starvation", "degree_error degree_by_law flooded_film_m meniscus_m"),
    Quantity(
        "starvation.inlet_distance_m",
        words={"axis": "distance of the meniscus ahead of the contact"},
    ),
    *_plain("starvation", "entering_m leaving_m leaving_each_m balance"),
    *stress_quantities(),
    Quantity(
        "dynamics.stiffness_n_per_m",
        lambda film: film.stiffness[0],
        error=lambda numbers: numbers.get("dynamics.stiffness_error"),
        symbol="k",
        unit="N/um",
        words=_words("stiffness", "axis list notebook", report="stiffness of the film, static"),
    ),
    Quantity(
        "dynamics.damping_n_s_per_m",
        lambda film: film.damping[0],
        error=lambda numbers: numbers.get("dynamics.damping_error"),
        symbol="c",
        unit="N s/m",
        words=_words("damping", "axis list notebook", report="damping of slow vibrations"),
    ),
    Quantity(
        "dynamics.stiffness_error", lambda film: film.stiffness_error[0] / abs(film.stiffness[0])
    ),
    Quantity("dynamics.damping_error", lambda film: film.damping_error[0] / abs(film.damping[0])),
    *(
        Quantity(f"dynamics.over_frequency.{key}", itemgetter(without_unit(key)))
        for key in DYNAMICS.split()
    ),
    Quantity("convergence.cycles", lambda found: len(found.finest)),
    Quantity("convergence.residual", _last("residual")),
    Quantity("convergence.change", _last("change")),
    Quantity("convergence.load_error", _last("load_error")),
    Quantity(
        "convergence.heat_balance_error",
        lambda found: found.solution.heat and found.solution.heat.balance.error,
    ),
    Quantity("convergence.work_balance_error", lambda found: found.work_error),
    *_plain("errors", "central minimum discretisation_central discretisation_minimum"),
    *_plain("errors", "iteration_central iteration_minimum domain supply"),
    *_plain("errors", "extrapolated spike_resolved"),
    Quantity("cost.points.0", lambda result: [result.scaled.x.size, result.scaled.y.size]),
    *_of_part("cost", "cost", "cpu_seconds wall_seconds work"),
)
TRANSIENT: tuple[Quantity, ...] = (
    Quantity("film.h_min_m.value", name="film_minimum", unit="nm"),
    Quantity("film.h_central_m.least", name="film_central_least", unit="nm"),
    Quantity("film.h_central_m.largest", name="film_central_largest", unit="nm"),
    Quantity("pressure.p_max_pa.value", name="pressure_max", unit="GPa"),
    Quantity("temperature.film_rise_max_k.value", name="film_rise_max", unit="K"),
    Quantity("traction.extreme", name="traction_extreme", words={"bar": "at the extreme"}),
)
"""Extremes of a transient result that have error bars when it is certified."""
