"""The page: our tables and pictures beside the paper's numbers, as Markdown and as HTML."""

from collections.abc import Iterator
from pathlib import Path

from ..export import TableRow, html_page, markdown_table
from ..files import write_text
from .experiment import MeasuredRun
from .reported import (
    N_COMPONENTS,
    N_STEPS,
    SECONDS_PER_MATERIAL,
    SECONDS_PER_PICTURE,
    SMALL_EIGENVALUE,
    TABLE_1,
)
from .reproduction import Reproduction


def write_page(folder: Path, results: Reproduction) -> None:
    """Write ``page.md`` and ``page.html`` beside the pictures that they show."""
    text = "\n\n".join(_sections(results)) + "\n"
    html = html_page("The paper's figures and tables", text)
    for name, content in (("page.md", text), ("page.html", html)):
        write_text(folder / name, content)


def _sections(results: Reproduction) -> Iterator[str]:
    yield _head(results)
    yield from _table_1(results)
    yield from _plots(results)
    yield from _runs(results)
    yield from _comparison(results)
    yield from _costs(results)
    yield _differences(results)


def _head(results: Reproduction) -> str:
    return (
        "# The paper's figures and tables\n\n"
        "Every table and figure of *Using Dimensionality Reduction to Create New Materials from Tabular BRDFs* "
        "(da Silva Nunes, Miranda Jr., Trinchão Andrade), made by `halfway reproduce` on "
        f"`{Path(results.report.library).name}`: {results.n_materials} materials, {results.report.description}. "
        "Where the paper gives a number, ours stands beside it; [what differs](#what-differs) is at the end."
    )


def _table_1(results: Reproduction) -> Iterator[str]:
    yield "## Table I: error of the reconstruction"
    columns = (
        "components", "the paper", "ours", "uncentred", "over all materials", "variance left",
    )  # fmt: skip
    yield markdown_table(columns, map(_table_1_row, results.report.table_1))
    yield (
        "*Ours* is the mean over materials and channels of |u - u_k| / |u|, where u is a material minus the mean "
        "material and u_k its reconstruction from k components. The paper names its number *mean relative error* and "
        "gives no formula; the other usual readings stand to the right."
    )


def _table_1_row(row: TableRow) -> tuple[str, ...]:
    reported = TABLE_1.get(row.n_components)
    return (
        str(row.n_components),
        f"{reported:.4f}" if reported else "",
        f"**{row.mean_relative_error:.4f}**",
        f"{row.mean_relative_error_uncentred:.4f}",
        f"{row.total_relative_error:.4f}",
        f"{row.unexplained_variance:.2e}",
    )


def _plots(results: Reproduction) -> Iterator[str]:
    yield "## Figure 2: materials as points, and their triangulation"
    yield _picture("figure-2.webp", "Two scores per channel and their Delaunay triangulation")
    yield (
        "The paper shows the red channel. A few mirror-like materials stand far from the rest; the lower row shows "
        "where most are. The sign of a component is a convention, so the picture may be mirrored."
    )
    yield "## Figure 3: eigenvalues"
    yield _picture(
        "figure-3.webp", "Eigenvalues per channel, and the variance that k components leave"
    )
    yield (
        f"The paper: with {N_COMPONENTS} components the eigenvalues that remain are below {SMALL_EIGENVALUE:g} in all "
        "channels; it does not say in what unit. As shares of the sum of all, ours are below "
        f"{SMALL_EIGENVALUE:g} after {results.n_components} components, and after {N_COMPONENTS} the largest that remains is "
        f"{results.share_after_36:.1e}."
    )


