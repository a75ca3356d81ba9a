"""The session of one browser: flow control, and the binary messages of frames.

A browser acknowledges each message once it is drawn, and at most `WINDOW` messages are not yet
acknowledged. While the window is full frames are skipped; the next message has the newest frames
and the number skipped. So nothing queues for a slow browser or a hidden tab. `wire` has the
messages.
"""

import asyncio
import json
import time
from collections import deque
from contextlib import suppress
from typing import Any

import numpy as np
from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState

from lumitip.view.estimating import Estimated
from lumitip.view.finger import Finger
from lumitip.view.losses import Losses
from lumitip.view.registry import FingerRegistry
from lumitip.view.wire import encode, encode_estimate

WINDOW = 4
"""Most unacknowledged messages of one finger: enough for every frame at 200 Hz, drawn at 60 Hz."""
_STATUS_S = 0.5
_AGES = 600  # 10 s at 60 Hz


class Feed:
    """The frames of one finger for one browser."""

    def __init__(self, finger: Finger) -> None:
        self.finger = finger
        self.skipped = 0
        """Number of frames skipped."""
        self.drawn = 0
        """Number of messages of frames drawn."""
        self._count = max(0, finger.count - 1)  # sends the newest frame at once
        self._number = 0
        self._since = self._count
        self._estimated: Estimated | None = None
        self._pending: deque[tuple[int, float | None]] = deque()
        self._ages: deque[float] = deque(maxlen=_AGES)
        self._losses = Losses(replayed=finger.player is not None)

    def next(self, finger_number: int) -> bytes | None:
        """The next message, `None` if there is nothing new or the window is full."""
        if len(self._pending) >= WINDOW:
            return None
        frames, skipped = self.finger.newer(self._count)
        if not frames:
            return None
        self._count += skipped + len(frames)
        self.skipped += skipped
        self._number += 1
        last, read = frames[-1]
        self.finger.estimates.ask(last, self._count)
        self._pending.append((self._number, read if self.finger.player else last.t))
        return encode(
            finger_number,
            self._number,
            [frame for frame, _ in frames],
            self.finger.contact(last),
            skipped,
            self.finger.since,
        )

    def estimate(self, finger_number: int) -> str | None:
        """The newest estimate, `None` if it was sent, or if the window is full."""
        found = self.finger.estimates.newest
        # An estimate from before this browser came is of an old frame.
        if found is None or found is self._estimated or found.number <= self._since:
            return None
        if len(self._pending) >= WINDOW:
            return None
        self._estimated = found
        self._number += 1
        self._pending.append((self._number, None))
        return encode_estimate(
            finger_number, self._number, found.frame.t - self.finger.since, found.shown
        )

    def acknowledge(self, number: int) -> None:
        """Note that the browser has drawn all messages up to `number`."""
        now = time.monotonic()
        newest = None
        while self._pending and self._pending[0][0] <= number:
            sent, born = self._pending.popleft()
            if born is not None:
                self.drawn += 1
                newest = sent, born
        # Messages before the newest were never drawn; the first may be old.
        if newest and newest[0] > 1:
            self._ages.append(now - newest[1])

    def status(self) -> dict[str, Any]:
        """Statistics for JSON; ages are from reading the cells to the acknowledgement."""
        ages_ms = np.array(self._ages) * 1e3
        return {
            "skipped": self.skipped,
            "losses": self._losses.status(self.finger.tip.stats, self.skipped),
            "in_flight": len(self._pending),
            "age_ms": np.percentile(ages_ms, (50, 99)).tolist() if ages_ms.size else None,
        }


class Session:
    """Serves one browser until it disconnects."""

    def __init__(self, websocket: WebSocket, registry: FingerRegistry) -> None:
        self._websocket = websocket
        self._registry = registry
        self._feeds: dict[int, Feed] = {}
        self._awake = registry.listen()
        self._awake.set()
        self._status_due = 0.0
        self._status_pending = False

    async def run(self) -> None:
        """Send frames and receive acknowledgements; returns when the browser disconnects."""
        # The first task to end also ends the other.
        tasks = [asyncio.create_task(t) for t in (self._send(), self._listen())]
        try:
            done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            self._registry.leave(self._awake)
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
        for task in done:
            with suppress(WebSocketDisconnect):
                task.result()

    async def _listen(self) -> None:
        # Sending fails first when the browser disconnects; its last messages still arrive.
        while self._websocket.application_state is WebSocketState.CONNECTED:
            with suppress(KeyError):  # a binary message, which our page never sends
                self._acknowledged(await self._websocket.receive_text())

    async def _send(self) -> None:
        while True:
            await self._wait()
            self._match()
            for number, feed in list(self._feeds.items()):
                message = feed.next(number)
                if message is not None:
                    await self._websocket.send_bytes(message)
                estimate = feed.estimate(number)
                if estimate is not None:
                    await self._websocket.send_text(estimate)
            if time.monotonic() >= self._status_due and not self._status_pending:
                self._status_due = time.monotonic() + _STATUS_S
                self._status_pending = True
                await self._websocket.send_text(json.dumps(self._status()))

    async def _wait(self) -> None:
        """Wait for a change, an acknowledgement, or the next status."""
        left = self._status_due - time.monotonic()
        # Not by `wait_for`: until Python 3.12 it drops a cancellation that comes with a change.
        with suppress(TimeoutError):
            async with asyncio.timeout(_STATUS_S if left <= 0 else left):
                await self._awake.wait()
            self._awake.clear()

    def _match(self) -> None:
        """Keep one feed for each finger."""
        fingers = self._registry.fingers
        if self._feeds.keys() != fingers.keys():
            kept = self._feeds
            self._feeds = {n: kept[n] if n in kept else Feed(f) for n, f in fingers.items()}

    def _status(self) -> dict[str, Any]:
        return {
            "fingers": {
                str(number): feed.finger.status() | feed.status()
                for number, feed in self._feeds.items()
            }
        }

    def _acknowledged(self, text: str) -> None:
        """Read `{"drawn": {"finger": number}, "status": true}`."""
        try:
            message = json.loads(text)
            drawn = {int(n): int(m) for n, m in message.get("drawn", {}).items()}
        except (ValueError, AttributeError, TypeError, OverflowError, RecursionError):
            return
        for finger, number in drawn.items():
            if finger in self._feeds:
                self._feeds[finger].acknowledge(number)
        if message.get("status"):
            self._status_pending = False
        self._awake.set()
