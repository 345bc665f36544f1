"""Pieces of rollers that go on: behind mirrors, or with the film of their other end."""

import math
from dataclasses import asdict

import numpy as np
import pytest

import tehl
from tehl.contact.options import Domain, Options
from tehl.estimate.grid import Grid
from tehl.solver.judging.film_summary import film_summary

STEEL = {"material": "steel"}
LINE_FILM = 0.0297827
"""Central film of the line contact, on 257 nodes to the tolerance [-]."""
THINNING = {"name": "mineral-oil", "shear": {"law": "eyring", "stress": 5e6}}
HEAT = {"thermal": {"temperature": "40 degC", "sources": "full"}}


def contact(kind: dict[str, object], **stated: object) -> tehl.ContactProblem:
    """Return a contact of steel with M = 50, L = 10."""
    motion = {"radius": "10 mm", "moes_load": 50.0, "moes_speed": 10.0}
    return tehl.ContactProblem(
        contact=motion | kind,
        **{"surface_1": STEEL, "surface_2": STEEL, "lubricant": "mineral-oil"} | stated,
    )


def piece(length: str, **stated: object) -> tehl.ContactProblem:
    """Return a piece of a roller between mirrors."""
    kind = stated.pop("kind", {})
    return contact({"type": "roller", "ends": "mirrored", "length": length} | kind, **stated)


def ridged(wavelength: str, amplitude: str = "50 nm") -> dict[str, object]:
    """Return a surface with ridges along x, a crest at y = 0."""
    wave = {"type": "wave", "amplitude": amplitude, "wavelength": wavelength, "angle": "90 deg"}
    return STEEL | {"roughness": wave}


def oblique(angle: float, phase: str = "0 deg", amplitude: str = "30 nm") -> dict[str, object]:
    """Return a surface with a wave at an angle [deg], one period of which along y is 0.2 mm."""
    wave = {"type": "wave", "amplitude": amplitude, "angle": f"{angle} deg", "phase": phase}
    wave["wavelength"] = f"{0.2 * abs(math.sin(math.radians(angle)))!r} mm"
    return STEEL | {"roughness": wave}


def periodic(**stated: object) -> tehl.ContactProblem:
    """Return a piece of 0.2 mm that repeats itself."""
    kind = stated.pop("kind", {})
    return piece("0.2 mm", kind={"ends": "periodic"} | kind, **stated)


@pytest.mark.parametrize(
    ("kind", "physics"),
    [
        ({}, {}),
        ({"slide_roll_ratio": 0.1}, HEAT),
    ],
    ids=["isothermal", "heated"],
)
def test_a_smooth_piece_is_a_line_contact(kind, physics):
    film, heat = [], []
    for shape, points in (({"type": "line"}, (129, 1)), ({}, (129, 33))):
        options = Options(points=points, wedge_order=3, accuracy="tight")
        make = contact(shape | kind, **physics) if shape else piece("0.5 mm", kind=kind, **physics)
        found = tehl.solve(make, options)
        film.append(found.scaled.film)
        heat.append(found.temperature.mean.max() if physics else 0.0)
    assert film[1] == pytest.approx(np.broadcast_to(film[0], film[1].shape), rel=1e-5)
    assert heat[1] == pytest.approx(heat[0], rel=1e-6)


@pytest.mark.parametrize("order", [2, 3])
def test_the_bar_of_a_piece_contains_its_error_along_x(order):
    """Its first grids have the same columns: with 65 the film of order 2 errs by 8 %."""
    found = tehl.solve(piece("0.2 mm"), Options(wedge_order=order))
    error = abs(found.film_scaled.central / LINE_FILM - 1.0)
    assert error < found.errors.central < 0.03


def test_a_rigid_piece_touches_dry_on_one_column_and_is_a_line_contact():
    """Its domain is 160 half-widths long: 65 columns put one on them, whose gap is its mean."""
    nearly_rigid = {"moes_load": 0.04}
    line = tehl.solve(contact({"type": "line"} | nearly_rigid))
    found = tehl.solve(piece("50 mm", kind=nearly_rigid))
    film = found.film_scaled.central
    assert abs(film / line.film_scaled.central - 1.0) < found.errors.central


