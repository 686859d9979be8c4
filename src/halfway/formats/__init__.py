"""File formats of BRDFs. A file is what its first bytes say, whatever its name."""

from . import hdf5, spectra, zarr_tables
from .content import merl_bytes
from .find import Skipped, SourceBrdf, find_brdfs, read_brdf, read_nbrdf_archive
from .merl import MerlFile, encode_header, read_merl, write_merl
from .nbrdf import NeuralBrdf, read_nbrdf
from .rgl import RglBrdf
from .rgl_reader import read_rgl
from .rgl_writer import write_rgl
from .sources import UNREADABLE
from .write import write_brdf

__all__ = [
    "UNREADABLE",
    "MerlFile",
    "NeuralBrdf",
    "RglBrdf",
    "Skipped",
    "SourceBrdf",
    "encode_header",
    "find_brdfs",
    "hdf5",
    "merl_bytes",
    "read_brdf",
    "read_merl",
    "read_nbrdf",
    "read_nbrdf_archive",
    "read_rgl",
    "spectra",
    "write_brdf",
    "write_merl",
    "write_rgl",
    "zarr_tables",
]
