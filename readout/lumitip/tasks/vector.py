"""`TraceVectorEnv`: many `TraceEnv`s that advance together; needs the extra `gym`.

envs = TraceVectorEnv(256, layout, Settings("cable"))
values, info = envs.reset(seed=1)
values, rewards, terminated, truncated, info = envs.step(actions)       # shape (256, 3)

Rewards, seeds and automatic resets (in the step after the last) are those of Gymnasium's
`SyncVectorEnv` of `TraceEnv`s.
"""

from typing import Any

import gymnasium
import numpy as np
from gymnasium.utils.seeding import np_random
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from lumitip import arguments
from lumitip.control import Limits
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.links.twin import published_layout
from lumitip.tasks.batch import Flags, TaskBatch
from lumitip.tasks.environment import LIMITS, LOST_REWARD, Observation, velocities
from lumitip.tasks.picture import Image, Picture
from lumitip.tasks.task import Settings, TaskError
from lumitip.twin import Twin
from lumitip.values import shown


class TraceVectorEnv(VectorEnv[Observation, Observation, NDArray[Any]]):
    """Many tasks: one step is one frame of each sensor."""

    metadata = {  # noqa: RUF012 (Gymnasium's own attribute)
        "render_modes": ["rgb_array"],
        "render_fps": 55,
        "autoreset_mode": AutoresetMode.NEXT_STEP,
    }

    def __init__(
        self,
        num_envs: int,
        layout: Layout | None = None,
        settings: Settings | None = None,
        limits: Limits = LIMITS,
        most_frames: int = 2000,
        twin: Twin | None = None,
        render_mode: str | None = None,
    ) -> None:
        """Environments; `reset` begins their episodes.

        Args:
            num_envs: number of tasks.
            layout, settings, limits, most_frames, twin, render_mode: of each, see `TraceEnv`.

        Raises:
            LayoutError, TaskError: if an argument is invalid.
        """
        self.num_envs = arguments.count(num_envs, "num_envs", error=TaskError)
        layout = published_layout() if layout is None else layout
        self._tasks = TaskBatch(self.num_envs, layout, settings, twin)
        self._limits = arguments.instance(limits, Limits, "limits", TaskError)
        self._most_frames = arguments.count(most_frames, "most_frames", error=TaskError)
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise TaskError(f"render_mode is {shown(render_mode)}; allowed are rgb_array and None")
        self.render_mode = render_mode
        self._picture = Picture(layout) if render_mode else None
        self.single_observation_space = gymnasium.spaces.Box(0.0, 255.0, (len(layout),), np.float32)
        self.single_action_space = gymnasium.spaces.Box(-1.0, 1.0, (3,), np.float32)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self._chances = [np_random()[0] for _ in range(self.num_envs)]
        self._frames = np.zeros(self.num_envs, np.int64)
        self._over: Flags = np.zeros(self.num_envs, bool)
        self._values: Floats = np.zeros((self.num_envs, len(layout)))

    def reset(
        self,
        *,
        seed: int | list[int | None] | None = None,
        options: dict[str, Any] | None = None,  # noqa: ARG002 (Gymnasium's own)
    ) -> tuple[Observation, dict[str, Any]]:
        """Start all on new curves. A seed is that of the first task; the next have the next seeds.

        Raises:
            TaskError: if the number of seeds is not the number of tasks.
        """
        seeds = range(seed, seed + self.num_envs) if isinstance(seed, int) else seed
        if seeds is not None:
            if len(seeds) != self.num_envs:
                raise TaskError(f"seed has {len(seeds)} entries; {self.num_envs} are needed")
            for i, of_task in enumerate(seeds):
                if of_task is not None:
                    self._chances[i] = np_random(of_task)[0]
        self._values = self._begin(np.ones(self.num_envs, bool))
        return self._values.astype(np.float32), {}

    def step(
        self, actions: Observation
    ) -> tuple[Observation, Floats, Flags, Flags, dict[str, Any]]:
        """Advance all by one frame; tasks that ended in the step before begin anew instead.

        Raises:
            TaskError: if the actions are not three finite numbers for each task.
        """
        shares = arguments.numbers(actions, "actions", TaskError)
        if shares.shape != (self.num_envs, 3) or not np.isfinite(shares).all():
            raise TaskError(
                f"actions has shape {shares.shape}; finite numbers of shape ({self.num_envs}, 3) "
                "are needed"
            )
        tasks, fresh = self._tasks, self._over
        before_mm = tasks.travelled_mm
        self._values = tasks.step(velocities(shares, self._limits))
        self._frames += 1
        missed_mm = tasks.line()[0] - tasks.settings.target_mm
        rewards = tasks.travelled_mm - before_mm - missed_mm**2 / tasks.settings.rate_hz
        rewards[tasks.lost] += LOST_REWARD
        terminated = tasks.ended & ~fresh
        truncated = ~tasks.ended & (self._frames >= self._most_frames) & ~fresh
        reasons = np.where(tasks.lost, "lost", np.where(tasks.ended, "end", "")).astype(object)
        if fresh.any():
            self._values[fresh] = self._begin(fresh)
            rewards[fresh] = missed_mm[fresh] = 0.0
            reasons[fresh] = None
        self._over = terminated | truncated
        info = {
            "missed_mm": missed_mm,
            "_missed_mm": ~fresh,
            "reason": reasons,
            "_reason": ~fresh,
        }
        return self._values.astype(np.float32), rewards, terminated, truncated, info

    def render(self) -> tuple[Image, ...] | None:
        """The last frame and the true line of each task, or None without a render mode."""
        if not self._picture:
            return None
        lines = zip(self._values, *self._tasks.line(), strict=True)
        return tuple(self._picture(*line) for line in lines)

    def _begin(self, which: Flags) -> Floats:
        places = np.flatnonzero(which).tolist()
        self._frames[which], self._over = 0, self._over & ~which
        seeds = [int(self._chances[i].integers(2**31)) for i in places]
        return self._tasks.reset(places, seeds)
