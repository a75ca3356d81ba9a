"""Stands in for the controller of a UR arm on a loopback address, for the tests.

    python tests/ur_stand_in.py 127.0.0.5

Speaks RTDE (port 30004), as far as ur_rtde uses it, answers the dashboard (29999) and takes the
script (30003), of which it does the main loop: speed, stop and watchdog commands in registers. The
arm is a free body that takes on the speed it is told with the acceleration it is told. Each line
it prints is an event as JSON; each line it reads is a mishap:

    force X | protective | emergency | pause | freeze | drop | cut

`drop` ends the connections and takes no more, `cut` takes new ones.
"""

import asyncio
import json
import struct
import sys
import threading
import time
from collections.abc import Callable

import numpy as np
from scipy.spatial.transform import Rotation

STEP_S = 0.002
STOPPED, PLAYING, PAUSED = 1, 2, 4
READY, DONE = 1, 2  # of the script, in its integer register 0
SPEEDL, SPEED_STOP, SET_WATCHDOG, STOP_SCRIPT = 10, 15, 35, 255
TYPES = {"DOUBLE": "d", "INT32": "i", "UINT32": "I", "VECTOR6D": "6d"}


def type_of(name: str) -> str:
    if "int_register" in name:
        return "INT32"
    if "double_register" in name or name == "timestamp":
        return "DOUBLE"
    if name in ("runtime_state", "robot_status_bits", "safety_status_bits"):
        return "UINT32"
    vectors = ("actual_TCP_pose", "actual_TCP_speed", "actual_TCP_force", "external_force_torque")
    return "VECTOR6D" if name in vectors else "NOT_FOUND"


def say(event: str, **more: object) -> None:
    print(json.dumps({"event": event, "t": time.monotonic(), **more}), flush=True)


class Arm:
    """The body, the script and the registers between them."""

    def __init__(self) -> None:
        self.inputs: dict[str, float] = {}
        self.place = np.array([0.4, -0.2, 0.3])
        self.turn = Rotation.from_euler("xyz", [170.0, 20.0, 35.0], degrees=True)
        self.speed, self.target = np.zeros(6), np.zeros(6)
        self.acceleration, self.force = 1.0, 0.0
        self.runtime, self.safety, self.script = STOPPED, 1, READY
        self.executing = self.stopping = self.frozen = False
        self.watchdog_hz, self.written_s, self.time_s = 0.0, 0.0, 100.0

    def uploaded(self) -> None:
        self.runtime, self.script, self.executing, self.watchdog_hz = PLAYING, READY, False, 0.0
        say("script")

    def end_program(self, why: str, runtime: int = STOPPED) -> None:
        if self.runtime == PLAYING:
            self.runtime, self.target, self.acceleration = runtime, np.zeros(6), 2.0
            self.watchdog_hz = 0.0
            say("program ended", why=why)

    def command(self) -> None:
        """The main loop of the script, once for each package."""
        self.written_s = time.monotonic()
        number = int(self.inputs.get("input_int_register_0", 0))
        values = [self.inputs.get(f"input_double_register_{i}", 0.0) for i in range(8)]
        if self.runtime != PLAYING:
            return
        if number == SPEEDL:
            self.target, self.acceleration = np.array(values[:6]), values[6]
            self.script = READY
            say("speedl", twist=values[:6], acceleration=values[6], pose=self.pose())
        elif number == 0:
            self.executing, self.script = False, READY
        elif not self.executing:
            self.executing = True
            self.regular(number, values)

    def regular(self, number: int, values: list[float]) -> None:
        if number == SPEED_STOP:
            self.target, self.acceleration, self.stopping = np.zeros(6), values[0], True
            say("speed stop", acceleration=values[0])
        elif number == SET_WATCHDOG:
            self.watchdog_hz, self.script = values[0], DONE
            say("watchdog", hz=values[0])
        elif number == STOP_SCRIPT:
            say("stop script")
            self.end_program("script")
        else:
            say("unknown command", number=number)
            self.script = DONE

    def step(self) -> None:
        """Two milliseconds of the body."""
        now_s = time.monotonic()
        if self.watchdog_hz and now_s - self.written_s > 1.0 / self.watchdog_hz:
            self.end_program("watchdog")
        moved = bool(self.speed.any())
        change = self.target - self.speed
        # UR's manual of `speedl`: without aRot the same number is that of the rotation in rad/s².
        for axes in (slice(3), slice(3, 6)):
            size = float(np.linalg.norm(change[axes]))
            change[axes] *= min(1.0, self.acceleration * STEP_S / size) if size else 1.0
        self.speed += change
        self.place += self.speed[:3] * STEP_S
        self.turn = Rotation.from_rotvec(self.speed[3:] * STEP_S) * self.turn
        self.time_s += STEP_S
        if not self.speed.any():
            if self.stopping:
                self.stopping, self.script = False, DONE
            if moved:
                say("stands", pose=self.pose())

    def pose(self) -> list[float]:
        return [*self.place.tolist(), *self.turn.as_rotvec().tolist()]

    def output(self, name: str) -> tuple[float, ...]:
        told: dict[str, Callable[[], tuple[float, ...]]] = {
            "timestamp": lambda: (self.time_s,),
            "runtime_state": lambda: (self.runtime,),
            "robot_status_bits": lambda: (3,),
            "safety_status_bits": lambda: (self.safety,),
            "actual_TCP_pose": lambda: tuple(self.pose()),
            "actual_TCP_speed": lambda: tuple(self.speed.tolist()),
            "actual_TCP_force": lambda: (self.force, 0.0, 4.0, 0.0, 0.0, 0.0),
            "output_int_register_0": lambda: (self.script,),
        }
        return told.get(name, lambda: (0,))()

    def mishap(self, line: str) -> None:
        word, *more = line.split()
        say("mishap", line=line)
        if word == "force":
            self.force = float(more[0])
        elif word in ("protective", "emergency"):
            self.safety = {"protective": 1 << 2, "emergency": 1 << 7}[word]
            self.end_program(word, PAUSED)
        elif word == "pause":
            self.end_program("pause", PAUSED)
        elif word == "freeze":
            self.frozen = True


