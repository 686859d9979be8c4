"""The explorer as a folder of files, which any static host serves under any path: no server is needed.

    DIR/
        index.html, assets/         the page; index.html says that its data are in the folder beside it
        data/explorer.json          the library, and what the blocks hold               schema.Folder
        data/spaces/NAME.json       a space to look at                                  schema.SpaceView
        data/charts/NAME.json       its simplices, where it has points to go to         schema.ChartsFile
        data/legs/NAME/I-J.json     the way from material I to material J, I < J        schema.LegView
        data/attributes.json        the attributes of all materials                     schema.AttributesView
        data/alike.json             how different people find each two of them          schema.AlikeFile
        data/tables/I.bin           a table as half floats (`blocks`), gzip; so are
        data/thumbnails.bin, data/environment.bin       bytes with exponents, and half floats

Materials and spaces are called by number in paths, so a name may hold any letters. The folder is the explorer of a library of
these materials alone: the spaces are theirs, and no recipe needs another.

What is solved is solved here. The page puts a route's legs one after another, whoever answers for them. At a free point it
multiplies: each simplex has the matrix that gives the weights of its vertices, and a few materials have few enough simplices to
write them down. Beyond them all it takes the simplex that is least beyond, without the vertices whose weights are negative: a
mix nearby, where Python finds the nearest. Exported tables alone stay with Python: the page holds half floats.
"""

import warnings
from functools import partial
from itertools import combinations
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..batch import filling
from ..errors import DegenerateSpaceWarning, OutputError
from ..library import Library
from ..look import Looks
from ..people import distances
from ..recipes import Blend
from ..space import SPACES, Route, Space, make_space
from ..tasks import HERE, Work
from .blocks import Block
from .explorer import QUICK_PACES, Explorer, leg_view
from .guard import META_POLICY
from .page import Page
from .schema import (
    AlikeFile,
    BlockFile,
    ChartsFile,
    ChartView,
    Folder,
    LegView,
    LibrarySummary,
    Model,
)

N_LARGEST = 40
"""Materials that a folder takes: 780 legs in each space, and some thousand simplices."""
DATA = "./data/"
BLEND = Blend.LINEAR
"""Nobody mixes tables for a folder."""


class Exported(NamedTuple):
    """What `export` wrote."""

    n_files: int
    n_bytes: int


def export(
    library: Library, folder: Path, page: Page, *, force: bool = False, work: Work = HERE
) -> Exported:
    """Write the explorer of ``library`` into ``folder``, in place of an earlier one.

    Raises
    ------
    OutputError
        When the folder holds anything else, without ``force``, or cannot be written, or the library is too large for files.
    """
    if len(library) > N_LARGEST:
        raise OutputError(
            f"{library.name} has {len(library)} materials: a folder takes at most {N_LARGEST}. "
            "Name some with --materials, or choose with -n."
        )
    with filling(folder, "view", force=force) as scratch:
        explorer = Explorer(library, work=work, make=small_space)
        files = _Files(scratch)
        _write_page(files, page)
        _write_blocks(files, explorer, work)
        files.json("data/attributes.json", explorer.attributes())
        alike = distances(library, work=work)
        files.json("data/alike.json", AlikeFile(distances=alike.tolist()))
        for name in SPACES:
            _write_space(files, explorer, name, work)
        return Exported(files.n_files, files.n_bytes)


class _Files:
    """Writes into the folder, and counts."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self.n_files = self.n_bytes = 0

    def write(self, path: str, content: bytes) -> None:
        file = self._folder / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(content)
        self.n_files += 1
        self.n_bytes += len(content)

    def json(self, path: str, model: Model) -> None:
        self.write(path, model.model_dump_json().encode())

    def block(self, path: str, block: Block) -> BlockFile:
        self.write(path, block.packed)
        return BlockFile(shape=list(block.shape), scale=block.scale)


def _write_page(files: _Files, page: Page) -> None:
    for path, asset in page.assets.items():
        files.write(path, _index(asset.body) if path == "index.html" else asset.body)


def _index(html: bytes) -> bytes:
    """The page, told where its data are, and with the policy that the server sends as a header."""
    head = (
        f'<head><meta http-equiv="Content-Security-Policy" content="{META_POLICY}" />'
        f'<meta name="halfway-data" content="{DATA}" />'
    )
    return html.replace(b"<head>", head.encode(), 1)


def _write_blocks(files: _Files, explorer: Explorer, work: Work) -> None:
    names = explorer.library.names
    tables = [
        files.block(f"data/tables/{i}.bin", explorer.table(name))
        for i, name in enumerate(work.track(names, "Tables", len(names)))
    ]
    files.json(
        "data/explorer.json",
        Folder(
            library=_summary(explorer),
            thumbnails=files.block("data/thumbnails.bin", explorer.thumbnails()),
            environment=files.block("data/environment.bin", explorer.environment()),
            tables=tables,
        ),
    )


def _summary(explorer: Explorer) -> LibrarySummary:
    """What a folder can do: pictures mix in the page where the blend is linear, and it makes no tables."""
    summary = explorer.summary()
    spaces = [space.model_copy(update={"usual_blend": BLEND}) for space in summary.spaces]
    makes_no_tables = {"exports": [], "blends": [BLEND], "recolours": False}
    return summary.model_copy(
        update={**makes_no_tables, "spaces": spaces, "paces": list(QUICK_PACES)}
    )


def small_space(name: str, library: Library, **options: Any) -> Space:
    """A space whose triangulation is small enough to be written: three scores and not more."""
    n_components = min(3, max(0, len(library) - 4)) if name == "anchored" else None
    return make_space(name, library, n_components=n_components, **options)


def _write_space(files: _Files, explorer: Explorer, name: str, work: Work) -> None:
    space = explorer.space(name, BLEND)
    files.json(f"data/spaces/{name}.json", explorer.space_view(name, BLEND))
    if space.charts:
        files.json(f"data/charts/{name}.json", charts_file(space))
    pairs = list(combinations(space.names, 2))
    legs = work.run(partial(_leg, space, explorer.pictures), pairs, label=f"Legs, {name}")
    for (i, j), leg in zip(combinations(range(len(space.names)), 2), legs, strict=True):
        files.json(f"data/legs/{name}/{i}-{j}.json", leg)


def _leg(space: Space, pictures: Looks, stops: tuple[str, str]) -> LegView:
    return leg_view(Route.through(space, stops), pictures)


def charts_file(space: Space) -> ChartsFile:
    """What the page needs to find the weights at a point."""
    with warnings.catch_warnings():
        # Said already, when the space was made.
        warnings.simplefilter("ignore", DegenerateSpaceWarning)
        triangulations = space.triangulations()
    scales = [np.append(chart.coordinates.scale, 1.0) for chart in space.charts]
    return ChartsFile(
        charts=[
            ChartView(
                simplices=triangulation.simplices.tolist(),
                barycentric=(triangulation.barycentric * scale).tolist(),
            )
            for triangulation, scale in zip(triangulations, scales, strict=True)
        ]
    )
