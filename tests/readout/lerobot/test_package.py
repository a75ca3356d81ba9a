"""Names and files that LeRobot and pip need of the package."""

import ast
import re
import sys
import tomllib
from collections.abc import Callable
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any, get_type_hints

import pytest

import lerobot_stand_ins

ROOT = Path(__file__).parents[3] / "readout" / "lerobot"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]


def test_lerobot_finds_the_package_and_its_devices(
    lerobot: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    info = tmp_path / f"{PROJECT['name']}-{PROJECT['version']}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.4\nName: {PROJECT['name']}\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    lerobot_stand_ins.register_third_party_plugins()
    robots, teleoperators = lerobot["lerobot.robots"], lerobot["lerobot.teleoperators"]
    config = robots.RobotConfig.choices["lumitip"](fingers={"left": "twin://edge"})
    robot = robots.make_robot_from_config(config)
    assert (robot.robot_type, config.type, type(robot).__name__) == (
        "lumitip",
        "lumitip",
        "Lumitip",
    )
    teleoperator = teleoperators.make_teleoperator_from_config(
        teleoperators.TeleoperatorConfig.choices["lumitip_idle"]()
    )
    assert type(teleoperator).__name__ == "LumitipIdle"
    with teleoperator:
        assert teleoperator.is_connected and teleoperator.is_calibrated
        assert teleoperator.get_action() == teleoperator.action_features == {}
    assert not teleoperator.is_connected


def test_lerobots_parser_ends(plugin: Any, lerobot: dict[str, Any]) -> None:
    """It goes into every type of a registry, so that a configuration in itself has no end."""
    kinds = get_type_hints(plugin.LumitipConfig).values()
    assert not any("Config" in str(kind) for kind in kinds)
    assert lerobot["lerobot.robots"].RobotConfig not in kinds


def test_the_project_names_all_that_it_imports() -> None:
    found = set()
    for path in ROOT.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Import):
                found |= {alias.name.partition(".")[0] for alias in node.names}
            if isinstance(node, ast.ImportFrom):
                assert node.level == 0
                found.add(str(node.module).partition(".")[0])
    brought = {"numpy", "draccus"}  # by lumitip and lerobot
    listed = {re.split(r"[\[>=]", text)[0] for text in PROJECT["dependencies"]}
    assert found - sys.stdlib_module_names - {PROJECT["name"]} - brought == listed


def test_versions_are_those_of_lumitip() -> None:
    text = (ROOT.parents[1] / "pyproject.toml").read_text("utf-8")
    assert tomllib.loads(text)["project"]["version"] == PROJECT["version"]
    assert (ROOT / PROJECT["name"] / "__init__.py").is_file()


def test_options_of_the_page_are_those_of_the_robot(plugin: Any) -> None:
    table = (ROOT / "README.md").read_text("utf-8").partition("| option |")[2]
    rows = dict(re.findall(r"^\| `(\w+)` \| (\S+) \|", table, re.MULTILINE))
    own = [field for field in fields(plugin.LumitipConfig) if field.name not in _base(plugin)]
    assert list(rows) == [field.name for field in own]
    for field in own:
        default = {} if field.default is MISSING else field.default
        shown = "none" if default is None else str(default).lower()
        assert rows[field.name] == shown, field.name


def _base(plugin: Any) -> set[str]:
    return {field.name for field in fields(plugin.LumitipConfig.__mro__[1])}


def test_features_of_the_page_are_those_of_a_window(make_robot: Callable[..., Any]) -> None:
    table = (ROOT / "README.md").read_text("utf-8").partition("| feature |")[2]
    rows = re.findall(r"^\| `(\S+?)`(?: … `\S+`)? \|", table.partition("\n\n")[0], re.MULTILINE)
    names = make_robot(window=1).observation_features
    first = [name for name in names if not re.search(r"\.c([1-9]\d*)$", name)]
    assert [f"lumitip_left.{row}" for row in rows] == first
