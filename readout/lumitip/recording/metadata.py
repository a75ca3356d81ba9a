"""Metadata of a recording. They are written first, so that they survive damage."""

import json
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import version

from lumitip import arguments
from lumitip.calibration import Calibration
from lumitip.errors import LayoutError
from lumitip.frame import RecordedFrame, Values, complement
from lumitip.layout import Layout
from lumitip.recording.message import RecordingError

NAME = "lumitip"
FINGER = "finger"
"""Key of the name of a fingertip, in a file with several."""
FORMAT = "1"

_YEAR_5000 = 1e11


@dataclass(frozen=True, eq=False)
class Metadata:
    """Layout, device, calibration and versions of a recording."""

    layout: Layout
    device_id: str
    calibration: Calibration | None
    """At the start; recorded values are raw."""
    start_wall: float
    """Start of the recording, seconds since 1970 (UTC)."""
    versions: Mapping[str, str]
    """Versions of lumitip, numpy, mcap and Python."""

    def values(self, frame: RecordedFrame) -> Values:
        """Light of a frame with the calibration of the recording, 255 is full light."""
        light = complement(frame.raw, frame.bits)
        correction = self.calibration.correction() if self.calibration else None
        return correction.apply(light) if correction else light

    def to_texts(self) -> dict[str, str]:
        """Texts by name, for MCAP."""
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
        """Parse the result of `to_texts`.

        Raises:
            RecordingError: if a text is missing or wrong.
        """
        try:
            if texts["format"] != FORMAT:
                raise RecordingError(
                    f"format is {texts['format']!r:.40}; this lumitip reads {FORMAT}. Install the "
                    "lumitip that wrote the recording"
                )
            layout = Layout.from_json(texts["layout"])
            start_wall = checked_start(float(texts["start_wall"]))
            versions = {str(k): str(v) for k, v in dict(json.loads(texts["versions"])).items()}
            device_id = texts["device_id"]
            calibration = _calibration(texts["calibration"], device_id, layout)
        except KeyError as error:
            raise RecordingError(f"the recording has no {error.args[0]}") from error
        except (LayoutError, ValueError, TypeError, RecursionError, OverflowError) as error:
            raise RecordingError(f"the recording's metadata cannot be read: {error}") from error
        return cls(layout, device_id, calibration, start_wall, versions)


def checked_start(start_wall: float) -> float:
    """The start of a recording, if it is plausible.

    Raises:
        RecordingError: if it is not.
    """
    return arguments.number(start_wall, "start_wall", 0.0, _YEAR_5000, error=RecordingError)


def versions() -> dict[str, str]:
    """Versions of lumitip, numpy, mcap and Python."""
    packages = {name: version(name) for name in ("lumitip", "mcap", "numpy")}
    return packages | {"python": ".".join(map(str, sys.version_info[:3]))}


def _calibration_text(calibration: Calibration | None) -> str:
    if calibration is None:
        return "null"
    references = {"empty": calibration.empty, "dark": calibration.dark}
    return json.dumps({k: None if v is None else v.tolist() for k, v in references.items()})


def _calibration(text: str, device_id: str, layout: Layout) -> Calibration | None:
    references = json.loads(text)
    if references is None:
        return None
    if not isinstance(references, dict):
        raise ValueError("calibration: an object is needed")
    empty, dark = references.get("empty"), references.get("dark")
    calibration = Calibration(device_id, layout.design_hash, empty, dark)
    calibration.check(device_id, layout.design_hash, len(layout))
    calibration.correction()
    return calibration
