"""The lifecycle node, with the twin, on messages that have the types of ROS's own definitions."""

import math
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lumitip import Fingertip
from lumitip.estimation import PoseEstimator
from lumitip.processing import Processor
from lumitip.recording import Writer
from ros_node import SENSOR_DATA, Executor, Node, Returned

Make = Callable[..., Any]


def wait_for(node: Any, topic: str, count: int, timeout_s: float = 10.0) -> list[Any]:
    until = time.monotonic() + timeout_s
    while len(node.published[topic]) < count:
        assert time.monotonic() < until, f"{len(node.published[topic])} messages on {topic}"
        time.sleep(0.01)
    return list(node.published[topic])


@pytest.fixture
def active(make_node: Make) -> Any:
    """A node that publishes a cable, which stays on the cells for some seconds."""
    node = make_node(url="twin://cable?seed=3&speed=1")
    assert node.on_configure(None) is Returned.SUCCESS
    assert node.on_activate(None) is Returned.SUCCESS
    return node


def test_every_frame_is_published_with_the_time_of_its_cells(active: Any) -> None:
    values = wait_for(active, "~/values", 12)
    contacts, estimates = wait_for(active, "~/contact", 12), wait_for(active, "~/estimate", 12)
    stamps = [m.header.stamp.sec + m.header.stamp.nanosec * 1e-9 for m in values]
    assert stamps == sorted(stamps) and abs(stamps[-1] - time.time()) < 5.0
    for one, contact, estimate in zip(values, contacts, estimates, strict=False):
        heads = [m.header for m in (one, contact, estimate)]
        assert {h.frame_id for h in heads} == {"lumitip_receiver"}
        assert len({(h.stamp.sec, h.stamp.nanosec) for h in heads}) == 1
        assert len(one.values) == 32
    own = {topic: qos for topic, qos in active.qos.items() if topic.startswith("~/")}
    assert isinstance(own.pop("~/markers"), int), "a depth alone is reliable, as RViz asks for"
    assert len(own) == 3 and all(qos is SENSOR_DATA for qos in own.values())


def test_contact_and_estimate_are_in_metres_and_radians(active: Any) -> None:
    wait_for(active, "~/estimate", 5)
    active.on_deactivate(None)
    layout = active._tip.layout
    process, pose = Processor(layout), PoseEstimator(layout, tracking=True).prepare()
    for one, contact, estimate in zip(
        *(active.published[t] for t in ("~/values", "~/contact", "~/estimate")), strict=False
    ):
        light = np.array(one.values)
        wanted, fitted = process(light), pose(light)
        assert contact.shape == wanted.shape
        assert contact.centre.x == pytest.approx(wanted.centre_mm[0] / 1000)
        assert estimate.kind == fitted.kind == "cable"
        assert estimate.offset == pytest.approx(fitted.offset_mm / 1000, abs=1e-9)
        assert estimate.angle == pytest.approx(math.radians(fitted.angle_deg), abs=1e-9)
        assert estimate.width == pytest.approx(fitted.width_mm / 1000)
        names = list(estimate.parameters)
        size = len(names)
        assert size == len(fitted.parameters) and not any("_" in n for n in names)
        assert {"transmittance", "gain"} <= set(names) <= set(vars(estimate)) | {"x", "y"}
        assert estimate.curvature == pytest.approx(fitted.curvature_per_mm * 1000)
        assert estimate.transmittance == pytest.approx(fitted.transmittance)
        spread = np.reshape(estimate.covariance, (size, size))
        at = names.index("offset"), names.index("angle")
        assert math.sqrt(spread[at[0], at[0]]) == pytest.approx(fitted.offset_sd_mm / 1000)
        assert math.sqrt(spread[at[1], at[1]]) == pytest.approx(math.radians(fitted.angle_sd_deg))


@pytest.mark.parametrize("name", ["cloth_edge", "cloth_corner", "cable"])
def test_a_published_frame_has_its_light_and_dark_centre(
    make_node: Make,
    tmp_path: Path,
    published_frames: dict[str, dict[str, Any]],
    published_values: Callable[[str], Any],
    name: str,
) -> None:
    """Raw codes are high in the dark, values in the light: neither may be taken for the other."""
    values = published_values(name)
    with Fingertip.open("twin://edge") as tip:
        frame, layout = tip.read(timeout=5.0), tip.layout
    path = tmp_path / "run.mcap"
    with Writer(path, layout, device_id="x") as writer:
        for seq in range(4):
            fields = {n: getattr(frame, n) for n in frame.__slots__}
            raw = (255 - values).astype(np.uint8)
            writer.write(type(frame)(**fields | {"raw": raw, "bits": 8, "seq": seq}))
    node = make_node(url=f"replay://{path}?speed=0", estimate=False)
    node.on_configure(None)
    node.on_activate(None)
    contact, light = wait_for(node, "~/contact", 1)[0], wait_for(node, "~/values", 1)[0]
    assert light.values == pytest.approx(values.tolist(), abs=0.05)
    found_mm = contact.centre.x * 1000, contact.centre.y * 1000
    assert found_mm == pytest.approx(published_frames[name]["dark_centre_mm"], abs=0.02)


