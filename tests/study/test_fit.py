"""The oil from a test: rigs, least squares through the solver, intervals, what stays open."""

import json
import math
import tomllib
from dataclasses import dataclass

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

import tehl
from tehl import plots
from tehl.base.errors import InputError
from tehl.cli import application
from tehl.studies.fitting.constants import Constant
from tehl.studies.fitting.estimate import estimate
from tehl.studies.fitting.measured import base_tables, points_of
from tests.study.rigs import ehd, mtm

CASE = """
[contact]
load = "20 N"
entrainment_speed = "1 m/s"
[surface_1]
material = "steel"
radius = "inf"
[surface_2]
material = "steel"
radius = "9.525 mm"
[lubricant]
viscosity = { law = "walther", nu_40 = "46 mm^2/s", nu_100 = "7 mm^2/s", alpha = "18 1/GPa" }
density = { law = "dowson-higginson", rho_0 = "850 kg/m^3", beta = "6.5e-4 1/K" }
conductivity = "0.14 W/m/K"
heat_capacity = "2000 J/kg/K"
[numerics]
points = 65
extrapolate = true
"""
TRUE_ALPHA, TRUE_EYRING = 22e-9, 6e6
SPEEDS, SLIDES = (0.3, 0.6, 1.1, 2.0, 3.2), (0.01, 0.04, 0.1, 0.25, 0.5)
HEATED = CASE + "[thermal]\n"


@pytest.fixture
def case(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(CASE)
    return path


def truth(text, tmp_path, alpha=TRUE_ALPHA, shear="newtonian", **contact):
    """Return the film [nm] and friction that the solver gives for the true oil."""
    path = tmp_path / "true.toml"
    path.write_text(text)
    law = f'{{ law = "{shear}" }}' if shear == "newtonian" else shear
    overrides = [f"lubricant.viscosity.alpha={alpha}", f"lubricant.shear={law}"]
    overrides += [f"{key.replace('__', '.')}={value}" for key, value in contact.items()]
    result = tehl.solve(*tehl.read_case_and_options(path, overrides))
    return 1e9 * result.film.central, abs(result.traction.mid_film)


def test_a_file_of_an_ehd2_is_read_and_alpha_is_that_of_its_oil(tmp_path, case):
    rng, rows = np.random.default_rng(3), []
    for u in SPEEDS:
        degrees = 40.0 + 10.0 * (u > 1)
        film, _ = truth(
            CASE,
            tmp_path,
            contact__entrainment_speed=u,
            contact__load=19.931,
            lubricant__temperature=f"{degrees} degC",
        )
        rows.append((1e3 * u, film * (1 + 0.02 * rng.standard_normal()), degrees))
    data, oil = tmp_path / "film.txt", tmp_path / "oil.toml"
    data.write_text(ehd(rows), encoding="utf-8", newline="")
    words = ["fit", data, "--case", case, "-o", oil, "--json", "--quiet", "--jobs", "1"]
    done = CliRunner().invoke(application(), [*map(str, words), "--plot", str(tmp_path / "out")])
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)
    alpha = found["constants"]["alpha"]
    assert alpha["low"] < TRUE_ALPHA < alpha["high"]
    assert alpha["high"] / alpha["low"] < 1.2  # 2 % of film are 4 % of alpha, t of 4 is 2.8
    assert found["noise"]["film"] < 0.05
    assert [row["u_m [m/s]"] for row in found["points"]] == pytest.approx(SPEEDS)
    assert [row["T [°C]"] for row in found["points"]] == [40, 40, 50, 50, 50]
    picture = plots.oil_fit(pd.DataFrame(found["points"]))
    curves = [text.get_text() for text in picture.axes[0].get_legend().get_texts()]
    assert curves == ["T 40", "T 50"]
    table = tomllib.loads(oil.read_text(encoding="utf-8"))["lubricant"]
    fitted = tehl.Lubricant.model_validate(table)
    assert fitted.viscosity.alpha == pytest.approx(alpha["value"], rel=1e-3)
    assert table["viscosity"]["nu_40"] == "46 mm^2/s"  # as it was stated
    assert (tmp_path / "out" / "fit.png").stat().st_size > 10_000


def test_an_mtm_file_has_its_speeds_slides_and_temperatures(tmp_path, case):
    path = tmp_path / "traction.txt"
    path.write_text(mtm([(2000, 5.0, 0.03), (2000, 20.0, 0.04)]), encoding="cp1252")
    base, folder = base_tables(case)
    points = points_of(path, base, folder, noise={"traction": "2 %"}, probe=None)
    problem = points[1].problem(base["lubricant"])
    assert problem.entrainment_speed == 2.0
    assert problem.slide_roll_ratio == pytest.approx(0.2)
    assert problem.load == 20.02
    assert problem.inlet_temperature == pytest.approx(313.35)
    assert points[1].measured == {"traction": (0.04, pytest.approx(0.0008))}
    path.write_text(mtm([(2000, 5.0, 0.03)], pot=80.0, lube=22.0))
    warm = points_of(path, base, folder, noise={}, probe="pot")[0]
    assert warm.problem(base["lubricant"]).inlet_temperature == pytest.approx(353.15)


