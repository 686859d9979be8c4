"""Batches on real faults: killed, interrupted, on a full disk, in a folder that cannot be written."""

import os
import signal
import subprocess
import sys
from contextlib import suppress
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from batch_server import N
from patience import PATIENCE, wait_until

from halfway import Grid, LinearSpace, Route, TabularBrdf, __version__, build_library
from halfway.batch import verify
from halfway.errors import OutputError
from halfway.export import write_route
from halfway.formats import write_merl
from halfway.tasks import Work

GRID = Grid.merl(24, 20, 40)
KILLED_AT = (0, 1, 3, 7, 12, 20)
"""Files that are there when a batch is killed."""
EXIT_130 = (130, -signal.SIGINT)
"""As a shell counts; Python ends itself by the signal where a compiled module saw it first."""
USAGE = 2
INTERRUPTED = (
    "halfway: interrupted; what was finished is kept, and the same command goes on from there.\n"
)


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    folder = tmp_path_factory.mktemp("faults")
    rng = np.random.default_rng(0)
    for i in range(3):
        values = rng.gamma(1.0, 0.1, (3, *GRID.shape)).astype(np.float32)
        write_merl(folder / "measured" / f"m{i}.binary", TabularBrdf(values, GRID))
    return build_library([folder / "measured"], folder / "some.brdflib").library


@pytest.fixture(scope="module")
def route(library):
    return Route.through(LinearSpace.of(library), library.names)


@pytest.fixture(scope="module")
def reference(library, route, tmp_path_factory):
    """What a run that nobody stops leaves."""
    folder = tmp_path_factory.mktemp("reference")
    write_route(folder, route, route.steps(N), library, format="merl")
    return contents(folder)


def contents(folder):
    """The bytes of the files under their final names."""
    return {
        path.name: path.read_bytes()
        for path in folder.iterdir()
        if not path.name.startswith((".", "manifest"))
    }


class Server:
    """Runs that can be killed (see `batch_server`)."""

    def __init__(self, library):
        command = [sys.executable, Path(__file__).parent / "batch_server.py", library.path]
        self.process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1
        )
        assert self.process.stdout.readline() == "ready\n"

    def run(self, folder, *, kill_at=None):
        """Run a batch, killing it when so many of its files are there."""
        self.process.stdin.write(f"{folder}\n")
        pid = int(self.process.stdout.readline())
        if kill_at is not None:
            wait_until(lambda: len(list(folder.glob("*.binary"))) >= kill_at)
            os.kill(pid, signal.SIGKILL)  # nobody waits for it yet, so the id is still its own
        self.process.stdin.write("end\n")
        assert self.process.stdout.readline() == "ended\n"


@pytest.fixture
def server(library):
    server = Server(library)
    yield server
    server.process.communicate(timeout=PATIENCE)


def test_a_batch_that_is_killed_ends_right(server, reference, tmp_path):
    """Kill -9, then the same again: what is there is right at any time, and in the end all is."""
    n_partial = 0
    for i, n_files in enumerate(KILLED_AT):
        out = tmp_path / f"out-{i // 2}"  # two kills in one folder
        server.run(out, kill_at=n_files)
        found = contents(out) if out.exists() else {}
        assert {name: reference[name] for name in found} == found
        n_partial += 0 < len(found) < len(reference)
    assert n_partial > 0, "no kill fell inside a batch"
    for out in tmp_path.glob("out-*"):
        server.run(out)
        assert contents(out) == reference
        assert verify(out) == (N + 1, [], [], [])
        assert not list(out.glob(".*"))


TRIES = 10
"""On a busy machine a signal may come when all is done; then it is sent to another run."""


def begun(process, file):
    return file.exists() or process.poll() is not None


def test_ctrl_c_is_one_line_and_leaves_no_temporary(library, reference, tmp_path):
    # Who interrupts it comes first, however busy the machine is.
    command = ["nice", sys.executable, "-m", "halfway", "route", library.path, *library.names]
    command += ["-n", N, "--space", "linear", "--pace", "uniform", "--format", "merl", "-o"]
    for i in range(TRIES):
        out = tmp_path / f"out-{i}"
        process = subprocess.Popen(
            [*map(str, command), str(out)], stderr=subprocess.PIPE, text=True
        )
        wait_until(partial(begun, process, out / "003.binary"))
        process.send_signal(signal.SIGINT)
        _, talk = process.communicate(timeout=PATIENCE)
        found = contents(out)
        assert {name: reference[name] for name in found} == found
        assert not list(out.glob(".*"))
        if process.returncode:
            break
    assert process.returncode in EXIT_130
    assert talk == INTERRUPTED


def test_ctrl_c_while_it_starts_is_one_line():
    command = [sys.executable, "-X", "importtime", "-m", "halfway", "route"]
    for _ in range(TRIES):
        with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
            assert process.stderr is not None
            next(line for line in process.stderr if "typer" in line)
            process.send_signal(signal.SIGINT)
            said = [line for line in process.stderr if not line.startswith("import time:")]
        if process.returncode != USAGE:
            break
    assert process.returncode in EXIT_130
    assert said == [INTERRUPTED]


def test_ctrl_c_when_all_is_done_has_nothing_to_say():
    script = "import atexit, signal; atexit.register(signal.raise_signal, signal.SIGINT);"
    script += "from halfway.__main__ import main; main()"
    command = [sys.executable, "-c", script, "--version"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.stdout, done.stderr) == (f"{__version__}\n", "")


@pytest.fixture
def small_disk(tmp_path):
    """A file system of eight megabytes."""
    disk = tmp_path / "disk"
    disk.mkdir()
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=8m", "tmpfs", disk], capture_output=True
    )
    if mounted.returncode:
        pytest.skip("needs the right to mount a small file system, which only root has")
    yield disk
    subprocess.run(["umount", disk], check=True)


def fill(path):
    """Write until the disk is full."""
    with suppress(OSError), path.open("wb", buffering=0) as file:
        while file.write(bytes(4096)):
            pass


def test_a_disk_that_fills_keeps_what_is_finished_and_goes_on_with_room(
    library, route, reference, small_disk
):
    out, thief = small_disk / "out", small_disk / "thief"

    def track(items, label, total):  # noqa: ARG001
        """Takes the room away while the third table is awaited."""
        for i, item in enumerate(items):
            if label == "Tables" and i == 2:
                fill(thief)
            yield item

    ts = route.steps(12)
    with pytest.raises(OutputError, match=r"cannot be written: the disk is full\. Free some space"):
        write_route(out, route, ts, library, format="merl", work=Work(track=track))
    assert not list(out.glob(".*"))
    assert (out / "000.binary").read_bytes() == reference["000.binary"]
    thief.unlink()
    written = write_route(out, route, ts, library, format="merl")
    assert written.n_kept >= 2
    assert verify(out) == (13, [], [], [])


def test_too_little_room_is_said_before_anything_is_written(library, route, small_disk):
    with pytest.raises(
        OutputError, match=r"a batch of 401 files takes 1\d\d\.\d MB and .* has \d+\.\d MB"
    ):
        write_route(small_disk / "out", route, route.steps(400), library, format="merl")
    assert list(small_disk.iterdir()) == []


def test_a_folder_that_cannot_be_written_gets_one_line(library, route, small_disk):
    subprocess.run(["mount", "-o", "remount,ro", small_disk], check=True)
    with pytest.raises(
        OutputError, match=r"out cannot be written: no permission in .*disk. Choose"
    ):
        write_route(small_disk / "out", route, route.steps(3), library)
