"""One browser: it gets the newest frames as fast as it draws them, and no faster.

At most `WINDOW` messages are on the way to it; it says of each when it was drawn. While the window
is full frames pass by, and the next message holds the newest with a count of those left out.
Nothing queues anywhere, however slow the browser is: also a hidden tab, which draws nothing.
"""

import asyncio
import json
import time
from collections import deque
from contextlib import suppress
from typing import Any

import numpy as np
from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState

from lumitip.view.finger import Finger
from lumitip.view.room import Room
from lumitip.view.wire import encode

WINDOW = 4
"""Most messages of one finger on the way: at 60 pictures and 200 frames a second, each frame."""
_STATUS_S = 0.5
_AGES = 600  # 10 s at 60 pictures a second


class Feed:
    """Frames of one finger on their way to one browser."""

    def __init__(self, finger: Finger) -> None:
        self.finger = finger
        self.skipped = 0
        """Frames left out so far."""
        self.drawn = 0
        """Messages drawn so far."""
        self._count = max(0, finger.count - 1)  # the last one is shown even if none follows
        self._number = 0
        self._flying: deque[tuple[int, float]] = deque()
        self._ages: deque[float] = deque(maxlen=_AGES)

    def next(self, finger_number: int) -> bytes | None:
        """The next message, `None` if there is nothing new or the window is full."""
        if len(self._flying) >= WINDOW:
            return None
        frames, skipped = self.finger.newer(self._count)
        if not frames:
            return None
        self._count += skipped + len(frames)
        self.skipped += skipped
        self._number += 1
        last, read = frames[-1]
        self._flying.append((self._number, read if self.finger.player else last.t))
        return encode(
            finger_number,
            self._number,
            [frame for frame, _ in frames],
            self.finger.contact(last),
            skipped,
            self.finger.since,
        )

    def acknowledge(self, number: int) -> None:
        """The browser has drawn message `number`, and with it all before."""
        now = time.monotonic()
        while self._flying and self._flying[0][0] <= number:
            sent, born = self._flying.popleft()
            self.drawn += 1
            # Earlier ones were overtaken before they were drawn; the first may be old.
            if sent == number and sent > 1:
                self._ages.append(now - born)

    def status(self) -> dict[str, Any]:
        """How this browser keeps up; ages reach from reading the cells to word of the drawing."""
        ages_ms = np.array(self._ages) * 1e3
        return {
            "skipped": self.skipped,
            "in_flight": len(self._flying),
            "age_ms": np.percentile(ages_ms, (50, 99)).tolist() if ages_ms.size else None,
        }


class Session:
    """Serves one browser until it leaves."""

    def __init__(self, websocket: WebSocket, room: Room) -> None:
        self._websocket = websocket
        self._room = room
        self._feeds: dict[int, Feed] = {}
        self._awake = room.listen()
        self._awake.set()
        self._status_due = 0.0
        self._status_flying = False

    async def run(self) -> None:
        """Send frames and listen for what was drawn; returns when the browser leaves."""
        # Whichever ends first, ends the other: a browser that left, or one that cannot be sent to.
        tasks = [asyncio.create_task(t) for t in (self._send(), self._listen())]
        try:
            done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            self._room.leave(self._awake)
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
        for task in done:
            with suppress(WebSocketDisconnect):
                task.result()

    async def _listen(self) -> None:
        # Sending notices first that the browser is gone; what it said before still comes.
        while self._websocket.application_state is WebSocketState.CONNECTED:
            with suppress(KeyError):  # bytes, which our page never sends
                self._heard(await self._websocket.receive_text())

    async def _send(self) -> None:
        while True:
            await self._wait()
            self._match()
            for number, feed in list(self._feeds.items()):
                message = feed.next(number)
                if message is not None:
                    await self._websocket.send_bytes(message)
            if time.monotonic() >= self._status_due and not self._status_flying:
                self._status_due = time.monotonic() + _STATUS_S
                self._status_flying = True
                await self._websocket.send_text(json.dumps(self._status()))

    async def _wait(self) -> None:
        """Until something changed, was drawn, or a status is due."""
        left = self._status_due - time.monotonic()
        try:
            await asyncio.wait_for(self._awake.wait(), _STATUS_S if left <= 0 else left)
        except TimeoutError:
            return
        self._awake.clear()

    def _match(self) -> None:
        """One feed for each finger that is shown now."""
        fingers = self._room.fingers
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

    def _heard(self, text: str) -> None:
        """`{"drawn": {"finger": number}, "status": true}`: what the browser has done with."""
        try:
            told = json.loads(text)
            drawn = {int(n): int(m) for n, m in told.get("drawn", {}).items()}
        except (ValueError, AttributeError, TypeError, OverflowError, RecursionError):
            return
        for number, message in drawn.items():
            if number in self._feeds:
                self._feeds[number].acknowledge(message)
        if told.get("status"):
            self._status_flying = False
        self._awake.set()
