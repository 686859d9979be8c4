"""Neural BRDFs: a small network for each material, as the weights that Keras saves (HDF5).

    x = (h, d)        h = (sin theta_h, 0, cos theta_h)
                      d = (sin theta_d cos phi_d, sin theta_d sin phi_d, cos theta_d)
    x1 = max(0, x W1 + b1)                    6 -> 21
    x2 = max(0, x1 W2 + b2)                  21 -> 21
    f_r = max(0, exp(x2 W3 + b3) - 1)        21 -> 3       linear RGB, 1/sr

In the file the attribute ``layer_names`` lists the layers in order, and each layer's ``weight_names`` its kernel and
its bias; a whole model has all this below ``model_weights``. Keras 3 saves weights by another scheme, ``layers/NAME/vars/0``
and ``1``, the layers called by their number. The activations are not in the file.

Source: A. Sztrajman, G. Rainer, T. Ritschel, T. Weyrich, "Neural BRDF Representation and Importance Sampling",
Computer Graphics Forum 40(6), 2021, section 3.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import prod
from pathlib import Path
from typing import ClassVar

import numpy as np

from .._types import Angle, Mask
from ..brdf import IsotropicModel
from ..errors import FormatError
from ..halfdiff import HalfDiff
from ..origin import Origin
from .content import HDF5, description
from .hdf5 import Hdf5Error, Hdf5Object, read_hdf5
from .sources import FileSource, Source

LARGEST_BYTES = 200_000
"""A network takes 19 kB; a file of more than this is something else, and is not read."""

ARCHIVE = Origin(
    "neural fits (stand-ins, not measurements)",
    "A. Sztrajman et al., Neural BRDF Representation and Importance Sampling, CGF 40(6), 2021",
    "MIT",
)
"""Of the fits that were published."""

_MOST_NAMES = 16
_CELLS_AT_ONCE = 2048
"""What the network makes of so many fits into a core's cache: ten times faster than all at once."""
_SHAPES = ((6, 21), (21,), (21, 21), (21,), (21, 3), (3,))


@dataclass(frozen=True, eq=False)
class NeuralBrdf(IsotropicModel):
    """A material as a network of three layers; kernels ``W`` are (inputs, outputs), float32."""

    W1: np.ndarray
    b1: np.ndarray
    W2: np.ndarray
    b2: np.ndarray
    W3: np.ndarray
    b3: np.ndarray

    formula: ClassVar[str] = "NBRDF 6-21-21-3"

    @property
    def about(self) -> str:
        return f"a neural fit ({self.formula})"

    def at(
        self, theta_h: Angle, theta_d: Angle, phi_d: Angle, cos_i: Angle, cos_o: Angle
    ) -> np.ndarray:
        del cos_i, cos_o  # they follow from the angles
        # The first layer is a sum of a part of theta_h and one of (theta_d, phi_d): on a grid each is small.
        sin_d = np.sin(theta_d)
        of_h = _product(self.W1[:3:2], np.sin(theta_h), np.cos(theta_h))
        of_d = _product(self.W1[3:], sin_d * np.cos(phi_d), sin_d * np.sin(phi_d), np.cos(theta_d))
        of_d += self.b1.reshape(-1, *[1] * theta_d.ndim)
        f = np.empty((3, *np.broadcast_shapes(of_h.shape[1:], of_d.shape[1:])), np.float32)
        for piece in _pieces(f.shape[1:]):
            x1 = _relu(_cut(of_h, piece) + _cut(of_d, piece))
            x2 = _relu(_layer(self.W2, self.b2, x1.reshape(len(x1), -1)))
            f[:, *piece] = _layer(self.W3, self.b3, x2).reshape(3, *x1.shape[1:])
        return _relu(np.expm1(f, out=f))

    def _at_centres(self, centres: HalfDiff, lit: Mask) -> np.ndarray:
        del lit  # off the mask the value is not kept
        theta_h, _, theta_d, phi_d = centres
        return self.at(theta_h, theta_d, phi_d, theta_h, theta_h)


def read_nbrdf(source: str | Path | bytes, *, name: str = "") -> NeuralBrdf:
    """The network in a Keras HDF5 file, given as a path or as its bytes; ``name`` is what messages call it.

    Raises
    ------
    FormatError
        When it is no HDF5 file, or its layers are not those of a neural BRDF.
    """
    if isinstance(source, bytes):
        return _decode(source, name or "the network")
    return read_nbrdf_source(FileSource(Path(source)))


