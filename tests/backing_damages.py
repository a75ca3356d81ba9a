"""Damages of a backing's files, each with the checks that must fail."""

import shutil
from pathlib import Path

import numpy as np
import trimesh

from damages import cut_short, flip_a_triangle, swap

STL = "backing/receiver_backing.stl"
EMITTER_STL = "backing/emitter_backing.stl"


def triangle_flipped(folder: Path) -> None:
    flip_a_triangle(folder / STL)


def triangle_lost(folder: Path) -> None:
    mesh = trimesh.load(folder / STL, force="mesh")
    faces = np.delete(mesh.faces, int(mesh.area_faces.argmin()), axis=0)
    trimesh.Trimesh(mesh.vertices, faces, process=False).export(folder / STL)


def windows_missing(folder: Path) -> None:
    shutil.copy(folder / STL, folder / EMITTER_STL)


def in_inches(folder: Path) -> None:
    trimesh.load(folder / STL, force="mesh").apply_scale(1 / 25.4).export(folder / STL)


def longer(folder: Path) -> None:
    mesh = trimesh.load(folder / STL, force="mesh")
    mesh.apply_transform(np.diag([1.0, 1.0, 1.002, 1.0])).export(folder / STL)


def truncated(folder: Path) -> None:
    cut_short(folder / STL, 5000)


def fingers_swapped(folder: Path) -> None:
    """The letters tell; and the emitter's parts on the back of its board find no windows."""
    swap(folder / STL, folder / EMITTER_STL)


def not_a_mesh(folder: Path) -> None:
    (folder / STL).write_text("solid nothing\nendsolid nothing\n")


def gone(folder: Path) -> None:
    (folder / STL).unlink()


EVERY_LENGTH = {
    "bed_contact",
    "bolt",
    "bolt_clearance",
    "bolt_hole",
    "gripper_pin_depth",
    "gripper_pin_hole",
    "gripper_pins",
    "key_hole",
    "key_sink",
    "keys",
    "letter",
    "min_wall",
    "nose",
    "outline",
    "pin_clearance",
    "pin_height",
    "pins",
    "pocket_depth",
    "pocket_gap",
    "screw_seat",
    "size",
    "slant",
    "tip_edge",
}
FILES = {
    triangle_flipped: {"watertight"},
    triangle_lost: {"watertight"},
    windows_missing: {"reliefs", "letter"},
    fingers_swapped: {"reliefs", "pocket_depth", "letter"},
    longer: {"size", "outline", "keys", "pins", "pocket_gap"},
    in_inches: EVERY_LENGTH,
    truncated: {"readable"},
    not_a_mesh: {"readable"},
    gone: {"readable"},
}