class Rtde:
    """One connection to port 30004: packages of size, type and payload."""

    def __init__(
        self, arm: Arm, reader: asyncio.StreamReader, writer: asyncio.StreamWriter
    ) -> None:
        self.arm, self.reader, self.writer = arm, reader, writer
        self.recipes: list[list[str]] = []
        self.outputs: list[str] = []
        self.period_s, self.sending = 0.0, False

    def send(self, kind: bytes, payload: bytes) -> None:
        self.writer.write(struct.pack(">HB", 3 + len(payload), kind[0]) + payload)

    async def run(self) -> None:
        while True:
            size, kind = struct.unpack(">HB", await self.reader.readexactly(3))
            self.take(bytes([kind]), await self.reader.readexactly(size - 3))

    def take(self, kind: bytes, body: bytes) -> None:
        if kind == b"V":
            self.send(kind, bytes([struct.unpack(">H", body)[0] == 2]))
        elif kind == b"v":
            self.send(kind, struct.pack(">4I", 5, 12, 0, 1101319))
        elif kind == b"O":
            self.period_s = 1.0 / struct.unpack(">d", body[:8])[0]
            self.outputs = [n for n in body[8:].decode().split(",") if n]
            self.send(kind, b"\1" + ",".join(map(type_of, self.outputs)).encode())
        elif kind == b"I":
            self.recipes.append([n for n in body.decode().split(",") if n])
            types = ",".join(map(type_of, self.recipes[-1])).encode()
            self.send(kind, bytes([len(self.recipes)]) + types)
        elif kind in (b"S", b"P"):
            self.sending = kind == b"S"
            self.send(kind, b"\1")
        elif kind == b"U":
            names = self.recipes[body[0] - 1]
            form = ">" + "".join(TYPES[type_of(n)] for n in names)
            self.arm.inputs.update(zip(names, struct.unpack(form, body[1:]), strict=False))
            self.arm.command()

    async def publish(self) -> None:
        while True:
            await asyncio.sleep(max(self.period_s, STEP_S))
            if self.sending and not self.arm.frozen:
                form = ">B" + "".join(TYPES[type_of(n)] for n in self.outputs)
                values = [v for name in self.outputs for v in self.arm.output(name)]
                self.send(b"U", struct.pack(form, 1, *values))


class StandIn:
    """The three servers and the clock."""

    def __init__(self, host: str) -> None:
        self.host, self.arm = host, Arm()
        self.servers: list[asyncio.Server] = []
        self.writers: set[asyncio.StreamWriter] = set()

    async def rtde(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.writers.add(writer)
        connection = Rtde(self.arm, reader, writer)
        publishing = asyncio.create_task(connection.publish())
        try:
            await connection.run()
        except (asyncio.IncompleteReadError, OSError):
            pass
        finally:
            publishing.cancel()
            self.writers.discard(writer)
            writer.close()

    async def dashboard(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.writers.add(writer)
        writer.write(b"Connected: Universal Robots Dashboard Server\n")
        answers = {
            b"PolyscopeVersion": b"URSoftware 5.12.0.1101319 (Nov 10 2022)",
            b"get serial number": b"20235500001",
            b"is in remote control": b"true",
        }
        while line := await reader.readline():
            if line.strip() == b"stop":
                self.arm.end_program("dashboard")
            writer.write(answers.get(line.strip(), b"Stopped") + b"\n")
        self.writers.discard(writer)
        writer.close()

    async def scripts(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.writers.add(writer)
        text = b""
        while piece := await reader.read(65536):
            text += piece
            if text.startswith(b"def rtde_control():\n") and text.endswith(b"\nend\n"):
                text = b""
                self.arm.uploaded()
        self.writers.discard(writer)
        writer.close()

    def take(self, line: str) -> None:
        if line.strip() in ("drop", "cut"):
            say("mishap", line=line.strip())
            for server in self.servers if line.strip() == "drop" else ():
                server.close()
            for writer in self.writers:
                writer.transport.abort()
        else:
            self.arm.mishap(line)

    async def run(self) -> None:
        for serve, port in ((self.rtde, 30004), (self.dashboard, 29999), (self.scripts, 30003)):
            self.servers.append(await asyncio.start_server(serve, self.host, port))
        loop, ended = asyncio.get_running_loop(), threading.Event()

        def listen() -> None:
            for line in sys.stdin:
                loop.call_soon_threadsafe(self.take, line)
            ended.set()  # the test is over

        threading.Thread(target=listen, daemon=True).start()
        say("listens")
        began_s = done_s = time.monotonic()
        while not ended.is_set():
            if time.monotonic() - done_s > 0.1:
                say("late", seconds=time.monotonic() - done_s)
            while done_s < time.monotonic() and not ended.is_set():
                self.arm.step()
                done_s += STEP_S
            await asyncio.sleep(STEP_S)
        say("ends", seconds=time.monotonic() - began_s)


if __name__ == "__main__":
    asyncio.run(StandIn(sys.argv[1]).run())
