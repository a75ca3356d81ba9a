"""Draw pictures of the documents from the real outputs: `make pictures`, then look at them.

Needs the extra `[docs]` (VTK drawing off screen, PDFium).
"""

import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pypdfium2
from PIL import Image
from vtkmodules import vtkInteractionStyle as _  # noqa: F401 - registers the renderer
from vtkmodules import vtkRenderingOpenGL2 as __  # noqa: F401
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkFiltersCore import vtkFeatureEdges, vtkPolyDataNormals
from vtkmodules.vtkIOGeometry import vtkSTLReader
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOImport import vtkGLTFImporter
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkLightKit,
    vtkPolyDataMapper,
    vtkRenderer,
    vtkRenderWindow,
    vtkWindowToImageFilter,
)

from lumitip_fab.design import frames
from lumitip_fab.design.encoding import read_design

Vector = tuple[float, float, float]
IMAGES = Path(__file__).parent / "images"
SHARP_DEG = 12
_COLOURS = 64
ZOOM = {"assembly": 1.3, "fit_plate": 1.85}
SIZE, FLAT = (1000, 800), (1000, 480)
PLASTIC: Vector = (0.56, 0.66, 0.80)
CLAMP: Vector = (0.85, 0.56, 0.31)
MOULD: Vector = (0.84, 0.76, 0.62)


def main(out: Path, integrated: Path, flex: Path) -> None:
    """Draw parts, masks, boards, wiring and the manual's pages.

    Args:
        out: outputs of the design to edit.
        integrated: outputs of the preset whose controller is on the flange's board.
        flex: outputs of the preset with compliant fingers.
    """
    IMAGES.mkdir(exist_ok=True)
    shots: tuple[tuple[str, str, Vector, Vector], ...] = (
        ("backing/emitter_backing.stl", "backing_back.png", (0.7, 1, 0.5), PLASTIC),
        ("backing/emitter_backing.stl", "backing_front.png", (0.6, -1, 0.4), PLASTIC),
        ("mould/receiver_mould.stl", "mould.png", (0.25, 1, 0.6), MOULD),
        ("holder/holder.stl", "holder.png", (0.5, -1, 0.9), PLASTIC),
        ("flange/flange_lower.stl", "flange_lower.png", (0.5, -0.8, 1.1), PLASTIC),
    )
    for part, picture, direction, colour in shots:
        draw([actor(out / part, colour)], IMAGES / picture, direction, (0, 0, 1))
    clamped = list(_clamped(out))
    if clamped:
        draw(clamped, IMAGES / "clamp.png", (-0.7, 1, 0.9), (0, 0, 1))
    plate = actor(out / "fit/fit_plate.stl", PLASTIC)
    draw([plate], IMAGES / "fit_plate.png", (0.3, -0.9, 0.9), (0, 0, 1), FLAT)
    for card in out.glob("gauge/*.stl"):
        draw([actor(card, PLASTIC)], IMAGES / "gauge_card.png", (0.3, -0.9, 0.9), (0, 0, 1), FLAT)
    for side in ("receiver", "emitter"):
        page = pypdfium2.PdfDocument(out / f"mask/{side}_mask_a4.pdf")[0]
        page.render(scale=110 / 72).to_pil().convert("L").save(
            IMAGES / f"mask_{side}.png", optimize=True
        )
    for side in ("receiver", "emitter"):
        shutil.copy(out / f"assembly/{side}_exploded.svg", IMAGES)
        for face in ("front", "back"):
            board = out / f"boards/{side}/{side}_{face}.png"
            _board(board, f"board_{side}_{face}.png")
    for name in ("breakout", "flange"):
        _board(out / f"boards/{name}/{name}_front.png", f"board_{name}.png")
    _board(integrated / "boards/flange/flange_front.png", "board_flange_module.png")
    shutil.copy(flex / "assembly/receiver_exploded.svg", IMAGES / "flex_exploded.svg")
    _board(flex / "boards/receiver/receiver_front.png", "flex_board.png")
    shutil.copy(out / "wiring/wiring.svg", IMAGES)
    shutil.copy(out / "assembly/system.svg", IMAGES)
    _pages(pypdfium2.PdfDocument(out / "manual/manual.pdf"), ("Put the board in", "Clamp it, and"))
    draw_glb(out / "assembly/assembly.glb", IMAGES / "assembly.png")


