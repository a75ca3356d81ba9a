"""What each cell of one fingertip reads in the dark and with an empty grasp, measured and kept.

Cells differ: LEDs, detectors and pull-ups have tolerances. With both references known,

    values = 255 * (light - dark) / (empty - dark), cut to 0..255,

where light is the complement of the raw code. Nothing is scaled frame by frame, so an absolute
intensity stays one.
"""

import json
import os
import re
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal, get_args

import numpy as np

from lumitip import arguments
from lumitip.errors import ArgumentError, CalibrationError, CalibrationMismatch
from lumitip.frame import Values
from lumitip.values import shown

_LEAST_SPAN = 25.5  # a tenth of full light: below it noise would be raised more than tenfold
_LEAST_SHARE = 0.4  # of the median cell: LEDs and detectors spread less, objects cover more
_MOST_DARK = 76.5  # three tenths of full light
_MOST_NOISE = 8.0  # more, and something moves
_FORMAT = 1

Kind = Literal["empty", "dark"]


@dataclass(frozen=True, eq=False)
class Correction:
    """What turns light into calibrated values."""

    dark: Values
    gain: Values

    def apply(self, light: Values) -> Values:
        """Calibrated values of light, shape `(..., cells)`, from 0 to 255."""
        values: Values = (light - self.dark) * self.gain
        return np.clip(values, np.float32(0), np.float32(255), out=values)


