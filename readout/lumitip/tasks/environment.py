"""`TraceEnv`: a task as a Gymnasium environment; needs the extra `gym`.

env = gymnasium.make("lumitip.tasks.environment:Lumitip/TraceCable-v0", layout=layout)
values, info = env.reset(seed=1)
values, reward, terminated, truncated, info = env.step(action)

`gymnasium.make_vec` with `num_envs` and `vectorization_mode="vector_entry_point"` gives
`TraceVectorEnv`. The ids are `Lumitip/TraceCable-v0`, `Lumitip/TraceCloth-v0` and
`Lumitip/TraceCorner-v0`.

The observation is a frame. The action is forward, lateral and turning velocity as shares of
`limits`. The reward is the distance along the line (mm) minus the squared error of the line's
height (mm²) for each second, with an error of 9 mm at most; a lost line costs 100.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lumitip import arguments
from lumitip.control import Command, Limits
from lumitip.errors import MissingExtra
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.links.twin import published_layout
from lumitip.tasks.picture import Image, Picture
from lumitip.tasks.task import LOST_MM, Settings, Task, TaskError
from lumitip.twin import Twin
from lumitip.twin.lines import Numbers
from lumitip.values import shown

try:
    import gymnasium
except ImportError as error:
    raise MissingExtra("gym", "the environment") from error

Observation = NDArray[np.float32]
LIMITS = Limits(forward_mm_s=250.0, lateral_mm_s=150.0, rotation_rad_s=6.0)
LOST_REWARD = -100.0
METADATA: dict[str, Any] = {"render_modes": ["rgb_array"]}


class TraceEnv(gymnasium.Env[Observation, Observation]):
    """A task: one step is one frame of the sensor."""

    metadata = METADATA

    def __init__(
        self,
        layout: Layout | None = None,
        settings: Settings | None = None,
        limits: Limits = LIMITS,
        most_frames: int = 2000,
        twin: Twin | None = None,
        render_mode: str | None = None,
    ) -> None:
        """An environment; `reset` begins an episode.

        Args:
            layout: the cells; by default those of the published sensor.
            settings: of the task; dead cells need a `dead_value`.
            limits: velocities of an action of 1.
            most_frames: an episode is truncated after this number of frames.
            twin: simulates the sensor.
            render_mode: `"rgb_array"`: `render` returns the cells and the true line as an image.

        Raises:
            LayoutError, TaskError: if an argument is invalid.
        """
        layout = published_layout() if layout is None else layout
        self.task = Task(layout, with_numbers(settings), twin)
        self.metadata = {**METADATA, "render_fps": round(self.task.settings.rate_hz)}
        self.render_mode = render_mode
        self._picture = picture_in(render_mode, layout)
        self._values: Floats | None = None
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
        values = self._values = self.task.reset(int(self.np_random.integers(2**31)))
        return values.astype(np.float32), {}

    def step(self, action: Observation) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Advance by one frame.

        Raises:
            TaskError: if the action is not three finite numbers, or `reset` was not called.
        """
        if self._values is None:
            raise TaskError("step: the environment has no episode; call reset first")
        shares = arguments.numbers(action, "action", TaskError)
        if shares.shape != (3,) or not np.isfinite(shares).all():
            raise TaskError(f"action is {shown(action, 60)}; three finite numbers are needed")
        command = Command(*velocities(shares, self._limits).tolist())
        before_mm = self.task.travelled_mm
        values, ended = self.task.step(command)
        self._values = values
        self._frames += 1
        missed_mm = self.task.line()[0] - self.task.settings.target_mm
        reward = self.task.travelled_mm - before_mm
        reward -= float(cost_mm2(missed_mm)) / self.task.settings.rate_hz
        lost = self.task.reason == "lost"
        info = {"missed_mm": missed_mm, "reason": self.task.reason}
        cut_off = not ended and self._frames >= self._most_frames
        return (
            values.astype(np.float32),
            reward + (LOST_REWARD if lost else 0.0),
            ended,
            cut_off,
            info,
        )

    def render(self) -> Image | None:
        """The last frame and the true line, or None without a render mode.

        Raises:
            TaskError: if `reset` was not called.
        """
        if self._values is None:
            raise TaskError("render: the environment has no episode; call reset first")
        return self._picture(self._values, *self.task.line()) if self._picture else None


def with_numbers(settings: Settings | None) -> Settings | None:
    """The settings, if all cells read numbers: NaN is no part of the observation space.

    Raises:
        TaskError: if dead cells read NaN.
    """
    if isinstance(settings, Settings) and settings.dead_cells and settings.dead_value is None:
        raise TaskError(
            f"settings has dead_cells {settings.dead_cells} and no dead_value; an observation has "
            "numbers only. Set dead_value, 0 to 255, such as 0.0 for cells that stay dark"
        )
    return settings


def cost_mm2(missed_mm: Numbers | float) -> Floats:
    """Squared errors of heights, at most that at which a line is lost: where a finger has turned
    away from its line, the height is without limit."""
    squared: Floats = np.square(np.clip(missed_mm, -LOST_MM, LOST_MM, dtype=np.float64))
    return squared


def picture_in(render_mode: str | None, layout: Layout) -> Picture | None:
    """What draws in a render mode.

    Raises:
        TaskError: if there is no such mode.
    """
    if render_mode not in (None, *METADATA["render_modes"]):
        raise TaskError(f"render_mode is {shown(render_mode)}; allowed are rgb_array and None")
    return Picture(layout) if render_mode else None


def velocities(shares: Floats, limits: Limits) -> Floats:
    """Velocities (mm/s, mm/s, rad/s) of actions, both of shape `(..., 3)`."""
    most = (limits.forward_mm_s, limits.lateral_mm_s, limits.rotation_rad_s)
    asked: Floats = np.clip(shares, -1.0, 1.0) * np.array(most)
    return asked


for _name, _settings in (
    ("Cable", Settings("cable")),
    ("Cloth", Settings("cloth")),
    ("Corner", Settings("cloth", corner=True)),
):
    gymnasium.register(
        f"Lumitip/Trace{_name}-v0",
        "lumitip.tasks.environment:TraceEnv",
        vector_entry_point="lumitip.tasks.vector:TraceVectorEnv",
        kwargs={"settings": _settings},
    )
