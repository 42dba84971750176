"""The local page in a browser, from a dropped recording to the tire that is downloaded."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from browser import CONTRAST, Watched, browser
from drives import damped, saved
from radialtire import read_tire

HOSTILE = "<img src=x onerror=document.title='run'>.csv"


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    with browser() as opened:
        yield opened


def hears_ctrl_c() -> None:
    """Undo what a shell does to programs in its background."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[tuple[str, Path]]:
    """The program as a user starts it: the address that it prints, and its folder."""
    folder = tmp_path / "desk"
    words = [sys.executable, "-m", "tirelab", "open", str(folder), "--no-browser"]
    with subprocess.Popen(
        words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=hears_ctrl_c
    ) as program:
        assert program.stdout is not None
        address = program.stdout.readline().strip()
        assert re.fullmatch(r"http://127\.0\.0\.1:\d+/[\w-]{20,}/", address)
        yield address, folder
        program.send_signal(signal.SIGINT)
        _, said = program.communicate(timeout=120)
    assert program.returncode == 0
    assert "Traceback" not in said


DROP = """
([text, name]) => {
  const data = new DataTransfer();
  data.items.add(new File([text], name));
  const options = { dataTransfer: data, bubbles: true, cancelable: true };
  for (const kind of ["dragenter", "dragover", "drop"])
    document.getElementById("drop").dispatchEvent(new DragEvent(kind, options));
}
"""
"""Drops a file on the page, as the hand does."""


def test_from_drop_to_download(chromium: Any, opened: tuple[str, Path], tmp_path: Path) -> None:
    address, folder = opened
    text = saved(damped(1, samples=2000), tmp_path / "ride.csv").read_text()
    shown = Watched(chromium, viewport={"width": 1280, "height": 800}, accept_downloads=True)
    page = shown.page
    page.goto(address)
    assert page.locator("#diagnose").is_disabled()

    page.evaluate(DROP, ["Dear colleague,\nall went well.\n", "notes.txt"])
    page.wait_for_selector("#problem:not([hidden])")
    assert "notes.txt: " in page.inner_text("#problem")
    assert page.locator(".recording").count() == 0

    # a column without name and unit: the user says what it is
    lines = text.splitlines()
    odd = "\n".join(["time [s],deflection [cm],radius [cm],Kanal 4", *lines[1:]])
    page.evaluate(DROP, [odd, HOSTILE])
    page.wait_for_selector(".recording")
    box = page.locator(".recording")
    assert box.locator("h3").inner_text() == HOSTILE
    assert page.locator("img").count() == 0
    assert page.locator("#diagnose").is_disabled()
    assert box.locator(".alarm").count() == 1
    box.locator("select[aria-label='column of force']").select_option(label="Kanal 4")
    box.locator("input[aria-label='unit of force']").fill("N")
    box.locator("button[type=submit]").click()
    page.wait_for_selector(".recording .facts")
    assert "samples: 2000" in box.locator(".facts").inner_text()
    assert page.evaluate(CONTRAST) == []

    page.locator("#files").set_input_files(tmp_path / "ride.csv")
    page.locator(".recording").nth(1).wait_for()
    page.locator(".recording").nth(1).locator("select").first.select_option(value="held-out")
    page.wait_for_selector("#diagnose:not([disabled])")

    page.click("#diagnose")
    page.wait_for_selector("#stop:visible")
    panel = page.locator(".recording").nth(1).locator("details")
    panel.locator("summary").click()
    unit = panel.locator("input[aria-label='unit of force']")
    unit.fill("kN")
    page.wait_for_selector("#progress:visible")
    page.wait_for_selector(".result", timeout=180_000)
    page.locator("#stage", has_text="done").wait_for()
    # the end of the diagnosis takes away nothing that was being entered, and leads to the result
    assert panel.get_attribute("open") is not None
    assert unit.input_value() == "kN"
    assert unit.evaluate("field => field === document.activeElement")
    assert page.locator("#stage a").get_attribute("href") == "#" + str(
        page.locator(".result").get_attribute("id")
    )
    assert "Viscous damping" in page.inner_text(".result h3")

    with page.expect_download() as download:
        page.click(".result a:text('Tire')")
    download.value.save_as(tmp_path / "tire.json")
    assert [effect.name for effect, _ in read_tire(tmp_path / "tire.json").effects] == ["viscous_damping"]
    with page.expect_download() as download:
        page.click(".result a:text('FMU')")
    download.value.save_as(tmp_path / "tire.fmu")
    assert (tmp_path / "tire.fmu").read_bytes().startswith(b"PK")
    with shown.context.expect_page() as opening:
        page.click(".result a:text('Report')")
    report = opening.value
    report.wait_for_selector("#explore[data-ready]")
    assert report.locator("h1").inner_text().startswith("Viscous damping")
    assert HOSTILE.removesuffix(".csv") in report.inner_text("body")
    assert report.title() != "run"

    assert all(url.startswith((address, "data:")) for url in shown.asked)
    # the refusal of notes.txt is an answer with status 422, which the browser notes
    assert [line for line in shown.said if "422" not in line] == []
    assert sorted(p.name for p in (folder / "uploads").iterdir()) == [
        "0001.csv",
        "0001.json",
        "0001.toml",
        "0002.csv",
        "0002.json",
        "0002.toml",
    ]
    told = json.loads((folder / "diagnoses" / "0001" / "diagnosis.json").read_text())
    assert told["fit"]["held_out_after"] < 0.5 * told["fit"]["held_out_before"]
    shown.context.close()


