"""`Task`: a finger that follows the edge of a cloth or a cable, in closed loop, simulated.

    values = task.reset(seed)
    values, ended = task.step(command)      # one frame later
    task.metrics()

Each step is a frame of the sensor. A frame arrives `latency` frames late, and the finger follows
commanded velocities with the lag of its actuator. The object does not move or deform.
"""

import math
from collections import deque
from dataclasses import dataclass

import numpy as np

from lumitip import arguments
from lumitip.control import Command
from lumitip.errors import LumitipError
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.tasks.curve import LONGEST_MM, STEP_MM, Curve
from lumitip.tasks.motion import advance, in_sensor
from lumitip.twin import Cable, Corner, HalfPlane, Scene, Twin
from lumitip.values import shown

KINDS = ("cloth", "cable")
RATE_HZ = 55.0
"""Frame rate of the published firmware (Hz)."""
LOST_MM = 9.0
"""Error of the line's height beyond which it is lost (mm)."""
SEEN_MM = 40.0
"""Distance of a corner within which the fingertip may see it (mm)."""
STRAIGHT_MM = 80.0
"""Length of the straight edge before a corner (mm)."""
END_MM = 25.0
"""Rest of a curve without corner that a trial leaves, as its end must not be seen (mm)."""
_STILL_MM_S = 0.5


class TaskError(LumitipError, ValueError):
    """An invalid setting or input of a task."""


@dataclass(frozen=True)
class Settings:
    """Settings of a task."""

    kind: str = "cloth"
    """`"cloth"` (sheet on the side of the tip) or `"cable"`."""
    length_mm: float = 400.0
    """Length of the curve (mm)."""
    corner: bool = False
    """Whether a cloth ends in a corner; else the curve ends the task."""
    rate_hz: float = RATE_HZ
    latency: int = 1
    """Frames from a contact until the controller sees it."""
    lag_s: float = 0.03
    """Time constant of the velocity of the actuator (s)."""
    noise: float = 1.5
    """Standard deviation of a value (counts of 255)."""
    target_mm: float = 0.0
    """Target height of the line in the grid (mm)."""
    dead_cells: int = 0
    """Cells that do not see the light, others in each trial."""
    dead_value: float | None = None
    """What a dead cell reads (counts of 255); nothing (NaN) by default."""

    def __post_init__(self) -> None:
        if not isinstance(self.kind, str) or self.kind not in KINDS:
            raise TaskError(f"kind is {shown(self.kind)}; allowed are {', '.join(KINDS)}")
        if self.corner and self.kind != "cloth":
            raise TaskError("corner: a cable has none")
        arguments.finite_fields(self, TaskError)
        arguments.count(self.latency, "latency", 0, TaskError)
        arguments.number(self.length_mm, "length_mm", most=LONGEST_MM, above=0.0, error=TaskError)
        arguments.number(self.rate_hz, "rate_hz", above=0.0, error=TaskError)
        arguments.count(self.dead_cells, "dead_cells", 0, TaskError)
        if self.dead_value is not None:
            arguments.number(self.dead_value, "dead_value", 0.0, 255.0, error=TaskError)
        for name in ("lag_s", "noise"):
            arguments.number(getattr(self, name), name, 0.0, error=TaskError)


def checked(command: Command) -> Command:
    """The command, if it is valid.

    Raises:
        TaskError: if it is no command, or a velocity is not finite.
    """
    arguments.finite_fields(arguments.instance(command, Command, "command", TaskError), TaskError)
    return command


@dataclass(frozen=True, slots=True)
class Metrics:
    """Errors of a trial, against the true line."""

    reason: str
    """`"end"`, `"corner"`, `"lost"`, or `""` while it runs."""
    travelled_mm: float
    seconds: float
    lateral_rms_mm: float
    """Error of the line's height."""
    angle_rms_deg: float
    """Angle between the line and the finger."""
    corner_error_mm: float
    """Error of the vertex in x at the end; NaN without corner."""

    @property
    def lost(self) -> bool:
        """Whether the line was lost, or the finger stopped without reason."""
        return self.reason == "lost"


