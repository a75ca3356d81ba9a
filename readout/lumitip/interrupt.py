"""How a command ends. Ctrl-C (SIGINT): without a traceback, with exit status 130. SIGTERM, and
SIGHUP of a terminal that is closed: in the same way, so that files are whole, then by that signal.

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
_HANGUP = getattr(signal, "SIGHUP", None)  # the shell and the system both send it
_IMPORT = "<frozen importlib._bootstrap>"


def ending_signals() -> "tuple[int, ...]":
    """The signals that end a command, without those that it was started to ignore (`nohup`)."""
    others = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]
    return signal.SIGINT, *(n for n in others if signal.getsignal(n) != signal.SIG_IGN)


def leave_on_interrupt() -> None:
    """Let SIGINT end the process at once. For the time without anything to clean up."""
    signal.signal(signal.SIGINT, _leave)


def leave_with_daemons(status: int) -> None:
    """End the process here if a daemon thread still runs; to be called last, by `atexit`.

    Python would stop the thread where it next needs the interpreter. Within C++ code, which numpy
    has, that aborts the process.
    """
    import threading

    if not any(thread.daemon for thread in threading.enumerate()):
        return
    _flush()
    os._exit(status)


def leave_by_signal(status: int) -> None:
    """End the process by the signal that has ended its command, so that its parent sees which."""
    number = status - 128
    if number == signal.SIGINT or number not in ending_signals():
        return
    _flush()
    signal.signal(number, signal.SIG_DFL)
    signal.raise_signal(number)


def _flush() -> None:
    import contextlib

    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError):
            stream.flush()


def _leave(number: int, _: "FrameType | None" = None) -> None:
    os._exit(128 + number)


class InterruptGuard:
    """Raises `KeyboardInterrupt` on the first of `ending_signals`, and ends the process on the
    second, unless that is SIGHUP.

    A context manager for the main thread; on other threads it does nothing. During an import it
    waits for the end of that. Code written in C may drop an exception, and the command would go
    on: then it raises another.
    """

    def __init__(self) -> None:
        self.interrupted = False
        """Whether a signal came: other exceptions may follow from it."""
        self._by: int = signal.SIGINT
        self._before: dict[int, Any] = {}
        self._outside: FrameType | None = None
        self._hook = sys.unraisablehook
        self._inside = _thread.allocate_lock()
        """Held within the block."""

    @property
    def status(self) -> int:
        """Exit status of the command that the signal has ended."""
        return 128 + self._by

    def __enter__(self) -> "InterruptGuard":
        import threading

        if threading.current_thread() is threading.main_thread():
            self._outside = sys._getframe(1)
            self._inside.acquire()
            self._hook, sys.unraisablehook = sys.unraisablehook, self._unraisable
            self._before = {n: signal.signal(n, self._interrupt) for n in ending_signals()}
        return self

    def __exit__(
        self, _: type[BaseException] | None, __: BaseException | None, ___: "TracebackType | None"
    ) -> None:
        if self._before:
            for number, handler in self._before.items():
                signal.signal(number, handler)
            sys.unraisablehook = self._hook
            self._inside.release()
        self._outside = None

    def _interrupt(self, number: int, frame: "FrameType | None") -> None:
        if self.interrupted:
            if number != _HANGUP:
                _leave(number)
            return
        if number != signal.SIGINT:
            self._by = number  # a SIGINT may be ours, to interrupt once more
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
    """Keeps one of `ending_signals` until the end of a block, which must not be left half-done.

    A context manager for the main thread; on other threads it does nothing. Blocking the signal is
    not enough: threads of numpy's library may take it, and Python then raises in the main thread.

    Args:
        end: called when it comes, to end the block early.
    """

    def __init__(self, end: "Callable[[], None] | None" = None) -> None:
        self._end = end
        self._came: int | None = None
        self._before: dict[int, Any] = {}

    def __enter__(self) -> None:
        import threading

        if threading.current_thread() is threading.main_thread():
            self._before = {n: signal.signal(n, self._keep) for n in ending_signals()}

    def __exit__(
        self, _: type[BaseException] | None, __: BaseException | None, ___: "TracebackType | None"
    ) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)
        if self._came is not None:
            signal.raise_signal(self._came)

    def _keep(self, number: int, _: "FrameType | None") -> None:
        self._came = self._came or number
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
