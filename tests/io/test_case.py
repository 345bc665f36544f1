"""Case files: what is read, and the sentence that each mistake gets."""

from pathlib import Path

import pytest

from tehl.api.problem import case_from_tables, read_case, read_case_and_options
from tehl.base.errors import InputError
from tehl.contact.options import Domain, coarsenable, coarsenings
from tehl.io.case import overridden
from tehl.io.templates import template_text
from tests.cases import ball_tables


def test_a_case_becomes_problem_and_options(case: Path):
    problem, options = read_case_and_options(case)
    assert problem.title == "a ball"
    assert problem.load == 80.0
    assert problem.radius_x == pytest.approx(0.02)
    assert problem.surface_1.material.name == "steel"
    assert problem.surface_2.material.young_modulus == pytest.approx(82e9)
    assert options.points == 129
    assert options.domain == Domain(x=(-4.5, 1.5), y=(-3.0, 3.0))
    assert read_case(case) == problem


def test_overrides_are_applied_before_anything_is_checked(case: Path):
    changes = (
        "numerics.points=[257, 129]",
        "contact.load = 100 N",
        'lubricant="mineral-oil"',
        "numerics.domain=auto",
        "numerics.accuracy=tight",
    )
    problem, options = read_case_and_options(case, changes)
    assert options.shape == (129, 257)
    assert options.domain == "auto"
    assert options.accuracy == "tight"
    assert problem.load == 100.0
    assert problem.lubricant.name == "mineral-oil"


