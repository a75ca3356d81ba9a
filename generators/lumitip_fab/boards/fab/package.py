"""One zip to order a board with: layers, drills, parts, their places, and which way round."""

import io
import zipfile

from lumitip_fab.boards.fab.lists import bill_of_materials, placement_list
from lumitip_fab.boards.gerber.drills import plated_drills, unplated_drills
from lumitip_fab.boards.gerber.layers import gerber_layers
from lumitip_fab.boards.model import BoardModel
from lumitip_fab.design import Fab

_EPOCH = (1980, 1, 1, 0, 0, 0)
_MODE = 0o644 << 16


def layers_of(model: BoardModel) -> dict[str, bytes]:
    """Every layer and drill file by its key in the table of board houses."""
    layers = {layer.key: layer.data for layer in gerber_layers(model)}
    return layers | {"plated": plated_drills(model), "unplated": unplated_drills(model)}


def order_files(
    model: BoardModel, layers: dict[str, bytes], note: bytes, fab: Fab, stem: str
) -> dict[str, bytes]:
    """The zip for a board house, and its two tables once more by themselves.

    Args:
        model: the finished board.
        layers: from `layers_of`.
        note: for who places the parts.
        fab: the board house.
        stem: what the files' names begin with.
    """
    board = model.placement
    tables = {
        f"{stem}_bom.csv": bill_of_materials(board, fab),
        f"{stem}_positions.csv": placement_list(board, fab),
    }
    files = {stem + ending: layers[layer] for layer, ending in fab.layers if layer in layers}
    files[f"{stem}_assembly.txt"] = note
    told = {f"{fab.name}_{name}": data for name, data in tables.items()}
    return {
        f"{fab.name}_{stem}.zip": _zipped(files | tables),
        **told,
    }


def _zipped(files: dict[str, bytes]) -> bytes:
    """A zip that is the same whenever and wherever it is made."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as package:
        for name in sorted(files):
            entry = zipfile.ZipInfo(name, _EPOCH)
            entry.compress_type, entry.external_attr, entry.create_system = (
                zipfile.ZIP_DEFLATED, _MODE, 3,
            )  # fmt: skip
            package.writestr(entry, files[name])
    return packed.getvalue()
