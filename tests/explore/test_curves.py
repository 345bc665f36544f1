"""The ends of a sweep are finite numbers in order, or a sentence says what is wrong."""

import pytest

pytest.importorskip("nicegui", reason="needs pip install 'tehl[explore]'")

from tehl.errors import InputError
from tehl.explore.curve_panel import ends


def test_ends_are_read_with_a_point_or_a_comma():
    assert ends("0.5", "1,5") == (0.5, 1.5)


@pytest.mark.parametrize(
    ("low", "high", "words"),
    [
        ("", "2", "must be numbers"),
        ("nan", "2", "finite"),
        ("1", "inf", "finite"),
        ("5", "1", "below to = 1"),
    ],
)
def test_other_ends_are_a_sentence(low, high, words):
    with pytest.raises(InputError, match=words):
        ends(low, high)
