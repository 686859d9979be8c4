"""Batches and manifests: what is kept, what is made again, what is somebody else's."""

import json

import pytest

from halfway.batch import Batch, Checksum, Manifest, verify
from halfway.errors import FormatError, OutputError

MADE = {"by": "test"}
OUTPUTS = {"a.txt": {"t": 0}, "b.txt": {"t": 1}, "deep/c.txt": {"t": 2}}


def write(folder, outputs=OUTPUTS, *, made=MADE, stop_after=9):
    """Write a batch of files that say what they are made of; gives the names it wrote."""
    with Batch.open(folder, outputs, made=made, n_bytes=10) as batch:
        for name in batch.missing[:stop_after]:
            path = folder / name
            path.parent.mkdir(exist_ok=True)
            path.write_text(f"{outputs[name]}")
            batch.add(name, Checksum.of(path))
        if len(batch.missing) > stop_after:
            raise KeyboardInterrupt
        return batch.missing


def interrupt(folder, outputs=OUTPUTS, *, stop_after=1):
    with pytest.raises(KeyboardInterrupt):
        write(folder, outputs, stop_after=stop_after)


def test_a_finished_folder_says_what_each_file_is(tmp_path):
    assert write(tmp_path) == list(OUTPUTS)
    document = json.loads((tmp_path / "manifest.json").read_text())
    assert (document["format"], document["made"], list(document["files"])) == (
        1,
        MADE,
        sorted(OUTPUTS),
    )
    # printf "{'t': 0}" | sha256sum
    sha256 = "179ada1151a98ca435d96a15ea760bfbcef89c8622edb317eb18a07ef93b60c1"
    assert document["files"]["a.txt"] == {"of": {"t": 0}, "bytes": 8, "sha256": sha256}
    assert not (tmp_path / "manifest.jsonl").exists()
    assert verify(tmp_path) == (3, [], [], [])


def test_a_batch_that_is_stopped_goes_on(tmp_path):
    interrupt(tmp_path)
    assert not (tmp_path / "manifest.json").exists()
    assert verify(tmp_path).missing == ["b.txt", "deep/c.txt"]
    assert write(tmp_path) == ["b.txt", "deep/c.txt"]
    assert write(tmp_path) == []
    assert verify(tmp_path).ok


def test_a_file_whose_line_was_not_written_is_made_again(tmp_path):
    """Killed between the rename and the line."""
    interrupt(tmp_path)
    (tmp_path / "b.txt").write_text("who knows")
    assert write(tmp_path) == ["b.txt", "deep/c.txt"]
    assert (tmp_path / "b.txt").read_text() == "{'t': 1}"


def test_a_line_that_was_cut_counts_as_none(tmp_path):
    interrupt(tmp_path, stop_after=2)
    journal = tmp_path / "manifest.jsonl"
    journal.write_text(journal.read_text()[:-20])
    assert write(tmp_path) == ["b.txt", "deep/c.txt"]
    assert verify(tmp_path).ok


@pytest.mark.parametrize("spoil", ["shorter", "other bytes", "gone"])
def test_a_spoilt_file_is_found_and_made_again(tmp_path, spoil):
    write(tmp_path)
    path = tmp_path / "b.txt"
    if spoil == "gone":
        path.unlink()
    else:
        path.write_text("" if spoil == "shorter" else "{'t': 7}")
    found = verify(tmp_path)
    assert (found.n_right, found.missing, found.changed) == (
        (2, ["b.txt"], []) if spoil == "gone" else (2, [], ["b.txt"])
    )
    assert write(tmp_path) == ["b.txt"]
    assert verify(tmp_path).ok


def test_what_is_made_of_something_else_now_is_made_again(tmp_path):
    write(tmp_path)
    assert write(tmp_path, {**OUTPUTS, "b.txt": {"t": 0.5}}) == ["b.txt"]


def test_more_files_of_the_same_batch_keep_the_others(tmp_path):
    write(tmp_path)
    assert write(tmp_path, {"d.txt": None}) == ["d.txt"]
    assert verify(tmp_path).n_right == 4
    interrupt(tmp_path, {"e.txt": None, "f.txt": None})
    write(tmp_path)
    assert verify(tmp_path).missing == ["f.txt"]
    assert (tmp_path / "manifest.jsonl").exists()


def test_another_batch_of_the_same_command_takes_the_folder_over(tmp_path):
    write(tmp_path)
    assert write(tmp_path, {"a.txt": {"t": 0}}, made={"by": "test", "with": "paint"}) == ["a.txt"]
    assert sorted(p.name for p in tmp_path.rglob("*.*")) == ["a.txt", "manifest.json"]


