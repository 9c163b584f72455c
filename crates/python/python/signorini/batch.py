"""Many runs at once."""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Iterable
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from typing import TYPE_CHECKING, Literal

from .result import Result, run

if TYPE_CHECKING:
    from .case import Case

LOOK = 0.1
"""Seconds between looks for Ctrl-C."""


def run_many(
    cases: Iterable[Case],
    *,
    save: bool = False,
    output: str | os.PathLike[str] | None = None,
    workers: int | None = None,
    threads: int | None = None,
    on_error: Literal["keep", "raise"] = "keep",
    progress: bool | None = None,
) -> list[Result]:
    """Runs cases at the same time and returns their results in order.

    Parameters
    ----------
    save, output: whether results are written, to `output/000`, `output/001`, …; a given `output` saves
    workers: how many run at a time; absent: as many as there are cores. threads: of each run; absent: its share
    on_error: "keep": a run that fails is a result with `ok == False`, its error in `error` and its converged frames;
        "raise": the first failure is raised, and the other runs stop

    Ctrl-C stops all runs within an iteration, and is raised.
    """
    from .case import Case

    cases = list(cases)
    for index, case in enumerate(cases):
        if not isinstance(case, Case):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise TypeError(f"run_many takes a list of cases, found {case!r} at index {index}")
    cores = os.cpu_count() or 1
    workers = max(1, min(len(cases) or 1, workers or cores))
    threads = threads or max(1, cores // workers)
    folder = os.fspath(output) if output is not None else "signorini.out" if save else None
    stop = threading.Event()
    shown = _Counter(len(cases), progress)

    def one(index: int, case: Case) -> Result:
        if stop.is_set():
            return Result(status="not started", exit_code=130)
        place = None if folder is None else os.path.join(folder, f"{index:03d}")
        # the interpreter is asked once per iteration whether to go on
        return run(case, place, threads=threads, progress=False, on_iteration=lambda _: stop.is_set())

    pool = ThreadPoolExecutor(workers, thread_name_prefix="signorini")
    futures: list[Future[Result]] = []
    try:
        futures = [pool.submit(one, index, case) for index, case in enumerate(cases)]
        left = set(futures)
        while left:
            done, left = wait(left, LOOK, FIRST_COMPLETED)
            shown.show(len(cases) - len(left))
            failed = [error for future in done if (error := future.exception()) is not None]
            if failed and on_error == "raise":
                raise failed[0]
    except BaseException:
        stop.set()
        for future in futures:
            future.cancel()
        raise
    finally:
        pool.shutdown(wait=True)
        shown.close()
    return [_kept(future) for future in futures]


def _kept(future: Future[Result]) -> Result:
    error = future.exception()
    return future.result() if error is None else Result.failed(error)


class _Counter:
    """How many runs are done, in a terminal."""

    def __init__(self, count: int, progress: bool | None) -> None:
        self._count = count
        self._is_shown = sys.stderr.isatty() if progress is None else progress

    def show(self, done: int) -> None:
        if self._is_shown:
            print(f"\r {done} of {self._count} runs", end="", file=sys.stderr, flush=True)

    def close(self) -> None:
        if self._is_shown:
            print(file=sys.stderr)
