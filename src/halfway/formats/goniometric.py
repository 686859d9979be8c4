"""Tables over the directions of light and viewer themselves, as gonioreflectometers and cameras fill them.

UTIA `.bin`, 1,990,656 bytes:

    float64   [channel][theta_i][phi_i][theta_o][phi_o]      3 x 6 x 48 x 6 x 48

little endian; theta in steps of 15 degrees from 0 to 75, phi in steps of 7.5. Past 75 degrees the values of the last ring stand.

MIT CSAIL, anisotropic:

    16 x int32   0 to 3 n_theta_i, n_theta_o, n_phi_d, n_phi_i · 6 is 1 · 7 is 0 · 9 half · 10 is 3, the channels
    float32      [channel][theta_i][theta_o][phi_d][phi_i]

little endian; a sample stands at the middle of its bin, and a negative one is unmeasured. theta reaches 90 degrees, phi_i a whole turn,
phi_d = phi_o - phi_i as well, or half of one where ``half`` is 1: the other half is there with light and viewer exchanged.

Neither file says its unit. The values are taken for 1/sr as they are; a scale may be given when they are converted.

Sources: J. Filip, R. Vávra, "Template-Based Sampling of Anisotropic BRDFs", CGF 33(7), 2014, and the readers of the UTIA BRDF
Database; A. Ngan, F. Durand, W. Matusik, "Experimental Analysis of BRDF Models", EGSR 2005, and the reader of Disney's BRDF
Explorer.
"""

import hashlib
from collections.abc import Callable
from dataclasses import dataclass
from math import prod
from typing import NamedTuple

import numpy as np

from .._types import Angle, Directions, Indices, Table, Values
from ..brdf import Measurement
from ..errors import FormatError
from ..halfdiff import Corners, above_horizon, to_polar
from .content import CSAIL_HEADER, UTIA_BYTES
from .sources import Source

_UTIA_SHAPE = (6, 48, 6, 48)


class Nodes(NamedTuple):
    """Evenly spaced angles at which samples stand, in radians."""

    size: int
    step: float
    first: float = 0.0
    periodic: bool = False

    def around(self, angle: Angle) -> list[tuple[Indices, Angle]]:
        """The two nodes around each angle and their weights; beyond the ends the last one counts."""
        position = (angle - self.first) / self.step
        if not self.periodic:
            position = np.clip(position, 0, self.size - 1)
        lower = np.floor(position).astype(np.intp)
        cells = lower % self.size, (lower + 1) % self.size
        return [(cells[0], lower + 1 - position), (cells[1], position - lower)]


Coordinates = Callable[[Directions, Directions], tuple[Angle, ...]]


@dataclass(frozen=True, eq=False)
class GoniometricBrdf(Measurement):
    """A material sampled over the angles of its two directions.

    Parameters
    ----------
    kind : str
        Which files hold such a table.
    nodes : tuple of Nodes
        Of each axis.
    values : float32 array, shape (3, *sizes of the axes)
        f_r in 1/sr; NaN where unmeasured.
    coordinates : callable
        The angles along the axes of pairs of directions.
    """

    name: str
    kind: str
    nodes: tuple[Nodes, ...]
    values: Table
    coordinates: Coordinates

    @property
    def is_isotropic(self) -> bool:
        return False

    @property
    def about(self) -> str:
        sizes = " x ".join(str(axis.size) for axis in self.nodes)
        return f"a {self.kind} table of {sizes} directions, its values taken for 1/sr"

    def eval(self, wi: Directions, wo: Directions) -> Values:
        return above_horizon(lambda i, o: self._corners(i, o).blend(self.values), wi, wo)

    def fingerprint(self) -> bytes:
        digest = hashlib.sha256(repr((self.kind, self.nodes)).encode())
        digest.update(np.ascontiguousarray(self.values).data)
        return digest.digest()

    def _corners(self, wi: Directions, wo: Directions) -> Corners:
        angles = self.coordinates(wi, wo)
        sides = (axis.around(angle) for axis, angle in zip(self.nodes, angles, strict=True))
        return Corners.between(sides, self.values.shape[1:])


