"""Slow browsers get fewer frames; the server reads every one."""

import asyncio
import json
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Page
from starlette.websockets import WebSocket, WebSocketState
from websockets.sync.client import ClientConnection, connect

from lumitip.frame import Frame
from lumitip.view.finger import KEPT, Finger
from lumitip.view.registry import FingerRegistry
from lumitip.view.server import ViewServer
from lumitip.view.session import WINDOW, Session

pytestmark = pytest.mark.slow

Serve = Callable[..., ViewServer]
WaitFor = Callable[[Callable[[], bool]], None]


class Seen:
    """The numbers of all frames that the server read."""

    def __init__(self) -> None:
        self.seq: list[int] = []

    def take(self, finger: Finger, frame: Frame) -> None:  # noqa: ARG002
        """Note one."""
        self.seq.append(frame.seq)


def stream(server: ViewServer) -> ClientConnection:
    here = f"127.0.0.1:{server.port}"
    return connect(f"ws://{here}/stream", origin=f"http://{here}")  # type: ignore[arg-type]


def parsed(message: bytes | str) -> dict[str, Any]:
    """A message of frames, or an estimate, which skips none and has none."""
    if isinstance(message, str):
        return {"skipped": 0, "seq": [], **json.loads(message)["estimate"]}
    head = struct.unpack_from("<BBHHHHHIII", message)
    finger, frames, _, markers, _, number, skipped, _ = head[2:]
    at = 24 + 8 * frames + 80 + 8 * markers
    seq = struct.unpack_from(f"<{frames}I", message, at)
    return {"finger": finger, "number": number, "skipped": skipped, "seq": list(seq)}


def until_silent(client: ClientConnection) -> list[bytes | str]:
    """Messages of frames and estimates until nothing comes for a while."""
    messages = list[bytes | str]()
    while True:
        try:
            message = client.recv(timeout=0.5)
        except TimeoutError:
            return messages
        if isinstance(message, bytes) or "estimate" in json.loads(message):
            messages.append(message)
            assert len(messages) < 50, "it does not wait for the browser"


def test_a_browser_that_does_not_draw_gets_a_window_and_no_more(
    serve: Serve, wait_for: WaitFor
) -> None:
    server = serve("twin://disc?rate=500")
    finger = server.registry.fingers[1]
    with stream(server) as client:
        first = until_silent(client)
        assert [parsed(m)["number"] for m in first] == list(range(1, WINDOW + 1))
        before = finger.count
        wait_for(lambda: finger.count > before + 2 * KEPT)
        client.send(json.dumps({"drawn": {"1": WINDOW}}))
        after = until_silent(client)
    assert [parsed(m)["number"] for m in after] == list(range(WINDOW + 1, 2 * WINDOW + 1))
    assert sum(parsed(m)["skipped"] for m in first) == 0
    first, after = ([m for m in some if isinstance(m, bytes)] for some in (first, after))
    caught_up = parsed(after[0])
    assert len(caught_up["seq"]) == KEPT
    # Nothing is missing but what is said to be.
    last = parsed(first[-1])["seq"][-1]
    assert caught_up["seq"][0] == last + 1 + caught_up["skipped"]
    assert caught_up["skipped"] > 0
    following = [s for m in after for s in parsed(m)["seq"]]
    assert following == list(range(following[0], following[0] + len(following)))


def test_a_browser_that_draws_gets_every_frame(serve: Serve) -> None:
    server = serve("twin://disc?rate=200")
    got: list[int] = []
    with stream(server) as client:
        while len(got) < 300:
            message = client.recv(timeout=10)
            if isinstance(message, str) and "estimate" not in json.loads(message):
                client.send(json.dumps({"status": True}))
                continue
            frames = parsed(message)
            assert frames["skipped"] == 0
            got += frames["seq"]
            client.send(json.dumps({"drawn": {"1": frames["number"]}}))
    assert got == list(range(got[0], got[0] + len(got)))


def test_one_slow_browser_does_not_slow_another(serve: Serve) -> None:
    server = serve("twin://disc?rate=500")
    with stream(server) as slow, stream(server) as quick:
        frames = 0
        while frames < 300:
            message = quick.recv(timeout=10)
            if isinstance(message, bytes) or "estimate" in json.loads(message):
                frames += len(parsed(message)["seq"])
                quick.send(json.dumps({"drawn": {"1": parsed(message)["number"]}}))
        assert len(until_silent(slow)) == WINDOW


def test_who_comes_late_sees_the_last_frame(serve: Serve, wait_for: WaitFor) -> None:
    server = serve("twin://disc")
    finger = server.registry.fingers[1]
    wait_for(lambda: finger.count > 3)
    finger.tip.close()
    wait_for(lambda: finger.status()["state"] == "ended")
    with stream(server) as client:
        message = until_silent(client)[0]
    last = finger.tip.stats.received - 1
    assert parsed(message)["seq"] == [last]


