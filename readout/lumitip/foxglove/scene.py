"""`write_scene`: several recordings in one MCAP file, with what Foxglove draws of each.

Topics of a fingertip NAME: `/NAME/frames` (raw codes, as in a recording), `/NAME/values`,
`/NAME/contact`, `/NAME/estimate` (JSON), `/NAME/light` (`foxglove.Grid`), `/NAME/cells`,
`/NAME/published` and `/NAME/estimated` (`foxglove.SceneUpdate`); for all `/tf`
(`foxglove.FrameTransforms`).
"""

import heapq
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mcap.writer import Writer as McapWriter
from mcap_protobuf.schema import register_schema

from lumitip import arguments
from lumitip.errors import LumitipError
from lumitip.estimation import PoseEstimator
from lumitip.estimation.estimate import LEAST_CELLS
from lumitip.estimation.estimator import DIAMETER_MM
from lumitip.foxglove import drawings, numbers
from lumitip.foxglove.panels import ROOT
from lumitip.frame import RecordedFrame
from lumitip.processing import Tracker
from lumitip.recording import Reader
from lumitip.recording import message as frames_message
from lumitip.recording.metadata import FINGER
from lumitip.recording.metadata import NAME as RECORD
from lumitip.twin.optics import GAP_MM
from lumitip.view.drawn import ESTIMATE, PUBLISHED, borders
from lumitip.view.pose import described, reach_of

MOST_HZ = 60.0
"""Largest rate of drawings: more are not visible. Numbers have every frame."""
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
"""Names that topics can have."""


class FoxgloveError(LumitipError):
    """A file for Foxglove that cannot be written."""


@dataclass(frozen=True)
class Written:
    """The result of `write_scene`."""

    path: Path
    frames: int
    damage: tuple[str, ...]
    """Damage of the recordings, for the user; damaged parts are left out."""


def write_scene(
    target: str | Path,
    recordings: Mapping[str, str | Path | Reader],
    *,
    gap_mm: float = GAP_MM,
    diameter_mm: float = DIAMETER_MM,
    estimates: bool = True,
) -> Written:
    """Write a file for Foxglove.

    Args:
        target: of the file, ending in `.mcap`; must not exist yet.
        recordings: of each fingertip, by a name of letters, digits and `_`: a path, or of a file
            with several fingertips `Reader(path, tolerant=True, finger=...)`.
        gap_mm: that the estimates expect, see `PoseEstimator`.
        diameter_mm: of cables that the estimates expect.
        estimates: whether poses are estimated, which takes about a millisecond for each frame.

    Raises:
        FoxgloveError: if there is no recording or no frame, a name cannot be used, or the file
            exists or cannot be written; after an error no partial file is left.
        RecordingError: if a file is not a recording.
        EstimationError, TwinError: if gap or diameter cannot be used.
    """
    path = arguments.path(target, FoxgloveError)
    if path.suffix != ".mcap":
        raise FoxgloveError(
            f"the file is {path}; its name must end in .mcap for Foxglove to open it"
        )
    fingers = [
        _Finger(_name(name), _reader(file), gap_mm, diameter_mm, estimates)
        for name, file in _recordings(recordings).items()
    ]
    try:
        file = path.open("xb")
    except FileExistsError as error:
        raise FoxgloveError(f"{path} exists. Choose another name") from error
    except OSError as error:
        raise FoxgloveError(arguments.unwritable(path, error)) from error
    try:
        with file:
            frames = _write(McapWriter(file), fingers)
    except BaseException as error:
        path.unlink(missing_ok=True)
        if isinstance(error, OSError):
            raise FoxgloveError(f"{path}: cannot be written: {error}") from error
        raise
    damage = tuple(f"{f.name}: {why}" for f in fingers for why in f.reader.damage)
    return Written(path, frames, damage)


def _reader(recording: str | Path | Reader) -> Reader:
    return recording if isinstance(recording, Reader) else Reader(recording, tolerant=True)


def _recordings(recordings: object) -> Mapping[str, str | Path | Reader]:
    if not isinstance(recordings, Mapping) or not recordings:
        raise FoxgloveError(
            "recordings by name are needed, such as {'left': 'left.mcap', 'right': 'right.mcap'}"
        )
    return recordings


def _name(name: object) -> str:
    if not isinstance(name, str) or not NAME.fullmatch(name) or name == ROOT:
        raise FoxgloveError(
            f"a fingertip is called {name!r:.60}; letters, digits and _ are allowed, a letter "
            f"first, and not {ROOT!r}. Give it another name: NAME=FILE"
        )
    return name


