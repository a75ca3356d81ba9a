"""The file for Foxglove, as the reference readers of MCAP, protobuf and JSON schemas see it."""

import json
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from mcap.reader import make_reader

from lumitip import Layout
from lumitip.estimation.estimate import without_contact
from lumitip.foxglove import drawings, numbers, panels, write_scene
from lumitip.frame import Frame, RecordedFrame
from lumitip.recording import Reader, Writer
from lumitip.view.drawn import ESTIMATE

Messages = dict[str, list[tuple[Any, Any, Any]]]
Sources = dict[str, tuple[Path, list[Frame]]]
ANGLE_DEG, OFFSET_MM = 20.0, 2.0
"""Of the edge in the recordings."""


def test_each_topic_has_the_schema_that_panels_know(messages: Messages) -> None:
    kinds = {topic: found[0][0].name for topic, found in messages.items()}
    of_each = {
        "frames": "lumitip_msgs/msg/Frame",
        "values": "lumitip.Values",
        "contact": "lumitip.Contact",
        "estimate": "lumitip.Estimate",
        "light": "foxglove.Grid",
        "cells": "foxglove.SceneUpdate",
        "published": "foxglove.SceneUpdate",
        "estimated": "foxglove.SceneUpdate",
    }
    wanted = {
        f"/{name}/{topic}": kind for name in ("left", "right") for topic, kind in of_each.items()
    }
    assert kinds == wanted | {"/tf": "foxglove.FrameTransforms"}
    for topic, found in messages.items():
        times = [message.log_time for _, message, _ in found]
        assert times == sorted(times), topic


def test_raw_codes_are_those_of_the_recordings(scene: Path, sources: Sources) -> None:
    for name, (path, frames) in sources.items():
        reader, alone = Reader(scene, finger=name), Reader(path)
        assert reader.metadata.to_texts() == alone.metadata.to_texts()
        for one, other, frame in zip(reader, alone, frames, strict=True):
            np.testing.assert_array_equal(one.raw, frame.raw)
            assert (one.seq, one.t_wall, one.bits) == (other.seq, other.t_wall, other.bits)
        assert reader.damage == ()


def test_json_keeps_to_its_schema_and_has_calibrated_light(
    messages: Messages, sources: Sources
) -> None:
    for topic in ("values", "contact", "estimate"):
        for name in sources:
            for schema, _, record in messages[f"/{name}/{topic}"]:
                jsonschema.validate(record, json.loads(schema.data))
    for name, (path, _) in sources.items():
        reader = Reader(path)
        wanted = reader.metadata.values(next(iter(reader)))
        np.testing.assert_allclose(messages[f"/{name}/values"][0][2]["values"], wanted, rtol=1e-6)


def test_types_in_schemas_are_single_words_that_foxglove_knows() -> None:
    """Its reader takes each type as a word, and leaves out a topic with another one."""
    kinds = {"object", "array", "number", "integer", "string", "boolean"}

    def walk(schema: dict[str, Any]) -> None:
        assert schema["type"] in kinds, schema
        for inner in schema.get("properties", {}).values():
            walk(inner)
        if schema["type"] == "array":
            walk(schema["items"])

    for schema in (numbers.VALUES, numbers.CONTACT, numbers.ESTIMATE):
        walk(json.loads(schema.text))


def test_what_is_not_known_is_left_out_or_marked(layout: Layout) -> None:
    values = np.full(32, 250.0, np.float32)
    values[[3, 4]] = np.nan, np.inf
    record = numbers.values_record(values, None)
    jsonschema.validate(record, json.loads(numbers.VALUES.text))
    assert record["values"][3:6] == [-1.0, -1.0, 250.0] and record["mean"] == 250.0
    assert "dropped_before" not in record
    nothing = without_contact("none", np.arange(len(layout)) != 3)
    record = numbers.estimate_record(nothing)
    jsonschema.validate(record, json.loads(numbers.ESTIMATE.text))
    assert record["left_out"] == [3] and "offset_mm" not in record
    grid = drawings.Raster(layout).grid(values, "left", 0)
    squares = np.frombuffer(grid.data, np.uint8).reshape(-1, grid.cell_stride)
    red = (squares[:, :3] == [204, 26, 26]).all(axis=1)
    assert 0 < red.sum() < len(squares) / 8
    light = np.frombuffer(grid.data, "<f4")[1::2]
    assert np.isnan(light).any() and np.isinf(light).any()
    update = drawings.cells(layout, values, "left", 0)
    discs = update.entities[0].cylinders
    assert discs[3].color.r == pytest.approx(0.8) and discs[5].color.r == pytest.approx(250 / 255)


