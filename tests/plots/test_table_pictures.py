"""Curves and maps of the table of a study."""

import math

import numpy as np
import pandas as pd
import pytest

from tehl.base.errors import InputError
from tehl.plots import contour_map, curves, film_deviations, moes_map
from tehl.plots.table_columns import find_column, numbers
from tehl.plots.table_curves import overlay

UNITS = {"contact.load": "N", "film.h_min_m": "m", "traction.mid_film": "1"}


@pytest.fixture
def table() -> pd.DataFrame:
    loads = [80.0, 20.0, 40.0] * 2
    frame = pd.DataFrame(
        {
            "contact.load": loads,
            "lubricant.shear": ["newtonian"] * 3 + ["eyring"] * 3,
            "status": ["converged"] * 5 + ["stalled"],
            "laws.shear": ["newtonian"] * 3 + ["eyring"] * 3,
            "film.h_min_m": [1e-9 * load for load in loads],
            "traction.mid_film": [-1e-3 * load for load in loads],
            "uncertainty.film.h_min_m.value": [1.01e-9 * load for load in loads],
            "uncertainty.film.h_min_m.uncertainty": [2e-11 * load for load in loads],
        }
    )
    frame.attrs["units"] = UNITS
    return frame


def drawn(figure) -> list[tuple[list[float], list[float]]]:
    lines = [bar.lines[0] for bar in figure.axes[0].containers]
    return [(list(line.get_xdata()), list(line.get_ydata())) for line in lines]


def test_a_curve_runs_along_x_with_certified_values_and_their_bars(table):
    figure = curves(table, "contact.load", "film.h_min_m", "lubricant.shear")
    first, second = drawn(figure)
    assert first[0] == [20.0, 40.0, 80.0]
    assert first[1] == pytest.approx([20.2, 40.4, 80.8])  # nm
    assert second[0] == [20.0, 80.0]  # the third failed
    bars = figure.axes[0].containers[0].lines[2][0].get_segments()
    assert np.ptp(bars[0][:, 1]) == pytest.approx(2 * 0.4)
    axes = figure.axes[0]
    assert axes.get_ylabel() == "minimum film thickness $h_{min}$ [nm]"
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["newtonian", "eyring"]
    assert figure.get_supxlabel() == "1 of 6 cases failed and are left out"


def test_an_axis_that_is_not_named_distinguishes_curves(table):
    first, second = drawn(curves(table, "contact.load", "film.h_min_m"))
    assert first[0] == [20.0, 40.0, 80.0]
    assert second[0] == [20.0, 80.0]


def test_cases_that_no_column_distinguishes_are_points_without_a_line(table):
    plain = table.drop(columns=["lubricant.shear"])
    bars = curves(plain, "contact.load", "film.h_min_m").axes[0].containers
    assert [bar.lines[0].get_linestyle() for bar in bars] == ["None"]


def test_samples_are_points_without_a_line(table):
    sampled = table.drop(columns=["lubricant.shear"])[:3].assign(speed=[1.0, 2.0, 3.0])
    sampled.insert(1, "contact.entrainment_speed", sampled.pop("speed"))
    bars = curves(sampled, "contact.load", "film.h_min_m").axes[0].containers
    assert [bar.lines[0].get_linestyle() for bar in bars] == ["None"]
    zipped = sampled.assign(**{"contact.entrainment_speed": [3.0, 1.0, 2.0]})
    bars = curves(zipped, "contact.load", "film.h_min_m").axes[0].containers
    assert [bar.lines[0].get_linestyle() for bar in bars] == ["-"]


@pytest.mark.parametrize(
    ("column", "error", "value"),
    [("film.h_min_m", "minimum", 20.0), ("traction.mid_film", "traction_mid_film", 0.02)],
)
def test_the_bar_of_a_value_that_is_not_certified_is_its_estimated_error(
    table, column, error, value
):
    uncertified = table[[n for n in table if not n.startswith("uncertainty")]]
    uncertified = uncertified.assign(**{f"errors.{error}": 0.05})
    uncertified.attrs = table.attrs
    bars = curves(uncertified, "contact.load", column).axes[0].containers[0]
    segments = bars.lines[2][0].get_segments()
    assert np.ptp(segments[0][:, 1]) == pytest.approx(2 * 0.05 * value)


def test_curves_have_the_title_of_their_study(table):
    axes = curves(table, "contact.load", "film.h_min_m", title="costs $5").axes[0]
    assert axes.get_title() == r"costs \$5"


def test_a_minus_turns_the_sign_and_short_names_suffice(table):
    figure = curves(table, "load", "-mid_film", hue="shear", log="xy")
    assert drawn(figure)[0][1] == pytest.approx([0.02, 0.04, 0.08])
    assert figure.axes[0].get_xscale() == "log"


def test_an_axis_precedes_a_number_of_the_same_name(table):
    assert find_column(table, "shear") == "lubricant.shear"
    assert find_column(table, "h_min_m") == "film.h_min_m"


@pytest.mark.parametrize(
    ("x", "y", "words"),
    [
        ("load", "h_mni", "no column h_mni"),
        ("load", "film.h_central_m", "no column film.h_central_m"),
        ("load", "laws.shear", "does not hold numbers"),
    ],
)
def test_columns_that_cannot_be_drawn_raise_an_input_error(table, x, y, words):
    with pytest.raises(InputError, match=words):
        curves(table, x, y)


def test_a_similar_column_is_suggested(table):
    with pytest.raises(InputError, match=r"did you mean film\.h_min_m"):
        curves(table, "load", "h_min")


