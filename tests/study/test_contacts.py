"""Lists of contacts: headings, units, templates, wrong rows, answers, spreadsheets."""

import json

import pandas as pd
import pytest
from openpyxl import Workbook, load_workbook
from typer.testing import CliRunner

import tehl
from tehl.api.problem import case_from_tables, read_case
from tehl.base.errors import InputError
from tehl.base.lists import lines_of_frame
from tehl.cli import application
from tehl.estimate.settled import settled
from tehl.io.templates import template_text
from tehl.result.solution import Hint
from tehl.studies import Store
from tehl.studies.answers import _obtained, answers, values_of, write_answers
from tehl.studies.case import Case, Row
from tehl.studies.contacts import contacts_of, read_contacts, tables_of, template_tables
from tehl.studies.headings import column_of

COARSE = """
[contact]
radius = "10 mm"
load = "20 N"
entrainment_speed = "1 m/s"
[surface_1]
material = "steel"
[surface_2]
material = "steel"
[lubricant]
name = "mineral-oil"
[numerics]
points = 65
"""


@pytest.fixture
def template(tmp_path):
    """Return a case file that is solved at once."""
    path = tmp_path / "case.toml"
    path.write_text(COARSE)
    return path


def command(*words):
    """Run ``tehl contacts``."""
    return CliRunner().invoke(application(), ["contacts", *map(str, words)])


@pytest.mark.parametrize(
    ("heading", "key", "unit"),
    [
        ("load [N]", "contact.load", "N"),
        ("Load (kN)", "contact.load", "kN"),
        ("load / N", "contact.load", "N"),
        ("load/N", "contact.load", "N"),
        ("load in N", "contact.load", "N"),
        ("load_N", "contact.load", "N"),
        ("contact.load", "contact.load", ""),
        ("p_h [GPa]", "contact.hertz_pressure", "GPa"),
        ("Hertz pressure (GPa)", "contact.hertz_pressure", "GPa"),
        ("u_m [m/s]", "contact.entrainment_speed", "m/s"),
        ("SRR [-]", "contact.slide_roll_ratio", ""),
        ("SRR (%)", "contact.slide_roll_ratio", "%"),
        ("oil temperature [°C]", "lubricant.temperature", "degC"),
        ("nu_40 [mm²/s]", "lubricant.viscosity.nu_40", "mm^2/s"),
        ("Ra 1 [µm]", "surface_1.ra_roughness", "um"),
        ("surface_2.rms_roughness [um]", "surface_2.rms_roughness", "um"),
        ("numerics.points", "numerics.points", ""),
        ("spin 1 [rpm]", "contact.spin_1", "rpm"),
        ("sliding angle (deg)", "contact.sliding_angle", "deg"),
        ("roller length / mm", "contact.length", "mm"),
        ("misalignment [mrad]", "contact.tilt", "mrad"),
        ("oil", "lubricant.oil", ""),
        ("Last [N]", "contact.load", "N"),
        ("Geschwindigkeit [m/s]", "contact.entrainment_speed", "m/s"),
        ("Öl", "lubricant.oil", ""),
        ("Werkstoff 2", "surface_2.material", ""),
        ("remark", None, ""),
    ],
)
def test_headings_are_read_in_every_usual_spelling(heading, key, unit):
    column = column_of(heading)
    assert (column.key, column.unit) == (key, unit)


@pytest.mark.parametrize(
    "text",
    [
        "load [N];speed [m/s];remark\n20,5;1,0;new\n30,5;2,0;\n",
        "load,speed,remark\nN,m/s,\n20.5,1.0,new\n30.5,2.0,\n",
        "load_kN\tspeed in m/s\tremark\n0,0205\t1\tnew\n0,0305\t2\t\n",
    ],
)
def test_spreadsheets_of_all_countries_give_the_same_contacts(tmp_path, template, text):
    path = tmp_path / "list.csv"
    path.write_text(text)
    found = read_contacts(path, template)
    problems = [case.problem for case in found.cases]
    assert [one.load for one in problems] == pytest.approx([20.5, 30.5])
    assert [one.entrainment_speed for one in problems] == pytest.approx([1.0, 2.0])
    assert found.rows[0].cells[2] == "new"