# A change of the case above, and what the sentence must hold.
MISTAKES = [
    ("contact.laod=80 N", "contact.laod is not a known key", "did you mean load?"),
    ("numeric.points=129", "numeric is not a known key", "did you mean numerics?"),
    ("numerics.xyz=3", "numerics.xyz is not a known key", "known are error"),
    ("lubricant.viscosity.alfa=3", "lubricant.viscosity.alfa is not a known key", "alpha"),
    ("contact.width=10 mm", "contact.width is not a known key", 'type = "line"'),
    ("contact.line_load=1e5", "contact.line_load", "did you mean load_per_length?"),
    ("contact.radius_1=1 mm", "contact.radius_1 is not", "did you mean surface_1.radius?"),
    ("contact.type=line", "states load", "a line contact takes load_per_length"),
    ("contact.type=cone", "contact.type", "known are point, line"),
    ("contact.load_per_length=100 N", "has the unit of a force", '"200 N/mm"'),
    ("contact.load_per_length=1 N/mm", "states load_per_length", "a point contact takes load"),
    ("numerics.points=[257, 1]", "one row of nodes", 'contact.type = "line"'),
    ("contact.speed=1 m/s", "contact.speed is not a known key", "did you mean entrainment_speed"),
    ("surface_1.ra=0.1 um", "surface_1.ra is not a known key", "did you mean ra_roughness?"),
    ("surface_2.rq=0.1 um", "surface_2.rq is not a known key", "did you mean rms_roughness?"),
    (
        "lubricant.viscosity.alpha=22",
        "alpha = 22",
        "is in 1/Pa as a bare number; expected an inverse",
    ),
    ("surface_1.roughness='0.05 um'", "surface_1.roughness", "rms_roughness or ra_roughness"),
    ("supply.ratio=1e-12", "supply.ratio = 1e-12", "at least 0.001"),
    ("contact_film.thickness=few", "contact_film.thickness", 'a length such as "5 nm"'),
    ("contact.load='80'", 'contact.load = "80"', "lacks a unit"),
    ("contact.load=80 mm", "has the unit of a length (mm)", 'a force such as "80 N"'),
    ("contact.load=80 newton", "unknown unit 'newton'", '"80 N"'),
    ("contact.load=-80 N", "contact.load", "must be positive"),
    ("contact.load=0", "contact.load = 0", "must be positive"),
    ("contact.load=nan", "contact.load = NaN", "not a number"),
    ("contact.load=inf", "contact.load", "not finite"),
    ("contact.load=true", "contact.load = true", "not a number"),
    ("contact.hertz_pressure=1 GPa", "contact states load and hertz_pressure", "only one"),
    ("contact.moes_speed=10", "entrainment_speed and moes_speed", "only one"),
    ("contact.slide_roll_ratio=0.2 m", "contact.slide_roll_ratio", "plain number"),
    ("contact.sliding_angle=45", "contact.sliding_angle = 45", 'such as "45 deg"'),
    ("contact.spin_1=20 Hz", "has the unit of a frequency (Hz)", '"500 rpm"'),
    ("contact.spin=20", "contact.spin is not a known key", "spin_1 and spin_2"),
    ("contact=3", "contact = 3", "must be a table"),
    ("surface_1=steel", 'surface_1 = "steel"', "must be a table"),
    ("surface_1.material=stel", "surface_1.material", "did you mean steel?"),
    ("surface_1.material=unobtainium", "tehl solids lists 24, such as steel", "young_modulus"),
    ("surface_2.material.poisson_ratio=0.7", "surface_2.material.poisson_ratio = 0.7", "at most"),
    ("surface_1.radius=10 mm", "radii are stated twice", "reduced"),
    ("surface_1.rms_roughness=-1 nm", "surface_1.rms_roughness", "not be negative"),
    ("surface_1.roughness={type='wave'}", "surface_1.roughness.amplitude is missing", "length"),
    ("surface_1.temperature=300", "surface_1.temperature has an effect in thermal", "[thermal]"),
    ("surface_1.temperature=40", "surface_1.temperature = 40 K", '"40 degC"'),
    ("lubricant.temperature=40", "lubricant.temperature = 40 K", '"40 degC"'),
    ("lubricant.temperature=350", "lubricant.viscosity is given at 313.15 K", "add gamma"),
    ("lubricant.temperature='80 bar'", "lubricant.temperature", '"40 degC"'),
    ("thermal=3", "thermal = 3", "must be a table"),
    ("thermal={}", "surface_2.material.density is missing", '"7850 kg/m^3"'),
    ("thermal.temperature=40", "thermal.temperature = 40 K", '"40 degC"'),
    ("thermal.layer=21", "thermal.layer is not a known key", "did you mean layers?"),
    ("thermal.layers=4", "thermal.layers = 4", "a whole number from 5 to 81"),
    ("thermal.layers=99", "thermal.layers = 99", "from 5 to 81"),
    ("thermal.layers='9'", 'thermal.layers = "9"', "whole number"),
    ("thermal.reynolds='average'", "thermal.reynolds", "known are generalised, mean"),
    ("thermal.scheme='cheby'", "thermal.scheme", "did you mean chebyshev?"),
    ("thermal.sources='lines'", "thermal.sources", "did you mean line?"),
    ("lubricant.conductivity='0.14'", "lubricant.conductivity", "W/m/K"),
    ("lubricant.conductivity={value=0.14}", "lubricant.conductivity.slope is missing", "1/GPa"),
    ("lubricant.heat_capacity={value=2e3, slope=0, basis='mol'}", "capacity.basis", "mass, volume"),
    ("lubricant.heat_capacity={value=0, slope=0}", "lubricant.heat_capacity.value = 0", "J/kg/K"),
    ("transient.step='auto'", "transient.step is not a known key", "stride"),
    ("transient.duration='1 m'", "transient.duration", "time"),
    ("lubricant=mineral-oel", "lubricant", "did you mean mineral-oil?"),
    ("lubricant.viscosity={law='roelands'}", "lubricant.viscosity.eta_0 is missing", "Pa s"),
    ("lubricant.viscosity={eta_0=0.04}", "lubricant.viscosity.law is missing", "barus"),
    ("lubricant.viscosity.law='roeland'", 'lubricant.viscosity.law = "roeland"', "roelands?"),
    ("lubricant.viscosity.z=0.6", "lubricant.viscosity needs exactly one of", "alpha and z"),
    ("lubricant.viscosity.eta_0=1e-5 Pa s", "eta_0 = 1e-05 Pa s", "6.3e-5"),
    ("lubricant.viscosity={law='walther', nu_40=6e-5}", "viscosity.nu_100 is missing", "mm^2/s"),
    ("lubricant.viscosity={law='walther', nu_40='68 mPa s', nu_100=8e-6}", "nu_40", "mm^2/s"),
    ("lubricant.viscosity={law='walther', nu_40=6e-5, nu_100=8e-6}", "viscosity needs", "alpha"),
    (
        "lubricant.viscosity={law='walther', nu_40='6 mm^2/s', nu_100='8 mm^2/s', z=0.6}",
        "viscosity has nu_40",
        "fall",
    ),
    ("lubricant.viscosity={law='tait-doolittle'}", "viscosity.eta_0 is missing", "Pa s"),
    ("lubricant.viscosity={law='roelands-exponential', eta_0=1}", "needs exactly one", "alpha"),
    (
        "lubricant.viscosity={law='tait-doolittle', eta_0=1, B=4, occupied=1.2, bulk_modulus=1e9}",
        "lubricant.viscosity.occupied = 1.2",
        "less than 1",
    ),
    (
        "lubricant.viscosity={law='tait-doolittle', eta_0=1, B=4, occupied=0.6, bulk_modulus='m'}",
        'lubricant.viscosity.bulk_modulus = "m"',
        '"1.2 GPa"',
    ),
    ("lubricant.density={law='tait', rho_0=800}", "density.bulk_modulus is missing", "GPa"),
    ("lubricant={name='iso-vg-86'}", 'lubricant.name = "iso-vg-86"', "did you mean iso-vg-"),
    ("lubricant={name='iso-vg-68', shear={law='eyring'}}", "shear.stress is missing", "5 MPa"),
    ("lubricant.density.rho_0='890'", "lubricant.density.rho_0", '"890 kg/m^3"'),
    ("lubricant.density.form='sum'", "lubricant.density.form", "known are product, additive"),
    ("lubricant.shear.law='eyrin'", "lubricant.shear.law", "did you mean eyring?"),
    ("lubricant.shear={law='eyring'}", "lubricant.shear.stress is missing", '"5 MPa"'),
    ("lubricant.shear={law='eyring', stress='5 mm'}", "lubricant.shear.stress", '"5 MPa"'),
    ("lubricant.shear={law='eyring', stress=0}", "lubricant.shear.stress = 0", "be positive"),
    ("lubricant.shear={law='carreau', modulus=6e6}", "shear.exponent is missing", "0.4"),
    ("lubricant.shear={law='carreau', modulus=6e6, exponent=2}", "shear.exponent = 2", "at most 1"),
    ("lubricant.shear={law='limiting'}", "lubricant.shear needs stress or slope", '"20 MPa"'),
    ("lubricant.shear={law='limiting', slope=-1}", "lubricant.shear.slope = -1", "0.04"),
    ("title=4", "title = 4", "must be a string"),
    ("numerics=3", "write [numerics] on a line of its own", 'error = "1 %" below it'),
    ("thermal=true", "write [thermal] on a line of its own", "or {} in place of true for its"),
    ("numerics.max_time={}", "numerics.max_time is a number, not a table", "below [numerics]"),
    ("lubricant.viscosity=5", "must be a table such as", '{ law = "roelands", eta_0 = '),
    ("numerics.points=100", "numerics.points = 100", "cannot be coarsened"),
    ("numerics.error=5", "numerics.error = 5", 'at most 50 %; did you mean "5 %"?'),
    ("numerics={error='1 %', points=129}", "numerics.error = 1 %", "both stated"),
    ("numerics.points=[129, 100]", "numerics.points = 100", "cannot be coarsened"),
    ("numerics.points=5", "numerics.points = 5", "a whole number from 17 to 16385"),
    ("numerics.points=[129]", "numerics.points = [129]", "two numbers"),
    ("numerics.points=[129, 129, 129]", "numerics.points", "must have at most 2"),
    ("numerics.points=many", "numerics.points", "whole number"),
    ("numerics.domain={x=[-0.5, 1.5], y=[-3, 3]}", "numerics.domain.x", "cuts the contact"),
    ("numerics.domain={x=[-4, nan], y=[-3, 3]}", "numerics.domain.x", "two finite numbers"),
    ("numerics.domain={x=[-inf, 1.5], y=[-3, 3]}", "numerics.domain.x", "two finite numbers"),
    ("numerics.domain={x=[1.5, -4.5], y=[-3, 3]}", "numerics.domain.x", "begin with its lower"),
    ("numerics.domain={x=[-1e5, 1.5], y=[-3, 3]}", "numerics.domain.x", "within 1000 Hertz"),
    (
        'dynamics.frequencies="1 kHz"',
        'dynamics.frequencies = "1 kHz"',
        "must be a list, in square br",
    ),
    ("lubricant.density.beta=2", "lubricant.density.beta = 2", "is in 1/K as a bare number"),
    ("numerics.max_memory=-1", "numerics.max_memory = -1", "is not an amount of memory, su"),
    ("numerics.max_memory=1e30", "numerics.max_memory = 1e+30", "is not an amount of memory, su"),
    ("lubricant.temperature=0.0", "lubricant.temperature = 0", "is not above absolute zero"),
    ("numerics.domain={x=3, y=[-3, 3]}", "numerics.domain.x = 3", "a list of two numbers"),
    ("numerics.domain={x=[-4, 2, 3], y=[-3, 3]}", "numerics.domain.x", "at most 2 numbers"),
    ("numerics.domain=wide", 'numerics.domain = "wide"', "or a table with x and y"),
    ("numerics.points=true", "numerics.points = true", "is not a number"),
    ("numerics.max_cycles=true", "numerics.max_cycles = true", "is not a number"),
    (f"numerics.points={'9' * 400}", "numerics.points = 999", "from 17 to 16385"),
    (f"contact.load={'9' * 5000}", "contact.load", '"80 N"'),
    (f"contact.load=80 {'(' * 5000}", "contact.load", "unreadable unit"),
    (f"contact.load={'[' * 100}{']' * 100}", "contact.load = [[[", '"80 N"'),
    (f"contact.load={'[' * 5000}", "nested too deeply", ""),
    ("contact.load=80,5 N", "comma", "write a decimal point"),
    ("contact.load=80\udcff N", "not UTF-8 text", ""),
    ("axes=1", "", "is a study, not a case: solve it with tehl study"),
    ("points=33", "points is not a known key", "did you mean numerics.points?"),
    ("load=80 N", "load is not a known key", "did you mean contact.load or transient.load?"),
    ("srr=0.5", "srr is not a known key", "did you mean contact.slide_roll_ratio?"),
    ("contact.points=33", "contact.points is not a known key", "did you mean numerics.points?"),
    ("x" * 100_000 + "=3", "xxx... is not a known key", "known are title"),
    ("contact.a\nb=3", 'contact."a\\nb" is not a known key', "load"),
    ("a." * 2000 + "b=3", "2001 parts; expected at most 8", ""),
    ("contact.load=1\nx=2", "contact.load", '"80 N"'),
    ("surface_1.material=5", "surface_1.material = 5: must be the name", "or a table with young"),
    ("surface_1.material={E=1}", "surface_1.material.E is not", "did you mean young_modulus?"),
    ("surface_1.rough=1", "surface_1.rough is not", "did you mean roughness?"),
    ("lubricant.shear={law='limit'}", "unknown", "did you mean limiting?"),
    ("lubricant=5W-30", "is not a known oil", "such as that of tehl new data-sheet"),
    ("surface_1.material=[]", "surface_1.material = []: must be the name", "steel"),
    ("surface_1.material={young_modulus=2e11}", "poisson_ratio is missing", "such as 0.3"),
    ("lubricant=true", "lubricant = true: must be the name", "mineral-oil"),
    ("lubricant={}", "lubricant.density is missing", "one of dowson-higginson"),
    ("numerics.domain={x=[-4.5, 1.5]}", "numerics.domain.y is missing", ""),
    ("numerics.domain=big", 'numerics.domain = "big"', "auto"),
    ("numerics.cycle='Z'", "numerics.cycle", "known are V, W, F"),
    ("numerics.wedge_order=4", "numerics.wedge_order = 4", "known are 1, 2, 3"),
    ("numerics.tolerance=2", "numerics.tolerance = 2", "greater than 0 and less than 1"),
    ("numerics.points=[257, 5]", "numerics.points.1 = 5", "from 17 to 16385"),
    ("numerics.points=33.5", "numerics.points = 33.5", "a whole number from 17 to 16385"),
    ("numerics.max_cycles=0", "numerics.max_cycles = 0", "from 1 to 1000"),
    ("thermal={layers=7.5}", "thermal.layers = 7.5", "a whole number from 5 to 81"),
    ("lubricant.heat_capacity=1.8 MJ/m^3/K", "per volume (MJ/m^3/K)", "divide it by the density"),
    (
        'lubricant.heat_capacity={ value = "1.8 MJ/m^3/K", slope = 0, basis = "volume" }',
        "lubricant.heat_capacity.value",
        'a heat capacity per mass such as "2000 J/kg/K" (divide it by the density, also with basis',
    ),
    ("lubricant.conductivity={value=0.14}", "conductivity.slope is missing", '"1.4 1/GPa"'),
    ("lubricant.viscosity.eta_0=68 cSt", "kinematic viscosity", "multiply it by the density"),
    ("lubricant.shear=carreau", "must be a table", '{ law = "carreau", modulus = "5 MPa"'),
    ("lubricant.shear={law=carreau}", "not a TOML table", "double quotes"),
]


