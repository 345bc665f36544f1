"""The numbers of a state beside those of a pinned one."""

from dataclasses import replace

import pytest

pytest.importorskip("nicegui", reason="needs pip install 'tehl[explore]'")

from tehl.explore.number_panel import number_html
from tehl.explore.numbers import Number


@pytest.mark.parametrize(
    ("unit", "words"), [("nm", "−20.0 % from pinned 50"), ("°C", "−10.0 K from pinned 50")]
)
def test_a_temperature_changes_by_kelvins_and_another_quantity_by_a_share(unit, words):
    one = Number(key="a", name="a", symbol="a", value=40.0, unit=unit)
    assert words in number_html(one, replace(one, value=50.0))
