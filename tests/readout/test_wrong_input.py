"""Mistakes of a hurried user are rejected in one line: the value, and what is needed."""

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lumitip import Block, Calibration, FingertipGroup, Layout, LayoutError, LumitipError
from lumitip.calibration import checked_kind
from lumitip.cli import main
from lumitip.control import CentreLaw, Command, ControlError, Limits, LineLaw, Tracer, sight_of
from lumitip.errors import ArgumentError, CalibrationError
from lumitip.estimation import EstimationError, PoseEstimator, learn
from lumitip.grid import hexagonal_grid, hexagonal_neighbours
from lumitip.health.doctor import examine
from lumitip.links.twin import published_layout
from lumitip.processing import Processor, Tracker, ValuesError
from lumitip.robots import ArmError, ArmLimits, Mount, URArm
from lumitip.tasks import Bench, Curve, Settings, Task, TaskError, Tuning
from lumitip.tasks.live import LiveTask
from lumitip.twin import (
    Cable,
    Corner,
    Disc,
    HalfPlane,
    Image,
    Misregistration,
    Model,
    Polygon,
    Twin,
    TwinError,
)
from lumitip.twin.fit import fit_edge
from lumitip.twin.materials import material
from lumitip.values import shown

Call = Callable[[Any], object]
CELLS = published_layout()
NO_VALUES = [
    ["a"] * 32,
    [[1.0], [2.0, 3.0]],
    [1j] * 32,
    [10**400] * 32,
    ["3"] * 32,
    {},
    None,
    np.full(32, np.datetime64("2020-01-01")),
    b"x" * 32,
    [None, "3"] + [200.0] * 30,
    [None, b"3"] + [200.0] * 30,
]
NO_NUMBERS = ["3", math.nan, None, [1.0], 1j, 10**400, 10**5000, np.array([1.0, 2.0])]
COUNTS = ["hold", "seed", "corner_frames", "latency"]
NO_NAMES = [3, None, ["a"], math.nan]


@pytest.fixture(scope="module")
def twin() -> Twin:
    return Twin(CELLS)


@pytest.fixture(scope="module")
def estimator() -> PoseEstimator:
    return PoseEstimator(CELLS)


@pytest.mark.slow
@pytest.mark.parametrize("values", NO_VALUES, ids=shown)
def test_values_that_are_no_numbers(estimator: PoseEstimator, values: Any) -> None:
    frames: list[Call] = [Processor(CELLS), Processor(CELLS).batch, Tracker(CELLS), estimator]
    for call in [*frames, lambda v: estimator.fitted(v, "edge"), lambda v: learn(CELLS, v)]:
        with pytest.raises(ValuesError, match=r"; (an array of numbers|a frame|frames of)"):
            call(values)
    others: list[tuple[type[LumitipError], Call]] = [
        (ArgumentError, lambda v: examine(v, CELLS)),
        (TwinError, lambda v: fit_edge(CELLS, v, 0.0, 0.0)),
    ]
    if values is not None:  # of gains it means that none are told
        others.append((TwinError, lambda v: Twin(CELLS, gains=v)))
        others.append((EstimationError, lambda v: PoseEstimator(CELLS, gains=v)))
    for error, call in others:
        with pytest.raises(error, match=r"; .*needed"):
            call(values)


@pytest.mark.parametrize("kind", ["disc", "", 3, b"edge"])
def test_a_kind_that_there_is_not(estimator: PoseEstimator, kind: Any) -> None:
    values = np.linspace(0.0, 255.0, 32)
    for call in (estimator, estimator.fitted):
        with pytest.raises(EstimationError, match=r"kind is .*; allowed are edge"):
            call(values, kind)


def test_a_frame_that_is_a_template_of_the_bank_is_estimated(estimator: PoseEstimator) -> None:
    values = np.zeros(32)
    values[31] = 255.0
    assert estimator(values).kind in ("edge", "cable", "corner")


