"""What a recording says about itself: written first, so that it survives whatever follows."""

import json
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import version

import numpy as np

from lumitip import arguments
from lumitip.calibration import Calibration
from lumitip.errors import LayoutError
from lumitip.frame import Values, complement
from lumitip.layout import Layout
from lumitip.recording.message import RecordedFrame, RecordingError

NAME = "lumitip"
FORMAT = "1"

_YEAR_5000 = 1e11


@dataclass(frozen=True, eq=False)
class Metadata:
    """About a recording."""

    layout: Layout
    device_id: str
    calibration: Calibration | None
    """In force when the recording began; the values recorded are raw."""
    start_wall: float
    """When the recording began, seconds since 1970 (UTC)."""
    versions: Mapping[str, str]
    """Of lumitip and what it ran on."""

    def values(self, frame: RecordedFrame) -> Values:
        """Light of a frame, calibrated as when it was recorded, 255 is full light."""
        light = complement(frame.raw, frame.bits)
        correction = self.calibration.correction() if self.calibration else None
        return correction.apply(light) if correction else light

    def to_texts(self) -> dict[str, str]:
        """As MCAP keeps it: texts by name."""
        return {
            "format": FORMAT,
            "device_id": self.device_id,
            "design_hash": self.layout.design_hash,
            "start_wall": repr(self.start_wall),
            "versions": json.dumps(dict(self.versions), sort_keys=True),
            "calibration": _calibration_text(self.calibration),
            "layout": self.layout.to_json(),
        }

    @classmethod
    def from_texts(cls, texts: Mapping[str, str]) -> "Metadata":
        """Read what `to_texts` gave.

        Raises:
            RecordingError: if something is missing or wrong.
        """
        try:
            if texts["format"] != FORMAT:
                raise RecordingError(
                    f"format {texts['format']!r:.40} given, this version reads {FORMAT}: install "
                    "the lumitip that made the recording"
                )
            layout = Layout.from_json(texts["layout"])
            start_wall = begun(float(texts["start_wall"]))
            versions = {str(k): str(v) for k, v in dict(json.loads(texts["versions"])).items()}
            device_id = texts["device_id"]
            calibration = _calibration(texts["calibration"], device_id, layout)
        except KeyError as error:
            raise RecordingError(f"the recording does not tell its {error.args[0]}") from error
        except (LayoutError, ValueError, TypeError, RecursionError, OverflowError) as error:
            raise RecordingError(f"the recording's metadata cannot be read: {error}") from error
        return cls(layout, device_id, calibration, start_wall, versions)


def begun(start_wall: float) -> float:
    """When a recording began, if it can have been then.

    Raises:
        RecordingError: if not.
    """
    return arguments.number(start_wall, "start_wall", 0.0, _YEAR_5000, error=RecordingError)


def versions() -> dict[str, str]:
    """Of lumitip and what it runs on."""
    packages = {name: version(name) for name in ("lumitip", "mcap", "numpy")}
    return packages | {"python": ".".join(map(str, sys.version_info[:3]))}


def _calibration_text(calibration: Calibration | None) -> str:
    if calibration is None:
        return "null"
    told = {"empty": calibration.empty, "dark": calibration.dark}
    return json.dumps({k: None if v is None else v.tolist() for k, v in told.items()})


def _calibration(text: str, device_id: str, layout: Layout) -> Calibration | None:
    told = json.loads(text)
    if told is None:
        return None
    found = Calibration(
        device_id,
        layout.design_hash,
        _values(told.get("empty"), len(layout)),
        _values(told.get("dark"), len(layout)),
    )
    found.correction()
    return found


def _values(told: object, cells: int) -> Values | None:
    if told is None:
        return None
    values: Values = np.array(told, dtype=np.float32)
    if values.shape != (cells,) or not np.isfinite(values).all():
        raise ValueError(f"a calibration of {cells} numbers is needed")
    return values
