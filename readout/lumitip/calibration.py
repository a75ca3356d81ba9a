"""Calibration: the light of each cell in the dark and with an empty grasp, measured and saved.

It corrects the tolerances of LEDs, detectors and pull-ups. With both references,

    values = 255 * (light - dark) / (empty - dark), cut to 0..255,

where light is the complement of the raw code.
"""

import json
import os
import re
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal, get_args

import numpy as np

from lumitip import arguments
from lumitip.errors import ArgumentError, CalibrationError, CalibrationMismatch
from lumitip.frame import Values
from lumitip.values import one_line, shown

_LEAST_SPAN = 25.5  # a tenth of full light: the gain stays below 10
_LEAST_SHARE = 0.4  # of the median cell: the spread of parts is smaller, an object's effect larger
_MOST_DARK = 76.5  # three tenths of full light
_MOST_NOISE = 8.0  # counts of 255; above it something moves
_MOST_LISTED = 6
_FORMAT = 1

Kind = Literal["empty", "dark"]


@dataclass(frozen=True, eq=False)
class Correction:
    """Offset and gain of each cell."""

    dark: Values
    gain: Values

    def apply(self, light: Values) -> Values:
        """Calibrated values, 0 to 255, shape `(..., cells)`."""
        values: Values = (light - self.dark) * self.gain
        return np.clip(values, np.float32(0), np.float32(255), out=values)


@dataclass(frozen=True, eq=False)
class Calibration:
    """References of one fingertip; `None`: not measured."""

    device_id: str
    design_hash: str
    empty: Values | None = None
    """Light of each cell with nothing in the grasp, shape `(cells,)`, 255 is full light."""
    dark: Values | None = None
    """The same in the dark."""

    def __repr__(self) -> str:
        return one_line(self)

    def __post_init__(self) -> None:
        for name in ("empty", "dark"):
            reference = getattr(self, name)
            if reference is None:
                continue
            values = arguments.numbers(reference, name, CalibrationError).astype(np.float32)
            if values.ndim != 1 or not np.isfinite(values).all():
                raise CalibrationError(
                    f"{name} is {shown(reference)}; a finite number for each cell is needed"
                )
            object.__setattr__(self, name, values)

    def correction(self) -> Correction | None:
        """Offset and gain of each cell; `None` without any reference.

        Raises:
            CalibrationError: if a cell is not lighter with an empty grasp than in the dark.
        """
        reference = self.empty if self.empty is not None else self.dark
        if reference is None:
            return None
        dark = self.dark if self.dark is not None else np.zeros_like(reference)
        empty = self.empty if self.empty is not None else np.full_like(reference, 255)
        if (blind := np.flatnonzero(empty <= dark)).size:
            raise CalibrationError(
                f"{named(blind, dark.size)}: not lighter with an empty grasp than in the dark. "
                "Tare again"
            )
        return Correction(dark, np.float32(255) / (empty - dark))

    def measured(self, kind: Kind, light: Values) -> "Calibration":
        """This calibration with one reference replaced.

        Args:
            kind: of the reference.
            light: several frames, not calibrated, shape `(n, cells)`.

        Raises:
            CalibrationError: if values move, or have too little or too much light.
        """
        mean: Values = light.mean(axis=0, dtype=np.float64).astype(np.float32)
        moving = np.flatnonzero(light.std(axis=0) > _MOST_NOISE)
        if moving.size:
            raise CalibrationError(
                f"{named(moving, mean.size)}: the noise is above {_MOST_NOISE:g} of 255. Hold the "
                "fingers still and open, away from flickering light"
            )
        if kind == "dark" and (bright := np.flatnonzero(mean > _MOST_DARK)).size:
            raise CalibrationError(
                f"{named(bright, mean.size)}: the light is above {_MOST_DARK:g} of 255. Cover the "
                "whole fingertip, or switch the emitter off"
            )
        calibration = replace(self, empty=mean) if kind == "empty" else replace(self, dark=mean)
        dark = calibration.dark if calibration.dark is not None else np.zeros_like(mean)
        if calibration.empty is not None:
            span = calibration.empty - dark
            least = max(_LEAST_SPAN, _LEAST_SHARE * float(np.median(span)))
            if (poor := np.flatnonzero(span < least)).size:
                raise CalibrationError(
                    f"{named(poor, mean.size)}: the empty grasp is less than {least:.0f} of 255 "
                    "lighter than the dark. Is the grasp empty? `lumitip doctor` tests each cell"
                )
        return calibration

    def check(self, device_id: str, design_hash: str, cells: int | None = None) -> None:
        """Reject another fingertip.

        Raises:
            CalibrationMismatch: if device, design or number of cells differ.
        """
        sizes = {reference.size for reference in (self.empty, self.dark) if reference is not None}
        if cells is not None and sizes - {cells}:
            raise CalibrationMismatch(
                f"the calibration has {max(sizes - {cells})} cells; the fingertip has {cells}. "
                "Tare this fingertip"
            )
        if self.design_hash != design_hash:
            raise CalibrationMismatch(
                f"the calibration has design {self.design_hash[:16]}; the fingertip has design "
                f"{design_hash[:16]}. Tare this fingertip"
            )
        if self.device_id != device_id:
            raise CalibrationMismatch(
                f"the calibration is of {self.device_id!r}; the fingertip is {device_id!r}. "
                "Tare this fingertip"
            )

    def save(self, folder: Path | None = None) -> Path:
        """Save it in the user's data folder or in `folder`.

        Raises:
            CalibrationError: if it cannot be written.
        """
        path = _path(self.device_id, self.design_hash, folder)
        record = {
            "format": _FORMAT,
            "device_id": self.device_id,
            "design_hash": self.design_hash,
            "empty": _listed(self.empty),
            "dark": _listed(self.dark),
        }
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            fresh = path.with_suffix(".new")
            fresh.write_text(json.dumps(record) + "\n", encoding="utf-8")
            fresh.replace(path)
        except OSError as error:
            raise CalibrationError(f"{path}: cannot be written: {error}") from error
        return path

    @classmethod
    def load(cls, path: str | Path) -> "Calibration":
        """Read a calibration.

        Raises:
            CalibrationError: if the file cannot be read or is not a calibration.
        """
        try:
            record = json.loads(Path(path).read_text(encoding="utf-8"))
            if record["format"] != _FORMAT:
                raise ValueError(f"format is {record['format']}; this lumitip reads {_FORMAT}")
            found = cls(
                str(record["device_id"]),
                str(record["design_hash"]),
                record["empty"],
                record["dark"],
            )
            found.correction()
            return found
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise CalibrationError(
                f"{path}: cannot be read as a calibration: {error}. Delete it and tare again"
            ) from error

    @classmethod
    def kept(
        cls, device_id: str, design_hash: str, cells: int, folder: Path | None = None
    ) -> "Calibration":
        """The saved calibration of this fingertip, or an empty one.

        Raises:
            CalibrationError: if there is one that cannot be used.
        """
        path = _path(device_id, design_hash, folder)
        try:
            path.stat()
        except FileNotFoundError:
            return cls(device_id, design_hash)
        except OSError:
            pass  # `load` says why it cannot be read
        found = cls.load(path)
        found.check(device_id, design_hash)
        for reference in (found.empty, found.dark):
            if reference is not None and reference.shape != (cells,):
                raise CalibrationError(f"{path}: not of {cells} cells. Delete it and tare again")
        return found

    def forget(self, folder: Path | None = None) -> None:
        """Delete the saved calibration of this fingertip.

        Raises:
            CalibrationError: if it cannot be deleted.
        """
        path = _path(self.device_id, self.design_hash, folder)
        try:
            path.unlink(missing_ok=True)
        except OSError as error:
            raise CalibrationError(f"{path}: cannot be deleted: {error}") from error


