"""`Model`: links, joints and meshes of a URDF file, read without any library of robots."""

from collections.abc import Iterator
from copy import deepcopy
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import numpy as np

from lumitip_fab.checks.readers.solids import Vectors, read_mesh
from lumitip_fab.errors import OutputError

M_TO_MM = 1000.0
_MACRO = "{http://www.ros.org/wiki/xacro}macro"
_LIMITS = ("lower", "upper", "effort", "velocity")


@dataclass(frozen=True, eq=False)
class Link:
    """A rigid body. Meshes are in the link's frame, in mm."""

    name: str
    mass_g: float
    centre_mm: Vectors
    inertia_g_mm2: Vectors
    """About the centre of mass, in the link's axes, shape `(3, 3)`."""
    visuals: dict[str, Any]
    collisions: dict[str, Any]
    materials: dict[str, tuple[str, tuple[float, ...]]]
    """Name and colour of each visual's material, as a viewer takes them; of those that have one."""
    xml: Element

    def renamed(self, prefix: str, meshes: str) -> str:
        """Its `xml_text` with another prefix of names and another folder of meshes."""
        copy = deepcopy(self.xml)
        for element in copy.iter():
            if element.tag in {"link", "material"}:
                element.set("name", _replaced(element.get("name", ""), "lumitip_", prefix))
            elif element.tag == "mesh":
                element.set("filename", _replaced(element.get("filename", ""), "meshes", meshes))
        return xml_text(copy)


@dataclass(frozen=True, eq=False)
class Joint:
    """How a link hangs on another."""

    kind: str
    parent: str
    child: str
    place: Vectors
    """4x4, from the child's frame at zero to the parent's, mm."""
    axis: Vectors
    lower_mm: float
    upper_mm: float
    effort_n: float
    speed_mm_s: float
    mimics: tuple[str, float, float]
    """The joint that it follows, or none (`""`); how many times as far, and from where (m)."""


@dataclass(frozen=True, eq=False)
class Model:
    """All of a file, by name."""

    name: str
    settings: dict[str, str]
    """Settings for MuJoCo in the file."""
    links: dict[str, Link]
    joints: dict[str, Joint]

    def to_base(self, link: str, opened_mm: float = 0.0) -> Vectors:
        """From a link's frame to its parent's, its joint moved by so much."""
        joint = next(j for j in self.joints.values() if j.child == link)
        moved = np.eye(4)
        moved[:3, 3] = joint.axis * opened_mm
        return np.asarray(joint.place @ moved)


def read_urdf(path: Path) -> Model:
    """Read a URDF file and the meshes that it names.

    Raises:
        OutputError: if the file or a mesh is missing or cannot be read.
    """
    try:
        root = ElementTree.fromstring(path.read_bytes())
        links = [_link(e, path.parent) for e in root.findall("link")]
        joints = {e.get("name", ""): _joint(e) for e in root.findall("joint")}
        settings = {k: v for e in root.findall("mujoco/compiler") for k, v in e.items()}
    except OSError as error:
        raise OutputError(f"cannot be read: {error.strerror}") from error
    except (ElementTree.ParseError, ValueError, KeyError, AttributeError) as error:
        raise OutputError(f"is no URDF: {error!r:.200}") from error
    return Model(root.get("name", ""), settings, {link.name: link for link in links}, joints)


def read_macros(path: Path, prefix: str, meshes: str) -> list[tuple[str, str]]:
    """Name and text of the robot, of each macro and of each element in one, and of anything else
    in a xacro file: macros by their parameters, elements in the form of `xml_text`, the macros'
    `prefix` and `meshes` replaced as xacro would.

    Raises:
        OutputError: if the file cannot be read.
    """
    try:
        text = path.read_text(encoding="utf-8")
        text = text.replace("${prefix}", prefix).replace("${meshes}", meshes)
        root = ElementTree.fromstring(text)
    except (OSError, ValueError, ElementTree.ParseError) as error:
        raise OutputError(f"cannot be read: {error}") from error
    found = [("robot", str(root.get("name")))]
    for element in root:
        if element.tag == _MACRO:
            found.append((f"macro {element.get('name')}", str(element.get("params"))))
        inside = element if element.tag == _MACRO else [element]
        found += [(str(e.get("name", e.tag)), xml_text(e)) for e in inside]
    return found


def xml_text(element: Element) -> str:
    """Tag, values and all that is in an element, the same however a file is written; tags with
    their namespace in full, whose prefix depends on what else ran in this process."""
    own = [element.tag, *(f"{key}={value!r}" for key, value in sorted(element.items()))]
    inside = [(element.text or "").strip()]
    inside += [f"{xml_text(each)}{(each.tail or '').strip()}" for each in element]
    return f"<{' '.join(own)}>{''.join(inside)}</>"


