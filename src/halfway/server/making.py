"""What is dear is computed once, on a thread of its own: who asks for it waits as long as they have patience, and is told how far it is."""

import threading
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future
from itertools import count
from typing import Generic, TypeVar

from ..tasks import Track
from .schema import ProgressView

T = TypeVar("T")
R = TypeVar("R")


class NotYetError(Exception):
    """An answer is being computed; ``progress`` says how far it is, where that is known."""

    def __init__(self, progress: ProgressView | None) -> None:
        super().__init__("The server is computing what this needs: ask again.")
        self.progress = progress


class Progress:
    """A `Track` that remembers what was begun last and how far it is, and tells another one."""

    def __init__(self, beside: Track) -> None:
        self._beside = beside
        self._running: dict[int, ProgressView] = {}
        self._keys = count()

    def __call__(self, items: Iterable[R], label: str, total: int) -> Iterator[R]:
        start = time.monotonic()
        key = next(self._keys)
        self._running[key] = ProgressView(label=label, done=0, total=total, seconds=0)
        try:
            for i, item in enumerate(self._beside(items, label, total), start=1):
                seconds = time.monotonic() - start
                self._running[key] = ProgressView(label=label, done=i, total=total, seconds=seconds)
                yield item
        finally:
            del self._running[key]

    @property
    def now(self) -> ProgressView | None:
        """How far it is; None when nothing runs that says so."""
        return next(reversed(list(self._running.values())), None)


class Once(Generic[T]):
    """What ``compute`` gives, computed when it is first asked for; a failure is told to who waits for it, and tried again for who asks later."""

    def __init__(self, compute: Callable[[], T], progress: Progress) -> None:
        self._compute = compute
        self._progress = progress
        self._lock = threading.Lock()
        self._future: Future[T] | None = None

    def get(self, patience: float | None) -> T:
        """The value, within so many seconds (None: however long it takes), or a `NotYetError`."""
        with self._lock:
            future = self._future
            if future is None or (future.done() and future.exception() is not None):
                future = self._future = Future[T]()
                threading.Thread(target=self._run, args=[future], daemon=True).start()
        try:
            return future.result(patience)
        except TimeoutError:
            if future.done():
                raise
            raise NotYetError(self._progress.now) from None

    def _run(self, future: Future[T]) -> None:
        try:
            future.set_result(self._compute())
        except BaseException as error:
            future.set_exception(error)
