"""``{command-line}``: the reference of the commands, made from the commands themselves at every build.

Each command becomes a section with its usage, its text, its examples and its options, as ``--help`` says them.
"""

import inspect
from collections.abc import Iterator

import click
import typer
from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from halfway.cli import app as commands


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
    for name, command in leaves(typer.main.get_command(commands), "halfway"):
        yield from _section(name, command)


def leaves(command: click.Command, name: str) -> Iterator[tuple[str, click.Command]]:
    """Every command that does something, with its whole name, in the order of ``--help``."""
    if isinstance(command, click.Group):
        context = click.Context(command)
        for word in command.list_commands(context):
            inner = command.get_command(context, word)
            if inner is not None:
                yield from leaves(inner, f"{name} {word}")
    else:
        yield name, command


def _section(name: str, command: click.Command) -> Iterator[list[str]]:
    context = click.Context(command, info_name=name)
    yield [f"## `{name}`"]
    yield ["```text", " ".join([name, *command.collect_usage_pieces(context)]), "```"]
    for paragraph in inspect.cleandoc(command.help or "").split("\n\n"):
        kept = paragraph.startswith("\b")
        lines = paragraph.removeprefix("\b").strip("\n").splitlines()
        yield ["```console", *lines, "```"] if kept else lines
    arguments = [p for p in command.params if isinstance(p, click.Argument)]
    options = [p for p in command.params if isinstance(p, click.Option)]
    rows = [(f"`{p.make_metavar(context)}`", getattr(p, "help", None) or "") for p in arguments] + [
        (_flags(p, context), _told(p, context)) for p in options
    ]
    if rows:
        yield ["| argument or option | what it is |", "|---|---|"] + [
            f"| {left} | {_escape(right)} |" for left, right in rows
        ]


def _flags(option: click.Option, context: click.Context) -> str:
    names = ", ".join(f"`{name}`" for name in (*option.opts, *option.secondary_opts))
    metavar = "" if option.is_flag else f" `{_escape(option.make_metavar(context))}`"
    return names + metavar


def _told(option: click.Option, context: click.Context) -> str:
    default = option.get_default(context)
    shown = default not in (None, "", False) and "[default" not in (option.help or "")
    value = getattr(default, "value", default)
    return (option.help or "") + (f" Default: `{value}`." if shown else "")


def _escape(text: str) -> str:
    return text.replace("|", "\\|")
