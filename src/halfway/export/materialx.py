"""A fitted model as a MaterialX document: one surface node and the material that wears it.

OpenPBR goes to the node ``open_pbr_surface``, glTF's model to ``gltf_pbr``; parameters have the names of the node's inputs.
Colours are linear with the primaries of sRGB (``lin_rec709``). Every document is validated by the MaterialX library against its
own node definitions before it is given out.

A tangent that is turned is OpenPBR's own input, of a node that turns it: ``rotate3d``, which takes degrees the other way around, as
MaterialX's own graph of ``gltf_pbr`` has it.

Names are USD identifiers as well, since each becomes the name of a prim: `identifier`. The true one stands in ``uiname`` and ``doc``.

Source: MaterialX specification 1.39, Academy Software Foundation.
"""

import math
import re
from functools import cache
from hashlib import sha256
from importlib import import_module
from typing import Any

from ..errors import OutputError
from ..fit import Fit

NODES = {"openpbr": "open_pbr_surface", "gltf": "gltf_pbr"}
"""The node of each model that has one."""


def to_materialx(fit: Fit) -> str:
    """The document, as XML.

    Raises
    ------
    OutputError
        When MaterialX has no node for the model, or finds fault with the document.
    """
    if fit.model_name not in NODES:
        raise OutputError(
            f"MaterialX has no node for the model {fit.model_name}: expected {' or '.join(NODES)}. "
            f"Fit one of them with --model."
        )
    mx: Any = import_module("MaterialX")
    document = mx.createDocument()
    document.setColorSpace("lin_rec709")
    name = identifier(fit.name or "material")
    surface = document.addNode(NODES[fit.model_name], f"{name}_surface", "surfaceshader")
    parameters = fit.model.parameters()
    # MaterialX before 1.39.4 has no grain in its node of glTF's material.
    for parameter in fit.model.grain if fit.model.is_isotropic else ():
        del parameters[parameter]
    turn = parameters.pop("tangent_rotation", 0.0)
    if isinstance(turn, float) and turn:
        surface.setConnectedNode("geometry_tangent", _turned_tangent(document, name, turn))
    for parameter, value in parameters.items():
        colour = isinstance(value, list)
        surface.setInputValue(
            parameter, mx.Color3(*value) if colour else value, "color3" if colour else "float"
        )
    material = document.addMaterialNode(name, surface)
    true_name = printable(fit.name)
    material.setAttribute("uiname", true_name)
    material.setDocString(f"{true_name}, {fit.summary}")
    text = mx.writeToXmlString(document)
    _require_valid(text, fit.name)
    return text


def printable(name: str) -> str:
    """A name as documents may hold it: what cannot be printed is replaced."""
    return "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in name)


def _turned_tangent(document: Any, name: str, radians: float) -> Any:
    """The node of the tangent, turned counter-clockwise about the normal."""
    turned = document.addNode("rotate3d", f"{name}_tangent", "vector3")
    turned.setInputValue("amount", -math.degrees(radians), "float")
    for port, kind in (("in", "tangent"), ("axis", "normal")):
        source = document.addNode(kind, f"{name}_{kind}_of_mesh", "vector3")
        source.setInputValue("space", "world", "string")
        turned.setConnectedNode(port, source)
    return turned


def identifier(name: str) -> str:
    """A name that MaterialX and USD take: ASCII letters, digits and ``_``, no digit first.

    ``-`` becomes ``_``, and a digit gets one before it. Where more is lost, eight digits of a checksum of the name follow, so that names
    that look alike stay apart.

    >>> identifier("gold-paint"), identifier("001"), identifier("gold paint")
    ('gold_paint', '_001', 'gold_paint_e520cd29')
    """
    clean = re.sub(r"[^A-Za-z0-9_]", "_", name)
    if re.fullmatch(r"[A-Za-z0-9_-]*[A-Za-z0-9][A-Za-z0-9_-]*", name) is None:
        checksum = sha256(name.encode(errors="surrogatepass")).hexdigest()[:8]
        clean = f"{clean.strip('_') or 'material'}_{checksum}"
    return f"_{clean}" if clean[0].isdecimal() else clean


def _require_valid(text: str, name: str) -> None:
    mx: Any = import_module("MaterialX")
    document = mx.createDocument()
    mx.readFromXmlString(document, text)
    document.setDataLibrary(_definitions())
    valid, fault = document.validate()
    if not valid:
        raise OutputError(
            f"MaterialX finds fault with the document of {name}: {' '.join(fault.split())}. "
            "Its version may be too old: 1.39 or later has the nodes."
        )


@cache
def _definitions() -> Any:
    """The node definitions that come with MaterialX."""
    mx: Any = import_module("MaterialX")
    library = mx.createDocument()
    mx.loadLibraries(mx.getDefaultDataLibraryFolders(), mx.getDefaultDataSearchPath(), library)
    return library
