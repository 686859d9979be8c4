"""A valid file of every kind that is read, and its reader: what `test_fuzz` and `fuzz` spoil and try.

Whatever the bytes, a reader gives what it reads or raises a `HalfwayError` of one line.
"""

import json
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
from exr_files import exr
from gonio_files import csail, utia
from written_files import keras, keras_model, keras_numbered, merl, nbrdf_layers, zipped

from halfway import Brdf, Grid, TabularBrdf
from halfway.errors import RenderError
from halfway.fetch.unpack import unpack
from halfway.formats import find_brdfs, read_brdf, write_brdf
from halfway.formats.tensor_file import write_tensor_file
from halfway.formats.zarr_tables import write_zarr
from halfway.library import StoredLibrary, build_library

UP = np.array([0.0, 0.0, 1.0])
AWRY = np.array([[0.6, 0.0, 0.8], [0.0, -0.28, 0.96]])


class Subject(NamedTuple):
    """A kind of file."""

    valid: bytes
    read: Callable[[bytes, Path], None]
    """Puts the bytes into the folder and reads all of them."""


def subjects(folder: Path) -> dict[str, Subject]:
    """Every kind of file, by name; ``folder`` must stay as long as they are used."""
    (folder / "tables").mkdir(parents=True, exist_ok=True)
    for i, name in enumerate(("clay", "chalk")):
        write_brdf(folder / "tables" / f"{name}.binary", _table(0.1 * (i + 1)))
    path = folder / "tiny.brdflib"
    tables = build_library([folder / "tables"], path).library.tables
    weights = {"clay": 0.25, "chalk": 0.75}
    recipe = {"library": str(path), "weights": weights}
    route = {
        "format": 1,
        "library": str(path),
        "stops": ["clay", "chalk"],
        "recipes": [{"t": 0.5, "weights": dict.fromkeys("rgb", weights)}],
    }
    return {
        "merl": Subject((folder / "tables" / "clay.binary").read_bytes(), _read_brdf),
        "merl-order": Subject(_in_another_order(), _read_brdf),
        "rgl": Subject(_tensors(folder, _rgl()), _read_brdf),
        "rgl-spectral": Subject(_tensors(folder, _spectral()), _read_brdf),
        "csail": Subject(csail(_table(0.2), (2, 2, 2, 3)), _read_brdf),
        "utia": Subject(utia(_table(0.2)), _read_brdf),
        "zarr": Subject(_zarr(folder, "zarr.json"), _zarr_with(folder, "zarr.json")),
        "zarr-chunk": Subject(_zarr(folder, _CHUNK), _zarr_with(folder, _CHUNK)),
        "nbrdf": Subject(_nbrdf(), _read_brdf),
        "nbrdf-model": Subject(keras_model(_nbrdf()), _read_brdf),
        "nbrdf-numbered": Subject(keras_numbered(nbrdf_layers()), _read_brdf),
        "zip": Subject(_zip(folder), _find),
        "unpack": Subject(_zip(folder), _unpack),
        "ply": Subject(_PLY, _read_mesh(".ply")),
        "ply-text": Subject(_PLY_TEXT, _read_mesh(".ply")),
        "obj": Subject(_OBJ, _read_mesh(".obj")),
        "hdr": Subject(_HDR, _read_radiance),
        "exr": Subject(_EXR, _read_exr),
        "library": Subject((path / "library.json").read_bytes(), _library_with("library.json", path)),
        "tables": Subject(tables.read_bytes(), _library_with(tables.name, path)),
        "recipe": Subject(json.dumps(recipe).encode(), _materials("recipe.json")),
        "route": Subject(json.dumps(route).encode(), _materials("recipes.json")),
        "words": Subject(b"clay=0.25, chalk=0.75\n0,0.25,1:2:0.1\n1,-2e3", _words(str(path))),
    }  # fmt: skip


