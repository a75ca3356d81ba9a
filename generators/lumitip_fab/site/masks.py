"""Masks at 1:1, and the grid of cells as the view shows it."""

import math
import re
from collections.abc import Sequence
from html import escape

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.design import Finger
from lumitip_fab.design.frames import Matrix
from lumitip_fab.site.folder import Folder

_BLACK = re.compile(r'<path id="black" fill-rule="evenodd" d="([^"]+)"')
_OTHER = re.compile(r'<path (?!id="black")[^>]*d="([^"]+)"')
_SIZE = re.compile(r'width="([\d.]+)mm" height="([\d.]+)mm"')
_NUMBER = re.compile(r"-?[\d.]+")
_NEAR_MM = 0.1  # from the middle of an aperture to its cell


def mask_svg(folder: Folder, finger: Finger) -> str:
    """The mask of a finger at 1:1, each aperture with its cell.

    Raises:
        OutputError: if the file has no aperture for a cell, or is no such drawing.
    """
    file = f"mask/{finger.name}_mask.svg"
    text = folder.text(file)
    black, size = _BLACK.search(text), _SIZE.search(text)
    if black is None or size is None:
        raise folder.damaged(file, "no black area, or no size")
    runs = [f"M{run}" for run in black[1].split("M") if run]
    try:
        middles = np.array([_middle(run) for run in runs])
    except ValueError as error:
        raise folder.damaged(file, error) from error
    to_file = np.linalg.inv(np.array(folder.entry(file).to_sensor))
    width, height = size[1], size[2]
    holes = []
    for cell, place in enumerate(finger.cells):
        away = np.hypot(*(middles - _on_page(to_file, place)).T)
        nearest = int(away.argmin())
        if away[nearest] > _NEAR_MM:
            raise folder.damaged(file, f"cell {cell} has no aperture")
        holes.append(
            f'<g class="hole cell" data-cell="{cell}" aria-label="Cell {cell}: hole of the '
            f'{finger.name} mask"><path d="{runs[nearest]}"/></g>'
        )
    cuts = "".join(f'<path class="cut" d="{d}"/>' for d in _OTHER.findall(text))
    return (
        f'<svg class="mask" style="width:{width}mm" viewBox="0 0 {width} {height}" role="group" '
        f'aria-label="{escape(finger.name.capitalize())} mask at 1:1, inside of the film">'
        f'<path class="black" d="{black[1]}"/>{cuts}{"".join(holes)}</svg>'
    )


def _on_page(to_file: Matrix, place: tuple[float, float]) -> NDArray[np.float64]:
    return np.asarray((to_file @ (*place, 0.0, 1.0))[:2])


def _middle(run: str) -> tuple[float, float]:
    """Middle of the corners of a run."""
    points = np.array(_NUMBER.findall(run), dtype=float).reshape(-1, 2)
    if not len(points):
        raise ValueError(f"{run:.40} has no corners")
    x, y = np.unique(points, axis=0).mean(axis=0)
    return float(x), float(y)


def grid_svg(x_mm: Sequence[float], y_mm: Sequence[float], pitch_mm: float) -> str:
    """The cells as hexagons in the receiver's sensor frame, as the view shows them."""
    radius = pitch_mm / math.sqrt(3)
    corners = [(radius * math.cos(a), radius * math.sin(a)) for a in np.radians(range(0, 360, 60))]
    cells = []
    for cell, (x, y) in enumerate(zip(x_mm, y_mm, strict=True)):
        points = " ".join(f"{x + dx:.2f},{dy - y:.2f}" for dx, dy in corners)
        cells.append(
            f'<g class="pixel cell" data-cell="{cell}" aria-label="Cell {cell}: value {cell} of a '
            f'frame"><polygon points="{points}"/><text x="{x:.2f}" y="{-0.5 - y:.2f}">{cell}</text>'
            f'<text class="value" x="{x:.2f}" y="{1.2 - y:.2f}"></text></g>'
        )
    margin = radius + 3
    left, top = min(x_mm) - margin, -max(y_mm) - margin
    wide, high = max(x_mm) + margin - left, -min(y_mm) + margin - top
    return (
        f'<svg class="grid" id="grid" viewBox="{left:.2f} {top:.2f} {wide:.2f} {high:.2f}" '
        'role="group" aria-label="Cells as the view shows them, tip up">'
        f'<g>{"".join(cells)}</g><g id="scene"></g><polygon id="ring"/></svg>'
    )