def heated_set(seed, curve):
    """Return films and tractions of the true oil with noise of 3 % and 0.0007."""
    rng = np.random.default_rng(seed)
    rows = []
    for u, slide, film, traction in curve:
        row = {"u_m [m/s]": u, "SRR": slide, "film [nm]": None, "traction": None}
        if slide:
            row["traction"] = traction + 0.0007 * rng.standard_normal()
        else:
            row["film [nm]"] = film * (1 + 0.03 * rng.standard_normal())
        rows.append(row)
    return pd.DataFrame(rows)


@pytest.fixture
def curve(tmp_path):
    """Return speed, slide, film and traction of a heated test of the true oil."""
    law = f'{{ law = "eyring", stress = {TRUE_EYRING} }}'
    conditions = [(u, 0.0) for u in SPEEDS] + [(2.0, slide) for slide in SLIDES]
    return [
        (
            *(u, slide),
            *truth(
                HEATED,
                tmp_path,
                shear=law,
                contact__entrainment_speed=u,
                contact__slide_roll_ratio=slide,
            ),
        )
        for u, slide in conditions
    ]


@pytest.mark.slow
def test_alpha_and_eyring_stress_are_found_with_heat(tmp_path, curve):
    path = tmp_path / "case.toml"
    path.write_text(HEATED)
    found = tehl.fit(heated_set(1, curve), path)
    assert found["alpha"].low < TRUE_ALPHA < found["alpha"].high
    assert found["eyring_stress"].low < TRUE_EYRING < found["eyring_stress"].high
    assert found["eyring_stress"].high < 1.6 * found["eyring_stress"].low
    assert found.noise["film"] == pytest.approx(0.03, rel=0.7)
    assert found.noise["traction"] == pytest.approx(0.0007, rel=0.7)
    assert found.lubricant.shear.law == "eyring"
    assert len(plots.oil_fit(found.table).axes) == 4
    assert 'stress = "' in found.toml()
    tehl.Lubricant.model_validate(tomllib.loads(found.toml())["lubricant"])


@pytest.mark.slow
def test_intervals_of_twenty_tests_hold_the_true_constants(tmp_path, curve):
    path = tmp_path / "case.toml"
    path.write_text(HEATED)
    inside = [0, 0]
    for seed in range(20):
        found = tehl.fit(heated_set(seed, curve), path)
        for k, (name, true) in enumerate((("alpha", TRUE_ALPHA), ("eyring_stress", TRUE_EYRING))):
            inside[k] += found[name].low < true < found[name].high
    assert min(inside) >= 18, inside


# ---- statistics, without the solver


@dataclass
class Formula:
    """Stands for the solver: films by a power law, tractions by a logarithm of the slide."""

    x_true: np.ndarray
    solves = 0

    def __post_init__(self):
        self.constants = [Constant(name, name, "", 1.0, 1.0, 1e-3, 1e3) for name in ("a", "b")]
        self.u, self.s = np.geomspace(0.2, 3, 7), np.geomspace(0.02, 0.5, 7)
        self.places = [(k, "film") for k in range(7)] + [(k + 7, "traction") for k in range(7)]

    def values(self, x):
        film = 1e-7 * self.u**0.67 * math.exp(0.6 * x[0])
        traction = 0.01 * math.exp(x[1]) * np.arcsinh(100 * self.s * math.exp(2 * x[0] - x[1]))
        return np.concatenate([film, traction])

    def jacobian(self, x):
        return np.column_stack(
            [(self.values(x + d) - self.values(x - d)) / 2e-4 for d in 1e-4 * np.eye(2)]
        )

    def answers(self, *places):
        return [[None] * len(self.places) for _ in places]

    def shown(self, x):
        return str(x)

    def check(self, x):
        assert np.isfinite(x).all()

    def report(self, text):
        assert text


@pytest.mark.parametrize("is_stated", [False, True])
def test_intervals_hold_in_95_of_100_tests(is_stated):
    model = Formula(np.array([0.2, -0.1]))
    true = model.values(model.x_true)
    noise = np.concatenate([0.05 * true[:7], np.full(7, 0.002)])
    stated = noise if is_stated else np.full(14, np.nan)
    rng, inside, total = np.random.default_rng(5), np.zeros(2), 400
    for _ in range(total):
        found = estimate(model, true + noise * rng.standard_normal(14), stated)
        inside += (found.ends[:, 0] < model.x_true) & (model.x_true < found.ends[:, 1])
    # three standard deviations of 400 draws are 3.3 %; noise by 7 points costs up to 2 %
    assert inside / total == pytest.approx(0.95, abs=0.04)


