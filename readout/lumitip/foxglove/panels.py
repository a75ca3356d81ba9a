"""`panels`: a layout of Foxglove for the topics of `write_scene`, to import in the app."""

import json
from collections.abc import Sequence
from typing import Any

ROOT = "lumitip"
"""Frame in which the fingertips stand beside each other."""
_DRAWN = ("light", "cells", "published", "estimated")
_SERIES = (
    ("offset (mm)", "estimate.offset_mm"),
    ("angle (deg)", "estimate.angle_deg"),
    ("angle, published (deg)", "contact.angle_deg"),
)


def panels(names: Sequence[str]) -> str:
    """The text of a layout file: the fingertips in 3D, and a plot and the contact of each.

    Args:
        names: of the fingertips, as in `write_scene`.
    """
    configs: dict[str, Any] = {"3D!scene": _scene(names)}
    columns: list[Any] = []
    for name in names:
        plot, table = f"Plot!{name}", f"RawMessages!{name}"
        configs[plot] = _plot(name)
        configs[table] = {"topicPath": f"/{name}/contact", "diffEnabled": False}
        columns.append(_split("column", plot, table, 65))
    beside: Any = columns[0]
    for count, column in enumerate(columns[1:], 1):
        beside = _split("row", beside, column, 100 * count / (count + 1))
    layout = {
        "configById": configs,
        "globalVariables": {},
        "userNodes": {},
        "playbackConfig": {"speed": 1},
        "layout": _split("column", "3D!scene", beside, 60),
    }
    return json.dumps(layout, indent=2, sort_keys=True) + "\n"


def _split(direction: str, first: Any, second: Any, percent: float) -> dict[str, Any]:
    return {
        "direction": direction,
        "first": first,
        "second": second,
        "splitPercentage": percent,
    }


def _scene(names: Sequence[str]) -> dict[str, Any]:
    """Seen from above, the tip up; the grid is hidden, for the cells show the same."""
    topics = {
        f"/{name}/{topic}": {"visible": topic != "light"} for name in names for topic in _DRAWN
    }
    return {
        "followTf": ROOT,
        "followMode": "follow-none",
        "cameraState": {
            "perspective": False,
            "distance": 0.12 * max(len(names), 1),
            "phi": 0.0,
            "thetaOffset": 0.0,
            "targetOffset": [0.0, 0.0, 0.0],
            "target": [0.0, 0.0, 0.0],
            "targetOrientation": [0.0, 0.0, 0.0, 1.0],
            "fovy": 45.0,
            "near": 0.001,
            "far": 100.0,
        },
        "scene": {},
        "transforms": {},
        "topics": topics,
        "layers": {},
    }


def _plot(name: str) -> dict[str, Any]:
    paths = [
        {
            "value": f"/{name}/{path}",
            "label": label,
            "enabled": True,
            "timestampMethod": "receiveTime",
        }
        for label, path in _SERIES
    ]
    return {
        "title": name,
        "paths": paths,
        "showXAxisLabels": True,
        "showYAxisLabels": True,
        "showLegend": True,
        "legendDisplay": "floating",
        "isSynced": True,
        "xAxisVal": "timestamp",
    }
