"""Studies of transient runs: extremes with their times, means and ends, in one table."""

import numpy as np
import pytest
from benchmarks.pairs import contact

from tehl.api.problem import ContactProblem
from tehl.api.solvers import solve_transient
from tehl.base.errors import InputError
from tehl.contact.options import Options
from tehl.io.summary import HISTORY
from tehl.studies.case import unit_of
from tehl.studies.file import study
from tehl.studies.tables import is_number, missing_column

OPTIONS = Options(points=49)
SPEED = {"contact.entrainment_speed": ["0.4 m/s", "0.5 m/s"]}


def growing(**tables: object) -> ContactProblem:
    """Return a contact whose load grows, on steel."""
    given = contact("across").model_dump(exclude_none=True)
    given["transient"] = {"load": [[0.0, 1.0], [3e-4, 1.3]], "duration": 5e-4, "frames": 2}
    return ContactProblem.model_validate(given | tables)


@pytest.fixture(scope="module")
def table():
    return study(growing(), SPEED, OPTIONS)


def test_a_row_has_the_extremes_times_means_and_ends_of_its_run(table):
    assert list(table["status"]) == ["converged"] * 2
    history = solve_transient(growing(), OPTIONS).history
    row = table.iloc[0]
    least = int(history.film_minimum.argmin())
    assert row["film.h_min_m.value"] == history.film_minimum[least]
    assert row["film.h_min_m.time_s"] == history.time[least]
    assert row["film.h_min_m.end"] == history.film_minimum[-1]
    assert row["traction_across.least"] == history.traction_across.min()
    assert row["load_factor.largest"] == pytest.approx(1.3)
    mean = np.trapezoid(history.traction_across, history.time) / history.time[-1]
    assert row["traction_across.mean"] == pytest.approx(mean, rel=1e-12)
    assert row["start.film.h_central_m"] == pytest.approx(history.film_central[0])
    assert table["film.h_min_m.value"].is_monotonic_increasing


def test_columns_have_units_and_may_be_asked_for(table):
    units = table.attrs["units"]
    assert units["film.h_min_m.value"] == units["film.h_central_m.mean"] == "m"
    assert units["film.h_min_m.time_s"] == units["traction.least_time_s"] == "s"
    assert unit_of("drilling.moment_n_m.end") == "N m"
    assert units["traction.mean"] == "1"
    for one in HISTORY:
        assert all(map(is_number, one.columns))
    assert missing_column([], "h_min_m.value") is None
    assert missing_column([], "start.film.h_min_m") is None
    assert "no column" in str(missing_column([], "film.h_min_m.median"))


def test_keys_of_the_run_may_be_axes_and_its_steps_take_time():
    axes = {"transient.duration": ["0.1 ms", "0.3 ms"]}
    found = study(growing(), axes, OPTIONS)
    more = found["time.duration_s"].to_numpy() - [1e-4, 3e-4]  # up to the end of a step
    assert np.all((more > -1e-12) & (more < solve_transient(growing(), OPTIONS).time_step))
    with pytest.raises(InputError, match="axis title"):
        study(growing(), {"title": ["a", "b"]}, OPTIONS)


def test_a_run_that_is_not_valid_is_a_row_with_its_reason():
    found = study(growing(), {"transient.stride": [1, 8]}, OPTIONS)
    assert list(found["status"]) == ["converged", "bad_input"]
    assert "too long for" in found["message"][1]
