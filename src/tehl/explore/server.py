"""The server of the page: on the loopback address only, for whoever has the token."""

import asyncio
import logging
import os
import secrets
import socket
import tempfile
from http.cookies import SimpleCookie
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import parse_qs

from nicegui import app, background_tasks, ui
from starlette.responses import HTMLResponse

from tehl.base.errors import InputError
from tehl.base.lazy import lazy
from tehl.explore.case_text import LONGEST_ADDRESS, CaseText
from tehl.explore.files import LARGEST_UPLOAD, Files, named_files

if TYPE_CHECKING:
    from tehl.explore import page as pages
else:
    pages = lazy("tehl.explore.page")

ADDRESS = "127.0.0.1"
REFUSED = (
    "This address lacks the token of the running page. Open the address that `tehl explore` has "
    "printed in its terminal."
)
TOO_LARGE = f"An upload has at most {LARGEST_UPLOAD // 10**6} MB: crop the map before."
TOO_LONG = (
    f"This link is longer than {LONGEST_ADDRESS // 1000} kB, and may have been cut on its way: "
    "open the case as a file on the page."
)
_POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline' 'unsafe-eval'; "
    "style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; font-src 'self' data:; "
    "connect-src 'self'; worker-src 'self' blob:; frame-ancestors 'none'; base-uri 'self'"
)
_HEADERS = [
    (b"content-security-policy", _POLICY.encode()),
    (b"referrer-policy", b"no-referrer"),
    (b"x-content-type-options", b"nosniff"),
]


class Guard:
    """Lets requests with the token pass: in the address, once, then in a cookie.

    A request from another page, by its origin, or to another name of this machine does not pass.
    """

    def __init__(self, inner: Any, token: str, port: int) -> None:
        self.inner, self.token = inner, token
        self.cookie = f"tehl-{port}"
        self.hosts = {f"{ADDRESS}:{port}", f"localhost:{port}"}

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        """Pass a request on, or refuse it."""
        if scope["type"] not in ("http", "websocket"):
            await self.inner(scope, receive, send)
            return
        headers = {
            key.decode("latin-1"): value.decode("latin-1") for key, value in scope["headers"]
        }
        given = parse_qs(scope["query_string"].decode("latin-1")).get("token", [""])[0]
        if not self._may_pass(headers, given):
            await _refuse(scope, receive, send, REFUSED, 403)
            return
        # bytes beside the case
        if len(scope["query_string"]) > LONGEST_ADDRESS + 500:
            await _refuse(scope, receive, send, TOO_LONG, 414)
            return
        if scope["type"] == "http" and not _is_small(scope["method"], headers):
            await _refuse(scope, receive, send, TOO_LARGE, 413)
            return

        async def send_with_headers(message: Any) -> None:
            if message["type"] == "http.response.start":
                message["headers"] = [*message.get("headers", []), *_HEADERS, *self._stored(given)]
            await send(message)

        await self.inner(scope, receive, send_with_headers)

    def _may_pass(self, headers: dict[str, str], given: str) -> bool:
        origin = headers.get("origin", "")
        if headers.get("host") not in self.hosts:
            return False
        if origin and origin.removeprefix("http://") not in self.hosts:
            return False
        morsel = SimpleCookie(headers.get("cookie", "")).get(self.cookie)
        known = given or ("" if morsel is None else morsel.value)
        return secrets.compare_digest(known.encode(), self.token.encode())

    def _stored(self, given: str) -> list[tuple[bytes, bytes]]:
        if not given:
            return []
        words = f"{self.cookie}={self.token}; Path=/; HttpOnly; SameSite=Lax"
        return [(b"set-cookie", words.encode())]


def _is_small(method: str, headers: dict[str, str]) -> bool:
    """Return whether a request states a size, and one that an upload may have."""
    if method in ("GET", "HEAD", "OPTIONS"):
        return True
    length = headers.get("content-length", "")
    # bytes around the file
    return length.isdecimal() and int(length) <= LARGEST_UPLOAD + 100_000


