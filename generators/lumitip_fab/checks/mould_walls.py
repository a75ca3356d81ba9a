"""The walls of a mould: how near they guide the finger, and whether they let it go."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import shapely

from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import Box, Design

GAP_MM = (0.10, 0.30)
LEAST_DRAFT_DEG = 2.0
DRAFT_MESH_DEG = 0.25  # of triangles on curved walls
_ABOVE_MM = 0.05  # stops and weir end at the rim itself
_STEP_MM = 0.5
_UPRIGHT = math.sin(math.radians(0.5))  # a facet that leans by less is an upright wall's mesh
_ON_BED_MM = 1e-3


def measured(mesh: Any, file: str, design: Design, notch: Box) -> Iterator[Measurement]:
    """Gap at the rim, draft above it, and faces that hold the finger back.

    Args:
        mesh: the mould on its bed.
        file: its name.
        design: the design.
        notch: the finger's wire notch, where the wall may be open.
    """
    mould, stack = design.mould, design.stack
    rim_mm = mould.wall_mm + stack.cover_mm
    silhouette = shapely.Polygon(design.outline.polygon() * (1, -1))  # as seen from above
    places = _along(silhouette, design, notch)
    near = _distances(mesh, rim_mm + _ABOVE_MM, places)
    yield Measurement("mould.gap", file, float(near.min()), *GAP_MM, "mm", "least at the rim")
    yield Measurement(
        "mould.gap",
        f"{file}: widest",
        float(near.max()),
        *GAP_MM,
        "mm",
        "but for the weir at the gripper end",
    )
    rise = stack.plate_mm / 2  # the wall guides at least half the plate
    far = _distances(mesh, rim_mm + _ABOVE_MM + rise, places)
    draft = float(np.degrees(np.arctan2(far - near, rise)).min())
    least = min(LEAST_DRAFT_DEG, mould.draft_deg) - DRAFT_MESH_DEG
    yield Measurement(
        "mould.draft",
        file,
        draft,
        least,
        unit="deg",
        note=f"least above the rim; designed {mould.draft_deg:g}",
    )
    yield Measurement(
        "mould.undercut",
        file,
        _undercut_mm2(mesh, silhouette, design),
        0,
        0.01,
        "mm²",
        "that hangs over, seen along the pull",
    )


def _along(silhouette: Any, design: Design, notch: Box) -> Any:
    """Points along the outline, without those before the weir."""
    edge = silhouette.exterior
    points = shapely.line_interpolate_point(edge, np.arange(0.0, edge.length, _STEP_MM))
    at = shapely.get_coordinates(points)
    at_end = np.abs(at[:, 1] + design.outline.end_y_mm) < 1e-6
    return points[~(at_end & (np.abs(at[:, 0]) < notch.x_max_mm))]


def _distances(mesh: Any, z_mm: float, places: Any) -> solids.Vectors:
    material = solids.section(mesh, z_mm)
    if material.is_empty:
        return np.full(len(places), np.inf)
    return np.asarray(shapely.distance(places, material))


def _undercut_mm2(mesh: Any, silhouette: Any, design: Design) -> float:
    """Faces that look down, from the wall's middle inward and above the bed, as they are seen
    along the pull: a facet of a curved wall may lean, but hangs over next to nothing."""
    mould = design.mould
    inner = silhouette.buffer(mould.wall_gap_mm + mould.wall_mm / 2)
    above_bed = mesh.triangles[:, :, 2].min(axis=1) > mesh.bounds[0, 2] + _ON_BED_MM
    down = (mesh.face_normals[:, 2] < -_UPRIGHT) & above_bed
    centres = mesh.triangles_center[down]
    held = shapely.contains_xy(inner, centres[:, 0], centres[:, 1])
    overhung = mesh.area_faces * -mesh.face_normals[:, 2]
    return float(overhung[down][held].sum())