def checked_kind(value: object) -> Kind:
    """The kind of a reference.

    Raises:
        ArgumentError: if it is unknown.
    """
    for kind in get_args(Kind):
        if isinstance(value, str) and value == kind:
            return kind  # type: ignore[no-any-return]
    raise ArgumentError(f"kind is {shown(value)}; allowed are {', '.join(get_args(Kind))}")


def user_folder() -> Path:
    """The user's data folder by the rules of XDG, macOS or Windows.

    Raises:
        CalibrationError: if there is no such folder.
    """
    variable = {"win32": "LOCALAPPDATA", "darwin": ""}.get(sys.platform, "XDG_DATA_HOME")
    if folder := os.environ.get(variable):
        return Path(folder) / "lumitip"
    below = {"win32": "AppData/Local", "darwin": "Library/Application Support"}
    try:
        return Path.home() / below.get(sys.platform, ".local/share") / "lumitip"
    except RuntimeError as error:
        raise CalibrationError(
            f"no folder for calibrations. Set {variable or 'HOME'} to a folder of this user"
        ) from error


def file_name(device_id: str, design_hash: str) -> str:
    """Name of the file that belongs to a device of a design."""
    # Other characters become their code, so that two devices never share a file.
    name = re.sub(r"[^A-Za-z0-9-]", lambda m: f"_{ord(m[0]):02x}", device_id)
    return f"{name}.{design_hash[:16]}.json"


def _path(device_id: str, design_hash: str, folder: Path | None) -> Path:
    return (folder or user_folder() / "calibration") / file_name(device_id, design_hash)


def named(which: np.ndarray[tuple[int], np.dtype[np.int64]], cells: int) -> str:
    """Some of all cells, in a few words: what to do comes after them."""
    if which.size == cells > 1:
        return f"all {cells} cells"
    if which.size <= _MOST_LISTED:
        return f"cell{'s' if which.size > 1 else ''} {', '.join(map(str, which))}"
    return f"cells {', '.join(map(str, which[:3]))} and {which.size - 3} others"


def _listed(values: Values | None) -> list[float] | None:
    return None if values is None else [round(float(v), 4) for v in values]
