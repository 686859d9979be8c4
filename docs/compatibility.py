"""The page on compatibility: ``python docs/compatibility.py`` writes `compatibility.md`.

A row is a file as another program writes it, or another program that reads one of ours: who, what, and a function that makes the
file in an empty folder, tries it, and says what came of it. What raises there is a fault of ours, and ends the script.
Programs that are no dependency run in environments of their own (`python_with`).
"""

import struct
import sys
import tempfile
from collections.abc import Callable, Iterator
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from compatibility_rows import Row, python_with
from compatibility_scenes import SCENES

from halfway import MERL, Grid, HalfDiff, TabularBrdf, from_half_diff
from halfway.errors import FormatError
from halfway.formats import MerlFile, read_brdf, read_merl, write_merl, write_rgl
from halfway.formats.rgl_writer import Resolution
from halfway.library import open_library
from halfway.render.variant import load_mitsuba

PAGE = Path(__file__).with_suffix(".md")
KERAS = "3.15.1"

INTRO = """\
# Compatibility

Files as other programs write them, and other programs that read ours: what was tried, and what came of it. *Run* means that the program itself
wrote or read the file; *emulated*, that the file was made as its code makes it. `python docs/compatibility.py` tries all of it again and writes this page.
"""


def main() -> None:
    """Try every row, and write the page."""
    sections = [line for title, rows in SECTIONS.items() for line in section(title, rows)]
    PAGE.write_text("\n".join([INTRO, *sections]))


def section(title: str, rows: list[Row]) -> Iterator[str]:
    """A heading and a table."""
    yield f"## {title}\n\n| program | how | what | result |\n|---|---|---|---|"
    for program, how, what, tried in rows:
        with tempfile.TemporaryDirectory() as folder:
            result = tried(Path(folder))
        print(f"{program}: {what}: {result}", file=sys.stderr)
        yield f"| {program} | {how} | {what} | {result} |"
    yield ""


# Tables and materials


def gold() -> TabularBrdf:
    """A table of the database's size."""
    return open_library("builtin:merl-abc").brdf("gold-paint")


def merl(
    sizes: tuple[int, int, int], *, turns: int = 1, order: str = "<", samples: str = "f8"
) -> Callable[[Path], str]:
    """A MERL file of `gold` under a header of its own."""

    def tried(folder: Path) -> str:
        path = folder / "gold.binary"
        cells = np.concatenate([MerlFile.from_table(gold()).samples] * turns, axis=3)
        path.write_bytes(
            struct.pack(f"{order}3i", *sizes) + cells.astype(order + samples).tobytes()
        )
        try:
            found = read_merl(path)
        except FormatError as error:
            return f"refused: {str(error).partition(': ')[0]}"
        assert found.grid == MERL
        assert np.array_equal(found.values, gold().values, equal_nan=True)
        return "the same table"

    return tried


def keras(call: str, file: str) -> Callable[[Path], str]:
    """A network with weights that follow from their shapes, saved by Keras itself."""
    program = f"""
        import os
        os.environ["KERAS_BACKEND"] = "jax"
        import keras, numpy as np
        layers = [keras.layers.Dense(n, activation="relu") for n in (21, 21, 3)]
        model = keras.Sequential([keras.layers.Input((6,)), *layers])
        model.compile(optimizer="adam", loss="mse")
        model.set_weights([np.cos(np.arange(w.size)).reshape(w.shape) for w in model.get_weights()])
        model.{call}("{file}")
    """

    def tried(folder: Path) -> str:
        python_with([f"keras=={KERAS}", "jax[cpu]", "scipy"], program, folder)
        weights = vars(read_brdf(folder / file)).values()
        assert all(np.allclose(w, np.cos(np.arange(w.size)).reshape(w.shape)) for w in weights)
        return "the same weights"

    return tried


def bsdf(first: int, *, by: str = "halfway") -> Callable[[Path], str]:
    """A tensor file whose version begins with ``first``: as we read it, and as Mitsuba shows it."""

    def tried(folder: Path) -> str:
        path = folder / "gold.bsdf"
        write_rgl(path, gold(), resolution=Resolution(16, 32))
        mi = load_mitsuba()
        if by == "tensor_io":
            from mitsuba.python import tensor_io

            fields = tensor_io.read(str(path))
            tensor_io.write(str(path), **fields)
        content = bytearray(path.read_bytes())
        content[12] = first
        path.write_bytes(content)
        light, viewer = pairs()
        ours = read_brdf(path).eval(light, viewer) * light[:, 2:]
        error = np.abs(in_mitsuba(mi, path, light, viewer) - ours).max() / ours.max()
        assert error < 1e-4, error
        return f"read, and shown by Mitsuba {version('mitsuba')} within {error:.0e} of the largest value"

    return tried


def pairs() -> tuple[np.ndarray, np.ndarray]:
    """Some pairs of directions above the horizon."""
    rng = np.random.default_rng(0)
    angles = (
        rng.uniform(0, 0.6, 200),
        np.zeros(200),
        rng.uniform(0, 0.8, 200),
        rng.uniform(0, np.pi, 200),
    )
    return from_half_diff(HalfDiff(*angles))


def in_mitsuba(mi: Any, path: Path, light: np.ndarray, viewer: np.ndarray) -> np.ndarray:
    """f_r times the light's cosine in its stock plugin."""
    with mi.variant_context("scalar_rgb"):
        plugin = mi.load_dict({"type": "measured", "filename": str(path)})
        values = []
        for i, o in zip(viewer, light, strict=True):
            si = mi.SurfaceInteraction3f()
            si.wi = mi.Vector3f(i.tolist())
            values.append(list(plugin.eval(mi.BSDFContext(), si, mi.Vector3f(o.tolist()))))
        return np.array(values)


def written_again(folder: Path) -> str:
    """The database's order and size."""
    write_merl(folder / "gold.binary", gold())
    MerlFile.read(folder / "gold.binary").write(folder / "again.binary")
    assert (folder / "gold.binary").read_bytes() == (folder / "again.binary").read_bytes()
    return f"{Grid.merl()} cells; written again, the same bytes"


SECTIONS = {
    "Tables and materials": [
        Row("MERL database", "emulated", "its files", written_again),
        Row("fastmerl, of the neural fits' authors", "emulated", "phi_d over the whole turn, 90 x 90 x 360", merl((90, 90, 360), turns=2)),
        Row("whatever the database's reader takes", "emulated", "sizes in another order, 180 x 90 x 90", merl((180, 90, 90))),
        Row("whatever the database's reader takes", "emulated", "the product alone, 1458000 x 1 x 1", merl((1458000, 1, 1))),
        Row("a program on a big-endian machine", "emulated", "MERL, big-endian", merl((90, 90, 180), order=">")),
        Row("a program in single precision", "emulated", "MERL, float32", merl((90, 90, 180), samples="f4")),
        Row(f"Keras {KERAS}", "run", '`model.save("x.h5")` of a neural BRDF', keras("save", "x.h5")),
        Row(f"Keras {KERAS}", "run", '`model.save_weights("x.weights.h5")`', keras("save_weights", "x.weights.h5")),
        Row("halfway", "run", "`.bsdf`, version 1.0", bsdf(1)),
        Row(f"Mitsuba {version('mitsuba')}, `tensor_io`", "run", "`.bsdf`", bsdf(1, by="tensor_io")),
        Row("Mitsuba2_measured_mat, `save_tensor.py`", "emulated", "`.bsdf`, version bytes 88.0", bsdf(88)),
    ],
    **SCENES,
}  # fmt: skip


if __name__ == "__main__":
    main()
