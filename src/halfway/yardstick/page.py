"""The page of a benchmark: what was measured, in plots and tables, beside what others published."""

import json
from collections.abc import Iterator, Sequence
from importlib.resources import files
from pathlib import Path

from ..export import html_page, markdown_table
from ..files import write_text
from .plots import curves
from .results import Benchmark, Result
from .scores import MEASURES

TITLE = "A yardstick for materials"
PLOTTED = ("mean-log", "psnr.judging")
IN_TABLES = ("mean-log", "log", "log-relative", "rmse.judging", "psnr.judging", "ssim.judging", "flip.judging", "ciede2000.judging")  # fmt: skip
SETTINGS = {3, 5, 10, 20, 40}
"""k and n in tables; plots have all."""
SPLITS = {
    "liu2023": "20 of the MERL materials, by the 80 others, as Liu et al. 2023 split them",
    "kind": "what is alike left out together: all fabrics by what is no fabric, and so on",
    "leave-one-out": "each material by all others",
}


def write_page(folder: Path, measured: Benchmark) -> None:
    """Write ``benchmark.json``, and ``benchmark.html`` with everything in it."""
    text = "\n\n".join(_sections(measured)) + "\n"
    documents = {
        "benchmark.json": json.dumps(measured.to_json(), indent=1),
        "benchmark.html": html_page(TITLE, text),
    }
    for name, content in documents.items():
        write_text(folder / name, content)


def _sections(measured: Benchmark) -> Iterator[str]:
    yield _head(measured)
    yield _in_short(measured)
    yield from _reconstructed(measured)
    yield from _recovered(measured)
    yield from _halfway(measured)
    yield from _triplets(measured)
    yield from _published()
    yield _how(measured)


def _head(measured: Benchmark) -> str:
    origin, grid = measured.origin, " x ".join(map(str, measured.grid))
    return (
        f"# {TITLE}\n\n"
        "A BRDF says how a surface reflects light: how much of what comes from one direction leaves in another. Measured ones are tables of a million "
        "numbers. This page says how well they are held in a few numbers, recovered from a few measured directions, mixed halfway, and compared as "
        "people compare them: each method by the same materials, split in the same way, in the same measures.\n\n"
        f"- **Materials**: `{Path(measured.library).name}`: {origin.description or 'no description'}. Source: {origin.source or 'not stated'}.\n"
        f"- **Grid**: {grid} cells of half and difference angles.\n"
        "- **Fair**: a method learns from training materials alone, also which directions to ask for and how strongly to smooth.\n"
        f"- **Made** by `halfway benchmark`, in {measured.seconds / 60:.1f} minutes, seed {measured.seed}; every number, with all measures, is in "
        "`benchmark.json`.\n\n"
        "Small is good in all measures but PSNR and SSIM. [How each is measured](#how) is at the end."
    )


def _in_short(measured: Benchmark) -> str:
    """The best of each task, in a sentence each."""
    said: list[str] = []
    for task, said_of, what in (
        ("reconstruct", "With", "numbers"),
        ("recover", "From", "measured directions"),
    ):
        results = measured.of(task, next((r.split for r in measured.of(task)), ""))
        settings = sorted({r.setting for r in results if r.setting in SETTINGS})
        for setting in settings[-2:]:
            best = min(
                (r for r in results if r.setting == setting), key=lambda r: r.scores["mean-log"]
            )
            said.append(
                f"- {said_of} {setting} {what}, *{best.method}* makes the nearest tables: {_shown(best, 'psnr.judging')} dB in pictures of a sphere."
            )
    return "## In short\n\n" + "\n".join(said)


def _reconstructed(measured: Benchmark) -> Iterator[str]:
    yield "## A material in k numbers"
    yield (
        "How much of a material is left when it is held in k numbers: scores on principal components, which one of the training materials it is, "
        "weights of a mix of them, or parameters of a model that is fitted to it. A test material has no part in what its method learned."
    )
    for split in dict.fromkeys(r.split for r in measured.of("reconstruct")):
        results = measured.of("reconstruct", split)
        yield f"### {split}: {SPLITS.get(split, '')}"
        plotted = [r for r in results if r.setting]
        yield _plot(plotted, "numbers per material, k")
        yield from _tables(results, "k")


def _recovered(measured: Benchmark) -> Iterator[str]:
    results = measured.of("recover")
    if not results:
        return
    yield "## A material from n measured directions"
    yield (
        "A goniometer has measured n pairs of directions; the rest of the table is recovered by what other materials teach. *halfway* is "
        "`halfway recover` at the directions of `halfway plan`; *nearest mix* keeps all laws of a BRDF, the others do not. Where directions are drawn "
        "at random, the band holds 95 % of the draws."
    )
    yield _plot(results, "measured pairs of directions, n")
    yield from _tables(results, "n")


def _halfway(measured: Benchmark) -> Iterator[str]:
    results = measured.of("halfway")
    if not results:
        return
    yield "## Halfway between two materials"
    yield (
        "Ladders are materials whose highlights widen from rung to rung by one factor. What lies halfway between two rungs is known: the rung in the middle. A blend "
        "is given the two, half and half (the test of Bonneel et al. 2011). First number: difference in the metric *log*; second: mean CIELAB difference on a "
        "lit sphere."
    )
    ladders = list(dict.fromkeys(r.split for r in results))
    rows = [
        (blend, *(f"{r.scores['log']:.4f} / {r.scores['seen']:.1f}" for r in results if r.method == blend))
        for blend in dict.fromkeys(r.method for r in results)
    ]  # fmt: skip
    yield markdown_table(("blend", *ladders), rows)


