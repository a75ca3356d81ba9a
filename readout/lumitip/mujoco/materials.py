"""`Materials`: transmittance of the geoms and flexes of a MuJoCo model."""

from collections.abc import Mapping

import mujoco

from lumitip import arguments
from lumitip.mujoco.model import MujocoError
from lumitip.values import shown

Material = tuple[float, float]
"""Clear and diffuse transmittance, as of the twin's objects."""
OPAQUE: Material = (0.0, 0.0)
_GEOM, _FLEX, _BODY = mujoco.mjtObj.mjOBJ_GEOM, mujoco.mjtObj.mjOBJ_FLEX, mujoco.mjtObj.mjOBJ_BODY


class Materials:
    """Materials by the name of a geom, of its body, or of a flex; all else is opaque."""

    def __init__(self, model: mujoco.MjModel, named: Mapping[str, Material] | None) -> None:
        """Check the names and figures.

        Raises:
            MujocoError: if a name is not in the model, or a material is invalid.
        """
        self._model = model
        if named is not None and not isinstance(named, Mapping):
            raise MujocoError(f"materials is {shown(named)}; names with two numbers are needed")
        self._named: dict[str, Material] = {
            name: _checked(model, name, material) for name, material in (named or {}).items()
        }

    def of_geom(self, geom: int) -> Material:
        """The material of a geom."""
        own = mujoco.mj_id2name(self._model, _GEOM, geom)
        body = mujoco.mj_id2name(self._model, _BODY, int(self._model.geom_bodyid[geom]))
        return self._named.get(own, self._named.get(body, OPAQUE))

    def own_name(self, geom: int) -> str | None:
        """The name of a geom, if it has a material by it."""
        name = mujoco.mj_id2name(self._model, _GEOM, geom)
        return name if name in self._named else None

    def of_flex(self, flex: int) -> Material:
        """The material of a flex."""
        return self._named.get(mujoco.mj_id2name(self._model, _FLEX, flex), OPAQUE)

    def visible(self, geom: int) -> bool:
        """Whether a geom is drawn: markers and triggers with an alpha of 0 shade nothing."""
        material = int(self._model.geom_matid[geom])
        colour = self._model.mat_rgba[material] if material >= 0 else self._model.geom_rgba[geom]
        return bool(colour[3] > 0.0)


def _checked(model: mujoco.MjModel, name: str, material: Material) -> Material:
    known = isinstance(name, str) and any(
        mujoco.mj_name2id(model, kind, name) >= 0 for kind in (_GEOM, _BODY, _FLEX)
    )
    if not known:
        raise MujocoError(f"materials has {shown(name)}; the model has no such geom, body or flex")
    shares = arguments.numbers(material, f"materials[{name!r}]", MujocoError)
    if shares.shape != (2,) or not (shares.min() >= 0.0 and shares.sum() <= 1.0):
        raise MujocoError(
            f"materials[{name!r}] is {shown(material)}; clear and diffuse shares of light are "
            "needed, whose sum is 1 at most"
        )
    return float(shares[0]), float(shares[1])
