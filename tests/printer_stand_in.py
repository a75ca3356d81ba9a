"""A 3D printer on a pseudo-terminal, with the answers of Marlin, or with others.

The order and the words of the answers are those of Marlin 2.1; OctoPrint's virtual printer, which
is written by others, gives the second form of `M114`.
"""

import os
import pty
import re
import select
import termios
import threading
from pathlib import Path

MARLIN = "FIRMWARE_NAME:Marlin 2.1.2.4 (Jan  3 2024 10:00:00) SOURCE_CODE_URL:github.com"


class StandIn:
    """Reads commands on a thread of its own until it is closed.

    Args:
        path: where its port appears.
        range_mm: of each axis; a move beyond ends there, as with Marlin's software end stops.
        answers: other answers to some commands, by their first word; `None` is silence.
        deaf_to: number of commands that it drops first, as a board that starts.
    """

    def __init__(
        self,
        path: Path,
        range_mm: tuple[float, float] = (-1000.0, 1000.0),
        answers: dict[str, str | None] | None = None,
        deaf_to: int = 0,
    ) -> None:
        self.place_mm = dict.fromkeys("XYZ", 0.0)
        self.commands: list[str] = []
        self._range, self._answers, self._deaf_to = range_mm, answers or {}, deaf_to
        self._relative = False
        self._master, self._slave = pty.openpty()
        settings = termios.tcgetattr(self._slave)
        settings[1] &= ~termios.OPOST
        settings[3] &= ~(termios.ECHO | termios.ICANON)
        termios.tcsetattr(self._slave, termios.TCSANOW, settings)
        path.symlink_to(os.ttyname(self._slave))
        self._closed = False
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def close(self) -> None:
        """End after the commands that have come; may be called twice."""
        if self._closed:
            return
        self._closed = True
        self._thread.join()
        os.close(self._master)
        os.close(self._slave)

    def _run(self) -> None:
        waiting = b""
        while True:
            if not select.select([self._master], [], [], 0.05)[0]:
                if self._closed:
                    return
                continue
            *lines, waiting = (waiting + os.read(self._master, 4096)).split(b"\n")
            for line in lines:
                self._obey(line.decode())

    def _obey(self, command: str) -> None:
        if self._deaf_to:
            self._deaf_to -= 1
            return
        self.commands.append(command)
        word = command.split(maxsplit=1)[0]
        if word in ("G90", "G91"):
            self._relative = word == "G91"
        if word == "G1" and word not in self._answers:
            for axis, number in re.findall(r"([XYZ])(-?[\d.]+)", command):
                wanted = float(number) + (self.place_mm[axis] if self._relative else 0.0)
                self.place_mm[axis] = min(max(wanted, self._range[0]), self._range[1])
        answer = self._answers.get(word, self._answer(word))
        if answer is not None:
            os.write(self._master, answer.encode())

    def _answer(self, word: str) -> str:
        places = " ".join(f"{axis}:{at:.2f}" for axis, at in self.place_mm.items())
        return {
            "M115": f"{MARLIN}\nCap:AUTOREPORT_TEMP:1\nok\n",
            "M114": f"{places} E:0.00 Count X:0 Y:0 Z:0\nok\n",
            "M400": "echo:busy: processing\nok\n",
        }.get(word, "ok\n")
