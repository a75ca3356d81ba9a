"""The one event loop that bleak runs in, on a thread of its own.

All Bluetooth links of a program share it: bleak keeps state for each loop and is made for one.
Nothing but bleak runs there, so nothing keeps it from taking what the system delivers.
"""

import asyncio
import atexit
import contextlib
import threading
from collections.abc import Coroutine
from concurrent.futures import Future
from functools import cache
from typing import Any, TypeVar

T = TypeVar("T")


class LoopThread:
    """An event loop on a thread of its own, to the end of the program."""

    def __init__(self) -> None:
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(
            target=self._loop.run_forever, name="lumitip-bleak", daemon=True
        )
        self._thread.start()
        atexit.register(self._end)

    def submit(self, coroutine: Coroutine[Any, Any, T]) -> "Future[T]":
        """Run a coroutine there. From any other thread."""
        return asyncio.run_coroutine_threadsafe(coroutine, self._loop)

    def _end(self) -> None:
        # bleak disconnects a device when its task is cancelled; the system would keep it connected
        # after the program has ended, and no other program could then find it.
        with contextlib.suppress(TimeoutError):
            self.submit(_cancel_all()).result(5.0)
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(5.0)


async def _cancel_all() -> None:
    tasks = asyncio.all_tasks() - {asyncio.current_task()}
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)


@cache
def shared_loop() -> LoopThread:
    """The program's loop for bleak, started when it is first needed."""
    return LoopThread()
