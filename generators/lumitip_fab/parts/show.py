"""Show parts in the browser while a drawing function is being written."""

import math
import tempfile
import webbrowser
from itertools import cycle
from pathlib import Path

import trimesh
from build123d import Shape, import_step
from trimesh.viewer.notebook import scene_to_html
from trimesh.visual import TextureVisuals
from trimesh.visual.material import PBRMaterial

from lumitip_fab.parts.export import mesh

MESHES = (".stl", ".3mf", ".glb")
SOLIDS = (".step", ".stp")
_COLOURS = ((90, 130, 180), (215, 150, 70), (110, 165, 110), (170, 110, 160), (150, 150, 150))
_CHORD_MM = 0.05
_FROM_ABOVE_RAD = (math.radians(55), 0.0, math.radians(30))


def show(*parts: Shape | Path | str, open_page: bool = True) -> Path:
    """Write parts into one page with a 3D view, and open it in the browser.

    The page holds everything that it needs: it also works without a network, and can be sent on.

    Args:
        parts: shapes of build123d, or STEP, STL, 3MF or GLB files. Each is drawn where its
            coordinates say.
        open_page: open the page; if not, it is only written.

    Returns:
        The page, in the temporary folder of the system.

    Raises:
        ValueError: with every argument that is no part.
    """
    faults = [fault for part in parts if (fault := _fault(part))]
    if faults or not parts:
        raise ValueError("\n".join(faults or ["show needs at least one part"]))
    scene = trimesh.Scene()
    for part, colour in zip(parts, cycle(_COLOURS), strict=False):
        body = _mesh(part)
        if isinstance(part, Shape) or Path(part).suffix.lower() != ".glb":
            body.unmerge_vertices()  # edges stay sharp
            body.visual = TextureVisuals(
                material=PBRMaterial(
                    baseColorFactor=colour, metallicFactor=0.0, roughnessFactor=0.8
                )
            )
        scene.add_geometry(body)
    scene.set_camera(angles=_FROM_ABOVE_RAD, distance=1.4 * scene.scale)
    page = Path(tempfile.mkdtemp(prefix="lumitip-show-")) / "parts.html"
    page.write_text(scene_to_html(scene), encoding="utf-8")
    if open_page:
        webbrowser.open(page.as_uri())
    return page


def _fault(part: object) -> str:
    if isinstance(part, Shape):
        return ""
    if not isinstance(part, Path | str):
        return f"{part!r:.60} is a {type(part).__name__}; give a shape of build123d or a file"
    file = Path(part)
    if file.suffix.lower() not in MESHES + SOLIDS:
        return f"{file} is no part; give a {', '.join(MESHES + SOLIDS)} file"
    return "" if file.is_file() else f"{file} does not exist; build the design first"


def _mesh(part: Shape | Path | str) -> trimesh.Trimesh:
    if not isinstance(part, Shape):
        file = Path(part)
        if file.suffix.lower() in MESHES:
            return trimesh.load(file, force="mesh")
        part = import_step(file)
    surface = mesh(part, _CHORD_MM)
    return trimesh.Trimesh(surface.points_mm, surface.triangles, process=False)
