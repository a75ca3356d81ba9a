"""`TaskBatch`: many `Task`s of one kind that advance together, as arrays over the tasks."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lumitip.grid import Floats, Integers
from lumitip.layout import Layout
from lumitip.tasks.curve import REACH_MM, STEP_MM, Curve
from lumitip.tasks.motion import advance, in_sensor
from lumitip.tasks.task import END_MM, LOST_MM, SEEN_MM, STRAIGHT_MM, Settings, Task
from lumitip.twin import Corner, Twin
from lumitip.twin.lines import Numbers

Flags = NDArray[np.bool_]
_REACH = round(REACH_MM / STEP_MM)
_FRAMES = 64  # frames of noise that are drawn at once


class TaskBatch:
    """Fingers on lines. Task `i` with a seed gives the frames of a `Task` with that seed."""

    def __init__(
        self,
        number: int,
        layout: Layout,
        settings: Settings | None = None,
        twin: Twin | None = None,
    ) -> None:
        """Tasks that all begin on the curve of seed 0.

        Args:
            number: of tasks.
            layout, settings, twin: of each, see `Task`.

        Raises:
            LayoutError, TaskError: if one of these is invalid.
        """
        task = Task(layout, settings, twin)
        self.settings, self.twin, self.layout = task.settings, task.twin, task.layout
        cells, s = len(layout), self.settings
        points = task.curve.x_mm.size
        self._curve_x, self._curve_y, self._curve_heading, self._bend = np.zeros(
            (4, number, points)
        )
        self._all = np.arange(number)
        self._last = np.full(number, points - 1)
        self._chance = [np.random.default_rng(0)] * number
        self._noise = np.zeros((number, _FRAMES, cells))
        self._read_frames = np.zeros(number, np.int64)
        self._dead = np.zeros((number, s.dead_cells), np.int64)
        self.pose = np.zeros((number, 3))
        """x, y (mm) and heading (rad) of each finger, shape `(tasks, 3)`."""
        self._velocity = np.zeros((number, 3))
        self._at: Integers = np.zeros(number, np.int64)
        self._late = np.zeros((s.latency + 1, number, cells))
        self.lost = np.zeros(number, bool)
        """Tasks that lost the line, shape `(tasks,)`."""
        self.ended = np.zeros(number, bool)
        """Tasks that ended, lost or at the end of the curve, shape `(tasks,)`."""
        self.reset(range(number), [0] * number)

    def reset(self, tasks: Sequence[int], seeds: Sequence[int]) -> Floats:
        """Start trials on the curves of seeds; returns their first values, `(tasks, cells)`."""
        s = self.settings
        for i, seed in zip(tasks, seeds, strict=True):
            curve = Curve.random(s.length_mm, seed, STRAIGHT_MM if s.corner else 0.0)
            self._curve_x[i], self._curve_y[i] = curve.x_mm, curve.y_mm
            self._curve_heading[i], self._bend[i] = curve.heading, curve.bend_per_mm
            self._chance[i] = np.random.default_rng((8, seed))
            cells = np.random.default_rng((9, seed)).permutation(len(self.layout))
            self._dead[i] = cells[: s.dead_cells]
        index = np.asarray(tasks, np.int64)
        self.pose[index] = 0.0, -s.target_mm, 0.0
        self._velocity[index] = 0.0
        self._at[index] = self._read_frames[index] = 0
        self.lost[index] = self.ended[index] = False
        first = self._read(index)
        self._late[:, index] = first
        return first

    def step(self, asked: Floats) -> Floats:
        """Advance all tasks by one frame; a task that ended goes on all the same.

        Args:
            asked: forward and lateral (mm/s) and turning velocity (rad/s), shape `(tasks, 3)`.

        Returns:
            The values that have arrived by then, shape `(tasks, cells)`.
        """
        self._move(asked)
        self._at = self._nearest()
        self._late[:-1] = self._late[1:]
        self._late[-1] = self._read(self._all)
        self._judge()
        arrived: Floats = self._late[0].copy()
        return arrived

    @property
    def travelled_mm(self) -> Floats:
        """Distance of each finger along its curve so far, shape `(tasks,)` (mm)."""
        travelled: Floats = np.multiply(self._at, STEP_MM, dtype=np.float64)
        return travelled

    def line(self) -> tuple[Numbers, Numbers]:
        """True height of each line above the middle of the grid (mm), and its direction (rad), in
        the sensor frame; both of shape `(tasks,)`."""
        offset_mm, angle = self._tangent(self._all)
        return offset_mm / np.cos(angle), angle

    def direction_ahead(self, ahead_mm: Floats) -> Numbers:
        """Direction of each line a way further along it (rad), in the sensor frame, `(tasks,)`.

        Args:
            ahead_mm: the ways, shape `(tasks,)`.
        """
        at = np.minimum(self._at + np.round(ahead_mm / STEP_MM).astype(np.int64), self._last)
        ahead: Floats = self._curve_heading[self._all, at] - self.pose[:, 2]
        return ahead

    def _move(self, asked: Floats) -> None:
        dt_s, lag_s = 1.0 / self.settings.rate_hz, self.settings.lag_s
        self.pose, self._velocity = advance(self.pose, self._velocity, asked, dt_s, lag_s)

    def _nearest(self) -> Integers:
        near = self._at[:, None] + np.arange(-_REACH, _REACH + 1)
        rows, inside = self._all[:, None], np.clip(near, 0, self._curve_x.shape[1] - 1)
        x, y = self._curve_x[rows, inside], self._curve_y[rows, inside]
        away = (x - self.pose[:, :1]) ** 2 + (y - self.pose[:, 1:2]) ** 2
        best: Integers = inside[self._all, away.argmin(axis=1)]
        return best

    def _judge(self) -> None:
        s = self.settings
        self.lost = np.abs(self.line()[0] - s.target_mm) > LOST_MM
        if s.corner:  # the edge is behind the finger
            self.lost |= self._in_sensor(self._all, self._last)[0] < -LOST_MM
            self.ended = self.lost
        else:
            length_mm = (self._curve_x.shape[1] - 1) * STEP_MM
            self.ended = self.lost | (self.travelled_mm >= length_mm - END_MM)

    def _in_sensor(self, tasks: Integers, at: Integers) -> tuple[Numbers, Numbers]:
        return in_sensor(self._curve_x[tasks, at], self._curve_y[tasks, at], self.pose[tasks])

    def _tangent(self, tasks: Integers) -> tuple[Numbers, Numbers]:
        at = self._at[tasks]
        x, y = self._in_sensor(tasks, at)
        angle = self._curve_heading[tasks, at] - self.pose[tasks, 2]
        return y * np.cos(angle) - x * np.sin(angle), angle

    def _read(self, tasks: Integers) -> Floats:
        noise = self.settings.noise * self._next_noise(tasks)
        values: Floats = np.floor(np.clip(self._values(tasks) + noise, 0.0, 255.0))
        read = self.settings.dead_value
        rows = np.arange(tasks.size)[:, None]
        values[rows, self._dead[tasks]] = math.nan if read is None else read
        return values

    def _next_noise(self, tasks: Integers) -> Floats:
        place = self._read_frames[tasks] % _FRAMES
        for i in tasks[place == 0]:
            self._chance[i].standard_normal(out=self._noise[i])
        self._read_frames[tasks] += 1
        noise: Floats = self._noise[tasks, place]
        return noise

    def _values(self, tasks: Integers) -> Floats:
        """Values without noise, shape `(tasks, cells)`, of the scenes of `Task.scene`."""
        offset_mm, angle = self._tangent(tasks)
        bend = self._bend[tasks, self._at[tasks]]
        if self.settings.kind == "cable":
            return self.twin.cables(offset_mm, np.degrees(angle), bend)
        # The sheet is left of the line, towards the tip: right of the reversed line.
        values = self.twin.edges(-offset_mm, np.degrees(angle) + 180.0, curvature_per_mm=-bend)
        if self.settings.corner:
            x_mm, y_mm = self._in_sensor(tasks, self._last[tasks])
            turn = np.degrees(self._curve_heading[tasks, -1] - self.pose[tasks, 2])
            for i in np.flatnonzero(x_mm < SEEN_MM):
                vertex = Corner(x_mm=x_mm[i], y_mm=y_mm[i], angle_deg=turn[i] + 135.0)
                values[i] = self.twin.values(vertex)
        return values
