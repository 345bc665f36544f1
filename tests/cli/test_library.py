"""``tehl oils`` and ``tehl solids``, libraries of the user, and names with other constants."""

import json
import re
import sys
import tomllib
from pathlib import Path

import pytest

from tehl.api.problem import read_case, read_case_and_options
from tehl.base import named
from tehl.base.errors import InputError
from tehl.contact.materials import Solid, material
from tehl.contact.problem import ContactProblem
from tehl.io.case import case_from_tables, changed
from tehl.lubricant import oil
from tests.cases import ball_tables
from tests.cli.test_main import run

OWN = """
[sources]
test = "Viscometer of the house"

[my-oil]
aliases = ["squalane"]
family = "test"
viscosity = { law = "barus", eta_0 = "0.1 Pa s", alpha = "20 1/GPa" }
density = { law = "constant", rho_0 = "900 kg/m^3" }
evidence = { "eta_0 alpha" = "measured, 1 %, test" }
"""


@pytest.fixture(autouse=True)
def home(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def problem(lubricant, folder=None):
    return case_from_tables(ball_tables() | {"lubricant": lubricant}, folder)[0]


def test_the_lists_filter_and_one_entry_is_shown_in_full(monkeypatch, capsys):
    assert run(monkeypatch, "oils", "traction", "--json") == 0
    found = json.loads(capsys.readouterr().out)
    assert [one["name"] for one in found] == ["santotrac-30", "santotrac-50"]
    assert found[0]["evidence"]["alpha"]["range"] == "15 %"
    assert run(monkeypatch, "oils", "polyglycol") == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 8  # with the heading
    assert run(monkeypatch, "solids", "peek") == 0
    text = capsys.readouterr().out
    assert "3.65 GPa" in text
    assert "3.6 to 4.0 GPa" in text
    assert "GEARpie" in text
    assert run(monkeypatch, "oils", "gear", "--json") == 0  # the source of others is GEARpie
    assert all("gear" in one["name"] for one in json.loads(capsys.readouterr().out))
    assert run(monkeypatch, "oils", "gearpie", "--json") == 0
    assert len(json.loads(capsys.readouterr().out)) > 5
    assert run(monkeypatch, "oils", "olive") == 2
    assert "tehl oils lists 60" in capsys.readouterr().err
    assert run(monkeypatch, "solids", "--table") == 2


@pytest.mark.parametrize("name", ["squalane", "pao-40", "fva-3"])
def test_a_printed_table_is_the_oil(monkeypatch, capsys, name):
    run(monkeypatch, "oils", name, "--table")
    table = tomllib.loads(capsys.readouterr().out)["lubricant"]
    assert problem(table).lubricant == oil(name)
    run(monkeypatch, "solids", "440C", "--table")
    table = tomllib.loads(capsys.readouterr().out)["surface_1"]["material"]
    assert Solid.model_validate(table) == material("440c")


def test_keys_beside_a_name_replace_single_constants():
    plain, own = oil("fva-3"), {"oil": "fva-3", "viscosity": {"alpha": "25 1/GPa"}}
    found = problem(own | {"temperature": "60 degC", "shear": {"law": "newtonian"}}).lubricant
    assert found.viscosity == plain.viscosity.model_copy(update={"alpha": 25e-9})
    assert found.density == plain.density
    assert found.shear.law == "newtonian"
    assert found.name == "fva-3"
    assert found.source.startswith(plain.source)
    assert found.source.endswith("; stated in the case: viscosity.alpha")
    # the other of two keys that exclude each other, and another law
    assert problem({"oil": "fva-3", "viscosity": {"z": 0.6}}).lubricant.viscosity.z == 0.6
    other = {"law": "barus", "eta_0": 0.1, "alpha": 2e-8}
    assert problem({"oil": "fva-3", "viscosity": other}).lubricant.viscosity.law == "barus"
    tables = ball_tables()
    tables["surface_1"] |= {"material": {"solid": "steel", "hardness": "8 GPa"}}
    solid = case_from_tables(tables)[0].surface_1.material
    assert solid == material("steel").model_copy(update={"hardness": 8e9, "source": solid.source})
    again = ContactProblem.model_validate_json(case_from_tables(tables)[0].model_dump_json())
    assert again.surface_1.material == solid


def test_an_override_goes_through_a_name(monkeypatch, capsys):
    text = Path("case.toml")
    tables = ball_tables() | {"lubricant": "iso-vg-68"}
    after = changed(tables, "lubricant.viscosity.alpha", "20 1/GPa")
    assert after["lubricant"] == {"oil": "iso-vg-68", "viscosity": {"alpha": "20 1/GPa"}}
    text.write_text(
        'lubricant = "iso-vg-68"\n[contact]\nradius = 0.01\nload = 50\nentrainment_speed = 1\n'
        '[surface_1]\nmaterial = "steel"\n[surface_2]\nmaterial = "glass"\n'
    )
    assert read_case(text).pressure_coefficient == pytest.approx(23.1e-9)
    found, _ = read_case_and_options(text, ["lubricant.viscosity.alpha=20 1/GPa"])
    assert found.pressure_coefficient == pytest.approx(20e-9)
    hot = ("explain", str(text), "--set", "lubricant.temperature=160 degC")
    assert run(monkeypatch, *hot) == 0
    assert "constants of iso-vg-68 are known from 293.1 to 423.1 K" in capsys.readouterr().out
    assert run(monkeypatch, *hot, "--set", "lubricant.limits={pressure='0.5 GPa'}") == 0
    assert "constants of iso-vg-68 are known up to 0.5 GPa" in capsys.readouterr().out


def test_a_library_of_the_user_adds_to_that_of_the_package(home, monkeypatch, capsys):
    with pytest.raises(InputError, match="my-oil"):
        problem("my-oil", home)
    (home / "oils.toml").write_text(OWN, encoding="utf-8")
    found = problem("My Oil", home).lubricant
    assert found.viscosity.eta_0 == 0.1
    assert found.source == "eta_0, alpha (measured, 1 %): Viscometer of the house"
    assert problem("squalane", home).lubricant.name == "my-oil"
    assert problem("squalane").lubricant.name == "squalane"  # not beside this case
    run(monkeypatch, "oils", "my-oil")
    assert "Viscometer of the house" in capsys.readouterr().out
    named.config_folder().mkdir(parents=True)
    (named.config_folder() / "solids.toml").write_text(
        "[putty]\nyoung_modulus = 1e9\npoisson_ratio = 0.4\n", encoding="utf-8"
    )
    assert material("putty").young_modulus == 1e9


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("[a\n", "is not a TOML file"),
        ("a = 1\n", r"a is not a table, write \[a\]"),
        (OWN.replace("20 1/GPa", "20 furlongs").replace("squalane", "iso-vg-68"), "furlongs"),
    ],
)
def test_a_broken_library_is_named(home, monkeypatch, capsys, text, fault):
    (home / "oils.toml").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=rf"lubricant = .*oils\.toml.*{fault}"):
        problem("iso-vg-68", home)
    monkeypatch.chdir(home)
    run(monkeypatch, "oils")
    assert re.search(rf"the library cannot be .*oils\.toml.*{fault}", capsys.readouterr().err)


@pytest.mark.parametrize(
    ("platform", "variable", "place"),
    [("win32", "APPDATA", "tehl"), ("darwin", "HOME", "Library/Application Support/tehl")],
)
def test_the_folder_is_that_of_the_platform(monkeypatch, home, platform, variable, place):
    monkeypatch.setattr(sys, "platform", platform)
    monkeypatch.setenv(variable, str(home))
    assert named.config_folder() == home / place
