"""A design with a gripper that is not in the catalogue yet."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from lumitip_fab.catalogue import Catalogue
from lumitip_fab.catalogue.grippers import Gripper, Nose, Pins
from lumitip_fab.config.load import Input
from lumitip_fab.config.messages import shown_path
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.errors import InputError, Problem
from lumitip_fab.grippers.figures import TEXTS
from lumitip_fab.text import table_of

_PATTERN = "two_hole_jaw"  # of the catalogue, on which the example is based


def design_with(config: Input, name: str, gripper: Gripper, file: Path | None = None) -> Design:
    """The design of a parameter file, held by another gripper.

    Args:
        config: the parameter file.
        name: of the gripper.
        gripper: its entry.
        file: where its figures stand, for messages.

    Raises:
        InputError: with every rule that the gripper breaks with this finger.
    """
    grippers = {**config.catalogue.grippers, name: gripper}
    catalogue = config.catalogue.model_copy(update={"grippers": grippers})
    held = replace(config, catalogue=catalogue).with_values({"coupling.gripper": name})
    try:
        return derive(held)
    except InputError as error:
        finger = shown_path(config.sources[0].path)
        place = shown_path(file) if file else finger
        texts = (problem.text.partition(" Override it in ")[0] for problem in error.problems)
        sentence = table_of(TEXTS)["faults"]["rule"]
        raise InputError(
            Problem(place, 0, "", sentence.format(finger=finger, text=text.removesuffix(".")))
            for text in texts
        ) from error


def with_figures(base: Gripper, values: Mapping[str, Any]) -> Gripper:
    """A gripper with a flat seat that has these figures, and the others of another one.

    Args:
        base: the other one.
        values: figures by name, such as `pins.hole_mm`: all of a table, or none.
    """
    pins = {name.removeprefix("pins."): v for name, v in values.items() if "pins." in name}
    figures = {name: value for name, value in values.items() if "." not in name}
    own = {"pins": Pins(**pins) if pins else None, "nose": None}
    own |= {"bolt_spacing_mm": None, "seat_back_w_mm": None}
    return base.model_copy(update={**own, **figures})


def example(catalogue: Catalogue) -> Gripper:
    """A gripper with every figure that an entry may have; none in particular."""
    jaw = catalogue.grippers[_PATTERN]
    figures: Mapping[str, Any] = {
        "pins": Pins(hole_mm=3.1, spacing_mm=5.0, depth_mm=2.6),
        "nose": Nose(front_width_mm=12.0, front_w_mm=3.0, half_angle_deg=40.0, height_mm=2.5),
        "seat_width_mm": jaw.block_width_mm + 4.0,
    }
    return jaw.model_copy(update=figures)
