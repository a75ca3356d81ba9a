"""Where a line of a table is shown: names of bodies, parts, nets, boards, masks and wires of the
page.

A body of the 3D view and a part of a board have the same name, such as `emitter.D18`; a net of a
board is `emitter:Q18`.
"""

import re
from collections.abc import Collection, Iterable, Iterator
from pathlib import Path
from string import digits

from lumitip_fab.site.boards import drawn_parts
from lumitip_fab.site.folder import Folder, board_path

_REFERENCE = re.compile(r"\b[A-Z]{1,3}\d+\b")
_NODE = re.compile(r"\b(?:emitter|receiver|flange|holder|gripper|coupling|robot)\.[A-Za-z]\w*")
_FINGER = re.compile(r"\b(emitter|receiver)\b")
_PLACE = re.compile(r"at \((-?[\d.]+), (-?[\d.]+), (-?[\d.]+)\) of the file's frame")
_PRINT = re.compile(r"[\w./-]+\.(?:stl|3mf)\b")
_WORD = re.compile(r"[^\s,;:()]+")
_EVERYWHERE = "GND"
"""Its fills are all over each board."""
_SCENES = ("assembly", "robot")
"""Folders of files with all bodies of both fingers."""
_OF_BREAKOUT = "holder.board"
"""The breakout lies in the holder."""


class Targets:
    """Names of what an output folder has."""

    def __init__(self, folder: Folder, printed: Collection[str]) -> None:
        """Collect the names.

        Args:
            folder: the output folder.
            printed: STL of the printed parts.
        """
        design = folder.design
        self.fingers = [finger.name for finger in design.fingers]
        letters = {finger.name: finger.cells_hold.letter for finger in design.fingers}
        self._elsewhere = {
            finger: {letter for other, letter in letters.items() if other != finger}
            for finger in letters
        }
        """Letters of the cells of the other finger."""
        auxiliary = [board.name for board in design.auxiliary_boards]
        self.printed = printed
        self.boards = [*self.fingers, *auxiliary]
        self.references = {
            board: {part.ref for part in folder.board(board).parts} for board in self.boards
        }
        self._nets = {
            board: {piece.net for piece in folder.board(board).copper()} - {"", _EVERYWHERE}
            for board in self.boards
        }
        self._modelled = [
            (Path(model.path).stem, f"{board}.{part.ref}")
            for board in self.boards
            for part in folder.board(board).parts
            for model in part.models
        ]
        self._parts = {
            board: folder.facts(board_path(board)).get("parts", ()) for board in self.boards
        }
        self._panels = {
            *folder.scene.nodes,
            *(f"{b}.{ref}" for b in self.boards for ref in drawn_parts(folder.board(b))),
            *(f"board.{board}" for board in self.boards),
            *(f"{board}:{net}" for board, nets in self._nets.items() for net in nets),
            *(f"mask.{finger}" for finger in self.fingers),
            *(f"print.{path}" for path in printed),
            "wires",
            "grid",
        }

    def _shown(self, names: Iterable[str]) -> list[str]:
        """Those of some names that a panel of the page has, each once."""
        once = dict.fromkeys(names)
        return [name for name in once if name.partition("@")[0] in self._panels]

    def of_file(self, path: str) -> list[str]:
        """Targets of a file: the part or board that it makes."""
        return self._shown(self._of_file(path))

    def _of_file(self, path: str) -> Iterator[str]:
        folder, _, name = path.partition("/")
        fingers = _FINGER.findall(name.replace("_", " ")) or self.fingers
        if folder in ("backing", "interface"):
            yield from (f"{finger}.{folder}" for finger in fingers)
        elif folder == "mask":
            yield from (f"mask.{finger}" for finger in fingers)
            yield from (f"{finger}.film" for finger in fingers)
        elif folder == "flange":
            halves = [half for half in ("lower", "upper") if half in name]
            yield from (f"flange.{half}" for half in halves or ("lower", "upper"))
        elif folder == "holder":
            yield "holder.tray"
        elif path.startswith("boards/models/"):
            yield from (part for stem, part in self._modelled if stem == Path(path).stem)
        elif folder == "boards":
            yield from self._of_board(name.partition("/")[0])
        elif folder == "wiring":
            yield "wires"
        elif path in ("layout.json", "firmware/layout.h"):
            yield "grid"
        mesh = f"{path.rpartition('.')[0]}.stl"
        if mesh in self.printed:
            yield f"print.{mesh}"

    def of_board(self, name: str) -> list[str]:
        """A bare board."""
        return self._shown(self._of_board(name))

    def _of_board(self, name: str) -> Iterator[str]:
        if name in self.boards:
            yield f"board.{name}"
            yield _OF_BREAKOUT if name == "breakout" else f"{name}.board"

    def of_measurement(self, subject: str, note: str) -> list[str]:
        """Targets of a measurement: parts, bodies and prints that it names, and those of
        its file."""
        file = re.split(r"[:\s]", subject, maxsplit=1)[0]
        rest = f"{subject[len(file) :]} {note}"
        found = _NODE.findall(f"{rest} ")
        if (place := _PLACE.search(note)) and file in self.printed:
            found.insert(0, f"print.{file}@{','.join(place.groups())}")
        board = file.split("/")[1] if file.startswith("boards/") and file.count("/") > 1 else ""
        known = self.references.get(board, set())
        found += [f"{board}.{ref}" for ref in _REFERENCE.findall(rest) if ref in known]
        words = _WORD.findall(rest)
        found += [f"{board}:{word}" for word in words if word in self._nets.get(board, ())]
        if file.startswith(_SCENES):
            found += self._of_scene([*_FINGER.findall(file.replace("_", " ")), *words])
        files = [file, *_PRINT.findall(rest)]
        return self._shown([*found, *(name for each in files for name in self._of_file(each))])

    def _of_scene(self, words: list[str]) -> Iterator[str]:
        """Bodies that are named by their kind; else the backings, which carry all others. Where no
        finger is named, the reference of an LED or photodetector is that of a cell."""
        named = [finger for finger in self.fingers if finger in words]
        elsewhere = {} if named else self._elsewhere
        fingers = named or self.fingers
        kinds = [
            f"{finger}.{word}"
            for finger in fingers
            for word in words
            if word.rstrip(digits) not in elsewhere.get(finger, ())
        ]
        yield from self._shown(kinds) or (f"{finger}.backing" for finger in fingers)

    def of_line(self, group: str, item: str, part: str) -> list[str]:
        """What a line of the bill buys."""
        return self._shown(self._of_line(group, item, part))

    def _of_line(self, group: str, item: str, part: str) -> list[str]:
        if group == "electronics":
            return [
                f"{board}.{ref}"
                for board, parts in self._parts.items()
                for entry in parts
                if entry["part"] == part
                for ref in entry["refs"].split(",")
            ]
        if group == "boards":
            return list(self._of_board(item.removesuffix(" board")))
        if group == "prints":
            return list(self._of_file(item))
        if group == "casting":
            return [f"{finger}.silicone" for finger in self.fingers]
        if group == "mask":
            return [t for f in self.fingers for t in (f"mask.{f}", f"{f}.film")]
        return ["wires"] if group == "wiring" else []
