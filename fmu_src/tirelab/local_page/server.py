"""The server of the local page: bound to this machine, every address begins with a token, nothing else is answered."""

from __future__ import annotations

import hmac
import json
import re
import secrets
import threading
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib import resources
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlsplit

from ..errors import TirelabError
from .job import Job, Order
from .store import Store, Upload, clean_text, clean_texts

HOST = "127.0.0.1"

LARGEST_UPLOAD = 1_000_000_000
"""Bytes of one recording at most."""

LARGEST_TEXT = 20_000
"""Bytes of settings at most."""

SILENT = 60.0
"""Seconds after which a connection that says nothing is closed."""

PATIENCE = 20.0
"""Seconds that a diagnosis gets to take away what it had begun, when the page ends."""

PAGE = "page.html"

_TYPES = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".json": "application/json; charset=utf-8",
    ".csv": "text/csv; charset=utf-8",
    ".fmu": "application/octet-stream",
}

_OWN = {"": (__package__, PAGE), "page.js": (__package__, "page.js"), "page.css": (__package__, "page.css")}
_OWN["report.css"] = ("tirelab.report", "report.css")

POLICY = "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src data:"


@dataclass(frozen=True)
class Refused(Exception):
    """An answer that is not what was asked for: the status, and a sentence for the user."""

    status: HTTPStatus
    sentence: str


class Workbench:
    """What the page shows and does: uploads, the diagnosis that runs, and those that are finished."""

    def __init__(self, store: Store, tire: Path | None = None, largest: int = LARGEST_UPLOAD) -> None:
        self.store, self.tire, self.largest = store, tire, largest
        self.lock = threading.Lock()
        self.job: Job | None = None
        self.number = 0
        self._seen: dict[tuple[str, int, int], dict[str, Any]] = {}

    def state(self) -> dict[str, Any]:
        """Return everything that the page shows."""
        with self.lock:
            uploads = self.store.uploads()
            job = self.job
        return {
            "recordings": [self._told(upload) for upload in uploads],
            "job": None
            if job is None
            else {
                "running": job.running,
                "stages": list(job.stages),
                "problem": job.problem,
                "number": self.number,
            },
            "diagnoses": [_diagnosis(number, folder) for number, folder in self.store.diagnoses()],
            "largest": self.largest,
        }

    def add(self, name: str, stream: Any, size: int) -> dict[str, Any]:
        """Keep an upload and return what it was understood to be; nothing is kept of what is no recording."""
        from .understood import understood

        arrived = self.store.arrive(name, stream, size)
        with self.lock:
            upload = self.store.keep(arrived)
        try:
            understood(upload.file, upload.name)
        except BaseException:
            self.store.remove(upload)
            raise
        return self._told(upload)

    def change(self, number: int, given: Any) -> dict[str, Any]:
        """Change how a recording is read and used, and return what it was understood to be then."""
        from .understood import CHANNEL_NAMES

        if not isinstance(given, Mapping):
            raise TirelabError("settings are an object")
        with self.lock:
            upload = self.store.upload(number)
            if "use" in given:
                self.store.use(upload, str(given["use"]))
            if "columns" in given or "units" in given or "radius" in given:
                radius = given.get("radius", "")
                if not clean_text(radius):
                    raise TirelabError('the surface is a short text such as "flat" or "25.4 cm"')
                columns = clean_texts(given.get("columns", {}), CHANNEL_NAMES)
                units = clean_texts(given.get("units", {}), CHANNEL_NAMES)
                self.store.settings(upload, columns, units, radius.strip())
            return self._told(self.store.upload(number))

    def remove(self, number: int) -> None:
        """Delete a recording."""
        with self.lock:
            self.store.remove(self.store.upload(number))

    def diagnose(self) -> None:
        """Begin a diagnosis. Raises TirelabError where one runs, or no recording is to be fitted."""
        with self.lock:
            if self.job is not None and self.job.running:
                raise TirelabError("a diagnosis runs already; wait for it, or stop it")
            uploads = [u for u in self.store.uploads() if u.use != "left out"]
            unread = [u.name for u in uploads if self._told(u)["problem"]]
            if unread:
                raise TirelabError(f"{unread[0]} cannot be read yet; correct its columns, or leave it out")
            self.number, folder = self.store.next_diagnosis()
            self.job = Job(Order.of(uploads, self.tire, folder))

    def stop(self) -> None:
        """Stop the diagnosis that runs."""
        if self.job is not None and self.job.running:
            self.job.stop()

    def close(self) -> None:
        """Stop what runs, and wait until it has cleaned up."""
        self.stop()
        if self.job is not None:
            self.job.wait(PATIENCE)
            self.job.kill()

    def _told(self, upload: Upload) -> dict[str, Any]:
        """Return what a recording was understood to be; read again where its file or settings changed."""
        from .understood import Understood, understood

        beside = upload.file.with_suffix(".toml")
        changed = beside.stat().st_mtime_ns if beside.exists() else 0
        key = (str(upload.file), upload.file.stat().st_mtime_ns, changed)
        if key not in self._seen:
            try:
                found = understood(upload.file, upload.name)
            except TirelabError as error:
                found = Understood((), (), problem=str(error))
            self._seen[key] = {**found.to_dict(), "settings": _settings(upload)}
        return {"number": upload.number, "name": upload.name, "use": upload.use, **self._seen[key]}