@pytest.mark.parametrize(("change", "what", "right"), MISTAKES)
def test_a_mistake_is_reported_in_one_sentence_with_its_key(
    case: Path, change: str, what: str, right: str
):
    with pytest.raises(InputError) as caught:
        read_case_and_options(case, [change])
    message = str(caught.value)
    assert what in message
    assert right in message
    assert message.startswith(str(case))
    assert "\n" not in message


@pytest.mark.parametrize("table", ["contact", "surface_1", "lubricant"])
def test_a_missing_table_is_named(table: str):
    tables = {key: value for key, value in ball_tables().items() if key != table}
    with pytest.raises(InputError, match=f"^{table} is missing"):
        case_from_tables(tables)


@pytest.mark.parametrize(
    ("key", "words"),
    [
        ("load", "contact needs one of load, hertz_pressure, moes_load"),
        ("entrainment_speed", "contact needs one of entrainment_speed, moes_speed"),
        ("radius", "contact.radius is missing"),
    ],
)
def test_a_missing_part_of_the_contact_is_named(key: str, words: str):
    tables = ball_tables()
    del tables["contact"][key]
    with pytest.raises(InputError, match=words):
        case_from_tables(tables)


def test_a_value_instead_of_a_table_is_reported_before_missing_keys():
    with pytest.raises(InputError, match=r'^contact = "x": must be a table'):
        case_from_tables({"contact": "x"})


