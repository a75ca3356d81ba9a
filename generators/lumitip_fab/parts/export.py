"""Shapes to the bytes of STEP, STL and 3MF files: the same shape gives the same bytes."""

import io
import re
import zipfile
from functools import partial
from itertools import count
from typing import Any
from xml.sax.saxutils import escape, quoteattr

import numpy as np
import trimesh
from build123d import Shape, export_step
from numpy.typing import ArrayLike
from OCP.BRep import BRep_Tool
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.TopAbs import TopAbs_REVERSED
from OCP.TopLoc import TopLoc_Location

from lumitip_fab.design.frames import Matrix
from lumitip_fab.parts.shapes import placed
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.pipeline.artefact import Artefact, Facts
from lumitip_fab.text import passage

_TEXTS = "parts/export.txt"

_USAGE = re.compile(r"NEXT_ASSEMBLY_USAGE_OCCURRENCE\('[^']*'([^;]*);")
_BREAK = re.compile(r"\n\s*")
_ENTITY = re.compile(r"#(\d+) = (.*?);\n", re.DOTALL)
_REFERENCE = re.compile(r"#(\d+)")
_COLOURED = "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION("
_END = "ENDSEC;\nEND-ISO-10303-21;"


def canonical(text: str) -> str:
    """The same file with uses numbered from 1 and colours in the order of their text."""
    text = _USAGE.sub(partial(_numbered, count(1)), text)
    start, end = _colours(text)
    if start < 0:
        return text
    entities = {int(n): _BREAK.sub("", entity) for n, entity in _ENTITY.findall(text[start:end])}
    return text[:start] + _ordered(entities) + text[end:]


def _numbered(numbers: "count[int]", use: re.Match[str]) -> str:
    # The number's length decides where the kernel breaks the line.
    rest = _BREAK.sub("", use[1])
    return f"NEXT_ASSEMBLY_USAGE_OCCURRENCE('{next(numbers)}'{rest};"


def _colours(text: str) -> tuple[int, int]:
    """Where the entities of colours begin and end; below zero where there are none."""
    first = text.find(_COLOURED)
    return (text.rfind("#", 0, first) if first >= 0 else -1), text.rfind(_END)


def _ordered(entities: dict[int, str]) -> str:
    """Entities sorted by what they say, equal ones once, numbered anew from their first."""
    expanded: dict[int, str] = {}

    def full(number: int) -> str:
        if number not in expanded:
            expanded[number] = _REFERENCE.sub(
                lambda m: f"<{full(int(m[1]))}>" if int(m[1]) in entities else m[0],
                _sorted_items(entities[number]),
            )
        return expanded[number]

    def _sorted_items(entity: str) -> str:
        if not entity.startswith(_COLOURED):
            return entity
        head, items, tail = re.split(r"\((?=#)|\)(?=,#)", entity, maxsplit=2)
        ordered = sorted(items.split(","), key=lambda item: full(int(item[1:])))
        return f"{head}({','.join(ordered)}){tail}"

    numbers: dict[str, int] = {}
    lines: list[tuple[int, str]] = []

    def emit(number: int) -> int:
        key = full(number)
        if key not in numbers:
            numbers[key] = min(entities) + len(numbers)
            mine = numbers[key]
            line = _REFERENCE.sub(
                lambda m: f"#{emit(int(m[1]))}" if int(m[1]) in entities else m[0],
                _sorted_items(entities[number]),
            )
            lines.append((mine, line))
        return numbers[key]

    roots = [n for n, entity in entities.items() if entity.startswith(_COLOURED)]
    for root in sorted(roots, key=full):
        emit(root)
    return "".join(f"#{number} = {line};\n" for number, line in sorted(lines))


CHORD_MM = 0.01
ANGLE_RAD = 0.15
_LEVEL = 0.999  # upward part of a normal
_ON_BED_MM = 0.01
_WELD_DECIMALS = 5  # of a mm: far below the chord error, above the noise of edges shared by faces
_TIMESTAMP = "2000-01-01T00:00:00"
_ZIP_DATE = (2000, 1, 1, 0, 0, 0)
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])

_DESCRIPTION = '<metadata name="Description">{}</metadata>\n'


def mesh(shape: Shape, chord_mm: float = CHORD_MM) -> Mesh:
    """The surface of a shape.

    Args:
        shape: a solid or several.
        chord_mm: how far a triangle may lie off a curved face.
    """
    BRepMesh_IncrementalMesh(shape.wrapped, chord_mm, False, ANGLE_RAD, False)
    points: list[Any] = []
    triangles: list[Any] = []
    for face in shape.faces():
        place = TopLoc_Location()
        facets = BRep_Tool.Triangulation_s(face.wrapped, place)
        shift, first = place.Transformation(), len(points) - 1
        flipped = face.wrapped.Orientation() == TopAbs_REVERSED
        for k in range(1, facets.NbNodes() + 1):
            node = facets.Node(k).Transformed(shift)
            points.append((node.X(), node.Y(), node.Z()))
        for k in range(1, facets.NbTriangles() + 1):
            a, b, c = facets.Triangle(k).Get()
            corners = (a, c, b) if flipped else (a, b, c)
            triangles.append([first + corner for corner in corners])
    return welded(points, triangles)


