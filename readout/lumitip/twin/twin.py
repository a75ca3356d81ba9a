"""`Twin`: values that a fingertip of a layout reads of a scene.

twin = Twin(layout)
twin.values(HalfPlane(offset_mm=2.0, angle_deg=15.0))   # calibrated, without noise
twin.frame(Cable(angle_deg=30.0), t=1.5)                # raw codes, as the firmware sends them
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from lumitip import arguments
from lumitip.frame import Codes
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.twin.cached import Cached
from lumitip.twin.inputs import cell_gains, code_bits, height_in_gap, same_shape
from lumitip.twin.lines import Numbers
from lumitip.twin.optics import FULL, Model, TwinError, values_of_drive
from lumitip.twin.outline import Outline, Polygon
from lumitip.twin.pairs import Emitter, Misregistration, Mixed, Pairs
from lumitip.twin.raster import Plane, blended, direct_plane, scattered_plane
from lumitip.twin.scene import Cable, Line, Scene, Singles, Thing, things
from lumitip.twin.tables import LineTable, cable_table, edge_table
from lumitip.values import shown

WARM_UP_S = 100.0
"""Time constant of the decay of the LEDs' extra light after switching on (s)."""


class Twin:
    """The optical twin of a fingertip pair. Thread-safe: only caches change. Can be pickled."""

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
            model: optics and circuit; by default those of the layout at a gap of 3 mm.
            gains: light of each cell relative to its empty grasp, shape `(cells,)`; by default 1.
            misregistration: of the emitter; part of the empty grasp.
            ambient: light from outside, as a share of the full light of the brightest cell; not
                part of the empty grasp.
            noise: standard deviation of the values (counts of 255).
            bits: of the raw codes, 8, 10 or 12.
            seed: of the noise; the same seed and time give the same codes.
            warm_up: extra light of the LEDs when switched on, as a share.

        Raises:
            LayoutError: if `layout` is no layout.
            TwinError: if another argument is invalid.
        """
        self.layout = arguments.layout(layout)
        model = Model.from_layout(layout) if model is None else model
        self.model = arguments.instance(model, Model, "model", TwinError)
        deviation = Misregistration() if misregistration is None else misregistration
        arguments.instance(deviation, Misregistration, "misregistration", TwinError)
        self.emitter = Emitter(self.model, deviation)
        self.gains = cell_gains(gains, len(layout))
        self.bits = code_bits(bits)
        self.seed = arguments.count(seed, "seed", 0, TwinError)
        self.ambient, self.noise, self.warm_up = (
            arguments.number(of, name, 0.0, error=TwinError)
            for of, name in ((ambient, "ambient"), (noise, "noise"), (warm_up, "warm_up"))
        )
        self._pairs = Pairs.of(layout, self.emitter)
        straight = Pairs.of(layout, Emitter(self.model)).full
        self.drive: Floats = self.model.gain * self._pairs.full / straight.max()
        """Photocurrent of each cell in the empty grasp; 1 is the largest current of the pull-up."""
        self.empty: Floats = values_of_drive(self.drive, self.model)
        """Value of each cell in the empty grasp before calibration, 0 to 255."""
        optics = layout, self._pairs, self.emitter
        self._direct = Cached(partial(direct_plane, *optics))
        self._scatter = Cached(partial(scattered_plane, *optics))
        self._material = Cached(self._material_plane)
        self._outline = Cached(self._outline_of)
        self._edges = Cached(partial(edge_table, self._pairs))
        self._mixed = Cached(partial(Mixed, layout, self._pairs, self._scattered))
        self._cables = Cached(partial(cable_table, self._pairs))

    def values(self, scene: Scene = ()) -> Floats:
        """Values without noise, calibrated with the empty grasp, 0 to 255, shape `(cells,)`."""
        return self.calibrated(self.light(scene))

    def batch(self, scenes: Sequence[Scene] | Singles, height: float = 0.5) -> Floats:
        """Values of many scenes, shape `(n, cells)`.

        Args:
            scenes: scenes, or coverage of an opaque object on `plane(height)`, `(n, pixels)`.
            height: of that coverage in the gap.

        Raises:
            TwinError: if `scenes` is neither.
        """
        if isinstance(scenes, np.ndarray):
            at = self.plane(height)
            if scenes.ndim != 2 or scenes.shape[1] != at.x_mm.size:
                raise TwinError(
                    f"scenes has shape {scenes.shape}; (n, {at.x_mm.size} pixels) is needed"
                )
            return self.calibrated(1.0 - at(scenes))
        if isinstance(scenes, Thing | str) or not isinstance(scenes, Sequence):
            raise TwinError(f"scenes is {shown(scenes)}; a list of scenes is needed")
        if not scenes:
            return np.empty((0, len(self.layout)))
        return self.calibrated(np.stack([self.light(scene) for scene in scenes]))

    def light(self, scene: Scene = ()) -> Numbers:
        """Share of its empty-grasp light that each cell receives, shape `(cells,)`.

        A single edge or cable is looked up in a table, flat objects at one height are computed on
        the raster, everything else ray by ray.
        """
        found = things(scene)
        if not found:
            return np.ones(len(self.layout))
        if len(found) == 1 and isinstance(found[0], Line) and not found[0].hem_mm:
            return self._of_line(found[0])
        flat = not any(isinstance(thing, Cable) for thing in found)
        if flat and len({thing.height for thing in found}) == 1:
            return self._of_flat(found)
        return self._mixed().light(found)

    def edges(
        self,
        offset_mm: ArrayLike,
        angle_deg: ArrayLike,
        clear: ArrayLike = 0.0,
        curvature_per_mm: ArrayLike = 0.0,
    ) -> Floats:
        """Values of many edges, shape `(n, cells)`, from the table.

        Args:
            offset_mm: of each edge along its left normal, shape `(n,)`; its right is covered.
            angle_deg: its direction, shape `(n,)`.
            clear: transmittance of each sheet, shape `(n,)` or one for all.
            curvature_per_mm: of each edge, positive to the left, shape `(n,)` or one for all.

        Raises:
            TwinError: if they are no finite numbers of one shape, or `clear` is not 0 to 1.
        """
        offset, angle, bend, through = same_shape(
            offset_mm=offset_mm, angle_deg=angle_deg, curvature_per_mm=curvature_per_mm, clear=clear
        )
        if through.min(initial=0.0) < 0.0 or through.max(initial=1.0) > 1.0:
            raise TwinError(f"clear is {shown(clear)}; numbers from 0 to 1 are needed")
        taken = self.edge_table().of_lines(self.layout, offset, angle, bend)
        return self.calibrated(1.0 - (1.0 - through[:, None]) * taken)

    def cables(
        self,
        offset_mm: ArrayLike,
        angle_deg: ArrayLike,
        curvature_per_mm: ArrayLike = 0.0,
        diameter_mm: float = 3.0,
    ) -> Floats:
        """Values of many opaque cables of one diameter, shape `(n, cells)`, from the table.

        Args:
            offset_mm: of each axis, as of an edge; the next two likewise.
            angle_deg: its direction.
            curvature_per_mm: its curvature.
            diameter_mm: of all.

        Raises:
            TwinError: if they are no finite numbers of one shape.
        """
        lines = same_shape(
            offset_mm=offset_mm, angle_deg=angle_deg, curvature_per_mm=curvature_per_mm
        )
        return self.calibrated(1.0 - self.cable_table(diameter_mm).of_lines(self.layout, *lines))

    def edge_table(self, height: float = 0.5) -> LineTable:
        """Light that an opaque half-plane takes from each cell, by direction and distance."""
        return self._edges(height_in_gap(height))

    def cable_table(self, diameter_mm: float = 3.0, height: float = 0.5) -> LineTable:
        """The same for an opaque round cable, by the distance from its axis."""
        diameter_mm = Cable(diameter_mm=diameter_mm).diameter_mm
        return self._cables(diameter_mm, height_in_gap(height))

    def plane(self, height: float = 0.5) -> Plane:
        """The raster at a height in the gap."""
        return self._direct(height_in_gap(height))

    def calibrated(self, light: Numbers) -> Floats:
        """Values of shares of light, both of shape `(..., cells)`; 255 is the empty grasp."""
        values: Floats = self.uncalibrated(light) * (FULL / self.empty)
        return np.clip(values, 0.0, FULL, out=values)

    def uncalibrated(self, light: Numbers, extra: float | Floats = 0.0) -> Floats:
        """Values before calibration, 0 to 255, of shares of light and extra light of the LEDs."""
        drive = light * (self.drive * self.gains * (1.0 + extra))
        return values_of_drive(drive + self.ambient * self.model.gain, self.model)

    def frame(self, scene: Scene = (), t: float = 0.0) -> Codes:
        """Raw codes of one frame as the firmware sends them: dark is high, shape `(cells,)`.

        Args:
            scene: the objects between the fingers.
            t: time since switching on (s).
        """
        times_s = np.array([arguments.number(t, "t", 0.0, error=TwinError)])
        codes: Codes = self.codes(self.light(scene)[None], times_s)[0]
        return codes

    def codes(self, light: Numbers, times_s: Floats) -> Codes:
        """Raw codes of shares of light, shape `(n, cells)`, at times since switching on (s)."""
        extra = self.warm_up * np.exp(-np.asarray(times_s) / WARM_UP_S)[:, None]
        voltage = (FULL - self.uncalibrated(light, extra)) / FULL
        if self.noise:
            chances = [self._chance(t).standard_normal(len(self.layout)) for t in times_s]
            voltage = voltage + (self.noise / FULL) * np.stack(chances)
        most = 2**self.bits - 1
        # An ADC rounds down to whole steps, so it reads half a step low on average.
        codes: Codes = np.clip(np.floor(voltage * (most + 1)), 0, most).astype(
            np.uint8 if self.bits == 8 else np.uint16
        )
        return codes

    def _chance(self, t: float) -> np.random.Generator:
        return np.random.Generator(np.random.SFC64([self.seed, round(t * 1e6)]))

    def _of_line(self, line: Line) -> Numbers:
        left_mm, beside_deg = line.left_of(self.layout.x_mm, self.layout.y_mm)
        if isinstance(line, Cable):
            table = self._cables(line.diameter_mm, line.height)
        else:
            table = self._edges(line.height)
        return self._behind(line, table(beside_deg, left_mm))

    def _behind(self, thing: Thing, taken: Numbers) -> Numbers:
        """Light behind an object that would take these shares if it were opaque."""
        light: Numbers = 1.0 - (1.0 - thing.clear) * taken
        return light + thing.diffuse * self._scattered(thing) if thing.diffuse else light

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
            return 1.0 - taken if dense and thing.diffuse else self._behind(thing, taken)
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
        """Share of light that passes each pixel straight, and the share that passes at all."""
        clear = whole = np.ones(at.x_mm.size, np.float32)
        for thing in found:
            for layer in thing.layers(at.x_mm, at.y_mm, at.pixel_mm):
                clear = clear * (1.0 - (1.0 - thing.clear) * layer)
                whole = whole * (1.0 - (1.0 - thing.clear - thing.diffuse) * layer)
        return clear, whole

    def _scattered(self, thing: Thing) -> Numbers:
        at = self._scatter(thing.height)
        return at(thing.coverage(at.x_mm, at.y_mm, at.pixel_mm).astype(np.float32))

    def _material_plane(self, height: float, clear: float, diffuse: float) -> Plane:
        return blended(self._direct(height), self._scatter(height), clear, diffuse)

    def _outline_of(self, height: float, clear: float, diffuse: float) -> Outline | None:
        at = self.plane(height)
        if not Outline.fits(at):
            return None
        scattered = self._scatter(height) if diffuse else replace(at, weights=0.0 * at.weights)
        return Outline(blended(at, scattered, clear, diffuse))
