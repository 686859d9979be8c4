"""Files on the command line: sound, damaged, oddly named, of other kinds."""

import json

import numpy as np
import pytest
from strategies import random_tables

from halfway import TabularBrdf
from halfway.formats import read_merl, write_merl
from halfway.halfdiff import Grid
from halfway.library import ProceduralLibrary

GRID = Grid.merl(4, 3, 5)


def test_check_tells_sound_from_broken_and_repair_mends(run, tmp_path):
    wrong = np.full((3, *GRID.shape), 5.0, np.float32)
    write_merl(tmp_path / "wrong.binary", TabularBrdf(wrong, GRID, name="wrong"))
    code, out, _ = run("check", "wrong.binary")
    assert (code, "BROKEN  wrong.binary: reflects" in out) == (1, True)
    (card,) = json.loads(run("check", "wrong.binary", "--json")[1])
    assert (card["file"], card["ok"], card["format"]) == ("wrong.binary", False, 1)
    assert run("check", "wrong.binary", "--repair", "-o", "mended.binary")[0] == 0
    assert run("check", "mended.binary")[0] == 0


@pytest.fixture
def damaged(tmp_path):
    """A file cut short, one with a sample that is no number, and a whole one."""
    write_merl(
        tmp_path / "whole.binary", TabularBrdf(np.full((3, *GRID.shape), 0.1, np.float32), GRID)
    )
    whole = (tmp_path / "whole.binary").read_bytes()
    (tmp_path / "cut.binary").write_bytes(whole[:99])
    (tmp_path / "nan.binary").write_bytes(whole[:-8] + np.float64("nan").tobytes())
    return ["cut.binary", "whole.binary", "nan.binary"]


def test_check_goes_on_past_what_it_cannot_read(run, damaged):
    code, out, talk = run("check", *damaged)
    assert (code, talk) == (3, "0 of 3 break a law, 2 cannot be read\n")
    assert [line.split()[0] for line in out.splitlines()] == ["UNREAD", "sound", "UNREAD"]
    assert "nan.binary has a NaN sample (1 of 180 are not finite" in out
    documents = json.loads(run("check", *damaged, "--json")[1])
    assert [(d["file"], "error" in d) for d in documents] == [
        ("cut.binary", True),
        ("whole.binary", False),
        ("nan.binary", True),
    ]
    assert documents[0]["error"] in out


def test_a_library_is_built_past_what_is_damaged(run, damaged, tmp_path):
    """Cut short is seen at once, a damaged sample where the table is read; in the database's size not before."""
    code, _, talk = run("library", "build", *damaged, "-o", "x.brdflib")
    assert code == 3
    assert "skipped cut.binary: is 1,353 bytes shorter than its header says" in talk
    assert "skipped nan.binary: has a NaN sample (1 of 180" in talk
    assert "  whole\n" in run("library", "info", "x.brdflib")[1]
    code, _, talk = run("library", "build", "cut.binary", "-o", "y.brdflib")
    assert (code, "there is no BRDF in cut.binary (cut.binary: is 1,353" in talk) == (1, True)
    assert not (tmp_path / "y.brdflib").exists()


def test_names_may_hold_what_the_command_line_means_something_by(run, tmp_path):
    names = ("gold=paint", "red, matte", "scan 12:30", "a.zip:b", "two\nlines", "\x1b[31mred")
    for name, table in zip(names, random_tables(len(names), GRID).values(), strict=True):
        write_merl(tmp_path / "odd" / f"{name}.binary", table)
    assert run("library", "build", "odd", "-o", "n.brdflib")[0] == 0
    out = run("library", "info", "n.brdflib")[1]
    assert out.splitlines()[1:] == [
        r"  \x1b[31mred", "  a.zip:b", "  gold=paint", "  red, matte", "  scan 12:30", r"  two\nlines",
    ]  # fmt: skip
    mixed = "gold=paint=0.25, red, matte=0.5, scan 12:30=.25"
    assert run("mix", "n.brdflib", mixed, "-o", "m.binary")[0] == 0
    for name in names[:4]:
        assert run("mix", "n.brdflib", name, "-o", "one.binary")[0] == 0
        assert (tmp_path / "one.binary").read_bytes() == (
            tmp_path / "odd" / f"{name}.binary"
        ).read_bytes()
        assert run("info", f"n.brdflib:{name}")[1].startswith(f"{name}: a table")
    assert run("info", "builtin:merl-abc:scan 12:30")[2].startswith(
        "halfway: 'scan 12:30' is not one of"
    )