def welded(points_mm: ArrayLike, triangles: ArrayLike) -> Mesh:
    """A surface whose equal corners are one, without the triangles that vanish by that.

    Args:
        points_mm: corners, shape `(n, 3)`; equal ones may repeat.
        triangles: their indices, shape `(m, 3)`.
    """
    rounded = np.round(np.array(points_mm), _WELD_DECIMALS) + 0.0
    corners, places = np.unique(rounded, axis=0, return_inverse=True)
    joined = places.reshape(-1)[np.array(triangles)]
    distinct = (joined != np.roll(joined, 1, axis=1)).all(axis=1)
    return Mesh(corners, joined[distinct])


def part_files(
    path: str,
    solid: Shape,
    bed_to_frame: Matrix,
    frame: str = "sensor",
    chord_mm: float = CHORD_MM,
    facts: Facts | None = None,
) -> tuple[Artefact, ...]:
    """STEP of a printed part in a frame, STL and 3MF as it lies on the bed, with its volume.

    Args:
        path: of the files, without their ending.
        solid: the part in its frame.
        bed_to_frame: from the bed to that frame (4x4, mm).
        frame: name of the frame.
        chord_mm: how far a triangle may lie off a curved face.
        facts: more figures of the part, beside those of its surface.
    """
    name = path.rpartition("/")[2]
    in_frame = Artefact(f"{path}.step", step(solid, name), frame=frame)
    surface = mesh(placed(solid, np.asarray(np.linalg.inv(bed_to_frame), np.float64)), chord_mm)
    figures = {**surface_facts(surface), **(facts or {})}
    return (
        in_frame,
        Artefact(f"{path}.stl", mesh_stl(surface), bed_to_frame, frame, figures),
        Artefact(f"{path}.3mf", three_mf(surface, name), bed_to_frame, frame),
    )


def surface_facts(surface: Mesh) -> dict[str, float]:
    """Volume inside a closed surface that lies on the bed, its height, and areas: of its walls as
    seen from the side, on the bed, and of what looks up."""
    solid = trimesh.Trimesh(surface.points_mm, surface.triangles, process=False)
    (_, _, low), (_, _, high) = solid.bounds
    up, areas = solid.face_normals[:, 2], solid.area_faces
    level = np.abs(up) > _LEVEL
    middle = solid.triangles_center[:, 2]
    return {
        "volume_mm3": float(solid.volume),
        "height_mm": round(float(high - low), 6),
        "side_mm2": round(float((areas * np.sqrt(1 - np.minimum(up**2, 1))).sum()), 3),
        "base_mm2": round(float(areas[level & (middle < low + _ON_BED_MM)].sum()), 3),
        "top_mm2": round(float(areas[level & (up > 0)].sum()), 3),
    }


def mesh_stl(surface: Mesh) -> bytes:
    """A binary STL of a surface."""
    corners = surface.points_mm[surface.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    records = np.zeros(len(corners), dtype=_TRIANGLE)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    records["normal"] = normals / np.where(lengths > 0, lengths, 1.0)
    records["corners"] = corners
    header = b"Lumitip, units mm".ljust(80)
    return header + np.uint32(len(records)).tobytes() + records.tobytes()


def three_mf(surface: Mesh, name: str, description: str = "") -> bytes:
    """A 3MF package with one object.

    Args:
        surface: what to print, in print orientation on z = 0.
        name: what slicers call it.
        description: how to print it, as metadata; none where it is empty.
    """
    vertices = "\n".join(
        f'<vertex x="{x:.5f}" y="{y:.5f}" z="{z:.5f}"/>' for x, y, z in surface.points_mm.tolist()
    )
    triangles = "\n".join(
        f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in surface.triangles.tolist()
    )
    metadata = _DESCRIPTION.format(escape(description)) if description else ""
    model = passage(_TEXTS, "model").format(
        name=quoteattr(name), metadata=metadata, vertices=vertices, triangles=triangles
    )
    package = io.BytesIO()
    with zipfile.ZipFile(package, "w") as files:
        for path, text in (
            ("[Content_Types].xml", passage(_TEXTS, "content_types")),
            ("_rels/.rels", passage(_TEXTS, "relationships")),
            ("3D/3dmodel.model", model),
        ):
            entry = zipfile.ZipInfo(path, _ZIP_DATE)
            entry.create_system = 3  # the same on every system
            files.writestr(entry, text, zipfile.ZIP_DEFLATED, compresslevel=6)
    return package.getvalue()


def step(shape: Shape, name: str) -> bytes:
    """A STEP file.

    Args:
        shape: a shape, or a compound with labelled and coloured children.
        name: what other programs call it.
    """
    written = io.BytesIO()
    before, shape.label = shape.label, name
    try:
        export_step(shape, written, timestamp=_TIMESTAMP)
    finally:
        shape.label = before
    return canonical(written.getvalue().decode("ascii")).encode("ascii")
