"""Arrays of a result file: attribute of the result, name in the file, dimensions, unit, meaning."""

from typing import NamedTuple

DEFINITIONS = """\
reduced modulus E': 2/E' = (1 - nu1^2)/E1 + (1 - nu2^2)/E2 (twice the contact modulus E*)
entrainment speed: u_m = (u1 + u2)/2; slide-to-roll ratio: SRR = (u1 - u2)/u_m
surfaces: 1 is z = 0, 2 is z = h; x along entrainment, the inlet is at negative x
Hertz: p_h = 3 w/(2 pi a_x a_y); for a circle a^3 = 3 w R/(2 E')
dimensionless: X = x/a_x, Y = y/a_y, P = p/p_h, H = h R_x/a_x^2
Moes: M = W (2U)^(-3/4), L = G (2U)^(1/4); U = eta_0 u_m/(E' R_x), W = w/(E' R_x^2), G = alpha E'
pressure is gauge, positive in compression; cavitation by complementarity (p >= 0)
h_central is the film at x = y = 0; h_min is the sub-grid minimum
shear stress: tau = eta du/dz, negative for SRR > 0; traction is its integral over p > 0 by the load
temperature in kelvin over (zeta, y, x), zeta = z/h; rises are over the oil at the inlet
heat flux and powers into the solids are positive where the film heats them"""


class Column(NamedTuple):
    """One array: dimensions, attribute that holds it, name in the file, unit and long name."""

    dims: tuple[str, ...]
    field: str
    name: str
    units: str
    text: str


def _table(axes: str, *rows: tuple[str, str, str, str]) -> tuple[Column, ...]:
    return tuple(Column(tuple(axes.split()), *row) for row in rows)


