"""Every table and figure of the paper, on any library, as files.

Pictures of a run are mixed from one picture per measured material, which is exact for direct light; one of them is
rendered in full besides, and the difference is reported.
"""

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from time import perf_counter
from typing import Any, TypeVar

import numpy as np

from ..export import Report, figures
from ..files import replacing, write_text
from ..library import Library
from ..recipes import Mixer
from ..render import BasisPictures, Renderer, pictures
from ..tasks import HERE, Work
from .experiment import SPACES, Experiment, MeasuredRun, largest_share_after, n_components_below
from .reported import (
    FABRICS,
    FAR_APART,
    N_COMPONENTS,
    N_STEPS,
    RUNS,
    SMALL_EIGENVALUE,
    SPECULARS,
    Run,
)

T = TypeVar("T")

FORMAT = 1
N_FINE = 6
DRESSED = 2, 4, 5
"""Of the finely spaced spheres of Figure 7, those whose materials the scene of Figure 8 wears: i, k and l."""
N_COMPARED = 7
MIDDLE = 0.5


@dataclass(frozen=True)
class Reproduction:
    """What `reproduce` found."""

    report: Report
    n_materials: int
    n_components: int
    """Components until every further eigenvalue is below .001 of the sum of its channel."""
    share_after_36: float
    """The largest share that an eigenvalue after the paper's 36 has of the sum of its channel."""
    runs: tuple[MeasuredRun, ...]
    largest_step: dict[str, float]
    """Of the run of Figure 7, in CIEDE2000, with 51 materials and with the fine list of t."""
    fine_ts: tuple[float, ...]
    """The t of the finely spaced spheres."""
    seconds_per_material: float
    seconds_per_picture: float
    mixed_picture_error: float
    """Mean |mixed - rendered| / mean rendered, of the middle of Figure 5."""
    size: tuple[int, int]
    spp: int

    def to_json(self) -> dict[str, Any]:
        """The document paper.json."""
        own = {key: value for key, value in asdict(self).items() if key != "report"}
        return {**self.report.to_json(), "format": FORMAT, **own}


def reproduce(
    folder: Path,
    library: Library,
    *,
    size: int = 320,
    spp: int = 64,
    env: Path | None = None,
    mesh: Path | None = None,
    work: Work = HERE,
) -> Reproduction:
    """Run everything and write it into ``folder``: pictures, ``page.md``, ``page.html`` and ``paper.json``.

    Parameters
    ----------
    size : int
        Width of one picture in pixels.
    spp : int
        Samples per pixel.
    env : path, optional
        Environment in place of the studio.
    mesh : path, optional
        In place of the objects of Figure 8.

    Raises
    ------
    LibraryError
        With fewer than six materials.
    """
    from .page import write_page

    experiment = Experiment.fit(library, work=work)
    shape = (size, round(size / 1.25))
    teapot = Renderer("teapot", size=shape, spp=spp, env=env)
    basis = BasisPictures(teapot, library.brdf, work=work)
    spheres = BasisPictures(Renderer("spheres", size=(size, size), spp=spp), library.brdf)
    trio = Renderer("trio", size=(2 * size, round(1.2 * size)), spp=spp, env=env, mesh=mesh)
    draw = _Draw(folder, experiment, work)

    draw.plots()
    draw.figure(FABRICS, basis, columns=5)
    draw.figure(SPECULARS, basis, columns=4)
    draw.comparison(FABRICS, basis)
    draw.comparison(SPECULARS, basis)
    fine_ts = experiment.evenly_seen(FAR_APART, N_FINE)
    draw.spheres(fine_ts, spheres)
    draw.comparison(FAR_APART, spheres)
    draw.new_materials([fine_ts[i] for i in DRESSED], trio)

    reproduction = Reproduction(
        Report.of(library, experiment.pca),
        len(library),
        n_components_below(experiment.pca.eigenvalues, SMALL_EIGENVALUE),
        largest_share_after(experiment.pca.eigenvalues, N_COMPONENTS),
        tuple(experiment.measure(run) for run in RUNS),
        experiment.largest_steps(FAR_APART),
        fine_ts,
        *_one_in_full(experiment, teapot, basis),
        shape,
        spp,
    )
    write_text(folder / "paper.json", json.dumps(reproduction.to_json(), indent=1))
    write_page(folder, reproduction)
    return reproduction


