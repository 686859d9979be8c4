"""Tasks on a cluster: the engine that hands them to a ``dask.distributed`` scheduler.

Workers need this version of halfway, and need to see the files that the tasks name: a file system that is mounted
everywhere, or a URL such as ``s3://bucket/x.brdflib``. What comes back over the network is results, in order: Gram
matrices, pictures, rows of a library that is being built. Tables of a route are written by the workers themselves.

A task whose worker died is done again by another; one that takes four workers with it is given up.
"""

import asyncio
import platform
import time
import warnings
from collections import deque
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import CancelledError, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any, TypeVar

from threadpoolctl import threadpool_limits

from .errors import ClusterError, MissingExtraError
from .tasks import Engine

T = TypeVar("T")
R = TypeVar("R")
Client = Any
"""A ``distributed.Client``; the package is imported when a cluster is used."""

CONNECTION_SECONDS = 5.0
"""How long to wait for a scheduler, and then for its first worker."""
LONELY_SECONDS = 60.0
"""How long to wait for a worker to come when all have gone."""
LOOK_SECONDS = 2.0
"""How often to look whether there are any, while a result is waited for."""


@dataclass(frozen=True, eq=False)
class Cluster(Engine):
    """The workers of a ``distributed.Client``."""

    client: Client

    @classmethod
    @contextmanager
    def at(cls, address: str) -> "Generator[Cluster]":
        """The cluster whose scheduler is at ``address`` (``tcp://host:8786``), for the length of the block.

        Raises
        ------
        ClusterError
            When the scheduler cannot be reached, has no workers, or they have another version of halfway.
        MissingExtraError
            When ``distributed`` is not installed.
        """
        client = _connect(address)
        try:
            _require_workers(client, address)
            _require_same_versions(client, address)
            yield cls(client)
        finally:
            client.close()

    def map(self, f: Callable[[T], R], tasks: Sequence[T]) -> Iterator[R]:
        """``f`` of every task, in order; workers hold at most two results more per thread than they work on.

        Raises
        ------
        ClusterError
            When the scheduler is lost, all workers stay away, or a task kills them.
        """
        n_ahead = 2 * self.client.scheduler_info(n_workers=0)["total_threads"] + 2
        # A task like the others: it goes to each worker once, and is done again where a worker died with it.
        shared = _submit(self.client, _itself, f)
        waiting: deque[Any] = deque()
        try:
            for task in tasks:
                waiting.append(_submit(self.client, _call, shared, task))
                if len(waiting) > n_ahead:
                    yield self._result(waiting.popleft())
            while waiting:
                yield self._result(waiting.popleft())
        finally:
            if self.client.status == "running":
                self.client.cancel([shared, *waiting], force=True)

    def _result(self, future: Any) -> Any:
        from distributed import KilledWorker
        from distributed.client import ClosedClientError
        from distributed.comm.core import CommClosedError

        address = self.client.scheduler.address
        try:
            self._wait(future)
            return future.result()
        except KilledWorker as error:
            raise ClusterError(
                f"{address} lost {error.allowed_failures + 1} workers on one task: expected none to die. See their "
                "logs; most often the memory of a worker is too small."
            ) from None
        except (CancelledError, ClosedClientError, CommClosedError):
            raise ClusterError(
                f"{address} is gone: the scheduler was there when the work began. Start it, and run the same "
                "command again."
            ) from None

    def _wait(self, future: Any) -> None:
        """Until a task is done, in whatever way."""
        from distributed import wait

        seen = time.monotonic()
        while not future.done():
            with suppress(TimeoutError), self.client.as_current():
                wait(future, timeout=LOOK_SECONDS)
            now = time.monotonic()
            if self._has_workers():
                seen = now
            elif now - seen > LONELY_SECONDS:
                raise ClusterError(
                    f"{self.client.scheduler.address} has had no worker for {now - seen:.0f} s: expected some that "
                    "come back. Start workers, and run the same command again."
                )

    def _has_workers(self) -> bool:
        # Of a scheduler that is gone, the tasks themselves tell.
        with suppress(OSError):
            return self.client.scheduler_info(n_workers=0)["n_workers"] > 0
        return True


def _connect(address: str) -> Client:
    try:
        from distributed import Client
    except ImportError:
        raise MissingExtraError(f"the scheduler {address}", "distributed", "dask") from None
    try:
        # A client whose first connection fails leaves threads and messages behind: knock first.
        with ThreadPoolExecutor(1) as pool:
            pool.submit(asyncio.run, _knock(address)).result()
        with warnings.catch_warnings():
            # Versions are compared below, and told in one line.
            warnings.simplefilter("ignore")
            return Client(address, timeout=CONNECTION_SECONDS, set_as_default=False)
    except Exception as error:  # what is no scheduler may answer anything
        reason = str(error) or f"no answer of a scheduler in {CONNECTION_SECONDS:.0f} s"
        raise ClusterError(
            f"{address} cannot be reached ({reason}): expected the address of a Dask scheduler, such as "
            "tcp://localhost:8786. `dask scheduler` starts one and prints its address."
        ) from None


async def _knock(address: str) -> None:
    from distributed import Security
    from distributed.comm.core import connect

    options: dict[str, Any] = Security().get_connection_args("client")
    async with asyncio.timeout(CONNECTION_SECONDS):
        comm = await connect(address, CONNECTION_SECONDS - 0.5, **options)
        await comm.close()


def _require_workers(client: Client, address: str) -> None:
    try:
        client.wait_for_workers(1, timeout=CONNECTION_SECONDS)
    except TimeoutError:
        raise ClusterError(
            f"{address} has 0 workers after {CONNECTION_SECONDS:.0f} s: expected at least one. "
            f"`dask worker {address}` starts one."
        ) from None


def _require_same_versions(client: Client, address: str) -> None:
    try:
        of_workers: dict[str, dict[str, str]] = client.run(_versions)
    except Exception as error:
        raise ClusterError(
            f"{address} has workers that cannot import halfway ({error}): expected halfway {version('halfway')} on all "
            "of them. Install it there."
        ) from None
    for what, ours in _versions().items():
        others = sorted({theirs[what] for theirs in of_workers.values()} - {ours})
        if not others:
            continue
        difference = f"workers of {address} have {what} {', '.join(others)} and here is {ours}"
        if what == "halfway":
            raise ClusterError(
                f"{difference}: expected the same on all machines. Install it there."
            )
        warnings.warn(f"{difference}: results may differ in the last digits.", stacklevel=2)


def _versions() -> dict[str, str]:
    return {
        "halfway": version("halfway"),
        "Python": platform.python_version(),
        "numpy": version("numpy"),
    }


def _submit(client: Client, f: Callable[..., Any], *arguments: Any) -> Any:
    from dask.config import set as setting

    # Distributed warns at 10 MB; a space with its basis images has 30.
    with setting({"distributed.admin.large-graph-warning-threshold": "1 GB"}):
        return client.submit(f, *arguments, pure=False)


def _itself(f: Callable[[T], R]) -> Callable[[T], R]:
    return f


def _call(f: Callable[[T], R], task: T) -> R:
    # For good: a worker does nothing else, and tasks side by side would undo each other's limits.
    threadpool_limits(1, "blas")
    return f(task)
