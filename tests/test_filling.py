"""Folders that one command fills: what is somebody else's stays."""

import pytest

from halfway.batch import Manifest, filling, keeping, verify
from halfway.errors import OutputError


def fill(folder, texts, **options):
    with filling(folder, "report", **options) as scratch:
        for name, text in texts.items():
            (scratch / name).parent.mkdir(parents=True, exist_ok=True)
            (scratch / name).write_text(text)


def contents(folder):
    files = (path for path in folder.rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_text() for path in files}


def test_a_manifest_names_all_that_was_written_and_verify_holds(tmp_path):
    fill(tmp_path / "out", {"a.txt": "a", "deep/b.txt": "b"})
    assert Manifest.read(tmp_path / "out").entries.keys() == {"a.txt", "deep/b.txt"}
    assert verify(tmp_path / "out").ok


def test_what_was_written_before_is_replaced_and_what_is_not_written_again_goes(tmp_path):
    fill(tmp_path, {"a.txt": "old", "b.txt": "old"})
    fill(tmp_path, {"a.txt": "new"})
    assert contents(tmp_path).keys() == {"a.txt", "manifest.json"}
    assert (tmp_path / "a.txt").read_text() == "new"
    assert verify(tmp_path).ok


@pytest.mark.parametrize("spoil", ["foreign", "changed", "other command"])
def test_what_is_somebody_elses_is_never_written_over_unasked(tmp_path, spoil):
    if spoil != "foreign":
        fill(tmp_path, {"a.txt": "old"})
    if spoil == "other command":
        with filling(tmp_path / "in", "export") as scratch:
            (scratch / "b.txt").write_text("theirs")
    else:
        (tmp_path / "a.txt").write_text("mine")
    folder = tmp_path / "in" if spoil == "other command" else tmp_path
    before = contents(folder)
    with pytest.raises(
        OutputError,
        match=r"holds files that `halfway report` did not write, or that were changed since, .\.txt",
    ):
        fill(folder, {"a.txt": "new"})
    assert contents(folder) == before


def test_force_writes_beside_what_is_there_and_over_what_has_the_same_name(tmp_path):
    (tmp_path / "a.txt").write_text("mine")
    (tmp_path / "notes.txt").write_text("mine too")
    fill(tmp_path, {"a.txt": "new"}, force=True)
    assert contents(tmp_path) | {"manifest.json": ""} == {
        "a.txt": "new",
        "notes.txt": "mine too",
        "manifest.json": "",
    }
    assert Manifest.read(tmp_path).names == {"a.txt"}


@pytest.mark.parametrize("earlier", [{}, {"a.txt": "old"}])
def test_a_run_that_fails_changes_nothing(tmp_path, earlier):
    def fails():
        with filling(tmp_path / "out", "report") as scratch:
            (scratch / "a.txt").write_text("half")
            raise KeyboardInterrupt

    if earlier:
        fill(tmp_path / "out", earlier)
    before = contents(tmp_path)
    with pytest.raises(KeyboardInterrupt):
        fails()
    assert contents(tmp_path) == before
    assert (tmp_path / "out").exists() == bool(earlier)


def test_a_run_that_was_stopped_while_files_were_moved_is_gone_on_from(tmp_path):
    Manifest({"by": "report"}, frozenset({"a.txt", "b.txt"})).write_journal(tmp_path)
    (tmp_path / "a.txt").write_text("moved")
    fill(tmp_path, {"b.txt": "whole"})
    assert contents(tmp_path).keys() == {"b.txt", "manifest.json"}
    assert verify(tmp_path).ok


def test_what_is_noted_is_there_for_the_next_until_the_folder_is_filled(tmp_path):
    folder = tmp_path / "out"
    with keeping(folder, "notes.jsonl", "hand") as path:
        path.write_text("one")  # and here it is stopped
    with keeping(folder, "notes.jsonl", "hand") as path:
        assert path.read_text() == "one"
    with filling(folder, "hand") as scratch:
        (scratch / "page.html").write_text("whole")
    assert sorted(p.name for p in folder.iterdir()) == ["manifest.json", "page.html"]


def test_notes_are_forgotten_by_force(tmp_path):
    folder = tmp_path / "out"
    with keeping(folder, "notes.jsonl", "hand") as path:
        path.write_text("one")
    with keeping(folder, "notes.jsonl", "hand", force=True) as path:
        assert not path.exists()


def test_a_block_that_notes_nothing_leaves_nothing(tmp_path):
    with pytest.raises(ValueError, match="no"), keeping(tmp_path / "out", "notes", "hand"):
        raise ValueError("no")
    assert not (tmp_path / "out").exists()


def test_notes_in_the_folder_of_another_are_refused(tmp_path):
    (tmp_path / "theirs.txt").write_text("x")
    with pytest.raises(OutputError, match=r"theirs\.txt"), keeping(tmp_path, "notes", "hand"):
        pass
