"""The light of a fingertip pair in MuJoCo: rigid bodies, ropes and cloth between the fingers.

spec = fingers(layout, "outputs/robot/lumitip.urdf")         # or without a file: two plates
spec.worldbody.add_body(...)                                  # what is grasped
model = spec.compile()
sensor = LightSensor(model, layout)
values = sensor.values(data)                                  # or `with sensor.installed():`
"""

from lumitip.errors import MissingExtra

try:
    from lumitip.mujoco.model import SENSOR, MujocoError, fingers
    from lumitip.mujoco.sensor import LightSensor
except ModuleNotFoundError as error:
    if error.name != "mujoco":
        raise
    raise MissingExtra("mujoco", "the sensor in MuJoCo") from error

__all__ = ["SENSOR", "LightSensor", "MujocoError", "fingers"]