def _table(value: float) -> TabularBrdf:
    grid = Grid.merl(4, 3, 4)
    return TabularBrdf(np.full((3, *grid.shape), value, np.float32), grid, name="clay")


# Readers


def _read_brdf(content: bytes, folder: Path) -> None:
    (folder / "spoilt").write_bytes(content)
    _use(read_brdf(folder / "spoilt"))


_CHUNK = "c.0.0.0.0.0"


def _zarr(folder: Path, name: str) -> bytes:
    write_zarr(folder / "clay.zarr", _table(0.1))
    return (folder / "clay.zarr" / name).read_bytes()


def _zarr_with(folder: Path, name: str) -> Callable[[bytes, Path], None]:
    """Reads a Zarr store of which one file is spoilt."""
    valid = {file.name: file.read_bytes() for file in (folder / "clay.zarr").iterdir()}

    def read(content: bytes, place: Path) -> None:
        store = place / "spoilt.zarr"
        store.mkdir(exist_ok=True)
        for file, bytes_ in {**valid, name: content}.items():
            (store / file).write_bytes(bytes_)
        _use(read_brdf(store))

    return read


def _read_mesh(suffix: str) -> Callable[[bytes, Path], None]:
    def read(content: bytes, folder: Path) -> None:
        from halfway.render.assets import read_mesh

        (folder / f"spoilt{suffix}").write_bytes(content)
        mesh = read_mesh(folder / f"spoilt{suffix}")
        assert mesh.positions[mesh.faces].shape == (len(mesh.faces), 3, 3)
        assert np.isfinite(mesh.positions).all()
        assert np.isfinite(mesh.normals).all()

    return read


def _read_radiance(content: bytes, folder: Path) -> None:
    del folder
    from halfway.render.radiance import PictureFault, parse_radiance

    try:
        assert parse_radiance(content).shape[2] == 3
    except PictureFault as fault:
        raise RenderError(f"this picture {fault}") from fault


def _read_exr(content: bytes, folder: Path) -> None:
    from halfway.render.variant import load_mitsuba

    load_mitsuba()
    from halfway.render.environment import read_environment

    (folder / "spoilt.exr").write_bytes(content)
    assert (read_environment(folder / "spoilt.exr") >= 0).all()


def _find(content: bytes, folder: Path) -> None:
    (folder / "spoilt").write_bytes(content)
    found, _ = find_brdfs([folder / "spoilt"])
    for item in found:
        _use(item.load())


def _unpack(content: bytes, folder: Path) -> None:
    (folder / "spoilt").write_bytes(content)
    inside = folder / "inside"
    for path in unpack(folder / "spoilt", inside):
        assert path.resolve().is_relative_to(inside.resolve())


def _library_with(name: str, path: Path) -> Callable[[bytes, Path], None]:
    """Reads a library of which one file is spoilt."""
    valid = {file.name: file.read_bytes() for file in path.iterdir()}

    def read(content: bytes, folder: Path) -> None:
        place = folder / "spoilt.brdflib"
        place.mkdir(exist_ok=True)
        for file, bytes_ in {**valid, name: content}.items():
            (place / file).write_bytes(bytes_)
        library = StoredLibrary(place)
        for i in range(len(library)):
            assert library.row(i).shape == (3, library.grid.size)
        for block in library.blocks():
            library.columns(block)

    return read


def _materials(name: str) -> Callable[[bytes, Path], None]:
    def read(content: bytes, folder: Path) -> None:
        from halfway.recipes import open_materials

        (folder / name).write_bytes(content)
        for material in open_materials([str(folder / name)]):
            _use(material.load())

    return read


def _words(library: str) -> Callable[[bytes, Path], None]:
    """What a person types: a recipe, a list of t and a point, one a line."""

    def read(content: bytes, folder: Path) -> None:
        del folder
        from halfway.cli.arguments import LONGEST_ROUTE, parse_point, parse_t
        from halfway.recipes import Recipe

        recipe, t, point, *_ = [*content[:200].decode(errors="replace").split("\n"), "", ""]
        Recipe.from_text(library, recipe)
        assert len(parse_t(t)) <= LONGEST_ROUTE + 1
        parse_point(point)

    return read