def _settings(upload: Upload) -> dict[str, Any]:
    from ..recordings.metadata import read_sidecar

    try:
        told = read_sidecar(upload.file)
    except TirelabError:
        return {"columns": {}, "units": {}, "radius": ""}
    return {"columns": dict(told.columns), "units": dict(told.units), "radius": told.radius or ""}


def _diagnosis(number: int, folder: Path) -> dict[str, Any]:
    from ..report.first_screen import headline, sureness
    from .store import RESULTS

    content = json.loads((folder / "diagnosis.json").read_text(encoding="utf-8"))
    return {
        "number": number,
        "headline": headline(content),
        "sure": sureness(content["verdict"]),
        "files": [name for name in RESULTS if (folder / name).is_file()],
    }


class Server(ThreadingHTTPServer):
    """The server with its token; `address` is what a browser opens."""

    daemon_threads = True

    def __init__(self, workbench: Workbench, port: int = 0) -> None:
        super().__init__((HOST, port), Handler)
        self.workbench = workbench
        self.token = secrets.token_urlsafe(18)

    @cached_property
    def hosts(self) -> tuple[str, ...]:
        """What a request may call this machine: another name is a trick of a foreign page (DNS rebinding)."""
        return tuple(f"{name}:{self.server_address[1]}" for name in (HOST, "localhost"))

    @property
    def address(self) -> str:
        """The address of the page."""
        return f"http://{HOST}:{self.server_address[1]}/{self.token}/"