@pytest.mark.parametrize("layout", ["outputs/layout.json", Path("layout.json"), None, {}, Layout])
def test_what_is_no_layout(layout: Any, tmp_path: Path) -> None:
    from lumitip.recording import Writer

    frames = np.zeros((30, 32))
    calls: list[Call] = [Processor, Tracker, PoseEstimator, Twin, Task, Model.from_layout]
    calls += [lambda v: learn(v, frames), lambda v: examine(frames, v)]
    calls += [lambda v: Writer(tmp_path / "run.mcap", v, device_id="dev")]
    for call in calls:
        with pytest.raises(LayoutError, match="a Layout is needed"):
            call(layout)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("given", NO_NUMBERS, ids=shown)
@pytest.mark.parametrize(
    ("error", "call", "names"),
    [
        (ArgumentError, lambda **of: Processor(CELLS, **of), ["min_contrast", "covered_below"]),
        (
            ArgumentError,
            lambda **of: Tracker(CELLS, **of),
            ["min_contrast", "release_contrast", "hold"],
        ),
        (
            EstimationError,
            lambda **of: PoseEstimator(CELLS, **of),
            ["diameter_mm", "noise", "gain_error", "huber", "gap_sd_mm", "alpha_sd"],
        ),
        (TwinError, lambda **of: PoseEstimator(CELLS, **of), ["gap_mm"]),
        (TwinError, lambda **of: Twin(CELLS, **of), ["ambient", "noise", "bits", "seed"]),
        (TwinError, Model, ["gap_mm", "alpha", "knee_v", "silicone_index"]),
        (TwinError, Misregistration, ["x_mm", "tilt_deg"]),
        (TwinError, HalfPlane, ["offset_mm", "angle_deg", "curvature_per_mm", "hem_mm", "clear"]),
        (TwinError, Cable, ["offset_mm", "diameter_mm", "height"]),
        (TwinError, Corner, ["x_mm", "opening_deg"]),
        (TwinError, Disc, ["y_mm", "diameter_mm"]),
        (ControlError, lambda **of: Tracer(LineLaw(), **of), ["slow_s", "lead_s", "corner_frames"]),
        (ControlError, LineLaw, ["speed_mm_s", "gain_per_s", "target_mm"]),
        (ControlError, CentreLaw, ["speed_mm_s", "gain_per_s"]),
        (ControlError, Limits, ["lateral_mm_s"]),
        (TaskError, Settings, ["length_mm", "rate_hz", "latency", "lag_s", "noise", "target_mm"]),
        (ArmError, ArmLimits, ["speed_mm_s", "stale_s"]),
        (ArmError, lambda **of: URArm("127.0.0.1", Mount((1, 0, 0), (0, 0, 1)), **of), ["timeout"]),
    ],
)
def test_a_setting_that_is_no_number(
    error: type[LumitipError], call: Callable[..., object], names: list[str], given: Any
) -> None:
    for name in names:
        if isinstance(given, int) and name in COUNTS:
            continue
        with pytest.raises(error, match=rf"^{name} is .*; .*(needed|allowed)"):
            call(**{name: given})


