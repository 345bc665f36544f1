"""Films between bodies whose temperatures follow from the heat of the contact."""

import json
import tomllib

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

import tehl
from tehl.api.problem import case_from_tables
from tehl.api.results import load
from tehl.api.solvers import certify, solve
from tehl.cli import application
from tehl.cli.text import as_text
from tehl.contact.options import Options
from tehl.io.templates import template_text
from tehl.post.bodies import bodies
from tehl.report.explain import explain
from tehl.report.page import report_text
from tehl.solver import steady
from tehl.solver.monitor import Silent

COARSE = Options(error=0.05)


def tables(first=None, second=None, **changes):
    """Return the tables of the template ``thermal`` with thermal resistances [K/W]."""
    case = tomllib.loads(template_text("thermal")) | changes
    for name, one in (("surface_1", first), ("surface_2", second)):
        case[name] = case[name] | ({} if one is None else {"thermal_resistance": one})
    del case["numerics"]
    return case


def warmed(first=None, second=None, **changes):
    return case_from_tables(tables(first, second, **changes))[0]


class Messages(Silent):
    """Keeps the messages."""

    def __init__(self):
        self.texts = []

    def message(self, text):
        self.texts.append(text)

    def cycle(self, report):
        pass


@pytest.fixture(scope="module")
def balanced():
    """Return a film between two bodies, on the grid that an error takes."""
    return solve(warmed(5.0, 20.0), COARSE)


def test_each_body_passes_on_the_heat_that_enters(balanced):
    heat, warm = balanced.heat.balance, balanced.bodies
    for temperature, entering, resistance in (
        (warm[0], heat.surface_1, 5.0),
        (warm[1], heat.surface_2, 20.0),
    ):
        assert (temperature - 313.15) / resistance == pytest.approx(entering, rel=1e-6)
    assert bodies(balanced).balance < 1e-6
    # it is the film between bodies of these temperatures
    stated = solve(warmed().with_bodies(*warm), COARSE)
    assert np.array_equal(stated.pressure, balanced.pressure)
    assert stated.bodies is None
    # formulas expect them; the theory of the rises is within a factor of two
    assert explain(balanced.problem).scaled.problem.heat.bulk_2 - 313.15 == pytest.approx(
        warm[1] - 313.15, rel=0.3
    )


def test_bodies_without_resistance_leave_every_bit_of_the_film():
    plain, cooled = (solve(warmed(one, one), Options(points=97)) for one in (None, 0.0))
    assert cooled.bodies == (313.15, 313.15)
    for name in ("pressure", "film_thickness"):
        assert np.array_equal(getattr(plain, name), getattr(cooled, name))
    assert np.array_equal(plain.heat.temperature, cooled.heat.temperature)
    assert plain.summary()["bodies"]["balance"] is None


def test_the_heat_of_asperities_enters_both_bodies():
    case = tables(60.0, 60.0)
    case["contact"] |= {"entrainment_speed": "0.8 m/s"}
    case["asperities"] = {
        "model": "greenwood-tripp",
        "rms": "0.25 um",
        "summit_radius": "10 um",
        "summit_density": "2e10 1/m^2",
    }
    found = solve(case_from_tables(case)[0], Options(points=97))
    shared, heat, known = found.load_sharing, found.heat.balance, bodies(found)
    assert shared.power_boundary > 0.2 * heat.shear
    rubbed = known.heat_1 - heat.surface_1, known.heat_2 - heat.surface_2
    assert sum(rubbed) == pytest.approx(shared.power_boundary, rel=1e-9)
    # steel on steel: by the roots of the Peclet numbers alone
    parts = [1.0 + peclet**0.5 for peclet in found.problem.solid_peclet]
    assert rubbed[0] / rubbed[1] == pytest.approx(parts[0] / parts[1], rel=1e-9)
    assert known.temperature_1 - 313.15 == pytest.approx(60.0 * known.heat_1, rel=1e-6)


@pytest.mark.usefixtures("no_pictures")
def test_the_temperatures_are_stored_printed_and_reported(balanced, tmp_path, monkeypatch):
    monkeypatch.setattr("tehl.report.page.CAPTIONS", {})  # without pictures
    balanced.save(tmp_path / "film.nc")
    again = load(tmp_path / "film.nc")
    assert again.bodies == balanced.bodies
    block = again.summary()["bodies"]
    assert block["temperature_2_k"] == balanced.bodies[1]
    assert block["resistance_1"] == 5.0
    line = next(line for line in as_text(again).splitlines() if line.startswith("  bodies"))
    assert f"{balanced.bodies[1] - 273.15:.4g} degC far from the contact, computed" in line
    assert "by 20 K/W" in report_text(again)
    assert "body 1: 5 K/W   body 2: 20 K/W" in repr(explain(again.problem))


@pytest.mark.slow
def test_certified_films_balance_on_each_grid():
    monitor = Messages()
    found = certify(warmed(5.0), Options(points=129), monitor=monitor)
    assert found.uncertainty["film_central"].uncertainty > 0.0
    assert bodies(found).balance < 1e-6
    assert sum(text.startswith("bodies at 40 and 40 degC") for text in monitor.texts) >= 3


def test_a_list_has_the_temperatures_as_columns(tmp_path):
    frame = pd.DataFrame({"p_h [GPa]": [0.8], "R_th 1 [K/W]": [5.0], "numerics.points": [129]})
    template = tmp_path / "case.toml"
    text = template_text("thermal").replace("# temperature", "temperature")  # of body 1
    template.write_text(text)
    row = tehl.solve_contacts(frame, template=template).iloc[0]
    assert row["status"] == "converged", row["obtained"]
    found = solve(warmed(5.0), Options(points=129))
    assert row["temperature of body 1 [°C]"] == pytest.approx(found.bodies[0] - 273.15, rel=1e-9)
    assert row["heat into body 1 [W]"] == pytest.approx(bodies(found).heat_1, rel=1e-9)
    assert row["± temperature of body 1 [°C]"] > 0.0


def test_a_contact_that_runs_away_exits_with_1_and_its_cause(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "case.toml").write_text(template_text("thermal"))
    words = ["solve", "case.toml", "--json", "--quiet", "--set", "numerics.points=65"]
    for side in (1, 2):
        words += ["--set", f"surface_{side}.thermal_resistance='10000 K/W'"]
    found = CliRunner().invoke(application(), words)
    assert found.exit_code == 1
    said = json.loads(found.stdout)
    assert said["cause"] == "thermal_runaway"
    assert "10000 K/W" in said["message"].replace("1e+04", "10000")
    assert said["hint"].startswith("Lower the thermal resistance")
    assert load(tmp_path / "case.nc").bodies[0] > 313.15


def test_the_response_is_that_of_the_film_between_the_balanced_bodies_alone(monkeypatch):
    known, calls = steady.with_dynamics, []

    def counted(result, run):
        calls.append(result.problem.surface_1.temperature)
        return known(result, run)

    monkeypatch.setattr(steady, "with_dynamics", counted)
    dynamics = {"frequencies": ["1 kHz"]}
    found = solve(warmed(5.0, dynamics=dynamics), Options(points=65))
    assert calls == [found.bodies[0]]
    assert found.dynamics.stiffness.min() > 0.0
