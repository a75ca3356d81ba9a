"""Draw the README's animation: a cable that moves over the twin's cells, and its estimate.

Needs the extra `[fab]`, for its drawing library. The same code writes the same bytes:

    python docs/cable_animation.py [FILE]
"""

import math
import sys
from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import RegularPolygon
from numpy.typing import NDArray
from PIL import Image

from lumitip import Layout
from lumitip.estimation import Estimate, PoseEstimator
from lumitip.links.twin import published_layout
from lumitip.twin import Cable, Model, Twin

ANIMATION = Path(__file__).parent / "images" / "cable.webp"
FRAMES, FRAME_MS, QUALITY = 48, 100, 50
DIAMETER_MM, SEED = 3.0, 1
# The finger differs from what the estimator expects, as a real one would.
GAP_MM, GAINS_SD, NOISE_COUNTS = 3.3, 0.06, 1.5
HALF_WIDTH_MM, HALF_HEIGHT_MM = 20.0, 16.0
SIZE_IN, DPI = (4.8, 4.5), 90
CABLE, ESTIMATE = "#1a1a1a", "#d81b8c"
Values = NDArray[np.float64]


def main(file: Path) -> None:
    """Write the animation, which repeats without a jump."""
    layout = published_layout()
    random = np.random.default_rng(SEED)
    gains = 1.0 + GAINS_SD * random.standard_normal(len(layout))
    twin = Twin(layout, Model.from_layout(layout, GAP_MM), gains=gains)
    estimator = PoseEstimator(layout, tracking=True).prepare("cable")
    pictures = []
    for number in range(FRAMES):
        cable = cable_at(2.0 * math.pi * number / FRAMES)
        noise = random.normal(0.0, NOISE_COUNTS, len(layout))
        values = np.clip(np.round(twin.values(cable) + noise), 0.0, 255.0)
        pictures.append(_picture(layout, cable, values, estimator(values, "cable")))
    pictures[0].save(
        file,
        save_all=True,
        append_images=pictures[1:],
        duration=FRAME_MS,
        loop=0,
        quality=QUALITY,
        method=6,
    )


def cable_at(phase: float) -> Cable:
    """The cable at a phase of its motion (radians)."""
    offset_mm, angle_deg = 6.0 * math.sin(phase), 18.0 * math.sin(2.0 * phase + 0.6)
    return Cable(offset_mm, angle_deg, diameter_mm=DIAMETER_MM)


def _picture(layout: Layout, cable: Cable, values: Values, estimate: Estimate) -> Image.Image:
    figure = plt.figure(figsize=SIZE_IN, dpi=DPI)
    axes = figure.add_axes((0.0, 0.1, 1.0, 0.85))
    axes.set(xlim=(-HALF_WIDTH_MM, HALF_WIDTH_MM), ylim=(-HALF_HEIGHT_MM, HALF_HEIGHT_MM))
    axes.set_aspect("equal")
    axes.axis("off")
    _cells(axes, layout, values)
    for aside_mm in (-DIAMETER_MM / 2.0, DIAMETER_MM / 2.0):
        _line(axes, cable.offset_mm + aside_mm, cable.angle_deg, "white", 3.0)
        _line(axes, cable.offset_mm + aside_mm, cable.angle_deg, CABLE, 1.4)
    _line(axes, estimate.offset_mm, estimate.angle_deg, ESTIMATE, 2.6)
    lines = (
        ("cable     ", cable.offset_mm, cable.angle_deg, CABLE),
        ("estimate", estimate.offset_mm, estimate.angle_deg, ESTIMATE),
    )
    for row, (name, offset_mm, angle_deg, colour) in enumerate(lines):
        height = 0.075 - 0.05 * row
        figure.text(0.24, height, name, color=colour, fontsize=11)
        figure.text(0.58, height, f"{offset_mm:+.2f} mm", color=colour, fontsize=11, ha="right")
        figure.text(0.76, height, f"{angle_deg:+.1f}°", color=colour, fontsize=11, ha="right")
    figure.canvas.draw()
    drawn = Image.fromarray(np.asarray(figure.canvas.buffer_rgba())).convert("RGB")
    plt.close(figure)
    return drawn


def _cells(axes: Axes, layout: Layout, values: Values) -> None:
    """Cells as hexagons whose flats face the tip, each with its value."""
    radius_mm = layout.pitch_mm / math.sqrt(3.0) * 0.96
    colours = plt.get_cmap("cividis")
    for x, y, value in zip(layout.x_mm, layout.y_mm, values, strict=True):
        face = colours(value / 255.0)
        axes.add_patch(
            RegularPolygon((x, y), 6, radius=radius_mm, orientation=math.pi / 6, facecolor=face)
        )
        ink = "black" if value > 128 else "white"
        axes.text(x, y, f"{value:.0f}", color=ink, ha="center", va="center", fontsize=8)


def _line(axes: Axes, offset_mm: float, angle_deg: float, colour: str, width: float) -> None:
    along = np.array((math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))))
    nearest = offset_mm * np.array((-along[1], along[0]))
    ends = np.stack((nearest - 19.5 * along, nearest + 19.5 * along), axis=1)
    axes.plot(*ends, color=colour, linewidth=width, solid_capstyle="butt")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else ANIMATION)
