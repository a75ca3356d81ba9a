"""Who is let in, asked over a real connection."""

import http.client
import json
import time
from collections.abc import Callable
from urllib.parse import urlsplit

import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from lumitip.errors import ViewError
from lumitip.sharing import FingertipServer
from lumitip.view.server import ViewServer

Serve = Callable[..., ViewServer]


def ask(
    server: ViewServer, method: str, path: str, body: object = None, **headers: str
) -> http.client.HTTPResponse:
    """A request with just these headers; `Origin` and `Host` as given, bytes as they are."""
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=10)
    sent = {name.title(): text for name, text in headers.items()}
    text = body if body is None or isinstance(body, bytes) else json.dumps(body)
    connection.request(method, path, text, sent)
    answer = connection.getresponse()
    answer.text = answer.read().decode()  # type: ignore[attr-defined]
    connection.close()
    return answer


def here(server: ViewServer) -> str:
    return f"127.0.0.1:{server.port}"


def stream_status(server: ViewServer, **headers: str) -> int:
    """HTTP status that opening the stream is answered with."""
    origin = headers.pop("origin", None)
    try:
        with connect(
            f"ws://{here(server)}/stream", origin=origin, additional_headers=headers
        ) as stream:
            assert stream.recv(timeout=10)
            return 101
    except InvalidStatus as refused:
        return int(refused.response.status_code)


def test_page_of_this_server_may_post_and_stream(serve: Serve) -> None:
    server = serve("twin://disc")
    origin = f"http://{here(server)}"
    assert stream_status(server, origin=origin) == 101
    answer = ask(server, "POST", "/api/fingers/1/record", {"on": False}, origin=origin)
    assert answer.status == 200


@pytest.mark.parametrize(
    "origin",
    [
        None,
        "null",
        "http://example.org",
        "https://127.0.0.1:{port}",
        "http://127.0.0.1",
        "http://127.0.0.1:{port}.example.org",
        "http://localhost:{port}",
    ],
)
def test_another_origin_may_neither_post_nor_stream(serve: Serve, origin: str | None) -> None:
    server = serve("twin://disc")
    told = {"origin": origin.format(port=server.port)} if origin else {}
    assert stream_status(server, **told) == 403
    answer = ask(server, "POST", "/api/fingers/1/tare", {}, **told)
    assert answer.status == 403


@pytest.mark.parametrize(
    "host", ["example.org", "example.org:{port}", "127.0.0.1.example.org", "192.168.1.5:{port}", ""]
)
def test_a_name_that_was_pointed_here_is_refused(serve: Serve, host: str) -> None:
    server = serve("twin://disc")
    host = host.format(port=server.port)
    for path in ("/", "/api/fingers", "/main.js"):
        assert ask(server, "GET", path, host=host).status == 421
    origin = f"http://{host}"
    answer = ask(server, "POST", "/api/fingers/1/tare", {}, host=host, origin=origin)
    assert answer.status == 421


@pytest.mark.parametrize("host", ["localhost", "127.0.0.1", "[::1]"])
def test_names_of_this_computer_are_answered(serve: Serve, host: str) -> None:
    server = serve("twin://disc")
    assert ask(server, "GET", "/", host=f"{host}:{server.port}").status == 200


def test_another_address_needs_the_token(serve: Serve) -> None:
    server = serve("twin://disc", host="0.0.0.0")
    origin = f"http://{here(server)}"
    assert server.token
    assert len(server.token) >= 32
    assert server.url.endswith(f"/?token={server.token}")
    for path in ("/", "/api/fingers", "/main.js", "/?token=wrong", "/?token="):
        assert ask(server, "GET", path).status == 401, path
    assert ask(server, "POST", "/api/fingers/1/tare", {}, origin=origin).status == 401
    assert stream_status(server, origin=origin) == 403

    moved = ask(server, "GET", f"/?token={server.token}")
    assert (moved.status, moved.headers["Location"]) == (303, "/")
    cookie = moved.headers["Set-Cookie"]
    assert "HttpOnly" in cookie
    assert "SameSite=lax" in cookie
    shown = cookie.partition(";")[0]
    assert ask(server, "GET", "/", cookie=shown).status == 200
    # Cookies are shared by all ports of a host; those of other programs lock nobody out.
    for foreign in ('prefs={"theme":"dark"}', "a b=1", "=;;", "x=[1, 2]", 'q="'):
        assert ask(server, "GET", "/", cookie=f"{foreign}; {shown}; {foreign}").status == 200
    assert stream_status(server, origin=origin, Cookie=shown) == 101
    assert stream_status(server, origin="http://example.org", Cookie=shown) == 403
    assert ask(server, "GET", "/", cookie=shown.replace("=", "=x")).status == 401


