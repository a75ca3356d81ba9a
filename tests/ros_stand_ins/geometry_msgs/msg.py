"""Stands in for `geometry_msgs.msg`, with the types that ROS insists on."""

from typing import ClassVar


class _Typed:
    _kinds: ClassVar[dict[str, type]] = {}

    def __init__(self):
        for name, kind in self._kinds.items():
            object.__setattr__(self, name, kind())

    def __setattr__(self, name, value):
        assert type(value) is self._kinds[name], (name, value)
        object.__setattr__(self, name, value)


class _Stamp(_Typed):
    _kinds: ClassVar[dict[str, type]] = {"sec": int, "nanosec": int}


class _Header(_Typed):
    _kinds: ClassVar[dict[str, type]] = {"frame_id": str, "stamp": _Stamp}


class _Point(_Typed):
    _kinds: ClassVar[dict[str, type]] = {"x": float, "y": float, "z": float}


class PointStamped(_Typed):
    """A point with its frame and time."""

    _kinds: ClassVar[dict[str, type]] = {"header": _Header, "point": _Point}

    def __repr__(self):
        assert 0 <= self.header.stamp.nanosec < 1_000_000_000
        return f"point in {self.header.frame_id} at {self.point.x:.5f} {self.point.y:.5f}"
