"""A neural process as a method: an encoder of any number of samples to seven numbers, and a decoder of those to a BRDF.

    x = (cos(2 pi u)/2 + 1/2, sin(2 pi u)/2 + 1/2, theta_h/(pi/2), theta_d/(pi/2))      u = phi_d/pi
    y = f_r, four times log1p, over .15
    encoder   (x, y) -> 400 -> 400 -> 64, the mean over samples, three layers of 64, and a head of 7: z
    decoder   (x, z) -> six layers of 400 -> 3: y;  ReLU after every layer but the head

Its file has all hundred materials of the MERL database in its training set, so it is judged by what it knows: a bound, no prediction.

Source: C. Zheng, R. Zheng, R. Wang, S. Zhao, H. Bao, "A Compact Representation of Measured BRDFs Using Neural Processes", ACM TOG
41(2), 2021; the weights that its authors published (MIT).
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float32, Float64

from .._types import Angle, Directions
from ..errors import FormatError
from ..formats import hdf5
from ..halfdiff import Grid, to_half_diff
from ..library import Library
from ..recovery import plan
from .data import Values, values_of
from .sparse import Sampling, random_directions

N_NUMBERS = 7
SCALE = 0.15
_AT_ONCE = 8192

Layer = tuple[np.ndarray, np.ndarray]
"""Kernel (in, out) and bias."""
Features = Float32[np.ndarray, "n _"]


@dataclass(frozen=True, eq=False)
class NeuralProcess:
    """The two networks."""

    encoder: Sequence[Layer]
    decoder: Sequence[Layer]

    @classmethod
    def read(cls, path: Path) -> "NeuralProcess":
        """The networks in the HDF5 file that Keras wrote.

        Raises
        ------
        FormatError
            When the file does not hold them.
        """
        try:
            root = hdf5.read_hdf5(path.read_bytes())
            return cls(_layers(root["encoder"]), _layers(root["decoder"]))
        except (OSError, hdf5.Hdf5Error) as error:
            raise FormatError(
                f"{path} holds no neural process ({error}): expected the weights of Zheng et al. 2021 (HDF5)."
            ) from None

    def encode(self, x: Features, f: Features) -> Float32[np.ndarray, " 7"]:
        """The seven numbers of samples ``f``, shape (n, 3), at ``x``."""
        for _ in range(4):
            f = np.log1p(f)
        h = np.concatenate([x, f / np.float32(SCALE)], axis=1)
        *hidden, head, _ = self.encoder  # the last gives a variance
        for layer in hidden[:3]:
            h = _relu(h, layer)
        r = h.mean(axis=0, keepdims=True)
        for layer in hidden[3:]:
            r = _relu(r, layer)
        return (r @ head[0] + head[1])[0]

    def decode(self, z: Float32[np.ndarray, " 7"], x: Features) -> Features:
        """f_r in 1/sr at ``x``."""
        (kernel, bias), *rest = self.decoder
        constant = z @ kernel[x.shape[1] :] + bias
        out = np.empty((len(x), 3), np.float32)
        for start in range(0, len(x), _AT_ONCE):
            h = np.maximum(x[start : start + _AT_ONCE] @ kernel[: x.shape[1]] + constant, 0)
            for layer in rest:
                h = _relu(h, layer)
            h *= np.float32(SCALE)
            for _ in range(4):
                h = np.expm1(h)
            out[start : start + _AT_ONCE] = h
        return out

    def table(self, z: Float32[np.ndarray, " 7"], grid: Grid) -> Float32[np.ndarray, "3 p"]:
        """The table on a grid; NaN off its mask."""
        known = grid.mask().ravel()
        angles = (np.broadcast_to(a, grid.shape).ravel()[known] for a in grid.centres())
        theta_h, _, theta_d, phi_d = angles
        values = np.full((3, grid.size), np.nan, np.float32)
        values[:, known] = self.decode(z, _inputs(theta_h, theta_d, phi_d)).T
        return values

    def reconstruct(
        self, train: Library, test: Library, ks: Sequence[int]
    ) -> Iterator[tuple[int, Values]]:
        """As a method of `reconstruct`: seven numbers of all cells, and the tables of those."""
        del train, ks
        grid = test.grid
        known = np.flatnonzero(grid.mask())
        wi, wo = (x.reshape(-1, 3)[known] for x in grid.directions())
        x = _inputs_at(wi, wo)
        values = values_of(test)[..., known]
        tables = [self.table(self.encode(x, f.T), grid) for f in values.swapaxes(0, 1)]
        yield N_NUMBERS, np.stack(tables, axis=1)

    def planned(self, train: Library, n: int, rng: np.random.Generator) -> Sampling | None:
        """As a method of `recover`: the table of what the encoder makes of n samples, at the directions of `halfway.plan`."""
        del rng
        chosen = plan(train, n)
        return self._sampling(train.grid, chosen.wi, chosen.wo)

    def unplanned(self, train: Library, n: int, rng: np.random.Generator) -> Sampling | None:
        """The same at directions that are drawn, as those were on which it learned."""
        return self._sampling(train.grid, *random_directions(train.grid, n, rng))

    def _sampling(self, grid: Grid, wi: Directions, wo: Directions) -> Sampling:
        x = _inputs_at(wi, wo)

        def complete(values: Float64[np.ndarray, "n 3"]) -> Float32[np.ndarray, "3 p"]:
            return self.table(self.encode(x, values.astype(np.float32)), grid)

        return Sampling(wi, wo, complete)


def _layers(group: hdf5.Hdf5Object) -> list[Layer]:
    """In the order in which Keras made them: dense, dense_1, dense_2 ..."""
    names = sorted(group.names, key=lambda name: int(name.rpartition("_")[2]) if "_" in name else 0)
    layers = (group[name] for name in names)
    return [(layer["kernel:0"].array(), layer["bias:0"].array()) for layer in layers]


def _relu(x: Features, layer: Layer) -> Features:
    h = x @ layer[0]
    h += layer[1]
    return np.maximum(h, 0, out=h)


def _inputs_at(wi: Directions, wo: Directions) -> Features:
    angles = to_half_diff(wi, wo)
    return _inputs(angles.theta_h, angles.theta_d, angles.phi_d)


def _inputs(theta_h: Angle, theta_d: Angle, phi_d: Angle) -> Features:
    turn = 2 * phi_d
    quarter = np.pi / 2
    x = (np.cos(turn) / 2 + 0.5, np.sin(turn) / 2 + 0.5, theta_h / quarter, theta_d / quarter)
    return np.stack(x, axis=-1).astype(np.float32)
