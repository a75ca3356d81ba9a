"""Finds in STEP files: figures of fingertips whose entries the finder does not know."""

import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest
from build123d import Axis, Compound, Cylinder, Location, Shape, export_brep
from OCP.Interface import Interface_Static
from OCP.ShapeUpgrade import ShapeUpgrade_ShapeDivideClosed
from OCP.STEPControl import STEPControl_StepModelType, STEPControl_Writer

from fingertip_shapes import block, bore, box, face_at, figures_of, plain
from lumitip_fab.catalogue.grippers import Gripper
from lumitip_fab.cli import main
from lumitip_fab.config.load import Input
from lumitip_fab.grippers.answers import Answer, template
from lumitip_fab.grippers.figures import value_of
from lumitip_fab.grippers.proposal import Proposal, propose
from lumitip_fab.grippers.reading import read_solid
from lumitip_fab.grippers.trial import design_with, example
from lumitip_fab.parts.backing import backing_solid
from lumitip_fab.parts.export import step

pytestmark = pytest.mark.slow

Write = Callable[[str, Gripper], Path]


@pytest.fixture(scope="session")
def backing_step(config: Input, tmp_path_factory: pytest.TempPathFactory) -> Write:
    """`backing_step("wsg50", gripper)`: the STEP file of a printed finger."""
    folder = tmp_path_factory.mktemp("fingers")

    def write(name: str, gripper: Gripper) -> Path:
        file = folder / f"{name}.step"
        if not file.exists():
            d = design_with(config, name, gripper)
            solid = backing_solid(
                d.receiver, d.stack, d.outline, d.tip, d.board, d.mount, d.interfaces, ()
            )
            file.write_bytes(step(solid, "backing"))
        return file

    return write


def found(file: Path, config: Input) -> Proposal:
    return propose(file, read_solid(file), config.catalogue.fasteners)


GIVEN = (
    *("bolt", "bolt_spacing_mm", "bolt_hole_mm", "counterbore_mm", "land_mm"),
    *("block_corner_mm", "block_back_w_mm", "bolt_w_mm"),
    *("pins.hole_mm", "pins.spacing_mm", "pins.depth_mm"),
)
"""Figures of an entry that the backing shows: its board stands where a maker's pad is. Its ends
stand beside the block, on the mount plane, so that the width of the block is not certain."""


@pytest.mark.parametrize(
    "name", ["example", "robotiq_2f85", "wsg50", "onrobot_rg2", "franka_hand", "two_hole_jaw"]
)
def test_a_printed_finger_has_the_figures_of_its_entry(
    name: str, config: Input, backing_step: Write
) -> None:
    gripper = example(config.catalogue) if name == "example" else config.catalogue.grippers[name]
    proposal = found(backing_step(name, gripper), config)
    values = {figure: proposed.value for figure, proposed in proposal.figures.items()}
    assert values.pop("pad_w_mm") == gripper.bolt_w_mm
    assert values == {n: v for n in GIVEN if (v := value_of(gripper, n)) is not None}
    assert proposal.open == {"block_width_mm"}


def test_the_part_may_lie_anywhere_and_in_inches(
    config: Input, backing_step: Write, tmp_path: Path
) -> None:
    gripper = config.catalogue.grippers["robotiq_2f85"]
    solid = read_solid(backing_step("robotiq_2f85", gripper))
    moved = solid.moved(Location((70.0, -31.0, 12.0), (31.0, -47.0, 143.0)))
    assert figures_of(moved, config) == figures_of(solid, config)
    file = tmp_path / "inches.step"
    Interface_Static.SetCVal_s("write.step.unit", "INCH")
    try:
        writer = STEPControl_Writer()
        writer.Transfer(solid.wrapped, STEPControl_StepModelType.STEPControl_AsIs)
        writer.Write(str(file))
    finally:
        Interface_Static.SetCVal_s("write.step.unit", "MM")
    assert "INCH" in file.read_text(encoding="utf-8")
    assert figures_of(read_solid(file), config) == figures_of(solid, config)


def test_holes_of_two_half_cylinders_are_whole(config: Input, backing_step: Write) -> None:
    solid = read_solid(backing_step("wsg50", config.catalogue.grippers["wsg50"]))
    divided = ShapeUpgrade_ShapeDivideClosed(solid.wrapped)
    assert divided.Perform()
    halves = Compound(Compound(divided.Result()).solids())
    assert len(halves.faces()) > len(solid.faces()) + 8
    assert figures_of(halves, config) == figures_of(solid, config)


