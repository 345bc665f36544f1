"""Exports of ``import tehl``, and the time it takes."""

import subprocess
import sys

import pytest

import tehl
from tests.cases import moes_problem

LIGHT = ["ContactProblem", "Domain", "InputError", "Options", "Solid", "read_case_and_options"]


def fresh(script: str) -> str:
    """Return what ``script`` prints in a new process."""
    command = [sys.executable, "-c", script]
    return subprocess.run(
        command, capture_output=True, text=True, check=True, timeout=60
    ).stdout.strip()


def test_importing_the_package_loads_nothing_heavy():
    shown = fresh("import sys, tehl; print(*{name.partition('.')[0] for name in sys.modules})")
    heavy = {"numpy", "pydantic", "numba", "scipy", "xarray", "matplotlib", "typer"}
    assert not set(shown.split()) & heavy


def test_importing_the_package_takes_less_than_0_3_seconds():
    clock = "import time; t = time.process_time(); import tehl; print(time.process_time() - t)"
    assert min(float(fresh(clock)) for _ in range(3)) < 0.3


@pytest.mark.parametrize("name", LIGHT)
def test_an_export_that_states_a_case_loads_no_arrays(name: str):
    shown = fresh(f"import sys, tehl; tehl.{name}; print(*sys.modules)")
    assert not {"numpy", "numba", "scipy", "xarray"} & set(shown.split())


@pytest.mark.parametrize("name", tehl.__all__)
def test_every_export_can_be_loaded(name: str):
    assert getattr(tehl, name) is not None
    assert name in dir(tehl)


def test_only_exports_are_listed():
    assert dir(tehl) == sorted(tehl.__all__)


def test_an_unknown_export_is_an_attribute_error():
    with pytest.raises(AttributeError, match="nonsense"):
        _ = tehl.nonsense


@pytest.mark.parametrize(
    ("name", "values", "sentence"),
    [
        ("Options", {"points": 7}, "Options.points = 7: must be a whole number from 17 to 16385"),
        ("Contact", {"lod": 80}, "Contact.lod is not a known key; did you mean load?"),
        ("ContactProblem", {}, "ContactProblem.contact is missing"),
    ],
)
def test_a_mistake_of_a_call_is_one_sentence(name, values, sentence):
    with pytest.raises(tehl.InputError) as caught:
        getattr(tehl, name)(**values)
    assert str(caught.value) == sentence


def test_modules_of_post_and_pictures_are_reachable_and_loaded_on_use():
    script = (
        "import sys, tehl; tehl.post.film.profile_x; print('matplotlib' in sys.modules); "
        "tehl.plots.film_map; print('matplotlib' in sys.modules)"
    )
    assert fresh(script).split() == ["False", "True"]
    assert dir(tehl.post) == sorted(tehl.post.__all__)
    with pytest.raises(AttributeError, match="nonsense"):
        _ = tehl.post.nonsense


def test_the_programs_that_tests_start_can_be_interrupted():
    """A shell starts commands in the background with SIGINT ignored, which children inherit."""
    code = (
        "import signal; signal.signal(signal.SIGINT, signal.SIG_IGN); import tests.conftest; "
        "print(signal.getsignal(signal.SIGINT) is signal.default_int_handler)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "True"


@pytest.mark.parametrize(
    "name", ["solve", "certify", "solve_passes", "solve_transient", "certify_transient"]
)
def test_a_solver_names_an_argument_that_is_not_a_case_or_options(name):
    solver = getattr(tehl, name)
    with pytest.raises(tehl.InputError, match=r"not str; tehl\.read_case reads one"):
        solver("case.toml")
    with pytest.raises(tehl.InputError, match=r"options: must be tehl\.Options, not dict"):
        solver(moes_problem(20.0, 10.0), {"error": 0.01})
    with pytest.raises(tehl.InputError, match=r"error = 1 % and numerics\.points are both stated"):
        solver(moes_problem(20.0, 10.0), tehl.Options(points=65, error=0.01))


def test_an_oil_or_a_solid_that_is_not_a_name_is_not_known():
    with pytest.raises(tehl.InputError, match=r"None is not a known oil"):
        tehl.oil(None)
    with pytest.raises(tehl.InputError, match=r"3 is not a known solid"):
        tehl.material(3)


def test_a_study_names_an_argument_that_is_not_a_case():
    with pytest.raises(tehl.InputError, match=r"not str; tehl\.read_case reads one"):
        tehl.study("case.toml", {"contact.load": ["20 N"]})
