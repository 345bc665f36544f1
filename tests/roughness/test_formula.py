"""Surfaces by a formula of the user."""

import numpy as np
import pytest
from pydantic import BaseModel, ValidationError

from tehl.base.errors import InputError
from tehl.roughness import AnyRoughness, Formula, Pocket, Wave


class Body(BaseModel):
    roughness: AnyRoughness


def stated(formula, **keys):
    return Body.model_validate(
        {"roughness": {"type": "formula", "formula": formula} | keys}
    ).roughness


X, Y = np.linspace(-4e-4, 4e-4, 41)[None, :], np.linspace(-3e-4, 3e-4, 31)[:, None]


@pytest.mark.parametrize("text", ["0.2 um * cos(2*pi*x/(0.1 mm))", "0.2um*cos(360 deg*x/0.1 mm)"])
def test_a_formula_of_a_wave_is_the_wave(text):
    found, wave = stated(text), Wave(amplitude=2e-7, wavelength=1e-4)
    for time, speed in ((0.0, 0.0), (1e-5, 1.5)):
        np.testing.assert_allclose(
            found.height(X, Y, time, speed), wave.height(X, Y, time, speed), atol=1e-20
        )
    assert found.shortest_wavelengths == (pytest.approx(1e-4, rel=0.01), np.inf)
    assert found.is_even_in_y
    assert not found.is_smooth
    assert found.rms == pytest.approx(wave.rms, rel=0.02)


def test_a_formula_of_a_pocket_is_the_pocket():
    found = stated("-1 um * cos(pi*r/(2*40 um)) * exp(-2*(r/(40 um))^2)")
    pocket = Pocket(amplitude=-1e-6, radius=4e-5)
    np.testing.assert_allclose(found.height(X, Y), pocket.height(X, Y), atol=1e-20)
    assert found.shortest_wavelength == pytest.approx(pocket.shortest_wavelength, rel=0.3)


def test_a_tilted_wave_is_not_even_and_a_stated_wavelength_counts():
    found = stated("100 nm * cos((x + y)/(10 um))", wavelength="50 um")
    assert not found.is_even_in_y
    assert found.shortest_wavelengths == (5e-5, 5e-5)
    assert stated("0 um").is_smooth


def test_a_formula_is_stored_and_read_again():
    found = stated("min(0 um, 1e-7 * abs(x) - 20 nm)")
    assert Formula.model_validate_json(found.model_dump_json()) == found


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("cos(x)", "takes cos of a length"),
        ("cos(x/(1 mm))", "is a plain number, but heights are a length"),
        ("x*y", "is an area"),
        ("x + 1", "adds a length and a plain number"),
        ("1 um * foo(x)", "the function 'foo'"),
        ("1 um * z", "unknown name 'z'"),
        ("__import__('os').system('true')", "not allowed"),
        ("(1 um).__class__", "not allowed"),
        ("1 um *", "is not a formula"),
        ("[x for x in y]", "not allowed"),
        ("1 um if x else 2 um", "not allowed"),
        ("(lambda: x)()", "not allowed"),
        ("1 um * 9**9**9", "exponent"),
        ("x**(x/(1 um))", "exponent that is not a constant"),
        ("1 um / (x - x) * (1 um)", "not finite at x"),
        ("1 um * log(0*x/(1 um))", "not finite at x"),
        ("1 mm * cos(x/(1 um))", "is not small beside wavelength"),
        ("(" * 205 + "x" + ")" * 205, "is not a formula"),
        ("x+" * 240 + "x", "more than 200 parts"),
        ("x" * 600, "more than 500 characters"),
        ("", "is not a formula"),
    ],
)
def test_what_is_not_a_formula_is_one_sentence(text, words):
    with pytest.raises(ValidationError, match=words) as error:
        stated(text)
    assert len(error.value.errors()) == 1


def test_a_height_that_is_not_finite_on_a_grid_is_reported():
    pole = stated("1 nm * (0.1 mm) / hypot(x - 1.234567 mm, y)")
    with pytest.raises(InputError, match="not finite at x = 1235 um, y = 0 um"):
        pole.height(np.array([[1.234567e-3]]), np.array([[0.0]]))
