"""How a command ends. Ctrl-C (SIGINT): without a traceback, with exit status 130.

Imports little: until `leave_on_interrupt` is called, Python answers Ctrl-C with a traceback.
"""

import _thread
import os
import signal
import sys

TYPE_CHECKING = False  # `typing` is slow to import

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import FrameType, TracebackType
    from typing import Any

INTERRUPTED = 128 + signal.SIGINT
"""Exit status of a command that Ctrl-C ended."""
_AGAIN_S = 0.05
_IMPORT = "<frozen importlib._bootstrap>"


def leave_on_interrupt() -> None:
    """Let SIGINT end the process at once. For the time without anything to clean up."""
    signal.signal(signal.SIGINT, _leave)


def leave_with_daemons(status: int) -> None:
    """End the process here if a daemon thread still runs; to be called last, by `atexit`.

    Python would stop the thread where it next needs the interpreter. Within C++ code, which numpy
    has, that aborts the process.
    """
    import contextlib
    import threading

    if not any(thread.daemon for thread in threading.enumerate()):
        return
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError):
            stream.flush()
    os._exit(status)


def _leave(_: int = 0, __: "FrameType | None" = None) -> None:
    os._exit(INTERRUPTED)


class InterruptGuard:
    """Raises `KeyboardInterrupt` on the first SIGINT, and ends the process on the second.

    A context manager for the main thread; on other threads it does nothing. During an import it
    waits for the end of that. Code written in C may drop an exception, and the command would go
    on: then it raises another.
    """

    def __init__(self) -> None:
        self.interrupted = False
        """Whether SIGINT came: other exceptions may follow from it."""
        self._before: Any = None
        self._outside: FrameType | None = None
        self._hook = sys.unraisablehook
        self._inside = _thread.allocate_lock()
        """Held within the block."""

    def __enter__(self) -> "InterruptGuard":
        import threading

        if threading.current_thread() is threading.main_thread():
            self._outside = sys._getframe(1)
            self._inside.acquire()
            self._hook, sys.unraisablehook = sys.unraisablehook, self._unraisable
            self._before = signal.signal(signal.SIGINT, self._interrupt)
        return self

    def __exit__(
        self, _: type[BaseException] | None, __: BaseException | None, ___: "TracebackType | None"
    ) -> None:
        if self._before is not None:
            signal.signal(signal.SIGINT, self._before)
            sys.unraisablehook = self._hook
            self._inside.release()
        self._outside = None

    def _interrupt(self, _: int, frame: "FrameType | None") -> None:
        if self.interrupted:
            _leave()
        if self._is_importing(frame):
            _interrupt_again()
            return
        self.interrupted = True
        # Not by `threading`, whose locks this thread may hold.
        _thread.start_new_thread(self._raise_again, (_thread.get_ident(),))
        raise KeyboardInterrupt

    def _raise_again(self, main: int) -> None:
        """Interrupt a main thread that goes on within the block and handles no exception."""
        while not self._inside.acquire(timeout=_AGAIN_S):
            if sys._current_exceptions().get(main) in (None, (None, None, None)):
                self.interrupted = False
                _interrupt_main()
                return
        self._inside.release()

    def _is_importing(self, frame: "FrameType | None") -> bool:
        while frame is not None and frame is not self._outside:
            if frame.f_code.co_filename == _IMPORT:
                return True
            frame = frame.f_back
        return False

    def _unraisable(self, problem: "sys.UnraisableHookArgs") -> None:
        if not self.interrupted:
            self._hook(problem)
        elif problem.exc_type is KeyboardInterrupt:
            # Raised in a destructor, where Python drops it: raise it again after that.
            self.interrupted = False
            _interrupt_again()


class InterruptsHeld:
    """Keeps a SIGINT until the end of a block, which must not be left half-done.

    A context manager for the main thread; on other threads it does nothing. Blocking the signal is
    not enough: threads of numpy's library may take it, and Python then raises in the main thread.

    Args:
        end: called when it comes, to end the block early.
    """

    def __init__(self, end: "Callable[[], None] | None" = None) -> None:
        self._end = end
        self._came = False
        self._before: Any = None

    def __enter__(self) -> None:
        import threading

        if threading.current_thread() is threading.main_thread():
            self._before = signal.signal(signal.SIGINT, self._keep)

    def __exit__(
        self, _: type[BaseException] | None, __: BaseException | None, ___: "TracebackType | None"
    ) -> None:
        if self._before is not None:
            signal.signal(signal.SIGINT, self._before)
            if self._came:
                signal.raise_signal(signal.SIGINT)

    def _keep(self, _: int, __: "FrameType | None") -> None:
        self._came = True
        if self._end:
            self._end()


def _interrupt_again() -> None:
    import threading

    threading.Timer(_AGAIN_S, _interrupt_main).start()


def _interrupt_main() -> None:
    """A signal to the main thread, which also wakes it while it waits for a lock."""
    import threading

    if hasattr(signal, "pthread_kill"):
        ident = threading.main_thread().ident
        assert ident is not None
        signal.pthread_kill(ident, signal.SIGINT)
    else:  # Windows
        signal.raise_signal(signal.SIGINT)
