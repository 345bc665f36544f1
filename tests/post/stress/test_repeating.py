"""Stress below pieces that go on along y: against long rows of them, and a line contact."""

import numpy as np
import pytest

import tehl
from tehl.contact.options import Domain, Options
from tehl.post.stress.influence import HalfSpace
from tehl.post.stress.moving import moving_stress
from tehl.post.stress.repeating import RepeatingHalfSpace
from tehl.post.stress.window import halved
from tests.solver.test_piece import THINNING, contact, oblique, periodic, piece, ridged

LINES, COLUMNS, SIDES = 32, 121, (0.015, 0.02)
PERIOD = LINES * SIDES[0]
SLIDING = {"kind": {"slide_roll_ratio": 0.3}, "lubricant": THINNING, "stress": {"body": 1}}


def loads(lines, *, even=False):
    """Pressure and tractions that repeat, even or odd about the first line if wanted."""
    x = (np.arange(COLUMNS) - COLUMNS // 2) * SIDES[1]
    turn = 2.0 * np.pi * lines[:, None] / LINES
    base = np.cos(0.5 * np.pi * np.minimum(np.abs(x), 1.0)) ** 3
    lean, wave = (0.0, np.cos(turn)) if even else (4.0 * x, np.sin(turn))
    pressure = base * (1.0 + 0.3 * np.cos(turn + lean) + 0.1 * np.cos(2.0 * turn))
    return pressure, 0.05 * pressure * (1.0 + 0.2 * wave), 0.1 * base * np.sin(turn)


@pytest.mark.parametrize("ends", ["periodic", "mirrored"])
@pytest.mark.parametrize("depth", [0.08, 0.15])
def test_stresses_vary_as_in_the_middle_of_a_long_row_of_pieces(depth, ends):
    """Its ends, eight pieces away, change what all lines share: plane strain is a hundred away."""
    stored = LINES if ends == "periodic" else LINES // 2
    here = RepeatingHalfSpace((stored + 1, COLUMNS), SIDES, ends)
    acting = loads(np.arange(stored + 1.0), even=ends == "mirrored")
    found = here.stresses(here.spectra_of(*acting), here.influence(depth), 0.3)
    lines = np.arange(-8.0 * LINES, 9.0 * LINES + 1.0)
    row = HalfSpace((lines.size, COLUMNS), SIDES)
    spectra = row.spectra_of(*loads(lines, even=ends == "mirrored"))
    whole = row.stresses(spectra, row.influence(depth), 0.3)
    middle = whole[:, 8 * LINES : 8 * LINES + stored + 1]
    first = found[:, :1], middle[:, :1]
    np.testing.assert_allclose(found - first[0], middle - first[1], atol=2e-3)
    assert np.abs(middle - first[1]).max() > 0.15


@pytest.mark.parametrize("ends", ["periodic", "mirrored"])
def test_loads_on_every_second_node_are_the_same_whole(ends):
    stored = LINES if ends == "periodic" else LINES // 2
    for number, load in enumerate(loads(np.arange(stored + 1.0), even=ends == "mirrored")):
        coarse = halved(load, ends, odd=number == 2)
        weights = [np.ones(one.shape[0]) for one in (load, coarse)]
        for one in weights:
            one[[0, -1]] = 0.5
        total = weights[0] @ load[:, 1:-1].sum(axis=1)
        if number == 2 and ends == "mirrored":  # half of an odd wave
            assert np.abs(coarse[[0, -1]]).max() < 1e-14
            continue
        assert 4.0 * (weights[1] @ coarse.sum(axis=1)) == pytest.approx(total, abs=1e-10)


def test_the_stress_below_a_piece_does_not_depend_on_where_its_ends_are():
    options = Options(points=(129, 33), wedge_order=3, accuracy="tight")
    first, moved = (
        tehl.solve(periodic(surface_2=oblique(60.0, phase), **SLIDING), options).stress
        for phase in ("0 deg", "90 deg")
    )
    for name in ("shear", "orthogonal", "dang_van", "life", "life_coarse"):
        assert getattr(moved, name) == pytest.approx(getattr(first, name), rel=1e-7)
    rows = (np.arange(33) - 8) % 32
    assert moved.across == pytest.approx(first.across[..., rows], rel=1e-6)


def test_an_even_wave_has_the_same_stress_between_mirrors_and_again_and_again():
    options = Options(points=(129, 33), wedge_order=3)
    mirrored = tehl.solve(piece("0.2 mm", surface_2=ridged("0.2 mm"), **SLIDING), options)
    again = tehl.solve(
        piece(
            "0.2 mm",
            surface_2=ridged("0.2 mm"),
            **SLIDING | {"kind": {"slide_roll_ratio": 0.3, "ends": "periodic"}},
        ),
        options,
    )
    assert again.stress.shear == pytest.approx(mirrored.stress.shear, rel=1e-5)
    # a wave of 0.2 mm is not felt at three half-widths
    smooth = tehl.solve(piece("0.2 mm", **SLIDING), options)
    change = np.abs(mirrored.stress.shear / smooth.stress.shear - 1.0)
    assert change[0, 0] > 1000.0 * change[0, -1]


def test_the_stress_below_a_piece_over_time_begins_with_that_of_the_steady_film():
    stated = SLIDING | {"transient": {"frames": 2, "duration": "20 us", "start": "standing"}}
    run = tehl.solve_transient(
        periodic(surface_2=oblique(45.0), **stated), Options(points=(129, 33))
    )
    found = moving_stress(run)
    start = run.start.with_stress(body=1).stress
    assert found.depth == pytest.approx(start.depth)
    assert found.shear[0] == pytest.approx(start.shear[0], rel=2e-3)


FAST = {"moes_load": None, "moes_speed": None, "hertz_pressure": 0.6e9, "entrainment_speed": 4.0}
HOT = {
    "kind": FAST | {"slide_roll_ratio": 0.5},
    "lubricant": THINNING,
    "thermal": {"temperature": "40 degC"},
    "stress": {"thermal": True},
}


def smooth(stated, ends, nodes):
    """Return the stresses below a smooth piece of 0.2 mm and below the line contact that it is."""
    # so wide that the depths of both follow from the mesh width along x
    options = {"wedge_order": 3, "accuracy": "tight", "domain": Domain(x=(-5.2, 2.4))}
    kind = stated["kind"]
    rest = {key: value for key, value in stated.items() if key != "kind"}
    line = contact({"type": "line"} | kind, **rest)
    again = piece("0.2 mm", kind=kind | {"ends": ends}, **rest)
    grids = (nodes, (nodes - 1) // 4 + 1), (nodes, 1)
    return (
        tehl.solve(problem, Options(points=points, **options)).stress
        for problem, points in zip((again, line), grids, strict=True)
    )


@pytest.mark.parametrize("ends", [pytest.param("periodic", marks=pytest.mark.slow), "mirrored"])
def test_the_stress_below_a_smooth_piece_is_that_below_a_line(ends):
    found, line = smooth(SLIDING, ends, 257)
    assert found.depth == pytest.approx(line.depth)
    for name in ("shear", "von_mises", "orthogonal", "dang_van", "shear_coarse", "life"):
        assert getattr(found, name) == pytest.approx(getattr(line, name), rel=2e-5), name


@pytest.mark.parametrize("ends", ["periodic", pytest.param("mirrored", marks=pytest.mark.slow)])
def test_the_heat_below_a_smooth_piece_is_that_below_a_line(ends):
    found, line = smooth(HOT, ends, 129)
    assert found.thermal == pytest.approx(line.thermal, rel=1e-5)
    assert line.thermal.min() > 2e7
    for name in ("shear", "von_mises", "orthogonal", "shear_coarse", "life"):
        assert getattr(found, name) == pytest.approx(getattr(line, name), rel=5e-5), name


def test_the_heat_below_a_piece_does_not_depend_on_where_its_ends_are():
    options = Options(points=(129, 33), wedge_order=3, accuracy="tight")
    first, moved = (
        tehl.solve(periodic(surface_2=oblique(60.0, phase), **HOT), options).stress
        for phase in ("0 deg", "90 deg")
    )
    for name in ("shear", "orthogonal", "dang_van", "thermal", "life_coarse"):
        assert getattr(moved, name) == pytest.approx(getattr(first, name), rel=1e-6)
    rows = (np.arange(33) - 8) % 32
    assert moved.across == pytest.approx(first.across[..., rows], rel=1e-5)