def test_who_comes_late_gets_the_estimate_of_the_last_frame_and_no_older_one(
    serve: Serve, wait_for: WaitFor
) -> None:
    server = serve("twin://edge")
    finger = server.registry.fingers[1]
    with stream(server) as client:
        wait_for(lambda: finger.estimates.newest is not None)
        until_silent(client)  # the window is full: no frame is asked for any more
    old = finger.estimates.newest
    assert old
    wait_for(lambda: finger.count > old.number + 20)
    finger.tip.close()
    wait_for(lambda: finger.status()["state"] == "ended")
    for _ in range(3):
        with stream(server) as client:
            frame, estimate = until_silent(client)
        assert parsed(frame)["number"] == 1
        assert parsed(estimate)["number"] == 2
        assert finger.estimates.newest
        assert finger.estimates.newest.number == finger.count
        assert parsed(estimate)["t"] == finger.newer(finger.count - 1)[0][0][0].t - finger.since


def test_a_browser_that_left_before_its_last_words_are_read_leaves_quietly(
    tmp_path: Path,
) -> None:
    """The socket refuses what is sent while words of the browser still wait to be read."""

    async def main() -> None:
        refused = asyncio.Event()

        async def receive() -> dict[str, Any]:
            if websocket.client_state is WebSocketState.CONNECTING:
                return {"type": "websocket.connect"}
            await refused.wait()
            return {"type": "websocket.receive", "text": "{}"}

        async def send(message: dict[str, Any]) -> None:
            if message["type"] == "websocket.send":
                refused.set()
                raise OSError("gone")

        websocket = WebSocket({"type": "websocket"}, receive, send)
        await websocket.accept()
        await asyncio.wait_for(Session(websocket, FingerRegistry((), tmp_path)).run(), 10.0)

    asyncio.run(main())


@pytest.mark.parametrize("rounds", range(5))
def test_a_browser_that_leaves_just_after_an_acknowledgement_ends_its_session(
    tmp_path: Path, rounds: int
) -> None:
    """`asyncio.wait_for` of Python 3.11 dropped the cancellation, and the session stayed."""

    async def main() -> None:
        said = iter(
            [
                {"type": "websocket.connect"},
                {"type": "websocket.receive", "text": "{}"},
                {"type": "websocket.receive", "text": "{}"},
                {"type": "websocket.disconnect", "code": 1001},
            ]
        )

        async def receive() -> dict[str, Any]:
            for _ in range(rounds):
                await asyncio.sleep(0)
            return next(said)

        async def send(_: dict[str, Any]) -> None:
            return

        websocket = WebSocket({"type": "websocket"}, receive, send)
        await websocket.accept()
        await asyncio.wait_for(Session(websocket, FingerRegistry((), tmp_path)).run(), 10.0)

    asyncio.run(main())


NONSENSE = (
    "",
    "[]",
    "7",
    "{",
    '{"drawn": 3}',
    '{"drawn": {"x": 1}}',
    '{"drawn": {"1": null}}',
    '{"drawn": {"9": 1}}',
    '{"drawn": {"1": -5}}',
    '{"drawn": {"1": 1e999}}',
    "[" * 5000,
)


def test_nonsense_from_a_browser_changes_nothing(serve: Serve) -> None:
    server = serve("twin://disc")
    with stream(server) as client:
        for said in NONSENSE:
            client.send(said)
        assert len(until_silent(client)) == WINDOW
        client.send(json.dumps({"drawn": {"1": WINDOW}}))
        assert len(until_silent(client)) == WINDOW


def run(page: Page, folder: Path, wait_for: WaitFor, seconds: float) -> None:
    """200 Hz into a page that stands still for half a second now and then."""
    seen = Seen()
    finger = Finger.open("twin://demo?rate=200", sinks=(seen,))
    with ViewServer(FingerRegistry([finger], folder), port=0) as server:
        page.goto(server.url)
        page.wait_for_selector(".finger[data-seq]")
        statuses = []
        for _ in range(max(1, round(seconds / 2))):
            page.evaluate(
                "const until = performance.now() + 500; while (performance.now() < until);"
            )
            before = finger.count
            wait_for(lambda: finger.count >= before + 300)  # noqa: B023
            statuses.append(page.evaluate("lumitip.panels.get(1).status"))
        drawn = int(page.locator(".finger").get_attribute("data-seq") or -1)
        stats = finger.tip.stats
        page.goto("about:blank")  # or it would ask the stopped server again, and report an error
    assert seen.seq == list(range(seen.seq[0], seen.seq[0] + len(seen.seq)))
    assert stats.dropped == {"link": 0, "queue": 0, "crc": 0, "length": 0}
    assert len(seen.seq) >= 300 * len(statuses)
    assert all(status["in_flight"] <= WINDOW for status in statuses)
    assert drawn > seen.seq[0]


def test_200_hz_into_a_browser(page: Page, tmp_path: Path, wait_for: WaitFor) -> None:
    run(page, tmp_path, wait_for, 2.0)


def test_200_hz_into_a_browser_for_20_s(page: Page, tmp_path: Path, wait_for: WaitFor) -> None:
    run(page, tmp_path, wait_for, 20.0)