def test_what_is_entered_stays_where_something_else_changes(
    chromium: Any, opened: tuple[str, Path], tmp_path: Path
) -> None:
    shown = Watched(chromium, viewport={"width": 1280, "height": 800})
    page = shown.page
    page.goto(opened[0])
    names = [saved(damped(i, samples=500), tmp_path / f"ride_{i}.csv") for i in (1, 2)]
    page.locator("#files").set_input_files(names)
    first, second = page.locator(".recording").nth(0), page.locator(".recording").nth(1)
    second.wait_for()
    first.locator("summary").click()
    unit = first.locator("input[aria-label='unit of force']")
    unit.fill("kN")
    with page.expect_response("**/state"):
        second.locator("select.use").select_option(value="held-out")
    second.locator("select.use").focus()
    with page.expect_response("**/state"):
        first.locator("select.use").select_option(value="left out")
    assert unit.input_value() == "kN"
    assert first.locator("details").get_attribute("open") is not None
    assert first.locator("select.use").input_value() == "left out"
    # what was entered is read then, the panel stays, and the focus with it
    first.locator("button[type=submit]").focus()
    with page.expect_response("**/state"):
        page.keyboard.press("Enter")
    first.locator("input[placeholder=kN]").wait_for()
    assert first.locator("details").get_attribute("open") is not None
    assert page.evaluate("document.activeElement.textContent") == "Apply"
    with page.expect_response("**/state"):
        second.locator("button", has_text="Remove").click()
    second.wait_for(state="detached")
    assert unit.input_value() == "kN"
    assert shown.said == []
    shown.context.close()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_it_fits_a_phone_in_light_and_dark(
    chromium: Any, opened: tuple[str, Path], scheme: str, tmp_path: Path
) -> None:
    shown = Watched(chromium, viewport={"width": 390, "height": 844}, color_scheme=scheme)
    shown.page.goto(opened[0])
    shown.page.locator("#files").set_input_files(
        saved(damped(1, samples=500), tmp_path / f"{'long_name_' * 9}.csv")
    )
    shown.page.wait_for_selector(".recording")
    shown.page.locator("summary").click()
    assert shown.page.evaluate("() => document.documentElement.scrollWidth") <= 390
    assert shown.page.evaluate(CONTRAST) == []
    assert shown.said == []
    shown.context.close()