def test_plain_holes_leave_the_counterbore_open(config: Input) -> None:
    values = figures_of(block(*plain(-7, 7)), config, pad=1)
    assert values == {
        "bolt_hole_mm": 4.5,
        "bolt": "M4",
        "bolt_spacing_mm": 14.0,
        "block_width_mm": 24.0,
        "pad_w_mm": 10.0,
        "bolt_w_mm": 10.0,
        "block_back_w_mm": 16.0,
    }


def test_chamfers_of_block_and_holes_change_no_figure(config: Input) -> None:
    whole = block(*plain(-7, 7)) - box((-13, 13), (5, 9), (40, 51))
    foot = [edge for edge in whole.edges() if edge.center().Z < 1e-6]
    for tip in (whole, whole.chamfer(0.8, None, foot)):
        values = figures_of(tip, config, pad=face_at(tip, -8.0), mount=face_at(tip, 0.0, axis=2))
        assert (values["block_width_mm"], values["block_back_w_mm"]) == (24.0, 16.0)


def test_blind_holes_are_pins_if_they_are_in_the_mount_face(config: Input) -> None:
    bolt = [bore(0, 1, 5.4, -1, 51), bore(0, 1, 9.5, 6, 51)]
    pins = [bore(x, 1, 3.0, -1, 4) for x in (-8, 8)]
    others = [bore(x, 1, 2.5, 40, 51) for x in (-9, 9)]
    values = figures_of(block(*bolt, *pins, *others), config)
    assert values["pins.hole_mm"] == 3.0
    assert values["pins.spacing_mm"] == 16.0
    assert values["pins.depth_mm"] == 4.0
    assert (values["bolt"], values["counterbore_mm"], values["land_mm"]) == ("M5", 9.5, 6.0)
    assert "bolt_spacing_mm" not in values


def test_several_solids_are_doubted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    tip = block(*plain(-7, 7))
    rubber = box((-12, 12), (-11.5, -8.5), (15, 45))
    file = tmp_path / "two.step"
    file.write_bytes(step(Compound([tip, rubber]), "tip"))
    out = ["--out", str(tmp_path / "out")]
    assert main(["gripper", "new", "jaw", "--from-step", str(file), *out]) == 0
    printed = capsys.readouterr().out
    assert "The file has 2 solids, which were read as one part." in printed
    assert "Which face grips is not certain" in printed  # rubber in front, block behind


