"""``read_measurements``: the measurements in a file, which its content tells the kind of."""

import re
from pathlib import Path

from ..errors import FormatError, shown
from .brdf_json import read_brdf_json
from .measurements import Measurements
from .text import read_astm, read_csv

_LARGEST = 200_000_000
"""Bytes: ten thousand spectra are some 20 million."""


def read_measurements(path: str | Path) -> Measurements:
    """The measurements in a CSV file, a BRDF JSON file or an ASTM E1392 file.

    Raises
    ------
    FormatError
        When it is none, or what it holds is no BRDF; the message says where.
    """
    path = Path(path)
    label = shown(path.name)
    try:
        if path.stat().st_size > _LARGEST:
            raise FormatError(
                f"{label} has {path.stat().st_size:,} bytes: expected measurements, of {_LARGEST:,} or fewer."
            )
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise FormatError(
            f"{path} cannot be read ({error.strerror}): expected a file of measurements."
        ) from error
    except UnicodeDecodeError:
        raise FormatError(
            f"{label} is no text: expected CSV, JSON or ASTM E1392. A table is read by `read_brdf`."
        ) from None
    if text.lstrip().startswith("{"):
        read = read_brdf_json
    elif re.search(r"(?m)^VARS\b", text):
        read = read_astm
    else:
        read = read_csv
    return read(text, label).measurements(path.stem)