def test_times_go_on_after_the_wall_clock_was_set_back(
    tmp_path: Path, layout: Layout, sources: Sources
) -> None:
    _, (frame, *_) = sources["left"]
    with Writer(tmp_path / "a.mcap", layout, device_id="device 0") as writer:
        for i in range(20):
            back_s = 3600.0 if i > 5 else 0.0
            writer.write(_at(frame, i, frame.t_wall + i / 50.0 - back_s, frame.t_host + i / 50.0))
    write_scene(tmp_path / "scene.mcap", {"a": tmp_path / "a.mcap"}, estimates=False)
    with (tmp_path / "scene.mcap").open("rb") as file:
        times = [
            message.log_time
            for _, channel, message in make_reader(file).iter_messages()
            if channel.topic == "/a/values"
        ]
    np.testing.assert_allclose(np.diff(times), 2e7, atol=1e3)


def test_contact_and_estimate_are_those_of_the_edge(messages: Messages) -> None:
    for name in ("left", "right"):
        contact = messages[f"/{name}/contact"][0][2]
        estimate = messages[f"/{name}/estimate"][0][2]
        assert contact["shape"] == estimate["kind"] == "edge"
        assert contact["angle_deg"] == pytest.approx(ANGLE_DEG, abs=5.0)
        assert estimate["angle_deg"] == pytest.approx(ANGLE_DEG, abs=1.0)
        assert estimate["offset_mm"] == pytest.approx(OFFSET_MM, abs=0.3)
        size = len(estimate["parameters"])
        spread = np.reshape(estimate["covariance"], (size, size))
        at = estimate["parameters"].index("offset_mm")
        assert estimate["offset_sd_mm"] == pytest.approx(spread[at, at] ** 0.5)


def test_the_grid_has_the_light_of_each_cell_at_its_place(
    messages: Messages, grids: dict[str, Layout]
) -> None:
    for name, layout in grids.items():
        grid = messages[f"/{name}/light"][0][2]
        light = messages[f"/{name}/values"][0][2]["values"]
        rows = np.frombuffer(grid.data, np.uint8).reshape(-1, grid.row_stride)
        squares = rows.reshape(len(rows), grid.column_count, grid.cell_stride)
        offsets = {field.name: field.offset for field in grid.fields}
        corner, size = grid.pose.position, grid.cell_size
        for x_mm, y_mm, wanted in zip(layout.x_mm, layout.y_mm, light, strict=True):
            column = int((x_mm * 1e-3 - corner.x) / size.x)
            row = int((y_mm * 1e-3 - corner.y) / size.y)
            square = squares[row, column]
            found = square[offsets["light"] :][:4].view("<f4")[0]
            assert found == pytest.approx(wanted, rel=1e-6)
            assert square[offsets["red"]] == int(min(max(found, 0), 255))
            assert square[offsets["alpha"]] == 255
        assert squares[0, 0, offsets["alpha"]] == 0


