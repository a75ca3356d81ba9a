"""`Copies`: geoms that MuJoCo draws in place of those that collide."""

import mujoco

from lumitip.mujoco.materials import Materials
from lumitip.mujoco.model import MujocoError
from lumitip.values import shown


class Copies:
    """Geoms without contacts, whose body has others that collide."""

    def __init__(self, model: mujoco.MjModel, geoms: list[int], materials: Materials) -> None:
        """Find them.

        Args:
            model: with the geoms.
            geoms: those that can shade.
            materials: of all.

        Raises:
            MujocoError: if a material names one of them.
        """
        self._materials = materials
        paired = {*model.pair_geom1.tolist(), *model.pair_geom2.tolist()}
        collide: dict[int, list[int]] = {}
        free = []
        for geom in geoms:
            if geom in paired or model.geom_contype[geom] or model.geom_conaffinity[geom]:
                collide.setdefault(int(model.geom_bodyid[geom]), []).append(geom)
            else:
                free.append(geom)
        self._colliding: dict[int, list[int]] = {}
        for geom in free:
            body = int(model.geom_bodyid[geom])
            # What is fixed to the world is many objects.
            if body and body in collide:
                self._colliding[geom] = collide[body]
                self._require_unnamed(model, geom)

    def only_looked_at(self, geom: int) -> bool:
        """Whether a geom is drawn only: its body has a visible geom that collides."""
        return any(map(self._materials.visible, self._colliding.get(geom, ())))

    def _require_unnamed(self, model: mujoco.MjModel, geom: int) -> None:
        name = self._materials.own_name(geom)
        if name and self.only_looked_at(geom):
            body = model.body(int(model.geom_bodyid[geom])).name
            raise MujocoError(
                f"materials has {shown(name)}, a geom without contacts beside geoms that collide; "
                f"only those shade. Name one of them or their body {shown(body)}, or give the "
                "geom a body of its own"
            )
