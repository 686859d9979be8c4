"""The report on a library: the paper's Table I and Figures 2 and 3, for any library, as pictures and numbers.

The paper gives no formula for its "mean relative error". Of the usual definitions, the mean over materials and channels
of |u_i - u_i,k| / |u_i| (u centred) comes nearest to its numbers, and leads; the others stand beside it by name.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..components import Pca
from ..files import write_text
from ..library import Library
from ..locations import Location
from ..recipes import CHANNELS
from . import figures

FORMAT = 1
N_COMPONENTS = (3, 5, 15, 30, 36, 45)
"""The paper's, in Table I."""


@dataclass(frozen=True)
class TableRow:
    """Errors of the k-component reconstructions of a library, all channels together."""

    n_components: int
    mean_relative_error: float
    """Mean of |u_i - u_i,k| / |u_i|, u centred."""
    mean_relative_error_uncentred: float
    """Mean of |p_i - p_i,k| / |p_i|."""
    total_relative_error: float
    """Mean over channels of sqrt(sum |u_i - u_i,k|^2 / sum |u_i|^2)."""
    unexplained_variance: float
    """Mean over channels of (sum of the eigenvalues after k) / (sum of all)."""
    rms_error: float
    """sqrt of the mean squared error of a sample, 1/sr."""


@dataclass(frozen=True)
class Report:
    """What `write_report` found."""

    library: str
    description: str
    table_1: tuple[TableRow, ...]
    eigenvalues: Mapping[str, list[float]]
    spaces: tuple[Mapping[str, Any], ...] = ()
    """Measures of each space: `halfway.judge.Evaluation` and `halfway.judge.LeaveOneOut`, as JSON."""

    def to_json(self) -> dict[str, Any]:
        """The document that ``halfway report --json`` prints."""
        return {"format": FORMAT, **asdict(self)}

    @classmethod
    def of(
        cls,
        library: Library,
        pca: Pca,
        *,
        n_components: Sequence[int] = N_COMPONENTS,
        spaces: Sequence[Mapping[str, Any]] = (),
    ) -> "Report":
        """Table I for each number of components that the library has, its eigenvalues, and what `compare_spaces` gives."""
        table = tuple(table_row(pca, k) for k in n_components if k < len(library))
        eigenvalues = dict(zip(CHANNELS, pca.eigenvalues.tolist(), strict=True))
        return cls(library.name, library.origin.description, table, eigenvalues, tuple(spaces))

    def lines(self) -> list[str]:
        """The tables, to be read."""
        return [*_table_lines(self.table_1), *_space_lines(self.spaces)]


def table_row(pca: Pca, n_components: int) -> TableRow:
    """The errors of the reconstructions from ``n_components`` components, by every usual definition."""
    residuals = pca.squared_residuals(n_components)
    centred = pca.squared_residuals(0)
    # A material at the centroid has nothing to reconstruct, and no error.
    relative = np.sqrt(residuals / np.where(centred > 0, centred, 1.0))
    uncentred = np.sqrt(residuals / np.where(pca.squared_norms > 0, pca.squared_norms, 1.0))
    unexplained = residuals.sum(axis=1) / np.maximum(centred.sum(axis=1), np.finfo(float).tiny)
    n_samples = len(pca.names) * sum(pca.n_cells)
    return TableRow(
        n_components,
        float(relative.mean()),
        float(uncentred.mean()),
        float(np.sqrt(unexplained).mean()),
        float(unexplained.mean()),
        float(np.sqrt(residuals.sum() / n_samples)),
    )


def write_report(
    folder: Location,
    library: Library,
    pca: Pca,
    *,
    n_components: Sequence[int] = N_COMPONENTS,
    spaces: Sequence[Mapping[str, Any]] = (),
) -> Report:
    """Write report.json and the figures into ``folder``; ``spaces`` are those of `compare_spaces`."""
    report = Report.of(library, pca, n_components=n_components, spaces=spaces)
    write_text(folder / "report.json", json.dumps(report.to_json(), indent=1))
    label = Path(library.name).name
    if "stand-in" in library.origin.description:
        label += " (stand-ins, not measurements)"
    figures.write(folder / "eigenvalues", figures.eigenvalues(pca, label))
    figures.write(folder / "triangulation", figures.triangulation(pca, label))
    if spaces:
        figures.write(folder / "spaces", figures.spaces(spaces, label))
    return report


def _table_lines(rows: Sequence[TableRow]) -> list[str]:
    head = "components  mean relative error  uncentred  total    unexplained variance  rms error (1/sr)"
    return [head] + [
        f"{row.n_components:10d}  {row.mean_relative_error:19.4f}  {row.mean_relative_error_uncentred:9.4f}  "
        f"{row.total_relative_error:7.4f}  {row.unexplained_variance:20.2e}  {row.rms_error:16.4g}"
        for row in rows
    ]


def _space_lines(spaces: Sequence[Mapping[str, Any]]) -> list[str]:
    head = "space, blend      detour: median  90 %   max  jump, perceptual: max  judged  hue strays  realism  others  left out: log  seen"
    return [head, *map(_space_line, spaces)] if spaces else []


def _space_line(space: Mapping[str, Any]) -> str:
    detour, left = space["detour"], space.get("leave_one_out")
    name = f"{space['space']}, {space['blend']}"
    return (
        f"{name:17} {detour['median']:14.3f} {detour['90th percentile']:5.2f} {detour['max']:5.2f} "
        f"{space['jump']['perceptual']['max']:22.3f} {space['judged_jump']['perceptual']['max']:7.3f} "
        f"{space['hue_excursion']['median']:11.2f} {space['realism']['log by cell']['median']:8.4f} "
        f"{space['others']['median']:7.2f} "
        + (
            f"{left['log']['mean']:14.4f} {left['seen']['mean']:5.2f}"
            if left
            else "             -     -"
        )
    )