def test_discs_lie_on_the_cells_and_lines_on_the_edge(
    messages: Messages, grids: dict[str, Layout]
) -> None:
    normal = np.array([-np.sin(np.radians(ANGLE_DEG)), np.cos(np.radians(ANGLE_DEG))])
    for name, layout in grids.items():
        (entity,) = messages[f"/{name}/cells"][0][2].entities
        assert entity.frame_id == name
        places = [(c.pose.position.x * 1e3, c.pose.position.y * 1e3) for c in entity.cylinders]
        np.testing.assert_allclose(places, np.column_stack([layout.x_mm, layout.y_mm]))
        for topic, far_mm in (("estimated", 0.3), ("published", 1.5)):
            (entity,) = messages[f"/{name}/{topic}"][0][2].entities
            (line,) = entity.lines
            points = np.array([(p.x, p.y) for p in line.points]) * 1e3
            assert (abs(points @ normal - OFFSET_MM) < far_mm * (1 + abs(points).max() / 10)).all()
            most_mm = layout.pitch_mm + np.max(places, axis=0)
            assert (abs(points) <= most_mm + 1e-9).all() and np.ptp(points, axis=0).max() > 20.0


@pytest.mark.parametrize(
    ("line", "ends"),
    [
        ([(-99.0, 1.0), (99.0, 1.0)], [(-21.588457, 1.0), (21.588457, 1.0)]),
        ([(2.0, -99.0), (2.0, 99.0)], [(2.0, -18.0), (2.0, 18.0)]),
        ([(0.0, 0.0), (3.0, 4.0)], [(0.0, 0.0), (3.0, 4.0)]),
        ([(-99.0, 30.0), (99.0, 30.0)], None),
        ([(30.0, 0.0), (99.0, 9.0)], None),
    ],
)
def test_lines_end_at_the_edge_of_the_face(
    layout: Layout, line: list[tuple[float, float]], ends: list[tuple[float, float]] | None
) -> None:
    update = drawings.lines(layout, [np.array(line)], ESTIMATE, "line", "left", 0)
    found = [[(p.x * 1e3, p.y * 1e3) for p in each.points] for each in update.entities[0].lines]
    assert len(found) == bool(ends)
    if ends:
        np.testing.assert_allclose(found[0], ends, atol=1e-5)


def test_fingertips_stand_beside_each_other(messages: Messages, grids: dict[str, Layout]) -> None:
    ((_, _, tree),) = messages["/tf"]
    assert [t.child_frame_id for t in tree.transforms] == list(grids)
    assert {t.parent_frame_id for t in tree.transforms} == {"lumitip"}
    left, right = (t.translation.x * 1e3 for t in tree.transforms)
    half_mm = [np.ptp(layout.x_mm) / 2 for layout in grids.values()]
    assert right - left > sum(half_mm) + 10.0


def test_drawings_come_at_most_sixty_times_a_second(
    tmp_path: Path, layout: Layout, sources: Sources
) -> None:
    fast = tmp_path / "fast.mcap"
    _, frames = sources["left"]
    with Writer(fast, layout, device_id="device 0") as writer:
        for i in range(200):
            t = frames[0].t_wall + i / 1000.0
            writer.write(_at(frames[0], i, t))
    write_scene(tmp_path / "scene.mcap", {"fast": fast}, estimates=False)
    with (tmp_path / "scene.mcap").open("rb") as file:
        topics = [channel.topic for _, channel, _ in make_reader(file).iter_messages()]
    assert topics.count("/fast/values") == 200
    assert 10 <= topics.count("/fast/cells") <= 13
    assert "/fast/estimate" not in topics


def _at(frame: Frame, seq: int, t_wall: float, t_host: float = 0.0) -> RecordedFrame:
    numbers = frame.raw, frame.bits, frame.dropped_before
    return RecordedFrame(seq, frame.t_device, t_host, t_wall, *numbers)


def test_panels_show_topics_and_fields_that_the_file_has(messages: Messages) -> None:
    layout = json.loads(panels(["left", "right"]))
    configs = layout["configById"]
    assert set(configs["3D!scene"]["topics"]) <= set(messages)
    assert configs["3D!scene"]["followTf"] == "lumitip"
    for name in ("left", "right"):
        assert configs[f"RawMessages!{name}"]["topicPath"] in messages
        for path in configs[f"Plot!{name}"]["paths"]:
            topic, _, field = path["value"].partition(".")
            assert field in messages[topic][0][2], path
    shown = json.dumps(layout["layout"])
    assert all(f'"{name}"' in shown for name in configs)
