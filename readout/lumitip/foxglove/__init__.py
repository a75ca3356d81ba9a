"""Recordings as one MCAP file that Foxglove draws: cells, contact and estimate of every fingertip
beside its raw codes.

write_scene("scene.mcap", {"left": "left.mcap", "right": "right.mcap"})
"""

from lumitip.errors import MissingExtra

try:
    from lumitip.foxglove.names import by_name
    from lumitip.foxglove.scene import FoxgloveError, Written, write_scene
except ModuleNotFoundError as error:
    if (error.name or "").partition(".")[0] not in (
        "foxglove_schemas_protobuf",
        "google",
        "mcap",
        "mcap_protobuf",
        "zstandard",
    ):
        raise
    raise MissingExtra("foxglove", "the file for Foxglove") from error
from lumitip.foxglove.panels import panels

__all__ = ["FoxgloveError", "Written", "by_name", "panels", "write_scene"]
