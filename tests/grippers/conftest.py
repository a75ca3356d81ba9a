"""A finger, and answers for a new gripper."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import tomlkit

from lumitip_fab.catalogue.grippers import Gripper
from lumitip_fab.config.load import Input, load
from lumitip_fab.grippers.answers import template
from lumitip_fab.grippers.figures import figures, value_of

Fill = Callable[..., Path]


@pytest.fixture(scope="session")
def config(design_dir: Path) -> Input:
    """The published sensor."""
    return load(design_dir / "presets/published.toml")


@pytest.fixture
def fill(tmp_path: Path) -> Fill:
    """`fill("my_jaw", gripper, land_mm=4.0)`: the answers file of a new gripper, with the figures
    of another one in it but for those that are named; what that one is without is deleted."""

    def write(name: str, gripper: Gripper, **others: Any) -> Path:
        file = tmp_path / name / f"{name}.toml"
        file.parent.mkdir()
        answers = tomlkit.parse(template(name, {}, None, "page.html"))
        for figure in figures():
            table: Any = answers.get(figure.table, answers)
            key, value = figure.name.rpartition(".")[2], value_of(gripper, figure.name)
            if value is not None:
                table[key] = value
            elif figure.table:
                answers.pop(figure.table, None)
            else:
                del table[key]
        for key, value in others.items():
            answers[key] = value
        file.write_text(tomlkit.dumps(answers), encoding="utf-8")
        return file

    return write
