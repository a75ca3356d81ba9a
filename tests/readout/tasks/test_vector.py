"""Many environments at once, against Gymnasium's own `SyncVectorEnv` of single ones."""

from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pytest

from lumitip.links.twin import published_layout
from lumitip.tasks import Settings, TaskError

gymnasium = pytest.importorskip("gymnasium")

NUMBER = 5
SETTINGS = {
    "cable": Settings("cable"),
    "cloth": Settings("cloth", target_mm=1.0, noise=0.5),
    "corner": Settings("cloth", length_mm=120.0, corner=True),
    "dead cells": Settings("cable", dead_cells=3, dead_value=0.0, latency=3, lag_s=0.0),
    "stuck cells": Settings("cable", dead_cells=2, dead_value=255.0, latency=0),
    "short": Settings("cable", length_mm=60.0),
}


@pytest.mark.slow_cases
@pytest.mark.parametrize("name", SETTINGS)
def test_they_give_what_single_environments_give(name: str) -> None:
    from lumitip.tasks.environment import TraceEnv
    from lumitip.tasks.vector import TraceVectorEnv

    arguments = {"layout": published_layout(), "settings": SETTINGS[name], "most_frames": 60}
    single = gymnasium.vector.SyncVectorEnv([partial(TraceEnv, **arguments)] * NUMBER)
    many = TraceVectorEnv(NUMBER, **arguments)
    assert np.array_equal(single.reset(seed=3)[0], many.reset(seed=3)[0])
    chance = np.random.default_rng(4)
    ends = np.zeros(3)
    for _ in range(200):
        forward = chance.uniform(0.2, 0.6, (NUMBER, 1))
        actions = np.hstack([forward, chance.normal(0.0, 0.3, (NUMBER, 2))]).astype(np.float32)
        *expected, expected_info = single.step(actions)
        *found, info = many.step(actions)
        for left, right in zip(expected, found, strict=True):
            assert np.allclose(left, right, rtol=0.0, atol=1e-9)
        assert _same(expected_info, info)
        lost = (info["reason"] == "lost").sum()
        ends += [found[2].sum(), found[3].sum(), lost]
    assert ends[0] or ends[1], "no episode ended"
    if name == "short":
        assert ends[0] > ends[2], "none came to the end of its curve"
    if name == "cable":
        assert ends[2] and ends[1]


def _same(expected: dict[str, Any], found: dict[str, Any]) -> bool:
    """Whether infos agree where Gymnasium's masks say that there is one."""
    for name in ("missed_mm", "reason"):
        mask = expected.get(f"_{name}", np.zeros(NUMBER, bool))
        assert np.array_equal(mask, found[f"_{name}"])
        if mask.any():
            left, right = expected[name][mask], found[name][mask]
            equal = left == right if name == "reason" else np.isclose(left, right, atol=1e-9)
            assert equal.all(), name
    return True


def test_dead_cells_that_read_nothing_are_rejected() -> None:
    """NaN is not within the observation space."""
    from lumitip.tasks.environment import TraceEnv
    from lumitip.tasks.vector import TraceVectorEnv

    settings = Settings("cable", dead_cells=2)
    for make in (TraceEnv, partial(TraceVectorEnv, 2)):
        with pytest.raises(TaskError, match=r"dead_cells 2 and no dead_value; .* Set dead_value"):
            make(settings=settings)
        env = make(settings=replace(settings, dead_value=0.0))
        assert env.reset(seed=1)[0] in env.observation_space


def test_a_lost_line_costs_a_hundred_however_far_it_is() -> None:
    """Fingers beside their lines that turn until these are upright."""
    from lumitip.tasks.environment import TraceEnv
    from lumitip.tasks.vector import TraceVectorEnv

    number, settings = 64, Settings("cable", latency=0, lag_s=0.0)
    many, single = TraceVectorEnv(number, settings=settings), TraceEnv(settings=settings)
    actions = np.zeros((number, 3), np.float32)
    actions[:, 1] = np.linspace(0.0, 0.5, number)
    many.reset(seed=3)
    many.step(actions)
    turn = np.tile(np.array([0.0, 0.0, 1.0], np.float32), (number, 1))
    missed_mm, rewards = np.zeros(number), np.zeros(number)
    for _ in range(30):
        _, found, ended, _, info = many.step(turn)
        missed_mm[ended], rewards[ended] = info["missed_mm"][ended], found[ended]
    worst = int(np.abs(missed_mm).argmax())
    assert abs(missed_mm[worst]) > 30.0, "no height was large"
    assert rewards.min() > -103.0 and rewards[worst] < -95.0
    single.reset(seed=3 + worst)
    single.step(actions[worst])
    ended = False
    while not ended:
        _, reward, ended, _, _ = single.step(turn[0])
    assert reward == pytest.approx(rewards[worst], abs=1e-9)


