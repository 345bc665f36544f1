"""The live page in a browser: what an engineer does with it."""

import contextlib
import json
import math
import subprocess
import sys
from urllib.parse import urlsplit

from tehl.explore.case_text import CaseText
from tehl.explore.header import THEME
from tehl.io.templates import template_text
from tests.browser.conftest import (
    BALL,
    api,
    case_of,
    number,
    opened,
    solved,
    take,
    type_into,
    until,
)


def printed_by_solve(case, folder):
    """Return the summary that `tehl solve --json` prints."""
    path = folder / "case.toml"
    path.write_text(case)
    command = [sys.executable, "-m", "tehl", "solve", str(path), "--json", "-q"]
    out = subprocess.run(command, capture_output=True, check=True, text=True, cwd=folder).stdout
    return json.loads(out)


def test_another_load_gives_the_film_that_tehl_solve_prints(page, tmp_path):
    before = number(page, "h_central")
    type_into(page, "load", "120")
    until(lambda: number(page, "h_central") != before and page.locator(".light.good").count())
    solved(page)
    expected = printed_by_solve(BALL.replace('"80 N"', '"120 N"'), tmp_path)
    film = expected["film"]["h_central_m"] * 1e9
    until(lambda: number(page, "h_central") == f"{film:.1f}")
    assert number(page, "h_min") == f"{expected['film']['h_min_m'] * 1e9:.1f}"


def test_the_slider_moves_the_film_and_the_exact_entry_with_it(page):
    before = number(page, "h_central")
    box = page.get_by_role("slider", name="entrainment speed").bounding_box()
    middle = box["y"] + 0.5 * box["height"]
    page.mouse.move(box["x"] + 0.5 * box["width"], middle)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.6 * box["width"], middle, steps=5)
    page.locator(".status-words", has_text="65 × 65").wait_for()
    until(lambda: number(page, "h_central") != before)
    page.mouse.up()
    solved(page)
    entry = page.get_by_role("textbox", name="entrainment speed", exact=True)
    assert float(entry.input_value()) > 1.5


def test_the_keyboard_moves_a_slider(page):
    slider = page.get_by_role("slider", name="slide-to-roll ratio")
    slider.locator('[tabindex="0"]').focus()
    page.keyboard.press("ArrowRight")
    entry = page.get_by_role("textbox", name="slide-to-roll ratio", exact=True)
    until(lambda: entry.input_value() != "0")


def test_pinned_and_present_state_stand_side_by_side_with_one_scale(page):
    page.get_by_role("button", name="Pin", exact=True).click()
    type_into(page, "load", "200")
    page.locator(".change", has_text="from pinned").first.wait_for()
    until(lambda: page.locator(".change").first.inner_text()[:4] != "+0.0")
    titles = page.locator(".slot-title")
    assert titles.all_inner_texts() == ["pinned", "present"]
    assert page.get_by_role("switch", name="hold scales").get_attribute("aria-checked") == "true"
    page.get_by_role("button", name="Unpin").click()
    until(lambda: page.locator(".slot-title:visible").count() == 0)


def test_each_view_draws_and_no_request_leaves_the_machine(page, context):
    for view, found in (
        ("Pressure", "map of the pressure"),
        ("Centre lines", "film and pressure over x"),
        ("Interferogram", "interferogram in white light"),
        ("Film", "map of the film thickness"),
    ):
        page.get_by_role("tab", name=view, exact=True).click()
        page.locator(f'.slot:visible svg[aria-label^="{found}"]').wait_for()
    page.get_by_role("tab", name="Temperature").click()
    page.get_by_text("This contact is isothermal").wait_for()
    page.get_by_role("tab", name="3-D film").click()
    page.locator(".js-plotly-plot .gl-container").wait_for(state="attached")
    hosts = {urlsplit(url).hostname for url in context.requests if url.startswith(("http", "ws"))}
    assert hosts == {"127.0.0.1"}


def test_the_value_under_the_pointer_is_shown(page):
    page.get_by_role("tab", name="Film", exact=True).click()
    shown = set()
    for x in (300, 400):
        page.locator(".slot:visible .drawing > svg").hover(position={"x": x, "y": 250})
        readout = page.locator(".readout", has_text="nm").first
        until(lambda readout=readout: readout.is_visible() and readout.inner_text() not in shown)
        shown.add(readout.inner_text())


