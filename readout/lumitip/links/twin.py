"""`twin://demo`: a simulated fingertip in real time: `lumitip.twin` behind a link.

A shape moves between the fingers; the packets of version 2 are those of a device that was just
switched on.

    twin://SHAPE?speed=12&noise=1.5&rate=100&bits=8&seed=0&gap=3&diameter=3&warm=2.5
        &material=opaque

SHAPE is disc, edge, corner, cable, sheet, empty, or demo, which shows the first four in turn.

    speed     mm/s
    noise     standard deviation, counts of 255
    rate      frames per second
    gap       mm between the fingers
    diameter  of cables (mm)
    warm      excess light of cold LEDs (%)
    material  opaque, or a key of `lumitip.twin.materials`
"""

import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from importlib.resources import files
from typing import Any

import numpy as np

from lumitip.errors import UrlError
from lumitip.layout import Layout
from lumitip.links import twin_object
from lumitip.links.base import Arrival, Deliver, LinkEvent, Report
from lumitip.links.thread import ThreadedLink
from lumitip.links.url import Url
from lumitip.protocol.packet import BITS, Packet, design_code
from lumitip.twin import Model, Twin, scene
from lumitip.twin.materials import MATERIALS

TASKS = {"trace-cloth": "trace_cloth.py", "trace-cable": "trace_cable.py"}
"""Links of `lumitip.tasks.live`, and the example that runs each."""
_PACKETS_HZ = 133.0  # one packet per shortest Bluetooth connection interval, 7.5 ms
SHAPES = ("demo", "disc", "edge", "corner", "cable", "sheet", "empty")
_DEMO = ("disc", "edge", "corner", "cable")
_DEMO_MM = 60.0  # distance before the demonstration changes its shape


@dataclass(frozen=True)
class Matter:
    """Size and optics of the shapes."""

    diameter_mm: float = 3.0
    """Diameter of cables (mm)."""
    clear: float = 0.0
    diffuse: float = 0.0
    height: float = 0.5
    material: str = twin_object.OPAQUE
    """Key of the material."""

    @classmethod
    def of(cls, key: str, diameter_mm: float) -> "Matter":
        """The matter of a material."""
        clear, diffuse = twin_object.light_through(key)
        return cls(diameter_mm, clear, diffuse, material=key)


OPAQUE = Matter()


@dataclass(frozen=True)
class Scene:
    """Options of a twin."""

    shape: str
    speed_mm_s: float
    noise: float
    rate_hz: float
    bits: int
    seed: int
    gap_mm: float = 3.0
    matter: Matter = OPAQUE
    warm_up: float = 0.025
    placed: twin_object.Placed | None = None
    """The object where a user has put it; `None` while it moves by itself."""


class TwinLink(ThreadedLink):
    """A simulated fingertip; see the module."""

    _name = "lumitip-twin"

    def __init__(self, layout: Layout, options: Scene) -> None:
        super().__init__()
        self.layout = layout
        self.device_id = f"twin:{options.shape}"
        self.why_late = (
            f"the tables of {len(layout)} cells are still being computed (minutes for thousands of "
            "cells). Increase the timeout, or use a layout of fewer cells"
        )
        self._options = options
        self._choice = twin_object.Choice(options.shape, options.matter.material)
        self._sent = 0
        self._start_lock = threading.Lock()
        self._started = False

    def stop(self) -> None:
        """Stop sending; a thread that still computes tables ends later by itself."""
        with self._start_lock:
            self._stopping.set()
        if self._started:
            super().stop()

    def _run(self, deliver: Deliver, report: Report) -> None:
        packet_at(self.layout, self._options, 0, 1)  # computes the tables before the clock starts
        with self._start_lock:
            if self._stopping.is_set():
                return
            self._started = True
        report(LinkEvent("connected", f"{self.device_id} is simulated"))
        began = time.monotonic()
        batch = max(1, round(self._options.rate_hz / _PACKETS_HZ))
        while not self._stopping.is_set():
            # A packet is sent at the time of its last frame; a late thread catches up.
            due_s = (self._sent + batch) / self._options.rate_hz
            if self._stopping.wait(max(0.0, began + due_s - time.monotonic())):
                return
            packet = packet_at(self.layout, self._options, self._sent, batch)
            deliver(Arrival(time.monotonic(), packet))
            self._sent += batch

    def controls(self) -> dict[str, Any]:
        """See `Placeable`."""
        return twin_object.controls_of(self.layout, SHAPES)

    def placement(self) -> dict[str, Any]:
        """See `Placeable`."""
        return twin_object.status_of(self._choice, self._now(), self.layout)

    def place(self, asked: Mapping[str, object]) -> None:
        """See `Placeable`."""
        choice = twin_object.changed(self._choice, self._now(), self.layout, asked, SHAPES)
        matter = Matter.of(choice.material, self._options.matter.diameter_mm)
        self._choice = choice
        self._options = replace(
            self._options, shape=choice.shape, matter=matter, placed=choice.placed
        )

    def _now(self) -> twin_object.Placed:
        return scene_at(self.layout, self._options, self._sent / self._options.rate_hz)


