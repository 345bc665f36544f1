"""``tehl surface`` as a user meets it."""

import json
import zipfile

import numpy as np
import pytest

from tehl.plots.surface import surface_preview
from tehl.roughness import Map
from tehl.roughness.preview import Mesh, preview
from tests.cli.test_main import run
from tests.roughness.files import relief, write_x3p

STATED = ("--unit", "um", "--pixel", "2 um")


@pytest.fixture
def file(tmp_path):
    np.save(tmp_path / "map.npy", relief(48, 64) * 1e6)
    return str(tmp_path / "map.npy")


@pytest.fixture
def case(monkeypatch, capsys, tmp_path):
    run(monkeypatch, "new", "ball-on-disc")
    path = tmp_path / "case.toml"
    path.write_text(capsys.readouterr().out, encoding="utf-8")
    return str(path)


def numbers(monkeypatch, capsys, *arguments):
    assert run(monkeypatch, "surface", *arguments, "--json") == 0
    return json.loads(capsys.readouterr().out)


def test_a_surface_is_described_in_numbers(monkeypatch, capsys, file):
    found = numbers(monkeypatch, capsys, file, *STATED)
    heights = Map(file=file, unit="um", pixel="2 um").load().values
    assert found["Sq_m"] == pytest.approx(heights.std())
    assert found["size_m"] == pytest.approx([128e-6, 96e-6])
    assert found["points"] == [64, 48]
    assert (found["lost_share"], found["questions"]) == (None, [])


def test_a_surface_is_described_in_words(monkeypatch, capsys, file):
    assert run(monkeypatch, "surface", file, *STATED, "--half-width", "20 um") == 0
    words = capsys.readouterr().out
    assert all(word in words for word in ("Sq, Sa, Sz", "correlation", "variance is lost", "flat"))


def test_a_file_with_units_needs_no_options(monkeypatch, capsys, tmp_path):
    path = write_x3p(tmp_path / "map.x3p", relief())
    assert numbers(monkeypatch, capsys, str(path))["pixel_m"] == [2e-6, 3e-6]


def test_keys_of_a_map_are_options_too(monkeypatch, capsys, file):
    level = ("--level", "quadratic", "--size", "0.128 mm, 0.096 mm", "--unit", "um")
    keys = (
        "--set",
        "lambda_s=12 um",
        "--set",
        "flip_x=true",
        "--set",
        'crop={x=["0 um", "64 um"]}',
    )
    found = numbers(monkeypatch, capsys, file, *level, *keys)
    plain = numbers(monkeypatch, capsys, file, *STATED)
    assert found["size_m"] == pytest.approx([64e-6, 96e-6])
    assert found["mean_wavelength_m"] > plain["mean_wavelength_m"]


def test_keys_of_tables_have_dots_as_in_a_case(monkeypatch, capsys, file):
    keys = ("--set", 'crop.x=["0 um", "64 um"]', "--set", 'crop.y=["32 um", "64 um"]')
    found = numbers(monkeypatch, capsys, file, *STATED, *keys)
    assert found["size_m"] == pytest.approx([64e-6, 32e-6])


def test_a_turned_and_moved_map_is_reported(monkeypatch, capsys, file):
    keys = ("--set", "rotate=30 deg", "--set", "x=0.1 mm")
    assert run(monkeypatch, "surface", file, *STATED, *keys) == 0
    words = capsys.readouterr().out
    assert "turned by 30 deg, its middle at x = 100 um, y = 0 um" in words
    assert "along its x and y" in words
    found = numbers(monkeypatch, capsys, file, *STATED, *keys)
    assert found["middle_m"] == [1e-4, 0.0]
    assert found["rotate_rad"] == pytest.approx(np.pi / 6)
    assert run(monkeypatch, "surface", file, *STATED) == 0
    assert "placed" not in capsys.readouterr().out


def test_the_form_that_was_removed_is_reported(monkeypatch, capsys, file):
    keys = ("--level", "quadratic", "--set", "lambda_s=12 um")
    assert run(monkeypatch, "surface", file, *STATED, *keys) == 0
    words = capsys.readouterr().out
    assert 'a quadratic form by least squares (level = "quadratic")' in words
    assert "Gaussian, lambda_s = 12 um" in words
    assert run(monkeypatch, "surface", file, *STATED) == 0
    assert "Gaussian" not in capsys.readouterr().out
    found = numbers(monkeypatch, capsys, file, *STATED, *keys)
    assert (found["level"], found["lambda_c_m"]) == ("quadratic", None)
    assert found["lambda_s_m"] == pytest.approx(12e-6)


@pytest.mark.parametrize("beside", [(), ("--half-width", "40 um")])
def test_a_remaining_form_is_reported(monkeypatch, capsys, tmp_path, beside):
    x = (np.arange(64) - 31.5) * 2e-6
    np.save(tmp_path / "ball.npy", 1e6 * (-(x**2) / 0.04 - (x[:48, None]) ** 2 / 0.04))
    found = numbers(monkeypatch, capsys, str(tmp_path / "ball.npy"), *STATED, *beside)
    assert [one for one in found["questions"] if "20 mm along x" in one]