def test_what_was_found_is_shown_and_filled_in(
    config: Input, backing_step: Write, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wsg50 = config.catalogue.grippers["wsg50"]
    file = backing_step("wsg50", wsg50)
    assert main(["gripper", "new", "jaw", "--from-step", str(file), "--out", str(tmp_path)]) == 0
    printed = capsys.readouterr().out
    assert "hole 1      bolt, ⌀ 6.10, 4.30, 7.40, through  -10.50, 0.00" in printed
    assert "bolt_spacing_mm  21.0   hole 1 and hole 2" in printed
    answers = (tmp_path / "jaw.toml").read_text(encoding="utf-8")
    source = 'source = "wsg50.step: hole 1 and hole 2", confidence = "inferred"'
    assert f"bolt_spacing_mm = {{ value = 21.0, {source} }}" in answers
    assert 'stroke_mm = "?"' in answers  # no fingertip shows it
    assert 'width_mm = "?"' in answers
    picture = (tmp_path / "jaw_found.svg").read_text(encoding="utf-8")
    assert picture.count('stroke="#c0392b"') == 4  # rings of both holes, mount face, pad
    assert ">1, 2: bolt, ⌀ 6.10, 4.30, 7.40<" in picture
    assert picture in (tmp_path / "jaw.html").read_text(encoding="utf-8")
    assert "No gauge is written: block_width_mm must be known first." in printed
    assert not (tmp_path / "jaw_gauge.stl").exists()


def test_a_found_text_is_toml() -> None:
    known = {"bolt": Answer(value="M4", source='a "tip".step: hole', confidence="inferred")}
    assert 'source = "a \\"tip\\".step: hole"' in template("jaw", known, None, "page.html")


def broken(text: str) -> dict[str, tuple[str, bytes, str]]:
    """Files that are no fingertips, by name: ending, bytes, and what is said of them."""
    head, tail = text[: text.index("DATA;") + 6], "ENDSEC;\nEND-ISO-10303-21;\n"
    return {
        "empty": ("step", b"", "does not begin with ISO-10303-21"),
        "mesh": ("stp", b"solid x\nendsolid x\n", "does not begin with ISO-10303-21"),
        "binary": ("step", bytes(range(256)) * 40, "does not begin with ISO-10303-21"),
        "cut": ("step", text[: len(text) // 2].encode(), "is cut off"),
        "no_data": ("step", (head + tail).encode(), "step"),
        "garbage": ("step", f"{head}#1=FOO(;\n@@@\n{tail}".encode(), "cannot be read as STEP"),
        "no_faces": ("step", text.replace("ADVANCED_FACE(", "FACE(").encode(), "has no solid"),
        "no_archive": ("FCStd", b"x", "is no archive"),
    }


@pytest.mark.parametrize("name", broken("DATA; "))
def test_a_damaged_file_is_one_error(
    name: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    ending, data, message = broken(step(block(), "tip").decode())[name]
    file, out = tmp_path / f"{name}.{ending}", tmp_path / "out"
    file.write_bytes(data)
    assert main(["gripper", "new", "jaw", "--from-step", str(file), "--out", str(out)]) == 2
    printed = capfd.readouterr()
    assert (printed.out, printed.err.count("\n")) == ("", 1)
    assert printed.err.startswith(f"{file}: ")
    assert message in printed.err
    assert not out.exists()


UNFIT: dict[str, tuple[Callable[[], Shape], str]] = {
    "no_holes": (block, "narrower than 2 mm: 0."),
    "blind": (lambda: block(bore(0, 0, 4.5, -1, 20)), "narrower than 2 mm: 1."),
    "metres": (
        lambda: block(*plain(-7, 7)).scale(0.001),
        "The part is 0.024 x 0.016 x 0.05 mm: if that is wrong, export it again in the right unit",
    ),
    "narrow": (lambda: block(bore(0, 0, 1.0, -1, 51)), "narrower than 2 mm: 1."),
    "round": (
        lambda: Cylinder(10, 40).rotate(Axis.X, 90) - bore(0, 0, 4.5, -20, 20),
        "has no plane face that its bolt holes (4.5 mm) open into",
    ),
}


@pytest.mark.parametrize("name", UNFIT)
def test_a_solid_that_is_no_fingertip_is_one_error(
    name: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    make, message = UNFIT[name]
    file, out = tmp_path / f"{name}.step", tmp_path / "out"
    file.write_bytes(step(make(), "tip"))
    assert main(["gripper", "new", "jaw", "--from-step", str(file), "--out", str(out)]) == 2
    printed = capfd.readouterr()
    assert (printed.out, printed.err.count("\n")) == ("", 1)
    assert message in printed.err
    assert not out.exists()


def test_a_freecad_file_with_one_shape_is_read(
    config: Input, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    tip = block(*plain(-7, 7))
    export_brep(tip, tmp_path / "tip.brp")
    for count in (1, 2):
        with zipfile.ZipFile(tmp_path / f"{count}.FCStd", "w") as archive:
            for number in range(count):
                archive.write(tmp_path / "tip.brp", f"PartShape{number}.brp")
    with zipfile.ZipFile(tmp_path / "other.FCStd", "w") as archive:
        archive.writestr("PartShape.brp", "x")
    with zipfile.ZipFile(tmp_path / "torn.FCStd", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.write(tmp_path / "tip.brp", "PartShape.brp")
    torn = bytearray((tmp_path / "torn.FCStd").read_bytes())
    torn[200:230] = bytes(30)
    (tmp_path / "torn.FCStd").write_bytes(torn)
    assert figures_of(read_solid(tmp_path / "1.FCStd"), config)["bolt_spacing_mm"] == 14.0
    for name, message in (
        ("2", "has 2 shapes"),
        ("other", "another format than BRep"),
        ("torn", "is no archive"),
    ):
        command = ["gripper", "new", "jaw", "--from-step", str(tmp_path / f"{name}.FCStd")]
        assert main([*command, "--out", str(tmp_path / "out")]) == 2
        printed = capfd.readouterr()
        assert (printed.out, printed.err.count("\n")) == ("", 1)
        assert message in printed.err
    assert not (tmp_path / "out").exists()
