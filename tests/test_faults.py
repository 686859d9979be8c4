"""Faults, for real: nothing is lost, nothing half-written stands under a final name, one line says what happened.

Each is tried a few times here; `faults.py` tries many. The table of docs/faults.md has the counts.
"""

import os
import resource
import subprocess
import sys

import pytest
from faults import (
    forget_what_is_young,
    interrupt_commands,
    kill_builders,
    protect,
    small_disk,
    what_is_at,
)
from strategies import TINY, random_tables

from halfway import build_library, open_library
from halfway.cli import main as halfway
from halfway.errors import LibraryError, OutputError
from halfway.formats import write_merl
from halfway.halfdiff import Grid
from halfway.library import StoredLibrary
from halfway.tasks import Work, silent

GRID = Grid.merl(30, 20, 36)
"""Some ten milliseconds a library: a process can be killed in the middle."""


def measured(folder, n, grid=GRID, seed=0):
    for name, table in random_tables(n, grid, seed).items():
        write_merl(folder / f"{name}.binary", table)
    return folder


@pytest.fixture
def sources(tmp_path):
    return [measured(tmp_path / "a", 12), measured(tmp_path / "b", 8)]


def hidden(folder):
    return [path.name for path in folder.iterdir() if path.name.startswith(".")]


def test_a_killed_builder_leaves_a_whole_library_or_none(sources, tmp_path):
    found = kill_builders(tmp_path / "x.brdflib", sources, 4)
    assert found.keys() <= {"nothing", "a whole library"}
    forget_what_is_young(tmp_path)
    for name in ("x.brdflib", "trial.brdflib"):
        build_library(sources[:1], tmp_path / name)
        assert what_is_at(tmp_path / name) == "a whole library"
    assert not hidden(tmp_path)


def test_two_processes_may_build_the_same_library(sources, tmp_path):
    found = kill_builders(tmp_path / "x.brdflib", sources, 2, at_once=2)
    assert found.keys() <= {"nothing", "a whole library"}


def test_what_another_process_is_writing_stays(sources, tmp_path):
    """Only what nobody holds is removed, however old it is."""
    from halfway.files import scratch_folder

    with scratch_folder(tmp_path / "x.brdflib") as folder:
        os.utime(folder, (0, 0))
        build_library(sources[:1], tmp_path / "x.brdflib")
        assert folder.exists()


@pytest.mark.usefixtures("sources")
def test_an_interrupted_build_is_one_line_and_leaves_nothing(tmp_path):
    words = ["library", "build", "a", "-o", "x.brdflib"]
    found = interrupt_commands(tmp_path, words, 3, after=".x.brdflib.*.new")
    # A signal may come when all is done: the interpreter, on its way out, then ends of it.
    assert found.keys() <= {"exit 130, 1 line", "exit 0, 1 line", "exit -2, 1 line"}
    assert what_is_at(tmp_path / "x.brdflib") in ("nothing", "a whole library")
    assert not hidden(tmp_path)


def test_a_disk_that_fills_up_keeps_the_old_library(tmp_path):
    old, new = measured(tmp_path / "old", 2), measured(tmp_path / "new", 4, seed=1)
    one = 12 * GRID.size
    with small_disk(tmp_path, 7 * one) as disk:
        path = disk / "x.brdflib"
        build_library([old], path)

        def fill(items, label, total):  # noqa: ARG001
            for item in items:
                yield item
                with (disk / "filler").open("ab") as file:
                    file.write(bytes(one // 2))

        with pytest.raises(OutputError, match=r"cannot be written: the disk is full\. Free some"):
            build_library([new], path, work=Work(track=fill))
        assert (len(open_library(path)), what_is_at(path)) == (2, "a whole library")
        assert not hidden(disk)
        (disk / "filler").unlink()
        build_library([new], path)
        assert (len(open_library(path)), what_is_at(path)) == (4, "a whole library")


def test_a_disk_without_room_is_refused_before_anything_is_read(sources, tmp_path):
    with (
        small_disk(tmp_path, 1 << 20) as disk,
        pytest.raises(OutputError, match=r"a library of 12 materials takes \d\.\d MB and .* free"),
    ):
        build_library(sources[:1], disk / "x.brdflib")


def test_a_read_only_folder_is_one_line(sources, tmp_path):
    with small_disk(tmp_path, 8 << 20) as disk:
        protect(disk)
        with pytest.raises(OutputError, match=r"no permission in .*disk.*Choose another folder"):
            build_library(sources[:1], disk / "x.brdflib")


def test_a_file_that_may_not_grow_is_one_line(sources, tmp_path):
    """The limit that shared machines set, of a process of its own."""
    script = "from halfway.library import build_library; import sys; from pathlib import Path\n"
    script += "build_library([sys.argv[1]], Path(sys.argv[2]))"
    done = subprocess.run(
        [sys.executable, "-c", script, sources[0], tmp_path / "x.brdflib"],
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 16, 1 << 16)),
        capture_output=True,
        text=True,
        check=False,
    )
    assert "OutputError" in done.stderr.splitlines()[-1]
    assert "x.brdflib cannot be written: File too large" in done.stderr.splitlines()[-1]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a", "b"]


@pytest.fixture
def library(tmp_path):
    source = measured(tmp_path / "tiny", 4, TINY)
    return build_library([source], tmp_path / "tiny.brdflib").library


def test_a_sound_library_verifies(library):
    assert library.verify() == (4, (), ())


@pytest.mark.parametrize("place", [128, 200, -1])
def test_a_flipped_bit_is_found(library, place):
    content = bytearray(library.tables.read_bytes())
    content[place] ^= 1
    library.tables.write_bytes(content)
    found = StoredLibrary(library.path).verify()
    assert (found.n_right, len(found.damaged), found.ok) == (3, 1, False)


def test_tables_that_were_cut_are_refused_when_opened_and_while_read(library):
    with library.tables.open("r+b") as file:
        file.truncate(1000)
    with pytest.raises(LibraryError, match=r"in 3,008 bytes \(it has 1,000\)"):
        StoredLibrary(library.path)
    with pytest.raises(OSError, match=r"tables-.*\.npy ended \d+ bytes early"):
        library.row(3)


def test_a_source_that_changed_since_is_named(library, tmp_path):
    source = tmp_path / "tiny" / "material-2.binary"
    write_merl(source, random_tables(1, TINY, seed=9)["material-0"])
    (tmp_path / "tiny" / "material-3.binary").unlink()
    found = library.verify()
    assert (found.damaged, found.changed, found.ok) == ((), ("material-2",), True)


def test_a_source_that_shrinks_while_it_is_read_is_left_out_and_named(library, tmp_path):
    source = tmp_path / "tiny" / "material-3.binary"

    def cut(items, label, total):
        with source.open("r+b") as file:
            file.truncate(600)
        return silent(items, label, total)

    built, (skipped,) = build_library([tmp_path / "tiny"], library.path, work=Work(track=cut))
    assert skipped.path.endswith("material-3.binary")
    assert skipped.damaged
    assert "material-3" not in built.names
    assert what_is_at(library.path) == "a whole library"
    assert not hidden(tmp_path)


def test_verify_prints_what_is_damaged_and_exits_with_1(library, monkeypatch, capsys):
    content = bytearray(library.tables.read_bytes())
    content[-1] ^= 1
    library.tables.write_bytes(content)
    monkeypatch.setattr(sys, "argv", ["halfway", "library", "verify", str(library.path)])
    with pytest.raises(SystemExit, match="1"):
        halfway()
    out, talk = capsys.readouterr()
    assert out == "damaged  material-3\n"
    assert "3 of 4 materials right. Build the library again." in talk