def test_seeds_of_single_tasks_and_none() -> None:
    from lumitip.tasks.vector import TraceVectorEnv

    many = TraceVectorEnv(3)
    first = many.reset(seed=[7, None, 9])[0]
    again = many.reset(seed=[7, None, 9])[0]
    assert np.array_equal(first[[0, 2]], again[[0, 2]])
    assert not np.array_equal(many.reset()[0][0], first[0])
    with pytest.raises(TaskError, match="seed has 2 entries; 3 are needed"):
        many.reset(seed=[1, 2])


@pytest.mark.parametrize("actions", [np.zeros((2, 3)), np.zeros(3)])
def test_actions_of_another_shape_are_rejected(actions: Any) -> None:
    from lumitip.tasks.vector import TraceVectorEnv

    many = TraceVectorEnv(3)
    many.reset(seed=1)
    with pytest.raises(TaskError, match=r"actions has shape .*\(3, 3\) is needed"):
        many.step(actions)
    with pytest.raises(TaskError, match=r"actions\[1\] is .*nan.*; finite numbers are needed"):
        many.step(np.array([[0.0] * 3, [0.0, np.nan, 0.0], [0.0] * 3]))


def test_a_mask_resets_some() -> None:
    """As Gymnasium's `SyncVectorEnv` does."""
    from lumitip.tasks.environment import TraceEnv
    from lumitip.tasks.vector import TraceVectorEnv

    single, many = gymnasium.vector.SyncVectorEnv([TraceEnv] * 3), TraceVectorEnv(3)
    mask = np.array([True, False, True])
    with pytest.raises(TaskError, match="no episodes; reset all first"):
        many.reset(options={"reset_mask": mask})
    actions = np.tile(np.array([0.4, 0.1, 0.0], np.float32), (3, 1))
    for envs in (single, many):
        envs.reset(seed=5)
        for _ in range(5):
            envs.step(actions)
    found = [envs.reset(seed=9, options={"reset_mask": mask})[0] for envs in (single, many)]
    assert np.array_equal(*found)
    assert np.array_equal(single.step(actions)[0], many.step(actions)[0])
    with pytest.raises(TaskError, match="3 booleans, one of them true, are needed"):
        many.reset(options={"reset_mask": [True]})


def test_without_an_episode_there_is_no_step_and_no_picture() -> None:
    from lumitip.tasks.environment import TraceEnv
    from lumitip.tasks.vector import TraceVectorEnv

    for env, shape in ((TraceEnv(), (3,)), (TraceVectorEnv(2), (2, 3))):
        for call in (lambda env=env, shape=shape: env.step(np.zeros(shape)), env.render):
            with pytest.raises(TaskError, match="call reset first"):
                call()


@pytest.mark.parametrize("kind", ["Cable", "Cloth", "Corner"])
def test_ids_make_one_or_many_and_draw_them(kind: str) -> None:
    name = f"lumitip.tasks.environment:Lumitip/Trace{kind}-v0"
    one = gymnasium.make(name, render_mode="rgb_array")
    one.reset(seed=5)
    one.step(np.array([0.4, 0.0, 0.0], np.float32))
    image = one.render()
    assert image.ndim == 3 and image.dtype == np.uint8
    orange = (image == (232, 89, 12)).all(axis=2)
    assert 50 < orange.sum() < 0.05 * orange.size, "the line is not drawn"
    many = gymnasium.make_vec(
        name, 2, vectorization_mode="vector_entry_point", render_mode="rgb_array"
    )
    many.reset(seed=5)
    many.step(np.array([[0.4, 0.0, 0.0]] * 2, np.float32))
    assert np.array_equal(many.render()[0], image)
    assert many.unwrapped.num_envs == 2


@pytest.mark.slow_cases
@pytest.mark.parametrize("mode", [None, "sync"])
@pytest.mark.parametrize("most_frames", [3, 2000])
def test_a_limit_of_steps_by_the_name_of_gymnasium(mode: str | None, most_frames: int) -> None:
    many = gymnasium.make_vec(
        "lumitip.tasks.environment:Lumitip/TraceCable-v0",
        2,
        vectorization_mode=mode,
        max_episode_steps=5,
        most_frames=most_frames,
    )
    many.reset(seed=1)
    cut_off = [many.step(np.zeros((2, 3), np.float32))[3].tolist() for _ in range(5)]
    assert cut_off.index([True, True]) == min(5, most_frames) - 1
    with pytest.raises(TaskError, match="max_episode_steps is 0"):
        gymnasium.make_vec(many.spec.id, 2, max_episode_steps=0)


def test_a_render_mode_that_there_is_not_is_rejected() -> None:
    from lumitip.tasks.environment import TraceEnv
    from lumitip.tasks.vector import TraceVectorEnv

    for make in (TraceEnv, partial(TraceVectorEnv, 2)):
        env = make()
        env.reset()
        assert env.render() is None
        with pytest.raises(TaskError, match="render_mode is 'ansi'; allowed are rgb_array"):
            make(render_mode="ansi")


def test_gymnasium_accepts_the_ids() -> None:
    from gymnasium.utils.env_checker import check_env

    check_env(gymnasium.make("lumitip.tasks.environment:Lumitip/TraceCable-v0").unwrapped)