@pytest.mark.parametrize("head", ["load [N/mm],point", "load,point\nN/mm,", "w / (kN/m),point"])
def test_a_load_per_length_is_that_of_a_line(tmp_path, head):
    path, template = tmp_path / "list.csv", tmp_path / "line.toml"
    path.write_text(head + "\n100,a\n250,b\n")
    template.write_text(template_text("line"))
    problems = [case.problem for case in read_contacts(path, template).cases]
    assert [one.load for one in problems] == pytest.approx([1e5, 2.5e5])


def test_rows_may_be_numbered(tmp_path, template):
    path = tmp_path / "list.csv"
    path.write_text("no,load [N]\n1,20\n2,30\n")
    assert [case.problem.title for case in read_contacts(path, template).cases] == ["1", "2"]
    frame = pd.DataFrame({"id": [7, 8], "load [N]": [20.0, 30.0]})
    found = contacts_of(lines_of_frame(frame), *template_tables(template))
    assert [case.problem.title for case in found.cases] == ["7", "8"]


def test_a_row_that_states_another_key_removes_that_of_the_template(template):
    base = read_case_tables(template)
    tables = tables_of(base, {"contact.hertz_pressure": "1 GPa", "contact.radius_x": "5 mm"})
    assert tables["contact"] == {
        "entrainment_speed": "1 m/s",
        "hertz_pressure": "1 GPa",
        "radius_x": "5 mm",
    }
    assert base["contact"]["load"] == "20 N"
    tables = tables_of(base, {"lubricant.oil": "iso-vg-68", "surface_1.radius": "4 mm"})
    assert tables["lubricant"] == {"oil": "iso-vg-68"}
    assert tables["surface_1"] == {"material": "steel", "radius": "4 mm"}


def test_a_row_switches_a_table_on_and_off(template):
    base = template_tables(template)[0]
    heated = tables_of(base, {"thermal": "yes", "contact.slide_roll_ratio": 0.1})
    assert heated["thermal"] == {}
    layers = base | {"thermal": {"layers": 9}}
    assert tables_of(layers, {"thermal": True})["thermal"] == {"layers": 9}
    assert "thermal" not in tables_of(layers, {"thermal": "no"})
    with pytest.raises(InputError, match="thermal = perhaps: must be yes or no"):
        tables_of(layers, {"thermal": "perhaps"})


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('load [N],remark\n80,"unclosed\n90,x\n', "line 2: a quote is not closed"),
        ('load [N],remark\n80,x\n90,"a"b\n', "line 3: a quote is not closed, or has more"),
    ],
)
def test_a_quote_that_would_hide_rows_is_an_error(tmp_path, template, text, words):
    path = tmp_path / "list.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=words):
        read_contacts(path, template)


def test_dates_are_words_and_no_text_is_a_formula_in_a_sheet(tmp_path, template, monkeypatch):
    path = tmp_path / "list.csv"
    path.write_text("load [N],when,remark\n80,2020-01-01,=1+1\n", encoding="utf-8")
    contacts = read_contacts(path, template)
    monkeypatch.setattr(Store, "rows", lambda *_: {})
    write_answers(contacts, Store(tmp_path / "s"), tmp_path / "out.xlsx")
    page = load_workbook(tmp_path / "out.xlsx").active
    cells = [page.cell(3, place) for place in (1, 2, 3)]
    assert [one.value for one in cells] == [80, "2020-01-01", "=1+1"]
    assert [one.data_type for one in cells] == ["n", "s", "s"]


def test_the_viscosities_of_a_data_sheet_replace_the_law_of_the_template(tmp_path):
    path = tmp_path / "list.csv"
    path.write_text(
        "nu_40 [cSt],nu_100 [cSt],alpha [1/GPa],temperature [°C]\n"
        "68,8.7,20,60\n,,,40\n68,,20,60\n68,8.7,,60\n"
    )
    stated, template, half, without = read_contacts(path).rows
    assert stated.case.problem.lubricant.viscosity.law == "walther"
    assert template.case.problem.lubricant.viscosity.law == "roelands"
    assert "lubricant.viscosity.nu_100 is missing" in half.message
    assert "alpha" in without.message


