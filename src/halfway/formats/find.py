"""Find the BRDFs in files, folders, zips and the package itself, without reading them yet."""

import os
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from functools import partial
from hashlib import sha256
from pathlib import Path

from ..brdf import Brdf
from ..errors import FormatError, shown
from ..halfdiff import MERL, Grid
from ..locations import BUILTIN_PREFIX
from ..models import ModelSet, builtin
from ..origin import Origin
from .content import HEAD_BYTES, description, kind
from .goniometric import read_csail_source, read_utia_source
from .merl import read_merl_source, table_grid
from .nbrdf import ARCHIVE, NeuralBrdf, read_nbrdf_source, require_small
from .rgl_reader import material_name, read_rgl_source
from .sources import FileSource, MemberSource, Source, by_name, members
from .zarr_tables import ZarrStore, is_zarr

LARGEST_MEMBER = 100_000_000
"""Bytes of a zip's member that are read whatever it takes in the zip; a table of the MERL database has 35 million."""
MAX_RATIO = 100
"""Bytes of a larger member for each that it takes in the zip, at most."""

_EXPECTED = "expected a MERL table, a neural BRDF (.h5), an RGL material (.bsdf), a UTIA (.bin) or MIT CSAIL table, or a Zarr store"
_BRDFS = ("merl", "nbrdf", "rgl", "utia", "csail")


@dataclass(frozen=True)
class SourceBrdf:
    """A BRDF that is there to be loaded. Of what is large, nothing but its header has been read."""

    name: str
    source: str
    """Where it is: a path, ``archive.zip:member`` or ``builtin:NAME``."""
    grid: Grid | None
    """The grid of a table; None for what can be sampled on any."""
    origin: Origin
    _load: Callable[[], Brdf] = field(repr=False)
    _sha256: Callable[[], str] = field(repr=False)
    usual_grid: Grid = MERL
    """Where what is no table is sampled if nobody asks for another."""

    def load(self) -> Brdf:
        """Read it.

        Raises
        ------
        FormatError
            When its samples are damaged; its header and size have been checked.
        """
        return self._load()

    @property
    def sha256(self) -> str:
        """Checksum of the bytes that it is read from, hex digits; of the formula and its numbers if built in."""
        return self._sha256()


@dataclass(frozen=True)
class Skipped:
    """A file that is no BRDF, or a damaged one."""

    path: str
    reason: str
    """The end of a sentence that begins with the file: "is text"."""
    damaged: bool = False
    """Whether it should be one: it begins as one does, or was named itself."""

    @classmethod
    def because(cls, error: FormatError, path: str, *, damaged: bool = True) -> "Skipped":
        """What an error says of a file, without its advice."""
        said, name = str(error), shown(Path(path).name)
        # Of a member of a zip, what follows the zip's name; a name may hold other colons.
        names = [name, *(name[i + 1 :] for i, letter in enumerate(name) if letter == ":")]
        label = next(filter(said.startswith, names), "")
        what_is_wrong, _, _ = said.removeprefix(label).lstrip(": ").partition(": ")
        return cls(path, what_is_wrong, damaged)


def read_brdf(path: str | Path) -> Brdf:
    """The BRDF in a file, whatever its suffix: a MERL, UTIA or MIT CSAIL table, a neural BRDF, an RGL material, or
    a Zarr store of one table.

    Raises
    ------
    FormatError
        When it is none, or is damaged.
    """
    path = Path(path)
    if not is_zarr(path):
        return _inspect(FileSource(path)).load()
    store = ZarrStore.open(path)
    if len(store.names) > 1:
        raise FormatError(
            f"{path.name} holds {len(store.names)} tables: expected one. `halfway library build {path} -o NAME.brdflib` takes all."
        )
    return store.read(0)


def find_brdfs(
    sources: Iterable[str | Path], *, skip_damaged: bool = False
) -> tuple[list[SourceBrdf], list[Skipped]]:
    """The BRDFs in files, folders (with their subfolders), zips and ``builtin:NAME``, and what else is in there.

    Sources keep their order; what is in a folder or a zip is sorted by path. A BRDF is called by its file's name
    without the suffix. With ``skip_damaged`` a source that is no BRDF is skipped like one in a folder.

    Raises
    ------
    FormatError
        When a source does not exist, when one that is a single file is no BRDF, or when two BRDFs have the same name.
    """
    brdfs: dict[str, SourceBrdf] = {}
    skipped: list[Skipped] = []
    for source in sources:
        for item in _items(source, skip_damaged):
            if isinstance(item, Skipped):
                skipped.append(item)
                continue
            if item.name in brdfs:
                raise FormatError(
                    f"{item.name} is there twice, as {brdfs[item.name].source} and {item.source}: "
                    "each material needs a name of its own. Rename one, or leave one out."
                )
            brdfs[item.name] = item
    return list(brdfs.values()), skipped


def read_nbrdf_archive(path: str | Path) -> ModelSet:
    """The neural BRDFs in a zip, read in memory; `find_brdfs` says what else is in it, and why it is left out.

    Raises
    ------
    FormatError
        When the file is no zip, holds no neural BRDF, or two of the same name.
    """
    archive = FileSource(Path(path))
    if _kind(archive) != "zip":
        raise FormatError(f"{archive.label} is no zip: expected an archive of neural BRDFs (.h5).")
    brdfs, _ = find_brdfs([archive.path])
    loaded = {item.name: item.load() for item in brdfs if item.grid is None}
    networks = {name: brdf for name, brdf in loaded.items() if isinstance(brdf, NeuralBrdf)}
    if not networks:
        raise FormatError(
            f"{archive.label} holds no neural BRDF: expected .h5 files of Keras weights in it."
        )
    return ModelSet(archive.name, ARCHIVE, networks)


