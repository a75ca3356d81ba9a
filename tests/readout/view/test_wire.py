"""Messages to the browser, read here as `lumitip.view.wire` describes them."""

import struct
from collections.abc import Callable

import numpy as np
import pytest

from lumitip import Layout
from lumitip.frame import Frame
from lumitip.processing import Processor
from lumitip.view.wire import encode


def frame(values: np.ndarray, seq: int, t: float) -> Frame:
    raw = np.zeros(len(values), np.uint8)
    return Frame(seq, t, t, t, t, raw, 8, values.astype(np.float32), 0, "test")


def edge(layout: Layout, turn_deg: float) -> np.ndarray:
    turn = np.deg2rad(turn_deg)
    across = layout.x_mm * np.cos(turn) + layout.y_mm * np.sin(turn)
    return np.clip(127.5 + 60.0 * across, 4.0, 251.25)


@pytest.mark.parametrize("columns", [(5, 4, 5, 4, 5, 4, 5), (2, 3), (16,) + (15, 16) * 20])
def test_message_says_frames_and_contact(
    make_layout: Callable[..., Layout], columns: tuple[int, ...]
) -> None:
    layout = make_layout(columns)
    values = [edge(layout, turn) for turn in (10.0, 20.0, 30.0)]
    frames = [frame(v, 2**32 + 5 + i, 100.0 + i / 200) for i, v in enumerate(values)]
    contact = Processor(layout)(frames[-1].values)
    assert contact.line
    assert contact.centre_mm
    assert contact.markers_mm is not None
    data = encode(3, 70_000, frames, contact, skipped=12, since=99.0)

    told = struct.unpack_from("<BBHHHHHIII", data)
    k = len(contact.markers_mm)
    assert told == (1, 0, 3, 3, len(layout), k, 0, 70_000, 12, 0)
    at = 24
    np.testing.assert_allclose(np.frombuffer(data, "<f8", 3, at), [1.0, 1.005, 1.01])
    at += 24
    fields = np.frombuffer(data, "<f4", 20, at)
    assert fields[0] == 1
    np.testing.assert_allclose(fields[1], contact.threshold, rtol=1e-6)
    np.testing.assert_allclose(fields[3:5], contact.centre_mm, rtol=1e-6)
    np.testing.assert_allclose(fields[7], contact.line.angle_deg, rtol=1e-6)
    at += 80
    markers = np.frombuffer(data, "<f4", 2 * k, at).reshape(k, 2)
    np.testing.assert_allclose(markers, contact.markers_mm, rtol=1e-5, atol=1e-5)
    at += 8 * k
    assert np.frombuffer(data, "<u4", 3, at).tolist() == [5, 6, 7]
    at += 12
    codes = np.frombuffer(data, "<u2", 3 * len(layout), at).reshape(3, -1)
    np.testing.assert_allclose(codes / 256.0, values, atol=1 / 512)
    assert len(data) == at + codes.nbytes


def test_no_contact_and_no_number(layout: Layout) -> None:
    values = np.full(len(layout), 255.0)
    values[7] = np.nan
    contact = Processor(layout)(values)
    data = encode(1, 1, [frame(values, 0, 0.0)], contact)
    fields = np.frombuffer(data, "<f4", 20, 32)
    assert fields[0] == 0
    assert np.isnan(fields[1:]).all()
    codes = np.frombuffer(data, "<u2", len(layout), 32 + 80 + 4)
    assert codes[7] == 65535
    assert set(codes[np.arange(len(layout)) != 7]) == {255 * 256}