@pytest.mark.parametrize(
    ("error", "call"),
    [
        (EstimationError, lambda: PoseEstimator(CELLS, noise=0.0)),
        (EstimationError, lambda: PoseEstimator(CELLS, diameter_mm=0.0)),
        (EstimationError, lambda: PoseEstimator(CELLS, optics=CELLS)),  # type: ignore[arg-type]
        (EstimationError, lambda: PoseEstimator(CELLS, gains=[math.inf] * 32)),
        (ArgumentError, lambda: Processor(CELLS, min_contrast=-1.0)),
        (ArgumentError, lambda: learn(CELLS, np.zeros((30, 32)), most_frames=3)),
        (TwinError, lambda: Twin(CELLS, CELLS.optics)),  # type: ignore[arg-type]
        (TwinError, lambda: Model().changed(gap=3.0)),
        (TwinError, lambda: Model.from_layout(CELLS, hole=3.0)),
        (TwinError, lambda: Disc(diameter_mm=-1.0)),
        (TwinError, lambda: Corner(opening_deg=0.0)),
        (TwinError, lambda: Cable(diameter_mm=1e9)),
        (TwinError, lambda: Polygon(points_mm=[(0, 0), (1, math.nan), (2, 2)])),
        (TwinError, lambda: Image([["a"]])),  # type: ignore[arg-type]
        (TwinError, lambda: Image.of(Disc(), size_mm=-1.0)),
        (TwinError, lambda: Image.of(Disc(), 10.0, 0.5).at(math.nan, 0.0, 0.0)),
        (ControlError, lambda: LineLaw(-80.0)),
        (ControlError, lambda: Limits(math.nan)),
        (ControlError, lambda: Tracer("line")),  # type: ignore[arg-type]
        (ControlError, lambda: Tracer(LineLaw(), 400.0)),  # type: ignore[arg-type]
        (TaskError, lambda: Task(CELLS, "cable")),  # type: ignore[arg-type]
        (TaskError, lambda: LiveTask("cable", "twin://x")),  # type: ignore[arg-type]
        (ArgumentError, lambda: Curve.random(1e12, 1)),
        (ArgumentError, lambda: Curve.random(100.0, -1)),
        (ArmError, lambda: Mount(x="abc", y=(0, 0, 1))),  # type: ignore[arg-type]
        (ArmError, lambda: URArm("127.0.0.1", None)),  # type: ignore[arg-type]
        (ArgumentError, lambda: hexagonal_grid(["a"], 6.0)),  # type: ignore[list-item]
        (ArgumentError, lambda: hexagonal_grid(5, 6.0)),  # type: ignore[arg-type]
        (ArgumentError, lambda: hexagonal_grid([4.5, 5.2], 6.0)),  # type: ignore[list-item]
        (ArgumentError, lambda: hexagonal_grid([10**400], 6.0)),
        (ArgumentError, lambda: hexagonal_grid([[4, 5], [6]], 6.0)),  # type: ignore[list-item]
        (ArgumentError, lambda: hexagonal_neighbours(5)),  # type: ignore[arg-type]
        (ArgumentError, lambda: Block.of([])),
        (ArgumentError, lambda: Block.of(np.zeros((3, 32)))),  # type: ignore[arg-type]
        (ArgumentError, lambda: Block.of(None)),  # type: ignore[arg-type]
        (ArgumentError, lambda: FingertipGroup.open({1: "twin://a"}, layout={"b": CELLS})),  # type: ignore[dict-item]
        (ArgumentError, lambda: checked_kind(np.array(["empty", "dark"]))),
        (TwinError, lambda: Twin(CELLS, bits=np.array([8, 10]))),  # type: ignore[arg-type]
        (TwinError, lambda: Model(hole_shape=np.array(["hexagon", "circle"]))),  # type: ignore[arg-type]
        (TwinError, lambda: material(np.array(["cloth", "paper"]))),  # type: ignore[arg-type]
        (TaskError, lambda: Settings(np.array(["cable", "cloth"]))),  # type: ignore[arg-type]
        (CalibrationError, lambda: Calibration("dev", "0", np.array(["a"]))),
        (CalibrationError, lambda: Calibration("dev", "0", np.zeros((8, 32), np.float32))),
    ],
)
def test_what_cannot_be_so(error: type[LumitipError], call: Callable[[], object]) -> None:
    with pytest.raises(error, match=r"needed|not finite|; ") as told:
        call()
    assert "\n" not in str(told.value)


@pytest.mark.parametrize(
    "pitch_mm", ["6", None, math.inf, 10**400, -1.0, np.array([6.0, 6.0])], ids=shown
)
def test_a_pitch_that_is_none(pitch_mm: Any) -> None:
    with pytest.raises(ArgumentError, match=r"pitch_mm is .*; a number above 0 is needed"):
        hexagonal_grid([4, 5], pitch_mm)


