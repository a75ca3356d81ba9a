"""Public objects as values: one line of text; copied, compared and sent to other processes."""

import asyncio
import copy
import pickle
from dataclasses import asdict

import numpy as np
import pytest

from lumitip import AsyncFingertip, Block, Fingertip, FingertipGroup, LinkEvent, Stats
from lumitip.control import LineLaw, Tracer
from lumitip.estimation import PoseEstimator
from lumitip.health.doctor import examine
from lumitip.processing import Processor, Tracker
from lumitip.recording import Reader, Writer
from lumitip.tasks import Curve
from lumitip.twin import LineTable


def test_stats_are_copied_compared_and_pickled(open_feed) -> None:
    tip, feed = open_feed()
    feed.packet(0)
    feed.packet(4)
    stats = tip.stats
    for other in (pickle.loads(pickle.dumps(stats)), copy.deepcopy(stats), copy.copy(stats)):
        assert isinstance(other, Stats)
        assert other == stats and hash(other) == hash(stats)
    assert stats.dropped == {"link": 3, "queue": 0, "crc": 0, "length": 0}
    assert asdict(stats)["dropped"] == stats.dropped
    with pytest.raises(KeyError):
        stats.dropped["keys"]
    with pytest.raises(AttributeError):
        stats.dropped.link = 0
    feed.packet(6)
    assert tip.stats != stats
    assert "dropped={'link': 3, 'queue': 0, 'crc': 0, 'length': 0}" in repr(stats)


def test_a_legacy_device_has_stats_too(open_feed) -> None:
    tip, feed = open_feed()
    feed.legacy(1)
    assert pickle.loads(pickle.dumps(tip.stats)) == tip.stats


def test_every_public_object_is_one_useful_line(open_feed, layout, tmp_path) -> None:
    tip, feed = open_feed()
    feed.packet(0)
    feed.packet(3, value=40)
    frame = tip.latest()
    group = FingertipGroup({"left": tip})
    values = frame.values.copy()
    values[:9] = 20.0
    law = LineLaw(20.0)
    path = tmp_path / "run.mcap"
    with Writer(path, layout, device_id="feed") as writer:
        writer.write(frame)
        text_of_writer = repr(writer)
    recorded = next(iter(Reader(path)))
    light = np.stack([frame.values, values]).astype(np.float32)
    texts = {
        repr(frame): "Frame(seq=3, ",
        repr(recorded): "raw=<uint8[32] from 40 to 40>",
        repr(Block.of([frame, frame])): "values=<float32[2, 32] from 215 to 215>",
        repr(layout): f"<Layout of 32 cells, pitch 6 mm, design {layout.design_hash[:16]}>",
        repr(tip.calibration): "Calibration(device_id='feed', ",
        repr(tip): "<Fingertip feed: connected; 32 cells, 2 frames, 33.3 Hz, lost: 2>",
        repr(group): "<FingertipGroup of left: <Fingertip feed: connected",
        repr(LinkEvent("lost", "gone")): "LinkEvent(kind='lost', detail='gone'",
        repr(AsyncFingertip.open("twin://disc")): "<AsyncFingertip twin://disc: not open>",
        repr(Processor(layout)): "<Processor of <Layout of 32 cells",
        repr(Tracker(layout)): "<Tracker, hold 3, <Processor",
        repr(PoseEstimator(layout)): "<PoseEstimator of <Layout of 32 cells",
        repr(PoseEstimator(layout)(values)): "covariance=<float64[",
        repr(Processor(layout)(values)): "markers_mm=<float64[",
        repr(Processor(layout).batch(light)): "thresholds=<float64[2]",
        repr(examine(light, layout)): "noise=<float32[32]",
        repr(Tracer(law)): "<Tracer of LineLaw(speed_mm_s=20.0",
        repr(
            LineTable(np.zeros((1, 2, 3), np.float32), 2.0, np.zeros(1, int))
        ): "shares=<float32[1, 2, 3] from 0",
        repr(Curve.random(100.0, 0)): "Curve(x_mm=<float64[",
        text_of_writer: "run.mcap: feed, 1 frames>",
        repr(Reader(path)): "run.mcap: feed, <Layout of 32 cells",
    }
    for text, part in texts.items():
        assert part in text
        assert "\n" not in text
    feed.report(LinkEvent("lost", "gone"))
    assert "feed: reconnecting; " in repr(tip)
    tip.close()
    assert "the fingertip was closed" in repr(tip)


def test_moments_and_open_coroutines_are_one_line() -> None:
    async def main() -> str:
        async with AsyncFingertip.open("twin://disc") as tip:
            return repr(tip)

    with FingertipGroup.open({"left": "twin://disc", "right": "twin://edge"}) as group:
        assert " s of left, right, spread 0." in repr(group.read(10.0))
    assert "<AsyncFingertip twin://disc: <Fingertip twin:disc: connected; " in asyncio.run(main())


def test_drift_is_one_line() -> None:
    from lumitip.session.drift import DriftWatch

    watch = DriftWatch()
    for n in range(400):
        watch.add(np.zeros(32, np.uint8), 8, n * 0.1, n * 0.1)
    assert repr(watch.drift).startswith("Drift(watched_s=")


def test_a_fingertip_is_described_while_it_streams() -> None:
    with Fingertip.open("twin://disc") as tip:
        tip.read(10.0)
        assert repr(tip).startswith("<Fingertip twin:disc: connected; 32 cells, ")
