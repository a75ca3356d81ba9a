"""The fuzzer finds planted faults, and nothing in what is shipped."""

import mmap
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture
def fuzz(monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """The package `fuzz`, which is beside the tests and not installed."""
    monkeypatch.syspath_prepend(str(ROOT))
    import fuzz.engine
    import fuzz.targets

    yield fuzz
    for name in [n for n in sys.modules if n.partition(".")[0] == "fuzz"]:
        del sys.modules[name]


def test_a_short_run_finds_nothing(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "fuzz", "--inputs", "20000", "--crashes", str(tmp_path)]
    done = subprocess.run(
        command, cwd=ROOT, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.count(" refused ") >= 6
    assert list(tmp_path.iterdir()) == []


def test_an_untyped_exception_is_found_and_its_input_kept(fuzz: Any, tmp_path: Path) -> None:
    def careless(data: bytes) -> None:
        if len(data) < 10:
            data[20]

    target = replace(fuzz.targets.TARGETS[0], feed=careless)
    with pytest.raises(fuzz.engine.FoundError, match="packet: IndexError"):
        fuzz.engine.run(target, 5000, 1, tmp_path)
    (kept,) = tmp_path.iterdir()
    with pytest.raises(IndexError):
        careless(kept.read_bytes())


def test_memory_that_grows_is_found(fuzz: Any, tmp_path: Path) -> None:
    hoard: list[mmap.mmap] = []

    def hoarding(data: bytes) -> None:
        pages = mmap.mmap(-1, 20_000)  # new ones, whatever this process has freed before
        pages.write(data[:1] * 20_000)
        hoard.append(pages)

    target = replace(fuzz.targets.TARGETS[0], feed=hoarding)
    with pytest.raises(fuzz.engine.FoundError, match="memory grew"):
        fuzz.engine.run(target, 2000, 1, tmp_path)


def test_damage_reaches_behind_the_checksum(fuzz: Any) -> None:
    """Every reason for a refusal is seen, and repaired packets are accepted."""
    import random

    target, rng, seen = fuzz.targets.TARGETS[0], random.Random(1), set()
    for _ in range(5000):
        data = fuzz.mutate.mutated(rng, target.seeds(), target.mutations)
        try:
            target.feed(target.seal(data))
            seen.add("accepted")
        except target.refuses_with as error:
            seen.add(error.reason)
    assert seen == {"accepted", "length", "magic", "version", "bits"}


def test_the_same_seed_gives_the_same_inputs(fuzz: Any, tmp_path: Path) -> None:
    runs: list[list[bytes]] = []
    for _ in range(2):
        fed: list[bytes] = []
        fuzz.engine.run(replace(fuzz.targets.TARGETS[0], feed=fed.append), 300, 5, tmp_path)
        runs.append(fed)
    assert runs[0] == runs[1]