def test_values_that_are_not_plausible_are_named_beside_their_row(tmp_path, template):
    path = tmp_path / "list.csv"
    path.write_text("load [N],Ra 1 [um]\n20,0.01\n20,400000\n")
    usual, wrong = answers(read_contacts(path, template), Store(tmp_path / "store"))
    assert usual["obtained"] == "not solved yet"
    assert wrong["obtained"].startswith("not solved yet; please check: ")
    assert "typical values are" in wrong["obtained"]


def test_texts_of_a_sheet_may_have_decimal_commas(tmp_path, template):
    path = tmp_path / "list.xlsx"
    for cells, load in ((["20,5", "1.250,5"], [20.5, 1250.5]), ([20.5, "1250.5"], [20.5, 1250.5])):
        pd.DataFrame({"load [N]": cells, "remark": ["a", "b"]}).to_excel(path, index=False)
        found = read_contacts(path, template)
        assert [case.problem.load for case in found.cases] == pytest.approx(load)
        assert found.carried == ["remark"]
    pd.DataFrame({"load [N]": ["20,5", "1.250"]}).to_excel(path, index=False)
    (wrong,) = read_contacts(path, template).wrong
    assert "write 1250 or 1,250" in wrong.message


def read_case_tables(path):
    """Return the tables of a case file."""
    return tehl.io.case.toml_tables(path)


def test_wrong_headings_are_one_sentence(tmp_path, template):
    path = tmp_path / "list.csv"
    for text, words in (
        ("lod [N],speed\n1,2\n", 'the column "lod [N]" is not known; did you mean load'),
        ("load [N],n [1/min]\n1,2\n", 'values such as "500 rpm at 40 mm" below u_m'),
        ("load [N],force [N]\n1,2\n", "two columns state contact.load"),
        (
            "load [furlong]\n1\n",
            'the unit of the column "load [furlong]" is not known: furlong; expected a force such '
            'as "80 N"',
        ),
        ("nu_40 [SUS]\n1\n", "is not known: SUS; expected a kinematic viscosity such as"),
        ("max_time [fortnight]\n1\n", 'is not known: fortnight; expected a time such as "10 min"'),
        ("radius_1 [foot]\n1\n", 'is not known: foot; expected a radius such as "20 mm"'),
        ("load [N]\n", "has no contacts"),
        (
            "remark\nnew\n",
            'such as load [N]: its first row must have the headings, and is "remark"',
        ),
        ("strange\n5\n", "has no column that a case file knows"),
        ("load,xyzzy\n5,6\n", 'the column "xyzzy" is not known; take a usual word (load, p_h'),
        ("load,Ölsorte\n5,ISO VG 32\n", "and its cells name oils: call it oil, or remove it"),
        ("load,Kugel\n5,steel\n", "and its cells name solids: call it material 1 or material 2"),
    ):
        path.write_text(text)
        with pytest.raises(InputError) as caught:
            read_contacts(path, template)
        assert words in str(caught.value)


def test_wrong_rows_are_named_and_the_others_are_solved_equal_ones_once(tmp_path, template):
    path, out = tmp_path / "list.csv", tmp_path / "out.csv"
    path.write_text("title,load [N]\na,20\nb,-5\nc,20\n\nd,much\ne,25\n")
    done = command(path, "-o", out, "--template", template, "-j", 1, "--json")
    assert done.exit_code == 1
    found = json.loads(done.stdout.strip().splitlines()[-1])
    assert found["rows"] == 5
    assert found["equal"] == 1
    assert found["converged"] == 2
    assert "what the rows do not state" not in done.stderr
    assert [text.split(":")[0] for text in found["wrong"]] == ["row 3", "row 6"]
    assert 'column "load [N]": contact.load' in found["wrong"][0]
    table = pd.read_csv(out)
    assert list(table["status"]) == [
        "converged",
        "wrong row",
        "converged",
        "wrong row",
        "converged",
    ]
    first, third = table.iloc[0], table.iloc[2]
    assert first["central film [nm]"] == third["central film [nm]"]
    result = tehl.solve(read_case(template), tehl.Options(points=65))
    assert first["central film [nm]"] == pytest.approx(1e9 * result.film.central)
    assert first["± central film [nm]"] == pytest.approx(
        1e9 * result.film.central * result.errors.central
    )
    assert first["obtained"].startswith("solved on 65 x 65 nodes, film to ")
    assert "row 3" in table.iloc[1]["obtained"]

    again = command(path, "-o", out, "--template", template, "-j", 1, "--json")
    assert json.loads(again.stdout.strip().splitlines()[-1])["reused"] == 2


