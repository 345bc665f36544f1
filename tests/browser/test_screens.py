"""Views fit into the window at the widths of a desk, a tablet and a phone.

``SCREENS=docs/_static`` stores the screenshots of the guide.
"""

import os
from itertools import product
from pathlib import Path

import pytest
from PIL import Image

from tehl.explore.case_text import CaseText
from tehl.io.templates import template_text
from tests.browser.conftest import solved, type_into, until

SCREENS = os.environ.get("SCREENS")
SIZES = {"desk": (1440, 900), "tablet": (1024, 768), "phone": (390, 844)}
VIEWS = ("Film", "Pressure", "Centre lines", "Temperature", "Interferogram", "Curves", "Movie")


@pytest.fixture
def page(context, served):
    page = context.new_page()
    page.goto(f"{served.address}&case={CaseText(template_text('thermal')).packed}")
    solved(page)
    return page


def store(page, name):
    """Store a screenshot for the guide."""
    if SCREENS:
        path = Path(SCREENS) / f"{name}.png"
        page.mouse.move(720, 5)
        page.wait_for_timeout(600)
        page.screenshot(path=path)
        with Image.open(path) as image:
            image.convert("RGB").quantize(256, dither=Image.Dither.NONE).save(path, optimize=True)


def test_no_view_is_wider_than_the_window(page):
    for scheme, (width, height) in product(("light", "dark"), SIZES.values()):
        page.set_viewport_size({"width": width, "height": height})
        page.emulate_media(color_scheme=scheme)
        check_widths(page, width)


def check_widths(page, width):
    for view in VIEWS:
        page.get_by_role("tab", name=view, exact=True).click()
        page.locator(f'.q-tab--active:has-text("{view}")').wait_for()
        page.wait_for_timeout(100)
        until(lambda: page.evaluate("document.documentElement.scrollWidth") <= width)


def test_on_a_phone_the_header_is_one_line_and_the_main_numbers_stay_in_sight(page):
    page.set_viewport_size({"width": 390, "height": 844})
    until(lambda: page.locator(".top").bounding_box()["height"] < 60)
    slider = page.get_by_role("slider", name="slide-to-roll ratio")
    slider.scroll_into_view_if_needed()
    page.evaluate("window.scrollBy(0, 200)")
    numbers = page.locator(".main-numbers")
    before, box = numbers.inner_text(), numbers.bounding_box()
    assert box["y"] > 700
    assert box["y"] + box["height"] <= 844
    slider.locator('[tabindex="0"]').focus()
    for _ in range(5):  # one step may change less than the digits shown
        page.keyboard.press("ArrowLeft")
    until(lambda: numbers.inner_text() != before)


def test_the_screenshots_of_the_guide(page):
    store(page, "explore")
    page.get_by_role("button", name="Pin", exact=True).click()
    type_into(page, "Hertz pressure", "0.6")
    until(lambda: "−2" in page.locator('[data-key="p_max"] .change').inner_text())
    solved(page)
    store(page, "explore-compare")
    page.get_by_role("button", name="Unpin").click()
    page.get_by_role("button", name="undo").click()
    page.get_by_role("button", name="curve of the friction").click()
    page.get_by_text("13 of 13 points").wait_for()
    store(page, "explore-curve")
    assert page.locator(".curves svg circle.point").count() == 13
