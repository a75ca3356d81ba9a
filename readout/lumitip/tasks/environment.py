"""`TraceEnv`: a task as a Gymnasium environment; needs the extra `gym`.

env = TraceEnv(layout, Settings("cable"))
values, info = env.reset(seed=1)
values, reward, terminated, truncated, info = env.step(action)

The observation is a frame. The action is forward, lateral and turning velocity as shares of
`limits`. The reward is the distance along the line (mm) minus the squared error of the line's
height (mm²) for each second; a lost line costs 100.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lumitip import arguments
from lumitip.control import Command, Limits
from lumitip.errors import MissingExtra
from lumitip.layout import Layout
from lumitip.tasks.task import Settings, Task, TaskError
from lumitip.twin import Twin
from lumitip.values import shown

try:
    import gymnasium
except ImportError as error:
    raise MissingExtra("gym", "the environment") from error

Observation = NDArray[np.float32]
LIMITS = Limits(forward_mm_s=250.0, lateral_mm_s=150.0, rotation_rad_s=6.0)
_LOST = -100.0


class TraceEnv(gymnasium.Env[Observation, Observation]):
    """A task: one step is one frame of the sensor."""

    metadata = {"render_modes": []}  # noqa: RUF012 (Gymnasium's own attribute)

    def __init__(
        self,
        layout: Layout,
        settings: Settings | None = None,
        limits: Limits = LIMITS,
        most_frames: int = 2000,
        twin: Twin | None = None,
    ) -> None:
        """An environment; `reset` begins an episode.

        Args:
            layout: the cells.
            settings: of the task.
            limits: velocities of an action of 1.
            most_frames: an episode is truncated after this number of frames.
            twin: simulates the sensor.

        Raises:
            LayoutError, TaskError: if an argument is invalid.
        """
        self.task = Task(layout, settings, twin)
        self._limits = arguments.instance(limits, Limits, "limits", TaskError)
        self._most_frames = arguments.count(most_frames, "most_frames", error=TaskError)
        self._frames = 0
        self.observation_space = gymnasium.spaces.Box(0.0, 255.0, (len(layout),), np.float32)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (3,), np.float32)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Start on a new curve; the same seed gives the same curves."""
        super().reset(seed=seed, options=options)
        self._frames = 0
        values = self.task.reset(int(self.np_random.integers(2**31)))
        return values.astype(np.float32), {}

    def step(self, action: Observation) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Advance by one frame.

        Raises:
            TaskError: if the action is not three finite numbers.
        """
        shares = arguments.numbers(action, "action", TaskError)
        if shares.shape != (3,) or not np.isfinite(shares).all():
            raise TaskError(f"action is {shown(action, 60)}; three finite numbers are needed")
        shares = np.clip(shares, -1.0, 1.0)
        command = Command(
            float(shares[0]) * self._limits.forward_mm_s,
            float(shares[1]) * self._limits.lateral_mm_s,
            float(shares[2]) * self._limits.rotation_rad_s,
        )
        before_mm = self.task.travelled_mm
        values, ended = self.task.step(command)
        self._frames += 1
        missed_mm = self.task.line()[0] - self.task.settings.target_mm
        reward = self.task.travelled_mm - before_mm - missed_mm**2 / self.task.settings.rate_hz
        lost = self.task.reason == "lost"
        info = {"missed_mm": missed_mm, "reason": self.task.reason}
        cut_off = not ended and self._frames >= self._most_frames
        return values.astype(np.float32), reward + (_LOST if lost else 0.0), ended, cut_off, info
