"""`FingerRegistry`: the fingertips displayed, and the browsers to notify of changes."""

import asyncio
import re
import threading
from collections.abc import Iterable
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Any

from lumitip.errors import ViewError
from lumitip.view.estimating import EXPECTED, Expected
from lumitip.view.finger import Finger

MOST_REPLAYS = 8
"""Replays open at once: each has its frames in memory."""
_SUFFIX = ".mcap"


class FingerRegistry:
    """Fingers by number, and the folder of recordings.

    Args:
        fingers: open; the registry closes them.
        folder: of recordings.
        expected: by the estimates, in replays that the page opens.
    """

    def __init__(
        self, fingers: Iterable[Finger], folder: Path, expected: Expected = EXPECTED
    ) -> None:
        self.folder = folder
        self.expected = expected
        self.fingers: dict[int, Finger] = {}
        self._number = 0
        self._wakers: set[asyncio.Event] = set()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._waking = threading.Event()
        self._adding = threading.Lock()
        self._replaying = threading.Lock()
        for finger in fingers:
            self.add(finger)

    def open(self, loop: asyncio.AbstractEventLoop) -> None:
        """Start reading all fingers; `loop` runs the sessions of browsers."""
        self._loop = loop
        for finger in self.fingers.values():
            finger.start(self.changed)

    def close(self) -> None:
        """End recordings and disconnect."""
        self._loop = None
        with ExitStack() as stack:  # closes all, even if one fails
            for finger in self.fingers.values():
                stack.callback(finger.close)

    def add(self, finger: Finger) -> int:
        """Add a finger; returns its number. Thread-safe."""
        with self._adding:
            self._number += 1
            self.fingers = {**self.fingers, self._number: finger}
            if self._loop:
                finger.start(self.changed)
            return self._number

    def remove(self, number: int) -> None:
        """Remove a finger. Thread-safe."""
        with self._adding:
            finger = self.fingers[number]
            self.fingers = {n: f for n, f in self.fingers.items() if n != number}
        finger.close()
        self.changed()

    def listen(self) -> asyncio.Event:
        """An event that is set on each change; on the loop."""
        event = asyncio.Event()
        self._wakers.add(event)
        return event

    def leave(self, event: asyncio.Event) -> None:
        """Remove an event; on the loop."""
        self._wakers.discard(event)

    def changed(self) -> None:
        """Wake the sessions of browsers. Thread-safe."""
        loop = self._loop
        # One pending call is enough: a session looks for all changes.
        if loop is None or self._waking.is_set():
            return
        self._waking.set()
        try:
            loop.call_soon_threadsafe(self._wake)
        except RuntimeError:  # the loop is closed: there are no sessions
            self._waking.clear()

    def _wake(self) -> None:
        self._waking.clear()
        for event in self._wakers:
            event.set()

    def describe(self) -> list[dict[str, Any]]:
        """Layouts of the fingers for JSON."""
        return [
            {
                "number": number,
                "url": finger.url,
                "device": finger.tip.device_id,
                "replayed": finger.player is not None,
                "scene": finger.tip.simulated.controls() if finger.tip.simulated else None,
                "design": finger.tip.layout.design_hash[:16],
                "pitch_mm": finger.tip.layout.pitch_mm,
                "x_mm": finger.tip.layout.x_mm.tolist(),
                "y_mm": finger.tip.layout.y_mm.tolist(),
            }
            for number, finger in self.fingers.items()
        ]

    def recordings(self) -> list[str]:
        """Names of the recordings in the folder, newest first."""
        changed_ns: dict[str, int] = {}
        for file in self.folder.glob(f"*{_SUFFIX}"):
            # A name may be not encodable, and a file may disappear.
            with suppress(OSError, UnicodeEncodeError):
                file.name.encode()
                if file.is_file():
                    changed_ns[file.name] = file.stat().st_mtime_ns
        return sorted(changed_ns, key=changed_ns.__getitem__, reverse=True)

    def recording(self, name: str) -> Path:
        """The path of a recording in the folder.

        Raises:
            ViewError: if there is no such recording.
        """
        if name not in self.recordings():
            raise ViewError(f"there is no recording {name!r} in {self.folder}")
        return self.folder / name

    def replay(self, name: str) -> int:
        """Play a recording in the folder, in its open replay if there is one; returns its number.

        Raises:
            LumitipError: if there is no such recording, it cannot be played, or `MOST_REPLAYS`
                are open.
        """
        from lumitip.view.player import Player, content_of

        with self._replaying:
            path = self.recording(name)
            content = content_of(path)
            replays = {number: f.player for number, f in self.fingers.items() if f.player}
            for number, player in replays.items():
                if player.content == content:
                    player.control(playing=True)
                    return number
            if len(replays) >= MOST_REPLAYS:
                raise ViewError(
                    f"{len(replays)} replays are open; {MOST_REPLAYS} are allowed. Close one, then "
                    f"replay {name}"
                )
            return self.add(Finger.play(name, Player(path), (), self.expected))

    def finished(self, name: str) -> Path:
        """The path of a recording that is complete.

        Raises:
            ViewError: if there is no such recording, or it is being written.
        """
        path = self.recording(name)
        if any(finger.is_recording_to(name) for finger in self.fingers.values()):
            raise ViewError(f"{name} is being recorded. Stop it first, then download it")
        return path

    def fresh(self, finger: Finger) -> Path:
        """The path of a new recording of a finger, with its name and a number."""
        name = re.sub(r"[^A-Za-z0-9-]+", "-", finger.tip.device_id).strip("-") or "lumitip"
        taken = set(self.recordings())
        number = 1
        while f"{name}-{number:03d}{_SUFFIX}" in taken:
            number += 1
        return self.folder / f"{name}-{number:03d}{_SUFFIX}"