def _use(brdf: Brdf) -> None:
    assert brdf.eval(UP, UP).shape == (3,)
    assert brdf.eval(AWRY, AWRY[::-1]).shape == (2, 3)


# Valid files

_PLY = (
    b"ply\nformat binary_little_endian 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
    b"element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n"
    + np.array([0, 0, 0, 2, 0, 0, 2, 2, 0, 1, 1, 0, 0, 0, 1], "<f4").tobytes()
    + b"\3" + np.array([0, 1, 4], "<i4").tobytes() + b"\1" + np.array([0.5], "<f4").tobytes()
    + b"\4" + np.array([1, 2, 3, 0], "<i4").tobytes() + b"\0"
)  # fmt: skip
_PLY_TEXT = (
    b"ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\nproperty uchar red\n"
    b"element face 2\nproperty list uchar int vertex_index\nend_header\n"
    b"0 0 0 1\n2 0 0 2\n2 2 .5 3\n1 1e-1 0 4\n4 0 1 2 3\n3 0 2 1\n"
)
_OBJ = b"v 0 0 0\nv 2 0 0 \\\n1 1 1\nv 2 2 0\nv 1 .5 0\nvn 0 0 1\nf 1//1 2//1 3//1 4//1\nf -1/2 -2/2/ -3 # face\n"
_HDR = (
    b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n+X 2 -Y 9\n"
    + 2 * (b"\2\2\0\x09" + b"\x89\x40" + b"\x09abcdefghi" + b"\x85\x10\x84\x20" + b"\x89\x80")
)  # fmt: skip


_EXR = exr([(f"sky.{c}", 2, np.linspace(0, 1, 32).reshape(4, 8)) for c in "RGBZ"])


def _nodes(*shape: int) -> np.ndarray:
    return np.linspace(0.5, 1, int(np.prod(shape)), dtype=np.float32).reshape(shape)


def _rgl() -> dict[str, np.ndarray]:
    return {
        "description": np.frombuffer(b"clay", np.uint8),
        "phi_i": np.zeros(1, np.float32),
        "theta_i": np.array([0, 1.5], np.float32),
        "ndf": _nodes(2, 3),
        "sigma": _nodes(2, 3),
        "vndf": _nodes(1, 2, 3, 4),
        "rgb": _nodes(1, 2, 3, 3, 3),
        "jacobian": np.ones(1, np.uint8),
    }


def _spectral() -> dict[str, np.ndarray]:
    """Spectral and anisotropic."""
    fields = _rgl()
    del fields["rgb"]
    return {
        **fields,
        "phi_i": np.array([-3.1, 0, 3.1], np.float32),
        "vndf": _nodes(3, 2, 3, 4),
        "wavelengths": np.array([400, 550, 700, 720], np.float32),
        "spectra": _nodes(3, 2, 4, 3, 3),
    }


def _tensors(folder: Path, fields: dict[str, np.ndarray]) -> bytes:
    write_tensor_file(folder / "clay.bsdf", fields)
    return (folder / "clay.bsdf").read_bytes()


def _nbrdf() -> bytes:
    names = ("dense", "dense_1", "dense_2")
    return keras(nbrdf_layers(), order=names)


def _in_another_order() -> bytes:
    """A MERL file whose header states its sizes in another order."""
    grid = Grid.merl(6, 6, 12)
    samples = np.random.default_rng(0).random((3, *grid.shape))
    return merl(np.where(grid.mask(), samples, -1), (12, 6, 6))


def _zip(folder: Path) -> bytes:
    return zipped(
        {
            "brdfs/clay.binary": (folder / "tables" / "clay.binary").read_bytes(),
            "chalk.bsdf": _tensors(folder, _rgl()),
            "slate.h5": _nbrdf(),
        }
    )
