"""`Twin`: what a fingertip of a layout reads of a scene.

twin = Twin(layout)
twin.values(HalfPlane(offset_mm=2.0, angle_deg=15.0))   # calibrated, without noise
twin.frame(Cable(angle_deg=30.0), t=1.5)                # raw codes, as the firmware sends them
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import ArrayLike

from lumitip import arguments
from lumitip.frame import Codes
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.protocol.packet import BITS
from lumitip.twin import inputs
from lumitip.twin.mixed import Mixed
from lumitip.twin.optics import FULL, Model, TwinError, values_of_drive
from lumitip.twin.outline import Outline
from lumitip.twin.pairs import Emitter, Misregistration, Pairs
from lumitip.twin.polygon import Polygon
from lumitip.twin.raster import Plane, blended, direct_plane, scattered_plane
from lumitip.twin.scene import Cable, Line, Numbers, Scene, Singles, Thing, things
from lumitip.twin.tables import LineTable, cable_table, edge_table
from lumitip.values import shown

WARM_UP_S = 100.0
"""Time in which the LEDs come down to a third of what they give too much when switched on."""


class Twin:
    """The optical twin of a fingertip pair. Thread-safe: nothing changes but for caches."""

    def __init__(
        self,
        layout: Layout,
        model: Model | None = None,
        gains: ArrayLike | None = None,
        misregistration: Misregistration | None = None,
        ambient: float = 0.0,
        noise: float = 1.0,
        bits: int = 8,
        seed: int = 0,
        warm_up: float = 0.025,
    ) -> None:
        """A twin of a layout.

        Args:
            layout: the cells.
            model: optics and circuit; those of the layout at a gap of 3 mm by default.
            gains: light of each cell relative to when its empty grasp was measured, shape
                `(cells,)`; 1 by default.
            misregistration: how the emitter stands; part of the empty grasp.
            ambient: light from outside, as a share of the full light of the brightest cell; not
                part of the empty grasp.
            noise: standard deviation of what is read, in counts of 255.
            bits: of the raw codes, 8, 10 or 12.
            seed: of the noise; the same seed and time give the same codes.
            warm_up: share of light that the LEDs give too much when switched on.

        Raises:
            LayoutError: if it is no layout.
            TwinError: if another of them cannot be so.
        """
        self.layout = arguments.layout(layout)
        self.model = (
            Model.from_layout(layout)
            if model is None
            else arguments.instance(model, Model, "model", TwinError)
        )
        astray = Misregistration() if misregistration is None else misregistration
        arguments.instance(astray, Misregistration, "misregistration", TwinError)
        self.emitter = Emitter(self.model, astray)
        self.gains = inputs.gains(gains, len(layout))
        self.bits = arguments.count(bits, "bits", error=TwinError)
        if self.bits not in BITS:
            raise TwinError(f"bits is {shown(bits)}; allowed are {', '.join(map(str, BITS))}")
        self.seed = arguments.count(seed, "seed", 0, TwinError)
        self.ambient, self.noise, self.warm_up = (
            arguments.number(of, name, 0.0, error=TwinError)
            for of, name in ((ambient, "ambient"), (noise, "noise"), (warm_up, "warm_up"))
        )
        self._pairs = Pairs.of(layout, self.emitter)
        straight = Pairs.of(layout, Emitter(self.model)).full
        self.drive: Floats = self.model.gain * self._pairs.full / straight.max()
        """Photocurrent of each cell with an empty grasp, 1 is what the pull-up carries."""
        self.empty: Floats = values_of_drive(self.drive, self.model)
        """Value of each cell with an empty grasp before calibration, 0 to 255."""
        self._direct = lru_cache(maxsize=8)(self._direct_plane)
        self._scatter = lru_cache(maxsize=8)(self._scattered_plane)
        self._material = lru_cache(maxsize=8)(self._material_plane)
        self._outline = lru_cache(maxsize=8)(self._outline_of)
        self._edges = lru_cache(maxsize=8)(self._edge_table)
        self._cables = lru_cache(maxsize=8)(self._cable_table)

    def values(self, scene: Scene = ()) -> Floats:
        """Values without noise, calibrated with the empty grasp, 0 to 255, shape `(cells,)`."""
        return self.calibrated(self.light(scene))

    def batch(self, scenes: Sequence[Scene] | Singles, height: float = 0.5) -> Floats:
        """Values of many scenes, shape `(n, cells)`.

        Args:
            scenes: scenes, or the coverage of an opaque object on `plane(height)`, shape
                `(n, pixels)`.
            height: where in the gap that coverage lies.

        Raises:
            TwinError: if they are neither.
        """
        if isinstance(scenes, np.ndarray):
            at = self.plane(height)
            inputs.coverage(scenes, at.x_mm.size)
            return self.calibrated(1.0 - at(scenes))
        if isinstance(scenes, Thing | str) or not isinstance(scenes, Sequence):
            raise TwinError(f"scenes is {shown(scenes)}; a list of scenes is needed")
        if not scenes:
            return np.empty((0, len(self.layout)))
        return self.calibrated(np.stack([self.light(scene) for scene in scenes]))

    def light(self, scene: Scene = ()) -> Numbers:
        """Share of its empty-grasp light that each cell gets, 1 is all, shape `(cells,)`.

        A single edge or cable is looked up in a table, flat objects at one height go through the
        raster, everything else ray by ray.
        """
        found = things(scene)
        if not found:
            return np.ones(len(self.layout))
        if len(found) == 1 and isinstance(found[0], Line) and not found[0].hem_mm:
            return self._of_line(found[0])
        flat = not any(isinstance(thing, Cable) for thing in found)
        if flat and len({thing.height for thing in found}) == 1:
            return self._of_flat(found)
        return self._mixed.light(found)

    def edges(self, offset_mm: ArrayLike, angle_deg: ArrayLike, clear: ArrayLike = 0.0) -> Floats:
        """Values of many straight edges, shape `(n, cells)`: one look-up each.

        Args:
            offset_mm: signed distance of each edge from the origin along its left normal,
                shape `(n,)`; what is right of it is covered.
            angle_deg: its direction, shape `(n,)`.
            clear: transmittance of each sheet, shape `(n,)` or one for all.

        Raises:
            TwinError: if they are no finite numbers of one shape, or a sheet gives light.
        """
        offset, angle, through = inputs.alike(offset_mm=offset_mm, angle_deg=angle_deg, clear=clear)
        if not ((through >= 0.0) & (through <= 1.0)).all():
            raise TwinError(f"clear is {shown(clear)}; a number from 0 to 1 is needed")
        turn = np.radians(angle)[:, None]
        left = self.layout.y_mm * np.cos(turn) - self.layout.x_mm * np.sin(turn) - offset[:, None]
        share = self.edge_table()(angle[:, None], left)
        return self.calibrated(1.0 - (1.0 - through[:, None]) * share)

    def edge_table(self, height: float = 0.5) -> LineTable:
        """Share of its light that an opaque half-plane takes from each cell, by the direction and
        the signed distance of its edge."""
        return self._edges(inputs.height(height))

    def cable_table(self, diameter_mm: float = 3.0, height: float = 0.5) -> LineTable:
        """The same of an opaque round cable, by the distance from its axis."""
        diameter_mm = Cable(diameter_mm=diameter_mm).diameter_mm
        return self._cables(diameter_mm, inputs.height(height))

    def plane(self, height: float = 0.5) -> Plane:
        """The raster at a height in the gap: places of its pixels and what each gives."""
        return self._direct(inputs.height(height))

    def calibrated(self, light: Numbers) -> Floats:
        """Values of shares of light, both of shape `(..., cells)`, 255 is the empty grasp."""
        values: Floats = self.uncalibrated(light) * (FULL / self.empty)
        return np.clip(values, 0.0, FULL, out=values)

    def uncalibrated(self, light: Numbers, extra: float | Floats = 0.0) -> Floats:
        """Values, 0 to 255, from shares of light; LEDs are too bright by `extra`."""
        drive = light * (self.drive * self.gains * (1.0 + extra))
        return values_of_drive(drive + self.ambient * self.model.gain, self.model)

    def frame(self, scene: Scene = (), t: float = 0.0) -> Codes:
        """Raw codes of one frame, dark is high, shape `(cells,)`: what the firmware sends.

        Args:
            scene: what is between the fingers.
            t: time since switching on (s); the LEDs warm up by it.
        """
        at_s = arguments.number(t, "t", 0.0, error=TwinError)
        one: Codes = self.codes(self.light(scene)[None], np.array([at_s]))[0]
        return one

    def codes(self, light: Numbers, times_s: Floats) -> Codes:
        """Raw codes of shares of light, shape `(n, cells)`, at times since switching on (s)."""
        extra = self.warm_up * np.exp(-np.asarray(times_s) / WARM_UP_S)[:, None]
        voltage = (FULL - self.uncalibrated(light, extra)) / FULL
        if self.noise:
            chances = [self._chance(t).standard_normal(len(self.layout)) for t in times_s]
            voltage = voltage + (self.noise / FULL) * np.stack(chances)
        most = 2**self.bits - 1
        # An ADC tells how many whole steps the voltage has, and so is half a step low.
        codes = np.clip(np.floor(voltage * (most + 1)), 0, most)
        as_sent: Codes = codes.astype(np.uint8 if self.bits == 8 else np.uint16)
        return as_sent

    def _chance(self, t: float) -> np.random.Generator:
        return np.random.Generator(np.random.SFC64([self.seed, round(t * 1e6)]))

    def _of_line(self, line: Line) -> Numbers:
        left_mm, beside_deg = line.left_of(self.layout.x_mm, self.layout.y_mm)
        if isinstance(line, Cable):
            table = self._cables(line.diameter_mm, line.height)
        else:
            table = self._edges(line.height)
        light: Numbers = 1.0 - (1.0 - line.clear) * table(beside_deg, left_mm)
        if line.diffuse:
            light = light + line.diffuse * self._scattered(line)
        return light

    def _of_flat(self, found: Sequence[Thing]) -> Numbers:
        thing = found[0]
        if len(found) == 1 and isinstance(thing, Polygon) and not thing.hem_mm and thing.simple:
            outline = self._outline(thing.height, thing.clear, thing.diffuse)
            if outline is not None:
                return 1.0 - outline(np.asarray(thing.points_mm))
        at = self.plane(thing.height)
        dense = at.index is None
        if len(found) == 1 and dense and thing.diffuse:
            at = self._material(thing.height, thing.clear, thing.diffuse)
        layers = thing.layers(at.x_mm, at.y_mm, at.pixel_mm)
        if len(found) == len(layers) == 1:
            taken = at(np.asarray(layers[0], np.float32))
            if dense and thing.diffuse:
                return 1.0 - taken
            alone: Numbers = 1.0 - (1.0 - thing.clear) * taken
            if thing.diffuse:
                alone = alone + thing.diffuse * self._scattered(thing)
            return alone
        return self._of_layers(found)

    def _of_layers(self, found: Sequence[Thing]) -> Numbers:
        at = self.plane(found[0].height)
        clear, _ = self._through(found, at)
        light: Numbers = 1.0 - at(np.float32(1.0) - clear)
        if any(thing.diffuse for thing in found):
            at = self._scatter(found[0].height)
            clear, whole = self._through(found, at)
            light = light + at(whole - clear)
        return light

    def _through(self, found: Sequence[Thing], at: Plane) -> tuple[Singles, Singles]:
        """Share of light that goes straight through each pixel, and that goes through at all."""
        clear = whole = np.ones(at.x_mm.size, np.float32)
        for thing in found:
            for layer in thing.layers(at.x_mm, at.y_mm, at.pixel_mm):
                clear = clear * (1.0 - (1.0 - thing.clear) * layer)
                whole = whole * (1.0 - (1.0 - thing.clear - thing.diffuse) * layer)
        return clear, whole

    def _scattered(self, thing: Thing) -> Numbers:
        at = self._scatter(thing.height)
        return at(thing.coverage(at.x_mm, at.y_mm, at.pixel_mm).astype(np.float32))

    @cached_property
    def _mixed(self) -> Mixed:
        return Mixed(self.layout, self._pairs, self._scattered)

    def _direct_plane(self, height: float) -> Plane:
        return direct_plane(self.layout, self._pairs, self.emitter, height)

    def _scattered_plane(self, height: float) -> Plane:
        return scattered_plane(self.layout, self._pairs, self.emitter, height)

    def _material_plane(self, height: float, clear: float, diffuse: float) -> Plane:
        return blended(self._direct(height), self._scatter(height), clear, diffuse)

    def _outline_of(self, height: float, clear: float, diffuse: float) -> Outline | None:
        at = self.plane(height)
        if not Outline.fits(at):
            return None
        scattered = self._scatter(height) if diffuse else replace(at, weights=0.0 * at.weights)
        return Outline(blended(at, scattered, clear, diffuse))

    def _edge_table(self, height: float) -> LineTable:
        return edge_table(self._pairs, height)

    def _cable_table(self, diameter_mm: float, height: float) -> LineTable:
        return cable_table(self._pairs, diameter_mm, height)