def test_the_line_is_a_frame_with_x_along_it(active: Any) -> None:
    placed = wait_for(active, "/tf", 3)[-1]
    assert (placed.header.frame_id, placed.child_frame_id) == ("lumitip_receiver", "lumitip_line")
    stamp = placed.header.stamp
    (estimate,) = [m for m in active.published["~/estimate"] if m.header.stamp is stamp]
    move, turn = placed.transform.translation, placed.transform.rotation
    assert math.hypot(move.x, move.y) == pytest.approx(abs(estimate.offset))
    along = math.cos(estimate.angle), math.sin(estimate.angle)
    assert move.x * along[0] + move.y * along[1] == pytest.approx(0.0, abs=1e-12)
    assert 2 * math.atan2(turn.z, turn.w) == pytest.approx(estimate.angle)
    assert turn.x == turn.y == move.z == 0.0


def test_markers_show_cells_and_lines_and_delete_what_is_gone(active: Any, ros: Any) -> None:
    marked = wait_for(active, "~/markers", 2)[-1].markers
    assert [m.ns for m in marked] == ["cells", "published", "estimate"]
    cells, _, estimate = marked
    assert len(cells.points) == len(cells.colors) == 32
    layout = active._tip.layout
    np.testing.assert_allclose([p.x for p in cells.points], layout.x_mm / 1000)
    assert len(estimate.points) == 6 and estimate.action == estimate.ADD
    gone = ros.markers.lines([], ros.ESTIMATE, "estimate", cells.header)
    assert gone.action == gone.DELETE and gone.points == []
    assert all(m.pose.orientation.w == 1.0 for m in marked)
    lifetimes_s = {m.lifetime.sec + m.lifetime.nanosec * 1e-9 for m in marked}
    assert lifetimes_s == {0.5}, "RViz shows nothing once the link is cut"
    over = estimate.points[0].z - cells.scale.z / 2
    assert cells.type == cells.CUBE_LIST and over > 1e-4, "lines are over the cells"
    active.on_deactivate(None)
    (last,) = active.published["~/markers"][-1].markers
    assert last.action == last.DELETEALL


@pytest.mark.parametrize("end", ["on_shutdown", "on_error", "on_deactivate"])
def test_markers_are_deleted_when_an_active_node_ends(active: Any, end: str) -> None:
    wait_for(active, "~/markers", 1)
    assert getattr(active, end)(None) is Returned.SUCCESS
    (last,) = active.published["~/markers"][-1].markers
    assert last.action == last.DELETEALL


def test_nothing_is_published_unless_the_node_is_active(make_node: Make) -> None:
    node = make_node(url="twin://edge", estimate=False)
    assert node.on_configure(None) is Returned.SUCCESS
    time.sleep(0.2)
    assert not node.published["~/values"]
    node.on_activate(None)
    wait_for(node, "~/values", 3)
    assert not node.published["~/estimate"]
    node.on_deactivate(None)
    time.sleep(0.1)
    before = len(node.published["~/values"])
    time.sleep(0.2)
    assert len(node.published["~/values"]) == before
    node.on_activate(None)
    wait_for(node, "~/values", before + 3)
    assert node.on_cleanup(None) is Returned.SUCCESS
    assert node._tip is None


@pytest.mark.parametrize(
    ("parameters", "why"),
    [
        ({"url": "serial:///dev/lumitip-none"}, "lumitip-none"),
        ({"url": "twin://edge", "layout": "/no/layout.json"}, "/no/layout.json"),
        ({"url": "twin://edge", "gap_mm": -1.0}, "The parameter estimate: false does without"),
        ({"url": "tcp://127.0.0.1:1"}, "127.0.0.1"),
    ],
)
def test_what_cannot_be_opened_leaves_the_node_unconfigured(
    make_node: Make, parameters: dict[str, Any], why: str
) -> None:
    node = make_node(**parameters)
    assert node.on_configure(None) is Returned.FAILURE
    assert any(level == "error" and why in text for level, text in node.logged)
    assert node._tip is None and not node.failure, "the process goes on"
    node.diagnose()
    (status,) = node.published["/diagnostics"][-1].status
    assert status.level == status.ERROR and why in status.message