def _link(element: Element, folder: Path) -> Link:
    inertial = element.find("inertial")
    weighed = inertial is not None
    return Link(
        name=element.attrib["name"],
        mass_g=M_TO_MM * float(_attribute(inertial, "mass", "value")) if weighed else 0.0,
        centre_mm=M_TO_MM * _three(_attribute(inertial, "origin", "xyz") if weighed else "0 0 0"),
        inertia_g_mm2=_inertia(inertial) if weighed else np.zeros((3, 3)),
        visuals=dict(_meshes(element, "visual", folder)),
        collisions=dict(_meshes(element, "collision", folder)),
        materials=dict(_materials(element)),
        xml=element,
    )


def _replaced(name: str, old: str, new: str) -> str:
    """A name with another beginning; as it is where it begins otherwise."""
    return new + name.removeprefix(old) if name.startswith(old) else name


def _inertia(inertial: Element | None) -> Vectors:
    """The tensor, turned from the axes of the `<inertial>` to those of the link."""
    tensor = np.zeros((3, 3))
    for i, j in zip(*np.triu_indices(3), strict=True):
        value = _attribute(inertial, "inertia", f"i{'xyz'[i]}{'xyz'[j]}")
        tensor[i, j] = tensor[j, i] = float(value) * M_TO_MM**3
    turn = _turn(*_three(_attribute(inertial, "origin", "rpy")))
    return np.asarray(turn @ tensor @ turn.T)


def _meshes(element: Element, kind: str, folder: Path) -> Any:
    for body in element.findall(kind):
        mesh_element = body.find("geometry/mesh")
        if mesh_element is None:
            raise ValueError(f"{kind} {body.get('name')} has no mesh")
        name = mesh_element.attrib["filename"]
        try:
            mesh = read_mesh(folder / name)
        except OutputError as error:
            raise OutputError(f"{name}: {error}") from error
        mesh.apply_scale(_three(mesh_element.attrib["scale"]) * M_TO_MM)
        own = body.find("origin")
        yield str(body.get("name")), mesh if own is None else mesh.apply_transform(_place(own))


def _materials(element: Element) -> Iterator[tuple[str, tuple[str, tuple[float, ...]]]]:
    for body in element.findall("visual"):
        material, colour = body.find("material"), body.find("material/color")
        if material is not None and colour is not None:
            rgba = tuple(float(word) for word in colour.get("rgba", "").split())
            yield str(body.get("name")), (material.get("name", ""), rgba)


def _place(origin: Element) -> Vectors:
    """From the frame that an `<origin>` gives to the one around it, 4x4, mm."""
    place = np.eye(4)
    place[:3, :3] = _turn(*_three(origin.get("rpy", "0 0 0")))
    place[:3, 3] = M_TO_MM * _three(origin.get("xyz", "0 0 0"))
    return place


def _joint(element: Element) -> Joint:
    origin = element.find("origin")
    slides = element.get("type") == "prismatic"
    limits = {n: float(_attribute(element, "limit", n)) if slides else 0.0 for n in _LIMITS}
    mimic = element.find("mimic")
    return Joint(
        kind=element.attrib["type"],
        parent=_attribute(element, "parent", "link"),
        child=_attribute(element, "child", "link"),
        place=np.eye(4) if origin is None else _place(origin),
        axis=_three(_attribute(element, "axis", "xyz") if slides else "0 0 0"),
        lower_mm=M_TO_MM * limits["lower"],
        upper_mm=M_TO_MM * limits["upper"],
        effort_n=limits["effort"],
        speed_mm_s=M_TO_MM * limits["velocity"],
        mimics=("", 1.0, 0.0) if mimic is None else _mimicry(mimic),
    )


def _mimicry(mimic: Element) -> tuple[str, float, float]:
    multiplier, offset = mimic.get("multiplier", "1"), mimic.get("offset", "0")
    return mimic.attrib["joint"], float(multiplier), float(offset)


def _turn(roll: float, pitch: float, yaw: float) -> Vectors:
    """Turns about the fixed axes x, then y, then z (rad)."""
    (a, b, c), (p, q, r) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    about_x = np.array([[1, 0, 0], [0, a, -p], [0, p, a]])
    about_y = np.array([[b, 0, q], [0, 1, 0], [-q, 0, b]])
    about_z = np.array([[c, -r, 0], [r, c, 0], [0, 0, 1]])
    return np.asarray(about_z @ about_y @ about_x)


def _three(text: str) -> Vectors:
    numbers = np.array([float(word) for word in text.split()])
    if numbers.shape != (3,) or not np.isfinite(numbers).all():
        raise ValueError(f"{text!r} is not three numbers")
    return numbers


def _attribute(element: Element | None, path: str, name: str) -> str:
    found = None if element is None else element.find(path)
    if found is None or name not in found.attrib:
        raise ValueError(f"no {path} with {name}")
    return found.attrib[name]
