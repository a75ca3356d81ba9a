"""Learned policies: those that are shipped, their training, their files."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from lumitip.cli import main
from lumitip.control import Limits
from lumitip.errors import LayoutError
from lumitip.links.twin import published_layout
from lumitip.processing.processor import ValuesError
from lumitip.tasks import Settings, Task, TaskError
from lumitip.tasks.batch import TaskBatch
from lumitip.tasks.policy import UNSEEN_S, Follower, Memory, Policy
from lumitip.tasks.training import Schedule, train
from poses import wrong_twin

LAYOUT = published_layout()
SHORT = Schedule(rounds=2, fingertips=2, tasks=4, frames=30, steps=10, batch=128)


@pytest.fixture(scope="module")
def short() -> tuple[Policy, list[str]]:
    said: list[str] = []
    return train(LAYOUT, "cable", seed=3, schedule=SHORT, say=said.append), said


@pytest.mark.parametrize("kind", ["cloth", "cable"])
def test_a_shipped_policy_follows_its_line_on_fingertips_that_it_never_saw(kind: str) -> None:
    policy = Policy.shipped(kind)
    assert policy.kind == kind
    follow = Follower(policy, LAYOUT, speed_mm_s=240.0)
    for seed in range(4):
        task = Task(LAYOUT, Settings(kind, dead_cells=seed), wrong_twin(LAYOUT, 1 + seed))
        values, ended = task.reset(seed), False
        follow.reset()
        for _ in range(250):
            values, ended = task.step(follow(values))
            if ended:
                break
        done = task.metrics()
        assert done.reason == "end"
        assert done.lateral_rms_mm < 1.5
        assert done.travelled_mm / done.seconds == pytest.approx(240.0, rel=0.15)


def test_one_finger_gets_the_commands_of_many(short: tuple[Policy, list[str]]) -> None:
    policy, _ = short
    batch = TaskBatch(3, LAYOUT, Settings("cable"))
    values = batch.reset(range(3), [4, 5, 6])
    memory = Memory(3, len(LAYOUT))
    follow = Follower(policy, LAYOUT, speed_mm_s=150.0)
    for _ in range(8):
        commands = policy(memory.see(values, np.full(3, 150.0)))
        one = follow(values[1])
        alone = [one.forward_mm_s, one.lateral_mm_s, one.rotation_rad_s]
        assert alone == pytest.approx(commands[1].tolist(), abs=1e-3)
        memory.act(commands)
        values = batch.step(commands)


def test_the_same_seed_gives_the_same_policy_and_others_differ(
    short: tuple[Policy, list[str]],
) -> None:
    policy, said = short
    assert [line[:12] for line in said] == ["round 1 of 2", "round 2 of 2"]
    again = train(LAYOUT, "cable", seed=3, schedule=SHORT, say=said.append)
    other = train(LAYOUT, "cable", seed=4, schedule=SHORT, say=said.append)
    for one, same, differs in zip(policy.weights, again.weights, other.weights, strict=True):
        assert np.array_equal(one, same)
        assert not np.array_equal(one, differs)


@pytest.mark.slow
def test_training_teaches(short: tuple[Policy, list[str]]) -> None:
    """More of it follows the teacher more closely."""
    _, said = short
    longer: list[str] = []
    schedule = dataclasses.replace(SHORT, steps=50)
    train(LAYOUT, "cable", seed=3, schedule=schedule, say=longer.append)
    few, many = (float(of[-1].split("off by ")[1].split()[0]) for of in (said, longer))
    assert many < 0.8 * few


def test_a_policy_is_kept_in_a_file(short: tuple[Policy, list[str]], tmp_path: Path) -> None:
    policy, _ = short
    file = tmp_path / "own.npz"
    policy.save(file)
    read = Policy.load(file)
    assert (read.kind, read.design_hash, read.seed) == ("cable", LAYOUT.design_hash, 3)
    for one, kept in zip(policy.weights, read.weights, strict=True):
        assert kept == pytest.approx(one, rel=1e-3, abs=1e-6)
    before = file.read_bytes()
    read.save(file)
    assert file.read_bytes() == before
    assert repr(read) == (
        f"<Policy for a cable, design {LAYOUT.design_hash[:16]}, 167 to 128 to 64 to 3>"
    )


def damaged(policy: Policy, **changes: object) -> Policy:
    return dataclasses.replace(policy, **changes)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "damage",
    [
        lambda p: damaged(p, kind="rope"),
        lambda p: damaged(p, rate_hz=0.0),
        lambda p: damaged(p, weights=[p.weights[0] * np.nan, *p.weights[1:]]),
        lambda p: damaged(p, weights=p.weights[1:], biases=p.biases[:-1]),
        lambda p: damaged(p, weights=p.weights[:-1], biases=p.biases[:-1]),
        lambda p: damaged(p, biases=[b[:-1] for b in p.biases]),
    ],
    ids=["kind", "rate", "nan", "order", "outputs", "shapes"],
)
def test_a_damaged_policy_is_refused(
    short: tuple[Policy, list[str]], tmp_path: Path, damage
) -> None:
    file = tmp_path / "damaged.npz"
    damage(short[0]).save(file)
    with pytest.raises(TaskError, match="cannot be read as a policy"):
        Policy.load(file)


@pytest.mark.parametrize("data", [b"", b"PK\x03\x04", b"words"])
def test_a_file_of_another_kind_is_refused(tmp_path: Path, data: bytes) -> None:
    file = tmp_path / "own.npz"
    file.write_bytes(data)
    with pytest.raises(TaskError, match="cannot be read as a policy"):
        Policy.load(file)
    with pytest.raises(TaskError, match="cannot be read as a policy"):
        Policy.load(tmp_path / "none.npz")


def test_without_contrast_it_stops(short: tuple[Policy, list[str]]) -> None:
    policy, _ = short
    follow = Follower(policy, LAYOUT)
    nothing = np.full(len(LAYOUT), 255.0)
    commands = [follow(nothing) for _ in range(round(UNSEEN_S * policy.rate_hz) + 2)]
    assert commands[0].state == "trace"
    assert (commands[-1].state, commands[-1].reason) == ("stop", "lost")
    dead = np.full(len(LAYOUT), np.nan)
    assert follow(dead).state == "stop"
    follow.reset()
    assert follow(nothing).state == "trace"


def test_limits_hold(short: tuple[Policy, list[str]]) -> None:
    limits = Limits(30.0, 5.0, 0.1)
    follow = Follower(short[0], LAYOUT, speed_mm_s=600.0, limits=limits)
    task = Task(LAYOUT, Settings("cable"))
    command = follow(task.reset(1))
    assert abs(command.forward_mm_s) <= 30.0
    assert abs(command.lateral_mm_s) <= 5.0
    assert abs(command.rotation_rad_s) <= 0.1


def test_wrong_input_is_refused(short: tuple[Policy, list[str]]) -> None:
    policy, _ = short
    with pytest.raises(TaskError, match="kind is 'rope'"):
        Policy.shipped("rope")
    with pytest.raises(TaskError, match="kind is 'rope'"):
        train(LAYOUT, "rope", schedule=SHORT)
    with pytest.raises(TaskError, match="rate_hz"):
        train(LAYOUT, "cable", rate_hz=0.0, schedule=SHORT)
    with pytest.raises(TaskError, match="seed"):
        train(LAYOUT, "cable", seed=-1, schedule=SHORT)
    with pytest.raises(LayoutError):
        train("layout", "cable", schedule=SHORT)  # type: ignore[arg-type]
    for speed_mm_s in (-1.0, 701.0, float("nan")):
        with pytest.raises(TaskError, match="speed_mm_s"):
            Follower(policy, LAYOUT, speed_mm_s)
    with pytest.raises(ValuesError):
        Follower(policy, LAYOUT)(np.zeros(5))
    with pytest.raises(TaskError, match="the policy is of design"):
        Follower(damaged(policy, design_hash="0" * 64), LAYOUT)


def test_the_command_never_writes_over_a_file(tmp_path: Path, capsys) -> None:
    file = tmp_path / "cable.npz"
    file.write_bytes(b"mine")
    assert main(["train", "cable", "--out", str(file)]) == 2
    assert "cannot be written as a new file" in capsys.readouterr().err
    assert file.read_bytes() == b"mine"


def test_the_command_writes_a_policy_and_leaves_nothing_if_it_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys
) -> None:
    monkeypatch.setattr("lumitip.tasks.training.Schedule", lambda: SHORT)
    file = tmp_path / "cable.npz"
    assert main(["train", "cable", "--seed", "5", "--rate", "80", "--out", str(file)]) == 0
    assert (Policy.load(file).seed, Policy.load(file).rate_hz) == (5, 80.0)
    assert capsys.readouterr().out.splitlines()[-1] == str(file)
    monkeypatch.setattr("lumitip.tasks.training.Schedule", lambda: None)
    with pytest.raises(AttributeError):
        main(["train", "cable", "--out", str(tmp_path / "other.npz")])
    assert not (tmp_path / "other.npz").exists()