async def _refuse(scope: Any, receive: Any, send: Any, words: str, code: int) -> None:
    """Reply with a sentence."""
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008})
        return
    page = f"<!doctype html><html lang=en><title>tehl explore</title><p>{words}</p></html>"
    await HTMLResponse(page, status_code=code)(scope, receive, send)


def serve(case: Path | None, text: str, port: int | None, *, browser: bool, report: Any) -> None:
    """Serve the page until Ctrl-C.

    Parameters
    ----------
    case, text : Path or None, str
        The case file of the user, None for a template; and its text.
    port : int or None
        Port; None takes the usual one, or another that is free.
    browser : bool
        Whether to open the page in the browser.
    report : callable
        Receives the address.
    """
    opened = CaseText(text)
    listening = _socket(port)
    taken = int(listening.getsockname()[1])
    if os.name != "posix":  # there the server binds a port itself
        listening.close()
    token = secrets.token_urlsafe(16)
    with tempfile.TemporaryDirectory(prefix="tehl-explore-") as folder:
        beside = None if case is None else case.resolve().parent
        stated = frozenset(name for _, name in named_files(opened.tables))

        page = pages.Page(opened, Files(Path(folder) / "uploads", beside, stated))
        app.add_middleware(Guard, token=token, port=taken)
        app.on_startup(page.start)
        app.on_shutdown(page.close)
        ui.page("/", title="tehl explore", favicon=_ICON, language="en-US", response_timeout=20)(
            page.build
        )
        logging.getLogger("uvicorn.error").addFilter(of_open_tabs)
        address = f"http://{ADDRESS}:{taken}/?token={token}"
        app.on_startup(lambda: background_tasks.create(_announce(taken, address, report)))
        ui.run(
            host=ADDRESS,
            port=taken,
            fd=listening.fileno() if os.name == "posix" else None,
            title="tehl explore",
            reload=False,
            show=f"/?token={token}" if browser else False,
            show_welcome_message=False,
            dark=None,
            reconnect_timeout=30.0,
            uvicorn_logging_level="error",
            timeout_graceful_shutdown=1,
            http="h11",  # the other parser has no reply to a long line but "Invalid HTTP request"
            # bytes of a request line, to reply to it: browsers send up to two million
            h11_max_incomplete_event_size=2_100_000,
        )


def of_open_tabs(record: logging.LogRecord) -> bool:
    """Return whether a message of the server concerns a tab that is still open.

    Starlette raises "No response returned." when a client disconnects before the response starts.
    """
    error = record.exc_info[1] if record.exc_info else None
    return not (isinstance(error, RuntimeError) and str(error) == "No response returned.")


async def _announce(port: int, address: str, report: Any) -> None:
    """Report the address as soon as it replies."""
    while True:
        try:
            _, writer = await asyncio.open_connection(ADDRESS, port)
        except OSError:
            await asyncio.sleep(0.02)
        else:
            writer.close()
            report(address)
            return


def _socket(wanted: int | None) -> socket.socket:
    """Return a socket that listens on a free port: the one wanted, the usual one, or any.

    The usual one is taken if it is free, so that a stored address finds the page again.

    Raises
    ------
    InputError
        If the one wanted is taken.
    """
    for port in (8765, 0) if wanted is None else (wanted,):
        found = socket.socket()
        if os.name == "posix":  # a port whose last page has just ended is free
            found.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            found.bind((ADDRESS, port))
            found.listen()
        except OSError:
            found.close()
            continue
        return found
    raise InputError(f"port {wanted} is taken by another program: choose another, or leave it out")


_ICON = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 32 32"><rect width="32" height="32" '
    'rx="7" fill="#1f4e9c"/><circle cx="16" cy="13" r="8" fill="none" stroke="#fff" '
    'stroke-width="2.5"/><path d="M4 25h24" stroke="#7fd1ae" stroke-width="3"/></svg>'
)