def test_another_commands_folder_is_refused(tmp_path):
    write(tmp_path)
    with pytest.raises(OutputError, match="holds what `halfway test` wrote: choose another folder"):
        write(tmp_path, made={"by": "bake"})
    assert verify(tmp_path).ok


def test_somebody_elses_file_is_never_touched(tmp_path):
    (tmp_path / "b.txt").write_text("mine")
    with pytest.raises(OutputError, match=r"b\.txt is in the way: no manifest of halfway names it"):
        write(tmp_path)
    assert [p.name for p in tmp_path.iterdir()] == ["b.txt"]
    (tmp_path / "b.txt").rename(tmp_path / "notes.txt")
    write(tmp_path)
    assert verify(tmp_path).foreign == ["notes.txt"]


def test_temporaries_of_a_killed_run_are_swept_and_other_hidden_files_stay(tmp_path):
    interrupt(tmp_path)
    (tmp_path / ".b.0123456789ab.txt").write_text("half")
    (tmp_path / "deep").mkdir()
    (tmp_path / "deep" / ".c.0123456789ab.txt").write_text("half")
    (tmp_path / ".DS_Store").write_text("")
    write(tmp_path)
    assert verify(tmp_path).foreign == [".DS_Store"]


def test_temporaries_of_killed_workers_are_swept_too(tmp_path):
    with Batch.open(tmp_path, {"a.txt": {"t": 0}}, made=MADE, n_bytes=10) as batch:
        (tmp_path / ".a.0123456789ab.txt").write_text("half")
        (tmp_path / "a.txt").write_text("whole")
        batch.add("a.txt", Checksum.of(tmp_path / "a.txt"))
    assert verify(tmp_path) == (1, [], [], [])


def test_two_runs_do_not_share_a_folder(tmp_path):
    with (
        Batch.open(tmp_path, OUTPUTS, made=MADE, n_bytes=10),
        pytest.raises(OutputError, match="is being written by another halfway: wait for it"),
    ):
        write(tmp_path)


def test_too_little_space_leaves_no_folder(tmp_path, monkeypatch):
    monkeypatch.setattr("shutil.disk_usage", lambda _: type("usage", (), {"free": 29})())
    with pytest.raises(OutputError, match="a batch of 3 files takes"):
        write(tmp_path / "new")
    assert not (tmp_path / "new").exists()


def test_what_the_old_files_take_counts_as_free(tmp_path, monkeypatch):
    write(tmp_path, {"a.txt": {"t": "x" * 100}})
    monkeypatch.setattr("shutil.disk_usage", lambda _: type("usage", (), {"free": 0})())
    write(tmp_path, made={"by": "test", "again": True})


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("lasagne", "Expecting value"),
        ("[]", "list indices"),
        ('{"format": 1, "made": {}, "files": {}}', "'by'"),
        ('{"format": 2, "made": {}, "files": {}}', "format 2"),
        ('{"format": 1, "made": {"by": "test"}, "files": {"../../x": {}}}', "the name '../../x'"),
        ('{"format": 1, "made": {"by": "test"}, "files": {"/etc/x": {}}}', "the name '/etc/x'"),
        ('{"format": 1, "made": {"by": "test"}, "files": {"x": {"of": 1}}}', "'bytes'"),
        (
            '{"format": 1, "made": {"by": "test"}, "files": {"x": {"of": 1, "bytes": 1e400}}}',
            "infinity",
        ),
        ("[" * 100_000, "recursion"),
    ],
)
def test_a_manifest_that_is_none_gets_one_line(tmp_path, text, reason):
    (tmp_path / "manifest.json").write_text(text)
    with pytest.raises(FormatError, match="is no manifest of halfway") as caught:
        verify(tmp_path)
    assert reason in str(caught.value)
    with pytest.raises(FormatError, match="is no manifest of halfway"):
        write(tmp_path)
    assert (tmp_path / "manifest.json").read_text() == text


def test_a_folder_without_a_manifest_gets_one_line(tmp_path):
    assert Manifest.read(tmp_path) is None
    with pytest.raises(
        FormatError, match=r"has no manifest.json: expected a folder that `halfway route`"
    ):
        verify(tmp_path)
    with pytest.raises(FormatError, match=r"there is no folder .*nowhere: expected one that"):
        verify(tmp_path / "nowhere")