class _Finger:
    """A recording, and what is computed of its frames."""

    def __init__(
        self, name: str, reader: Reader, gap_mm: float, diameter_mm: float, estimates: bool
    ) -> None:
        layout = reader.layout
        self.name, self.reader = name, reader
        self._track, self._raster = Tracker(layout), drawings.Raster(layout)
        self._estimator = None
        if estimates and len(layout) >= LEAST_CELLS:
            self._estimator = PoseEstimator(
                layout, gap_mm=gap_mm, diameter_mm=diameter_mm, tracking=True
            ).prepare()
        self._reach_mm, self._drawn_ns = reach_of(layout), float("-inf")

    def frames(self) -> Iterator[tuple[int, str, RecordedFrame]]:
        """Frames with their time (ns) and name, in order of time. After the wall clock was set back
        the times go on by the other clock of the computer."""
        newest_ns = shift_ns = 0
        last_s: float | None = None
        for frame in self.reader:
            at_ns = frames_message.stamp_ns(frame.t_wall) + shift_ns
            if last_s is not None and at_ns < newest_ns:
                passed_ns = round(max(frame.t_host - last_s, 0.0) * 1e9)
                shift_ns += newest_ns + passed_ns - at_ns
                at_ns = newest_ns + passed_ns
            newest_ns, last_s = at_ns, frame.t_host
            yield at_ns, self.name, frame

    def messages(self, at_ns: int, frame: RecordedFrame) -> Iterator[tuple[str, Any]]:
        """Topic and message of all that is written of a frame but its raw codes."""
        layout, values = self.reader.layout, self.reader.metadata.values(frame)
        contact = self._track(values)
        yield "values", numbers.values_record(values, frame.dropped_before)
        yield "contact", numbers.contact_record(contact)
        estimate = self._estimator(values) if self._estimator else None
        if estimate:
            yield "estimate", numbers.estimate_record(estimate)
        if at_ns - self._drawn_ns < 1e9 / MOST_HZ:
            return
        self._drawn_ns = at_ns
        yield "light", self._raster.grid(values, self.name, at_ns)
        yield "cells", drawings.cells(layout, values, self.name, at_ns)
        strips = borders(contact, self._reach_mm)
        yield (
            "published",
            drawings.lines(layout, strips, PUBLISHED, "published", self.name, at_ns),
        )
        if estimate:
            strips = described(estimate, self._reach_mm)["lines"]
            yield (
                "estimated",
                drawings.lines(layout, strips, ESTIMATE, "estimate", self.name, at_ns),
            )


_SCHEMAS = {"values": numbers.VALUES, "contact": numbers.CONTACT, "estimate": numbers.ESTIMATE}


class _Topics:
    """Channels of a file, which are registered when they are first needed."""

    def __init__(self, mcap: McapWriter) -> None:
        self._mcap = mcap
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}

    def frame(self, name: str, at_ns: int, frame: RecordedFrame, device_id: str) -> None:
        """Write raw codes, as a recording has them."""
        if frames_message.SCHEMA_NAME not in self._schemas:
            text = frames_message.schema_text().encode()
            self._schemas[frames_message.SCHEMA_NAME] = self._mcap.register_schema(
                frames_message.SCHEMA_NAME, "ros2msg", text
            )
        schema = self._schemas[frames_message.SCHEMA_NAME]
        data = frames_message.encode(frame, device_id, frame.dropped_before)
        self._add(
            frames_message.frames_topic(name), "cdr", schema, at_ns, data, frame.seq & 0xFFFFFFFF
        )

    def message(self, topic: str, at_ns: int, message: Any) -> None:
        """Write a record as JSON, or a message of Foxglove's."""
        if isinstance(message, dict):
            schema = _SCHEMAS[topic.rpartition("/")[2]]
            if schema.name not in self._schemas:
                self._schemas[schema.name] = self._mcap.register_schema(
                    schema.name, "jsonschema", schema.text.encode()
                )
            data = numbers.encoded(message)
            self._add(topic, "json", self._schemas[schema.name], at_ns, data)
            return
        kind = type(message)
        name = kind.DESCRIPTOR.full_name
        if name not in self._schemas:
            self._schemas[name] = register_schema(self._mcap, kind)
        data = message.SerializeToString(deterministic=True)
        self._add(topic, "protobuf", self._schemas[name], at_ns, data)

    def _add(
        self, topic: str, encoding: str, schema: int, at_ns: int, data: bytes, seq: int = 0
    ) -> None:
        if topic not in self._channels:
            self._channels[topic] = self._mcap.register_channel(topic, encoding, schema)
        self._mcap.add_message(self._channels[topic], at_ns, data, at_ns, seq)


def _write(mcap: McapWriter, fingers: list[_Finger]) -> int:
    """All messages in order of time; returns the number of frames."""
    mcap.start(profile="", library="lumitip")
    for finger in fingers:
        mcap.add_metadata(RECORD, finger.reader.metadata.to_texts() | {FINGER: finger.name})
    topics, by_name, count = _Topics(mcap), {f.name: f for f in fingers}, 0
    layouts = [(finger.name, finger.reader.layout) for finger in fingers]
    for at_ns, name, frame in heapq.merge(*(f.frames() for f in fingers), key=lambda each: each[0]):
        finger = by_name[name]
        if not count:
            topics.message("/tf", at_ns, drawings.places(layouts, at_ns))
        count += 1
        topics.frame(name, at_ns, frame, finger.reader.metadata.device_id)
        for topic, message in finger.messages(at_ns, frame):
            topics.message(f"/{name}/{topic}", at_ns, message)
    mcap.finish()
    if not count:
        raise FoxgloveError("no recording has a frame")
    return count
