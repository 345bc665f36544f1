"""Views fit into the window at the widths of a desk, a tablet and a phone.

``SCREENS=docs/_static`` stores the screenshots of the guide.
"""

import os
from pathlib import Path

import pytest
from PIL import Image

from tehl.io.templates import template_text
from tests.browser.conftest import DESK, case_of, solved, take, type_into, until

SCREENS = os.environ.get("SCREENS")
SIZES = (DESK, {"width": 1024, "height": 768}, {"width": 390, "height": 844})
"""Windows of a desk, a tablet and a phone."""
VIEWS = {
    "Film": "svg[aria-label^='map of the film']",
    "Pressure": "svg[aria-label^='map of the pressure']",
    "Centre lines": "svg[aria-label^='film and pressure over x']",
    "Temperature": "svg[aria-label^='temperature']",
    "Interferogram": "svg[aria-label^='interferogram']",
    "Curves": ".sweep-choices",
    "Movie": "text=This contact is steady",
}
"""What each view has that no other has."""
THERMAL = template_text("thermal")


@pytest.fixture
def page(page):
    """The shared page with a heated film."""
    take(page, THERMAL)
    until(lambda: case_of(page) == THERMAL)
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


def test_no_view_is_wider_than_the_window_in_light_and_dark(page):
    for size in SIZES:
        page.set_viewport_size(size)
        for view, found in VIEWS.items():
            page.get_by_role("tab", name=view, exact=True).click()
            page.locator(f"{found} >> visible=true").first.wait_for()
            for scheme in ("light", "dark"):
                page.emulate_media(color_scheme=scheme)
                page.locator(f"body.body--{scheme}").wait_for()
                until(lambda: page.evaluate("document.documentElement.scrollWidth <= innerWidth"))


def test_on_a_phone_the_header_is_one_line_and_the_main_numbers_stay_in_sight(page):
    page.set_viewport_size(SIZES[-1])
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
    page.get_by_role("tab", name="Curves").click()
    page.locator(".sweep-end input").nth(2).fill("13")
    page.get_by_role("button", name="curve of the friction").click()
    page.get_by_text("13 of 13 points").wait_for()
    store(page, "explore-curve")
    assert page.locator(".curves svg circle.point").count() == 13
