"""Fitted models as files; the suffix says which.

.mtlx          MaterialX                      OpenPBR, or glTF's model
.gltf, .glb    a glTF asset, with a sphere    glTF's model
.json          parameters and errors          any model
"""

import json
from pathlib import Path

from ..files import replacing, suffix_of
from ..fit import Fit
from .gltf import to_glb, to_gltf
from .materialx import to_materialx

MODEL_OF = {".mtlx": "openpbr", ".gltf": "gltf", ".glb": "gltf", ".json": "openpbr"}
"""By the suffix of a file, the model that is fitted for it unless another is named."""


def model_of(path: str | Path) -> str:
    """The name of the model that is fitted for a file unless another is named, by its suffix.

    Raises
    ------
    OutputError
        When the suffix names no format of fitted models.
    """
    return MODEL_OF[suffix_of(Path(path), MODEL_OF, what="format of fitted models")]


def write_fit(path: str | Path, fit: Fit) -> None:
    """Write a fit to ``path``, in the format of its suffix.

    Raises
    ------
    OutputError
        When the suffix names no format, the format cannot hold the model, or the file cannot be written.
    """
    path = Path(path)
    match suffix_of(path, MODEL_OF, what="format of fitted models"):
        case ".mtlx":
            data = to_materialx(fit).encode()
        case ".gltf":
            data = to_gltf(fit)
        case ".glb":
            data = to_glb(fit)
        case _:
            data = json.dumps(fit.to_json(), indent=1).encode()
    with replacing(path) as temporary:
        temporary.write_bytes(data)