def read_nbrdf_source(source: Source) -> NeuralBrdf:
    """The network in a file or in a member of a zip; raises as `read_nbrdf` does."""
    require_small(source)
    with source.open() as stream:
        return _decode(stream.read(), source.label)


def require_small(source: Source) -> None:
    """Refuse what is too large to be a network, before it is read."""
    if source.n_bytes > LARGEST_BYTES:
        raise FormatError(
            f"{source.label} is an HDF5 file of {source.n_bytes:,} bytes: a neural BRDF takes about 19,000, and "
            f"no more than {LARGEST_BYTES:,} are read. It is something else."
        )


def _decode(content: bytes, label: str) -> NeuralBrdf:
    if not content.startswith(HDF5):
        what = description(content[:512]) or "is no HDF5 file"
        raise FormatError(f"{label} {what}: expected the Keras weights of a neural BRDF (HDF5).")
    try:
        weights = [weight for layer in _layers(read_hdf5(content), label) for weight in layer]
    except Hdf5Error as error:
        raise FormatError(
            f"{label} is no HDF5 as Keras writes it ({error}): expected the weights of a neural BRDF. "
            "Compare it with the original download."
        ) from error
    shapes = tuple(weight.shape for weight in weights)
    if shapes != _SHAPES:
        raise FormatError(
            f"{label} has layers of shapes {_listed(shapes)}: a neural BRDF has {_listed(_SHAPES)}. "
            "It is a network for something else."
        )
    if not all(np.isfinite(weight).all() for weight in weights):
        raise FormatError(
            f"{label} has weights that are not finite: expected finite numbers. It is damaged, or was not trained."
        )
    return NeuralBrdf(*weights)


def _layers(root: Hdf5Object, label: str) -> list[list[np.ndarray]]:
    """The weights of each layer that has some, in the order in which the network applies them."""
    if "layers" in root:
        layers = [root["layers"][name] for name in root["layers"].names]
        return [_weights(layer["vars"], ("0", "1")) for layer in layers if "0" in layer["vars"]]
    if "model_weights" in root:
        root = root["model_weights"]
    layers = [root[name] for name in _names(root, "layer_names", label)]
    return [_weights(layer, _names(layer, "weight_names", label)) for layer in layers]


def _weights(layer: Hdf5Object, names: Sequence[str]) -> list[np.ndarray]:
    return [np.asarray(layer[name].array(), np.float32) for name in names]


def _names(group: Hdf5Object, attribute: str, label: str) -> list[str]:
    names = group.strings(attribute, most=_MOST_NAMES)
    if names is None:
        raise FormatError(
            f"{label} is an HDF5 file without {attribute}: expected the Keras weights of a neural BRDF."
        )
    return names


def _listed(shapes: tuple[tuple[int, ...], ...]) -> str:
    return ", ".join("x".join(map(str, shape)) for shape in shapes) or "none"


def _pieces(shape: tuple[int, ...]) -> Iterator[tuple[slice, ...]]:
    """Parts of an array of this shape, each of few cells; together all of it."""
    n, *rest = shape
    n_below = prod(rest)
    if n_below > _CELLS_AT_ONCE:
        below = list(_pieces(tuple(rest)))
        yield from ((slice(i, i + 1), *piece) for i in range(n) for piece in below)
        return
    step = max(1, _CELLS_AT_ONCE // max(1, n_below))
    yield from ((slice(start, start + step),) for start in range(0, n, step))


def _cut(layer: np.ndarray, piece: tuple[slice, ...]) -> np.ndarray:
    """The features on a part of the grid; an axis along which they do not vary stays as it is."""
    sizes = layer.shape[1:]
    return layer[:, *(slice(None) if n == 1 else r for n, r in zip(sizes, piece, strict=False))]


def _product(W: np.ndarray, *inputs: Angle) -> np.ndarray:
    """The part of ``x W`` that comes from these inputs, shape (outputs, ...)."""
    x = np.stack(np.broadcast_arrays(*(x.astype(np.float32) for x in inputs)))
    return np.tensordot(W.T, x, 1)


def _layer(W: np.ndarray, b: np.ndarray, x: np.ndarray) -> np.ndarray:
    """``x W + b`` with the features first: ``x`` has shape (inputs, n)."""
    y = W.T @ x
    y += b[:, None]
    return y


def _relu(x: np.ndarray) -> np.ndarray:
    return np.maximum(x, 0, out=x)
