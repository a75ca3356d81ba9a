"""Draw the figures of docs/twin.md from the twin itself: `make pictures`, then look at them."""

import json
import math
import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.collections import PatchCollection
from matplotlib.patches import RegularPolygon
from numpy.typing import NDArray

from lumitip import Layout
from lumitip.links.twin import published_layout
from lumitip.twin import Cable, Corner, HalfPlane, Model, Sheet, Twin
from lumitip.twin.fit import fit_edge
from lumitip.twin.materials import MATERIALS, MEASURED_GAP_MM

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "benchmarks"))

from bench_real_misfit import KEPT_SD  # noqa: E402
from real_fit import NAMES, RealFit, Shared  # noqa: E402
from real_frames import real_frame as frame_of  # noqa: E402
from real_terms import MADE, PLAIN, RealTwin  # noqa: E402

IMAGES = ROOT / "docs/images"
REAL_FRAMES = ROOT / "tests/readout/published_frames.json"
WIDTHS_MM = {2.0: 1.3, 3.0: 1.9, 6.0: 4.5}
MEASURED, COMPUTED = "#c2571a", "#2a5d84"
Values = NDArray[np.float64]


def main() -> None:
    """Draw all of them."""
    mpl.rcParams |= {
        "font.size": 9,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "svg.hashsalt": "lumitip",
    }
    layout = published_layout()
    materials(layout)
    edges(layout)
    real_frame(layout)
    real_frames(layout)
    scenes(layout)


def materials(layout: Layout) -> None:
    """Published mean of each material, and the twin's after its calibration."""
    twin = Twin(layout, Model.from_layout(layout, MEASURED_GAP_MM))
    figure, axes = plt.subplots(figsize=(6.4, 3.0), layout="constrained")
    for i, material in enumerate(MATERIALS):
        values = twin.values(material.sheet())
        axes.errorbar(
            i - 0.12,
            material.published_mean,
            material.published_bar,
            fmt="o",
            color=MEASURED,
            capsize=4,
            label=None if i else "published, hardware",
        )
        axes.errorbar(
            i + 0.12,
            values.mean(),
            values.std(),
            fmt="s",
            color=COMPUTED,
            capsize=4,
            label=None if i else "twin, one transmittance fitted to each",
        )
    axes.set_xticks(range(len(MATERIALS)), [m.name.replace(", ", ",\n") for m in MATERIALS])
    axes.set_ylim(0, 255)
    axes.set_ylabel("mean value of all cells")
    axes.set_title(f"Materials at a gap of {MEASURED_GAP_MM:g} mm: a calibration, no validation")
    axes.legend(frameon=False, loc="upper left")
    save(figure, "twin_materials.png")


def edges(layout: Layout) -> None:
    """Values of a middle cell as an edge passes, at three gaps."""
    figure, axes = plt.subplots(figsize=(6.4, 3.0), layout="constrained")
    way = np.linspace(-6.0, 6.0, 481)
    middle = int(np.hypot(layout.x_mm, layout.y_mm - 3.0).argmin())
    for shade, gap_mm in zip(("#123", COMPUTED, "#7fb2d6"), WIDTHS_MM, strict=True):
        twin = Twin(layout, Model.from_layout(layout, gap_mm))
        values = twin.edges(layout.y_mm[middle] - way, 0.0)[:, middle]
        axes.plot(way, values, color=shade, label=f"gap {gap_mm:g} mm")
    for share in (0.1, 0.9):
        axes.axhline(255 * share, color="0.8", lw=0.8, zorder=0)
    axes.set_xlabel("distance of the cell's centre from the edge (mm)")
    axes.set_ylabel("value")
    axes.set_ylim(0, 258)
    axes.set_title("A cloth edge passes over a cell")
    axes.legend(frameon=False)
    save(figure, "twin_edges.png")


def real_frame(layout: Layout) -> None:
    """The published cloth edge, the twin fitted to it, and what remains."""
    frames = json.loads(REAL_FRAMES.read_text(encoding="utf-8"))["frames"]
    real = np.concatenate(frames["cloth_edge"]["columns"]).astype(np.float64)
    fitted = fit_edge(layout, real, 0.0, 184.0)
    figure, parts = plt.subplots(1, 3, figsize=(8.4, 2.5), layout="constrained")
    hexagons(parts[0], layout, real, "published frame (hardware)")
    hexagons(parts[1], layout, fitted.values, f"twin, {len(fitted.numbers)} numbers fitted")
    left = fitted.values - real
    hexagons(parts[2], layout, left, f"difference, {fitted.rms:.1f} counts rms", "PuOr", (-40, 40))
    save(figure, "twin_real_frame.png")
    print({name: round(value, 4) for name, value in fitted.numbers.items()}, round(fitted.rms, 2))


