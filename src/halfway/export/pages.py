"""Pages for people: Markdown as one HTML file."""

from collections.abc import Iterable, Sequence

STYLE = """
body { max-width: 62rem; margin: 3rem auto; padding: 0 1.5rem; color: #222; background: #fff;
       font: 16px/1.6 system-ui, sans-serif; }
h1, h2, h3 { line-height: 1.25; margin-top: 2.5rem; }
img { max-width: 100%; display: block; margin: 1rem 0; }
table { border-collapse: collapse; margin: 1rem 0; font-variant-numeric: tabular-nums; }
th, td { padding: .35rem 1rem .35rem 0; border-bottom: 1px solid #ddd; text-align: left; }
code { font-size: .9em; }
"""


def html_page(title: str, text: str) -> str:
    """The HTML of a page of Markdown."""
    from markdown_it import MarkdownIt

    body = MarkdownIt("commonmark").enable("table").render(text)
    return (
        f'<!doctype html>\n<html lang="en"><meta charset="utf-8"><title>{title}</title>\n'
        f"<style>{STYLE}</style>\n<body>\n{body}</body></html>\n"
    )


def markdown_table(columns: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table in Markdown."""
    lines = (columns, ["---"] * len(columns), *rows)
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)
