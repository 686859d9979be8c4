"""How the weighted materials of a recipe become one."""

from collections.abc import Callable
from enum import StrEnum
from typing import NamedTuple

import numpy as np

from ..errors import RecipeError


class Mapping(NamedTuple):
    """A function of BRDF values in which weighted sums are taken: increasing, concave, 0 at 0."""

    name: str
    to: np.ufunc
    back: np.ufunc
    slope: Callable[[np.ndarray], np.ndarray]
    """The derivative of ``back``, at mapped values."""
    unit: str
    """Of mapped values."""


class Blend(StrEnum):
    """The ways to mix materials f_i with weights w_i, none negative, which sum to 1.

    Each is a generalised mean, ``m^-1(sum_i w_i m(f_i))``, in a mapping m. Where m is concave the mean is pointwise at or below
    the linear one (Jensen), so a mix is non-negative, reciprocal and passive wherever its materials are.
    """

    LINEAR = "linear"
    """m(f) = f, the paper's: keeps every linear functional of the BRDF, so pictures in direct light mix alike."""
    ROOT = "root"
    """m(f) = sqrt(f): equal weight to equal amplitudes, so a dark material counts beside a bright one."""
    LOG = "log"
    """m(f) = log(1 + f): linear where dark, geometric in highlights."""
    LOBES = "lobes"
    """m(f) = sqrt(f) of materials whose highlights have first been brought to one width: one highlight that narrows."""

    @property
    def mapping(self) -> Mapping:
        """The function in which the weighted sum is taken."""
        return _MAPPINGS[self]

    @property
    def aligns(self) -> bool:
        """Whether highlights are brought to one width before materials are mixed."""
        return self is Blend.LOBES

    @classmethod
    def _missing_(cls, value: object) -> "Blend":
        raise RecipeError(
            f"there is no blend {value!r}: expected {', '.join(cls)}. "
            "A newer halfway may have written it: upgrade, or choose one of these."
        )


def _twice(mapped: np.ndarray) -> np.ndarray:
    return 2 * mapped


_ROOT = Mapping("root", np.sqrt, np.square, _twice, "sr^-1/2")
_MAPPINGS = {
    Blend.LINEAR: Mapping("linear", np.positive, np.positive, np.ones_like, "1/sr"),
    Blend.ROOT: _ROOT,
    Blend.LOG: Mapping("log", np.log1p, np.expm1, np.exp, "log(1 + f sr)"),
    Blend.LOBES: _ROOT,
}