def test_a_parameter_that_nothing_depends_on_stays_open():
    model = Formula(np.zeros(2))
    true = model.values(model.x_true)
    model.places, values = model.places[:7], model.values
    model.values = lambda x: values(x)[:7]  # films only: b has no effect
    found = estimate(model, true[:7] * (1 + 0.01 * np.cos(9.0 * np.arange(7))), np.full(7, np.nan))
    assert np.isfinite(found.ends[0]).all()
    assert not np.isfinite(found.ends[1]).any()


# ---- what the data do not determine


def films(tmp_path, speeds=SPEEDS):
    rows = []
    for k, u in enumerate(speeds):
        film, _ = truth(CASE, tmp_path, contact__entrainment_speed=u)
        rows.append({"u_m [m/s]": u, "film [nm]": film * (1 + 0.02 * math.cos(2.0 * k))})
    return pd.DataFrame(rows)


@pytest.mark.slow
def test_alpha_and_viscosity_by_speeds_alone_are_one_combination(tmp_path, case):
    found = tehl.fit(films(tmp_path, SPEEDS[1:]), case, ["alpha", "lubricant.viscosity.nu_40"])
    assert abs(found.correlation[0, 1]) > 0.99
    assert any("a combination of both only" in text for text in found.remarks)


def test_a_limiting_stress_that_is_not_reached_stays_open(tmp_path, case):
    rows = []
    for slide in (1e-5, 2e-5, 4e-5, 7e-5):
        law = '{ law = "limiting", slope = 0.08 }'
        slides = {"contact__slide_roll_ratio": slide}
        _, traction = truth(CASE, tmp_path, 18e-9, law, **slides)
        rows.append({"SRR": slide, "traction": traction * (1 + 0.03 * math.cos(2e5 * slide))})
    found = tehl.fit(pd.DataFrame(rows), case, ["limiting_slope"])
    slope = found["limiting_slope"]
    assert slope.high > 4 * slope.low
    assert any("which is not reached" in text for text in found.remarks)
    assert "above" in slope.interval


# ---- mistakes


@pytest.mark.parametrize(
    ("text", "names", "message"),
    [
        ("u_m [m/s]\n1\n", "alpha", "has no measured column"),
        ("film [nm];u_m [m/s]\n80;1\n90;x\n", "alpha", "row 3: "),
        ("film [N];u_m [m/s]\n80;1\n90;2\n", "alpha", "has the unit of a force"),
        ("film [nm];nu_40 [mm^2/s]\n80;46\n90;50\n", "alpha", "the fit is for one oil"),
        ("film [nm]\n80\n", "alpha", "1 measured values for 1 constants: at least 2"),
        ("film [m]\n80\n90\n", "alpha", "more than 0.1 mm; check the unit"),
        (
            "film [nm],u_m [m/s]\n80,1\n90,1e9\n",
            "alpha",
            "row 3: contact.entrainment_speed = 1e+09",
        ),
        ("traction,u_m [m/s]\n.03,1\n.04,1e9\n", "alpha", "more than 1000 m/s; check the unit"),
        ("film [nm],u_m [m/s]\n80,1\n90,1e-6\n", "alpha", "row 3: film = 90 nm: formulas give"),
        ("film [um]\n80\n90\n", "alpha", "check units of film, speed and load"),
        ("film [nm]\n80\n90\n", "alfa", "did you mean alpha?"),
        ("film [nm]\n80\n90\n", "alpha,alpha", "name each constant once"),
        ("traction\n.03\n.04\n", "eyring_stress,limiting_slope", "an oil has one shear law"),
        ("film [nm]\n80\n90\n", "lubricant.viscosity.law", "is not a constant"),
        (mtm([(2000, 5, 0.03)], kind="BOD_TIMED"), "alpha", "its steps are BOD_TIMED"),
        (mtm([(2000, 5, 0.03)], pot=80, lube=20), "alpha", "lube or pot"),
    ],
)
def test_bad_input_is_one_sentence(tmp_path, case, text, names, message):
    data = tmp_path / "data.csv"
    data.write_text(text)
    words = ["fit", data, "--case", case, "-o", tmp_path / "oil.toml", "--fit", names, "-q"]
    found = CliRunner().invoke(application(), [*map(str, words), "--jobs", "1"])
    assert isinstance(found.exception, InputError)
    assert message in str(found.exception)
    assert "\n" not in str(found.exception)
    assert not (tmp_path / "oil.toml").exists()


def test_noise_and_cases_that_do_not_fit_are_named(case):
    frame = pd.DataFrame({"film [nm]": [80.0, 90.0]})
    with pytest.raises(InputError, match="noise of film = '3 N': has the unit of a force"):
        tehl.fit(frame, case, noise={"film": "3 N"})
    with pytest.raises(InputError, match="noise of films: is not measured; known are film, tr"):
        tehl.fit(frame, case, noise={"films": "3 %"})
    with pytest.raises(InputError, match="1 files of data and 2 cases"):
        tehl.fit(frame, [case, case])