def test_a_film_over_one_period_is_that_over_two():
    one, two = (
        tehl.solve(
            piece(length, surface_2=ridged("0.2 mm")),
            Options(points=points, wedge_order=3, accuracy="tight"),
        )
        for length, points in (("0.2 mm", (129, 33)), ("0.4 mm", (129, 65)))
    )
    assert two.scaled.film[16:49] == pytest.approx(one.scaled.film, rel=1e-5)
    # oil flows around the crests
    assert float(np.ptp(one.scaled.film[:, 64])) > 0.1 * one.film_scaled.central


PHYSICS = {
    "isothermal": {},
    "starved": {"supply": {"ratio": 0.6}},
    "heated": {"kind": {"slide_roll_ratio": 0.3}, "lubricant": THINNING} | HEAT,
    "marched": {
        "kind": {"slide_roll_ratio": 0.3},
        "lubricant": THINNING,
        "thermal": {"temperature": "40 degC", "sources": "line"},
    },
    "counter-moving": {
        "kind": {"slide_roll_ratio": 2.5, "moes_load": 5.0, "moes_speed": 3.0},
        "thermal": {"temperature": "40 degC"},
    },
    "asperities": {
        "asperities": {
            "model": "greenwood-tripp",
            "summit_radius": "10 um",
            "summit_density": "2e10 1/m^2",
            "rms": "0.15 um",
        }
    },
    "touching": {
        "contact_film": {"thickness": "80 nm", "friction": 0.1},
        "surface_2": ("500 nm",),
    },
}
ALSO = ("isothermal", "touching")
"""What wraps in each of the others too, and what takes long."""
COLUMNS = {"touching": 129}
"""Nodes along x where the crests of the wave need more."""


@pytest.mark.parametrize(
    "physics",
    [
        *(one for one in PHYSICS if one not in ALSO),
        *(pytest.param(one, marks=pytest.mark.slow) for one in ALSO),
    ],
)
def test_a_film_that_wraps_does_not_depend_on_where_its_ends_are(physics):
    """A quarter of a period on the phase is eight lines, and the wave at -60 degrees its image."""
    stated, options = (
        dict(PHYSICS[physics]),
        Options(points=(COLUMNS.get(physics, 97), 33), wedge_order=3, accuracy="tight"),
    )
    amplitude = stated.pop("surface_2", ("30 nm",))
    waves = oblique(60.0, "0 deg", *amplitude), oblique(60.0, "90 deg", *amplitude)
    first, moved, image = (
        tehl.solve(periodic(surface_2=one, **stated), options)
        for one in (*waves, oblique(-60.0, "0 deg", *amplitude))
    )
    rows = (np.arange(33) - 8) % 32
    for one, other, place in ((moved, first, rows), (image, first, slice(None, None, -1))):
        assert one.scaled.film == pytest.approx(other.scaled.film[place], rel=1e-6)
        assert one.scaled.pressure == pytest.approx(other.scaled.pressure[place], abs=1e-5)
        if first.temperature is not None:
            mean = other.temperature.mean[place]
            assert one.temperature.mean == pytest.approx(mean, abs=1e-5)
    middle = first.scaled.x.size // 2
    assert float(np.ptp(first.scaled.film[:, middle])) > 0.005 * first.film_scaled.central
    assert moved.film.minimum == pytest.approx(first.film.minimum, rel=1e-6)
    if physics == "touching":
        assert first.touching.share > 0.1
        assert asdict(first.touching.patches) == pytest.approx(asdict(moved.touching.patches))


@pytest.mark.parametrize("shift", [-0.4, 0.0, 0.3])
def test_the_thinnest_film_may_be_between_both_ends(shift):
    ends = Domain.model_construct(x=(-1.0, 1.0), y=(-1.0, 1.0))
    grid = Grid(nx=33, ny=33, domain=ends, mirror=False, wraps=True)
    place = 1.0 + shift * grid.dy
    film = 2.0 - np.cos(np.pi * (grid.y[:, None] - place)) + grid.x**2
    found = film_summary(grid, film)
    assert found.minimum == pytest.approx(1.0, abs=2e-5)
    assert (found.minimum_at[1] - place + 1.0) % 2.0 - 1.0 == pytest.approx(0.0, abs=1e-3)
    assert -1.0 <= found.minimum_at[1] <= 1.0


