"""Layouts that were used on this computer: a device that names its design is opened without a file.

They lie in the user's data folder, one file for each design; the last one used replaces it.
"""

import logging
from pathlib import Path

from lumitip.calibration import user_folder
from lumitip.errors import LumitipError
from lumitip.layout import Layout

_log = logging.getLogger(__name__)
_DIGITS = 16  # of the design hash, in the name of the file


def remember(layout: Layout, folder: Path | None = None) -> None:
    """Keep a layout for `recall`, in the user's data folder or in `folder`.

    A folder that cannot be written is logged: the fingertip itself can be used.
    """
    try:
        path = (folder or _folder()) / f"{layout.design_hash[:_DIGITS]}.json"
        text = layout.to_json()
        if path.is_file() and path.read_text(encoding="utf-8") == text:
            return
        path.parent.mkdir(parents=True, exist_ok=True)
        fresh = path.with_suffix(".new")
        fresh.write_text(text, encoding="utf-8")
        fresh.replace(path)
    except (OSError, ValueError, LumitipError) as error:
        _log.info("the layout of design %s is not kept: %s", layout.design_hash[:_DIGITS], error)


def recall(design: str, cells: int, folder: Path | None = None) -> Layout | None:
    """The layout of a design, or `None` if there is none, or no single one.

    Args:
        design: first digits of the design hash (hex), 4 or more.
        cells: number of cells.
        folder: instead of the user's data folder.
    """
    found = []
    try:
        for path in sorted((folder or _folder()).glob(f"{design[:_DIGITS]}*.json")):
            layout = Layout.load(path)
            if layout.design_hash.startswith(design) and len(layout) == cells:
                found.append(layout)
    except (OSError, LumitipError) as error:
        _log.info("layouts cannot be read: %s", error)
    return found[0] if len(found) == 1 else None


def _folder() -> Path:
    return user_folder() / "layouts"
