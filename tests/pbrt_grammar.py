"""The part of pbrt's scene format that our exports use, held to strictly.

Directives, kinds and parameters with their types are those of the file format pages, https://pbrt.org/fileformat-v2 and
https://pbrt.org/fileformat-v4 (sections "Transformations", "Cameras", "Samplers", "Film", "Integrators", "Lights",
"Materials", "Shapes"), and of the sources that read them (mmp/pbrt-v2, mmp/pbrt-v4).
"""

import re
from typing import NamedTuple

TRANSFORMATIONS = {"Scale": 3, "Translate": 3, "LookAt": 9}
BLOCKS = ("WorldBegin", "WorldEnd", "AttributeBegin", "AttributeEnd")
_PICTURE = {"xresolution": "integer", "yresolution": "integer", "filename": "string"}
_COMMON = {
    "Camera": {"perspective": {"fov": "float"}},
    "Material": {"measured": {"filename": "string"}},
    "Shape": {"sphere": {"radius": "float"}},
}
GRAMMAR = {
    "pbrt-v2": {
        **_COMMON,
        "Film": {"image": _PICTURE},
        "Sampler": {"lowdiscrepancy": {"pixelsamples": "integer"}},
        "SurfaceIntegrator": {"directlighting": {"maxdepth": "integer"}},
        "LightSource": {"infinite": {"L": "rgb"}, "point": {"I": "rgb", "from": "point"}},
    },
    "pbrt-v4": {
        **_COMMON,
        "Film": {"rgb": _PICTURE},
        "Sampler": {"zsobol": {"pixelsamples": "integer"}},
        "Integrator": {"path": {"maxdepth": "integer"}},
        "LightSource": {"infinite": {"L": "rgb"}, "point": {"I": "rgb", "from": "point3"}},
    },
}
OF_THE_WORLD = ("LightSource", "Material", "Shape")
N_VALUES = {"rgb": 3, "point": 3, "point3": 3, "float": 1, "integer": 1, "string": 1}

_TOKEN = re.compile(r'\s*("[^"\n]*"|\[|\]|[^\s"\[\]]+)')


class Directive(NamedTuple):
    """One statement: ``Shape "sphere" "float radius" [1]``, or a transformation with its numbers."""

    name: str
    kind: str
    parameters: dict
    numbers: tuple


def parse(text: str, version: str) -> list[Directive]:
    """The statements of a scene; an AssertionError where a version of pbrt would not take it."""
    tokens = _TOKEN.findall(text)
    assert re.sub(r"\s", "", "".join(tokens)) == re.sub(r"\s", "", text)
    grammar, directives, at = GRAMMAR[version], [], 0

    def take():
        nonlocal at
        at += 1
        return tokens[at - 1]

    while at < len(tokens):
        name = take()
        if name in BLOCKS:
            directives.append(Directive(name, "", {}, ()))
        elif name in TRANSFORMATIONS:
            numbers = tuple(float(take()) for _ in range(TRANSFORMATIONS[name]))
            directives.append(Directive(name, "", {}, numbers))
        else:
            kinds = grammar[name]
            kind = _unquoted(take())
            parameters = {}
            while at < len(tokens) and tokens[at].startswith('"'):
                type_, label = _unquoted(take()).split(" ")
                assert kinds[kind][label] == type_, (name, kind, label, type_)
                assert label not in parameters
                parameters[label] = _values(take, type_)
            directives.append(Directive(name, kind, parameters, ()))
    _require_order([directive.name for directive in directives], version)
    return directives


def _values(take, type_):
    assert take() == "["
    values = []
    while (token := take()) != "]":
        values.append(_unquoted(token) if type_ == "string" else float(token))
        assert type_ != "integer" or re.fullmatch(r"-?\d+", token)
    assert len(values) == N_VALUES[type_]
    return values


def _unquoted(token):
    assert re.fullmatch(r'"[^"]+"', token), token
    return token[1:-1]


def _require_order(names, version):
    """Options, then the world; blocks nest; pbrt-v2 renders at WorldEnd, pbrt-v4 at the end of the file."""
    assert names.count("WorldBegin") == 1
    assert names.count("WorldEnd") == (version == "pbrt-v2")
    if version == "pbrt-v2":
        assert names[-1] == "WorldEnd"
    begin = names.index("WorldBegin")
    assert set(names[:begin]) >= {"LookAt", "Camera", "Film", "Sampler"}
    assert not set(names[:begin]) & set(OF_THE_WORLD)
    assert not set(names[begin + 1 :]) & {"Camera", "Film", "Sampler", "Integrator", "SurfaceIntegrator"}  # fmt: skip
    depth = 0
    for name in names:
        depth += (name == "AttributeBegin") - (name == "AttributeEnd")
        assert depth >= 0
    assert depth == 0
