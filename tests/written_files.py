"""Files as other programs write them, made byte by byte: MERL tables, Keras networks, zips."""

import io
import struct
import zipfile
from collections.abc import Mapping, Sequence

import h5py
import numpy as np

MERL_SHAPE = (2, 3, 4)
NBRDF_SHAPES = [(6, 21), (21,), (21, 21), (21,), (21, 3), (3,)]


def merl(samples: np.ndarray | None = None, sizes: Sequence[int] = MERL_SHAPE) -> bytes:
    """A MERL file whose header says ``sizes``; its samples are 0, 1, 2 ... where none are given."""
    samples = np.arange(72.0) if samples is None else samples
    return struct.pack("<3i", *sizes) + np.asarray(samples, "<f8").tobytes()


def nbrdf_layers(seed: int = 0) -> list[np.ndarray]:
    """Random kernels and biases of a neural BRDF."""
    rng = np.random.default_rng(seed)
    return [rng.normal(0, 0.5, shape).astype(np.float32) for shape in NBRDF_SHAPES]


def keras(
    layers: Sequence[np.ndarray], *, order: Sequence[str] = ("a", "b", "c"), omit: str = ""
) -> bytes:
    """An HDF5 file as Keras writes it; layers lie in it by name, and ``order`` says which comes when."""
    buffer = io.BytesIO()
    with h5py.File(buffer, "w") as file:
        file.attrs["layer_names"] = [name.encode() for name in (*order, "lambda")]
        file.create_group("lambda").attrs["weight_names"] = np.array([])
        for layer, (kernel, bias) in zip(
            order, zip(layers[::2], layers[1::2], strict=True), strict=True
        ):
            names = [f"{layer}/kernel:0", f"{layer}/bias:0"]
            group = file.create_group(layer)
            group.attrs["weight_names"] = [name.encode() for name in names]
            for name, weight in zip(names, (kernel, bias), strict=True):
                if name != omit:
                    group[name] = weight
    return buffer.getvalue()


def keras_model(weights: bytes) -> bytes:
    """The weights in a whole model, as Keras' ``model.save`` writes it: below a group, beside the optimiser's."""
    buffer = io.BytesIO()
    with h5py.File(io.BytesIO(weights)) as source, h5py.File(buffer, "w") as file:
        file.attrs["model_config"] = "{}"
        file.create_group("optimizer_weights").attrs["weight_names"] = ["adam/iteration"]
        source.copy("/", file, name="model_weights")
    return buffer.getvalue()


def keras_numbered(layers: Sequence[np.ndarray]) -> bytes:
    """The file that Keras 3's ``save_weights`` writes: no list of layers, and the weights called 0 and 1."""
    buffer = io.BytesIO()
    with h5py.File(buffer, "w") as file:
        file.create_group("optimizer/vars")["0"] = np.int32(3)
        file.create_group("layers/re_lu/vars")
        for i, name in enumerate(("dense", "dense_1", "dense_2")):
            group = file.create_group(f"layers/{name}/vars")
            group["0"], group["1"] = layers[2 * i], layers[2 * i + 1]
    return buffer.getvalue()


def zipped(members: Mapping[str, bytes]) -> bytes:
    """A deflated zip of files by their names."""
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in members.items():
            archive.writestr(name, data)
    return content.getvalue()