class Handler(BaseHTTPRequestHandler):
    """Answers one connection."""

    server: Server
    protocol_version = "HTTP/1.1"
    server_version = "tirelab"
    sys_version = ""
    timeout = SILENT

    def do_GET(self) -> None:
        """Answer with the page, the state, or a file of a diagnosis."""
        self._answer(self._get)

    def do_POST(self) -> None:
        """Receive a recording or settings, or begin a diagnosis."""
        self._answer(self._post)

    def do_DELETE(self) -> None:
        """Delete a recording, or stop the diagnosis."""
        self._answer(self._delete)

    def log_message(self, format: str, *args: Any) -> None:
        """Say nothing: the token would be in it."""

    def _answer(self, act: Any) -> None:
        try:
            act(self._path())
        except Refused as refused:
            self._send_json({"problem": refused.sentence}, refused.status, close=True)
        except TirelabError as error:
            self._send_json({"problem": str(error)}, HTTPStatus.UNPROCESSABLE_ENTITY, close=True)
        except (BrokenPipeError, ConnectionResetError, TimeoutError):
            self.close_connection = True
        except Exception as error:  # a fault of ours must not leave the page waiting
            problem = f"internal error ({type(error).__name__}: {error}); please report it with the recording"
            self._send_json({"problem": problem}, HTTPStatus.INTERNAL_SERVER_ERROR, close=True)

    def _path(self) -> str:
        """Return the path after the token. Raises Refused for a wrong token, host or origin."""
        host, origin = self.headers.get("Host", ""), self.headers.get("Origin")
        if host not in self.server.hosts or origin not in (None, *(f"http://{h}" for h in self.server.hosts)):
            raise Refused(HTTPStatus.FORBIDDEN, "this page answers this machine only")
        token, _, path = urlsplit(self.path).path.removeprefix("/").partition("/")
        if not hmac.compare_digest(token.encode("utf-8", "replace"), self.server.token.encode()):
            raise Refused(HTTPStatus.FORBIDDEN, "open the address that tirelab open printed")
        return path

    def _get(self, path: str) -> None:
        if path in _OWN:
            package, name = _OWN[path]
            text = resources.files(package).joinpath(name).read_bytes()
            self._send(text, _TYPES[Path(name).suffix], {"Content-Security-Policy": POLICY})
        elif path == "state":
            self._send_json(self.server.workbench.state())
        elif found := re.fullmatch(r"diagnoses/(\d{1,4})/([A-Za-z_]+\.[a-z]+)", path):
            self._send_file(self.server.workbench.store.result(int(found[1]), found[2]))
        else:
            raise Refused(HTTPStatus.NOT_FOUND, "there is no such page")

    def _post(self, path: str) -> None:
        bench = self.server.workbench
        if path == "recordings":
            name = parse_qs(urlsplit(self.path).query).get("name", [""])[0]
            size = self._size(bench.largest)
            self._send_json(bench.add(name, self.rfile, size), HTTPStatus.CREATED)
        elif found := re.fullmatch(r"recordings/(\d{1,4})", path):
            self._send_json(bench.change(int(found[1]), self._json()))
        elif path == "diagnose":
            self._size(LARGEST_TEXT)
            bench.diagnose()
            self._send_json({}, HTTPStatus.ACCEPTED)
        else:
            raise Refused(HTTPStatus.NOT_FOUND, "there is no such page")

    def _delete(self, path: str) -> None:
        if found := re.fullmatch(r"recordings/(\d{1,4})", path):
            self.server.workbench.remove(int(found[1]))
        elif path == "diagnose":
            self.server.workbench.stop()
        else:
            raise Refused(HTTPStatus.NOT_FOUND, "there is no such page")
        self._send_json({})

    def _size(self, largest: int) -> int:
        """Return the length of what is sent. Raises Refused where it is not said, or too large."""
        told = self.headers.get("Content-Length", "")
        if not told.isdecimal():
            raise Refused(HTTPStatus.LENGTH_REQUIRED, "the length of the file is not told; drop it again")
        if int(told) > largest:
            raise Refused(
                HTTPStatus.REQUEST_ENTITY_TOO_LARGE,
                f"the file has {int(told) / 1e6:.0f} MB and at most {largest / 1e6:.0f} MB are taken; "
                "cut it into shorter recordings",
            )
        return int(told)

    def _json(self) -> Any:
        try:
            return json.loads(self.rfile.read(self._size(LARGEST_TEXT)))
        except ValueError:
            raise TirelabError("settings are JSON") from None

    def _send_json(self, content: Any, status: HTTPStatus = HTTPStatus.OK, close: bool = False) -> None:
        headers = {"Connection": "close"} if close else {}
        self._send(json.dumps(content).encode(), _TYPES[".json"], headers, status)

    def _send_file(self, file: Path | None) -> None:
        if file is None:
            raise Refused(HTTPStatus.NOT_FOUND, "there is no such file")
        kind = "inline" if file.suffix == ".html" else "attachment"
        headers = {"Content-Disposition": f'{kind}; filename="{file.name}"'}
        self._send(file.read_bytes(), _TYPES[file.suffix], headers)

    def _send(
        self, body: bytes, kind: str, headers: Mapping[str, str], status: HTTPStatus = HTTPStatus.OK
    ) -> None:
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(body)))
        self.send_header("Cache-Control", "no-store")
        self.send_header("X-Content-Type-Options", "nosniff")
        self.send_header("Referrer-Policy", "no-referrer")
        self.send_header("Cross-Origin-Resource-Policy", "same-origin")
        self.send_header("X-Frame-Options", "DENY")
        for name, text in headers.items():
            self.send_header(name, text)
        self.end_headers()
        self.wfile.write(body)