@pytest.mark.parametrize("angle", [40.0, pytest.param(90.0, marks=pytest.mark.slow)])
def test_surfaces_that_slide_along_a_piece_leave_it_at_one_end_and_come_back_at_the_other(angle):
    """Oil and heat do: a shift of the wave shifts both, and a smooth piece is a line contact."""

    def kind(sign: float = 1.0) -> dict[str, object]:
        return {"slide_roll_ratio": 0.3, "sliding_angle": f"{sign * angle} deg"}

    options = {"wedge_order": 3, "accuracy": "tight"}
    rest = {"lubricant": THINNING, "thermal": {"temperature": "40 degC"}}
    first, moved, image, smooth = (
        tehl.solve(
            periodic(surface_2=surface, kind=kind(sign), **rest),
            Options(points=(65, 33), **options),
        )
        for surface, sign in (
            (oblique(60.0), 1.0),
            (oblique(60.0, "90 deg"), 1.0),
            (oblique(-60.0), -1.0),
            (STEEL, 1.0),
        )
    )
    rows = (np.arange(33) - 8) % 32
    for one, place in ((moved, rows), (image, slice(None, None, -1))):
        assert one.scaled.film == pytest.approx(first.scaled.film[place], rel=2e-5)
        assert one.temperature.mean == pytest.approx(first.temperature.mean[place], abs=2e-5)
    line = tehl.solve(
        contact({"type": "line"} | kind(), **rest), Options(points=(65, 1), **options)
    )
    every = np.broadcast_to(line.scaled.film, smooth.scaled.film.shape)
    assert smooth.scaled.film == pytest.approx(every, rel=1e-5)
    assert smooth.traction.across == pytest.approx(line.traction.across, rel=1e-5)


def test_a_wave_that_is_even_about_both_ends_is_that_between_mirrors():
    options = {"points": (129, 33), "wedge_order": 3, "accuracy": "tight"}
    even = {"surface_2": ridged("0.2 mm")}
    mirrored = tehl.solve(piece("0.2 mm", **even), Options(**options))
    halves = tehl.solve(periodic(**even), Options(**options))
    whole = tehl.solve(periodic(**even), Options(half_domain="never", **options))
    assert np.array_equal(halves.scaled.film, mirrored.scaled.film)
    assert whole.scaled.film == pytest.approx(mirrored.scaled.film, rel=3e-6)


def test_an_oblique_wave_moves_through_a_film_that_wraps_wherever_its_ends_are():
    runs = [
        tehl.solve_transient(
            periodic(
                surface_2=oblique(45.0, phase),
                kind={"slide_roll_ratio": 0.3},
                transient={
                    "frames": 2,
                    "duration": "0.1 ms",
                    "start": "standing",
                    "tolerance": 1e-5,
                    "max_cycles": 40,
                },
            ),
            Options(points=(129, 33)),
        )
        for phase in ("0 deg", "90 deg")
    ]
    rows = (np.arange(33) - 8) % 32
    first, moved = (run.frames.film[-1] for run in runs)
    assert float(np.ptp(first[:, 64])) > 0.01 * float(first[:, 64].mean())
    assert moved == pytest.approx(first[rows], rel=1e-4)


def test_the_stiffness_of_scarce_oil_does_not_depend_on_where_the_ends_are():
    """The fronts at which its film begins go on beyond the ends too."""
    first, moved = (
        tehl.solve(
            periodic(
                surface_2=oblique(60.0, phase, "60 nm"),
                supply={"ratio": 0.5},
                dynamics={"frequencies": ["300 Hz", "3 kHz"]},
            ),
            Options(points=(129, 33), wedge_order=3, accuracy="tight"),
        ).dynamics
        for phase in ("0 deg", "90 deg")
    )
    assert moved.stiffness == pytest.approx(first.stiffness, rel=1e-6)
    assert moved.damping == pytest.approx(first.damping, rel=3e-3)  # of 0.1 % of the stiffness


