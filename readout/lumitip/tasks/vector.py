"""`TraceVectorEnv`: many `TraceEnv`s that advance together; needs the extra `gym`.

envs = TraceVectorEnv(256, layout, Settings("cable"))
values, info = envs.reset(seed=1)
values, rewards, terminated, truncated, info = envs.step(actions)       # shape (256, 3)

Rewards, seeds and automatic resets (in the step after the last) are those of Gymnasium's
`SyncVectorEnv` of `TraceEnv`s.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lumitip import arguments
from lumitip.control import Limits
from lumitip.errors import MissingExtra
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.links.twin import published_layout
from lumitip.tasks.batch import Flags, TaskBatch
from lumitip.tasks.environment import (
    LIMITS,
    LOST_REWARD,
    METADATA,
    Observation,
    cost_mm2,
    picture_in,
    velocities,
    with_numbers,
)
from lumitip.tasks.picture import Image
from lumitip.tasks.task import Settings, TaskError
from lumitip.twin import Twin
from lumitip.values import shown

try:
    import gymnasium
    from gymnasium.utils.seeding import np_random
    from gymnasium.vector import AutoresetMode, VectorEnv
    from gymnasium.vector.utils import batch_space
except ImportError as error:
    raise MissingExtra("gym", "the environments") from error


class TraceVectorEnv(VectorEnv[Observation, Observation, NDArray[Any]]):
    """Many tasks: one step is one frame of each sensor."""

    metadata = METADATA | {"autoreset_mode": AutoresetMode.NEXT_STEP}

    def __init__(
        self,
        num_envs: int,
        layout: Layout | None = None,
        settings: Settings | None = None,
        limits: Limits = LIMITS,
        most_frames: int = 2000,
        twin: Twin | None = None,
        render_mode: str | None = None,
        max_episode_steps: int | None = None,
    ) -> None:
        """Environments; `reset` begins their episodes.

        Args:
            num_envs: number of tasks.
            layout, settings, limits, most_frames, twin, render_mode: of each, see `TraceEnv`.
            max_episode_steps: as of `gymnasium.make`, another limit beside `most_frames`.

        Raises:
            LayoutError, TaskError: if an argument is invalid.
        """
        self.num_envs = arguments.count(num_envs, "num_envs", error=TaskError)
        layout = published_layout() if layout is None else layout
        self._tasks = TaskBatch(self.num_envs, layout, with_numbers(settings), twin)
        self._limits = arguments.instance(limits, Limits, "limits", TaskError)
        self._most_frames = arguments.count(most_frames, "most_frames", error=TaskError)
        if max_episode_steps is not None:
            most = arguments.count(max_episode_steps, "max_episode_steps", error=TaskError)
            self._most_frames = min(self._most_frames, most)
        rate_hz = self._tasks.settings.rate_hz
        self.metadata = {**self.metadata, "render_fps": round(rate_hz)}
        self.render_mode = render_mode
        self._picture = picture_in(render_mode, layout)
        self.single_observation_space = gymnasium.spaces.Box(0.0, 255.0, (len(layout),), np.float32)
        self.single_action_space = gymnasium.spaces.Box(-1.0, 1.0, (3,), np.float32)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self._chances = [np_random()[0] for _ in range(self.num_envs)]
        self._frames = np.zeros(self.num_envs, np.int64)
        self._over: Flags = np.zeros(self.num_envs, bool)
        self._values: Floats | None = None

    def reset(
        self,
        *,
        seed: int | list[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Observation, dict[str, Any]]:
        """Start all on new curves, or those in the mask `options["reset_mask"]`, shape `(tasks,)`.
        A seed is that of the first task; the next have the next seeds.

        Raises:
            TaskError: if the number of seeds is not the number of tasks, or the mask has another
                shape.
        """
        which = self._masked(options)
        seeds = range(seed, seed + self.num_envs) if isinstance(seed, int) else seed
        if seeds is not None:
            if len(seeds) != self.num_envs:
                raise TaskError(f"seed has {len(seeds)} entries; {self.num_envs} are needed")
            for i, of_task in enumerate(seeds):
                if of_task is not None and which[i]:
                    self._chances[i] = np_random(of_task)[0]
        begun = self._begin(which)
        if self._values is None:
            self._values = np.zeros((self.num_envs, begun.shape[1]))
        self._values[which] = begun
        return self._values.astype(np.float32), {}

    def step(
        self, actions: Observation
    ) -> tuple[Observation, Floats, Flags, Flags, dict[str, Any]]:
        """Advance all by one frame; tasks that ended in the step before begin anew instead.

        Raises:
            TaskError: if the actions are not three finite numbers for each task, or `reset` was
                not called.
        """
        if self._values is None:
            raise TaskError("step: the environments have no episodes; call reset first")
        shares = arguments.numbers(actions, "actions", TaskError)
        if shares.shape != (self.num_envs, 3):
            raise TaskError(f"actions has shape {shares.shape}; ({self.num_envs}, 3) is needed")
        if not np.isfinite(shares).all():
            task = int(np.argwhere(~np.isfinite(shares))[0, 0])
            raise TaskError(f"actions[{task}] is {shown(shares[task])}; finite numbers are needed")
        tasks, fresh = self._tasks, self._over
        before_mm = tasks.travelled_mm
        self._values = tasks.step(velocities(shares, self._limits))
        self._frames += 1
        missed_mm = tasks.line()[0] - tasks.settings.target_mm
        rewards = tasks.travelled_mm - before_mm - cost_mm2(missed_mm) / tasks.settings.rate_hz
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
        """The last frame and the true line of each task, or None without a render mode.

        Raises:
            TaskError: if `reset` was not called.
        """
        if self._values is None:
            raise TaskError("render: the environments have no episodes; call reset first")
        if not self._picture:
            return None
        lines = zip(self._values, *self._tasks.line(), strict=True)
        return tuple(self._picture(*line) for line in lines)

    def _masked(self, options: dict[str, Any] | None) -> Flags:
        mask = (options or {}).get("reset_mask")
        which = np.ones(self.num_envs, bool) if mask is None else np.asarray(mask)
        if which.shape != (self.num_envs,) or which.dtype != bool or not which.any():
            raise TaskError(
                f"reset_mask is {shown(mask)}; {self.num_envs} booleans, one of them true, are "
                "needed"
            )
        if self._values is None and not which.all():
            raise TaskError("reset_mask: the environments have no episodes; reset all first")
        return which

    def _begin(self, which: Flags) -> Floats:
        places = np.flatnonzero(which).tolist()
        self._frames[which], self._over = 0, self._over & ~which
        seeds = [int(self._chances[i].integers(2**31)) for i in places]
        return self._tasks.reset(places, seeds)