def test_a_table_without_converged_cases_has_no_picture(table):
    table["status"] = "stalled"
    with pytest.raises(InputError, match="no case that converged"):
        curves(table, "load", "film.h_min_m")


@pytest.mark.parametrize(("limit", "unit", "factor"), [(2e-8, "nm", 1e9), (2e-6, "µm", 1e6)])
def test_lengths_are_shown_in_a_fitting_unit(table, limit, unit, factor):
    table["film.h_min_m"] = np.linspace(0.0, limit, 6)
    column = numbers(table, "film.h_min_m")
    assert (column.unit, column.factor) == (unit, factor)


def test_measured_points_are_converted_to_the_units_of_the_picture(table, tmp_path):
    path = tmp_path / "lab.csv"
    lines = ("load [kN], film [um], error [nm], name", "0.02, 0.021, 1, lab", "0.04, 0.04, 2, b")
    path.write_text("\n".join(lines))
    figure = curves(table, "load", "h_min_m")
    overlay(figure, table, "load", "h_min_m", path=path)
    assert drawn(figure)[-2] == ([20.0], pytest.approx([21.0]))
    assert figure.axes[0].get_legend_handles_labels()[1][-2:] == ["lab", "b"]


def test_temperatures_are_in_degrees_celsius_and_rises_in_kelvin(table, tmp_path):
    table.insert(0, "lubricant.temperature", [313.15, 313.15, 313.15, 353.15, 353.15, 353.15])
    table["temperature.film_rise_max_k"] = 20.0
    table.attrs["units"] = UNITS | {
        "lubricant.temperature": "K",
        "temperature.film_rise_max_k": "K",
    }
    assert numbers(table, "film_rise_max_k").unit == "K"
    assert list(numbers(table, "lubricant.temperature").values[::5]) == pytest.approx([40.0, 80.0])
    figure = curves(table, "load", "h_min_m", "lubricant.temperature")
    words = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert words == ["temperature = 40 °C", "temperature = 80 °C"]
    path = tmp_path / "lab.csv"
    path.write_text("load [kN],temperature [degC],error [degC]\n0.02,50,2\n")
    figure = curves(table, "load", "lubricant.temperature")
    overlay(figure, table, "load", "lubricant.temperature", path=path)
    assert drawn(figure)[-1] == ([20.0], pytest.approx([50.0]))
    bars = figure.axes[0].containers[-1].lines[2][0].get_segments()
    assert np.ptp(bars[0][:, 1]) == pytest.approx(4.0)


def test_measured_points_of_a_spreadsheet_may_have_decimal_commas(table, tmp_path):
    path = tmp_path / "lab.csv"
    path.write_text("load [kN];film [um];error [nm]\n0,02;0,021;1\n0,04;0,04;\n", encoding="utf-16")
    figure = curves(table, "load", "h_min_m")
    overlay(figure, table, "load", "h_min_m", path=path)
    assert drawn(figure)[-1] == ([20.0, 40.0], pytest.approx([21.0, 40.0]))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("load,film [s]\n1,2\n", r"the unit of film\.h_min_m such as m"),
        ("load\n1\n", "give two columns"),
        ("load,film\n1,thin\n", "does not hold numbers"),
        ("", "give two columns"),
    ],
)
def test_invalid_measured_points_raise_an_input_error(table, tmp_path, text, words):
    path = tmp_path / "lab.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=words):
        overlay(curves(table, "load", "h_min_m"), table, "load", "h_min_m", path=path)


@pytest.fixture
def films() -> pd.DataFrame:
    """Films of a power law over M and L, one of them failed."""
    lines = []
    for load in (10.0, 100.0, 1000.0):
        for speed in (1.0, 5.0, 20.0):
            u = (speed / 5000.0) ** 4 / 2
            lines.append(
                {
                    "status": "stalled" if (load, speed) == (1000.0, 20.0) else "converged",
                    "groups.M": load,
                    "groups.L": speed,
                    "groups.U": u,
                    "groups.W": load * (2 * u) ** 0.75,
                    "groups.G": 5000.0,
                    "groups.lambda_bar": 0.1,
                    "groups.alpha_bar": 10.0,
                    "groups.ellipticity": 1.0,
                    "groups.radius_ratio": 1.0,
                    "film.H_central_moes": 1.7 * speed**0.5 * load**-0.1,
                    "film.H_min_moes": 1.0 * speed**0.5 * load**-0.2,
                }
            )
    frame = pd.DataFrame(lines)
    frame.attrs["units"] = {}
    return frame


def test_deviations_are_those_of_the_formulas(films):
    off = film_deviations(films)["Hamrock, Dowson: central"]
    row = films.iloc[4]
    u, w = row["groups.U"], row["groups.W"]
    ratio = 2.69 * u**0.67 * 5000**0.53 * w**-0.067 * (1 - 0.61 * math.exp(-0.73))
    assert off[4] == pytest.approx(
        100 * (ratio / math.sqrt(2 * u) / row["film.H_central_moes"] - 1)
    )
    assert len(off) == 8


def test_the_moes_map_has_a_panel_of_the_film_and_one_per_formula(films):
    titles = [axes.get_title() for axes in moes_map(films).axes]
    assert sum("central" in title or "minimum" in title for title in titles) == 6


def test_a_contour_map_needs_an_area(films):
    assert contour_map(films, "M", "L", "H_central_moes", "xy").axes
    line = films[films["groups.M"] == 10.0]
    line.attrs["units"] = {}
    with pytest.raises(InputError, match="not in one line"):
        contour_map(line, "M", "L", "H_central_moes")
