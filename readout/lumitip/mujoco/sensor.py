"""`LightSensor`: values of the cells from the state of a MuJoCo model."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager

import mujoco
import numpy as np

from lumitip import arguments
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.mujoco.bodies import Bodies, Body
from lumitip.mujoco.materials import Material, Materials
from lumitip.mujoco.model import FINGERS, SENSOR, MujocoError
from lumitip.mujoco.objects import REACH_MM, View
from lumitip.mujoco.twins import Twins, height_in, nearest_height
from lumitip.twin import Model, Twin
from lumitip.values import shown

_CROSSED_MM = 1.0  # that skins may press into each other
_FACING = -0.5  # cosine between the two z axes


class LightSensor:
    """The light of a fingertip pair, by its optical twin."""

    def __init__(
        self,
        model: mujoco.MjModel,
        layout: Layout,
        optics: Model | None = None,
        materials: Mapping[str, Material] | None = None,
        fingers: tuple[str, str] = FINGERS,
        sensor: str = SENSOR,
    ) -> None:
        """A sensor of a model.

        Args:
            model: with both fingers.
            layout: the cells.
            optics: of the twin, by default those of the layout; the gap is that of the fingers.
            materials: clear and diffuse transmittance, by the name of a geom, of its body, or of a
                flex; what is not named is opaque.
            fingers: names of the bodies of receiver and emitter, whose frames are the sensor
                frames.
            sensor: name of the user sensor that `installed` fills.

        Raises:
            LayoutError: if `layout` is no layout.
            MujocoError: if the model has no such body, geom or flex, or a material is invalid.
        """
        self.layout = arguments.layout(layout)
        self._model = arguments.instance(model, mujoco.MjModel, "model", MujocoError)
        optics = Model.from_layout(layout) if optics is None else optics
        self._twins = Twins(layout, arguments.instance(optics, Model, "optics", MujocoError))
        self._receiver, self._emitter = _bodies(model, fingers)
        self._sensor = arguments.instance(sensor, str, "sensor", MujocoError)
        of_objects = Materials(model, materials)
        self._bodies = Bodies(model, (self._receiver, self._emitter), of_objects)
        self._view = View(layout)

    def values(self, data: mujoco.MjData) -> Floats:
        """Values of the cells now, 0 to 255 with 255 as the empty grasp, shape `(cells,)`.

        Args:
            data: of the model, after `mj_forward` or `mj_step`.

        Raises:
            MujocoError: if it is of another model, or the fingers do not face each other.
        """
        arguments.instance(data, mujoco.MjData, "data", MujocoError)
        if data.model._address != self._model._address:
            raise MujocoError("data is of another model; the sensor's own is needed")
        frame, gap_mm = self._gap(data)
        low, high = self._view.low - REACH_MM, self._view.high + REACH_MM
        box_mm = np.array([[*low, 0.0], [*high, max(gap_mm, 1e-3)]])
        found = list(self._bodies.between(data, frame, box_mm))
        if not found:
            return np.full(len(self.layout), 255.0)
        return (
            self._of_one(found[0], gap_mm) if len(found) == 1 else self._of_several(found, gap_mm)
        )

    @contextmanager
    def installed(self) -> Iterator[None]:
        """Let MuJoCo fill the user sensor of the model in every step.

        A callback that is set already, as that of another `LightSensor`, is called too.

        Raises:
            MujocoError: if the model has no such sensor.
        """
        number = mujoco.mj_name2id(self._model, mujoco.mjtObj.mjOBJ_SENSOR, self._sensor)
        if number < 0 or self._model.sensor_dim[number] != len(self.layout):
            raise MujocoError(
                f"the model has no sensor {shown(self._sensor)} of {len(self.layout)} values; "
                "`fingers(layout)` adds it"
            )
        begin, cells = int(self._model.sensor_adr[number]), len(self.layout)
        before = mujoco.get_mjcb_sensor()

        def fill(model: mujoco.MjModel, data: mujoco.MjData, stage: int) -> None:
            if before is not None:
                before(model, data, stage)
            ours = model._address == self._model._address
            if ours and stage == mujoco.mjtStage.mjSTAGE_POS:
                data.sensordata[begin : begin + cells] = self.values(data)

        mujoco.set_mjcb_sensor(fill)
        try:
            yield
        finally:
            mujoco.set_mjcb_sensor(before)

    def _of_one(self, body: Body, gap_mm: float) -> Floats:
        """Values of a single object: by the twin's tables where it is one line, else on a raster.
        Both know it at any height."""
        line = self._view.line(body)
        if line is None:
            return self._twins.values(
                gap_mm, body.z_mm, lambda twin, height: twin.values(self._view.thing(body, height))
            )
        left_mm, beside_deg = line

        def read(twin: Twin, height: float) -> Floats:
            if body.form == "line":
                table = twin.cable_table(round(2.0 * body.radius_mm, 3), height)
            else:
                table = twin.edge_table(height)
            clear = body.material[0]
            return twin.calibrated(1.0 - (1.0 - clear) * table(beside_deg, left_mm))

        return self._twins.values(gap_mm, body.z_mm, read)

    def _of_several(self, found: list[Body], gap_mm: float) -> Floats:
        """Values of several objects, each at the nearest height that is computed."""
        total = np.zeros(len(self.layout))
        for twin, share in self._twins.around(gap_mm):
            heights = [nearest_height(twin, height_in(gap_mm, body.z_mm)) for body in found]
            total += share * twin.values([*map(self._view.thing, found, heights)])
        return total

    def _gap(self, data: mujoco.MjData) -> tuple[Floats, float]:
        """From the world to the receiver's sensor frame, shape `(4, 4)` (m), and the gap (mm)."""
        turn = data.xmat[self._receiver].reshape(3, 3)
        other = data.xmat[self._emitter].reshape(3, 3)
        place_m = data.xpos[[self._receiver, self._emitter]]
        if not (np.isfinite(turn).all() and np.isfinite(data.qpos).all()):
            raise MujocoError("data has positions that are not finite: the simulation is unstable")
        gap_mm = 1e3 * float(turn[:, 2] @ (place_m[1] - place_m[0]))
        if not turn[:, 2] @ other[:, 2] < _FACING or gap_mm < -_CROSSED_MM:
            raise MujocoError(
                f"the fingers do not face: the emitter is {gap_mm:.1f} mm in front of "
                "the receiver. The z axes of both bodies point out of the skins, towards each "
                "other; `mj_forward` must have been called."
            )
        frame = np.eye(4)
        frame[:3, :3] = turn.T
        frame[:3, 3] = -turn.T @ place_m[0]
        return frame, gap_mm


def _bodies(model: mujoco.MjModel, fingers: tuple[str, str]) -> tuple[int, int]:
    if not isinstance(fingers, tuple) or len(fingers) != 2:
        raise MujocoError(f"fingers is {shown(fingers)}; names of receiver and emitter are needed")
    ids = [
        mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name) if isinstance(name, str) else -1
        for name in fingers
    ]
    # 0 is the world.
    missing = [name for name, number in zip(fingers, ids, strict=True) if number < 1]
    if missing or ids[0] == ids[1]:
        raise MujocoError(
            f"fingers is {shown(fingers)}; two bodies of the model are needed, and "
            f"{', '.join(map(shown, missing)) or 'both names'} is none"
        )
    return ids[0], ids[1]
