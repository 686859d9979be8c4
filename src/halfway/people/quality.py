"""Perceived qualities as attributes that can be asked for.

Each has a reading of its own, after those of the instruments: the value of its network, the same in every channel. That is a
function of the table, and not a linear one, not even of a linear mix.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from jaxtyping import Float64

from ..instruments import INSTRUMENTS, Attribute, Condition
from .networks import networks

LEAST, MOST = -1.0, 2.0
"""Far beyond what people say: about 0 is not at all, 1 very."""

Read = Float64[np.ndarray, "*k n_instruments 3"]
Reading = Float64[np.ndarray, "*k n_readings 3"]
"""By instrument and network, and channel."""


@dataclass(frozen=True, kw_only=True)
class Quality(Attribute):
    """How people perceive a material in one respect."""

    i_reading: int
    """The position of its reading, behind those of the instruments."""

    @property
    def instruments(self) -> tuple[str, ...]:
        return ()

    def of(self, readings: Reading) -> Float64[np.ndarray | np.floating, "*k"]:
        return readings[..., self.i_reading, 0]

    def conditions(self, target: float, given: Mapping[str, Any]) -> list[Condition]:  # noqa: ARG002
        coefficients = np.zeros((self.i_reading + 1, 3))
        coefficients[self.i_reading, 0] = 1.0
        return [Condition(coefficients, target)]


def with_qualities(readings: Read, values: Float64[np.ndarray, "*k n_networks"]) -> Reading:
    """The readings of instruments, and after them those of `QUALITIES`, with these values."""
    each = np.broadcast_to(values[..., None], (*values.shape, 3))
    return np.concatenate([readings, each], axis=-2)


def _group(name: str) -> Literal["reflections", "colour"]:
    return "colour" if name in ("bright", "reflection_tint") else "reflections"


QUALITIES: Mapping[str, Quality] = {
    name: Quality(
        name=name,
        label=f"Perceived: {name.replace('_', ' ')}",
        formula="a network of radial basis functions of five numbers",
        source="Serrano et al. 2016",
        least=LEAST,
        most=MOST,
        close=0.01,
        group=_group(name),
        i_reading=len(INSTRUMENTS) + i,
    )
    for i, name in enumerate(networks())
}
"""By name, in the order of the networks."""
