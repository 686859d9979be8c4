"""The page that reproduces the paper, from the neural fits of MERL: ``python docs/paper.py merl_nbrdf.zip``."""

import re
import sys
from pathlib import Path

from halfway import open_library
from halfway.cli.console import cache_folder, track
from halfway.paper import reproduce
from halfway.tasks import Work

DOCS = Path(__file__).parent
PICTURES = DOCS / "images" / "paper"
WIDTH = 240


def main(where: str) -> None:
    """Run everything into ``docs/images/paper``; the page itself stands with the others, as ``docs/paper.md``."""
    reproduce(
        PICTURES,
        open_library(where),
        size=WIDTH,
        work=Work(cache=cache_folder(), track=track),
    )
    text = (PICTURES / "page.md").read_text()
    (DOCS / "paper.md").write_text(re.sub(r"\]\((\S+\.webp)\)", r"](images/paper/\1)", text))
    numbers = PICTURES / "paper.json"
    numbers.write_text(numbers.read_text().replace(where, Path(where).name))
    for name in ("page.md", "page.html"):
        (PICTURES / name).unlink()


if __name__ == "__main__":
    main(*sys.argv[1:])