def test_surfaces_that_do_not_curve_apart_are_named():
    contact = {"load": "80 N", "entrainment_speed": 1}
    hollow = {"material": "steel", "radius_x": "-20 mm", "radius_y": "20 mm"}
    flat = {"material": "steel", "radius": "inf"}
    with pytest.raises(InputError, match=r"^surface_1.radius_x and surface_2.radius: .* -0.02 m"):
        case_from_tables(ball_tables(contact=contact, surface_1=hollow, surface_2=flat))


def test_flat_on_flat_is_rejected():
    flat = {"material": "steel", "radius": "inf"}
    contact = {"load": "80 N", "entrainment_speed": 1}
    with pytest.raises(InputError, match="flat on flat"):
        case_from_tables(ball_tables(contact=contact, surface_1=flat, surface_2=flat))


@pytest.mark.parametrize("change", ["numerics.points", "=3", "contact..load=3", "title.x=3"])
def test_an_invalid_override_is_reported(case: Path, change: str):
    with pytest.raises(InputError, match="invalid override"):
        read_case_and_options(case, [change])


@pytest.mark.parametrize("nodes", range(33, 1200, 7))
def test_the_suggested_grids_can_be_coarsened(nodes: int):
    fewer, more = coarsenable(nodes)
    assert fewer <= nodes < more
    assert coarsenings(fewer) > 0
    assert coarsenings(more) > 0


