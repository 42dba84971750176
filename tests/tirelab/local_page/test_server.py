"""The server of the local page: what it answers, and to whom."""

from __future__ import annotations

import http.client
import json
import signal
import socket
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from drives import damped, saved
from tirelab.cli import main
from tirelab.local_page import server as module
from tirelab.local_page.server import HOST, Server, Workbench
from tirelab.local_page.store import Store


@pytest.fixture
def served(tmp_path: Path) -> Iterator[Server]:
    store = Store(tmp_path / "desk")
    store.prepare()
    made = Server(Workbench(store, largest=2_000_000))
    thread = threading.Thread(target=made.serve_forever, kwargs={"poll_interval": 0.02})
    thread.start()
    yield made
    made.shutdown()
    thread.join()
    made.server_close()
    made.workbench.close()


def ask(
    served: Server, method: str, path: str, body: bytes | None = None, **headers: str
) -> tuple[int, Any, http.client.HTTPMessage]:
    """Ask under the token; the answer as JSON where it is."""
    connection = http.client.HTTPConnection(HOST, served.server_address[1], timeout=120)
    given = {name.replace("_", "-"): text for name, text in headers.items()}
    connection.request(method, f"/{served.token}/{path}", body, given)
    answer = connection.getresponse()
    content = answer.read()
    connection.close()
    kind = answer.headers.get("Content-Type", "")
    return answer.status, json.loads(content) if "json" in kind else content, answer.headers