def _triplets(measured: Benchmark) -> Iterator[str]:
    results = measured.of("triplets")
    if not results:
        return
    yield "## Which looks more like it"
    yield (
        "People were shown three materials and asked which of two looks more like the third. A distance foretells an answer. "
        "The weights of `halfway.distances` were fitted to such answers about the same materials: its row is no test, the others are."
    )
    rows = [(r.method, f"{r.scores['raw']:.1%}", f"{r.scores['majority']:.1%}") for r in results]
    yield markdown_table(("distance", "with a vote", "with the majority"), rows)


def _published() -> Iterator[str]:
    yield "## What others published"
    yield (
        "Other materials, other splits, other scenes: these numbers stand beside ours and not in a column with them. Each table has a protocol of its own."
    )
    text = files("halfway.yardstick").joinpath("data", "published.json").read_text("utf-8")
    for table in json.loads(text):
        yield f"**{table['source']}**: {table['protocol']}."
        yield markdown_table(table["columns"], table["rows"])


def _how(measured: Benchmark) -> str:
    skipped = "".join(f"\n- {what}: {why}." for what, why in measured.skipped.items())
    return (
        '<h2 id="how">How it is measured</h2>\n\n'
        "- **mean Δ ln(1 + f cos)**: mean of the absolute difference over cells and channels; cells with both directions within 80 degrees of the normal, here and below.\n"
        "- **log, log-relative, cube root, cosine**: root mean square over solid angle, in the mappings of Löw 2012, Nielsen 2015, Fores 2012, Ngan 2005.\n"
        "- **MAE, RMSE, PSNR, SSIM**: of sRGB pictures of a sphere, 64 x 64, direct light, clipped at white. **FLIP, CIEDE2000**: of the same, highlights "
        "compressed as a display would. In two scenes: *judging*, three lights and a sky, in which nothing is chosen; *pacing*, the other, in `benchmark.json`.\n"
        "- What is negative in an estimate counts as 0.\n"
        "- **PCA**: one analysis of all three channels. *linear*: f as it is, every cell alike; *square root*: of f, cells weighed as light uses them; "
        "*log-relative*: Nielsen's mapping.\n"
        "- **ridge**: Nielsen's, with his eta of 40, at directions of least condition number (Nielsen 2015), of a matching pursuit (FROST 2024), or drawn.\n"
        "- **ABC, SGD**: the published fits. **GGX, OpenPBR**: fits of `halfway fit`. A fit sees the whole test material.\n"
        "- **NBRDF**: the network of Sztrajman et al. 2021, fitted to each material as there. Where the materials are such networks themselves, it could be exact.\n"
        "- **neural process**: the published networks, which had all measured MERL materials in their training set. Where the materials are stand-ins of those, "
        "what sets the two apart counts as an error of the networks.\n\n"
        "A method is one function; `halfway.yardstick` says which. Not measured here:"
        + (skipped or " nothing.")
    )


def _plot(results: Sequence[Result], setting: str) -> str:
    # Markdown's own pictures may not hold a drawing.
    picture = curves(results, PLOTTED, setting)
    return f'<p><img alt="Errors over {setting}" src="{picture}"></p>'


def _tables(results: Sequence[Result], setting: str) -> Iterator[str]:
    """The measure that is plotted first, a line for each method; and all others, folded."""
    drawn = " Of drawn directions, the mean, and what 95 % of the draws lie between."
    said = drawn if any(r.low for r in results) else ""
    yield f"**{MEASURES[PLOTTED[0]].label}**, small is good.{said}"
    yield _short_table(results, setting)
    yield "<details><summary>The other measures</summary>"
    yield _long_table(results, setting)
    yield "</details>"


def _short_table(results: Sequence[Result], setting: str) -> str:
    chosen = [r for r in results if r.setting in SETTINGS or r.method not in _several(results)]
    settings = sorted({r.setting for r in chosen} & SETTINGS)
    rows: dict[str, dict[int, str]] = {}
    for r in chosen:
        own = "" if r.setting in settings else f" ({setting} = {r.setting or 'its own'})"
        column = r.setting if r.setting in settings else 0
        rows.setdefault(_unbroken(r.method) + own, {})[column] = _with_interval(r, PLOTTED[0])
    has_own = any(0 in row for row in rows.values())
    columns = [*settings, *([0] if has_own else [])]
    return markdown_table(
        ("method", *(f"{setting} = {x}" if x else f"another {setting}" for x in columns)),
        [(method, *(row.get(x, "") for x in columns)) for method, row in rows.items()],
    )


def _long_table(results: Sequence[Result], setting: str) -> str:
    columns = (MEASURES[name].label.replace(", judging", "") for name in IN_TABLES)
    rows = [
        (_unbroken(r.method), str(r.setting) if r.setting else "own", *(_shown(r, name) for name in IN_TABLES))
        for r in results
        if r.setting in SETTINGS or r.method not in _several(results)
    ]  # fmt: skip
    return markdown_table(("method", setting, *columns), rows)


def _several(results: Sequence[Result]) -> set[str]:
    """The methods that were asked for several settings."""
    methods = [r.method for r in results]
    return {method for method in methods if methods.count(method) > 1}


def _unbroken(name: str) -> str:
    return name.replace(" ", "\N{NO-BREAK SPACE}")


def _with_interval(result: Result, name: str) -> str:
    ends = f" ({result.low[name]:.3f} to {result.high[name]:.3f})" if result.low else ""
    return _unbroken(f"{result.scores[name]:.3f}{ends}")


def _shown(result: Result, name: str) -> str:
    value = result.scores[name]
    digits = 1 if name.startswith("psnr") else 2 if name.startswith("ciede2000") else 4
    return f"{value:.{digits}f}"
