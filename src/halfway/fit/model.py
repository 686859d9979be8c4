"""What the models have in common: named parameters within bounds, as a flat vector for the optimiser.

A model is a `Brdf`: it is evaluated, tabulated, checked and rendered as any other.
"""

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple, get_type_hints

import numpy as np
from jaxtyping import Float64

from .._types import Angle, Directions, Part, Table, Values
from ..brdf import Brdf, IsotropicModel
from ..halfdiff import Grid, above_horizon
from .microfacet import Pair

Vector = Float64[np.ndarray, " n"]
Colour = Float64[np.ndarray, "3"]
"""Linear RGB."""


ROUGHNESSES = (0.1, 0.25, 0.45, 0.7)
"""Where searches begin: the width of the main lobe is what makes the metric's valleys."""


class Range(NamedTuple):
    """Where a parameter may lie, and where it stands when it does nothing."""

    low: float
    high: float
    neutral: float


ANY_TURN = Range(-np.pi, np.pi, 0)
"""Of a direction along the surface, in radians, counter-clockwise from the tangent; half a turn is none."""


@dataclass(frozen=True, eq=False)
class AnalyticModel(IsotropicModel):
    """A model of renderers: a frozen dataclass of numbers and colours (shape (3,), linear RGB)."""

    ranges: ClassVar[Mapping[str, Range]]
    """Of each parameter, in the order of the fields, which say them; a colour's range is that of each channel."""
    colours: ClassVar[frozenset[str]]
    """The parameters of three channels."""
    main_lobe: ClassVar[tuple[str, str]]
    """The parameters that say how wide the main lobe is and how much of it a metal's."""
    opening: ClassVar[Mapping[str, float]]
    """The other parameters at a search's start that are not at their defaults: inside their ranges, where they do something."""
    grain: ClassVar[tuple[str, ...]] = ()
    """The parameters that say how anisotropic it is, 0 for not, and in which direction its main lobe is widest; none where it never is."""
    n_searches: ClassVar[int] = 2
    """From how many of the starts to search."""
    simpler: ClassVar[Sequence[Mapping[str, float]]] = ()
    """Parameters that may be held, by their values, for the sake of other programs."""

    def __init_subclass__(cls) -> None:
        if "ranges" not in vars(cls):
            hints = get_type_hints(cls, include_extras=True).items()
            said = ((name, getattr(hint, "__metadata__", ())) for name, hint in hints)
            cls.ranges = {name: r for name, notes in said for r in notes if isinstance(r, Range)}

    @classmethod
    def starts(cls, body: Colour, glossy: Colour) -> Sequence["AnalyticModel"]:
        """Where a search may begin, for a material of this diffuse and this whole albedo: as a dielectric and as a metal."""
        width, metalness = cls.main_lobe
        return [
            cls(**{"base_color": colour, width: r, metalness: m}, **cls.opening)
            for r in ROUGHNESSES
            for m, colour in ((0.1, body), (0.9, glossy))
        ]

    @property
    def readings(self) -> Mapping[str, "AnalyticModel"]:
        """What programs make of the parameters that do not take all of them as they are meant, by which programs those are."""
        return {}

    @property
    def is_isotropic(self) -> bool:
        return not self.grain or getattr(self, self.grain[0]) == 0

    @abstractmethod
    def of(self, pair: Pair) -> np.ndarray:
        """f_r in 1/sr, shape (3, ...); a pair without azimuths is one of a model that is isotropic."""

    def at(
        self, theta_h: Angle, theta_d: Angle, phi_d: Angle, cos_i: Angle, cos_o: Angle
    ) -> np.ndarray:
        del phi_d  # it acts through the two cosines
        return self.of(Pair(theta_h, np.cos(theta_d), cos_i, cos_o))

    def eval(self, wi: Directions, wo: Directions) -> Values:
        if self.is_isotropic:
            return super().eval(wi, wo)
        return above_horizon(lambda i, o: self.of(Pair.of(i, o)), wi, wo)

    def _sample_rows(self, grid: Grid, rows: Part) -> Table:
        kind = IsotropicModel if self.is_isotropic else Brdf
        return kind._sample_rows(self, grid, rows)

    def __post_init__(self) -> None:
        for name in self.colours:
            value = np.array(np.broadcast_to(getattr(self, name), 3), np.float64)
            value.flags.writeable = False
            object.__setattr__(self, name, value)

    @classmethod
    def bounds(cls) -> tuple[Vector, Vector]:
        """The lowest and the highest vector."""
        low, high, _ = cls._spread()
        return low, high

    @classmethod
    def neutral(cls) -> Vector:
        """The vector of the parameters that do nothing."""
        return cls._spread()[2]

    @classmethod
    def _spread(cls) -> tuple[Vector, Vector, Vector]:
        rows = [cls.ranges[name] for name in cls.ranges for _ in range(cls._size(name))]
        low, high, neutral = np.array(rows, np.float64).T
        return low, high, neutral

    @classmethod
    def _size(cls, name: str) -> int:
        return 3 if name in cls.colours else 1

    @classmethod
    def from_vector(cls, vector: Vector) -> "AnalyticModel":
        """The model with the parameters of a vector."""
        values: dict[str, Any] = {}
        start = 0
        for name in cls.ranges:
            stop = start + cls._size(name)
            values[name] = vector[start:stop] if name in cls.colours else float(vector[start])
            start = stop
        return cls(**values)

    @classmethod
    def held(cls, values: Mapping[str, float]) -> Vector:
        """A vector of these parameters' values, NaN elsewhere."""
        rows = [values.get(name, np.nan) for name in cls.ranges for _ in range(cls._size(name))]
        return np.array(rows, np.float64)

    def to_vector(self) -> Vector:
        """All parameters in the order of the fields."""
        return np.concatenate([np.ravel(getattr(self, name)) for name in self.ranges])

    def parameters(self) -> dict[str, float | list[float]]:
        """The parameters by name; for JSON."""
        return {name: np.asarray(getattr(self, name), np.float64).tolist() for name in self.ranges}


def channels(colour: np.ndarray, like: Angle) -> np.ndarray:
    """A colour, shaped to multiply an array of angles: (3, 1, ...)."""
    return colour.reshape(3, *[1] * np.ndim(like))
