"""Files that colcon and ROS need of the two packages, checked without them."""

import ast
import re
import runpy
import shutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any
from xml.etree import ElementTree as XmlTree

import pytest
import yaml

from lumitip.recording.message import schema_text

ROOT = Path(__file__).parents[3] / "readout" / "ros2"
MESSAGES, NODE = ROOT / "lumitip_msgs", ROOT / "lumitip_ros"
NOT_OF_ROS = {"lumitip", "lumitip_ros", "setuptools", *sys.stdlib_module_names}
"""Lumitip is installed with pip."""
NAMES = {"numpy": "python3-numpy"}
"""Of modules in a package.xml, where they differ."""


def needed(package: Path) -> set[str]:
    root = XmlTree.parse(package / "package.xml").getroot()
    assert root.tag == "package" and root.attrib["format"] == "3"
    assert root.findtext("name") == package.name
    kinds = ("depend", "exec_depend", "buildtool_depend")
    return {e.text or "" for kind in kinds for e in root.iter(kind)}


def imported(path: Path) -> set[str]:
    found = set()
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name.partition(".")[0] for alias in node.names}
        if isinstance(node, ast.ImportFrom) and node.module:
            found.add(node.module.partition(".")[0])
    return found


def test_packages_name_all_that_they_import() -> None:
    sources = [*NODE.rglob("*.py")]
    assert len(sources) >= 6
    modules = set().union(*map(imported, sources)) - NOT_OF_ROS
    used = {NAMES.get(module, module) for module in modules}
    assert used == needed(NODE), "imports, and exec_depend in package.xml"


def test_every_message_is_generated_with_the_packages_it_needs() -> None:
    cmake = (MESSAGES / "CMakeLists.txt").read_text("utf-8")
    files = sorted(f"msg/{path.name}" for path in (MESSAGES / "msg").glob("*.msg"))
    assert re.findall(r'"(msg/\w+\.msg)"', cmake) == files
    texts = "".join(path.read_text("utf-8") for path in (MESSAGES / "msg").glob("*.msg"))
    used = set(re.findall(r"^(\w+_msgs)/\w+ \w+$", texts, re.MULTILINE))
    (listed,) = re.findall(r"DEPENDENCIES ([\w ]+)", cmake)
    assert set(listed.split()) == used
    found = set(re.findall(r"find_package\((\w+) REQUIRED\)", cmake))
    assert found - {"ament_cmake", "rosidl_default_generators"} == used <= needed(MESSAGES)
    root = XmlTree.parse(MESSAGES / "package.xml").getroot()
    assert root.findtext("member_of_group") == "rosidl_interface_packages"


def test_versions_and_licences_are_those_of_lumitip() -> None:
    text = (ROOT.parents[1] / "pyproject.toml").read_text("utf-8")
    (version,) = re.findall(r'^version = "(.*)"$', text, re.MULTILINE)
    for package in (MESSAGES, NODE):
        root = XmlTree.parse(package / "package.xml").getroot()
        assert (root.findtext("version"), root.findtext("license")) == (version, "Apache-2.0")
    assert f'version="{version}"' in (NODE / "setup.py").read_text("utf-8")


def test_a_recording_has_the_message_of_this_package() -> None:
    own, _, _ = schema_text().partition("\n====")
    assert (MESSAGES / "msg" / "Frame.msg").read_text("utf-8").strip() == own.strip()


def test_the_installed_files_exist(monkeypatch: pytest.MonkeyPatch) -> None:
    arguments: dict[str, Any] = {}
    setuptools = ModuleType("setuptools")
    setuptools.setup = lambda **values: arguments.update(values)  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "setuptools", setuptools)
    monkeypatch.chdir(NODE)
    runpy.run_path("setup.py")
    installed = [file for _, files in arguments["data_files"] for file in files]
    assert {"launch/fingertip.launch.py", "config/fingertip.yaml", "package.xml"} <= set(installed)
    assert all(Path(file).is_file() for file in installed)
    assert all((NODE / package / "__init__.py").is_file() for package in arguments["packages"])
    (script,) = arguments["entry_points"]["console_scripts"]
    name, module, function = re.fullmatch(r"(\w+) = ([\w.]+):(\w+)", script).groups()  # type: ignore[union-attr]
    source = (NODE / (module.replace(".", "/") + ".py")).read_text("utf-8")
    assert name == "fingertip" and f"def {function}()" in source


def test_the_node_runs_with_the_python_of_the_shell(tmp_path: Path) -> None:
    """By the commands of colcon, which apt runs with /usr/bin/python3 whatever venv is active."""
    pytest.importorskip("setuptools")
    folder = shutil.copytree(NODE, tmp_path / "lumitip_ros")
    subprocess.run(
        f"{sys.executable} -W ignore setup.py -q egg_info --egg-base {tmp_path} "
        f"build --build-base {tmp_path}/build install --prefix {tmp_path}/install "
        f"--record {tmp_path}/log --single-version-externally-managed",
        shell=True,
        cwd=folder,
        check=True,
        capture_output=True,
    )
    (script,) = (tmp_path / "install/lib/lumitip_ros").iterdir()
    assert script.name == "fingertip"
    assert script.read_text("utf-8").splitlines()[0] == "#!/usr/bin/env python3"