def test_token_on_request_and_printed_for_this_computer(serve: Serve) -> None:
    server = serve("twin://disc", token="hand-made")
    assert ask(server, "GET", "/").status == 401
    assert ask(server, "GET", "/api/fingers?token=hand-made").status == 303
    assert urlsplit(server.url).hostname == "127.0.0.1"


def test_a_token_with_any_sign_is_let_in(serve: Serve) -> None:
    server = serve("twin://disc", token='a&b=c #"; %41')
    moved = ask(server, "GET", "/?" + urlsplit(server.url).query)
    assert moved.status == 303
    shown = moved.headers["Set-Cookie"].partition("; HttpOnly")[0]
    assert ask(server, "GET", "/", cookie=shown).status == 200
    with pytest.raises(ViewError, match="ASCII"):
        serve("twin://disc", token="gehe\u0131m")


def test_bytes_from_a_browser_end_nothing(serve: Serve) -> None:
    server = serve("twin://disc")
    with connect(f"ws://{here(server)}/stream", origin=f"http://{here(server)}") as stream:
        stream.recv(timeout=10)
        stream.send(b"bytes")
        for _ in range(20):
            stream.send(json.dumps({"drawn": {"1": 1_000_000}, "status": True}))
            assert stream.recv(timeout=10)


def test_every_answer_forbids_what_is_not_from_here(serve: Serve) -> None:
    server = serve("twin://disc")
    for path in ("/", "/main.js", "/api/fingers", "/nothing"):
        headers = ask(server, "GET", path).headers
        policy = headers["Content-Security-Policy"]
        assert "default-src 'none'" in policy
        assert "script-src 'self'" in policy
        assert "unsafe" not in policy
        assert headers["X-Content-Type-Options"] == "nosniff"


def test_files_outside_the_page_are_not_given(serve: Serve) -> None:
    server = serve("twin://disc")
    for path in ("/../app.py", "/%2e%2e/app.py", "/..%2fapp.py", "/static/../../registry.py"):
        assert ask(server, "GET", path).status == 404


@pytest.mark.parametrize(
    ("path", "body", "status", "told"),
    [
        ("/api/fingers/9/tare", {}, 409, "finger 9 is closed"),
        ("/api/fingers/" + 5000 * "9" + "/tare", {}, 404, ""),
        ("/api/fingers/-1/close", {}, 404, ""),
        ("/api/fingers/%D9%A3/close", {}, 404, ""),
        ("/api/fingers/1/tare", {"kind": "full"}, 409, "allowed are empty and dark"),
        ("/api/fingers/1/record", {}, 409, "on is None; true or false is needed"),
        ("/api/fingers/1/record", {"on": "true"}, 409, "on is 'true'; true or false is needed"),
        ("/api/fingers/1/record", {"on": 1}, 409, "on is 1; true or false is needed"),
        ("/api/fingers/1/close", {}, 409, "is live; only a replay can be closed"),
        ("/api/fingers/1/tare", [], 400, "a JSON object"),
        ("/api/fingers/1/tare", b"[" * 100_000, 400, "a JSON object"),
        ("/api/replay", {"name": "../../etc/passwd"}, 409, "there is no recording"),
        ("/api/replay", {}, 409, "there is no recording"),
        ("/api/nothing", {}, 405, ""),
    ],
)
def test_what_cannot_be_done_is_said(
    serve: Serve, path: str, body: object, status: int, told: str
) -> None:
    server = serve("twin://disc")
    answer = ask(server, "POST", path, body, origin=f"http://{here(server)}")
    assert answer.status == status
    assert told in answer.text  # type: ignore[attr-defined]


def test_a_place_beyond_numbers_is_refused(serve: Serve) -> None:
    server = serve("twin://disc")
    origin = f"http://{here(server)}"
    for told in ({"on": True}, {"on": False}):
        time.sleep(0.1)
        assert ask(server, "POST", "/api/fingers/1/record", told, origin=origin).status == 200
    name = {"name": "twin-disc-001.mcap"}
    assert ask(server, "POST", "/api/replay", name, origin=origin).status == 200
    told = {"position_s": 10**400}
    answer = ask(server, "POST", "/api/fingers/2/player", told, origin=origin)
    assert answer.status == 409
    assert "a number is needed" in answer.text  # type: ignore[attr-defined]


def test_the_token_of_a_shared_fingertip_is_not_shown(serve: Serve) -> None:
    with FingertipServer("twin://disc", port=0, token="s3cret") as shared:
        assert shared.address.endswith("?token=s3cret")
        asked = ask(serve(shared.address), "GET", "/api/fingers")
        (finger,) = json.loads(asked.text)  # type: ignore[attr-defined]
        assert finger["url"] == shared.address.replace("s3cret", "***")
    assert "s3cret" not in asked.text  # type: ignore[attr-defined]
