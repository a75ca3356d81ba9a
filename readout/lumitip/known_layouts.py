"""Layouts that were used on this computer: a device that names its design is opened without a file.

They lie in the user's data folder, one file for each device and design. The name of a design covers
cells and wiring, not the optics: two fingers of one design may have different masks, and what is
known of one is used for the other only where there is no doubt.
"""

import logging
import os
import tempfile
from pathlib import Path

from lumitip.calibration import file_name, user_folder
from lumitip.errors import LumitipError
from lumitip.layout import Layout

_log = logging.getLogger(__name__)


def remember(device_id: str, layout: Layout, folder: Path | None = None) -> None:
    """Keep the layout of a device that sends this design, for `recall`.

    A folder that cannot be written is logged: the fingertip itself can be used.

    Args:
        device_id: of the device.
        layout: its cells.
        folder: instead of the user's data folder.
    """
    try:
        kept = (folder or _folder()) / file_name(device_id, layout.design_hash)
        text = layout.to_json()
        if _text(kept) != text:
            _replace(kept, text)
    except (OSError, LumitipError) as error:
        _log.info("the layout of %s is not kept: %s", device_id, error)


def recall(device_id: str, design: str, cells: int, folder: Path | None = None) -> Layout | None:
    """The layout that was used with a device, or else with every other device of its design;
    `None` if there is none, or these differ.

    Args:
        device_id: of the device.
        design: first digits of the design hash (hex), 4 or more.
        cells: number of cells.
        folder: instead of the user's data folder.
    """
    own: dict[str, Layout] = {}
    others: dict[str, Layout] = {}
    try:
        paths = sorted((folder or _folder()).glob(f"*.{design[:16]}*.json"))
    except LumitipError as error:
        _log.info("layouts cannot be read: %s", error)
        return None
    for path in paths:
        try:
            layout = Layout.load(path)
        except LumitipError as error:
            _log.info("%s", error)
            continue
        if layout.design_hash.startswith(design) and len(layout) == cells:
            mine = path.name == file_name(device_id, layout.design_hash)
            (own if mine else others)[layout.to_json()] = layout
    found = own or others
    return next(iter(found.values())) if len(found) == 1 else None


def _folder() -> Path:
    return user_folder() / "layouts"


def _text(path: Path) -> str | None:
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, ValueError):
        return None  # none yet, or damaged


def _replace(path: Path, text: str) -> None:
    """Write a file at once: other programs read the one before, or this."""
    path.parent.mkdir(parents=True, exist_ok=True)
    number, fresh = tempfile.mkstemp(dir=path.parent, suffix=".new")
    try:
        with os.fdopen(number, "w", encoding="utf-8") as file:
            file.write(text)
        Path(fresh).replace(path)
    except OSError:
        Path(fresh).unlink(missing_ok=True)
        raise