def packet_at(layout: Layout, options: Scene, number: int, frames: int) -> Packet:
    """The packet of `frames` frames from frame `number` on; deterministic."""
    times_s = (number + np.arange(frames)) / options.rate_hz
    twin = _twin(
        layout.to_json(),
        Model.from_layout(layout, options.gap_mm),
        options.noise,
        options.bits,
        options.seed,
        options.warm_up,
    )
    scenes = [scene_at(layout, options, t) for t in times_s]
    return Packet(
        design=design_code(layout.design_hash),
        sequence=number % 2**16,
        bits=options.bits,
        time_us=round(number * 1e6 / options.rate_hz) % 2**32,
        period_us=min(round(1e6 / options.rate_hz), 2**16 - 1),
        values=twin.codes(np.stack([twin.light(one) for one in scenes]), times_s),
    )


def scene_at(layout: Layout, options: Scene, t_s: float) -> twin_object.Placed:
    """The scene at a time (s)."""
    if options.placed is not None:
        return options.placed
    return moved(options.shape, layout, t_s * options.speed_mm_s, options.matter)


@lru_cache(maxsize=8)
def _twin(text: str, model: Model, noise: float, bits: int, seed: int, warm_up: float) -> Twin:
    """The twin of a layout by its text, since layouts that differ in holes alone are equal."""
    layout = Layout.from_json(text)
    return Twin(layout, model, noise=noise, bits=bits, seed=seed, warm_up=warm_up)


def make(url: Url, layout: Layout | None, any_design: bool) -> TwinLink:  # noqa: ARG001
    """The twin of an address; the default layout is the published sensor.

    Raises:
        UrlError: if shape or option is unknown.
    """
    url.allow("speed", "noise", "rate", "bits", "seed", "gap", "diameter", "warm", "material")
    shape = url.target or "demo"
    if shape in TASKS:
        raise UrlError(
            f"{url.text!r} is a task, in which a program moves the finger. Run `python "
            f"examples/{TASKS[shape]} 60 8642` and open http://127.0.0.1:8642, see "
            "lumitip.tasks.live, or use twin://edge or twin://cable"
        )
    if shape not in SHAPES:
        raise UrlError(
            f"{url.text!r}: there is no shape {shape!r}; allowed are {', '.join(SHAPES)}"
        )
    sheet = url.choice("material", "opaque", *(m.key for m in MATERIALS))
    options = Scene(
        shape=shape,
        speed_mm_s=url.number("speed", 12.0, 0.0, 1000.0),
        noise=url.number("noise", 1.5, 0.0, 100.0),
        rate_hz=url.number("rate", 100.0, 1.0, 5000.0),
        bits=int(url.choice("bits", *map(str, BITS))),
        seed=int(url.number("seed", 0, 0, 2**32)),
        gap_mm=url.number("gap", 3.0, 0.5, 20.0),
        matter=Matter.of(sheet, url.number("diameter", 3.0, 0.1, 20.0)),
        warm_up=url.number("warm", 2.5, 0.0, 100.0) / 100.0,
    )
    return TwinLink(layout or published_layout(), options)


def published_layout() -> Layout:
    """The layout of the published sensor, written by `lumitip-fab`."""
    text = files("lumitip.links").joinpath("published_layout.json").read_text(encoding="utf-8")
    return Layout.from_json(text, "published_layout.json")


def moved(shape: str, layout: Layout, way_mm: float, matter: Matter) -> twin_object.Placed:
    """The scene of one of `SHAPES` after moving `way_mm` over the cells."""
    if shape == "demo":
        turn = int(way_mm // _DEMO_MM)
        return moved(_DEMO[turn % len(_DEMO)], layout, way_mm, matter)
    if shape == "empty":
        return ()
    thing = _placed(shape, layout, way_mm, matter.diameter_mm)
    return replace(thing, clear=matter.clear, diffuse=matter.diffuse, height=matter.height)


def _placed(shape: str, layout: Layout, way_mm: float, diameter_mm: float) -> scene.Thing:
    if shape == "sheet":
        return scene.Sheet()
    reach_mm = float(np.hypot(np.ptp(layout.x_mm), np.ptp(layout.y_mm))) / 2.0
    reach_mm = max(reach_mm, layout.pitch_mm)  # of a single cell the reach is 0
    there = _to_and_fro(way_mm, reach_mm)
    if shape == "disc":
        x_mm = 0.7 * reach_mm * float(np.sin(way_mm / reach_mm))
        y_mm = 0.7 * reach_mm * float(np.sin(1.4 * way_mm / reach_mm))
        return scene.Disc(x_mm, y_mm, 2.4 * layout.pitch_mm)
    if shape == "cable":
        turn_deg = 25.0 * float(np.sin(way_mm / (2.0 * reach_mm))) - 20.0
        return scene.Cable(0.6 * there, turn_deg, diameter_mm=diameter_mm)
    if shape == "edge":
        return scene.HalfPlane(0.6 * there, 20.0 * float(np.sin(way_mm / (3.0 * reach_mm))) - 90.0)
    turn_deg = way_mm / reach_mm * 10.0
    inward = np.radians(turn_deg + 45.0)
    away_mm = 0.4 * np.sqrt(2.0) * there
    return scene.Corner(
        float(away_mm * np.cos(inward)), float(away_mm * np.sin(inward)), turn_deg + 225.0
    )


def _to_and_fro(way_mm: float, reach_mm: float) -> float:
    """A position between -reach and +reach, moving to and fro at constant speed."""
    return float(abs((way_mm + reach_mm) % (4.0 * reach_mm) - 2.0 * reach_mm) - reach_mm)