def test_a_sweep_shows_points_as_they_are_solved(page):
    page.get_by_role("button", name="curve of the central film").click()
    page.locator(".sweep-end input").nth(2).fill("5")
    page.get_by_role("button", name="Solve", exact=True).click()
    page.locator(".curves svg circle.point").first.wait_for()
    page.get_by_text("5 of 5 points").wait_for()
    until(lambda: page.locator(".curves svg circle.point").count() == 5)
    with page.expect_download() as download:
        page.get_by_role("button", name="save the table").click()
    lines = download.value.path().read_text().splitlines()
    assert lines[0].startswith("contact.entrainment_speed [m/s],h_central [nm],")
    assert len(lines) == 6
    type_into(page, "load", "90")
    page.get_by_text("The contact has changed since").wait_for()


def test_a_faulty_sweep_is_a_sentence_and_a_long_one_can_be_cancelled(page):
    page.get_by_role("tab", name="Curves").click()
    low, high, count = (page.locator(".sweep-end input").nth(k) for k in range(3))
    solve = page.get_by_role("button", name="Solve", exact=True)
    low.fill("5")
    high.fill("1")
    solve.click()
    page.get_by_text("must be below to").wait_for()
    low.fill("0.5")
    count.fill("101")
    solve.click()
    page.locator(".curves svg circle.point").first.wait_for()
    page.get_by_role("button", name="Cancel", exact=True).click()
    page.get_by_text("cancelled after").wait_for()


def test_a_saved_case_opens_again_and_the_address_reproduces_it(page, context, tmp_path):
    type_into(page, "load", "95")
    until(lambda: stated(page, "contact.load") == "95 N")
    with page.expect_download() as download:
        page.get_by_role("button", name="Save").click()
        page.get_by_text("Case, TOML").click()
    saved = tmp_path / download.value.suggested_filename
    download.value.save_as(saved)
    assert saved.read_text() == BALL.replace('"80 N"', '"95 N"')
    link = page.evaluate("location.href")
    assert CaseText.unpacked(link.partition("case=")[2]).text == saved.read_text()
    take(page, saved.read_text().replace('"95 N"', '"110 N"'), saved.name)
    entry = page.get_by_role("textbox", name="load", exact=True)
    until(lambda: entry.input_value() == "110")
    other = opened(context, link)
    assert other.get_by_role("textbox", name="load", exact=True).input_value() == "95"


def test_a_faulty_entry_is_a_sentence_beside_its_control(page):
    fault = page.locator(".knob .fault")
    entry = page.get_by_role("textbox", name="load", exact=True)
    for valid, shown in (("0.1 kN", "100"), ("80", "80")):  # another value, and the former one
        type_into(page, "load", "-3")
        fault.filter(has_text="must be positive").wait_for()
        page.get_by_text("shown is the last valid case").wait_for()
        type_into(page, "load", valid)
        until(lambda: page.locator(".knob .fault:visible").count() == 0)
        # the page writes the number into the entry, over what is typed meanwhile
        until(lambda shown=shown: entry.input_value() == shown)
        solved(page)


def test_text_that_is_not_a_case_is_a_sentence(page):
    take(page, "load = = 80")
    page.get_by_text("is not valid TOML").wait_for()


def test_a_case_cannot_read_files_of_the_machine(page):
    for name in ("/etc/hostname", "../secret.csv"):
        rough = f'roughness = {{ type = "map", file = "{name}", unit = "um", pixel = "1 um" }}\n'
        text = BALL.replace("[surface_2]", f"[surface_2]\n{rough}").replace(
            'rms_roughness = "0.01 um"', ""
        )
        take(page, text)
        refused = page.locator(".card .what", has_text="not a file of this page")
        refused.filter(has_text=name).wait_for()


def test_a_result_that_does_not_converge_says_why_and_what_to_try(page):
    take(page, BALL.replace('"80 N"', '"8000 N"').replace('error = "2 %"', "points = 33"))
    page.locator(".card .what", has_text="grid").wait_for()
    page.locator(".card .hint", has_text="hint:").wait_for()
    page.locator(".light.bad").wait_for()