class _Draw:
    """The pictures, one file each, named after the paper's figures."""

    def __init__(self, folder: Path, experiment: Experiment, work: Work) -> None:
        self._folder = folder
        self._experiment = experiment
        self._work = work

    def plots(self) -> None:
        """Figures 2 and 3."""
        pca, label = self._experiment.pca, Path(self._experiment.library.name).name
        for number, draw in (2, figures.triangulation), (3, figures.eigenvalues):
            with replacing(self._folder / f"figure-{number}.webp") as temporary:
                draw(pca, label).savefig(temporary, format="webp", dpi=110)

    def figure(self, run: Run, basis: BasisPictures, *, columns: int) -> None:
        """Figure 5 or 6: the paper's choice of t."""
        labels = [f"t = {t:.2f}" for t in run.ts]
        images = self._images(run, "paper", run.ts, basis)
        self._write(f"figure-{run.figure}", pictures.sheet(images, labels=labels, columns=columns))

    def comparison(self, run: Run, basis: BasisPictures) -> None:
        """The paper's space, linear interpolation and ours, one row each; and all 51 materials side by side, moving."""
        ts = np.linspace(0, 1, N_COMPARED)
        rows = [image for space in SPACES for image in self._images(run, space, ts, basis)]
        labels = [f"{space}, {t:.2f}" for space in SPACES for t in ts]
        name = f"comparison-{run.figure}"
        self._write(name, pictures.sheet(rows, labels=labels, columns=N_COMPARED))
        every = [self._images(run, space, np.linspace(0, 1, N_STEPS), basis) for space in SPACES]
        frames = (pictures.strip(frame, labels=SPACES) for frame in zip(*every, strict=True))
        pictures.animate(self._folder / f"{name}-moving.webp", frames, fps=10)

    def spheres(self, fine_ts: Sequence[float], basis: BasisPictures) -> None:
        """Figure 7: a row of far materials and a row of near ones."""
        ts = (*FAR_APART.ts, *fine_ts)
        images = self._images(FAR_APART, "paper", ts, basis)
        labels = [f"t = {t:.4g}" for t in ts]
        self._write("figure-7", pictures.sheet(images, labels=labels, columns=len(FAR_APART.ts)))

    def new_materials(self, ts: Sequence[float], trio: Renderer) -> None:
        """Figure 8: three new materials in one scene, with the light between them."""
        recipes = self._experiment.route(FAR_APART).recipes(ts)
        mixer = Mixer(self._experiment.library)
        self._write("figure-8", trio.picture([mixer.mix(recipe) for recipe in recipes]))

    def _images(
        self, run: Run, space: str, ts: Sequence[float] | np.ndarray, basis: BasisPictures
    ) -> list[np.ndarray]:
        recipes = self._experiment.route(run, space).recipes(list(ts))
        basis.render(sorted({n for recipe in recipes for n in recipe.names}))
        return [basis.picture(recipe) for recipe in recipes]

    def _write(self, name: str, image: np.ndarray) -> None:
        pictures.write(self._folder / f"{name}.webp", image)


def _one_in_full(
    experiment: Experiment, renderer: Renderer, basis: BasisPictures
) -> tuple[float, float, float]:
    """Seconds to mix a material and to render it, and how far the mixed picture is from the rendered one."""
    recipe = experiment.route(FABRICS).recipe(MIDDLE)
    mixer = Mixer(experiment.library)
    mixer.mix(recipe)  # compiles, and reads the rows
    table, seconds_per_material = _timed(lambda: mixer.mix(recipe))
    rendered, seconds_per_picture = _timed(lambda: renderer.picture(table))
    mixed = basis.picture(recipe)
    error = float(np.abs(mixed - rendered).mean() / rendered.mean())
    return seconds_per_material, seconds_per_picture, error


def _timed(work: Callable[[], T]) -> tuple[T, float]:
    start = perf_counter()
    return work(), perf_counter() - start
