"""`Parent`: the program that opened the arm, as `ur_process` sees it."""

import json
import os
import queue
import sys
import threading
from typing import Any

from lumitip.control import Command
from lumitip.robots.guard import ArmState


class Parent:
    """The program at the other end of this process's pipes; the loop of the arm never waits for
    it."""

    def __init__(self) -> None:
        """Wait for the settings, then listen to commands."""
        self.asked: tuple[Command, float] | None = None
        """The newest command, with the time of its frame (s). A command to stop is the last."""
        self._pid = os.getppid()
        self._gone = threading.Event()
        self._lines: queue.SimpleQueue[str] = queue.SimpleQueue()
        # ur_rtde prints to descriptor 1, between the lines: from here on that leads to stderr.
        self._pipe = os.fdopen(os.dup(1), "w", encoding="utf-8")
        os.dup2(2, 1)
        self.settings: dict[str, Any] = json.loads(sys.stdin.readline() or "{}")
        """Of `URArm`; empty if the program ended before it sent them."""
        self._sender = threading.Thread(target=self._send, daemon=True)
        self._sender.start()
        threading.Thread(target=self._listen, daemon=True).start()

    def gone_within(self, seconds: float) -> bool:
        """Wait; whether the program closed the arm or ended."""
        # A process that the program forked may hold its end of the pipe open.
        return self._gone.wait(max(0.0, seconds)) or os.getppid() != self._pid

    def say(self, **message: object) -> None:
        """Send a line as soon as the program reads."""
        self._lines.put(json.dumps(message) + "\n")

    def show(self, state: ArmState) -> None:
        """Send a state, unless an earlier one was not read yet: the program may stand still."""
        if self._lines.empty():
            self.say(pose=state.pose.tolist(), twist=state.twist.tolist())

    def close(self) -> None:
        """Wait until all lines were read."""
        self._lines.put("")
        self._sender.join()

    def _send(self) -> None:
        try:
            while line := self._lines.get():
                self._pipe.write(line)
                self._pipe.flush()
        except BrokenPipeError:
            self._gone.set()

    def _listen(self) -> None:
        try:
            for line in sys.stdin:
                message = json.loads(line)
                if "close" in message:
                    break
                if not self.asked or self.asked[0].state != "stop":
                    self.asked = Command(**message["command"]), message["seen_s"]
        finally:
            self._gone.set()