@dataclass(frozen=True, eq=False)
class Calibration:
    """References of one fingertip; `None` where one was not measured."""

    device_id: str
    design_hash: str
    empty: Values | None = None
    """Light of each cell with nothing in the grasp, shape `(cells,)`, 255 is full light."""
    dark: Values | None = None
    """The same with all light shut off."""

    def __post_init__(self) -> None:
        for name in ("empty", "dark"):
            told = getattr(self, name)
            if told is None:
                continue
            values = arguments.numbers(told, name, CalibrationError).astype(np.float32)
            if values.ndim != 1 or not np.isfinite(values).all():
                raise CalibrationError(
                    f"{name}: {shown(told)} given, a finite number for each cell is needed"
                )
            object.__setattr__(self, name, values)

    def correction(self) -> Correction | None:
        """What calibrates values; `None` without any reference.

        Raises:
            CalibrationError: if a cell reads no more with an empty grasp than in the dark.
        """
        reference = self.empty if self.empty is not None else self.dark
        if reference is None:
            return None
        dark = self.dark if self.dark is not None else np.zeros_like(reference)
        empty = self.empty if self.empty is not None else np.full_like(reference, 255)
        if (blind := np.flatnonzero(empty <= dark)).size:
            raise CalibrationError(
                f"{_cells(blind)} read no more with an empty grasp than in the dark: tare again"
            )
        return Correction(dark, np.float32(255) / (empty - dark))

    def measured(self, kind: Kind, light: Values) -> "Calibration":
        """This calibration with one reference measured anew.

        Args:
            kind: `"empty"`: nothing in the grasp; `"dark"`: all light shut off.
            light: several frames, not calibrated, shape `(n, cells)`.

        Raises:
            CalibrationError: if cells move, see too little light or too much; nothing changes.
        """
        mean: Values = light.mean(axis=0, dtype=np.float64).astype(np.float32)
        restless = np.flatnonzero(light.std(axis=0) > _MOST_NOISE)
        if restless.size:
            raise CalibrationError(
                f"{_cells(restless)} moved by more than {_MOST_NOISE:g} of 255: hold the fingers "
                "still and open, away from flickering light"
            )
        if kind == "dark" and (bright := np.flatnonzero(mean > _MOST_DARK)).size:
            raise CalibrationError(
                f"{_cells(bright)} see more than {_MOST_DARK:g} of 255: cover the whole fingertip, "
                "or switch the emitter off"
            )
        made = replace(self, empty=mean) if kind == "empty" else replace(self, dark=mean)
        dark = made.dark if made.dark is not None else np.zeros_like(mean)
        if made.empty is not None:
            span = made.empty - dark
            least = max(_LEAST_SPAN, _LEAST_SHARE * float(np.median(span)))
            if (poor := np.flatnonzero(span < least)).size:
                raise CalibrationError(
                    f"{_cells(poor)} gain less than {least:.0f} of 255 from darkness to the empty "
                    "grasp: is the grasp empty? `lumitip doctor` looks at each cell"
                )
        return made

    def check(self, device_id: str, design_hash: str, cells: int | None = None) -> None:
        """Refuse to calibrate another fingertip, of which the number of cells may be told too.

        Raises:
            CalibrationMismatch: naming both.
        """
        sizes = {reference.size for reference in (self.empty, self.dark) if reference is not None}
        if cells is not None and sizes - {cells}:
            raise CalibrationMismatch(
                f"a reference of {max(sizes - {cells})} cells given, the fingertip has {cells}: "
                "tare this fingertip"
            )
        if self.design_hash != design_hash:
            raise CalibrationMismatch(
                f"this calibration is of design {self.design_hash[:16]}, the fingertip of "
                f"{design_hash[:16]}: tare this fingertip"
            )
        if self.device_id != device_id:
            raise CalibrationMismatch(
                f"this calibration is of {self.device_id!r}, the fingertip is {device_id!r}: "
                "tare this fingertip"
            )

    def save(self, folder: Path | None = None) -> Path:
        """Keep it for the next time, in the user's data folder or in `folder`.

        Raises:
            CalibrationError: if it cannot be written.
        """
        path = _path(self.device_id, self.design_hash, folder)
        told = {
            "format": _FORMAT,
            "device_id": self.device_id,
            "design_hash": self.design_hash,
            "empty": _listed(self.empty),
            "dark": _listed(self.dark),
        }
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            fresh = path.with_suffix(".new")
            fresh.write_text(json.dumps(told) + "\n", encoding="utf-8")
            fresh.replace(path)
        except OSError as error:
            raise CalibrationError(f"{path}: cannot be written: {error}") from error
        return path

    @classmethod
    def load(cls, path: str | Path) -> "Calibration":
        """Read a calibration.

        Raises:
            CalibrationError: if the file cannot be read or is none.
        """
        try:
            told = json.loads(Path(path).read_text(encoding="utf-8"))
            if told["format"] != _FORMAT:
                raise ValueError(f"format {told['format']} given, this version reads {_FORMAT}")
            found = cls(
                str(told["device_id"]),
                str(told["design_hash"]),
                _array(told["empty"]),
                _array(told["dark"]),
            )
            found.correction()
            return found
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise CalibrationError(
                f"{path}: cannot be read as a calibration: {error}; delete it and tare again"
            ) from error

    @classmethod
    def kept(
        cls, device_id: str, design_hash: str, cells: int, folder: Path | None = None
    ) -> "Calibration":
        """The one kept for this fingertip, or an empty one.

        Raises:
            CalibrationError: if it is there but cannot be used.
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
                raise CalibrationError(f"{path}: is not of {cells} cells; delete it and tare again")
        return found

    def forget(self, folder: Path | None = None) -> None:
        """Delete what is kept for this fingertip.

        Raises:
            CalibrationError: if it cannot be deleted.
        """
        path = _path(self.device_id, self.design_hash, folder)
        try:
            path.unlink(missing_ok=True)
        except OSError as error:
            raise CalibrationError(f"{path}: cannot be deleted: {error}") from error


def checked_kind(given: object) -> Kind:
    """The kind of a reference.

    Raises:
        ArgumentError: if there is no such kind.
    """
    for kind in get_args(Kind):
        if isinstance(given, str) and given == kind:
            return kind  # type: ignore[no-any-return]
    raise ArgumentError(f"kind: {shown(given)} given, allowed are {', '.join(get_args(Kind))}")


def user_folder() -> Path:
    """Where this computer's user keeps such data: XDG, Apple's or Windows' folder.

    Raises:
        CalibrationError: if neither that nor a home folder is known.
    """
    variable = {"win32": "LOCALAPPDATA", "darwin": ""}.get(sys.platform, "XDG_DATA_HOME")
    if told := os.environ.get(variable):
        return Path(told) / "lumitip"
    below = {"win32": "AppData/Local", "darwin": "Library/Application Support"}
    try:
        return Path.home() / below.get(sys.platform, ".local/share") / "lumitip"
    except RuntimeError as error:
        raise CalibrationError(
            f"no folder for calibrations: set {variable or 'HOME'} to a folder of this user"
        ) from error


def _path(device_id: str, design_hash: str, folder: Path | None) -> Path:
    # Every character that a file name may not have becomes its code, so no two ids share a file.
    name = re.sub(r"[^A-Za-z0-9-]", lambda m: f"_{ord(m[0]):02x}", device_id)
    return (folder or user_folder() / "calibration") / f"{name}.{design_hash[:16]}.json"


def _cells(which: Sequence[int] | np.ndarray[tuple[int], np.dtype[np.int64]]) -> str:
    cells = [int(i) for i in which]
    return f"cell{'s' if len(cells) > 1 else ''} {', '.join(map(str, cells))}"


def _listed(values: Values | None) -> list[float] | None:
    return None if values is None else [round(float(v), 4) for v in values]


def _array(told: object) -> Values | None:
    if told is None:
        return None
    values: Values = np.array(told, dtype=np.float32)
    if values.ndim != 1 or not np.isfinite(values).all():
        raise ValueError("a list of numbers is needed")
    return values
