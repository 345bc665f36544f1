"""The guard of the page passes requests with its token, and says why others do not pass."""

import asyncio

import pytest

pytest.importorskip("nicegui", reason="needs pip install 'tehl[explore]'")

from tehl.explore.case_text import LONGEST_ADDRESS
from tehl.explore.server import ADDRESS, REFUSED, TOO_LONG, Guard

PORT, TOKEN = 8765, "secret"


def reply_to(query, port=PORT, **headers):
    """Return status, headers and text of the reply of a page to a request."""
    sent = []

    async def page(_scope, _receive, send):
        await send({"type": "http.response.start", "status": 200, "headers": []})
        await send({"type": "http.response.body", "body": b"the page"})

    async def send(message):
        sent.append(message)

    stated = {"host": f"{ADDRESS}:{port}"} | headers
    scope = {
        "type": "http",
        "method": "GET",
        "query_string": query.encode(),
        "headers": [(key.encode(), value.encode()) for key, value in stated.items()],
    }
    asyncio.run(Guard(page, TOKEN, port)(scope, None, send))
    start, body = sent[0], sent[-1]["body"].decode()
    return start["status"], dict(start["headers"]), body


def test_the_token_passes_once_in_the_address_then_in_a_cookie():
    status, headers, _ = reply_to(f"token={TOKEN}")
    assert status == 200
    cookie = headers[b"set-cookie"].decode().partition(";")[0]
    assert reply_to("", cookie=cookie)[0] == 200
    status, _, text = reply_to("", cookie=cookie.replace(TOKEN, "old"))
    assert status == 403
    assert REFUSED in text


def test_two_pages_of_one_machine_have_cookies_of_their_own():
    cookies = [
        reply_to(f"token={TOKEN}", port)[1][b"set-cookie"].decode().partition(";")[0]
        for port in (PORT, PORT + 1)
    ]
    assert len(set(cookies)) == 2
    assert reply_to("", PORT, cookie="; ".join(cookies))[0] == 200
    assert reply_to("", PORT, cookie=cookies[1])[0] == 403


def test_a_link_that_is_too_long_is_a_sentence():
    assert reply_to(f"token={TOKEN}&case={'a' * LONGEST_ADDRESS}")[0] == 200
    status, _, text = reply_to(f"token={TOKEN}&case={'a' * (LONGEST_ADDRESS + 1000)}")
    assert status == 414
    assert TOO_LONG in text