# A table, the word that changes its law, and the table that the sentence proposes.
CHANGED_LAWS = [
    ('shear={ law = "eyring", stress = "5 MPa" }', "shear.law=carreau"),
    ('shear={ law = "carreau", modulus = "5 MPa", exponent = 0.4 }', "shear.law=limiting"),
    ('shear={ law = "limiting", slope = 0.05 }', "shear.law=newtonian"),
    ('density={ law = "dowson-higginson", rho_0 = 890, beta = "7e-4 1/K" }', "density.law=tait"),
    ('viscosity={ law = "roelands", eta_0 = 0.04, z = 0.6 }', "viscosity.law=walther"),
    ('viscosity={ law = "roelands", eta_0 = 0.04, alpha = 2e-8 }', "viscosity.law=constant"),
]


@pytest.mark.parametrize(("table", "law"), CHANGED_LAWS)
def test_a_law_in_the_table_of_another_gets_a_whole_table_proposed(
    case: Path, table: str, law: str
):
    changes = [f"lubricant.{table}", f"lubricant.{law}"]
    with pytest.raises(InputError, match="is not a key of law = ") as caught:
        read_case_and_options(case, changes)
    _, _, proposed = str(caught.value).partition("replace the whole table, ")
    read_case_and_options(case, [changes[0], proposed])


