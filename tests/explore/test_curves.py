"""The ends of a sweep are finite numbers in order, or a sentence says what is wrong."""

import pytest

pytest.importorskip("nicegui", reason="needs pip install 'tehl[explore]'")

from tehl.base.errors import InputError
from tehl.base.units import Force, quantity
from tehl.explore.curve_panel import ends, table_of
from tehl.explore.curves import Point, nearest, swept_chart
from tehl.explore.knobs import Knob
from tehl.explore.numbers import Number
from tehl.explore.sweeps import Swept


def test_the_value_nearest_to_the_pointer_is_read():
    points = [Point(1.0, 2.0, 0.1), Point(2.0, None), Point(3.0, 4.0)]
    frame = swept_chart(points, ("speed", "film"), (640.0, 480.0), (1.0, 3.0)).frame
    assert nearest(points, frame, frame.x(2.95)) is points[2]
    assert nearest(points, frame, frame.x(2.0)) is None


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


def test_a_sweep_is_saved_as_a_table_in_the_order_of_the_control():
    knob = Knob("contact.load", "load", quantity(Force), ("N",), (1.0, 9.0), 2.0, "N")
    film = Number(key="h_min", name="film", symbol="h", value=310.0, unit="nm", error=0.01)
    points = [Swept(2.0, (film,), ""), Swept(1.0, (film,), ""), Swept(3.0, (), "failed")]
    lines = table_of(knob, points).splitlines()
    assert lines == ["contact.load [N],h_min [nm],h_min_error", "1,310,0.01", "2,310,0.01"]
    assert table_of(knob, []).strip() == "contact.load [N]"
