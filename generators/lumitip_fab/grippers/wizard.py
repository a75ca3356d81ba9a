"""The files of `lumitip-fab gripper new`, before and after the answers."""

from collections.abc import Iterator, Mapping
from collections.abc import Set as Names
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import tomlkit

from lumitip_fab.catalogue import Catalogue
from lumitip_fab.catalogue.grippers import Gripper
from lumitip_fab.catalogue.record import Confidence
from lumitip_fab.config.load import Input
from lumitip_fab.config.messages import shown_path, unknown_name
from lumitip_fab.design import Design
from lumitip_fab.errors import InputError, Problem
from lumitip_fab.grippers.answers import Answer, entry_text, read_answers, template
from lumitip_fab.grippers.drawing import body_drawing
from lumitip_fab.grippers.figures import TEXTS, figures, value_of
from lumitip_fab.grippers.page import page
from lumitip_fab.grippers.picture import found_drawing
from lumitip_fab.grippers.proposal import Proposal, propose
from lumitip_fab.grippers.reading import read_solid
from lumitip_fab.grippers.trial import design_with, example, with_figures
from lumitip_fab.grippers.ways import Named
from lumitip_fab.parts.export import mesh, mesh_stl
from lumitip_fab.parts.gauge import gauge_solid
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.paths import design_folder, parts_file
from lumitip_fab.scenes.coupling_view import coupling_view
from lumitip_fab.text import table_of

_CHORD_MM = 0.02
Written = dict[str, bytes]
"""Files by their name."""


@dataclass(frozen=True)
class Fingertip:
    """A maker's fingertip that was read from a file."""

    file: Path
    proposal: Proposal

    def answers(self) -> dict[str, Answer]:
        """The figures that it gives, each with its source."""
        source = table_of(TEXTS)["found"]["source"]
        trust: Confidence = "inferred"
        return {
            name: Answer(
                value=figure.value,
                source=source.format(file=self.file.name, where=figure.where),
                confidence=trust,
            )
            for name, figure in self.proposal.figures.items()
        }

    def notes(self) -> tuple[str, ...]:
        """What is doubtful, and what to do."""
        solids = len(self.proposal.shape.solids())
        text = table_of(TEXTS)["found"]["solids"].format(count=solids)
        return (*((text,) if solids > 1 else ()), *self.proposal.notes)


def read_fingertip(file: Path, catalogue: Catalogue, named: Named) -> Fingertip:
    """Read a STEP or FreeCAD file, and find what a gripper's entry needs.

    Args:
        file: of the maker's fingertip.
        catalogue: with the threads of bolts.
        named: holes and faces whose use the user names.

    Raises:
        InputError: if it cannot be read, or is no fingertip that can be bolted on.
    """
    return Fingertip(file, propose(file, read_solid(file), catalogue.fasteners, named))


def started(
    name: str, published: Input, own: Input, like: str | None, tip: Fingertip | None
) -> tuple[Written, tuple[str, ...]]:
    """Page, answers file, and where its figures are known a gauge; with what has to be noted.

    Args:
        name: of the new gripper.
        published: a finger that holds the example, for the drawings.
        own: the finger that the gripper is to hold, with its catalogue, for the gauge.
        like: a gripper of that catalogue to draw, and to make the gauge of.
        tip: the maker's fingertip.

    Raises:
        InputError: if `like` is not in the catalogue, or breaks a rule with that finger.
    """
    texts = table_of(TEXTS)
    shown = _entry(own.catalogue, like) if like else example(published.catalogue)
    held = design_with(own if like else published, name, shown)
    foot = _gauge(held)
    gauge, notes = (foot if like else None), tip.notes() if tip else ()
    drawings = {
        texts["page"]["foot"]: coupling_view(held.mount, foot, set(_figures_of(shown))),
        texts["page"]["whole"]: body_drawing(shown),
    }
    known = {
        figure: Answer(value=value, source=texts["answers"]["chosen"], confidence="assumed")
        for figure, value in texts["chosen"].items()
    }
    files: Written = {}
    if tip:
        known |= tip.answers()
        picture = found_drawing(tip.proposal)
        files[f"{name}_found.svg"] = picture.encode()
        drawings = {texts["page"]["step"].format(file=tip.file.name): picture, **drawings}
        values = {figure: answer.value for figure, answer in known.items()}
        gauge, missing = _gauge_of(values, tip.proposal.open, name, own, shown)
        notes += missing
    if gauge:
        files[f"{name}_gauge.stl"] = mesh_stl(gauge)
    answers, sheet = f"{name}.toml", f"{name}.html"
    title = shown.title or like if like else ""
    files[answers] = template(name, known, shown if like else None, sheet).encode()
    files[sheet] = page(name, answers, shown, title, drawings).encode()
    return files, notes


def _figures_of(gripper: Gripper) -> Iterator[str]:
    """Names of the figures that a gripper has."""
    return (f.name for f in figures() if value_of(gripper, f.name) is not None)


def _gauge(held: Design) -> Mesh:
    return mesh(gauge_solid(held), _CHORD_MM)


def _gauge_of(
    values: Mapping[str, Any], left: Names[str], name: str, finger: Input, others: Gripper
) -> tuple[Mesh | None, tuple[str, ...]]:
    """The gauge of a fingertip's figures, where all are known and go together; else why not."""
    texts = table_of(TEXTS)["gauge"]
    missing = sorted({*texts["needs"], *left} - set(values))
    if missing:
        return None, (texts["open"].format(figures=", ".join(missing)),)
    try:
        return _gauge(design_with(finger, name, with_figures(others, values))), ()
    except InputError as error:
        reasons = [texts["broken"].format(reason=problem.text) for problem in error.problems]
        return None, tuple(reasons)


def _entry(catalogue: Catalogue, name: str) -> Gripper:
    if name not in catalogue.grippers:
        message = unknown_name(name, catalogue.grippers, "parts/grippers.toml")
        raise InputError([Problem("lumitip-fab gripper", 0, "--like", message)])
    return catalogue.grippers[name]


def finished(name: str, config: Input, answers: Path) -> Written:
    """Entry and gauge of a gripper whose every figure is answered.

    Raises:
        InputError: with every fault of the answers, or every rule that the gripper breaks.
    """
    gripper = read_answers(answers)
    gauge = _gauge(design_with(config, name, gripper, answers))
    return {
        f"{name}_entry.toml": entry_text(name, gripper).encode(),
        f"{name}_gauge.stl": mesh_stl(gauge),
    }


def catalogue_with(name: str, entry: bytes, file: Path, replace: bool) -> tuple[Path, bytes]:
    """The catalogue of a design folder with a further entry.

    Args:
        name: of the gripper.
        entry: its table.
        file: a parameter file in that folder.
        replace: whether an entry of this name is replaced.

    Returns:
        The file `parts/grippers.toml` of that folder, and what is to be in it.

    Raises:
        InputError: if there is an entry of this name that may not be replaced.
    """
    folder = design_folder(file)
    text = parts_file(folder, "grippers").read_text(encoding="utf-8-sig")
    known = tomlkit.parse(text)
    target = folder / "parts" / "grippers.toml"
    if name in known:
        if not replace:
            message = table_of(TEXTS)["faults"]["entry"].format(name=name)
            raise InputError([Problem(shown_path(target), 0, "", message)])
        known.remove(name)
        text = tomlkit.dumps(known)
    return target, f"{text.rstrip()}\n\n".encode() + entry
