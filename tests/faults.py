"""Faults made for real: processes killed or interrupted at random moments while they build a library, and small disks.

The tests take a few of each; many, and the counts of docs/faults.md, with

    python tests/faults.py 200
"""

import os
import random
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path

import pytest
from patience import PATIENCE, wait_until

from halfway.cluster import Cluster
from halfway.errors import ClusterError, LibraryError
from halfway.library import StoredLibrary, build_library
from halfway.tasks import Work

TESTS = Path(__file__).parent
BUILD_FOR_EVER = """
import itertools, shutil, sys, time
from pathlib import Path
from halfway.library import build_library
target, *sources = map(Path, sys.argv[1:])
start = time.monotonic()
build_library([sources[0]], target.with_name("trial.brdflib"))
print(time.monotonic() - start, flush=True)
for source in itertools.cycle(sources):
    build_library([source], target)
"""


def start_building(target: Path, sources: list[Path]) -> tuple[subprocess.Popen[str], float]:
    """A process that builds a library of each source in turn at ``target``, for ever, and the seconds that one takes."""
    command = [sys.executable, "-c", BUILD_FOR_EVER, str(target), *map(str, sources)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    return process, float(process.stdout.readline())


def kill_builders(
    target: Path, sources: list[Path], n: int, *, at_once: int = 1, seed: int = 0
) -> Counter[str]:
    """What is at ``target`` after builders were killed (SIGKILL) at random moments, ``n`` times; half of them on nothing."""
    rng, found = random.Random(seed), Counter[str]()
    for i in range(n):
        if i % 2:
            shutil.rmtree(target, ignore_errors=True)
        builders = [start_building(target, sources) for _ in range(at_once)]
        for builder, seconds in builders:
            time.sleep(rng.uniform(0.0, 2.0) * seconds)
            builder.kill()
        for builder, _ in builders:
            builder.communicate()
        found[what_is_at(target)] += 1
    return found


def forget_what_is_young(folder: Path) -> None:
    """Make what killed builders left look old enough to be removed."""
    for left in folder.glob(".*.new"):
        os.utime(left, (0, 0))


def kill_scheduler() -> str:
    """What is said when the scheduler of a cluster gets SIGKILL in the middle of some work."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
    address = f"tcp://127.0.0.1:{port}"
    commands = (
        ["scheduler", "--port", str(port), "--no-dashboard"],
        ["worker", address, "--no-dashboard", "--no-nanny"],
    )
    processes = [
        subprocess.Popen([sys.executable, "-m", "dask", *words], stderr=subprocess.DEVNULL)
        for words in commands
    ]
    try:
        wait_until(lambda: _answers(port))
        with Cluster.at(address) as cluster:
            results = Work(engine=cluster).run(time.sleep, [0.05] * 100)
            next(results)
            processes[0].kill()
            list(results)
    except ClusterError as error:
        return str(error)
    finally:
        for process in processes:
            process.kill()
            process.wait()
    return "nothing"


def _answers(port: int) -> bool:
    with suppress(ConnectionRefusedError):
        socket.create_connection(("127.0.0.1", port)).close()
        return True
    return False


def what_is_at(target: Path) -> str:
    """``"nothing"``, ``"a whole library"``, or what is wrong."""
    if not target.exists():
        return "nothing"
    try:
        return "a whole library" if StoredLibrary(target).verify().ok else "damaged samples"
    except LibraryError as error:
        return str(error)


def interrupt_commands(
    folder: Path, words: list[str], n: int, *, after: str = "", seed: int = 0
) -> Counter[str]:
    """How ``halfway WORDS``, run in ``folder``, ended when it was interrupted (SIGINT) at random moments, ``n`` times.

    At any moment of its run; with ``after``, soon after a file of that pattern appeared.
    """
    rng, found = random.Random(seed), Counter[str]()
    whole = 0.0 if after else min(_seconds(folder, words) for _ in range(3))
    for _ in range(n):
        process = subprocess.Popen(
            [sys.executable, "-m", "halfway", *words],
            cwd=folder,
            stderr=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            text=True,
        )
        if after:
            wait_until(partial(_begun, process, folder, after))
        # The interpreter itself has to be up: what it does on a signal before is not ours.
        time.sleep(rng.uniform(0.0, 0.03) if after else rng.uniform(0.2, 0.9) * whole)
        with suppress(ProcessLookupError):
            process.send_signal(signal.SIGINT)
        _, talk = process.communicate(timeout=PATIENCE)
        lines = len(talk.strip().splitlines())
        found[f"exit {process.returncode}, {lines} line{'s' if lines != 1 else ''}"] += 1
        if lines > 1:
            print(talk, file=sys.stderr)
    return found


def _begun(process: subprocess.Popen[str], folder: Path, pattern: str) -> bool:
    return any(folder.glob(pattern)) or process.poll() is not None


def _seconds(folder: Path, words: list[str]) -> float:
    start = time.monotonic()
    command = [sys.executable, "-m", "halfway", *words]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    return time.monotonic() - start


@contextmanager
def small_disk(folder: Path, n_bytes: int) -> Iterator[Path]:
    """A disk of its own of ``n_bytes``, in memory; skips the test where one cannot be mounted."""
    disk = folder / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", f"size={n_bytes}", "tmpfs", str(disk)]
    if os.name != "posix" or os.geteuid() != 0 or subprocess.run(mount, check=False).returncode:
        pytest.skip("a small disk can only be mounted by root")
    try:
        yield disk
    finally:
        subprocess.run(["umount", str(disk)], check=True)


def protect(disk: Path) -> None:
    """Make a `small_disk` read-only: permissions do not bind root, this does."""
    subprocess.run(["mount", "-o", "remount,ro", str(disk)], check=True)


def main(n: int) -> None:
    from strategies import random_tables

    from halfway.formats import write_merl
    from halfway.halfdiff import Grid

    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        sources = [folder / "a", folder / "b"]
        for source, count in zip(sources, (30, 20), strict=True):
            for material, table in random_tables(count, Grid.merl(30, 20, 36)).items():
                write_merl(source / f"{material}.binary", table)
        print("killed:", kill_builders(folder / "x.brdflib", sources, n))
        print("two at once, killed:", kill_builders(folder / "x.brdflib", sources, n, at_once=2))
        words = ["library", "build", "a", "-o", "y.brdflib"]
        print("interrupted:", interrupt_commands(folder, words, n), what_is_at(folder / words[-1]))
        forget_what_is_young(folder)
        for target in ("x.brdflib", "trial.brdflib"):
            build_library(sources[:1], folder / target)
        print("left behind:", sorted(path.name for path in folder.iterdir()))


if __name__ == "__main__":
    sys.path.insert(0, str(TESTS))
    main(int(sys.argv[1]))