def test_taring_answers_why_it_failed(make_node: Make) -> None:
    node = make_node(url="twin://edge", estimate=False)
    answer = node.services["~/tare"]()
    assert (answer.success, "not configured" in answer.message) == (False, True)
    node.on_configure(None)
    answer = node.services["~/tare"]()
    assert not answer.success and "Hold the fingers still and open" in answer.message
    empty = make_node(url="twin://empty", estimate=False)
    empty.on_configure(None)
    answer = empty.services["~/tare"]()
    assert (answer.success, answer.message) == (True, "empty grasp measured and saved")


def recorded(path: Path) -> Path:
    with Fingertip.open("twin://edge") as tip, Writer(path, tip.layout, device_id="x") as writer:
        for _ in range(3):
            writer.write(tip.read(timeout=5.0))
    return path


def test_a_link_that_fails_for_good_is_fatal_and_ends_the_process(
    ros: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = recorded(tmp_path / "run.mcap")
    monkeypatch.setattr(Node, "overrides", {"url": f"replay://{path}", "estimate": False})
    monkeypatch.setattr(Node, "made", [])
    with pytest.raises(SystemExit) as ended:
        ros.main()
    (node,) = Node.made
    assert ended.value.code == 1
    assert any(level == "fatal" and "is over" in text for level, text in node.logged)
    (status,) = node.published["/diagnostics"][-1].status
    assert status.level == status.ERROR and "is over" in status.message
    assert node.destroyed and Executor.shut_down
    for topic in ("/diagnostics", "~/markers"):
        assert node.acknowledged[topic] == len(node.published[topic]) > 0
    (last,) = node.published["~/markers"][-1].markers
    assert last.action == last.DELETEALL, "no contact stays in RViz"


def test_a_frame_that_cannot_be_published_is_fatal(
    make_node: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    node = make_node(url="twin://edge", estimate=False)
    node.on_configure(None)
    monkeypatch.setattr(node, "_track", lambda _: 1 / 0)
    node.on_activate(None)
    until = time.monotonic() + 5.0
    while not node.failure:
        assert time.monotonic() < until
        time.sleep(0.01)
    assert "ZeroDivisionError" in node.failure
    assert any(level == "fatal" for level, _ in node.logged)


def test_after_the_end_of_ros_nothing_more_is_said(
    make_node: Make, ros: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    node = make_node(url="twin://edge", estimate=False)
    node.on_configure(None)
    monkeypatch.setattr(node, "_track", lambda _: 1 / 0)
    monkeypatch.setattr(ros.rclpy, "ok", lambda: False)
    node.on_activate(None)
    time.sleep(0.3)
    assert not node.failure and not any(level == "fatal" for level, _ in node.logged)


def test_diagnostics_do_not_wait_for_taring(make_node: Make) -> None:
    groups = make_node(url="twin://edge").groups
    assert groups["timer"] is not None, "of its own"
    assert groups["~/tare"] is None, "that of the transitions"


def test_ctrl_c_ends_without_an_error(ros: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Node, "overrides", {"url": "twin://edge", "estimate": False})
    monkeypatch.setattr(Node, "made", [])
    monkeypatch.setattr(Executor, "rounds", 2)
    with pytest.raises(SystemExit) as ended:
        ros.main()
    assert ended.value.code == 0
    assert Node.made[0].destroyed and Node.made[0]._tip is None


def test_diagnostics_tell_how_the_fingertip_is(make_node: Make) -> None:
    def diagnosed(node: Any) -> tuple[bytes, str]:
        (diagnose,) = node.timers
        diagnose()
        (status,) = node.published["/diagnostics"][-1].status
        return status.level, status.message

    node = make_node(url="twin://empty", estimate=False, stale_s=5.0)
    assert diagnosed(node) == (b"\3", "not configured")
    node.on_configure(None)
    assert node.services["~/tare"]().success
    node.on_activate(None)
    wait_for(node, "~/values", 3)
    assert diagnosed(node) == (b"\0", "frames arrive")
    (status,) = node.published["/diagnostics"][-1].status
    figures = {pair.key: pair.value for pair in status.values}
    assert int(figures["received"]) >= 3 and figures["lost"] == "0"
    assert status.name == "/fingertip: fingertip"
    node.on_deactivate(None)
    time.sleep(0.6)
    assert diagnosed(node) == (b"\0", "frames arrive"), (
        "the link is well, only nothing is published"
    )
    node.parameters["stale_s"] = 1e-6
    level, text = diagnosed(node)
    assert level == b"\1" and "s" in text
    node.on_cleanup(None)
    assert diagnosed(node) == (b"\3", "not configured")
