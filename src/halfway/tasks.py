"""One way to do many things at once: ``work.run(f, tasks)``.

Tasks are pure functions of small arguments (paths, column ranges, recipes); results come back in the order of the
tasks, so a sum over them does not depend on who finished first. An `Engine` says where they run: `Threads` of this
process by default, or a `halfway.cluster.Cluster`. The bytes of the results are the same.

BLAS runs at one thread inside a task: two threads per task on a busy machine were 10 to 20 times slower than one.
"""

import os
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, TypeVar, runtime_checkable

from threadpoolctl import threadpool_limits

from .cache import cached

if TYPE_CHECKING:
    import numpy as np

T = TypeVar("T")
R = TypeVar("R")


@runtime_checkable
class Track(Protocol):
    """Shows how far an iteration is; the command line brings a progress bar."""

    def __call__(self, items: Iterable[R], label: str, total: int) -> Iterable[R]: ...


def silent(items: Iterable[R], label: str, total: int) -> Iterable[R]:  # noqa: ARG001
    """The `Track` that shows nothing."""
    return items


class Engine(ABC):
    """Where tasks run."""

    @abstractmethod
    def map(self, f: Callable[[T], R], tasks: Sequence[T]) -> Iterator[R]:
        """``f`` of every task, in order; at most a few results wait at any time."""


@dataclass(frozen=True)
class Threads(Engine):
    """A pool of threads of this process, one per core unless told otherwise."""

    n_threads: int = 0

    def map(self, f: Callable[[T], R], tasks: Sequence[T]) -> Iterator[R]:
        """``f`` of every task, in order; one or two more results are held than there are threads."""
        n_threads = self.n_threads or os.cpu_count() or 1
        waiting: deque[Future[R]] = deque()
        with threadpool_limits(1, "blas"), ThreadPoolExecutor(n_threads) as pool:
            try:
                for task in tasks:
                    waiting.append(pool.submit(f, task))
                    if len(waiting) > n_threads + 1:
                        yield waiting.popleft().result()
                while waiting:
                    yield waiting.popleft().result()
            finally:
                pool.shutdown(wait=True, cancel_futures=True)


@dataclass(frozen=True)
class Work:
    """How long work is done: where its tasks run, who sees how far it is, where dear results are kept."""

    engine: Engine = Threads()
    track: Track = silent
    cache: Path | None = None
    """A folder for results that are small and dear; None keeps nothing."""

    def run(self, f: Callable[[T], R], tasks: Sequence[T], *, label: str = "") -> Iterator[R]:
        """``f`` of every task, in order, on the engine.

        On a cluster ``f`` and the tasks are pickled: ``f`` is a function of a module, or a `functools.partial` of one whose
        arguments it shares between the tasks, and each worker gets those once.
        """
        yield from self.track(self.engine.map(f, tasks), label, len(tasks))

    def cached(
        self, key: str, compute: "Callable[[], dict[str, np.ndarray]]"
    ) -> "dict[str, np.ndarray]":
        """The arrays that ``compute`` gives, from the cache folder when it has them under ``key``."""
        return compute() if self.cache is None else cached(self.cache, key, compute)


HERE = Work()
"""Threads of this process, in silence; nothing is kept."""