def _items(source: str | Path, skip_damaged: bool) -> Iterator[SourceBrdf | Skipped]:
    if str(source).startswith(BUILTIN_PREFIX):
        yield from _built_in(str(source).removeprefix(BUILTIN_PREFIX))
        return
    path = Path(source)
    if is_zarr(path):
        yield from _tables(path)
        return
    if path.is_dir():
        for each in _files(path):
            yield from _among_others(each)
        return
    file = FileSource(path)
    try:
        if _kind(file) == "zip":
            yield from map(_member, members(path))
        else:
            yield _inspect(file)
    except FormatError as error:
        if not skip_damaged:
            raise
        yield Skipped.because(error, str(path))


def _built_in(name: str) -> Iterator[SourceBrdf]:
    models = builtin(name)
    for material, model in models.models.items():
        yield SourceBrdf(
            material,
            f"{BUILTIN_PREFIX}{name}",
            None,
            models.origin,
            partial(_itself, model),
            partial(_fingerprint, model),
            models.grid,
        )


def _itself(model: Brdf) -> Brdf:
    return model


def _fingerprint(model: Brdf) -> str:
    return sha256(model.fingerprint()).hexdigest()


def _tables(path: Path) -> Iterator[SourceBrdf]:
    """Those of a Zarr store."""
    store = ZarrStore.open(path)
    for i, name in enumerate(store.names):
        load, checksum = partial(store.read, i), partial(_chunk_checksum, store, i)
        yield SourceBrdf(name, str(path), store.grid, Origin(), load, checksum)


def _chunk_checksum(store: ZarrStore, i: int) -> str:
    return store.chunk(i).sha256()


def _files(folder: Path) -> list[Path]:
    """The files in a folder and its subfolders; a Zarr store is one."""
    paths: list[Path] = []
    for parent, folders, names in os.walk(folder):
        if is_zarr(Path(parent)):
            folders.clear()
            paths.append(Path(parent))
        else:
            paths += [Path(parent, name) for name in names]
    return sorted(paths, key=by_name)


def _among_others(path: Path) -> Iterator[SourceBrdf | Skipped]:
    if not is_zarr(path):
        yield _examine(str(path), path.name, lambda: FileSource(path))
        return
    try:
        yield from _tables(path)
    except FormatError as error:
        yield Skipped.because(error, str(path), damaged=False)


def _member(member: MemberSource) -> SourceBrdf | Skipped:
    return _examine(member.location, member.label, lambda: member)


def _examine(location: str, label: str, open_source: Callable[[], Source]) -> SourceBrdf | Skipped:
    """What a file among others is; one that is no BRDF is no error there."""
    if label.startswith("."):
        return Skipped(location, "is hidden")
    claimed = None
    try:
        source = open_source()
        claimed = _kind(source)
        return _inspect(source)
    except FormatError as error:
        return Skipped.because(error, location, damaged=claimed in _BRDFS)


def _inspect(source: Source) -> SourceBrdf:
    """What a source is, from its first bytes and its size; a `FormatError` says why it can be no BRDF."""
    if isinstance(source, MemberSource):
        _require_modest(source)
    head = source.head(HEAD_BYTES)
    match kind(head, source.n_bytes):
        case "merl":
            return _found(source, table_grid(source), read_merl_source)
        case "nbrdf":
            require_small(source)
            # A network by itself may be anyone's; an archive of them is the published one.
            in_archive = isinstance(source, MemberSource)
            origin = ARCHIVE if in_archive else Origin(ARCHIVE.description)
            return _found(source, None, read_nbrdf_source, origin=origin)
        case "rgl":
            return _found(source, None, read_rgl_source, name=material_name(source.label))
        case "utia":
            return _found(source, None, read_utia_source, usual_grid=Grid.anisotropic())
        case "csail":
            return _found(source, None, read_csail_source, usual_grid=Grid.anisotropic())
        case "zip":
            raise FormatError(f"{source.label} is a zip: expected one BRDF. Name it as a source.")
        case _:
            what = description(head) or "is of no known format"
            raise FormatError(f"{source.label} {what}: {_EXPECTED}.")


def _require_modest(source: MemberSource) -> None:
    most = max(LARGEST_MEMBER, MAX_RATIO * source.member.compress_size)
    if source.n_bytes > most:
        raise FormatError(
            f"{source.label} unpacks to {source.n_bytes:,} bytes: no more than {most:,} are read from a zip. "
            "Unpack it first."
        )


def _kind(source: Source) -> str | None:
    return kind(source.head(HEAD_BYTES), source.n_bytes)


def _found(
    source: Source,
    grid: Grid | None,
    read: Callable[[Source], Brdf],
    *,
    name: str = "",
    origin: Origin = Origin(),  # noqa: B008 (frozen)
    usual_grid: Grid = MERL,
) -> SourceBrdf:
    name, load = name or source.name, partial(read, source)
    return SourceBrdf(name, source.location, grid, origin, load, source.sha256, usual_grid)