def test_a_list_with_decimal_commas_comes_back_with_them(tmp_path, template):
    """Else the spreadsheet that saved it puts each line into one cell."""
    path, out = tmp_path / "list.csv", tmp_path / "out.csv"
    text = "bearing;load [N];speed [m/s]\n22.205;20,5;1\nwrong;-3,5e0;1\nmany or few;1.205;1\n"
    path.write_text(text, encoding="utf-8-sig")
    done = command(path, "-o", out, "--template", template, "-j", 1, "--quiet")
    assert done.exit_code == 1
    head, first, second, third = out.read_text(encoding="utf-8").splitlines()
    assert head.startswith("\ufeffbearing;load [N];speed [m/s];")
    assert first.startswith("22.205;20,5;1;")
    assert second.startswith("wrong;-3,5e0;1;")
    assert third.startswith("many or few;1.205;1;")
    assert 'column ""load [N]"": 1.205 has a point' in third
    table = pd.read_csv(out, sep=";", decimal=",")
    case = tmp_path / "same.toml"
    case.write_text(COARSE.replace("20 N", "20.5 N"))
    film = tehl.solve(read_case(case), tehl.Options(points=65)).film.central
    assert table["central film [nm]"][0] == pytest.approx(1e9 * film)


def test_excel_comes_back_as_an_engineer_would_format_it(tmp_path, template):
    book = Workbook()
    book.active.append(["title", "load", "speed"])
    book.active.append([None, "N", "m/s"])
    book.active.append(["inner", 20, 1.5])
    path, out = tmp_path / "list.xlsx", tmp_path / "out.xlsx"
    book.save(path)
    done = command(path, "-o", out, "--template", template, "-j", 1, "--quiet")
    assert done.exit_code == 0, done.output
    page = load_workbook(out).active
    assert page.freeze_panes == "A3"
    assert page.auto_filter.ref.startswith("A2:")
    heads = [cell.value for cell in page[1]]
    units = dict(zip(heads, (cell.value for cell in page[2]), strict=True))
    assert units["load"] == "N"
    assert units["central film"] == units["± central film"] == "nm"
    assert heads.index("± central film") == heads.index("central film") + 1
    assert units["Hertz pressure"] == "GPa"
    line = dict(zip(heads, page[3], strict=True))
    assert line["title"].value == "inner"
    assert line["central film"].number_format == "0.0"
    assert line["status"].value == "converged"
    assert command(path, "-o", tmp_path / "out.txt").exit_code != 0


def test_a_frame_is_solved_from_python(template):
    frame = pd.DataFrame({"load [N]": [20.0, None], "mark": ["a", "b"]}, index=[10, 11])
    found = tehl.solve_contacts(frame, template)
    assert list(found.index) == [10, 11]
    assert list(found["mark"]) == ["a", "b"]
    # an empty cell is the load of the template, which is the same
    assert found.loc[10, "minimum film [nm]"] == found.loc[11, "minimum film [nm]"]
    assert found.loc[10, "Hertz pressure [GPa]"] > 0
    with pytest.raises(InputError, match=r"must be a pandas\.DataFrame, not str"):
        tehl.solve_contacts("list.csv", template)
    same = tehl.solve_contacts(frame, read_case(template))
    assert same.loc[10, "status"] in ("converged", "not_converged")


def test_friction_and_loss_contain_those_of_asperities():
    summary = {
        "traction.mid_film": -0.02,
        "traction.friction_power_w": 3.0,
        "load_sharing.share": 0.5,
        "load_sharing.friction_boundary": 0.04,
        "load_sharing.power_boundary_w": 2.0,
        "roughness.lambda_central": 2.0,
    }
    values = values_of(summary)
    assert values["friction"] == pytest.approx(0.06)
    assert values["friction loss [W]"] == 5.0
    assert values["load on asperities [%]"] == 50.0
    assert values["kappa, as lambda^1.3"] == pytest.approx(2.0**1.3)
    oil = {"traction.mid_film": -3.0, "traction.credible": False}
    oil |= {"temperature.film_rise_max_k": 110.0, "bodies.heat_1_w": 39.7, "film.h_min_m": 1e-7}
    assert list(values_of(oil)) == ["minimum film [nm]"]
    assert len(values_of(oil | {"traction.credible": True})) > 3
    row = Row(key="a", status="converged", summary=oil)
    assert "no friction or heat, as this oil shears at more stress" in _obtained(row)


