"""``{command-line}``: the reference of the commands, made from the commands themselves at every build.

Each command becomes a section with its usage, its text, its examples and its options, as ``--help`` says them.
"""

import inspect
from collections.abc import Iterator
from typing import Any

import typer
from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from halfway.cli import app as commands

Command = Any
"""Of click, which typer brings under a name that changes."""


class CommandLine(SphinxDirective):
    """The directive."""

    def run(self) -> list[nodes.Node]:
        """Sections, one per command."""
        lines = [line for block in _blocks() for line in (*block, "")]
        return self.parse_text_to_nodes("\n".join(lines), allow_section_headings=True)


def setup(app: Sphinx) -> dict[str, bool]:
    """Sphinx calls this."""
    app.add_directive("command-line", CommandLine)
    return {"parallel_read_safe": True}


def _blocks() -> Iterator[list[str]]:
    for name, command in _leaves(typer.main.get_command(commands), "halfway"):
        yield from _section(name, command)


def _leaves(command: Command, name: str) -> Iterator[tuple[str, Command]]:
    """Every command that does something, with its whole name, in the order of ``--help``."""
    if not hasattr(command, "commands"):
        yield name, command
        return
    for word, inner in command.commands.items():
        yield from _leaves(inner, f"{name} {word}")


def _section(name: str, command: Command) -> Iterator[list[str]]:
    context = command.context_class(command, info_name=name)
    yield [f"## `{name}`"]
    usage = " ".join([name, *command.collect_usage_pieces(context)])
    yield ["```text", usage, "```"]
    for paragraph in inspect.cleandoc(command.help or "").split("\n\n"):
        example = paragraph.startswith("\b")
        lines = paragraph.removeprefix("\b").strip("\n").splitlines()
        yield ["```sh", *lines, "```"] if example else lines
    records = [param.get_help_record(context) for param in command.params]
    rows = [f"| `{_escaped(name)}` | {_escaped(text)} |" for name, text in filter(None, records)]
    yield ["| | |", "|---|---|", *rows]


def _escaped(text: str) -> str:
    return text.replace("|", "\\|")
