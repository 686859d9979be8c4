"""``{public} halfway.mix``: what a public name is, from its docstring, and the example that the directive holds.

The examples of a page are one program: what an earlier one makes, a later one may use. The tests run them.
"""

import inspect
import sys
from importlib import import_module
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.pycode import ModuleAnalyzer
from sphinx.util.docutils import SphinxDirective


class PublicName(SphinxDirective):
    """The directive."""

    required_arguments = 1
    has_content = True

    def run(self) -> list[nodes.Node]:
        """The name's documentation, then the example."""
        (name,) = self.arguments
        text = ["```{eval-rst}", *_autodoc(name), "```", "", "```pycon", *self.content, "```"]
        return self.parse_text_to_nodes("\n".join(text))


def setup(app: Sphinx) -> dict[str, bool]:
    """Sphinx calls this."""
    app.add_directive("public", PublicName)
    app.connect("autodoc-process-docstring", _to_restructured_text, priority=400)  # numpydoc still
    return {"parallel_read_safe": True}


def _autodoc(name: str) -> list[str]:
    home, _, own = name.rpartition(".")
    value = getattr(import_module(home), own)
    if inspect.isclass(value):
        return [f".. autoclass:: {name}", "   :members:"]
    if inspect.ismodule(value):
        return [f".. automodule:: {name}", "   :members:"]
    if inspect.isfunction(value):
        return [f".. autofunction:: {name}"]
    return [f".. py:data:: {name}", "", *(f"   {line}" for line in _data_docstring(home, own))]


def _data_docstring(home: str, own: str) -> list[str]:
    """The string under a variable, wherever in the package it is set."""
    for module in sorted(name for name in sys.modules if f"{name}.".startswith(f"{home}.")):
        docstrings = ModuleAnalyzer.for_module(module).find_attr_docs()
        if ("", own) in docstrings:
            return docstrings["", own]
    return []


def _to_restructured_text(*event: Any) -> None:
    """Our docstrings as Sphinx reads them: |x| is a length, (3, *shape) a shape, and what is indented a drawing."""
    lines: list[str] = event[-1]
    for i, line in enumerate(lines):
        if not line.startswith("    "):
            escaped = line.replace("|", "\\|")
            lines[i] = escaped.replace("*", "\\*") if line.count("*") == 1 else escaped
    for i in reversed(range(_prose(lines))):
        if lines[i].startswith("    ") and lines[i - 1 : i] == [""]:
            lines[i:i] = [] if _is_drawn(lines[:i]) else ["::", ""]


def _prose(lines: list[str]) -> int:
    """How many lines come before the first section, such as Parameters."""
    rules = (i for i, line in enumerate(lines) if line and set(line) == {"-"})
    return next(rules, len(lines) + 1) - 1


def _is_drawn(above: list[str]) -> bool:
    """Whether the line follows, after a blank one, in a block that has begun already."""
    last = next((line for line in reversed(above) if line), "")
    return last.startswith("    ") or last.endswith("::")
