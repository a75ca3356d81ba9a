"""The first frame after opening, of a link that delivers it at once."""

import time
from dataclasses import replace

import numpy as np
import pytest

from lumitip import Calibration, Fingertip, Layout
from lumitip.errors import CalibrationError
from lumitip.links.base import Arrival, Deliver, LinkEvent, Report


class _Eager:
    """A link whose first frame comes with its start."""

    device_id = "feed"

    def __init__(self, layout: Layout) -> None:
        self.layout = layout
        self.stopped = False

    def start(self, deliver: Deliver, report: Report) -> None:
        report(LinkEvent("connected", "connected"))
        deliver(Arrival(time.monotonic(), np.full(len(self.layout), 155, np.uint8)))

    def stop(self) -> None:
        self.stopped = True


@pytest.mark.parametrize("own", [False, True])
def test_the_first_frame_of_all_has_the_known_calibration(
    layout: Layout, monkeypatch: pytest.MonkeyPatch, own: bool
) -> None:
    known = Calibration("feed", layout.design_hash, np.full(len(layout), 200.0, np.float32))
    link = _Eager(layout)
    if own:
        link.calibration = known  # as a recording has it
    else:
        known.save()
    monkeypatch.setattr("lumitip.fingertip.open_link", lambda *_: link)
    with Fingertip.open("feed://") as tip:
        assert tip.latest().values == pytest.approx(np.full(len(layout), 127.5))
    with Fingertip.open("feed://", calibrated=False) as tip:
        assert tip.latest().values == pytest.approx(np.full(len(layout), 100.0))
    blind = np.full(len(layout), 9.0, np.float32)
    link.stopped, link.calibration = False, replace(known, dark=known.empty, empty=blind)
    with pytest.raises(CalibrationError, match="not lighter"):
        Fingertip.open("feed://")
    assert link.stopped, "a link whose calibration is refused"
