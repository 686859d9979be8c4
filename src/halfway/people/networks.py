"""The published networks of perceived attributes: radial basis functions of five numbers.

value = Theta_0 + sum_j phi_j Theta_j        phi_j = exp(-beta |x - c_j|^2) / sum_k exp(-beta |x - c_k|^2)
"""

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

import numpy as np
from jaxtyping import Float64

BETA = 0.005
N_CENTRES = 10


@dataclass(frozen=True, eq=False)
class Network:
    """The network of one attribute."""

    constant: float
    weights: Float64[np.ndarray, " n_centres"]
    centres: Float64[np.ndarray, "n_centres n_components"]

    def of(self, x: Float64[np.ndarray, "*k n_components"]) -> Float64[np.ndarray, "*k"]:
        """The values of materials, as people would rate them: about 0, not at all, to 1, very."""
        squared = np.square(x[..., None, :] - self.centres).sum(axis=-1)
        phi = np.exp(-BETA * squared)
        return np.asarray(self.constant + (phi / phi.sum(axis=-1, keepdims=True)) @ self.weights)


@cache
def networks() -> Mapping[str, Network]:
    """All, by the name of the attribute."""
    text = files("halfway.people").joinpath("data", "serrano2016.csv").read_text(encoding="utf-8")
    return {row["attribute"]: _network(row) for row in csv.DictReader(text.splitlines())}


def _network(row: Mapping[str, str]) -> Network:
    numbers = [float(value) for name, value in row.items() if name != "attribute"]
    each = np.reshape(numbers[1:], (N_CENTRES, -1))
    return Network(numbers[0], each[:, 0], each[:, 1:])
