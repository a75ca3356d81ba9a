"""Version and date of the newest release, as CHANGELOG.md states them."""

import re
from datetime import UTC, date, datetime
from pathlib import Path

_HEADING = re.compile(r"^## \[(\d+\.\d+\.\d+)\] - (\d{4}-\d{2}-\d{2})$", re.MULTILINE)


class ReleaseError(Exception):
    """A file of the release lacks something; the message says what to do."""


def newest_release(root: Path) -> tuple[str, date]:
    """Version and date of the first release in CHANGELOG.md.

    Raises:
        ReleaseError: if it has no heading of a release.
    """
    found = _HEADING.search((root / "CHANGELOG.md").read_text(encoding="utf-8"))
    if not found:
        raise ReleaseError("CHANGELOG.md has no heading such as '## [1.2.3] - 2030-12-31'. Add it.")
    return found[1], date.fromisoformat(found[2])


def release_time_s(root: Path) -> int:
    """Midnight (UTC) of the newest release's date, in seconds since 1970: the time of all files
    in the distributions."""
    _, day = newest_release(root)
    return int(datetime(day.year, day.month, day.day, tzinfo=UTC).timestamp())
