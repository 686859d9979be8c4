"""The documentation says what is so: its examples run, its commands exist, its links lead somewhere."""

import doctest
import inspect
import re
from importlib import import_module
from pathlib import Path

import pytest

import halfway

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
API = sorted(path for path in (DOCS / "api").glob("*.md") if path.stem != "index")
PUBLIC = [path.stem for path in API if path.stem != "errors"]
FENCE = re.compile(r"^```(?:pycon|\{public\} (\S+))\n(.*?)^```$", re.MULTILINE | re.DOTALL)


EXPLAINED = sorted(
    path for path in (ROOT / "src" / "halfway").rglob("*.py") if " >>> " in path.read_text()
)


@pytest.mark.parametrize("page", API, ids=lambda path: path.stem)
def test_examples_of_the_reference_run(page, tmp_path, monkeypatch):
    """Those of a page are one program, in an empty folder."""
    monkeypatch.chdir(tmp_path)
    text = page.read_text()
    # As many lines as in the page, so that a failure says where.
    kept = ["" for _ in text.splitlines()]
    for block in FENCE.finditer(text):
        first = text.count("\n", 0, block.start(2))
        lines = block[2].splitlines()
        kept[first : first + len(lines)] = lines
    run(doctest.DocTestParser().get_doctest("\n".join(kept), {}, page.name, str(page), 0))


@pytest.mark.parametrize("path", EXPLAINED, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_examples_of_the_docstrings_run(path, tmp_path, monkeypatch):
    """Each by itself, in an empty folder, with the names of its module."""
    monkeypatch.chdir(tmp_path)
    module = import_module(".".join(path.relative_to(ROOT / "src").with_suffix("").parts))
    shown = [test for test in doctest.DocTestFinder().find(module) if test.examples]
    assert shown
    for test in shown:
        assert not any("SKIP" in example.source for example in test.examples), test.name
        run(test)


def run(test: doctest.DocTest) -> None:
    """Run examples that stand in one text; a failure says where."""
    runner = doctest.DocTestRunner(
        optionflags=doctest.ELLIPSIS | doctest.IGNORE_EXCEPTION_DETAIL, verbose=False
    )
    told: list[str] = []
    runner.run(test, out=told.append)
    assert test.examples
    assert not told, "".join(told)


@pytest.mark.parametrize("module", PUBLIC)
def test_every_public_name_has_a_docstring_and_an_example(module):
    home = import_module(f"halfway.{module}")
    examples = dict(FENCE.findall((DOCS / "api" / f"{module}.md").read_text()))
    for name in home.__all__:
        example = examples.get(f"halfway.{module}.{name}", "")
        assert name in example, f"docs/api/{module}.md has no {{public}} example of {name}"
        value = getattr(home, name)
        if inspect.isclass(value) or inspect.isfunction(value):
            assert value.__doc__, f"halfway.{module}.{name} has no docstring"


def test_every_public_module_has_its_page():
    modules = {
        path.parent.name
        for path in (ROOT / "src" / "halfway").glob("*/__init__.py")
        if "__all__" in path.read_text()
    }
    assert modules == set(PUBLIC)


def test_every_name_at_the_top_loads_and_is_public_where_it_lives():
    assert set(dir(halfway)) == set(halfway.__all__)
    public = {name for module in PUBLIC for name in import_module(f"halfway.{module}").__all__}
    assert set(halfway.__all__) - public == {"HalfwayError"}
    for name in halfway.__all__:
        assert getattr(halfway, name) is not None


LINKED = [
    *ROOT.glob("*.md"),
    *DOCS.glob("*.md"),
    *(DOCS / "api").glob("*.md"),
    *(DOCS / "decisions").glob("*.md"),
]


@pytest.mark.parametrize("page", LINKED, ids=lambda path: str(path.relative_to(ROOT)))
def test_links_lead_to_files_and_headings_that_are_there(page):
    text = re.sub(r"^```.*?^```$", "", page.read_text(), flags=re.MULTILINE | re.DOTALL)
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if re.match(r"https?:|mailto:", target):
            continue
        path, _, anchor = target.partition("#")
        file = (page.parent / path) if path else page
        assert file.exists(), f"{page.name} links to {target}"
        assert not anchor or anchor in _anchors(file), f"{page.name} links to {target}"


def _anchors(page: Path) -> set[str]:
    """The names of the headings, as GitHub and MyST make them."""
    headings = re.findall(r"^#+ (.*)$", page.read_text(), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def test_examples_are_short_and_say_what_they_show():
    examples = sorted((ROOT / "examples").glob("plot_*.py"))
    assert len(examples) >= 6
    for example in examples:
        text = example.read_text()
        assert text.count("\n") < 40, example.name
        assert re.match(r'"""\n.+\n=+\n\n.+', text), example.name
