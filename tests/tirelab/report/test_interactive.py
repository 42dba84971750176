"""The report used by a reader: pointer, keys, windows, recordings switched off, phone, dark, print, no scripts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser import CONTRAST, Watched, browser
from drives import long_ride
from tirelab.report.page import write_report

VIEWS = ("force-time", "force-x", "residual-time", "residual-x")
DESKTOP, PHONE = {"width": 1280, "height": 800}, {"width": 390, "height": 844}


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    with browser() as opened:
        yield opened


def opened(chromium: Any, path: Path, **context: Any) -> Watched:
    shown = Watched(chromium, **{"viewport": DESKTOP, **context})
    shown.page.goto(path.as_uri())
    if context.get("java_script_enabled", True):
        shown.page.wait_for_selector("#explore[data-ready]")
    return shown


@pytest.fixture
def report(chromium: Any, reports: dict[str, Path]) -> Iterator[Watched]:
    """The report on one effect, in a window of a desktop."""
    shown = opened(chromium, reports["one"])
    yield shown
    assert shown.said == []
    assert all(url.startswith(("file:", "data:")) for url in shown.asked)
    shown.context.close()


def window(page: Any, view: str) -> tuple[float, float]:
    box = page.locator(f"#explore-{view}")
    return float(box.get_attribute("data-from")), float(box.get_attribute("data-to"))


def middle(page: Any, view: str, part: float = 0.5) -> tuple[float, float]:
    over = page.locator(f"#explore-{view} .u-over")
    over.scroll_into_view_if_needed()
    box = over.bounding_box()
    return box["x"] + part * box["width"], box["y"] + 0.5 * box["height"]


def readout(page: Any) -> str:
    return str(page.locator("#explore-readout").inner_text())


def ring(page: Any, view: str, series: str) -> tuple[float, float]:
    box = page.locator(f"#explore-{view} .ring.{series}").bounding_box()
    over = page.locator(f"#explore-{view} .u-over").bounding_box()
    return box["x"] + 0.5 * box["width"] - over["x"], box["y"] + 0.5 * box["height"] - over["y"]


def test_the_pointer_marks_one_sample_in_all_views(report: Watched, kinds: dict[str, Any]) -> None:
    page, made = report.page, kinds["one"]
    over = page.locator("#explore-force-time .u-over").bounding_box()
    page.mouse.move(*middle(page, "force-time", 0.2))
    page.wait_for_function("document.getElementById('explore-readout').textContent.includes(' mm;')")
    low, high = window(page, "force-time")
    sample = int(np.argmin(np.abs(made.recordings[0].time - (low + 0.2 * (high - low)))))
    near = slice(max(sample - 60, 0), sample + 60)  # a pixel of the plot is some twenty samples wide
    told = readout(page)
    assert told.startswith("ride_0: ")
    time = float(told.split(": ")[1].split(" s")[0])
    mm = float(told.split("s, ")[1].split(" mm")[0])
    force = float(told.split("recorded ")[1].split(" N")[0])
    index = int(np.argmin(np.abs(made.recordings[0].time - time)))
    assert near.start <= index <= near.stop
    assert mm == pytest.approx(1e3 * made.recordings[0].deflection[index], abs=0.006)
    assert force == pytest.approx(made.recordings[0].force[index], abs=0.15)
    # the ring stands where the axis has that sample, in every view
    for view, at in (("force-time", time), ("residual-time", time), ("force-x", mm), ("residual-x", mm)):
        low, high = window(page, view)
        width = page.locator(f"#explore-{view} .u-over").bounding_box()["width"]
        series = "after" if view.startswith("residual") else "recorded"
        assert ring(page, view, series)[0] == pytest.approx(width * (at - low) / (high - low), abs=1.5)
    assert over["width"] > 300


def test_a_sample_is_found_in_the_loop_by_its_distance(report: Watched) -> None:
    page = report.page
    x, y = middle(page, "force-x", 0.5)
    page.mouse.move(x, y)
    page.wait_for_function("document.getElementById('explore-readout').textContent.includes(' mm;')")
    over = page.locator("#explore-force-x .u-over").bounding_box()
    left, top = ring(page, "force-x", "recorded")
    assert abs(left - (x - over["x"])) < 60
    assert abs(top - (y - over["y"])) < 60


def test_a_drag_zooms_both_views_of_its_axis_and_the_window_holds_in_all(report: Watched) -> None:
    page = report.page
    full = window(page, "force-time")
    heights = page.evaluate("() => document.querySelectorAll('#explore canvas').length")
    assert heights == 4
    x, y = middle(page, "force-time", 0.25)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 60, y, steps=3)
    page.mouse.move(x + 120, y, steps=3)
    page.mouse.up()
    zoomed = window(page, "force-time")
    assert zoomed == window(page, "residual-time")
    width = page.locator("#explore-force-time .u-over").bounding_box()["width"]
    assert (zoomed[1] - zoomed[0]) / (full[1] - full[0]) == pytest.approx(120 / width, rel=0.05)
    # the loop marks samples of that window only
    page.mouse.move(*middle(page, "force-x", 0.5))
    page.wait_for_function("document.getElementById('explore-readout').textContent.includes(' mm;')")
    assert zoomed[0] <= float(readout(page).split(": ")[1].split(" s")[0]) <= zoomed[1]
    page.click("[data-do=reset]")
    assert window(page, "force-time") == full
    assert page.locator("[data-do=reset]").is_disabled()


def test_shift_and_drag_pan_and_the_wheel_zooms(report: Watched) -> None:
    page = report.page
    x, y = middle(page, "residual-x", 0.5)
    full = window(page, "residual-x")
    page.mouse.move(x, y)
    page.keyboard.down("Control")
    page.mouse.wheel(0, -100)
    page.keyboard.up("Control")
    page.wait_for_function(
        f"Number(document.getElementById('explore-force-x').dataset.from) > {full[0] + 1e-9}"
    )
    near = window(page, "force-x")
    assert near == window(page, "residual-x")
    assert (near[1] - near[0]) / (full[1] - full[0]) == pytest.approx(0.8, rel=1e-6)
    page.keyboard.down("Shift")
    page.mouse.down()
    page.mouse.move(x + 10, y, steps=2)
    page.mouse.up()
    page.keyboard.up("Shift")
    moved = window(page, "residual-x")
    assert moved[0] < near[0]
    assert moved[1] - moved[0] == pytest.approx(near[1] - near[0], rel=1e-6)


def test_keys_walk_zoom_pan_and_reset(report: Watched) -> None:
    page = report.page
    page.focus("#explore-force-time")
    page.keyboard.press("ArrowRight")
    first = readout(page)
    assert first.startswith("ride_0: 0.000 s")
    page.keyboard.press("ArrowRight")
    assert readout(page).startswith("ride_0: 0.005 s")  # the next sample
    page.keyboard.press("Alt+ArrowRight")
    page.keyboard.press("ArrowLeft")
    assert readout(page) != first
    full = window(page, "force-time")
    page.keyboard.press("+")
    near = window(page, "force-time")
    assert near[1] - near[0] < 0.51 * (full[1] - full[0])
    page.keyboard.press("Shift+ArrowRight")
    assert window(page, "force-time")[0] > near[0]
    page.keyboard.press("Home")
    assert window(page, "force-time") == full
    order = page.evaluate(
        "() => [...document.querySelectorAll('#explore input, #explore button, #explore [tabindex]')]"
        ".every(e => e.tabIndex === 0)"
    )
    assert order


def test_buttons_of_time_say_so(report: Watched) -> None:
    titles = {
        b.get_attribute("data-do"): b.get_attribute("title")
        for b in report.page.query_selector_all("[data-do]")
    }
    assert all("time" in titles[do] for do in ("left", "right", "in", "out"))


def test_recordings_and_series_are_switched_off(report: Watched) -> None:
    page = report.page
    full = window(page, "force-time")
    boxes = page.locator(".recordings input")
    assert boxes.count() == 3
    boxes.nth(0).uncheck()
    assert window(page, "force-time")[1] == pytest.approx(full[1] * 2.0 / 3.0, rel=0.01)
    page.focus("#explore-force-time")
    page.keyboard.press("ArrowRight")
    assert readout(page).startswith("ride_1: ")
    page.locator(".toggles input").nth(0).uncheck()
    assert page.locator("#explore-force-time .ring.recorded").count() == 0
    assert page.locator("#explore-force-time .ring.before").count() == 1
    boxes.nth(1).uncheck()
    boxes.nth(2).click()
    assert boxes.nth(2).is_checked()  # the last one stays


@pytest.mark.parametrize("kind", ["nothing", "one", "two", "alternatives", "unknown"])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_texts_have_contrast_and_nothing_complains(
    chromium: Any, reports: dict[str, Path], kind: str, scheme: str
) -> None:
    shown = opened(chromium, reports[kind], color_scheme=scheme)
    assert shown.page.evaluate(CONTRAST) == []
    assert shown.said == []
    ground = shown.page.evaluate("() => getComputedStyle(document.body).backgroundColor")
    assert (ground == "rgb(255, 255, 255)") == (scheme == "light")
    shown.context.close()


def test_poor_contrast_would_be_seen(chromium: Any, tmp_path: Path) -> None:
    page = tmp_path / "faint.html"
    page.write_text(
        "<p style='color:#999;background:#fff'>faint</p><p style='color:#000;background:#fff'>clear</p>"
    )
    shown = Watched(chromium)
    shown.page.goto(page.as_uri())
    assert [text.split()[-1] for text in shown.page.evaluate(CONTRAST)] == ["faint"]
    shown.context.close()


@pytest.mark.parametrize("kind", ["nothing", "one", "two", "alternatives", "unknown"])
@pytest.mark.parametrize("size", [DESKTOP, PHONE], ids=["desktop", "phone"])
def test_the_first_screen_holds_the_answer(
    chromium: Any, reports: dict[str, Path], kind: str, size: dict[str, int]
) -> None:
    """Headline, confidence, every error, the picture and the action stand above the fold, and nothing is wider."""
    shown = opened(chromium, reports[kind], viewport=size)
    page = shown.page
    for part in ("h1", ".confidence", ".figures > div:last-child", "header figure svg", ".next p strong"):
        box = page.locator(part).first.bounding_box()
        assert box["y"] >= 0
        assert box["y"] + box["height"] <= size["height"], (part, box)
    assert page.evaluate("() => document.documentElement.scrollWidth") <= size["width"]
    links = page.locator(".links a")
    for i in range(links.count()):
        box = links.nth(i).bounding_box()
        assert box["y"] + box["height"] <= size["height"], (links.nth(i).inner_text(), box)
    drive = ["separating_test.csv"] if kind == "alternatives" else []
    assert [links.nth(i).get_attribute("href") for i in range(links.count())] == [
        "tire.json",
        "BicycleTire.fmu",
        *drive,
        "plots.csv",
        "diagnosis.json",
    ]
    shown.context.close()


def test_every_picture_has_its_numbers_below(chromium: Any, reports: dict[str, Path]) -> None:
    for kind in ("two", "unknown"):
        shown = opened(chromium, reports[kind])
        figures = shown.page.locator("main section figure")
        names = [figures.nth(i).locator("a[download]").count() for i in range(figures.count())]
        assert names == [1] * figures.count()
        with shown.page.expect_download() as download:
            shown.page.locator("a[download='residual_over_rate.csv']").click()
        assert Path(download.value.path()).read_text().startswith("curve,")
        assert shown.said == []
        shown.context.close()


@pytest.mark.parametrize("view", VIEWS)
def test_on_a_phone_a_tap_marks_a_sample_and_its_values_are_seen(
    chromium: Any, reports: dict[str, Path], view: str
) -> None:
    shown = opened(chromium, reports["one"], viewport=PHONE, has_touch=True)
    page = shown.page
    page.evaluate(f"() => document.getElementById('explore-{view}').scrollIntoView({{ block: 'end' }})")
    page.touchscreen.tap(*middle(page, view, 0.4))
    page.locator("#explore-readout", has_text=" mm;").wait_for()
    box = page.locator("#explore-readout").bounding_box()
    plot = page.locator(f"#explore-{view} .u-over").bounding_box()
    assert box["y"] >= 0
    assert box["y"] + box["height"] <= min(plot["y"], PHONE["height"])
    assert not page.locator(f"#explore-{view} .ring").first.is_hidden()
    shown.context.close()


def test_without_scripts_the_pictures_stand(chromium: Any, reports: dict[str, Path]) -> None:
    shown = opened(chromium, reports["one"], java_script_enabled=False)
    assert not shown.page.locator("#explore").is_visible()
    assert shown.page.locator("svg[role=img]:visible").count() >= 7
    assert shown.said == []
    shown.context.close()


def test_the_print_has_the_pictures_and_not_the_controls(chromium: Any, reports: dict[str, Path]) -> None:
    shown = opened(chromium, reports["alternatives"], color_scheme="dark")
    shown.page.emulate_media(media="print", color_scheme="dark")
    assert not shown.page.locator("#explore").is_visible()
    assert shown.page.locator("header svg").is_visible()
    assert (
        shown.page.evaluate("() => getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)"
    )
    assert shown.page.pdf(format="A4").startswith(b"%PDF")
    shown.context.close()


def test_no_sentence_of_the_print_is_torn_by_the_end_of_a_page(
    chromium: Any, reports: dict[str, Path]
) -> None:
    shown = opened(chromium, reports["alternatives"])
    shown.page.emulate_media(media="print")
    broken = "p => getComputedStyle(p).breakInside != 'avoid'"
    torn = f"[...document.querySelectorAll('main p')].filter({broken}).length"
    assert shown.page.locator("main p").count() > 5
    assert shown.page.evaluate(torn) == 0
    shown.context.close()


def test_names_are_text_in_the_script_too(chromium: Any, kinds: dict[str, Any], tmp_path: Path) -> None:
    script = "document.title='run'"
    hostile = f'</script><script>{script}</script><img src=x onerror="{script}"> \u2028 {{{{7*7}}}}'
    made = kinds["one"]
    named = [replace(r, name=hostile) for r in made.recordings]
    path = tmp_path / "hostile.html"
    write_report(path, made.diagnosis, named, made.before, made.after, held_out=made.held_out)
    shown = opened(chromium, path)
    assert shown.page.title() == "Viscous damping, 4 % of the load"
    assert shown.said == []
    shown.page.focus("#explore-force-time")
    shown.page.keyboard.press("ArrowRight")
    assert readout(shown.page).startswith("</script><script>document.title='run'</script><img src=x")
    assert shown.page.locator("img").count() == 0
    shown.context.close()


@pytest.mark.slow
def test_a_million_samples_open(chromium: Any, kinds: dict[str, Any], tmp_path: Path) -> None:
    """In a file under 2 MB; how soon is a matter of `tests/benchmarks/bench_report.py`."""
    made, path = kinds["one"], tmp_path / "long.html"
    write_report(path, made.diagnosis, *long_ride(1_000_000))
    assert path.stat().st_size < 2e6
    shown = opened(chromium, path)
    assert window(shown.page, "force-time")[1] > 999.0
    assert shown.said == []
    shown.context.close()
