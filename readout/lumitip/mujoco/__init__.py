"""The light of a fingertip pair in MuJoCo: rigid bodies, ropes and cloth between the fingers.

spec = fingers(layout, "outputs/robot/lumitip.urdf")         # or without a file: two plates
spec.worldbody.add_body(...)                                  # what is grasped
model = spec.compile()
sensor = LightSensor(model, layout)
open_fingers(model, data, 6.0)
values = sensor.values(data)                                  # or `with sensor.installed():`
"""

from lumitip.errors import MissingExtra

try:
    from lumitip.mujoco.model import ACTUATOR, FINGERS, SENSOR, MujocoError, fingers, open_fingers
    from lumitip.mujoco.sensor import LightSensor
except ModuleNotFoundError as error:
    if error.name != "mujoco":
        raise
    raise MissingExtra("mujoco", "the sensor in MuJoCo") from error

__all__ = [
    "ACTUATOR",
    "FINGERS",
    "SENSOR",
    "LightSensor",
    "MujocoError",
    "fingers",
    "open_fingers",
]
