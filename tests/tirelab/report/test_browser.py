"""The report in a browser: it shows, asks nobody for anything, and has nothing to complain of."""

from __future__ import annotations

import json
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest
from tirelab.report.page import write_report

CHROMIUM = next(
    (found for name in ("chromium", "chromium-browser", "google-chrome") if (found := shutil.which(name))),
    None,
)

OWN_HOSTS = ("google.com", "googleapis.com", "gvt1.com", "gstatic.com")
"""Where the browser itself calls at its start, whatever the page; no name is resolved here."""

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no chromium on this machine")


def opened(page: Path, folder: Path, *options: str) -> tuple[str, list[str], list[str]]:
    """Open a page and return its elements as text, the console's lines and the addresses asked for."""
    folder.mkdir()
    log = folder / "net.json"
    command = [
        str(CHROMIUM),
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--no-first-run",
        "--disable-background-networking",
        "--disable-component-update",
        "--host-resolver-rules=MAP * ~NOTFOUND",
        "--enable-logging=stderr",
        f"--user-data-dir={folder / 'profile'}",
        f"--log-net-log={log}",
        *options,
        page.as_uri(),
    ]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    events = json.loads(log.read_text())
    started = events["constants"]["logEventTypes"]["URL_REQUEST_START_JOB"]
    asked = [
        e["params"]["url"] for e in events["events"] if e["type"] == started and "url" in e.get("params", {})
    ]
    console = [line for line in done.stderr.splitlines() if ":CONSOLE" in line]
    return done.stdout, console, asked


def foreign(asked: list[str]) -> list[str]:
    """The addresses that are neither the page, nor data in it, nor the browser's own."""
    hosts = [(url, urlsplit(url).hostname or "") for url in asked if not url.startswith(("file:", "data:"))]
    return [url for url, host in hosts if not host.endswith(OWN_HOSTS)]


def test_requests_and_complaints_would_be_seen(tmp_path: Path) -> None:
    page = tmp_path / "loud.html"
    page.write_text("<img src='http://tirelab.invalid/a.png'><script>console.error('heard')</script>")
    _, console, asked = opened(page, tmp_path / "b", "--dump-dom")
    assert any("heard" in line for line in console)
    assert foreign(asked) == ["http://tirelab.invalid/a.png"]


@pytest.mark.parametrize(
    ("kind", "headings"),
    [
        (
            "two",
            (
                "Force loops before and after the correction",
                "How large the error is",
                "What was left out",
                "Alternative models",
            ),
        ),
        ("alternatives", ("Recommended next test", "Models compared", "Data and software")),
        ("unknown", ("Where simulation and recording differ", "Something that no known effect explains")),
    ],
)
def test_the_report_opens_without_requests_or_complaints(
    kinds: dict[str, Any], tmp_path: Path, kind: str, headings: tuple[str, ...]
) -> None:
    made = kinds[kind]
    hostile = (
        "<img src='http://tirelab.invalid/b.png' onerror='console.error(1)'><script>console.error(2)</script>"
    )
    recordings = [replace(r, name=hostile, notes=(hostile,)) for r in made.recordings]
    page = tmp_path / "report.html"
    write_report(page, made.diagnosis, recordings, made.before, made.after, held_out=made.held_out)
    shown, console, asked = opened(page, tmp_path / "b", "--dump-dom")
    assert console == []
    assert foreign(asked) == []
    for heading in headings:
        assert f">{heading}</h" in " ".join(shown.split()).replace(" </h", "</h")


def test_a_phone_is_wide_enough(kinds: dict[str, Any], tmp_path: Path) -> None:
    """A frame as wide as a phone tells by its title by how much the page in it would have to be wider."""
    made = kinds["alternatives"]
    page = tmp_path / "report.html"
    write_report(page, made.diagnosis, made.recordings, made.before, made.after, held_out=made.held_out)
    around = tmp_path / "around.html"
    around.write_text(
        "<iframe id=f src=report.html style='width:360px;height:800px;border:0'></iframe><script>f.onload = () => { "
        "const e = f.contentDocument.documentElement; "
        "document.title = 'over by ' + (e.scrollWidth - e.clientWidth) }</script>"
    )
    shown, _, _ = opened(
        around, tmp_path / "b", "--allow-file-access-from-files", "--virtual-time-budget=5000", "--dump-dom"
    )
    assert "<title>over by 0</title>" in shown