def read_utia_source(source: Source) -> GoniometricBrdf:
    """The material in a UTIA file; a `FormatError` where it has another size, or a value is not finite."""
    values = _floats(source, 0, "<f8", (3, *_UTIA_SHAPE), UTIA_BYTES)
    _require_finite(values, source)
    theta, phi = Nodes(6, np.radians(15)), Nodes(48, np.radians(7.5), periodic=True)
    return GoniometricBrdf(source.name, "UTIA", (theta, phi, theta, phi), values, _both)


def read_csail_source(source: Source) -> GoniometricBrdf:
    """The material in an anisotropic MIT CSAIL file; a `FormatError` where its header says another size, or a value is not finite."""
    header = CSAIL_HEADER.unpack(source.head(CSAIL_HEADER.size))
    shape, half = header[:4], bool(header[9])
    expected = CSAIL_HEADER.size + 12 * prod(shape)
    values = _floats(source, CSAIL_HEADER.size, "<f4", (3, *shape), expected)
    _require_finite(values, source)
    values[values < 0] = np.nan
    n_theta_i, n_theta_o, n_phi_d, n_phi_i = shape
    range_d = np.pi if half else 2 * np.pi
    nodes = (
        _bins(n_theta_i, np.pi / 2),
        _bins(n_theta_o, np.pi / 2),
        _bins(n_phi_d, range_d, periodic=not half),
        _bins(n_phi_i, 2 * np.pi, periodic=True),
    )
    kind = "MIT CSAIL"
    return GoniometricBrdf(source.name, kind, nodes, values, _half if half else _difference)


def _bins(size: int, stop: float, *, periodic: bool = False) -> Nodes:
    step = stop / size
    return Nodes(size, step, step / 2, periodic)


def _both(wi: Directions, wo: Directions) -> tuple[Angle, ...]:
    return (*to_polar(wi), *to_polar(wo))


def _difference(wi: Directions, wo: Directions) -> tuple[Angle, ...]:
    (theta_i, phi_i), (theta_o, phi_o) = to_polar(wi), to_polar(wo)
    return theta_i, theta_o, np.mod(phi_o - phi_i, 2 * np.pi), phi_i


def _half(wi: Directions, wo: Directions) -> tuple[Angle, ...]:
    """As `_difference`, of the pair or of its reverse: whichever has phi_d within half a turn."""
    there, back = _difference(wi, wo), _difference(wo, wi)
    return tuple(np.where(there[2] <= np.pi, a, b) for a, b in zip(there, back, strict=True))


def _floats(
    source: Source, skipped: int, dtype: str, shape: tuple[int, ...], expected: int
) -> Table:
    """The samples of a file that has ``expected`` bytes, as float32."""
    if source.n_bytes != expected:
        raise FormatError(
            f"{source.label} has {source.n_bytes:,} bytes: with the sizes {' x '.join(map(str, shape[1:]))} it takes "
            f"{expected:,}. It is probably truncated; compare it with the original download."
        )
    with source.open() as stream:
        stream.read(skipped)
        content = stream.read(expected - skipped)
    if len(content) < expected - skipped:
        raise FormatError(
            f"{source.label} ended after {skipped + len(content):,} of {expected:,} bytes: it changed while it was read. Try again."
        )
    with np.errstate(over="ignore"):
        return np.frombuffer(content, dtype).astype(np.float32).reshape(shape)


def _require_finite(values: Table, source: Source) -> None:
    n_wrong = values.size - int(np.count_nonzero(np.isfinite(values)))
    if n_wrong:
        raise FormatError(
            f"{source.label} has {n_wrong:,} of {values.size:,} samples that are not finite: expected numbers that a float32 "
            "holds. It is damaged; compare it with the original download."
        )