FIELDS = (
    *_table("x", ("x", "x", "m", "coordinate along entrainment")),
    *_table("y", ("y", "y", "m", "coordinate across entrainment")),
    *_table(
        "y x",
        ("pressure", "pressure", "Pa", "film pressure"),
        ("film_thickness", "film_thickness", "m", "film thickness"),
    ),
)
SCALED = (
    *_table("x", ("x", "X", "1", "x / a_x")),
    *_table("y", ("y", "Y", "1", "y / a_y")),
    *_table("y x", ("pressure", "P", "1", "p / p_h"), ("film", "H", "1", "h R_x / a_x^2")),
)
SHEAR = _table(
    "y x",
    ("surface_1", "shear_stress_1", "Pa", "tau_zx at z = 0, on surface 1"),
    ("mid_film", "shear_stress_mid", "Pa", "tau_zx at z = h/2"),
    ("surface_2", "shear_stress_2", "Pa", "tau_zx at z = h, on surface 2"),
    ("across", "shear_stress_across", "Pa", "tau_zy at z = h/2"),
    ("thinning", "shear_thinning", "1", "effective over Newtonian viscosity at z = h/2"),
)
HEIGHTS = _table(
    "y x",
    ("surface_1", "height_1", "m", "height of surface 1, positive outwards"),
    ("surface_2", "height_2", "m", "height of surface 2, positive outwards"),
)
ASPERITIES = (
    *_table(
        "y x",
        ("pressure", "asperity_pressure", "Pa", "pressure of asperities finer than the grid"),
        ("area", "asperity_area", "1", "part of the area in which they touch"),
        ("spots", "asperity_spots", "1/m^2", "spots in which they touch, per area"),
        ("separation", "separation", "m", "distance of the mean planes of both surfaces"),
    ),
    *_table(
        "",
        ("rms", "asperity_rms", "m", "standard deviation of their heights"),
        ("balance", "asperity_oil_balance", "1", "mass-balance error, over the inflow"),
    ),
)
CONTACT = (
    *_table("y x", ("pressure", "contact_pressure", "Pa", "pressure of contact beside the oil")),
    *_table("", ("balance", "contact_oil_balance", "1", "mass-balance error, over the throughput")),
)
STRESS = (
    *_table("body", ("body", "stress_body", "1", "number of the body")),
    *_table("depth", ("depth", "stress_depth", "m", "depth below the surface")),
    *_table("stress_x", ("x", "stress_x", "m", "coordinate along entrainment of stresses")),
    *_table("stress_y", ("y", "stress_y", "m", "coordinate across entrainment of stresses")),
    *_table(
        "body depth stress_x",
        *(
            (name, f"stress_{name}", "Pa", f"sigma_{name} on y = 0, tension positive")
            for name in ("xx", "yy", "zz", "xy", "yz", "zx")
        ),
    ),
    *_table(
        "body depth stress_y",
        ("across", "shear_max_across", "Pa", "largest shear stress on x = 0"),
    ),
    *_table(
        "body stress_y stress_x",
        ("floor", "shear_max_floor", "Pa", "largest shear stress at the depth where it is largest"),
    ),
    *_table("body", ("floor_depth", "shear_max_floor_depth", "m", "that depth")),
    *_table(
        "body depth",
        ("shear", "shear_max", "Pa", "largest shear stress at the depth"),
        ("shear_x", "shear_max_x", "m", "its place along x"),
        ("shear_y", "shear_max_y", "m", "its place along y"),
        ("von_mises", "von_mises_max", "Pa", "largest stress of von Mises"),
        ("orthogonal", "orthogonal_shear", "Pa", "largest amplitude of tau_zx along x"),
        ("dang_van", "dang_van", "Pa", "largest stress of Dang Van"),
        ("shear_coarse", "shear_max_coarse", "Pa", "shear_max by loads on every second node"),
        ("shear_dry", "shear_max_dry", "Pa", "shear_max of the dry smooth contact"),
        ("orthogonal_dry", "orthogonal_shear_dry", "Pa", "orthogonal_shear of the dry contact"),
        ("dang_van_dry", "dang_van_dry", "Pa", "dang_van of the dry smooth contact"),
    ),
    *_table(
        "body",
        ("life", "life_ratio", "1", "life over that of the dry smooth contact"),
        ("life_coarse", "life_ratio_coarse", "1", "life_ratio by loads on every second node"),
        ("traction", "stress_traction", "1", "force of the film on the body over the load"),
        ("thermal", "thermal_stress", "Pa", "E alpha dT/(1 - nu) of the warmest place"),
    ),
    *_table("", ("left_out", "stress_traction_left_out", "1", "1 where film shear is left out")),
)
OIL = (
    *_table("y x", ("fill", "fill", "1", "part of the gap that is oil")),
    *_table(
        "y",
        ("entering", "oil_entering", "m", "layer of oil at the inlet edge, both surfaces"),
        ("leaving", "oil_leaving", "m", "layer of oil at the outlet edge, both surfaces"),
    ),
)
PASSES = _table(
    "pass",
    ("number", "pass", "1", "number of the pass"),
    ("time", "pass_time", "s", "time at the pass"),
    ("film_central", "pass_film_central", "m", "central film"),
    ("film_minimum", "pass_film_minimum", "m", "minimum film"),
    ("entering", "pass_oil_entering", "m", "oil before the contact, on y = 0, both surfaces"),
    ("leaving", "pass_oil_leaving", "m", "oil after the contact, on y = 0, both surfaces"),
    ("inlet_distance", "pass_inlet_distance", "m", "from the meniscus to the Hertz contact, y = 0"),
)
DYNAMICS = _table(
    "frequency",
    ("frequency", "frequency", "Hz", "frequency of a small harmonic change"),
    ("stiffness", "stiffness", "N/m", "load by approach, in phase"),
    ("damping", "damping", "N s/m", "load by approach, a quarter period ahead, over omega"),
    ("stiffness_error", "stiffness_error", "N/m", "error bar of the stiffness"),
    ("damping_error", "damping_error", "N s/m", "error bar of the damping"),
    ("amplitude", "amplitude", "m", "approach at which the cavity would move by 0.1 a_x"),
    ("load_by_speed", "load_by_speed", "N s/m", "load by entrainment speed, in phase"),
    ("load_by_acceleration", "load_by_acceleration", "N s^2/m", "the same ahead, over omega"),
    ("rolling_stiffness", "rolling_stiffness", "N/m", "rolling force by approach, in phase"),
    ("rolling_damping", "rolling_damping", "N s/m", "the same ahead, over omega"),
    ("rolling_by_speed", "rolling_by_speed", "N s/m", "rolling force by entrainment speed"),
    ("rolling_by_acceleration", "rolling_by_acceleration", "N s^2/m", "the same, over omega"),
)
HEAT = (
    *_table(
        "zeta",
        ("zeta", "zeta", "1", "z / h, 0 on surface 1"),
        ("weights", "zeta_weights", "1", "weights of the mean across the film"),
    ),
    *_table("zeta y x", ("temperature", "temperature", "K", "temperature of the film")),
    *_table(
        "y x",
        ("flux_1", "heat_flux_1", "W/m^2", "heat conducted into surface 1"),
        ("flux_2", "heat_flux_2", "W/m^2", "heat conducted into surface 2"),
    ),
)
GRIDS = _table(
    "cycle",
    ("index", "cycle", "1", "cycles in the order they were made, coarse grids first"),
    ("points_x", "history_points_x", "1", "nodes of the grid in x"),
    ("points_y", "history_points_y", "1", "nodes of the grid in y"),
)
CYCLES = _table(
    "cycle",
    ("cycle", "history_number", "1", "number of the cycle on its grid"),
    ("residual", "history_residual", "1", "mean residual scaled by the local diagonal"),
    ("change", "history_change", "1", "largest change of P in the cycle"),
    ("load_error", "history_load_error", "1", "relative error of the load balance"),
    ("film_central", "history_film_central", "1", "H at X = Y = 0 after the cycle"),
    ("film_minimum", "history_film_minimum", "1", "smallest nodal H after the cycle"),
    ("smoother", "history_smoother", "1", "setting of the relaxation"),
    ("temperature_change", "history_temperature_change", "K", "largest change of film temperature"),
)
"""Parts of a steady result."""