def test_a_key_near_one_of_the_stated_law_is_suggested_from_that_law(case: Path):
    changes = ['lubricant.shear={ law = "carreau", modulus = "5 MPa", exponnt = 0.4 }']
    with pytest.raises(InputError, match="did you mean exponent"):
        read_case_and_options(case, changes)


@pytest.mark.parametrize(
    ("stated", "words"),
    [
        ({}, "surface_1.roughness.type is missing; known are smooth, wave, .*, map, sum$"),
        ([{"amplitude": "1 nm"}], r"roughness\.0\.type is missing; known are smooth, .*, map$"),
        ({"type": "wav"}, 'surface_1.roughness.type = "wav": unknown; did you mean wave'),
        ([{"type": "wave"}], r"roughness\.0\.amplitude is missing; expected a length such as"),
    ],
)
def test_a_roughness_without_its_type_is_reported_with_the_known_types(stated, words):
    with pytest.raises(InputError, match=words):
        case_from_tables(ball_tables(surface_1={"material": "steel", "roughness": stated}))


@pytest.mark.parametrize(
    ("first", "second", "points", "error"),
    [
        ("numerics.error='1 %'", "numerics.points=129", 129, None),
        ("numerics.points=129", "numerics.error='1 %'", "auto", 0.01),
    ],
)
def test_a_change_of_the_nodes_or_the_error_replaces_the_other(
    tmp_path, first, second, points, error
):
    path = tmp_path / "case.toml"
    path.write_text(template_text("ball-on-disc"), encoding="utf-8")
    _, options = read_case_and_options(path, [first, second])
    assert (options.points, options.error) == (points, error)