def test_a_loss_by_rolling_is_that_of_the_whole_line_or_not_known():
    """Of thick films the loaded zone has a part that falls short of it, or is negative."""
    zone = {"traction.friction_power_w": -42.9, "traction.sliding_power_w": 11.4}
    zone |= {"traction.mid_film": 0.01, "errors.traction_mid_film": 0.004}
    line = {"rolling.power_w": 282.4, "errors.rolling": 0.02}
    assert values_of(zone | line)["friction loss [W]"] == pytest.approx(293.8)
    assert values_of(zone | line)["± friction loss [W]"] == pytest.approx(0.02 * 293.8)
    assert "friction loss [W]" not in values_of(zone)
    row = Row(key="a", status="converged", summary=zone)
    assert "no loss, as that by rolling" in _obtained(row)


def test_a_row_says_which_of_its_empty_cells_the_template_states():
    headings = ["name", "load [N]", "p_h [GPa]", "u_m [m/s]"]
    rows = ["a", 50, None, 1.0], ["b", None, 1.2, 1.0], ["c", None, None, None]
    lines = list(enumerate([headings, *map(list, rows)], 1))
    found = contacts_of(lines, *template_tables(None))
    assert [row.taken for row in found.rows] == [(), (), ("load [N]", "u_m [m/s]")]
    solved = Row(key="a", status="converged", summary={})
    assert _obtained(solved, found.rows[2].taken).endswith("; of the template: load [N], u_m [m/s]")


def test_answers_are_taken_in_parts(tmp_path, template, monkeypatch):
    path = tmp_path / "list.csv"
    path.write_text("load [N]\n" + "".join(f"{20 + n}\n" for n in range(7)))
    contacts = read_contacts(path, template)
    asked: list[int] = []

    def rows(_, cases: list[Case]):
        asked.append(len(cases))
        return {}

    monkeypatch.setattr(Store, "rows", rows)
    monkeypatch.setattr("tehl.studies.answers._CHUNK", 3)
    assert [line["status"] for line in answers(contacts, Store(tmp_path / "s"))] == ["open"] * 7
    assert asked == [3, 3, 1]


def test_an_answer_that_a_row_states_itself_is_not_repeated(tmp_path, template, monkeypatch):
    path = tmp_path / "list.csv"
    path.write_text("Hertz pressure (GPa),load [N]\n0.8,\n,20\n")
    contacts = read_contacts(path, template)
    numbers = {"groups.hertz_pressure_pa": 8e8, "film.h_central_m": 1e-7}

    def rows(_, cases: list[Case]):
        return {case.key: Row(key=case.key, status="converged", summary=numbers) for case in cases}

    monkeypatch.setattr(Store, "rows", rows)
    first, second = answers(contacts, Store(tmp_path / "s"))
    assert first["Hertz pressure (GPa)"] == "0.8"
    assert "Hertz pressure [GPa]" not in first
    assert second["Hertz pressure [GPa]"] == pytest.approx(0.8)
    assert first["central film [nm]"] == second["central film [nm]"] == pytest.approx(100.0)


def test_an_answer_that_is_uncertain_names_what_remains_open(tmp_path, template, monkeypatch):
    path = tmp_path / "list.csv"
    path.write_text("load [N]\n20\n")
    known = {"message": "The pressure has no limit.", "hint": Hint("Relieve the ends.")}

    def rows(_, cases: list[Case]):
        return {case.key: Row(key=case.key, status="converged", **known) for case in cases}

    monkeypatch.setattr(Store, "rows", rows)
    (line,) = answers(read_contacts(path, template), Store(tmp_path / "s"))
    assert line["obtained"].endswith("The pressure has no limit. Relieve the ends.")


def test_films_of_a_list_without_a_template_have_the_default_error():
    problem, options = case_from_tables(template_tables(None)[0])
    assert settled(problem, options).target == 0.01
