"""`Ramp`: the way of an arm's velocity to a new one, within its accelerations."""

import numpy as np

from lumitip.grid import Floats
from lumitip.robots.guard import ArmLimits
from lumitip.robots.mount import Mount


class Ramp:
    """A twist that changes as a whole: its translation and its rotation arrive together.

    A fingertip turns about itself while the tool centre point goes round it. Were each part of the
    twist to change at its own pace, the fingertip would swing aside until the slower one is there.
    """

    def __init__(self, limits: ArmLimits, mount: Mount) -> None:
        """Begin at rest.

        Args:
            limits: of the acceleration of tool centre point, fingertip and rotation.
            mount: of the fingertip.
        """
        self._most = np.array(
            [limits.acceleration_mm_s2, limits.acceleration_mm_s2, limits.rotation_rad_s2]
        )
        self._mount = mount
        self.twist: Floats = np.zeros(6)
        """Of the tool centre point, in the tool frame (m/s, rad/s), shape `(6,)`."""

    def toward(self, wanted: Floats, seconds: float) -> Floats:
        """The twist after some time on the way to another one, in the tool frame; `(6,)`."""
        change = wanted - self.twist
        needed_s = self.seconds_of(change)
        self.twist = self.twist + change * (1.0 if needed_s <= seconds else seconds / needed_s)
        return self.twist

    def seconds_of(self, change: Floats) -> float:
        """Shortest time for a change of the twist in the tool frame (s)."""
        fingertip_m_s = change[:3] + np.cross(change[3:], np.array(self._mount.origin_mm) / 1000.0)
        sizes = np.linalg.norm([change[:3] * 1000.0, fingertip_m_s * 1000.0, change[3:]], axis=1)
        return float((sizes / self._most).max())