class Task:
    """A simulated finger on a line. Seeded: the same commands give the same frames."""

    def __init__(
        self, layout: Layout, settings: Settings | None = None, twin: Twin | None = None
    ) -> None:
        """A task on the curve of seed 0.

        Args:
            layout: the cells.
            settings: of the task.
            twin: simulates the sensor; by default that of the layout. Its noise is not used.

        Raises:
            LayoutError: if `layout` is no layout.
            TaskError: if an argument is invalid, or the twin is of another layout.
        """
        self.layout = arguments.layout(layout)
        settings = Settings() if settings is None else settings
        self.settings = arguments.instance(settings, Settings, "settings", TaskError)
        twin = Twin(layout) if twin is None else twin
        self.twin = arguments.instance(twin, Twin, "twin", TaskError)
        if self.twin.layout != layout:
            raise TaskError(
                f"the design of the twin is {self.twin.layout.design_hash[:16]}; that of the "
                f"layout is {layout.design_hash[:16]}. Use a twin of this layout."
            )
        if self.settings.dead_cells > len(layout):
            raise TaskError(
                f"dead_cells is {self.settings.dead_cells}; the layout has {len(layout)} cells"
            )
        self.reset()

    def reset(self, seed: int = 0) -> Floats:
        """Start a trial on the curve of a seed; returns the first values, shape `(cells,)`.

        Raises:
            TaskError: if the seed is no whole number from 0 on.
        """
        seed = arguments.count(seed, "seed", 0, TaskError)
        s = self.settings
        straight_mm = STRAIGHT_MM if s.corner else 0.0
        self.curve = Curve.random(s.length_mm, seed, straight_mm)
        self._chance = np.random.default_rng((8, seed))
        cells = np.random.default_rng((9, seed)).permutation(len(self.layout))
        self.dead = cells[: s.dead_cells]
        """Cells that do not see the light in this trial."""
        self.x_mm, self.y_mm, self.heading = 0.0, -s.target_mm, 0.0
        self._at = 0
        self._velocity = np.zeros(3)
        self._frames = 0
        self._misses: list[tuple[float, float]] = []
        self.reason = ""
        first = self._read()
        self._late = deque([first] * (s.latency + 1), maxlen=s.latency + 1)
        return first

    def step(self, command: Command) -> tuple[Floats, bool]:
        """Advance by one frame.

        Args:
            command: velocity in the sensor frame. A state of `"stop"` ends the trial once the
                finger stands still.

        Returns:
            The values that have arrived by then, shape `(cells,)`, and whether the trial ended.

        Raises:
            TaskError: if it is no command, or a velocity is not finite.
        """
        checked(command)
        self._move(command)
        self._frames += 1
        self._at = self.curve.nearest(self.x_mm, self.y_mm, self._at)
        height_mm, angle = self.line()
        self._misses.append((height_mm - self.settings.target_mm, angle))
        self._late.append(self._read())
        self._judge(command, height_mm)
        return self._late[0], bool(self.reason)

    @property
    def travelled_mm(self) -> float:
        """Distance along the curve so far (mm)."""
        return self._at * STEP_MM

    def line(self) -> tuple[float, float]:
        """True height of the line above the middle of the grid (mm), and its direction (rad), in
        the sensor frame."""
        offset_mm, angle = self._tangent()
        return offset_mm / math.cos(angle), angle

    def scene(self) -> Scene:
        """The object between the fingers now."""
        offset_mm, angle = self._tangent()
        bend = float(self.curve.bend_per_mm[self._at])
        if self.settings.kind == "cable":
            return Cable(offset_mm=offset_mm, angle_deg=math.degrees(angle), curvature_per_mm=bend)
        vertex = self._vertex()
        if vertex is not None and vertex[0] < SEEN_MM:
            turn = math.degrees(float(self.curve.heading[-1]) - self.heading)
            return Corner(x_mm=vertex[0], y_mm=vertex[1], angle_deg=turn + 135.0)
        # The sheet is left of the line, towards the tip: right of the reversed line.
        return HalfPlane(
            offset_mm=-offset_mm, angle_deg=math.degrees(angle) + 180.0, curvature_per_mm=-bend
        )

    def metrics(self) -> Metrics:
        """Errors of the trial so far."""
        misses = np.array(self._misses or [(0.0, 0.0)])
        rms = np.sqrt((misses**2).mean(axis=0))
        vertex = self._vertex()
        at_corner = self.reason == "corner" and vertex is not None
        return Metrics(
            reason=self.reason,
            travelled_mm=self.travelled_mm,
            seconds=self._frames / self.settings.rate_hz,
            lateral_rms_mm=float(rms[0]),
            angle_rms_deg=math.degrees(float(rms[1])),
            corner_error_mm=vertex[0] if at_corner and vertex else math.nan,
        )

    def _judge(self, command: Command, height_mm: float) -> None:
        still = float(np.hypot(*self._velocity[:2])) < _STILL_MM_S
        if abs(height_mm - self.settings.target_mm) > LOST_MM:
            self.reason = "lost"
        elif command.state == "stop" and still:
            near = (v := self._vertex()) is not None and abs(v[0]) < LOST_MM
            self.reason = "corner" if command.reason == "corner" and near else "lost"
        elif self.settings.corner:
            vertex = self._vertex()
            if vertex is not None and vertex[0] < -LOST_MM:  # the edge is behind the finger
                self.reason = "lost"
        elif self.travelled_mm >= self.curve.length_mm - END_MM:
            self.reason = "end"

    def _move(self, command: Command) -> None:
        asked = np.array([command.forward_mm_s, command.lateral_mm_s, command.rotation_rad_s])
        dt_s, lag_s = 1.0 / self.settings.rate_hz, self.settings.lag_s
        pose, self._velocity = advance(self._pose, self._velocity, asked, dt_s, lag_s)
        self.x_mm, self.y_mm, self.heading = pose.tolist()

    @property
    def _pose(self) -> Floats:
        return np.array([self.x_mm, self.y_mm, self.heading])

    def _in_sensor(self, at: int) -> tuple[float, float]:
        x_mm, y_mm = in_sensor(self.curve.x_mm[at], self.curve.y_mm[at], self._pose)
        return float(x_mm), float(y_mm)

    def _tangent(self) -> tuple[float, float]:
        """Signed distance (mm) and direction (rad) of the curve at its point nearest the origin."""
        x, y = self._in_sensor(self._at)
        angle = float(self.curve.heading[self._at]) - self.heading
        return y * math.cos(angle) - x * math.sin(angle), angle

    def _vertex(self) -> tuple[float, float] | None:
        return self._in_sensor(-1) if self.settings.corner else None

    def _read(self) -> Floats:
        noise = self.settings.noise * self._chance.standard_normal(len(self.layout))
        values: Floats = np.floor(np.clip(self.twin.values(self.scene()) + noise, 0.0, 255.0))
        read = self.settings.dead_value
        values[self.dead] = math.nan if read is None else read
        return values