HISTORY = _table(
    "time",
    (
        "time",
        "time",
        "s",
        "time; at a constant speed both surfaces have moved on by u_m time on average",
    ),
    ("load", "load_factor", "1", "load over that of the contact"),
    ("speed", "speed_factor", "1", "entrainment speed over that of the contact"),
    ("radius", "radius_factor", "1", "radius along x over that of the contact"),
    ("sliding", "sliding_factor", "1", "u_1 - u_2 over the entrainment speed of the contact"),
    ("film_central", "h_central", "m", "film at x = y = 0"),
    ("film_minimum", "h_min", "m", "smallest film between the nodes"),
    ("pressure_max", "p_max", "Pa", "largest pressure"),
    ("traction", "traction", "1", "mid-film traction coefficient, over the load at that time"),
    ("traction_across", "traction_across", "1", "the same along y"),
    ("drilling_moment", "drilling_moment", "N m", "moment of both tractions about the normal"),
    (
        "rolling_moment",
        "rolling_moment",
        "N m",
        "moment of the pressure of a line about the middle",
    ),
    ("asperity_load", "asperity_load", "1", "load on asperities, over the load at that time"),
    ("solid_friction", "solid_friction", "1", "friction of asperities and contact, over that load"),
    ("rigid_approach", "H00", "1", "rigid approach"),
    ("temperature_rise", "temperature_rise", "K", "largest rise of the film over the oil entering"),
    ("temperature_rise", "film_rise_max", "K", "largest rise over the oil at the inlet"),
    ("nodes", "step_nodes", "1", "nodes along x of the step"),
    ("cycles", "step_cycles", "1", "multigrid cycles of the step"),
    ("change", "step_change", "1", "largest change of P in the last cycle of the step"),
)
PROFILES = _table(
    "time x",
    ("pressure", "pressure_centre_line", "Pa", "pressure along y = 0"),
    ("film", "film_centre_line", "m", "film thickness along y = 0"),
    ("height_1", "height_1_centre_line", "m", "height of surface 1 along y = 0, outwards"),
    ("height_2", "height_2_centre_line", "m", "height of surface 2 along y = 0, outwards"),
)
FRAME_TIMES = _table(
    "frame",
    ("step", "frame_step", "1", "step of the frame"),
    ("time", "frame_time", "s", "time of the frame"),
)
FRAMES = _table(
    "frame y x",
    ("pressure", "pressure_frames", "Pa", "pressure of the frames"),
    ("film", "film_frames", "m", "film thickness of the frames"),
    ("height", "height_frames", "m", "heights of both surfaces of the frames, outwards"),
)
FRAME_STRESS = _table(
    "frame y x", ("stress", "shear_stress_frames", "Pa", "tau_zx at mid-film of the frames")
)
BARS = _table(
    "bar",
    ("time", "bar_time", "s", "times of the error bars"),
    ("film_central", "h_central_bar", "m", "half width of the error bar of h_central"),
    ("film_minimum", "h_min_bar", "m", "half width of the error bar of h_min"),
    ("pressure_max", "p_max_bar", "Pa", "half width of the error bar of p_max"),
)
"""Further parts of a transient result."""

COORDINATES = (
    *("x", "y", "X", "Y", "zeta", "cycle", "time", "frame_time", "bar_time"),
    *("stress_body", "stress_depth", "stress_x", "stress_y", "frequency"),
)
"""Arrays that are coordinates of a dataset."""