def test_a_name_cannot_tell_the_terminal_what_to_do(run, tmp_path):
    write_merl(tmp_path / "\x1b[31mr\ned.binary", random_tables(1, GRID)["material-0"])
    for words in (["check"], ["info"], ["fit"], ["convert"]):
        target = ["\x1b[0m.binary"] if words == ["convert"] else []
        _, out, talk = run(*words, "\x1b[31mr\ned.binary", *target)
        assert "\x1b" not in out + talk
        assert r"\x1b[31mr\ned" in out + talk


def test_a_suffix_may_be_in_capitals(run, lib, tmp_path):
    assert run("convert", f"{lib}:material-1", "ONE.BINARY")[0] == 0
    assert run("convert", "teflon", "ONE.BSDF")[0] == 0
    assert (tmp_path / "ONE.BSDF").read_bytes().startswith(b"tensor_file")


def test_a_table_is_converted_to_another_grid(run, lib, tmp_path):
    assert run("convert", f"{lib}:material-1", "fine.binary", "--grid", "8x6x10")[0] == 0
    assert read_merl(tmp_path / "fine.binary").grid == Grid.merl(8, 6, 10)
    code, _, talk = run("export", f"{lib}:material-1", "--for", "pbrt-v2", "-o", "x")
    assert (code, "with `halfway convert IN OUT.binary --grid 90x90x180`" in talk) == (1, True)


def test_info_of_formulas_computes_no_tables(run, monkeypatch):
    """A hundred tables take minutes where their formulas take a second."""
    monkeypatch.setattr(ProceduralLibrary, "row", None)
    out = run("info", "builtin:merl-abc")[1].splitlines()
    assert len(out) == 100
    assert out[0].startswith("alum-bronze: a fit (ABC microfacet, held past 80 degrees), The 100")


def test_convert_and_info(run, lib, tmp_path):
    assert run("convert", f"{lib}:material-1", "one.binary")[0] == 0
    assert (tmp_path / "one.binary").read_bytes() == (
        tmp_path / "measured" / "material-1.binary"
    ).read_bytes()
    told = run("info", "one.binary")[1]
    assert "one: a table of 4 x 3 x 5 cells, albedo" in told
    (facts,) = json.loads(run("info", "one.binary", "--json")[1])
    (read,) = json.loads(run("attributes", "one.binary", "--json")[1])
    assert facts["attributes"] == read["attributes"]
    assert f"gloss60{read['attributes']['gloss60']:19.4g} GU" in told
    assert "names no format" in run("convert", "one.binary", "one.exr")[2]
    write_merl(
        tmp_path / "no.binary", TabularBrdf(np.full((3, *GRID.shape), np.nan, np.float32), GRID)
    )
    assert "4 x 3 x 5 cells, nothing is measured" in run("info", "no.binary")[1]
    assert "no is measured nowhere on a lit sphere" in run("convert", "no.binary", "no.bsdf")[2]


def test_fit_says_how_far_off_it_is_and_writes_what_the_suffix_names(run, tmp_path):
    code, out, _ = run("fit", "teflon", "--model", "principled", "-o", "teflon.json")
    assert (code, out.startswith("teflon, as Mitsuba principled: ")) == (0, True)
    (document,) = json.loads(run("fit", "teflon", "--model", "principled", "--json")[1])
    assert f"{document['error']['psnr']:.1f} dB" in out
    assert json.loads((tmp_path / "teflon.json").read_text()) == document
    assert run("convert", "teflon", "teflon.glb")[0] == 0
    assert (tmp_path / "teflon.glb").read_bytes().startswith(b"glTF")
