"""The sheet that every schematic grows from, `template.kicad_sch`, opened with kicad-skip.

The library has no types: what it gives is `Any` here, in `writer.py` and in `as_node`.
"""

import logging
import warnings
from pathlib import Path
from typing import Any

from lumitip_fab.boards.kicad.sexpr import Node, as_node

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # of escapes in its source, where Python has to compile it
    from skip import Schematic
logging.getLogger("skip").setLevel(logging.WARNING)  # below, it logs every copy


class Template:
    """A sheet with one of each thing, which is copied as often as it is drawn.

    Attributes:
        sheet: kicad-skip's view of the whole sheet.
    """

    def __init__(self) -> None:
        self.sheet: Any = Schematic(str(Path(__file__).with_name("template.kicad_sch")))
        self._order = {thing[0]: i for i, thing in enumerate(self.sheet.tree[1:])}
        drawn = ("junction", "wire", "text", "global_label", "symbol")
        self._patterns: dict[str, Any] = {kind: getattr(self.sheet, kind)[0] for kind in drawn}
        self._patterns["polyline"] = self.sheet.polyline
        self._patterns["path"] = self.sheet.symbol_instances.path

    def copy(self, kind: str) -> Any:
        """Another thing of a kind; a `path` is a symbol's entry in the list at the end.

        Its identifiers are random: give it others.
        """
        return self._patterns[kind].clone()

    def finished(self, library: tuple[Node, ...]) -> Node:
        """The whole sheet without the things that were only there to be copied.

        Args:
            library: symbols that are drawn on the sheet.
        """
        for pattern in self._patterns.values():
            pattern.delete()
        things = [thing for thing in self.sheet.tree[1:] if thing is not None]
        things.sort(key=lambda thing: self._order[thing[0]])  # copies stand at the end
        return (
            "kicad_sch",
            *(
                (*as_node(thing), *library) if thing[0].value() == "lib_symbols" else as_node(thing)
                for thing in things
            ),
        )