@pytest.mark.parametrize(
    "surface",
    [
        oblique(60.0) | {"roughness": oblique(60.0)["roughness"] | {"wavelength": "0.17 mm"}},
        ridged("0.4 mm"),  # as high at both ends, where it has a bend
        STEEL | {"roughness": {"type": "random", "rms": "40 nm", "correlation_length": "30 um"}},
    ],
    ids=["period", "bend", "random"],
)
def test_heights_that_do_not_repeat_are_named(surface):
    with pytest.raises(tehl.InputError, match=r"surface_2.roughness.*repeat along y.*mirrored"):
        tehl.solve(periodic(surface_2=surface), Options(points=(129, 65)))


def test_a_random_surface_that_repeats_goes_on():
    heights = {"type": "random", "rms": "40 nm", "correlation_length": "30 um"}
    surface = STEEL | {"roughness": heights | {"repeat_y": "0.2 mm", "seed": 2}}
    found = tehl.solve(periodic(surface_2=surface), Options(points=(129, 65)))
    stood = found.heights.surface_2
    assert stood.std() == pytest.approx(40e-9, rel=0.1)
    assert np.array_equal(stood[0], stood[-1])
    assert np.abs(stood[1] - stood[-2]).max() > 1e-9  # no mirrors


def test_a_dimple_within_a_piece_repeats():
    dimple = {"type": "bump", "amplitude": "0.1 um", "radius": "20 um"}
    found = tehl.solve(periodic(surface_2=STEEL | {"roughness": dimple}), Options(error="5 %"))
    assert found.status.converged


def test_cycles_on_cells_shorter_along_y_halve_lines_first():
    """Columns first, no cycles converge: Newton's method does, after 172 steps of all kinds."""
    options = Options(points=(257, 65), wedge_order=3, accuracy="tight")
    found = tehl.solve(piece("20 um", surface_2=ridged("20 um", "5 nm")), options)
    finest = [one for one in found.history if one.points == (257, 65)]
    assert {one.smoother for one in finest} == {"rough"}
    assert (finest[6].residual / finest[1].residual) ** 0.2 < 0.5


def test_a_piece_has_as_many_lines_as_its_waves_need():
    ridges = ridged("25 um", "5 nm")
    smooth, rough = (tehl.solve(piece("0.2 mm", surface_2=one)) for one in (STEEL, ridges))
    assert 2 * smooth.y.size < rough.y.size
    # no end: a moment about x would mean nothing, and pressures have limits
    assert rough.rolling.tilting is None
    assert rough.errors.pressure_has_limit
    assert smooth.film_scaled.central == pytest.approx(LINE_FILM, rel=smooth.errors.central)


@pytest.mark.parametrize(
    ("kind", "stated", "reason"),
    [
        ({"tilt": "0.01 deg"}, {}, "straight"),
        ({"profile": {"shape": "lundberg"}}, {}, "straight"),
        ({"slide_roll_ratio": 0.2, "sliding_angle": "20 deg"}, {}, "slide the other way"),
        (
            {"entrainment_speed": "0.01 m/s", "moes_speed": None},
            {
                "surface_1": STEEL | {"temperature": "40 degC"},
                "stress": {"thermal": True},
                "thermal": {"temperature": "40 degC"},
            },
            "below 10 is that of a whole contact",
        ),
        ({"slide_roll_ratio": 2.0}, {"thermal": {"temperature": "40 degC"}}, "at rest"),
        ({"type": "point"}, {}, "has ends"),
        (
            {"ends": "periodic", "spin_1": "10 rpm"},
            {},
            "spin times distance along the line, without end",
        ),
    ],
)
def test_what_a_piece_cannot_state_is_said_in_one_sentence(kind, stated, reason):
    with pytest.raises(tehl.InputError, match=reason):
        piece("0.2 mm", kind=kind, **stated)
