"""The tilt of a roller that follows from the moment of its load, the second rigid motion."""

import numpy as np
import pytest

import tehl
from tehl.cli.text import as_text
from tehl.contact.options import Domain, Options
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import ScaledProblem
from tehl.io.store import load, save
from tehl.operators.dry import dry_motions, dry_pressure
from tehl.operators.load import Load
from tehl.solver.cycle.hierarchy import Hierarchy
from tehl.solver.cycle.newton import Newton
from tehl.solver.cycle.relaxation import FAST
from tehl.solver.cycle.start import from_dry_pressure
from tests.solver.test_roller import STEEL, roller

TILT = 2e-4
CROWNED = {"shape": "crown", "radius": "2 m"}
UNEVEN = {
    "shape": "table",
    "drops": [["-5 mm", "6 um"], ["-2 mm", "1 um"], [0, 0], ["2 mm", "0.5 um"], ["5 mm", "4 um"]],
}
TIGHT = Options(points=(65, 33), accuracy="tight")
COARSE = Options(points=(65, 33))


def crowned(**stated: object) -> tehl.ContactProblem:
    """Return a roller with a crown under a light load."""
    return roller(20.0, profile=CROWNED, **stated)


@pytest.fixture(scope="module")
def tilted() -> tehl.Result:
    """Return the film of a roller with a stated tilt."""
    return tehl.solve(crowned(tilt=TILT), TIGHT)


@pytest.fixture(scope="module")
def pressed(tilted: tehl.Result) -> tehl.Result:
    """Return the film of a roller with the moment that a stated tilt makes."""
    return tehl.solve(crowned(tilting_moment=tilted.rolling.tilting), TIGHT)


def test_the_moment_of_a_tilt_gives_back_the_tilt_and_its_film():
    """The roller is loaded up to its ends, so that both films have the same lines."""
    flat = CROWNED | {"radius": "6 m"}
    tilted = tehl.solve(roller(20.0, profile=flat, tilt=TILT), TIGHT)
    moment = tilted.rolling.tilting
    pressed = tehl.solve(roller(20.0, profile=flat, tilting_moment=moment), TIGHT)
    assert pressed.rolling.tilt == pytest.approx(TILT, rel=1e-6)
    assert pressed.rolling.tilting == pytest.approx(tilted.rolling.tilting, rel=1e-7)
    assert pressed.scaled.film == pytest.approx(tilted.scaled.film, rel=1e-5)
    # the second motion costs no more cycles: H_00 alone takes as many on this grid
    cycles = [sum(one.points == (65, 33) for one in run.history) for run in (tilted, pressed)]
    assert cycles[1] <= cycles[0] + 3


def test_it_starts_from_the_dry_contact_with_the_moment(pressed):
    roller = pressed.groups.roller
    assert roller.tilt == pytest.approx(TILT, rel=0.4)  # of slices that bend by themselves
    ends = Domain.model_construct(x=(-1.6, 1.6), y=(-1.0, 1.0))
    grid = Grid(nx=65, ny=65, domain=ends, mirror=False)
    pressure = dry_pressure(grid, pressed.groups)
    moment = Load(grid).integral(grid.centres[:, None] * pressure)
    assert moment == pytest.approx(roller.scaled_moment, rel=1e-4)
    tilt = roller.tilt + roller.tilt_unit * dry_motions(grid, pressed.groups)[1]
    assert tilt == pytest.approx(TILT, rel=0.03)


def test_a_loaded_end_takes_no_more_cycles():
    """From slices, whose tilt is 1.6 times too large, single nodes alternate: 40 cycles."""
    end = {"profile": {"shape": "logarithmic"}, "tilting_moment": "1.8 N m"}
    found = tehl.solve(roller(20.0, **end), Options(points=(129, 65), wedge_order=3))
    assert sum(one.points == (129, 65) for one in found.history) <= 5
    assert found.rolling.tilt == pytest.approx(-4.06e-4, rel=0.05)


def test_the_opposite_moment_makes_the_mirrored_film(pressed):
    other = tehl.solve(crowned(tilting_moment=-pressed.rolling.tilting), TIGHT)
    assert other.rolling.tilt == pytest.approx(-pressed.rolling.tilt, rel=1e-6)
    assert other.scaled.film[::-1] == pytest.approx(pressed.scaled.film, rel=1e-6)


def test_an_even_roller_without_moment_does_not_tilt():
    free, held = (tehl.solve(crowned(**one), COARSE) for one in ({"tilting_moment": 0.0}, {}))
    assert free.rolling.tilt == 0.0
    assert free.scaled.film.tobytes() == held.scaled.film.tobytes()
    # nor does it on the nodes of both halves, where the tilt is unknown
    whole = tehl.solve(crowned(tilting_moment=0.0), Options(points=(65, 35), accuracy="tight"))
    assert abs(whole.rolling.tilt) < 1e-10


def test_an_uneven_roller_aligns_itself():
    free = tehl.solve(roller(20.0, profile=UNEVEN, tilting_moment=0.0), TIGHT)
    arm = 0.5 * free.load * free.problem.contact.length
    assert abs(free.rolling.tilting) < 1e-8 * arm
    assert free.rolling.tilt > 1e-5
    held = tehl.solve(roller(20.0, profile=UNEVEN), COARSE)
    assert held.rolling.tilting > 0.02 * arm
    assert held.rolling.tilt is None
    assert free.film.minimum > held.film.minimum


