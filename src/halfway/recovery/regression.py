"""From samples of some directions to weights on a library's materials: kernel ridge regression.

A material of which only the samples y at some directions are known is taken for a weighted sum of the rows x_r of a library,

    a = (K + eta I)^-1 k(y)        k_r(y) = x_r . y + exp(-|x_r - y|^2 / (2 width^2)),    K_rs = k_r(x_s)

with samples in the log-relative mapping, about their mean, and the mean over the samples as inner product. With an infinite width the second
term is 1 and this is the ridge regression in the span of the materials of Nielsen et al. 2015, eq. 12, whose penalised principal components
are never formed: V diag(s / (s^2 + eta)) U^T acts on the rows as (K + eta I)^-1 does. A finite width has rows that look alike at these directions count more.

What a row would be taken for if the library lacked its material follows from the same inverse B = (K + eta I)^-1: with the rows I of one material,

    left-out weights of I = 1_I - B_II^-1 B_I        zero on I

so eta and width are those of the smallest leave-one-out error. G. Wahba, "Spline Models for Observational Data", SIAM 1990, section 4.2.
J. B. Nielsen, H. W. Jensen, R. Ramamoorthi, "On Optimal, Minimal BRDF Sampling for Reflectance Acquisition", ACM TOG 34(6), 2015.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float64, Int

WIDTHS = (1.0, 2.0, 4.0, np.inf)
"""Natural logarithms: root mean square over the samples."""
ETAS = tuple(np.geomspace(1e-6, 1, 13).tolist())


@dataclass(frozen=True, eq=False)
class Regression:
    """The weights that samples give to known rows; all of them sum to 1."""

    known: Float64[np.ndarray, "n_rows n"]
    """Samples of each row, about their mean."""
    materials: Int[np.ndarray, " n_rows"]
    """Whose row each is: the rows of one material are left out together."""
    shares: Float64[np.ndarray, " n"]
    """Of the samples in the inner product; they sum to 1."""
    width: float
    eta: float

    def weights(self, samples: Float64[np.ndarray, "m n"]) -> Float64[np.ndarray, "m n_rows"]:
        """Of other rows, whose samples are about the same mean."""
        return _with_mean(self._kernel(samples) @ self._inverse(), np.ones(len(self.known), bool))

    def left_out(self) -> Float64[np.ndarray, "n_rows n_rows"]:
        """Of each known row, on the rows of other materials."""
        inverse = self._inverse()
        weights = np.zeros_like(inverse)
        for material in np.unique(self.materials):
            own = self.materials == material
            weights[own] = _with_mean(
                np.where(own, 0, -np.linalg.solve(inverse[np.ix_(own, own)], inverse[own])), ~own
            )
        return weights

    def _inverse(self) -> Float64[np.ndarray, "n_rows n_rows"]:
        return np.linalg.inv(self._kernel(self.known) + self.eta * np.eye(len(self.known)))

    def _kernel(self, samples: Float64[np.ndarray, "m n"]) -> Float64[np.ndarray, "m n_rows"]:
        inner = samples * self.shares @ self.known.T
        norms = (self.known**2) @ self.shares
        squared = (samples**2 @ self.shares)[:, None] + norms - 2 * inner
        return inner + np.exp(-np.maximum(squared, 0) / (2 * self.width**2))


def _with_mean(weights: np.ndarray, counts: np.ndarray) -> np.ndarray:
    """What is missing to a sum of 1 is the mean row's."""
    return weights + (1 - weights.sum(axis=1, keepdims=True)) * counts / counts.sum()