def _runs(results: Reproduction) -> Iterator[str]:
    fabrics, speculars, far = results.runs
    yield f"## Figure 5: {_way(fabrics)}"
    yield _picture("figure-5.webp", f"Teapots from {_way(fabrics)}, at the paper's t")
    yield _stood_in(fabrics) + (
        f"The paper's space, evenly spaced t, the t of the paper's pictures. All {N_STEPS} materials are mixed from "
        f"{fabrics.n_materials} of the library's."
    )
    yield f"## Figure 6: {_way(speculars)}"
    yield _picture("figure-6.webp", f"Teapots from {_way(speculars)}, at the paper's t")
    yield _stood_in(speculars) + (
        f"Mixed from {speculars.n_materials} of the library's materials."
        if speculars.n_materials > 2
        else "The two are neighbours in every channel's triangulation, so here the paper's method is linear interpolation."
    )
    yield f"## Figure 7: {_way(far)}"
    yield _picture("figure-7.webp", f"Spheres from {_way(far)}: far steps above, near steps below")
    yield _stood_in(far) + (
        f"The paper's point is that few materials leap here and a finer list of t does not. With {N_STEPS} materials the "
        f"largest visible step is {results.largest_step['51']:.1f} (CIEDE2000, mean over a lit sphere), with t = 0.0001, "
        f"0.0002 ... 1 it is {results.largest_step['fine']:.2f}. The lower row takes six of the fine list that look "
        "equally far apart."
    )
    yield "## Figure 8: three new materials in one scene"
    yield _picture("figure-8.webp", "Three objects in three new materials")
    yield (
        f"The third, fifth and sixth material of the lower row of Figure 7, t = "
        f"{', '.join(f'{results.fine_ts[i]:.4g}' for i in (2, 4, 5))}, with the light between the objects."
    )


def _comparison(results: Reproduction) -> Iterator[str]:
    yield "## Against linear interpolation"
    for run in results.runs:
        yield _picture(
            f"comparison-{run.figure}.webp", f"{_way(run)}: the paper's space, linear, anchored"
        )
        yield f"All {N_STEPS}, moving: [comparison-{run.figure}-moving.webp](comparison-{run.figure}-moving.webp)."
    yield (
        "The paper shows this in a video. The third row is our anchored space, which the paper does not have. *Detour* is "
        "the length of the way over the distance of its ends, and *leap* the largest step over the mean step, at evenly "
        "spaced t; 1 is the least for both."
    )
    columns = "run", "detour: paper", "linear", "anchored", "leap: paper", "linear", "anchored"
    yield markdown_table(
        columns,
        (
            (_way(run), *(f"{by[space]:.2f}" for by in (run.detour, run.jump) for space in by))
            for run in results.runs
        ),
    )


def _costs(results: Reproduction) -> Iterator[str]:
    yield "## What it costs"
    yield markdown_table(
        ("", "the paper", "ours"),
        (
            (
                "a new material",
                f"{SECONDS_PER_MATERIAL} s",
                f"{results.seconds_per_material:.2g} s",
            ),
            ("a picture", f"{SECONDS_PER_PICTURE} s", f"{results.seconds_per_picture:.2g} s"),
        ),
    )
    width, height = results.size
    yield (
        "The paper used a Core i3-4130 of 2013 and pbrt-v2, at a size and a number of samples that it does not say; ours is "
        f"this machine and Mitsuba 3 at {width} x {height} pixels and {results.spp} samples. So compare the orders of "
        "magnitude. The pictures of a run are mixed from one picture per measured material; the middle of Figure 5, "
        f"rendered in full, differs from its mixed picture by {results.mixed_picture_error:.1e} of its brightness, the noise of "
        "both included."
    )


def _differences(results: Reproduction) -> str:
    stand_in = "stand-in" in results.report.description
    measured = (
        "- **The materials are stand-ins**, fits of the measured ones: see the first paragraph. Fits are smoother than "
        "measurements, and an analytic model has fewer dimensions than the materials it fits.\n"
        if stand_in
        else ""
    )
    return (
        "## What differs\n\n"
        + measured
        + "- **The renderer** is Mitsuba 3 and not pbrt-v2. It interpolates the table "
        "between cell centres, where pbrt-v2 takes the cell's value.\n"
        "- **The environment** is a studio made by the program, where the paper has the light probe of Galileo's Tomb, which "
        "is not ours to distribute; `--env FILE` takes it. Exposure and camera are ours.\n"
        "- **Figure 8** shows two spheres and a teapot where the paper has the Dragon; `--mesh FILE` takes it.\n"
        "- **Figure 7**: the paper's text does not give the t of its spheres. The upper row takes 0, 0.2 ... 1.\n"
        "- **Unmeasured samples**: the paper counts all 1,458,000 samples of a file. We leave out those that any material "
        "lacks, as a negative value in a file is not a reflectance."
    )


def _way(run: MeasuredRun) -> str:
    return " to ".join(run.stops)


def _stood_in(run: MeasuredRun) -> str:
    if run.stops == run.stops_in_paper:
        return ""
    return f"*The library lacks the paper's {' and '.join(run.stops_in_paper)}; two others stand in for them.* "


def _picture(name: str, what: str) -> str:
    return f"![{what}]({name})"