@pytest.mark.parametrize(
    "physics",
    [
        {"thermal": {"temperature": "40 degC"}, "slide_roll_ratio": 0.1},
        {
            "asperities": {
                "model": "greenwood-tripp",
                "rms": "0.05 um",
                "summit_radius": "20 um",
                "summit_density": "4e10 1/m^2",
            }
        },
    ],
    ids=["heat", "asperities"],
)
def test_the_moment_is_that_of_all_that_carries(physics):
    found = tehl.solve(crowned(tilting_moment="-0.5 N m", **physics), COARSE)
    assert found.rolling.tilting == pytest.approx(-0.5, rel=1e-3)
    assert TILT / 2 < found.rolling.tilt < TILT


def test_cycles_and_newton_converge_with_the_tilt():
    scaled = ScaledProblem.of(crowned(tilting_moment="-0.7 N m"))
    ends = Domain.model_construct(x=(-3.6, 1.6), y=(-1.0, 1.0))
    grid = Grid(nx=65, ny=33, domain=ends, mirror=False)
    hierarchy = Hierarchy.on(grid, scaled, Options(wedge_order=2), FAST)
    level, residuals = hierarchy.finest, []
    from_dry_pressure(level, hierarchy.expected_film)
    for _ in range(6):
        hierarchy.cycle(hierarchy.levels)
        level.update()
        residuals.append(level.evaluate_residual() + np.abs(level.missing()).max())
    assert (residuals[5] / residuals[0]) ** 0.2 < 0.2
    rigid = level.rigid.copy()
    level.set_state(
        level.film.p * (1.0 + 0.05 * np.cos(3.0 * grid.x)), rigid + np.array([0.0, 0.02])
    )
    newton = Newton(level, Grid(nx=17, ny=17, domain=ends, mirror=False))
    for _ in range(6):
        newton.step()
    assert level.evaluate_residual() + np.abs(level.missing()).max() < 1e-7
    assert level.rigid == pytest.approx(rigid, abs=1e-6)


def test_the_tilt_and_its_bar_are_shown_and_stored(tmp_path):
    found = tehl.solve(crowned(tilting_moment="-0.5 N m"), Options(points=(129, 65)))
    assert 0.0 < found.errors.bars["tilt"] < 0.05
    assert "tilting" not in found.errors.bars  # the moment is given
    assert found.summary()["rolling"]["tilt_rad"] == found.rolling.tilt
    assert "mrad, by the stated moment" in as_text(found)
    save(found, tmp_path / "film.nc")
    assert load(tmp_path / "film.nc").tilt == found.rolling.tilt
    coarse = tehl.solve(crowned(tilting_moment="-0.5 N m"), COARSE)
    assert coarse.rolling.tilt == pytest.approx(found.rolling.tilt, rel=0.02)


def test_explain_states_the_tilt_of_dry_slices():
    text = repr(crowned(tilting_moment="-0.5 N m").explain())
    assert (
        "mrad of dry slices; that of the film is smaller and follows from the moment -0.5" in text
    )


@pytest.mark.parametrize(("moment", "is_asked"), [(0.0, False), (4.0, False), (-9.0, True)])
def test_explain_asks_about_a_roller_that_rests_on_its_sharp_end(moment, is_asked):
    contact = {"type": "roller", "radius": "8 mm", "length": "10 mm", "load": "2 kN"}
    contact |= {"entrainment_speed": "2 m/s", "tilting_moment": moment}
    oil = {"lubricant": "mineral-oil", "surface_1": STEEL, "surface_2": STEEL}
    text = repr(tehl.ContactProblem(contact=contact, **oil).explain())
    assert ("of its length, up to its sharp end, at more than" in text) == is_asked


@pytest.mark.parametrize(
    ("stated", "message"),
    [
        ({"tilt": 1e-4, "tilting_moment": 0.1}, "states tilt and tilting_moment"),
        ({"tilting_moment": "20 N m"}, "= 20 N m: must be less than load times half the length, "),
        ({"tilting_moment": 0.0, "type": "point", "length": None}, 'only a contact with type = "r'),
        ({"tilting_moment": 0.0, "ends": "mirrored"}, "a piece that goes on is straight"),
        ({"tilting_moment": "3 N"}, "has the unit of a force"),
        ({"tilting_moment": 0.1, "transient": {"duration": "1 ms"}}, "and transient exclude each"),
    ],
)
def test_bad_input_is_named(stated, message):
    with pytest.raises(tehl.TehlError, match=message):
        crowned(**stated)


def test_a_moment_that_tilts_beyond_all_bounds_is_refused():
    flat = {"shape": "crown", "radius": "1 mm"}
    with pytest.raises(tehl.TehlError, match=r"tilts the roller by more than 0.05 rad"):
        roller(20.0, profile=flat, tilting_moment=0.9 * 0.5e-2 * roller(20.0).load)


def test_heights_of_one_side_tilt_a_roller_that_is_free():
    bump = {"type": "formula", "formula": "0.2 um * exp(-((y - 2 mm)/(1 mm))^2)"}
    rough = {"surface_2": STEEL | {"roughness": bump}}
    found = tehl.solve(crowned(tilting_moment=0.0, **rough), Options(points=(129, 65)))
    assert abs(found.rolling.tilting) < 1e-4 * 0.5 * found.load * 1e-2
    assert found.rolling.tilt > 1e-6
