"""`Unfinished`: a build that writes says so before, so that nothing old is taken for new, and the
next build clears away what an interrupted one left."""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from lumitip_fab.pipeline import manifest
from lumitip_fab.pipeline.artefact import Artefact

_NOBODY = ""  # no task: the file belongs to no step that could keep it
_PAGE = """<!DOCTYPE html>
<html lang="en">
<meta charset="utf-8">
<meta http-equiv="refresh" content="2">
<title>Not written yet</title>
<p>The files in this folder were built anew, and this page is not. It is written by
<code>make outputs</code>, or by <code>lumitip-fab page --out</code> with this folder.</p>
</html>
"""


class Unfinished:
    """Marks of a build in an output folder until its own manifest is written."""

    def __init__(self, out: Path, before: manifest.Manifest) -> None:
        """Nothing is marked yet.

        Args:
            out: the folder.
            before: its manifest.
        """
        self._out, self._before = out, before
        self._own = bool(before.files)  # else page and results are somebody else's
        self._begun = False

    def announce(self, changed: Iterable[Artefact]) -> None:
        """Before files are written that change: the reports on the old ones are void, and new ones
        stand in the manifest, which has no origin until the build ends."""
        entries = {
            a.path: manifest.entry(a, _NOBODY) for a in changed if a.path not in self._before.files
        }
        if self._begun and not entries:
            return
        self._before = replace(
            self._before, files=self._before.files | entries, origin=manifest.Origin()
        )
        manifest.write(self._out, self._before)
        if self._own and not self._begun:
            self._void_reports()
        self._begun = True

    def _void_reports(self) -> None:
        for name in manifest.RESULTS:
            (self._out / name).unlink(missing_ok=True)
        if (self._out / manifest.PAGE).exists():
            manifest.write_file(self._out / manifest.PAGE, _PAGE.encode())
