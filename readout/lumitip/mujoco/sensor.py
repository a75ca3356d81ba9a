"""`LightSensor`: values of the cells from the state of a MuJoCo model."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from functools import lru_cache

import mujoco
import numpy as np

from lumitip import arguments
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.mujoco.bodies import Bodies, Body
from lumitip.mujoco.model import FINGERS, SENSOR, MujocoError
from lumitip.mujoco.outlines import band, beside, border, turns
from lumitip.twin import Corner, Disc, Model, Polygon, Thing, Twin
from lumitip.values import shown

_REACH_MM = 8.0  # around the cells, within which objects are looked for
_NEAR_MM = 5.0  # around the cells; nothing farther away changes their light by a count
_GAP_STEP_MM, _LEAST_GAP_MM, _MOST_GAP_MM = 0.25, 0.5, 10.0
_HEIGHTS = 6  # steps of the height in the gap: light depends little on it
_CORNER = np.radians(20.0)  # change of direction from which on a bend is a corner
Material = tuple[float, float]


class LightSensor:
    """The light of a fingertip pair, by its optical twin.

    A single rope, cable, capsule or lying cylinder is a round cable, and everything else an
    outline at its height. Solids are convex, as for MuJoCo's contacts. The reference of each gap
    is the empty grasp at that gap.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        layout: Layout,
        optics: Model | None = None,
        materials: Mapping[str, Material] | None = None,
        fingers: tuple[str, str] = FINGERS,
    ) -> None:
        """A sensor of a model.

        Args:
            model: with both fingers.
            layout: the cells.
            optics: of the twin, by default those of the layout; the gap is that of the fingers.
            materials: clear and diffuse transmittance of geoms and flexes, by name; what is not
                named is opaque.
            fingers: names of the bodies whose frames are the sensor frames.

        Raises:
            LayoutError: if `layout` is no layout.
            MujocoError: if the model has no such body, geom or flex, or a material is invalid.
        """
        self.layout = arguments.layout(layout)
        self._model = arguments.instance(model, mujoco.MjModel, "model", MujocoError)
        optics = Model.from_layout(layout) if optics is None else optics
        self._optics = arguments.instance(optics, Model, "optics", MujocoError)
        ids = [mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name) for name in fingers]
        if min(ids) < 0:
            raise MujocoError(f"fingers is {shown(fingers)}; the model has no body of such a name")
        self._receiver, self._emitter = ids
        self._materials = self._checked(materials or {})
        self._bodies = Bodies(model, (ids[0], ids[1]))
        self._places = np.stack([layout.x_mm, layout.y_mm], axis=1)
        self._low, self._high = self._places.min(axis=0), self._places.max(axis=0)
        self._seen = self._low - _NEAR_MM, self._high + _NEAR_MM
        self._twin = lru_cache(maxsize=16)(self._twin_of)

    def values(self, data: mujoco.MjData) -> Floats:
        """Values of the cells now, 0 to 255 with 255 as the empty grasp, shape `(cells,)`.

        Args:
            data: of the model, after `mj_forward` or `mj_step`.
        """
        frame = self._frame(data)
        gap_mm = 1e3 * float(frame[2, :3] @ data.xpos[self._emitter] + frame[2, 3])
        twin = self._twin(round(np.clip(gap_mm, _LEAST_GAP_MM, _MOST_GAP_MM) / _GAP_STEP_MM))
        box_mm = np.array([[*self._low - _REACH_MM, 0.0], [*self._high + _REACH_MM, gap_mm]])
        found = list(self._bodies.between(data, frame, box_mm))
        along = self._line_of(found)
        if along is None:
            return twin.values([self._thing(body, gap_mm) for body in found])
        body, height = found[0], _height(found[0], gap_mm)
        if body.radius_mm:
            table = twin.cable_table(round(2.0 * body.radius_mm, 3), height)
        else:
            table = twin.edge_table(height)
        left_mm, beside_deg = beside(along, self._places)
        return twin.calibrated(1.0 - (1.0 - self._clear(body)) * table(beside_deg, left_mm))

    @contextmanager
    def installed(self) -> Iterator[None]:
        """Let MuJoCo fill the user sensor `SENSOR` of the model in every step.

        MuJoCo has one such callback in a process: use one sensor at a time.

        Raises:
            MujocoError: if the model has no such sensor, or another callback is set.
        """
        number = mujoco.mj_name2id(self._model, mujoco.mjtObj.mjOBJ_SENSOR, SENSOR)
        if number < 0 or self._model.sensor_dim[number] != len(self.layout):
            raise MujocoError(
                f"the model has no sensor {SENSOR} of {len(self.layout)} values; `fingers(layout)` "
                "adds it"
            )
        if mujoco.get_mjcb_sensor() is not None:
            raise MujocoError("a sensor callback is set already; MuJoCo has one in a process")
        begin = int(self._model.sensor_adr[number])
        signature, cells = self._model.signature, len(self.layout)

        def fill(model: mujoco.MjModel, data: mujoco.MjData, stage: int) -> None:
            if stage == mujoco.mjtStage.mjSTAGE_POS and model.signature == signature:
                data.sensordata[begin : begin + cells] = self.values(data)

        mujoco.set_mjcb_sensor(fill)
        try:
            yield
        finally:
            mujoco.set_mjcb_sensor(None)

    def _checked(self, materials: Mapping[str, Material]) -> dict[str, Material]:
        kinds = mujoco.mjtObj.mjOBJ_GEOM, mujoco.mjtObj.mjOBJ_FLEX
        for name, material in materials.items():
            if all(mujoco.mj_name2id(self._model, kind, name) < 0 for kind in kinds):
                raise MujocoError(
                    f"materials has {shown(name)}; the model has no such geom or flex"
                )
            if len(material) != 2 or min(material) < 0.0 or not sum(material) <= 1.0:
                raise MujocoError(
                    f"materials[{name!r}] is {shown(material)}; clear and diffuse shares of light "
                    "are needed, whose sum is 1 at most"
                )
        return dict(materials)

    def _twin_of(self, gap_steps: int) -> Twin:
        return Twin(self.layout, replace(self._optics, gap_mm=gap_steps * _GAP_STEP_MM))

    def _frame(self, data: mujoco.MjData) -> Floats:
        """From the world to the receiver's sensor frame, shape `(4, 4)` (m)."""
        turn = data.xmat[self._receiver].reshape(3, 3)
        frame = np.eye(4)
        frame[:3, :3] = turn.T
        frame[:3, 3] = -turn.T @ data.xpos[self._receiver]
        return frame

    def _line_of(self, found: list[Body]) -> Floats | None:
        """The line of a single rope, or of a single edge, that crosses all that the cells see: the
        twin's tables have it, exactly. None for everything else."""
        if len(found) != 1 or self._materials.get(found[0].name, (0.0, 0.0))[1]:
            return None
        body = found[0]
        if not body.radius_mm:
            line = border(body.points_mm, *self._seen)
            smooth = line is not None and np.abs(turns(line)).max(initial=0.0) < _CORNER
            return line if smooth else None
        ends = body.points_mm[[0, -1]]
        end_seen = ((ends > self._seen[0]) & (ends < self._seen[1])).all(axis=1).any()
        return None if end_seen else body.points_mm

    def _clear(self, body: Body) -> float:
        return self._materials.get(body.name, (0.0, 0.0))[0]

    def _thing(self, body: Body, gap_mm: float) -> Thing:
        clear, diffuse = self._materials.get(body.name, (0.0, 0.0))
        known = {"clear": clear, "diffuse": diffuse, "height": _height(body, gap_mm)}
        points = body.points_mm
        if len(points) == 1:
            x, y = points[0].tolist()
            return Disc(x_mm=x, y_mm=y, diameter_mm=2.0 * body.radius_mm, **known)
        if body.radius_mm:
            return Polygon(points_mm=band(points, body.radius_mm), **known)
        line = border(points, *self._seen)
        return Polygon(points_mm=points, **known) if line is None else _corner(line, points, known)


def _corner(line: Floats, points: Floats, known: dict[str, float]) -> Thing:
    """An outline of which the cells see one straight corner, or the whole outline."""
    if len(line) != 3:
        return Polygon(points_mm=points, **known)
    opening = np.pi + float(turns(line)[0])
    x, y = line[1].tolist()
    along, up = line[2] - line[1]
    angle = np.arctan2(up, along) - opening / 2.0
    return Corner(
        x_mm=x, y_mm=y, angle_deg=float(np.degrees(angle)), opening_deg=np.degrees(opening), **known
    )


def _height(body: Body, gap_mm: float) -> float:
    share = body.z_mm / max(gap_mm, _LEAST_GAP_MM)
    return round(min(max(share, 0.0), 1.0) * _HEIGHTS) / _HEIGHTS
