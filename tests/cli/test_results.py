"""``tehl plot``, ``export`` and ``report``: stored results in, files out."""

from dataclasses import asdict

import pytest

from tehl.cli.reference_runs import smooth_beside, smooth_file
from tehl.io.store import save
from tehl.plots import film_map
from tehl.post.micro_film import roughness_effect
from tests.fixtures_transient import make_transient


@pytest.fixture
def stored(result, tmp_path):
    save(result, tmp_path / "ball.nc")
    return tmp_path / "ball.nc"


@pytest.mark.parametrize(
    ("kind", "name"),
    [("csv", "ball.csv"), ("vtk", "ball.vtr"), ("npz", "ball.npz"), ("mat", "ball.mat")],
)
def test_exports_land_beside_the_result(stored, run, kind, name):
    done = run("export", str(stored), "--to", kind)
    assert done.code == 0
    assert sorted(path.name for path in stored.parent.iterdir()) == sorted(["ball.nc", name])


def test_csv_fields_are_written_on_request(stored, run):
    run("export", str(stored), "--to", "csv", "--what", "fields", "-o", str(stored) + ".csv")
    assert len((stored.parent / "ball.nc.csv").read_text().splitlines()) == 1 + 65**2


def test_the_ending_of_the_output_selects_the_format(stored, run):
    assert run("export", str(stored), "-o", str(stored.parent / "film.vtr")).code == 0
    assert (stored.parent / "film.vtr").read_text().startswith("<?xml")


@pytest.mark.parametrize("words", [[], ["-o", "film.txt"], ["--to", "vtk", "-o", "film.vtk"]])
def test_a_format_that_is_missing_or_does_not_match_is_bad_input(stored, run, words):
    done = run("export", str(stored), *words)
    assert done.code == 2
    assert done.err.count("\n") == 1


def test_an_unknown_format_is_bad_input(stored, run):
    unknown = run("export", str(stored), "--to", "xls")
    assert unknown.code == 2
    assert "'--to': 'xls' is not one of 'csv', 'vtk', 'npz', 'mat'" in unknown.err


def test_plots_land_in_the_folder(stored, run, monkeypatch):
    monkeypatch.setattr("tehl.plots.PICTURES", {"film": film_map})
    assert run("plot", str(stored), "-o", str(stored.parent / "pictures"), "--dpi", "40").code == 0
    assert [p.name for p in (stored.parent / "pictures").iterdir()] == ["film.png"]


def test_one_picture_lands_in_a_file_of_any_format(stored, run):
    target = stored.parent / "film.svg"
    done = run("plot", str(stored), "-o", str(target), "--only", "film", "--no-title")
    assert done.out == f"{target}\n"
    assert target.read_text().startswith("<?xml")
    several = run("plot", str(stored), "-o", str(target), "--only", "film,pressure")
    assert several.code == 2
    assert "a file holds one picture, not 2; choose one by --only" in several.err


def test_pictures_are_listed_chosen_and_drawn_in_a_format(stored, run):
    names = run("plot", str(stored), "--list").out.split()
    assert names[:2] == ["film", "pressure"]
    assert not (stored.parent / "ball_plots").exists()
    assert run("plot", str(stored), "--only", "film", "--format", "pdf").code == 0
    assert [path.name for path in (stored.parent / "ball_plots").iterdir()] == ["film.pdf"]
    done = run("plot", str(stored), "--only", "temperature")
    assert done.code == 2
    assert "picture temperature: unknown; the result has film" in done.err


def test_the_report_lands_beside_the_result(stored, run, monkeypatch):
    monkeypatch.setattr("tehl.report.page.CAPTIONS", {})
    assert run("report", str(stored)).code == 0
    assert "<!DOCTYPE html>" in (stored.parent / "ball.html").read_text(encoding="utf-8")


def test_the_smooth_film_beside_a_rough_one_is_taken_if_it_fits(rough, smooth, result, tmp_path):
    stored = tmp_path / "wavy.nc"
    assert smooth_file(stored).name == "wavy.smooth.nc"
    assert smooth_beside(stored, rough) is None
    save(smooth, smooth_file(stored))
    assert smooth_beside(stored, rough) is not None
    assert smooth_beside(stored, smooth) is None  # it has no roughness to show
    save(result, smooth_file(stored))
    assert smooth_beside(stored, rough) is None  # it lies on another grid
    smooth_file(stored).write_text("broken")
    assert smooth_beside(stored, rough) is None


def test_the_report_of_a_rough_result_shows_what_roughness_does(
    rough, smooth, tmp_path, run, monkeypatch
):
    monkeypatch.setattr("tehl.report.page.CAPTIONS", {})
    block = {"roughness_effect": asdict(roughness_effect(rough, smooth))}
    save(rough, tmp_path / "wavy.nc", extra=block)
    assert run("report", str(tmp_path / "wavy.nc")).code == 0
    page = (tmp_path / "wavy.html").read_text(encoding="utf-8")
    assert "Film with roughness and without" in page


@pytest.mark.parametrize("command", [["export", "--to", "csv"], ["report"]])
def test_the_result_itself_is_never_replaced(stored, run, command):
    stored = stored.rename(stored.with_suffix(".csv"))
    before = stored.read_bytes()
    done = run(command[0], str(stored), *command[1:], "-o", str(stored))
    assert done.code == 2
    assert "same file as the input" in done.err
    assert stored.read_bytes() == before


@pytest.mark.parametrize("command", [["plot"], ["export", "--to", "csv"], ["report"]])
@pytest.mark.parametrize("damage", ["truncated", "foreign", "missing"])
def test_a_file_that_is_not_a_result_is_bad_input(stored, run, command, damage):
    content = {"truncated": stored.read_bytes()[:5000], "foreign": b"title = 1"}
    stored.unlink()
    if damage in content:
        stored.write_bytes(content[damage])
    done = run(command[0], str(stored), *command[1:])
    assert done.code == 2
    assert "ball.nc" in done.err
    assert done.err.count("\n") == 1
    assert len(list(stored.parent.iterdir())) == (damage in content)


@pytest.mark.parametrize("command", ["plot", "animate", "export", "report"])
def test_a_missing_name_of_a_result_is_the_current_folder(tmp_path, run, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    done = run(command, "")  # of an empty variable of the shell
    assert done.code == 2
    assert "is a folder; expected a result file such as film.nc" in done.err


@pytest.mark.parametrize(
    ("words", "names"),
    [
        (("--to", "csv"), ["run.csv"]),
        (("--to", "npz"), ["run.npz"]),
        (("-o", "film.pvd"), ["film.pvd", *(f"film_000{number}.vtr" for number in range(4))]),
    ],
)
def test_a_transient_result_is_exported_too(tmp_path, run, monkeypatch, words, names):
    monkeypatch.chdir(tmp_path)
    make_transient().save("run.nc")
    done = run("export", "run.nc", *words)
    assert done.code == 0
    assert done.out.split() == names
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(["run.nc", *names])


def test_a_report_is_not_written_into_a_pdf(stored, run):
    done = run("report", str(stored), "-o", str(stored.with_suffix(".pdf")))
    assert done.code == 2
    assert "a report ends in .html" in done.err
    assert not stored.with_suffix(".pdf").exists()