def test_parameters_are_the_same_everywhere(ros: Any) -> None:
    config = yaml.safe_load((NODE / "config" / "fingertip.yaml").read_text("utf-8"))
    launched = launch_parameters()
    assert config["/**"]["ros__parameters"] | launched == ros.PARAMETERS
    page = (ROOT / "README.md").read_text("utf-8")
    table = page.partition("| parameter |")[2]
    rows = re.findall(r"^\| `(\w+)` \| (\w+) \| (\S+) \|", table, re.MULTILINE)
    kinds = {str: "string", bool: "bool", float: "double"}
    assert [(name, kind) for name, kind, _ in rows] == [
        (name, kinds[type(value)]) for name, value in ros.PARAMETERS.items()
    ]
    for name, _, default in rows:
        value = ros.PARAMETERS[name]
        shown = {"": "empty", True: "true"}.get(value, str(value))  # type: ignore[arg-type]
        assert default.strip("`") == shown, name


def launch_parameters() -> dict[str, str]:
    """Parameters that the launch file sets, with their defaults."""
    text = (NODE / "launch" / "fingertip.launch.py").read_text("utf-8")
    for node in ast.parse(text).body:
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "PARAMETERS":
            return {name: default for name, (default, _) in ast.literal_eval(node.value).items()}
    raise AssertionError("the launch file has no PARAMETERS")


def test_topics_of_the_page_are_those_of_the_node(make_node: Any) -> None:
    page = (ROOT / "README.md").read_text("utf-8")
    table = page.partition("| topic |")[2].partition("| parameter |")[0]
    topics = re.findall(r"^\| `(\S+)` \|", table, re.MULTILINE)
    assert sorted(topics) == sorted(make_node().published)


class Recorder(ModuleType):
    """A module of launch in which every name makes a record of its arguments."""

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        if name == "Transition":
            return type(name, (), {"TRANSITION_CONFIGURE": 1, "TRANSITION_ACTIVATE": 3})
        return lambda *args, **values: {"is": name, "args": args, **values}


LAUNCH = {
    "launch": {"Action", "LaunchDescription"},
    "launch.actions": {"DeclareLaunchArgument", "EmitEvent", "RegisterEventHandler", "TimerAction"},
    "launch.event_handlers": {"OnProcessStart"},
    "launch.events": {"matches_action"},
    "launch.substitutions": {"LaunchConfiguration", "PathJoinSubstitution"},
    "launch_ros": set(),
    "launch_ros.actions": {"LifecycleNode"},
    "launch_ros.event_handlers": {"OnStateTransition"},
    "launch_ros.events": set(),
    "launch_ros.events.lifecycle": {"ChangeState"},
    "launch_ros.parameter_descriptions": {"ParameterValue"},
    "launch_ros.substitutions": {"FindPackageShare"},
    "lifecycle_msgs": set(),
    "lifecycle_msgs.msg": {"Transition"},
}
"""Modules and names that ROS 2 has."""


def test_the_launch_file_configures_then_activates(monkeypatch: pytest.MonkeyPatch) -> None:
    path = NODE / "launch" / "fingertip.launch.py"
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.ImportFrom):
            assert {alias.name for alias in node.names} <= LAUNCH[node.module or ""]
    for name in LAUNCH:
        monkeypatch.setitem(sys.modules, name, Recorder(name))
    made = runpy.run_path(str(path))
    (parts,) = made["generate_launch_description"]()["args"]
    (node,) = [part for part in parts if part["is"] == "LifecycleNode"]
    assert (node["package"], node["executable"]) == ("lumitip_ros", "fingertip")
    declared = {part["args"][0] for part in parts if part["is"] == "DeclareLaunchArgument"}
    assert declared == {"config", "name", "namespace", *launch_parameters()}
    assert set(node["parameters"][1]) == set(launch_parameters())
    assert all(value["value_type"] is str for value in node["parameters"][1].values())
    started, active, refused = (p["args"][0] for p in parts if p["is"] == "RegisterEventHandler")
    assert started["is"] == "OnProcessStart" and started["target_action"] is node
    assert _transition(started["on_start"]) == 1
    assert (active["start_state"], active["goal_state"]) == ("configuring", "inactive")
    assert _transition(active["entities"]) == 3
    assert (refused["start_state"], refused["goal_state"]) == ("configuring", "unconfigured")
    (later,) = refused["entities"]
    assert later["is"] == "TimerAction" and later["period"] > 1.0
    assert _transition(later["actions"]) == 1


def _transition(actions: list[Any]) -> int:
    (action,) = actions
    return int(action["event"]["transition_id"])
