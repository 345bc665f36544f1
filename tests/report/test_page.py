"""The report of either kind of result: one file, everything in it, all text escaped."""

import re
import shutil
import subprocess
from dataclasses import fields, replace
from html.parser import HTMLParser

import numpy as np
import pytest

from tehl.api.problem import ContactProblem
from tehl.cli import text
from tehl.contact.materials import material
from tehl.contact.transient import Transient
from tehl.estimate.inlet_heating import InletFactor
from tehl.plots import pictures_of
from tehl.post.micro_film import roughness_effect
from tehl.post.thermal_effect import ThermalEffect
from tehl.post.transient import largest_change
from tehl.post.waves import passing_wave
from tehl.report import page as module
from tehl.report.page import report_text
from tehl.report.readable import input_rows
from tehl.report.rendering import FILTERS, UNITS
from tehl.result.bars import Estimate
from tehl.result.fields import FilmDynamics
from tehl.result.quantities import QUANTITIES
from tehl.result.solution import Hint, Status
from tests.fixtures_result import CASE
from tests.fixtures_rough import make_rough
from tests.fixtures_transient import make_certified, make_transient, passing
from tests.post.test_transient import wave_case

VOID = {"meta", "img", "br"}


class Page(HTMLParser):
    """Tags, links and text of a page; fails if tags are not closed in order."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open, self.tags, self.sources, self.words, self.headings = [], [], [], [], []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.sources += [value for name, value in attrs if name in ("src", "href")]
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.words.append(data)
        if self.open and self.open[-1] == "h2":
            self.headings.append(data)


SHARED = (
    "Result", "Pictures", "Formulas against computed", "Inputs", "Dimensionless groups", "Errors",
    "Convergence", "Conventions", "Provenance",
)  # fmt: skip


@pytest.fixture(scope="module")
def texts(certified):
    """Return the report of each kind with all its pictures, which take seconds."""
    runs = {"steady": certified, "transient": make_transient()}
    return {kind: report_text(run, dpi=40) for kind, run in runs.items()}


@pytest.fixture(scope="module")
def page(texts):
    return Page(texts["steady"])


def test_pictures_are_embedded_and_all_links_are_local(page):
    assert len(page.sources) == 5
    assert all(source.startswith("data:image/png;base64,") for source in page.sources)


def test_each_part_is_there(page):
    words = " ".join(page.words)
    for part in ("Inputs", "groups", "Formulas", "Errors", "Convergence", "Provenance"):
        assert part in words
    for fact in ("Hamrock-Dowson", "contact.load", "80", "certified", "2/E' =", "2.01"):
        assert fact in words


def test_each_quantity_of_the_first_table_has_a_unit():
    units = {one.unit for one in QUANTITIES if "report" in one.words}
    assert "N mm" in units
    assert {FILTERS[unit] for unit in units} <= UNITS.keys()


@pytest.mark.usefixtures("no_pictures")
def test_a_thermal_run_has_sections_of_heat_and_traction(thermal, result):
    words = " ".join(Page(report_text(thermal, dpi=40)).words)
    found = thermal.temperature
    assert f"{found.film_rise_max:.4g} K" in words
    assert f"{found.inlet + found.surface_1_rise_max - 273.15:.4g} °C" in words
    assert "line moving source, solid Péclet number 28.4" in words
    assert f"{thermal.traction.surface_2:.5g}" in words
    assert f"{thermal.heat.balance.shear:.4g} W" in words
    assert "ΔT [K]" in words
    cold = " ".join(Page(report_text(result, dpi=40)).words)
    assert not any(word in cold for word in ("Traction", "Temperature", "ΔT"))


@pytest.mark.usefixtures("no_pictures")
@pytest.mark.parametrize(("missing", "warns"), [(0.02, False), (0.3, True), (-0.3, True)])
def test_heat_that_differs_from_friction_is_not_trusted(thermal, monkeypatch, missing, warns):
    for at in (module, text):
        monkeypatch.setattr(at, "work_error", lambda _: missing)
    found = " ".join(Page(report_text(thermal, dpi=40)).words), text.as_text(thermal)
    assert {"heat and friction differ" in one for one in found} == {warns}


@pytest.mark.usefixtures("unrendered")
def test_pictures_of_heat_are_embedded(thermal):
    page = Page(report_text(thermal, dpi=30))
    assert len(page.sources) == 10
    assert any("plane y = 0" in word for word in page.words)


def test_dynamics_have_a_table_and_a_picture(result, monkeypatch):
    caption = module.CAPTIONS["dynamics"]
    monkeypatch.setattr(module, "CAPTIONS", {"dynamics": caption})
    names = [one.name for one in fields(FilmDynamics)]
    film = FilmDynamics(**{name: np.array([4e7, 4.125e7]) for name in names})
    film = replace(film, frequency=np.array([0.0, 2.5e4]))
    page = Page(report_text(replace(result, dynamics=film), dpi=30))
    assert "Stiffness and damping" in page.headings
    words = " ".join(page.words)
    assert all(word in words for word in ("25000", "41.25 N/µm", caption))
    assert len(page.sources) == 1


@pytest.mark.usefixtures("no_pictures")
def test_traction_alone_has_its_section(sheared):
    words = " ".join(Page(report_text(sheared, dpi=40)).words)
    assert "the film brakes it" in words
    assert "moving source" not in words
    assert "more than oils can transmit" not in words
    shear = replace(sheared.shear, mid_film=5 * sheared.shear.mid_film)
    doubted = " ".join(Page(report_text(replace(sheared, shear=shear), dpi=40)).words)
    assert "more than oils can transmit. The shear law is newtonian." in doubted


@pytest.mark.parametrize("kind", ["steady", "transient"])
def test_each_kind_has_each_section_and_needs_no_network(texts, kind):
    text = texts[kind]
    page = Page(text)
    assert set(SHARED) <= set(page.headings)
    assert page.sources
    assert all(source.startswith("data:image/png;base64,") for source in page.sources)
    assert not any(word in text for word in ("http:", "https:", "@import", "url("))


@pytest.mark.usefixtures("no_pictures")
@pytest.mark.parametrize("kind", ["steady", "transient"])
def test_a_hostile_title_is_escaped(result, kind):
    title = '<script>alert("x")</script> & co'
    problem = result.problem.model_copy(update={"title": title})
    run: object = replace(result, problem=problem)
    if kind == "transient":
        run = make_transient()
        problem = run.start.problem.model_copy(update={"title": title})
        run = replace(run, start=replace(run.start, problem=problem))
    page = Page(report_text(run, dpi=40))
    assert "script" not in page.tags
    assert title in " ".join(page.words)


def test_a_transient_run_shows_its_pictures_and_extremes(texts):
    run = make_transient()
    page = Page(texts["transient"])
    words = " ".join(page.words)
    assert len(page.sources) == 4
    assert f"{run.history.film_minimum.min() * 1e9:.4g} nm" in words
    assert f"{run.history.traction.min():.4g}" in words
    assert "Not certified" not in words
    assert "The run is not certified" in words


@pytest.mark.usefixtures("no_pictures")
def test_a_dent_is_followed_through_the_contact():
    run = make_transient()
    page = Page(report_text(run))
    words = " ".join(page.words)
    speed = run.start.problem.motion.speed_1
    assert "Effect of the roughness" in page.headings
    assert "bump of surface 1" in words
    assert f"{2e-4 / speed * 1e6:.4g} µs" in words
    assert f"{largest_change(run, 'film', 1).value * 1e9:.4g} nm" in words


@pytest.mark.usefixtures("no_pictures")
def test_a_wave_shows_its_amplitude_reduction():
    run = passing(wave_case(phase=0.0), points=65, flattened=0.3)
    found = passing_wave(run, 1)
    words = " ".join(Page(report_text(run)).words)
    assert f"({100 * found.film_ratio:.3g} %)" in words
    assert f"{100 * found.published_ratio:.3g} %" in words
    few = " ".join(Page(report_text(passing(wave_case(wavelength=1e-4)))).words)
    assert "Not evaluated: a period of the wave of surface_1 has" in few


@pytest.mark.usefixtures("no_pictures")
def test_error_bars_of_a_transient_run_are_in_si():
    run = make_certified()
    words = " ".join(Page(report_text(run)).words)
    one = run.uncertainty["pressure_max"]
    assert f"{one.value * 1e-9:.5g} ± {one.uncertainty * 1e-9:.2g} GPa" in words
    assert "± 1.4e-10" not in words


@pytest.mark.usefixtures("no_pictures")
def test_a_transient_run_that_stopped_shows_cause_and_hint():
    status = Status(
        kind="stalled", cause="step_not_settled", message="A step failed.", hint=Hint("Halve it.")
    )
    words = " ".join(Page(report_text(replace(make_transient(), status=status))).words)
    assert all(
        text in words for text in ("Stalled: step not settled", "A step failed.", "Halve it")
    )


@pytest.mark.usefixtures("no_pictures")
def test_a_failure_is_shown_with_its_hint(stalled):
    words = " ".join(Page(report_text(replace(stalled, errors=None), dpi=40)).words)
    assert "Stalled: grid too coarse" in words
    assert "take points = 513" in words
    assert "No error could be estimated" in words


@pytest.mark.usefixtures("no_pictures")
def test_the_error_of_the_largest_pressure_is_shown(result):
    errors = replace(result.errors, bars={"pressure_max": 0.099})
    words = " ".join(Page(report_text(replace(result, errors=errors), dpi=40)).words)
    assert "about 9.9 %" in words


def test_inputs_carry_their_units(result):
    rows = dict(input_rows(result.problem))
    assert rows["contact.load"] == "80 N"
    assert rows["lubricant.viscosity.eta_0"] == "0.04 Pa s"
    assert rows["contact.slide_roll_ratio"] == "0.25"
    assert "contact.moes_load" not in rows
    assert rows["lubricant.viscosity.alpha"] == "22 1/GPa"
    assert rows["surface_1.material.young_modulus"] == "206 GPa"
    transient = result.problem.model_copy(update={"transient": Transient(duration=2e-3)})
    assert dict(input_rows(transient))["transient.frames"] == "25"


def _with(result, **surface):
    """Return a result with a table of surface 1 that states more."""
    case = {**CASE, "surface_1": CASE["surface_1"] | surface}
    return replace(result, problem=ContactProblem.model_validate(case))


@pytest.mark.usefixtures("no_pictures")
@pytest.mark.parametrize(
    ("rms", "regime"), [(3e-8, "Full film"), (1e-7, "Mixed"), (1e-6, "Boundary lubrication")]
)
def test_the_lubrication_regime_stands_above_the_result(result, rms, regime):
    words = " ".join(Page(report_text(_with(result, rms_roughness=rms))).words)
    assert 0 < words.index(f"{regime}") < words.index("largest pressure")
    assert "valleys" not in words  # the surfaces were computed as smooth
    bare = " ".join(Page(report_text(result)).words)
    assert "No roughness is stated" in bare
    assert regime not in bare


@pytest.mark.usefixtures("no_pictures")
def test_a_certified_traction_stands_with_its_bar_in_the_first_table(sheared):
    bar = Estimate(
        value=-0.0412,
        uncertainty=0.0013,
        discretisation=0.0013,
        domain=0.0,
        observed_order=None,
        values=(-0.04, -0.041),
    )
    run = replace(sheared, uncertainty={"traction_mid_film": bar})
    words = " ".join(Page(report_text(run)).words)
    assert words.index("-0.0412 ± 0.0013") < words.index("Pictures")


def test_opaque_pairs_have_no_interferograms(result):
    assert not any("interferogram" in name for name in pictures_of(result))
    assert "interferogram_white" in pictures_of(_with(result, material="glass"))


@pytest.mark.skipif(shutil.which("chromium") is None, reason="needs chromium")
@pytest.mark.slow
def test_the_fullest_report_prints_on_six_pages(thermal, tmp_path):
    rough = make_rough(thermal.scaled.x.size)
    glass = replace(thermal, heights=rough.heights, problem=rough.problem)
    solids = glass.problem.surface_1.model_copy(update={"material": material("glass")})
    glass = replace(glass, problem=glass.problem.model_copy(update={"surface_1": solids}))
    glass = replace(glass, history=12 * glass.history)
    page, printed = tmp_path / "report.html", tmp_path / "report.pdf"
    page.write_text(report_text(glass, dpi=30), encoding="utf-8")
    chromium = ("chromium", "--headless", "--no-sandbox", "--disable-gpu")
    target = (f"--user-data-dir={tmp_path / 'home'}", f"--print-to-pdf={printed}", page.as_uri())
    subprocess.run((*chromium, *target), check=True, capture_output=True)
    assert 1 < len(re.findall(rb"/Type ?/Page\b", printed.read_bytes())) <= 6


@pytest.mark.usefixtures("no_pictures")
def test_a_certified_value_stands_first_with_its_bar(certified):
    words = " ".join(Page(report_text(certified, dpi=40)).words)
    assert words.index("±") < words.index("Formulas against computed")


@pytest.mark.usefixtures("no_pictures")
def test_a_negative_film_is_not_reported_as_a_result(stalled):
    numbers = replace(stalled.film_scaled, central=0.1, minimum=-0.1)
    text = report_text(replace(stalled, film_scaled=numbers), dpi=40)
    assert "There is no film to report" in text
    assert "this solve" not in text


def test_the_film_without_heat_stands_beside_the_one_with_it(thermal, monkeypatch):
    monkeypatch.setattr("tehl.report.page.CAPTIONS", {})
    factor = InletFactor(formula="Gupta", source="Trib. Trans.", factor=0.9375, remarks=("odd",))
    effect = ThermalEffect(
        central=0.9875,
        minimum=0.9625,
        isothermal_h_central_m=1.234e-6,
        isothermal_h_min_m=0.5e-6,
        inlet_factors=(factor,),
    )
    text = report_text(thermal, effect=effect)
    assert "Film with heat and without" in text
    assert all(number in text for number in ("0.9875", "0.9625", "1234 nm", "0.9375", "odd"))
    assert "Film with heat and without" not in report_text(thermal)


@pytest.mark.usefixtures("unrendered")
def test_a_rough_film_has_a_section_with_its_waves_and_pictures(rough, smooth, monkeypatch):
    effect = roughness_effect(rough, smooth)
    page = Page(report_text(rough, dpi=30, roughness=effect, smooth=smooth))
    words = " ".join(page.words)
    found = rough.roughness
    assert (
        f"λ = {found.lambda_central:.3g} by the central film, {found.lambda_minimum:.3g}" in words
    )
    assert "valleys along x" in words
    assert "left in the film" in words
    assert "(20 %)" in words
    assert "Film with roughness and without" in words
    assert "Ripples of film and pressure." in words
    monkeypatch.setattr(module, "CAPTIONS", {})
    assert "Roughness" not in " ".join(Page(report_text(smooth)).words)


@pytest.mark.usefixtures("no_pictures")
def test_formulas_are_compared_only_with_a_film_of_the_stated_contact():
    shown = {}
    for first in (1.0, 0.5):
        transient = {"duration": 1e-4, "load": [[0.0, first], [1e-4, 1.0]]}
        page = Page(report_text(passing(CASE | {"transient": transient})))
        shown[first] = " ".join(page.words)
    assert "this solve, at the start" in shown[1.0]
    assert "this solve" not in shown[0.5]
    assert "radius of [contact]: the run begins with others" in shown[0.5]


@pytest.mark.usefixtures("no_pictures")
def test_the_verdict_of_a_run_has_its_least_lambda():
    run = passing(CASE | {"transient": {"duration": 1e-4, "load": [[0.0, 1.0], [1e-4, 0.5]]}})
    rough = run.start.problem.surface_1.model_copy(update={"rms_roughness": 1e-7})
    problem = run.start.problem.model_copy(update={"surface_1": rough})
    central = run.history.film_central.copy()
    central[-1] = 2e-8
    run = replace(
        run,
        start=run.start.but(problem=problem),
        history=replace(run.history, film_central=central),
    )
    words = " ".join(Page(report_text(run)).words)
    assert "Boundary lubrication at" in words
    assert "λ = 0.2 at the least" in words


@pytest.mark.usefixtures("no_pictures")
def test_the_load_of_a_line_is_that_of_a_length():
    line = {"type": "line", "radius": "8 mm", "load_per_length": "300 N/mm"}
    line |= {"entrainment_speed": "3 m/s"}
    transient = {"duration": 1e-4, "load": [[0.0, 1.0], [1e-4, 0.5]]}
    run = passing(CASE | {"contact": line, "transient": transient})
    words = " ".join(Page(report_text(run)).words)
    assert f" {1e-3 * run.start.scales.load:.4g} N/mm " in words
    assert f" {run.start.scales.load:.4g} N " not in words
    assert "w / (E' R_x) " in words
    assert "w / (E' R_x²)" not in words