def test_bodies_that_are_both_flat_along_y_make_a_line_contact(tmp_path):
    text = template_text("ball-on-disc").replace(
        'radius = "20 mm"', 'radius_x = "20 mm"\nradius_y = "inf"'
    )
    (tmp_path / "line.toml").write_text(text)
    with pytest.raises(InputError, match=r"a line contact has contact\.type"):
        read_case(tmp_path / "line.toml")


def test_a_table_is_left_out_by_false():
    tables = {"thermal": {"layers": 9}, "contact": {"load": 1.0}}
    tables = overridden(tables, "thermal=false")
    assert tables == {"contact": {"load": 1.0}}


SUGGESTED = {
    "contact.force": "load",
    "contact.normal_load": "load",
    "contact.max_pressure": "hertz_pressure",
    "contact.velocity": "entrainment_speed",
    "contact.mean_speed": "entrainment_speed",
    "contact.SRR": "slide_roll_ratio",
    "contact.slip": "slide_roll_ratio",
    "contact.omega_1": "spin_1",
    "contact.R": "radius",
    "contact.temperature": "lubricant.temperature",
    "contact.viscosity": "lubricant.viscosity",
    "contact.modulus": None,
    "contact.amplitude": None,
    "contact.thickness": None,
    "contact.law": None,
    "contact.lambda": None,
    "surface_1.E": "material.young_modulus",
    "surface_1.nu": "material.poisson_ratio",
    "surface_1.sigma": "rms_roughness",
    "surface_2.Ra": "ra_roughness",
    "surface_2.speed": "contact.entrainment_speed",
    "surface_2.texture": None,
    "surface_2.width": None,
    "lubricant.eta": "viscosity.eta_0",
    "lubricant.alpha": "viscosity.alpha",
    "lubricant.eyring_stress": "shear.stress",
    "lubricant.beta": "lubricant.density.beta",
    "lubricant.cp": "heat_capacity",
    "lubricant.barus": None,
    "thermal.oil_temperature": "temperature",
    "numerics.nodes": "points",
    "numerics.iterations": "max_cycles",
    "numerics.steps": None,
    "numerics.relaxation": None,
    "transient.time_step": "stride",
    "transient.time": "duration",
    "supply.film": "layer",
    "supply.starvation": None,
    "contact_film.mu": "friction",
}
"""Keys in the field's words, and the key to suggest; none where none is plausible."""


@pytest.mark.parametrize(("wrong", "right"), SUGGESTED.items())
def test_a_suggested_key_is_plausible_in_its_table(wrong, right):
    table, _, key = wrong.partition(".")
    tables = ball_tables()
    stated = tables.get(table, {})
    tables[table] = (stated if isinstance(stated, dict) else {"name": stated}) | {key: 1.0}
    with pytest.raises(InputError, match="is not a known key") as caught:
        case_from_tables(tables)
    said = str(caught.value).partition("; ")[2]
    assert said.startswith("known are" if right is None else f"did you mean {right}?")


def test_a_missing_map_of_a_patch_is_named_with_its_key(tmp_path):
    patch = {"model": "surface", "map": {"file": "no.npy"}}
    with pytest.raises(InputError, match=r"^asperities\.map\.file: no map \"no\.npy\" in /"):
        case_from_tables(ball_tables() | {"asperities": patch}, tmp_path)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"contact": 5},
            "contact = 5: must be a table: write [contact] on a line of its own and "
            'radius = "20 mm" below it',
        ),
        (
            {"contact": {"radius": 0.01, "load": {}, "entrainment_speed": 1.0}},
            'contact.load is a number, not a table: write load = "80 N" below [contact]',
        ),
    ],
)
def test_a_number_and_a_table_in_place_of_one_another_are_explained(change, message):
    with pytest.raises(InputError) as caught:
        case_from_tables(ball_tables() | change)
    assert str(caught.value) == message
