"""One way to do many things at once: ``run(f, tasks)``.

Tasks are pure functions of small arguments (paths, column ranges); results come back in the order of the tasks, so a
sum over them does not depend on who finished first. BLAS runs at one thread inside: two threads per task on a
busy machine were 10 to 20 times slower than one.
"""

import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Protocol, TypeVar, runtime_checkable

from threadpoolctl import threadpool_limits

T = TypeVar("T")
R = TypeVar("R")


@runtime_checkable
class Track(Protocol):
    """Shows how far an iteration is; the command line brings a progress bar."""

    def __call__(self, items: Iterable[R], label: str, total: int) -> Iterable[R]: ...


def silent(items: Iterable[R], label: str, total: int) -> Iterable[R]:  # noqa: ARG001
    """The `Track` that shows nothing."""
    return items


def run(
    f: Callable[[T], R], tasks: Sequence[T], *, label: str = "", track: Track = silent
) -> Iterator[R]:
    """``f`` of every task, in order, on a pool of threads; at most a few results wait at any time."""
    yield from track(_run(f, tasks), label, len(tasks))


def _run(f: Callable[[T], R], tasks: Sequence[T]) -> Iterator[R]:
    n_workers = os.cpu_count() or 1
    waiting: deque[Future[R]] = deque()
    with threadpool_limits(1, "blas"), ThreadPoolExecutor(n_workers) as pool:
        try:
            for task in tasks:
                waiting.append(pool.submit(f, task))
                if len(waiting) > 2 * n_workers:
                    yield waiting.popleft().result()
            while waiting:
                yield waiting.popleft().result()
        finally:
            pool.shutdown(wait=True, cancel_futures=True)