@pytest.fixture(scope="module")
def ride(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """A recording with 500 N s/m of damping, as a file."""
    return saved(damped(1, samples=2000), tmp_path_factory.mktemp("ride") / "ride.csv").read_bytes()


def kept(served: Server) -> list[str]:
    return sorted(p.name for p in (served.workbench.store.folder / "uploads").iterdir())


def test_it_is_bound_to_this_machine_alone(served: Server) -> None:
    assert served.server_address[0] == "127.0.0.1"
    assert served.address.startswith("http://127.0.0.1:")
    assert len(served.token) >= 20


@pytest.mark.parametrize("path", ["/", "/state", "/wrong/state", "//state", "/wrong/", "/%2e%2e/state"])
def test_without_the_token_nothing_is_answered(served: Server, path: str) -> None:
    connection = http.client.HTTPConnection(HOST, served.server_address[1], timeout=120)
    connection.request("GET", path)
    answer = connection.getresponse()
    assert answer.status == 403
    assert "open the address" in json.loads(answer.read())["problem"]


@pytest.mark.parametrize("method", ["GET", "POST", "DELETE"])
def test_other_hosts_and_pages_are_refused(served: Server, method: str) -> None:
    path = {"GET": "state", "POST": "diagnose", "DELETE": "diagnose"}[method]
    port = served.server_address[1]
    assert ask(served, method, path, b"", Host=f"evil.invalid:{port}")[0] == 403
    assert ask(served, method, path, b"", Origin="http://evil.invalid")[0] == 403
    assert ask(served, method, path, b"", Origin="null")[0] == 403
    assert ask(served, method, path, b"", Origin=f"http://127.0.0.1:{port}")[0] != 403


def test_the_page_may_load_only_what_is_its_own(served: Server) -> None:
    status, text, headers = ask(served, "GET", "")
    assert status == 200
    assert b"Drop recordings here" in text
    policy = headers["Content-Security-Policy"]
    assert "default-src 'none'" in policy
    assert "unsafe" not in policy
    assert headers["X-Content-Type-Options"] == "nosniff"
    assert headers["Referrer-Policy"] == "no-referrer"
    for name in ("page.js", "page.css", "report.css"):
        assert ask(served, "GET", name)[0] == 200


@pytest.mark.parametrize(
    "path",
    [
        "server.py",
        "diagnoses/1/../../uploads/0001.json",
        "diagnoses/0001/%2e%2e",
        "uploads/0001.csv",
        "..%2f..%2fetc%2fpasswd",
        "diagnoses/1/report.html",
    ],
)
def test_no_other_file_is_given_out(served: Server, ride: bytes, path: str) -> None:
    ask(served, "POST", "recordings?name=ride.csv", ride)
    assert ask(served, "GET", path)[0] == 404


def test_a_recording_is_kept_and_understood(served: Server, ride: bytes) -> None:
    status, told, _ = ask(served, "POST", "recordings?name=my%20ride.csv", ride)
    assert status == 201
    assert (told["number"], told["name"], told["use"], told["problem"]) == (1, "my ride.csv", "fitted", "")
    assert ["samples", "2000"] in told["facts"]
    units = {c["channel"]: c["unit"] for c in told["channels"] if c["column"]}
    assert units == {"time": "s", "deflection": "cm", "radius": "cm", "force": "N"}
    assert kept(served) == ["0001.csv", "0001.json", "0001.toml"]
    assert ask(served, "GET", "state")[1]["recordings"] == [told]


@pytest.mark.parametrize(
    ("name", "content", "sentence"),
    [
        ("notes.txt", b"Dear colleague,\nthe tests went well.\n", "notes.txt: "),
        ("page.html", b"<html></html>", "page.html: "),
        ("sheet.xlsx", b"no workbook at all", "sheet.xlsx"),
        ("empty.csv", b"", "is empty (0 bytes)"),
        ("zip.csv", b"PK\x03\x04 and so on", "zip.csv is no text table"),
    ],
)
def test_what_is_no_recording_gets_a_sentence_and_nothing_is_kept(
    served: Server,
    name: str,
    content: bytes,
    sentence: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The sentence is that of `tirelab inspect`, word for word."""
    status, told, _ = ask(served, "POST", f"recordings?name={name}", content)
    assert status == 422
    assert sentence in told["problem"]
    (tmp_path / name).write_bytes(content)
    monkeypatch.chdir(tmp_path)
    inspected = CliRunner().invoke(main, ["inspect", name])
    assert inspected.exit_code == 2
    assert inspected.stderr.partition("Error: ")[2].splitlines()[0] == told["problem"]
    assert "0001" not in told["problem"]
    assert str(served.workbench.store.folder) not in told["problem"]
    assert kept(served) == []


def test_columns_and_units_are_corrected(served: Server, ride: bytes) -> None:
    """The second and the last column without their names and units: only the user knows."""
    lines = ride.decode().splitlines()
    odd = "\n".join(["time [s],Kanal 2,radius [cm],Kanal 4", *lines[1:]]).encode()
    status, told, _ = ask(served, "POST", "recordings?name=odd.csv", odd)
    assert status == 201
    assert "odd.csv" in told["problem"]
    assert told["headers"] == ["time [s]", "Kanal 2", "radius [cm]", "Kanal 4"]
    # of two unknown columns the one of the larger numbers is guessed to be the force
    assert told["guess"]["columns"] == {"deflection": "#2", "force": "#4"}
    assert "--columns" not in told["problem"]
    assert told["guess"]["units"]["force"] == "N"
    assert ask(served, "POST", "diagnose", b"")[0] == 422
    settings = {"columns": {"deflection": "#2", "force": "#4"}, "units": {"deflection": "cm", "force": "N"}}
    status, told, _ = ask(served, "POST", "recordings/1", json.dumps(settings).encode())
    assert (status, told["problem"]) == (200, "")
    assert told["settings"] == {**settings, "radius": ""}
    plain = ask(served, "POST", "recordings?name=plain.csv", ride)[1]
    assert plain["facts"] == told["facts"]
    # millimetres instead of centimetres: a tenth as deep
    settings["units"]["deflection"] = "mm"
    told = ask(served, "POST", "recordings/1", json.dumps(settings).encode())[1]
    spans = [{c["channel"]: c["values"] for c in t["channels"]}["deflection"] for t in (plain, told)]
    depths = [float(span.split(" to ")[1].split()[0]) for span in spans]
    assert depths[1] == pytest.approx(0.1 * depths[0], rel=0.02)


def test_a_radius_that_was_set_on_the_page_is_told_without_a_file_of_its_own(
    served: Server, ride: bytes
) -> None:
    rows = [row.split(",") for row in ride.decode().splitlines()]
    text = "\n".join(",".join([t, x, f]) for t, x, _, f in rows).encode()
    ask(served, "POST", "recordings?name=flat.csv", text)
    settings = {"columns": {}, "units": {}, "radius": "flat"}
    told = ask(served, "POST", "recordings/1", json.dumps(settings).encode())[1]
    assert "surface radius flat from the settings of flat.csv" in told["notes"]
    assert not any("0001" in note for note in told["notes"])
    wrong = ask(served, "POST", "recordings/1", json.dumps({**settings, "radius": "25"}).encode())[1]
    assert "0001" not in json.dumps([wrong.get("problem"), wrong.get("notes"), wrong.get("error")])


def test_doubts_and_what_the_file_says_are_told(served: Server, ride: bytes) -> None:
    """A force that is a thousand times too small for a tire, below a line about the test."""
    head, *rows = ride.decode().splitlines()
    small = [",".join([*row.split(",")[:3], f"{float(row.split(',')[3]) / 1e3:.6f}"]) for row in rows]
    text = "\n".join(["Tyre: 27.5 x 2.4", "", head, *small]).encode()
    told = ask(served, "POST", "recordings?name=small.csv", text)[1]
    assert told["problem"] == ""
    assert told["doubts"]
    assert "it says: Tyre: 27.5 x 2.4" in told["notes"]
    assert not any(note.startswith("doubtful") for note in told["notes"])
    assert dict(told["facts"])["table"].startswith("names in row 3")


def test_columns_that_are_known_are_shown_where_only_the_surface_is_not(served: Server, ride: bytes) -> None:
    text = "\n".join(",".join(row.split(",")[i] for i in (0, 1, 3)) for row in ride.decode().splitlines())
    told = ask(served, "POST", "recordings?name=plain.csv", text.encode())[1]
    assert "the radius of the surface is not known" in told["problem"]
    assert told["guess"]["radius"] == "flat"
    assert {c["channel"]: c["unit"] for c in told["channels"] if c["column"]} == {
        "time": "s",
        "deflection": "cm",
        "force": "N",
    }


def test_tests_side_by_side_are_recordings_each(served: Server, ride: bytes) -> None:
    head, *rows = ride.decode().splitlines()
    text = "\n".join([f"{head},{head}", *(f"{row},{row}" for row in rows)]).encode()
    told = ask(served, "POST", "recordings?name=both.csv", text)[1]
    assert told["problem"] == ""
    assert dict(told["facts"])["tests"].startswith("2 side by side")


@pytest.mark.parametrize(
    "body",
    [
        b"no json",
        b"[]",
        b'{"use": "../x"}',
        b'{"columns": {"mass": "a"}}',
        b'{"radius": 5}',
        b'{"units": []}',
    ],
)
def test_settings_that_make_no_sense_are_one_sentence(served: Server, ride: bytes, body: bytes) -> None:
    ask(served, "POST", "recordings?name=ride.csv", ride)
    status, told, _ = ask(served, "POST", "recordings/1", body)
    assert status == 422
    assert told["problem"]
    assert "Traceback" not in told["problem"]
    assert ask(served, "GET", "state")[1]["recordings"][0]["problem"] == ""


def test_what_is_too_large_or_of_unknown_length_is_refused(served: Server) -> None:
    connection = http.client.HTTPConnection(HOST, served.server_address[1], timeout=120)
    connection.putrequest("POST", f"/{served.token}/recordings?name=a.csv")
    connection.putheader("Content-Length", "2000001")
    connection.endheaders()  # the answer comes before a byte of it is sent
    answer = connection.getresponse()
    assert answer.status == 413
    assert "at most 2 MB are taken" in json.loads(answer.read())["problem"]
    with socket.create_connection((HOST, served.server_address[1]), timeout=120) as raw:
        text = f"POST /{served.token}/recordings?name=a.csv HTTP/1.1\r\nHost: {served.hosts[0]}\r\n\r\n"
        raw.sendall(text.encode())
        assert b" 411 " in raw.recv(4096)
    assert kept(served) == []


def test_a_connection_that_breaks_leaves_nothing(served: Server) -> None:
    with socket.create_connection((HOST, served.server_address[1]), timeout=120) as raw:
        head = f"POST /{served.token}/recordings?name=a.csv HTTP/1.1\r\nHost: {served.hosts[0]}\r\n"
        raw.sendall(f"{head}Content-Length: 900\r\n\r\n1,2".encode())
        raw.shutdown(socket.SHUT_WR)
        answer = b"".join(iter(lambda: raw.recv(4096), b""))
    assert b"did not arrive whole" in answer
    assert kept(served) == []


def test_without_a_recording_there_is_nothing_to_diagnose(served: Server, ride: bytes) -> None:
    assert ask(served, "POST", "diagnose", b"")[0] == 422
    ask(served, "POST", "recordings?name=ride.csv", ride)
    ask(served, "POST", "recordings/1", b'{"use": "held-out"}')
    status, told, _ = ask(served, "POST", "diagnose", b"")
    assert status == 422
    assert "no recording is to be fitted" in told["problem"]
    assert ask(served, "DELETE", "recordings/1")[0] == 200
    assert ask(served, "DELETE", "recordings/1")[0] == 422
    assert kept(served) == []


def test_a_diagnosis_that_is_stopped_leaves_nothing(served: Server, ride: bytes) -> None:
    ask(served, "POST", "recordings?name=ride.csv", ride)
    heard = signal.signal(signal.SIGINT, signal.SIG_IGN)  # as in a shell's background
    try:
        assert ask(served, "POST", "diagnose", b"")[0] == 202
    finally:
        signal.signal(signal.SIGINT, heard)
    job = served.workbench.job
    assert job is not None
    while job.running and not job.stages:
        time.sleep(0.05)
    assert job.stages[0] == "reading ride.csv"  # not 0001.csv
    assert ask(served, "POST", "diagnose", b"")[0] == 422  # one at a time
    assert ask(served, "DELETE", "diagnose")[0] == 200
    job.wait(60.0)
    state = ask(served, "GET", "state")[1]
    assert (state["job"]["running"], state["job"]["problem"]) == (False, "stopped")
    assert state["diagnoses"] == []
    assert list((served.workbench.store.folder / "diagnoses").iterdir()) == []


def test_a_diagnosis_that_fails_says_why(served: Server) -> None:
    rows = [f"{t:.4f},{20.0 * t:.4f},{900.0 * t:.2f}" for t in np.linspace(0.0, 1.0, 30)]
    short = "\n".join(["time [s],deflection [mm],force [N]", *rows]).encode()
    told = ask(served, "POST", "recordings?name=short.csv", short)[1]
    assert "short.csv" in told["problem"]  # the surface is not known
    told = ask(served, "POST", "recordings/1", b'{"radius": "flat"}')[1]
    assert told["problem"] == ""
    assert ask(served, "POST", "diagnose", b"")[0] == 202
    job = served.workbench.job
    assert job is not None
    job.wait(120.0)
    problem = ask(served, "GET", "state")[1]["job"]["problem"]
    assert "samples; at least 100 are needed" in problem


def test_a_fault_of_ours_is_one_sentence_and_keeps_nothing(
    served: Server, ride: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stumble(*_: Any) -> None:
        raise RuntimeError("no such branch")

    monkeypatch.setattr("tirelab.local_page.understood.understood", stumble)
    status, told, _ = ask(served, "POST", "recordings?name=ride.csv", ride)
    assert status == 500
    assert (
        told["problem"]
        == "internal error (RuntimeError: no such branch); please report it with the recording"
    )
    assert kept(served) == []


def test_what_the_page_names_is_what_the_server_serves() -> None:
    folder = Path(module.__file__).parent
    assert {p.name for p in folder.iterdir() if p.suffix in (".html", ".css", ".js")} == {
        "page.html",
        "page.css",
        "page.js",
    }
