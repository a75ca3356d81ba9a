"""`AsyncFingertip`: `Fingertip` for asyncio.

async with AsyncFingertip.open("ble://Lumitip", layout="outputs/layout.json") as tip:
    async for frame in tip: ...
"""

import asyncio
import contextlib
import threading
from collections.abc import AsyncIterator
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import Unpack, overload

from lumitip.arguments import count, seconds
from lumitip.calibration import Calibration, Kind
from lumitip.errors import EndOfRecording, FingertipClosed
from lumitip.fingertip import Fingertip
from lumitip.frame import Block, Frame, ended_early, too_late
from lumitip.layout import Layout
from lumitip.options import OpenOptions, check_options
from lumitip.session.hub import Hub


class AsyncFingertip:
    """An open fingertip, read by coroutines of one loop; made by `AsyncFingertip.open`.

    Tasks of the loop that entered it may call the coroutines. `tip.fingertip` is the `Fingertip`,
    for all that does not wait: `latest()`, `stats`, `layout`, `device_id`, `connected`, `drift`,
    `calibration`, `subscribe`.
    """

    def __init__(self, url: str, layout: Layout | str | Path | None, options: OpenOptions) -> None:
        self._url = url
        self._layout = layout
        self._options = options
        self._open: Fingertip | None = None
        self._queue: _AsyncQueue | None = None
        self._newest: _AsyncQueue | None = None
        self._handed_out: Frame | None = None
        self._opening = threading.Lock()
        self._abandoned = False

    @classmethod
    def open(
        cls,
        url: str,
        layout: Layout | str | Path | None = None,
        **options: Unpack[OpenOptions],
    ) -> "AsyncFingertip":
        """A fingertip for `async with`; arguments and errors of `Fingertip.open`."""
        check_options(options)
        return cls(url, layout, options)

    @property
    def fingertip(self) -> Fingertip:
        """The `Fingertip`. From any thread.

        Raises:
            FingertipClosed: outside of `async with`.
        """
        if self._open is None:
            raise FingertipClosed("not open: use `async with AsyncFingertip.open(url) as tip:`")
        return self._open

    @overload
    def latest(self, max_age_s: float) -> Frame: ...

    @overload
    def latest(self, max_age_s: float | None = None) -> Frame | None: ...

    def latest(self, max_age_s: float | None = None) -> Frame | None:
        """As `Fingertip.latest`; from any thread."""
        frame = self._handed_out = self.fingertip.latest(max_age_s)
        return frame

    async def read(self, timeout: float | None = 1.0) -> Frame:
        """As `Fingertip.read`; a cancelled call takes no frame."""
        frame = await self._reading().next(timeout)
        if frame is self.fingertip._hub.latest:
            self._handed_out = frame
        return frame

    async def wait_latest(self, timeout_s: float | None = 1.0) -> Frame:
        """As `Fingertip.wait_latest`; tasks that call it share the frames, the first one too."""
        timeout_s = seconds(timeout_s, "timeout_s")
        self._handed_out = self.fingertip._hub.pass_over(self._handed_out, timeout_s)
        if self._newest is None:
            self._newest = _AsyncQueue(self.fingertip._hub, 1, counted=False)
            newest = self.fingertip.latest()
            if newest is not None and newest is not self._handed_out:
                self._handed_out = newest
                return newest
        try:
            async with asyncio.timeout(timeout_s):
                while (frame := await self._newest.next(None)) is self._handed_out:
                    pass
        except TimeoutError:
            raise self.fingertip._hub.silent(timeout_s) from None
        self._handed_out = frame
        return frame

    async def get_data(self, num_samples: int, timeout: float | None = 10.0) -> Block:
        """As `Fingertip.get_data`, errors included."""
        number, timeout_s = count(num_samples, "num_samples"), seconds(timeout)
        frames: list[Frame] = []
        try:
            async with asyncio.timeout(timeout_s):
                while len(frames) < number:
                    frames.append(await self._reading().next(None))
        except TimeoutError:
            raise too_late(frames, number, timeout_s or 0.0) from None
        except EndOfRecording as end:
            raise ended_early(frames, number, end) from None
        return Block.of(frames)

    async def tare(
        self, kind: Kind = "empty", *, num_samples: int = 50, keep: bool = True
    ) -> Calibration:
        """As `Fingertip.tare`, on another thread."""
        tare = partial(self.fingertip.tare, kind, num_samples=num_samples, keep=keep)
        return await asyncio.to_thread(tare)

    async def __aiter__(self) -> AsyncIterator[Frame]:
        """Every frame from now to the end of a recording or `close`; each task gets all frames."""
        tip = self.fingertip
        queue = _AsyncQueue(tip._hub, tip._buffer)
        try:
            while True:
                yield await queue.next(None)
        except (EndOfRecording, FingertipClosed):
            return
        finally:
            queue.end()

    def __repr__(self) -> str:
        state = "not open" if self._open is None else repr(self._open)
        return f"<AsyncFingertip {self._url}: {state}>"

    async def __aenter__(self) -> "AsyncFingertip":
        try:
            await asyncio.to_thread(self._open_now)
        except asyncio.CancelledError:
            self._abandon()
            raise
        return self

    async def __aexit__(
        self, _: type[BaseException] | None, __: BaseException | None, ___: TracebackType | None
    ) -> None:
        tip, self._open, self._queue, self._newest = self.fingertip, None, None, None
        await asyncio.to_thread(tip.close)

    def _open_now(self) -> None:
        tip = Fingertip.open(self._url, self._layout, **self._options)
        with self._opening:
            self._open = tip
            abandoned = self._abandoned
        if abandoned:
            tip.close()

    def _abandon(self) -> None:
        # The connecting thread cannot be stopped: the later of the two closes the fingertip.
        with self._opening:
            self._abandoned = True
            tip = self._open
        if tip is not None:
            tip.close()

    def _reading(self) -> "_AsyncQueue":
        tip = self.fingertip
        if self._queue is None:
            self._queue = _AsyncQueue(tip._hub, tip._buffer)
        return self._queue


class _AsyncQueue:
    """A queue of the hub for coroutines."""

    def __init__(self, hub: Hub, size: int, counted: bool = True) -> None:
        self._hub = hub
        self._loop = asyncio.get_running_loop()
        self._came = asyncio.Event()
        self._queue = hub.queue(size, self._wake, counted)

    async def next(self, timeout_s: float | None) -> Frame:
        """As `Hub.next`."""
        timeout_s = seconds(timeout_s)
        try:
            async with asyncio.timeout(timeout_s):
                while True:
                    self._came.clear()
                    frame = self._queue.get(0)
                    if frame is not None:
                        return frame
                    await self._came.wait()
        except TimeoutError:
            raise self._hub.silent(timeout_s) from None

    def end(self) -> None:
        """Leave the hub."""
        self._hub.remove(self._queue)

    def _wake(self) -> None:
        # Frames may still arrive after the loop is closed, when the program ends.
        with contextlib.suppress(RuntimeError):
            self._loop.call_soon_threadsafe(self._came.set)
