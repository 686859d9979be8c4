"""The table of figures.json in docs/benchmarks.md: ``python benchmarks/table.py`` after ``make bench``."""

import json
from pathlib import Path

HERE = Path(__file__).parent
PAGE = HERE.parent / "docs" / "benchmarks.md"
BEGIN, END = "<!-- figures -->", "<!-- end -->"


def main() -> None:
    found = json.loads((HERE / "figures.json").read_text())
    before, rest = PAGE.read_text().split(BEGIN)
    after = rest.split(END)[1]
    PAGE.write_text(f"{before}{BEGIN}\n\n{table(found)}\n{END}{after}")


def table(found: dict) -> str:
    """The figures as a Markdown table, and where they come from."""
    lines = ["| what | compared | ratio | goal | as measured | on |", "|---|---|---|---|---|---|"]
    lines += [
        f"| {f['what']} | {f['compared']} | {f['ratio']:.3g} | {f['goal']} | {f['note']} | {f['date']} |"
        for f in found["figures"]
    ]
    about = found["about"]
    lines.append("")
    lines.append(f"{about['cores']} cores, {about['processor']}, Python {about['python']}.\n")
    return "\n".join(lines)


if __name__ == "__main__":
    main()
