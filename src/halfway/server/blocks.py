"""Numbers for the page: half floats and the scale that makes them fit, or a byte for each and an exponent for each pixel.

    value = scale x half float              tables, environments; see `halfway.brdf.half_scale`
    value = byte x 2^(exponent - 136)       small pictures: R, G, B, exponent; an exponent of 0 is beside the sphere

A table goes over as RGBA in the order of its axes; without phi_h that is
the order of a 3-D texture (width phi_d, height theta_d, depth theta_h). Alpha is 1 where the sample is
measured and 0 elsewhere, where RGB is 0 too: the hardware's trilinear filter then gives the sum of w v and of w, and
their quotient is the interpolation renormalised over the measured corners.

Reference (a byte for each, and an exponent): G. Ward, "Real Pixels", Graphics Gems II, 1991.
"""

import gzip
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float32

from ..brdf import TabularBrdf, half_scale

BIAS = 128
"""Of an exponent; with the 8 bits of a mantissa, 136."""
LEVEL = 4
"""A table takes half the time of level 6, and 2 % more bytes."""


@dataclass(frozen=True, eq=False)
class Block:
    """Numbers with their shape and scale, to be sent."""

    body: bytes
    shape: tuple[int, ...]
    """The last axis is RGBA."""
    scale: tuple[float, float, float]

    @classmethod
    def of(cls, values: np.ndarray, alpha: np.ndarray) -> "Block":
        """RGB ``values`` (..., 3), finite, and ``alpha`` (...) in [0, 1]."""
        scale = tuple(half_scale(float(values[..., c].max())) for c in range(3))
        block = np.empty((*alpha.shape, 4), "<f2")
        block[..., :3] = values / np.array(scale, np.float32)
        block[..., 3] = alpha
        return cls(block.tobytes(), block.shape, (scale[0], scale[1], scale[2]))

    @classmethod
    def of_table(cls, table: TabularBrdf) -> "Block":
        """A table; a cell counts as measured when it is in all three channels."""
        measured = np.logical_and.reduce(np.isfinite(table.values))
        values = np.where(measured, table.values, np.float32(0))
        return cls.of(np.moveaxis(values, 0, -1), measured)

    @classmethod
    def of_pictures(
        cls, values: Float32[np.ndarray, "k n_pixels 3"], mask: Bool[np.ndarray, "size size"]
    ) -> "Block":
        """Pictures of spheres by their pixels, those of ``mask``: half the bytes of half floats, and as far from black to a glint."""
        light = values.clip(0)
        exponent = np.frexp(light.max(axis=-1))[1]
        mantissa = np.rint(light * np.ldexp(np.float32(256), -exponent)[..., None])
        block = np.zeros((len(values), *mask.shape, 4), np.uint8)
        block[:, mask, :3] = mantissa.clip(0, 255)
        block[:, mask, 3] = (exponent + BIAS).clip(1, 255)
        return cls(block.tobytes(), block.shape, (1.0, 1.0, 1.0))

    @cached_property
    def packed(self) -> bytes:
        """The body by gzip: a MERL table of 11.7 MB in 1 to 2 MB. The same block makes the same bytes."""
        return gzip.compress(self.body, LEVEL, mtime=0)

    @property
    def headers(self) -> dict[str, str]:
        """The HTTP headers that describe the body."""
        return {
            "Halfway-Shape": ",".join(map(str, self.shape)),
            "Halfway-Scale": ",".join(f"{scale:g}" for scale in self.scale),
        }
