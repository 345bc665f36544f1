"""Pieces of rollers that go on behind mirrors: as a line contact, over one period or two."""

import numpy as np
import pytest

import tehl
from tehl.contact.options import Options

STEEL = {"material": "steel"}
LINE_FILM = 0.0297827
"""Central film of the line contact, on 257 nodes to the tolerance [-]."""
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
    for shape, points in (({"type": "line"}, (257, 1)), ({}, (257, 65))):
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
        ({}, {"stress": {}}, "whole contact"),
        ({"slide_roll_ratio": 2.0}, {"thermal": {"temperature": "40 degC"}}, "at rest"),
        ({"type": "point"}, {}, "has ends"),
    ],
)
def test_what_a_piece_cannot_state_is_said_in_one_sentence(kind, stated, reason):
    with pytest.raises(tehl.InputError, match=reason):
        piece("0.2 mm", kind=kind, **stated)