def test_what_is_told_of_what_was_given() -> None:
    assert shown(np.zeros((2, 3))) == "array([[0., 0., 0.], [0., 0., 0.]])"
    assert shown("a\nb") == r"'a\nb'"
    assert shown([1.0] * 99) == "[" + "1.0, " * 7 + "1.0,"
    assert shown(10**5000) == "<int>"


@pytest.mark.parametrize("given", NO_NAMES, ids=shown)
def test_a_path_that_is_none(given: Any, tmp_path: Path) -> None:
    from lumitip.recording import Reader, RecordingError, Writer, export, recover, summarise

    calls: list[Call] = [Reader, summarise, lambda v: recover(v, tmp_path / "new.mcap")]
    calls += [lambda v: Writer(v, CELLS, device_id="dev")]
    calls += [lambda v: Writer(tmp_path / "run.mcap", CELLS, device_id=v)]
    calls += [lambda v: export(tmp_path / "run.mcap", v)]
    for call in calls:
        with pytest.raises(RecordingError, match=r"; .* needed"):
            call(given)
    for error, load in (
        (LayoutError, Layout.load),
        (LayoutError, Layout.from_json),
        (CalibrationError, Calibration.load),
    ):
        with pytest.raises(error):
            load(given)
    assert not list(tmp_path.iterdir())


def test_a_folder_that_is_a_file_is_told_before_the_trials(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "taken").write_text("", encoding="utf-8")
    assert main(["bench-tasks", "--trials", "1", "--out", str(tmp_path / "taken")]) == 2
    assert "cannot be written" in capsys.readouterr().err


def test_scenes_and_places_of_a_twin(twin: Twin) -> None:
    calls: list[Callable[[], object]] = [
        lambda: twin.values("edge"),
        lambda: twin.values([1, 2]),
        lambda: twin.values(Cable),
        lambda: twin.batch(Cable()),
        lambda: twin.batch(np.zeros((3, 5), np.float32)),
        lambda: twin.edges([1.0, 2.0, 3.0], [1.0, 2.0]),
        lambda: twin.edges(math.nan, 0.0),
        lambda: twin.edges(0.0, 0.0, 2.0),
        lambda: twin.frame((), -1.0),
        lambda: twin.plane(2.0),
        lambda: twin.edge_table(math.nan),
        lambda: twin.cable_table(0.0),
        lambda: fit_edge(CELLS, np.zeros(32), math.nan, 0.0),
    ]  # type: ignore[arg-type,list-item]
    for call in calls:
        with pytest.raises(TwinError, match=r"needs|needed"):
            call()


def test_what_is_seen_and_commanded_in_a_task(twin: Twin) -> None:
    task = Task(CELLS, Settings("cable"), twin)
    for seen in (np.zeros(32), None, "edge"):
        with pytest.raises(ControlError, match="; a Contact or an Estimate is needed"):
            sight_of(seen)  # type: ignore[arg-type]
    contact = Processor(CELLS)(twin.values(HalfPlane()))
    for dt_s in NO_NUMBERS:
        with pytest.raises(ControlError, match=r"dt_s is .*;"):
            Tracer(LineLaw())(contact, dt_s)
    for command in (3.0, None, Command(math.nan), Command("1")):  # type: ignore[arg-type]
        with pytest.raises(TaskError, match=";"):
            task.step(command)  # type: ignore[arg-type]
    with pytest.raises(TaskError, match=r"seed is 'a';"):
        task.reset("a")  # type: ignore[arg-type]
    with pytest.raises(TaskError, match="allowed are centre, line, pose"):
        Bench(task).run("lines", 80.0, Tuning(), 0)
    other = replace(CELLS, x_mm=CELLS.x_mm + 1.0)
    with pytest.raises(TaskError, match="Use a twin of this layout"):
        Task(other, twin=twin)
