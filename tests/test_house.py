"""The house: what ARCHITECTURE.md says of the code and no type does."""

import ast
import re
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from itertools import chain
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[1]
SOURCE = ROOT / "src" / "halfway"
FILES = sorted(SOURCE.rglob("*.py"))
FOLDERS = sorted(path.parent.name for path in SOURCE.glob("*/__init__.py"))
KINDS = {
    "space": {"AnchoredSpace", "PaperSpace", "LinearSpace"},
    "library": {"StoredLibrary", "ProceduralLibrary", "CompactLibrary", "Subset", "Joined"},
}
VAGUE = {"found", "made", "told", "place", "places", "thing", "things", "stuff", "data", "helper"}
"""Words that say nothing to who has not read the neighbours."""


@cache
def tree(path: Path) -> ast.Module:
    """What a file says."""
    return ast.parse(path.read_text())


def imports(path: Path) -> Iterator[tuple[list[str], ast.ImportFrom]]:
    """The package's modules that a file imports from, as parts of their names."""
    package = list(path.relative_to(SOURCE).parts[:-1])
    for node in ast.walk(tree(path)):
        if not isinstance(node, ast.ImportFrom):
            continue
        parts = node.module.split(".") if node.module else []
        if node.level:
            yield [*package[: len(package) - node.level + 1], *parts], node
        elif parts[:1] == ["halfway"]:
            yield parts[1:], node


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(SOURCE)))
def test_no_folder_is_imported_past_its_init(path: Path) -> None:
    own = path.relative_to(SOURCE).parts[0]
    past = [
        f"line {node.lineno}: {'.'.join(module)}"
        for module, node in imports(path)
        if len(module) > 1 and module[0] != own
    ]
    assert past == []


def test_no_test_imports_another() -> None:
    line = re.compile(r"^ *(from|import) test_", re.MULTILINE)
    tests = (ROOT / "tests").rglob("*.py")
    assert [path.name for path in tests if line.search(path.read_text())] == []


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(SOURCE)))
def test_text_files_say_their_encoding(path: Path) -> None:
    """Before Python 3.15 Windows takes its own code page."""
    for node in ast.walk(tree(path)):
        match node:
            case ast.Call(func=ast.Attribute(attr="read_text" | "write_text" as name)):
                arguments = len(node.args) + len(node.keywords)
                assert arguments > (name == "write_text"), f"line {node.lineno}"


@pytest.mark.parametrize("folder", FOLDERS)
def test_a_folder_has_at_most_twenty_public_names(folder: str) -> None:
    names = getattr(import_module(f"halfway.{folder}"), "__all__", [])
    assert len(names) <= 20
    assert len(set(names)) == len(names)


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(SOURCE)))
def test_nobody_asks_what_kind_a_space_or_a_library_is(path: Path) -> None:
    foreign = set().union(*(names for home, names in KINDS.items() if home not in path.parts))
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") in ("isinstance", "type"):
            names = {leaf.id for leaf in ast.walk(node) if isinstance(leaf, ast.Name)}
            assert not names & foreign, f"line {node.lineno}"
        if isinstance(node, ast.MatchClass):
            assert getattr(node.cls, "id", "") not in foreign, f"line {node.lineno}"


def lengths() -> dict[str, int]:
    """Lines of every function, without its decorators and docstring."""
    n_lines_of = {}
    for path in FILES:
        for node in ast.walk(tree(path)):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                first = node.body[0]
                has_text = ast.get_docstring(node) is not None
                assert node.end_lineno is not None
                assert first.end_lineno is not None
                text = first.end_lineno - first.lineno + 1 if has_text else 0
                n_lines = node.end_lineno - node.lineno + 1 - text
                n_lines_of[f"{path.relative_to(SOURCE)}:{node.lineno} {node.name}"] = n_lines
    return n_lines_of


def test_functions_are_short() -> None:
    n_lines = lengths()
    assert np.median(list(n_lines.values())) <= 7
    assert np.quantile(list(n_lines.values()), 0.9) <= 22
    assert {name: n for name, n in n_lines.items() if n > 50} == {}


def test_the_srgb_curve_exists_once_in_each_language() -> None:
    numbers = re.compile(r"0?\.0031308|12\.92")
    python = [path for path in FILES if numbers.search(path.read_text())]
    assert [path.name for path in python] == ["colour.py"]
    page = [
        path
        for path in (ROOT / "viewer" / "src").rglob("*")
        if path.suffix in (".ts", ".glsl") and numbers.search(path.read_text())
    ]
    assert len({path.suffix for path in page}) == len(page)


def words(name: str) -> set[str]:
    """The words of a name: ``to_half_diff``, ``StoredLibrary``."""
    return {word.lower() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", name)}


@pytest.mark.parametrize("folder", FOLDERS)
def test_public_names_say_what_they_are(folder: str) -> None:
    home = import_module(f"halfway.{folder}")
    for name in getattr(home, "__all__", []):
        members = (
            [m for m in vars(getattr(home, name, None) or object()) if not m.startswith("_")]
            if isinstance(getattr(home, name, None), type)
            else []
        )
        for each in [name, *members]:
            assert not words(each) & VAGUE, f"halfway.{folder}.{name}: {each}"


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(SOURCE)))
def test_local_names_say_what_they_are(path: Path) -> None:
    """Fields are keys of JSON as well, and keep their names."""
    vague = VAGUE - {"data", "made"}  # numbers that are plotted; a manifest's key
    kinds = ast.FunctionDef | ast.AsyncFunctionDef
    functions = (node for node in ast.walk(tree(path)) if isinstance(node, kinds))
    for node in chain.from_iterable(map(ast.walk, functions)):
        match node:
            case ast.Name(id=name, ctx=ast.Store()) | ast.arg(arg=name):
                assert not words(name) & vague, f"line {node.lineno}: {name}"
