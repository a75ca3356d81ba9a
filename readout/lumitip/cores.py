"""Work on all cores of this computer."""

import multiprocessing
import os
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager

_THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


@contextmanager
def workers(most: int) -> Iterator[ProcessPoolExecutor]:
    """Fresh processes, one for each core but no more than `most`; what is left undone at the end
    is dropped.

    Linear algebra asks for no further threads in them: as many as there are cores would wait for
    each other. A program that calls this needs `if __name__ == "__main__"`.
    """
    context = multiprocessing.get_context("spawn")
    with _single_threaded():
        pool = ProcessPoolExecutor(min(most, os.cpu_count() or 1), mp_context=context)
        try:
            yield pool
        finally:
            pool.shutdown(cancel_futures=True)


@contextmanager
def _single_threaded() -> Iterator[None]:
    before = {name: os.environ.get(name) for name in _THREADS}
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
