"""Pictures, and how near the nearest of them is to another, exactly and soon.

The distance is `halfway.look.cielab_difference`, a mean over pixels of lengths. The length of a mean is at most the mean of lengths,
so the means of a few blocks of pixels bound it from below,

    sum_b n_b/n |mean over b of (x - y)|  <=  |x - y|

and only pictures whose bound is below the nearest so far are compared in full.
"""

import numpy as np
from jaxtyping import Float32

from ..look import cielab_difference

N_BLOCKS = 25
N_AT_ONCE = 16

Picture = Float32[np.ndarray, "n_pixels 3"]
"""CIELAB."""
Pictures = Float32[np.ndarray, "n n_pixels 3"]


class Apart:
    """A collection of pictures that grows."""

    def __init__(self, pictures: Pictures) -> None:
        self._pictures = list(pictures)
        n_pixels = pictures.shape[1]
        self._starts = np.linspace(0, n_pixels, min(N_BLOCKS, n_pixels), endpoint=False).astype(int)
        sizes = np.diff(np.append(self._starts, n_pixels))
        self._shares = (sizes / n_pixels).astype(np.float32)
        self._sizes = sizes[:, None].astype(np.float32)
        self._means = [self._mean(picture) for picture in pictures]

    def __len__(self) -> int:
        return len(self._pictures)

    def add(self, picture: Picture) -> None:
        """One more."""
        self._pictures.append(picture)
        self._means.append(self._mean(picture))

    def nearest(self, picture: Picture, *, within: float = np.inf, but: int | None = None) -> float:
        """The distance of the nearest, of those that are nearer than ``within``; of all but one, where one is named."""
        if not self._pictures:
            return within
        apart = np.linalg.norm(np.stack(self._means) - self._mean(picture), axis=-1)
        bounds = apart @ self._shares
        if but is not None:
            bounds[but] = np.inf
        order = bounds.argsort()
        nearest = within
        for start in range(0, len(order), N_AT_ONCE):
            some = order[start : start + N_AT_ONCE]
            some = some[bounds[some] < nearest]
            if not len(some):
                break
            others = np.stack([self._pictures[i] for i in some])
            nearest = min(nearest, float(np.min(cielab_difference(others, picture))))
        return nearest

    def _mean(self, picture: Picture) -> Float32[np.ndarray, "n_blocks 3"]:
        return np.add.reduceat(picture, self._starts, axis=0) / self._sizes
