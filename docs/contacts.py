"""Draw what the processing tells of the three published frames: `make pictures`, then look at it.

They are real: read from the publication's figures of a cloth edge, a cloth corner and a cable.
"""

import json
import math
from importlib.resources import files
from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import RegularPolygon
from numpy.typing import NDArray

from lumitip import Layout
from lumitip.processing import Contact, Processor

HERE = Path(__file__).parent
REAL_FRAMES = HERE.parent / "tests" / "readout" / "published_frames.json"
TITLES = {
    "cloth_edge": "a real cloth edge",
    "cloth_corner": "a real cloth corner",
    "cable": "a real cable",
}
RED, BLUE, GREEN = "#d55e00", "#0072b2", "#009e73"  # distinct for colour-blind people too


def main() -> None:
    """Draw the picture."""
    layout = Layout.load(str(files("lumitip.links") / "published_layout.json"))
    frames = json.loads(REAL_FRAMES.read_text(encoding="utf-8"))["frames"]
    figure, axes = plt.subplots(1, 3, figsize=(12.6, 3.9), dpi=100)
    for axis, (name, title) in zip(axes, TITLES.items(), strict=True):
        values = np.concatenate(frames[name]["columns"]).astype(np.float64)
        _draw(axis, layout, values, Processor(layout)(values), title)
    figure.tight_layout()
    figure.savefig(HERE / "images" / "contacts.png", metadata={"Software": None})


def _draw(
    axis: Axes, layout: Layout, values: NDArray[np.float64], contact: Contact, name: str
) -> None:
    for x, y, value in zip(layout.x_mm, layout.y_mm, values, strict=True):
        grey = str(value / 255.0)
        axis.add_patch(
            RegularPolygon(
                (x, y), 6, radius=3.2, orientation=math.pi / 6, facecolor=grey, edgecolor="#999"
            )
        )
        ink = "white" if value < 120 else "black"
        axis.text(x, y, f"{value:.0f}", ha="center", va="center", fontsize=7, color=ink)
    assert contact.markers_mm is not None and contact.centre_mm is not None
    axis.plot(*contact.markers_mm.T, "o", color=RED, markersize=4)
    axis.plot(*contact.centre_mm, "X", color=RED, markersize=9, markeredgecolor="white")
    axis.set_title(f"{name}: {_told(axis, contact)}", fontsize=10)
    axis.set(xlim=(-20, 20), ylim=(-16.5, 16.5), aspect="equal", xlabel="mm")
    axis.tick_params(labelsize=8)


def _told(axis: Axes, contact: Contact) -> str:
    """Draw the fit that gives the shape its name; returns its figures."""
    if contact.shape == "cable" and contact.cable:
        cable = contact.cable
        along = _direction(cable.angle_deg)
        half = np.array((-along[1], along[0])) * cable.width_mm / 2.0
        for aside, style in ((0.0, "-"), (1.0, "--"), (-1.0, "--")):
            _line(axis, np.array(cable.axis_point_mm) + aside * half, along, BLUE, style)
        return f"{cable.angle_deg:.1f}°, {cable.width_mm:.1f} mm wide"
    if contact.shape == "corner" and contact.corner:
        vertex = np.array(contact.corner.vertex_mm)
        for angle_deg in contact.corner.directions_deg:
            end = vertex + 18.0 * _direction(angle_deg)
            axis.plot(*np.stack((vertex, end), axis=1), color=GREEN, linewidth=2)
        return f"opens {contact.corner.opening_deg:.0f}°"
    assert contact.line is not None
    point, along = np.array(contact.line.point_mm), _direction(contact.line.angle_deg)
    _line(axis, point, along, BLUE, "-")
    return f"{contact.line.angle_deg:.1f}°"


def _line(
    axis: Axes, point: NDArray[np.float64], along: NDArray[np.float64], colour: str, style: str
) -> None:
    ends = np.stack((point - 19.0 * along, point + 19.0 * along), axis=1)
    axis.plot(*ends, style, color=colour, linewidth=2)


def _direction(angle_deg: float) -> NDArray[np.float64]:
    return np.array((math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))))


if __name__ == "__main__":
    main()
