"""The Gymnasium environment, by Gymnasium's own checker; and tasks in real time."""

import pickle
import re
import subprocess
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lumitip.links.twin import published_layout
from lumitip.tasks import Settings, TaskError
from lumitip.twin import Twin

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[3]


def test_gymnasium_accepts_the_environment() -> None:
    pytest.importorskip("gymnasium")
    from gymnasium.utils.env_checker import check_env

    from lumitip.tasks.environment import TraceEnv

    for settings in (Settings("cable"), Settings("cloth", corner=True)):
        with warnings.catch_warnings():
            # It asks for a registered id only in order to make other render modes.
            warnings.filterwarnings("ignore", message=".*spec.*")
            check_env(TraceEnv(published_layout(), settings))


def test_environments_of_ones_own_twin_run_in_other_processes() -> None:
    gymnasium = pytest.importorskip("gymnasium")
    layout = published_layout()
    envs = gymnasium.make_vec(
        "lumitip.tasks.environment:Lumitip/TraceCable-v0",
        2,
        vectorization_mode="async",
        vector_kwargs={"context": "spawn"},
        layout=layout,
        twin=Twin(layout),
    )
    try:
        first, _ = envs.reset(seed=3)
    finally:
        envs.close()
    from lumitip.tasks.environment import TraceEnv

    alone = pickle.loads(pickle.dumps(TraceEnv(layout, Settings("cable"), twin=Twin(layout))))
    assert np.array_equal(first[1], alone.reset(seed=4)[0])


def test_going_forward_is_rewarded_and_losing_the_line_is_not() -> None:
    pytest.importorskip("gymnasium")
    from lumitip.tasks.environment import TraceEnv

    env = TraceEnv(published_layout(), Settings("cable"), most_frames=30)
    env.reset(seed=1)
    rewards = [env.step(np.array([0.2, 0.0, 0.0], np.float32))[1] for _ in range(20)]
    assert sum(rewards) > 0.5 * 20 * 0.2 * 250.0 / 55.0
    assert env.step(np.zeros(3, np.float32))[2:4] == (False, False)
    for _ in range(8):
        env.step(np.zeros(3, np.float32))
    assert env.step(np.zeros(3, np.float32))[3]  # cut off
    env.reset(seed=1)
    for _ in range(30):
        _, reward, ended, _, info = env.step(np.array([0.0, 1.0, 0.0], np.float32))
        if ended:
            break
    assert ended and info["reason"] == "lost" and reward < -90.0


@pytest.mark.parametrize("action", [[np.inf, 0, 0], [0, np.nan, 0], [0, 0], ["1", 0, 0], None])
def test_an_action_of_no_three_finite_numbers_is_refused(action: Any) -> None:
    pytest.importorskip("gymnasium")
    from lumitip.tasks.environment import TraceEnv

    env = TraceEnv(published_layout(), Settings("cable"))
    env.reset(seed=1)
    with pytest.raises(TaskError, match=r"action is .*; .*numbers .*needed"):
        env.step(action)


@pytest.mark.parametrize(
    ("name", "word"), [("trace_cable.py", "end"), ("trace_cloth.py", "corner")]
)
def test_examples_follow_in_real_time(name: str, word: str) -> None:
    done = subprocess.run(
        [sys.executable, "-W", "error", f"examples/{name}", "60"],
        capture_output=True,
        text=True,
        timeout=100,
        cwd=ROOT,
        check=False,
    )
    assert done.returncode == 0 and done.stderr == "", done.stderr
    assert done.stdout.startswith(f"{word} after "), done.stdout
    told = re.search(r"lateral ([\d.]+) mm rms", done.stdout)
    assert told and float(told[1]) < 3.0
