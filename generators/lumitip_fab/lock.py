"""One build at a time in an output folder."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from lumitip_fab.errors import OutputError

try:
    import fcntl
except ImportError:  # Windows has no advisory locks on folders; there nothing is locked
    fcntl = None  # type: ignore[assignment]


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold a folder, which is made if missing; leaves no file behind, even when killed.

    Raises:
        OutputError: if another build holds it.
    """
    folder.mkdir(parents=True, exist_ok=True)
    if fcntl is None:
        yield
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        yield
    except BlockingIOError as error:
        raise OutputError(
            f"{folder}: another build is writing there: wait for it, or stop it (is `make watch` "
            "running?)"
        ) from error
    finally:
        os.close(handle)