def _clamped(out: Path) -> Iterator[list[vtkActor]]:
    """The receiver in its mould under the clamp, in the frame of the mould's bed."""
    design = read_design(out / "design.json")
    stack, mount = design.stack, design.mount
    to_bed = np.linalg.inv(frames.mould_bed_to_sensor(stack, design.mould))
    for clamp in design.clamps:
        yield actor(out / "mould/receiver_mould.stl", MOULD)
        to_sensor = frames.backing_bed_to_sensor(mount, stack)
        yield actor(out / "backing/receiver_backing.stl", PLASTIC, to_bed @ to_sensor)
        to_sensor = frames.clamp_bed_to_sensor(stack, clamp)
        yield actor(out / clamp.file, CLAMP, to_bed @ to_sensor)


def _board(picture: Path, name: str) -> None:
    """A board's picture, whose few colours need a palette alone."""
    Image.open(picture).quantize(_COLOURS).save(IMAGES / name, optimize=True)


def _pages(document: pypdfium2.PdfDocument, titles: tuple[str, ...]) -> None:
    """The manual's first page and those of some steps, side by side."""
    heads = [page.get_textpage().get_text_bounded()[:60] for page in document]
    numbers = [next(n for n, head in enumerate(heads) if title in head) for title in titles]
    shown = [document[number].render(scale=0.75).to_pil() for number in (0, *numbers)]
    width, height = shown[0].size
    together = Image.new("RGB", (len(shown) * (width + 8) - 8, height), "#c9d0d6")
    for place, page in enumerate(shown):
        together.paste(page, (place * (width + 8), 0))
    together.save(IMAGES / "manual.png", optimize=True)


def actor(stl: Path, colour: Vector, moved: frames.Matrix | None = None) -> list[vtkActor]:
    """A part shaded, with its sharp edges drawn; where its file has it, or moved by a matrix."""
    reader = vtkSTLReader()
    reader.SetFileName(str(stl))
    smooth = vtkPolyDataNormals()
    smooth.SetInputConnection(reader.GetOutputPort())
    smooth.SetFeatureAngle(SHARP_DEG)
    edges = vtkFeatureEdges()
    edges.SetInputConnection(reader.GetOutputPort())
    edges.SetFeatureAngle(SHARP_DEG)
    edges.BoundaryEdgesOff()
    edges.ColoringOff()
    actors = []
    for source, tint in ((smooth, colour), (edges, (0.1, 0.1, 0.1))):
        mapper = vtkPolyDataMapper()
        mapper.SetInputConnection(source.GetOutputPort())
        mapper.ScalarVisibilityOff()
        shown = vtkActor()
        shown.SetMapper(mapper)
        shown.GetProperty().SetColor(*tint)
        shown.GetProperty().SetAmbient(0.25)
        shown.GetProperty().SetLineWidth(1.4)
        if moved is not None:
            at = vtkMatrix4x4()
            at.DeepCopy(np.asarray(moved).ravel().tolist())
            shown.SetUserMatrix(at)
        actors.append(shown)
    return actors


def draw(
    parts: list[list[vtkActor]],
    picture: Path,
    direction: Vector,
    up: Vector,
    size: tuple[int, int] = SIZE,
) -> None:
    """Draw parts seen from a direction, without perspective."""
    scene = vtkRenderer()
    for shown in (a for part in parts for a in part):
        scene.AddActor(shown)
    _save(scene, picture, direction, up, size=size)


def draw_glb(glb: Path, picture: Path) -> None:
    """Draw the assembly with the colours that it carries, the dark films left away."""
    scene, window = vtkRenderer(), vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.AddRenderer(scene)
    importer = vtkGLTFImporter()
    importer.SetFileName(str(glb))
    importer.SetRenderWindow(window)
    importer.Update()
    scene.RemoveAllLights()
    for shown in scene.GetActors():
        look = shown.GetProperty()
        look.SetInterpolationToPhong()
        look.SetAmbient(0.3)
        look.SetDiffuse(0.9)
        shown.SetVisibility(look.GetOpacity() == 1 or sum(look.GetColor()) > 1)
    _save(scene, picture, (1, 0.45, 0.5), (0, 1, 0), window)


def _save(
    scene: vtkRenderer,
    picture: Path,
    direction: Vector,
    up: Vector,
    window: vtkRenderWindow | None = None,
    size: tuple[int, int] = SIZE,
) -> None:
    scene.SetBackground(1, 1, 1)
    vtkLightKit().AddLightsToRenderer(scene)
    camera = scene.GetActiveCamera()
    camera.SetFocalPoint(0, 0, 0)
    camera.SetPosition(*direction)
    camera.SetViewUp(*up)
    camera.ParallelProjectionOn()
    scene.ResetCamera()
    camera.Zoom(ZOOM.get(picture.stem, 1.15))
    if window is None:
        window = vtkRenderWindow()
        window.SetOffScreenRendering(1)
        window.AddRenderer(scene)
    window.SetMultiSamples(8)
    window.SetSize(*size)
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    writer = vtkPNGWriter()
    writer.SetFileName(str(picture))
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
