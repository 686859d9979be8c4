"""How near an estimate of a material is, by every measure that the field reports.

On tables, over the cells with both directions within 80 degrees of the normal (`halfway.brdf.metrics`):

    log, cube-root, cosine, log-relative    root mean square over solid angle
    mean-log                                mean over cells of |ln(1 + f cos_i) - ln(1 + g cos_i)|, each cell alike

On pictures of a lit sphere in the two scenes of `halfway.look`, 64 x 64, direct light, over the sphere's pixels: MAE, RMSE, PSNR and SSIM
of sRGB values clipped to [0, 1]; CIEDE2000 and FLIP of what a display with a shoulder shows.

Reference: Z. Wang, A. C. Bovik, H. R. Sheikh, E. P. Simoncelli, "Image Quality Assessment: From Error Visibility to Structural
Similarity", IEEE Transactions on Image Processing 13(4), 2004 (SSIM: a Gaussian of 1.5 pixels, means over channels).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Float64

from .._types import Mask, Table
from ..brdf import TabularBrdf, difference, metrics, quadrature
from ..colour import to_srgb
from ..halfdiff import Grid
from ..look import JUDGING_SCENE, PACING_SCENE, FilledSphere, appearance, ciede2000_difference, flip

MOST_PSNR = 99.0
"""Of pictures that are the same."""
Scores = Mapping[str, float]
Pixels = Float64[np.ndarray, "n_pixels 3"]


class Measure(NamedTuple):
    """What a score is."""

    label: str
    larger_is_better: bool = False


TABLE_MEASURES = {
    "mean-log": Measure("mean Δ ln(1 + f cos)"),
    "log": Measure("log (RMS)"),
    "cube-root": Measure("cube root (RMS)"),
    "cosine": Measure("cosine-weighted (RMS)"),
    "log-relative": Measure("log-relative (RMS)"),
}
PICTURE_MEASURES = {
    "mae": Measure("MAE"),
    "rmse": Measure("RMSE"),
    "psnr": Measure("PSNR (dB)", larger_is_better=True),
    "ssim": Measure("SSIM", larger_is_better=True),
    "flip": Measure("FLIP"),
    "ciede2000": Measure("CIEDE2000"),
}
SCENES = (PACING_SCENE, JUDGING_SCENE)
MEASURES: Mapping[str, Measure] = TABLE_MEASURES | {
    f"{name}.{scene.name}": Measure(f"{measure.label}, {scene.name}", measure.larger_is_better)
    for scene in SCENES
    for name, measure in PICTURE_MEASURES.items()
}
"""By name; those of pictures end with their scene."""


@dataclass(frozen=True, eq=False)
class Judge:
    """Compares tables on one grid."""

    grid: Grid
    spheres: tuple[FilledSphere, ...]
    pixels: tuple[Mask, ...]
    """Of the spheres, in the picture of each scene."""

    @classmethod
    def of(cls, grid: Grid) -> "Judge":
        mask = grid.mask()
        spheres = (FilledSphere.of(scene, grid, measured=mask) for scene in SCENES)
        return cls(grid, tuple(spheres), tuple(scene.mask() for scene in SCENES))

    def knowing(self, truth: Table) -> "Known":
        """What estimates of a material are compared with."""
        return Known(self, truth, self.pictures(truth))

    def pictures(self, table: Table) -> list[Pixels]:
        """Of the sphere in each scene, linear RGB."""
        filled = np.nan_to_num(table)[:, None]
        return [sphere.pictures(filled)[0].astype(np.float64) for sphere in self.spheres]


@dataclass(frozen=True, eq=False)
class Known:
    """A material whose table is known."""

    judge: Judge
    truth: Table
    pictures: list[Pixels]

    def scores(self, estimate: np.ndarray) -> Scores:
        """All `MEASURES` of an estimate, where the material is measured; what is negative counts as 0."""
        sound, grid = np.maximum(estimate, 0).astype(np.float32), self.judge.grid
        sound[np.isnan(self.truth)] = np.nan
        f, g = (TabularBrdf(x.reshape(3, *grid.shape), grid) for x in (self.truth, sound))
        scores = {"mean-log": _mean_log(grid, self.truth, sound)}
        scores |= {
            name: difference(f, g, name).below
            for name in TABLE_MEASURES.keys() & metrics.MAPPINGS.keys()
        }
        pixels, pictures = self.judge.pixels, self.judge.pictures(sound)
        for scene, mask, *pair in zip(SCENES, pixels, self.pictures, pictures, strict=True):
            of_scene = _picture_scores(mask, *pair)
            scores |= {f"{name}.{scene.name}": value for name, value in of_scene.items()}
        return scores


def _mean_log(grid: Grid, truth: Table, estimate: Table) -> float:
    cells = quadrature.comparison_cells(grid)
    counted = (grid.mask() & ~cells.grazing).ravel()
    cos_i = cells.cos_i.ravel()[counted]
    f, g = (np.log1p(x[:, counted] * cos_i) for x in (truth, estimate))
    return float(np.nanmean(np.abs(f - g)))


def _picture_scores(mask: Mask, truth: Pixels, estimate: Pixels) -> Scores:
    coded = [to_srgb(x) for x in (truth, estimate)]
    off = coded[0] - coded[1]
    square = float(np.square(off).mean())
    whole = [_whole(x, mask) for x in (*coded, truth, estimate)]
    return {
        "mae": float(np.abs(off).mean()),
        "rmse": square**0.5,
        "psnr": min(MOST_PSNR, float(-10 * np.log10(square))) if square else MOST_PSNR,
        "ssim": float(ssim(*whole[:2])[mask].mean()),
        "flip": flip(*whole[2:]),
        "ciede2000": float(ciede2000_difference(appearance(truth), appearance(estimate))),
    }


def _whole(pixels: Pixels, mask: np.ndarray) -> Float64[np.ndarray, "size size 3"]:
    picture = np.zeros((*mask.shape, 3))
    picture[mask] = pixels
    return picture


def ssim(
    a: Float[np.ndarray, "height width 3"], b: Float[np.ndarray, "height width 3"]
) -> Float[np.ndarray, "height width"]:
    """Structural similarity at each pixel of two pictures in [0, 1]; the mean of the channels."""
    from scipy.ndimage import gaussian_filter  # a second to load

    def mean(x: np.ndarray) -> np.ndarray:
        return gaussian_filter(x, sigma=(1.5, 1.5, 0), truncate=3.5)

    c1, c2 = 0.01**2, 0.03**2
    mean_a, mean_b = mean(a), mean(b)
    variance_a, variance_b = mean(a * a) - mean_a**2, mean(b * b) - mean_b**2
    covariance = mean(a * b) - mean_a * mean_b
    alike = (2 * mean_a * mean_b + c1) * (2 * covariance + c2)
    whole = (mean_a**2 + mean_b**2 + c1) * (variance_a + variance_b + c2)
    return (alike / whole).mean(axis=-1)
