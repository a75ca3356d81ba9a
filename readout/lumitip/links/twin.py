"""`twin://demo`: a fingertip that is computed, in real time: `lumitip.twin` behind a link.

A shape moves between the fingers and packets of version 2 come of it, as from a device that was
just switched on.

    twin://SHAPE?speed=12&noise=1.5&rate=100&bits=8&seed=0&gap=3&diameter=3&warm=2.5
        &material=opaque

SHAPE is disc, edge, corner, cable, sheet, demo, which shows the first four in turn, or empty.
speed is in mm/s, noise in counts of 255, rate in frames a second, gap and the diameter of cables
in mm, warm the light in percent that the LEDs give too much when switched on; material is opaque
or one of `lumitip.twin.materials`.
"""

import threading
import time
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files

import numpy as np

from lumitip.errors import UrlError
from lumitip.layout import Layout
from lumitip.links.base import Arrival, Deliver, LinkEvent, Report
from lumitip.links.shapes import OPAQUE, SHAPES, Matter, shown
from lumitip.links.thread import ThreadedLink
from lumitip.links.url import Url
from lumitip.protocol.packet import BITS, Packet, design_code
from lumitip.twin import Model, Twin
from lumitip.twin.materials import MATERIALS, material

TASKS = {"trace-cloth": "trace_cloth.py", "trace-cable": "trace_cable.py"}
"""What `lumitip.tasks.live` calls its links, and the example that runs each."""
_PACKETS_HZ = 133.0  # one packet each shortest Bluetooth connection interval of 7.5 ms


@dataclass(frozen=True)
class Scene:
    """What a twin shows."""

    shape: str
    speed_mm_s: float
    noise: float
    rate_hz: float
    bits: int
    seed: int
    gap_mm: float = 3.0
    matter: Matter = OPAQUE
    warm_up: float = 0.025


class TwinLink(ThreadedLink):
    """A fingertip that is computed: see the module."""

    _name = "lumitip-twin"

    def __init__(self, layout: Layout, scene: Scene) -> None:
        super().__init__()
        self.layout = layout
        self.device_id = f"twin:{scene.shape}"
        self.why_late = (
            f"the tables of {len(layout)} cells are still being computed, which takes minutes "
            "for thousands: give more time, or a layout of fewer cells"
        )
        self._scene = scene
        self._beginning = threading.Lock()
        self._begun = False

    def stop(self) -> None:
        """Send nothing more; a thread that still makes tables is not waited for, it ends then."""
        with self._beginning:
            self._stopping.set()
        if self._begun:
            super().stop()

    def _run(self, deliver: Deliver, report: Report) -> None:
        packet_at(self.layout, self._scene, 0, 1)  # so that the tables are made before time runs
        with self._beginning:
            if self._stopping.is_set():
                return
            self._begun = True
        report(LinkEvent("connected", f"{self.device_id} is computed, no device"))
        began = time.monotonic()
        batch = max(1, round(self._scene.rate_hz / _PACKETS_HZ))
        sent = 0
        while not self._stopping.is_set():
            # A packet leaves when its last frame is read; a late thread sends what is due at once.
            due_s = (sent + batch) / self._scene.rate_hz
            if self._stopping.wait(max(0.0, began + due_s - time.monotonic())):
                return
            deliver(Arrival(time.monotonic(), packet_at(self.layout, self._scene, sent, batch)))
            sent += batch


def packet_at(layout: Layout, scene: Scene, number: int, frames: int) -> Packet:
    """The packet of `frames` frames from frame `number` on: always the same for the same scene."""
    times_s = (number + np.arange(frames)) / scene.rate_hz
    twin = _twin(
        layout,
        Model.from_layout(layout, scene.gap_mm),
        scene.noise,
        scene.bits,
        scene.seed,
        scene.warm_up,
    )
    scenes = [shown(scene.shape, layout, t * scene.speed_mm_s, scene.matter) for t in times_s]
    return Packet(
        design=design_code(layout.design_hash),
        sequence=number % 2**16,
        bits=scene.bits,
        time_us=round(number * 1e6 / scene.rate_hz) % 2**32,
        period_us=min(round(1e6 / scene.rate_hz), 2**16 - 1),
        values=twin.codes(np.stack([twin.light(one) for one in scenes]), times_s),
    )


@lru_cache(maxsize=8)
def _twin(layout: Layout, model: Model, noise: float, bits: int, seed: int, warm_up: float) -> Twin:
    return Twin(layout, model, noise=noise, bits=bits, seed=seed, warm_up=warm_up)


def make(url: Url, layout: Layout | None, any_design: bool) -> TwinLink:  # noqa: ARG001
    """The twin of an address; without a layout it is of the published sensor.

    Raises:
        UrlError: if there is no such shape or option.
    """
    url.allow("speed", "noise", "rate", "bits", "seed", "gap", "diameter", "warm", "material")
    shape = url.target or "demo"
    if shape in TASKS:
        raise UrlError(
            f"{url.text!r}: a task, in which the finger moves as a program commands; run `python "
            f"examples/{TASKS[shape]} 60 8642` and open http://127.0.0.1:8642, or see "
            "lumitip.tasks.live; what moves by itself is twin://edge or twin://cable"
        )
    if shape not in SHAPES:
        raise UrlError(f"{url.text!r}: {shape!r} given, allowed are {', '.join(SHAPES)}")
    sheet = url.choice("material", "opaque", *(m.key for m in MATERIALS))
    of = None if sheet == "opaque" else material(sheet)
    scene = Scene(
        shape=shape,
        speed_mm_s=url.number("speed", 12.0, 0.0, 1000.0),
        noise=url.number("noise", 1.5, 0.0, 100.0),
        rate_hz=url.number("rate", 100.0, 1.0, 5000.0),
        bits=int(url.choice("bits", *map(str, BITS))),
        seed=int(url.number("seed", 0, 0, 2**32)),
        gap_mm=url.number("gap", 3.0, 0.5, 20.0),
        matter=Matter(
            diameter_mm=url.number("diameter", 3.0, 0.1, 20.0),
            clear=of.clear if of else 0.0,
            diffuse=of.diffuse if of else 0.0,
        ),
        warm_up=url.number("warm", 2.5, 0.0, 100.0) / 100.0,
    )
    return TwinLink(layout or published_layout(), scene)


def published_layout() -> Layout:
    """The layout of the published sensor, as `lumitip-fab` builds it."""
    text = files("lumitip.links").joinpath("published_layout.json").read_text(encoding="utf-8")
    return Layout.from_json(text, "published_layout.json")