def test_more_points_lose_less(monkeypatch, capsys, file):
    lost = [
        numbers(monkeypatch, capsys, file, *STATED, "--half-width", "20 um", "--points", count)[
            "lost_share"
        ]
        for count in ("9", "17", "65")
    ]
    assert lost[0] > lost[1] > lost[2]


def test_the_contact_of_a_case_is_compared(monkeypatch, capsys, file, case):
    found = numbers(monkeypatch, capsys, file, *STATED, "--contact", case, "--points", "65")
    coarse = numbers(monkeypatch, capsys, file, *STATED, "--contact", case, "--points", "33")
    assert coarse["mesh_m"] == pytest.approx([2 * step for step in found["mesh_m"]])
    assert "smaller than the contact" in found["questions"][0]


def test_a_line_takes_the_heights_at_its_middle(monkeypatch, capsys, file, tmp_path):
    run(monkeypatch, "new", "line")
    text = capsys.readouterr().out.replace("rms_roughness", "# rms_roughness")
    rough = f'roughness = {{ type = "map", file = "{file}", unit = "um", pixel = "2 um" }}'
    path = tmp_path / "line.toml"
    path.write_text(text.replace("[surface_1]", f"[surface_1]\n{rough}"), encoding="utf-8")
    found = numbers(monkeypatch, capsys, file, *STATED, "--contact", str(path))
    assert found["mesh_m"][0] == found["mesh_m"][1]
    (said,) = (one for one in found["questions"] if "smaller" in one)
    assert "x 96 um and the contact of 150 um" in said
    assert run(monkeypatch, "explain", str(path)) == 0
    assert "numerics.points" not in capsys.readouterr().out


def test_the_picture_is_written_and_the_file_stays(monkeypatch, capsys, file, tmp_path):
    picture = tmp_path / "map.png"
    assert run(monkeypatch, "surface", file, *STATED, "-o", str(picture)) == 0
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert str(picture) in capsys.readouterr().out
    assert run(monkeypatch, "surface", file, *STATED, "-o", file) == 2
    assert np.load(file).shape == (48, 64)


@pytest.mark.parametrize("shape", [(48, 64), (30, 90), (90, 30)])
def test_the_picture_has_map_histogram_and_spectrum(tmp_path, shape):
    np.save(tmp_path / "map.npy", relief(*shape) * 1e6)
    surface = Map(file=str(tmp_path / "map.npy"), unit="um", pixel="2 um")
    mesh = Mesh(spacing=(4e-6, 4e-6), half_widths=(2e-5, 2e-5), points=(65, 65))
    picture = surface_preview(preview(surface, mesh))
    picture.draw_without_rendering()
    labels = {axes.get_xlabel() for axes in picture.axes}
    assert {"x along entrainment [µm]", "wavelength [µm]"} <= labels
    axes = next(one for one in picture.axes if one.get_xlabel() == "x along entrainment [µm]")
    assert axes.get_aspect() == 1.0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("{}",), "does not state the unit"),
        (("{}",), 'give --unit "um"'),
        (("{}", "--unit", "um"), "how far its points are apart"),
        (("{}", "--unit", "um"), 'give --pixel "2 um", or --size "1 mm, 1 mm"'),
        (("{}", "--unit", "kg"), 'unit = "kg": is not a unit of length'),
        (("{}", *STATED, "--level", "flat"), 'level = "flat": unknown; known are none'),
        (("{}", *STATED, "--set", "shape=1"), "shape is not a known key"),
        (("{}", *STATED, "--set", "shape"), "invalid override"),
        (("{}", *STATED, "--set", "crop..x=1"), "expected key.path=value"),
        (("{}", *STATED, "--set", "crop.z=1"), "crop.z is not a known key"),
        (("{}", *STATED, "--points", "65"), "--points needs a contact"),
        (("{}", *STATED, "--half-width", "2 N"), "--half-width = '2 N': has the unit of a force"),
        (("{}", *STATED, "--half-width", "2 um", "--contact", "a"), "both state a contact"),
        (("{}x",), "no map"),
        (("/",), "is a folder"),
    ],
)
def test_invalid_input_is_reported_in_one_sentence(monkeypatch, capsys, file, arguments, words):
    assert run(monkeypatch, "surface", *(part.format(file) for part in arguments)) == 2
    printed = capsys.readouterr()
    assert words in printed.err
    assert printed.err.count("\n") == 1
    assert printed.out == ""


def test_damaged_files_are_reported_in_one_sentence(monkeypatch, capsys, tmp_path):
    write_x3p(tmp_path / "a.x3p", relief(), method=zipfile.ZIP_LZMA)
    whole = (tmp_path / "a.x3p").read_bytes()
    place = whole.index(b"bindata/data.bin") + 16 + 40
    (tmp_path / "a.x3p").write_bytes(whole[:place] + b"\0\0\0\0" + whole[place + 4 :])
    write_x3p(tmp_path / "b.x3p", relief(), encoding="rot13")
    with (tmp_path / "c.npy").open("wb") as file:
        header = {"descr": "<f8", "fortran_order": False, "shape": (-5, -5)}
        np.lib.format.write_array_header_1_0(file, header)
    for name in ("a.x3p", "b.x3p", "c.npy"):
        assert run(monkeypatch, "surface", str(tmp_path / name), *STATED) == 2
        printed = capsys.readouterr()
        assert name in printed.err
        assert (printed.out, printed.err.count("\n")) == ("", 1)
