"""The network of Sztrajman et al. 2021, fitted to a table: `halfway.formats.NeuralBrdf`, 675 numbers.

As there: the loss is the mean of |ln(1 + f cos_i) - ln(1 + g cos_i)| over samples of the table, each cell as likely, and Adam lowers it.
Theirs has 800,000 samples of a table of 1.4 million cells and steps of one size; here all cells of the grid are used, in fewer steps that become smaller to the end.

D. P. Kingma, J. Ba, "Adam: A Method for Stochastic Optimization", ICLR 2015.
"""

from collections.abc import Iterator
from itertools import islice

import numpy as np

from ..brdf import TabularBrdf, quadrature
from ..formats import NeuralBrdf
from ..halfdiff import from_polar

SHAPES = ((6, 21), (21,), (21, 21), (21,), (21, 3), (3,))
N_NUMBERS = sum(int(np.prod(shape)) for shape in SHAPES)
N_STEPS = 17_000
BATCH = 512
STEP = 3e-3
"""Of the first steps; the last are a thousandth of it."""
_DECAY = (0.9, 0.999)
_TINY = 1e-8

Layers = list[np.ndarray]


def fitted(table: TabularBrdf, *, n_steps: int = N_STEPS) -> NeuralBrdf:
    """The network that stands for a table best, of those with one start."""
    x, f, cos_i = _samples(table)
    rng = np.random.default_rng(0)
    layers = _start(rng, f)
    slope, square = ([np.zeros_like(layer) for layer in layers] for _ in range(2))
    for i, chosen in enumerate(islice(_batches(rng, len(x)), n_steps), 1):
        step = STEP * 10 ** (-3 * i / n_steps)
        gradient = _gradient(layers, x[chosen], f[chosen], cos_i[chosen])
        for layer, g, m, v in zip(layers, gradient, slope, square, strict=True):
            m += (1 - _DECAY[0]) * (g - m)
            v += (1 - _DECAY[1]) * (g * g - v)
            unbiased = np.sqrt(1 - _DECAY[1] ** i) / (1 - _DECAY[0] ** i)
            layer -= np.float32(step * unbiased) * m / (np.sqrt(v) + _TINY)
    return NeuralBrdf(*layers)


def _samples(table: TabularBrdf) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Inputs, f_r and cos_i of all measured cells."""
    grid = table.grid
    values = table.values.reshape(3, -1)
    known = grid.mask().ravel() & np.isfinite(values).all(axis=0)
    theta_h, _, theta_d, phi_d = (
        np.broadcast_to(angle, grid.shape).ravel()[known] for angle in grid.centres()
    )
    h, d = from_polar(theta_h, np.zeros_like(theta_h)), from_polar(theta_d, phi_d)
    x = np.concatenate([h, d], axis=1)
    cos_i = np.broadcast_to(quadrature.comparison_cells(grid).cos_i, grid.shape).ravel()[known]
    return x.astype(np.float32), values[:, known].T.copy(), cos_i.astype(np.float32)[:, None]


def _start(rng: np.random.Generator, f: np.ndarray) -> Layers:
    """Small even weights (Glorot and Bengio 2010); what comes out is the median, or the network might be dark and stay so."""
    layers = [np.zeros(shape, np.float32) for shape in SHAPES]
    for kernel in layers[::2]:
        limit = np.sqrt(6 / sum(kernel.shape))
        kernel[:] = rng.uniform(-limit, limit, kernel.shape)
    layers[-1][:] = np.log1p(np.median(f, axis=0))
    return layers


def _batches(rng: np.random.Generator, n: int) -> Iterator[np.ndarray]:
    while True:
        order = rng.permutation(n)
        yield from (order[start : start + BATCH] for start in range(0, n, BATCH))


def _gradient(layers: Layers, x: np.ndarray, f: np.ndarray, cos_i: np.ndarray) -> Layers:
    """Of the mean loss of some samples, for each kernel and bias."""
    W1, b1, W2, b2, W3, b3 = layers
    x1 = np.maximum(x @ W1 + b1, 0)
    x2 = np.maximum(x1 @ W2 + b2, 0)
    y = x2 @ W3 + b3
    g = np.maximum(np.expm1(y), 0)
    # Below 0, where the loss is flat, as exp goes on: or what is dark once stays so.
    d3 = np.sign(g - f) * np.exp(y) * cos_i / (1 + g * cos_i) / f.size
    d2 = d3 @ W3.T * (x2 > 0)
    d1 = d2 @ W2.T * (x1 > 0)
    return [x.T @ d1, d1.sum(0), x1.T @ d2, d2.sum(0), x2.T @ d3, d3.sum(0)]