def stated(page, path):
    """Return what the case in the address states at a path."""
    text = case_of(page)
    return CaseText(text).get(path) if text else None


def measured(page):
    """Open the dialog of a measured surface, and upload one; return the button that uses it."""
    lines = [[0.02 * math.cos(0.1 * i) + 0.01 * i for _ in range(40)] for i in range(40)]
    rows = [",".join(f"{height:.4f}" for height in line) for line in lines]
    file = {"name": "honed.csv", "mimeType": "text/csv", "buffer": "\n".join(rows).encode()}
    page.get_by_role("button", name="Surfaces").click()
    unit = page.get_by_label("unit of heights")

    for _ in range(3):  # a click while the controls are drawn anew is lost
        page.get_by_role("button", name="Measured surface").click()
        with contextlib.suppress(api.TimeoutError):
            unit.wait_for(timeout=10_000)
            break
    unit.fill("um")
    page.get_by_label("distance of points").fill("8 um")
    page.locator("input[type=file]").set_input_files(file)
    page.locator(".preview-words", has_text="Sq =").wait_for()
    return page.get_by_role("button", name="Use on surface 2")


def test_an_uploaded_surface_is_shown_levelled_and_used_by_buttons_that_stay_in_place(page):
    use = measured(page)
    use.hover(trial=True)  # once the dialog has opened
    before = use.bounding_box()
    type_into(page, "distance of points", "0 um")
    until(use.is_disabled)
    assert page.locator(".preview-words").inner_text().count("\n") == 0
    assert use.bounding_box() == before
    type_into(page, "distance of points", "8 um")
    use.click()
    until(lambda: stated(page, "surface_2.roughness.type") == "map")
    assert stated(page, "surface_2.roughness.file") == "honed.csv"
    assert stated(page, "surface_2.roughness.level") == "plane"


def test_files_of_a_result_are_downloaded(page):
    for words, start in (("Result, NetCDF", b"\x89HDF"), ("Picture, PNG", b"\x89PNG")):
        with page.expect_download() as download:
            page.get_by_role("button", name="Save", exact=True).click()
            page.get_by_text(words).click()
        assert download.value.path().read_bytes().startswith(start)


def test_the_buttons_undo_and_the_keyboard_redoes(page):
    entry = page.get_by_role("textbox", name="load", exact=True)
    type_into(page, "load", "85")
    page.get_by_role("button", name="undo").click()
    until(lambda: entry.input_value() == "80")
    for load in ("90", "100"):
        type_into(page, "load", load)
        until(lambda load=load: stated(page, "contact.load") == f"{load} N")
    page.go_back()
    until(lambda: entry.input_value() == "90")
    page.go_forward()
    until(lambda: entry.input_value() == "100")
    page.locator(".case-title").click()
    page.keyboard.press("Control+z")
    until(lambda: entry.input_value() == "90")
    page.keyboard.press("Control+Shift+Z")
    until(lambda: entry.input_value() == "100")


def test_the_theme_is_kept_over_a_reload(context, served):
    page = opened(context, served.address)
    assert "body--dark" not in page.locator("body").get_attribute("class")
    button = page.get_by_role("button", name="dark or light")
    button.click()
    page.locator("body.body--dark").wait_for()
    page.reload()
    page.locator("body.body--dark").wait_for()
    solved(page)  # a click before the page listens is lost
    button.click()
    page.locator("body.body--light").wait_for()
    context.clear_cookies(name=THEME)  # so that other pages follow the system


def test_values_of_curves_are_read_under_the_pointer(page):
    page.get_by_role("tab", name="Centre lines").click()
    page.locator(".slot:visible .drawing > svg").first.hover(position={"x": 300, "y": 150})
    page.locator(".readout", has_text="Hertz").wait_for()


def test_a_transient_run_plays_as_a_movie(page):
    take(page, template_text("passing-dent").replace("points = 257", "points = 65"))
    page.get_by_role("tab", name="Movie").click()
    page.get_by_role("button", name="Solve the run").click()
    page.get_by_role("slider", name="time").wait_for(timeout=60_000)
    clock = page.locator(".clock")
    assert clock.inner_text() == "0 µs"
    page.get_by_role("button", name="play or pause").click()
    until(lambda: clock.inner_text() != "0 µs")
    assert page.locator(".movie .drawing > svg").count() == 2