def real_frames(layout: Layout) -> None:
    """The three published frames, the twin with hem, bend and gains learned from the two other
    frames, and what remains."""
    fit = RealFit(RealTwin(layout))
    starts = {name: PLAIN[name] | MADE.get(name, {}) for name in NAMES}
    own = {name: fit.alone(name, starts[name], fit.nothing).own[name] for name in NAMES}
    found = fit.held_out(own, {}, KEPT_SD)
    figure, rows = plt.subplots(3, 3, figsize=(8.4, 7.2), layout="constrained")
    for axes, name in zip(rows, NAMES, strict=True):
        shared = Shared({}, found[name][1].gains)
        numbers = fit.alone(name, own[name], shared).own[name]
        fitted = fit.values(name, numbers, shared)
        real = frame_of(name)
        title = name.replace("_", " ")
        many = f"twin, {len(numbers)} numbers and gains"
        left = fitted - real
        counts = f"difference, {math.sqrt(np.mean(left**2)):.1f} counts rms"
        hexagons(axes[0], layout, real, f"{title} (hardware)")
        hexagons(axes[1], layout, fitted, many)
        hexagons(axes[2], layout, left, counts, "PuOr", (-40, 40))
    save(figure, "twin_real_frames.png")


def scenes(layout: Layout) -> None:
    """Objects, and what the fingertip reads of them."""
    twin = Twin(layout)
    shown = {
        "edge of cloth": HalfPlane(0.0, 200.0, clear=0.05),
        "corner with hem": Corner(2.0, 3.0, 200.0, 90.0, clear=0.3, hem_mm=4.0),
        "curved cable, 4 mm": Cable(0.0, 65.0, 0.025, diameter_mm=4.0),
        "cable on paper": [Sheet(diffuse=0.41, height=0.3), Cable(2.0, 20.0, diameter_mm=4.0)],
    }
    figure, parts = plt.subplots(1, 4, figsize=(9.6, 2.2), layout="constrained")
    for axes, (name, scene) in zip(parts, shown.items(), strict=True):
        hexagons(axes, layout, twin.values(scene), name)
    save(figure, "twin_scenes.png")


def hexagons(
    axes: Axes,
    layout: Layout,
    values: Values,
    title: str,
    colours: str = "cividis",
    limits: tuple[float, float] = (0, 255),
) -> None:
    """Cells as hexagons whose flats face the tip, each with its value."""
    radius = layout.pitch_mm / math.sqrt(3.0) * 0.97
    cells = [
        RegularPolygon((x, y), 6, radius=radius, orientation=math.pi / 6)
        for x, y in zip(layout.x_mm, layout.y_mm, strict=True)
    ]
    drawn = PatchCollection(cells, cmap=colours, edgecolor="none")
    drawn.set_array(values)
    drawn.set_clim(*limits)
    axes.add_collection(drawn)
    low, high = limits
    for x, y, value in zip(layout.x_mm, layout.y_mm, values, strict=True):
        red, green, blue, _ = plt.get_cmap(colours)((value - low) / (high - low))
        bright = 0.3 * red + 0.6 * green + 0.1 * blue > 0.5
        axes.text(
            x,
            y,
            f"{round(value)}",
            ha="center",
            va="center",
            fontsize=6.5,
            color="black" if bright else "white",
        )
    axes.set_xlim(-20, 20)
    axes.set_ylim(-15.5, 15.5)
    axes.set_aspect("equal")
    axes.axis("off")
    axes.set_title(title, fontsize=9)


def save(figure: plt.Figure, name: str) -> None:
    """Write a figure without a date, so that the same figure is the same file."""
    IMAGES.mkdir(exist_ok=True)
    figure.savefig(IMAGES / name, dpi=130, metadata={"Software": None})
    plt.close(figure)


if __name__ == "__main__":
    main()
