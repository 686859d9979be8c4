"""A set in the words of Croissant 1.0, the vocabulary in which catalogues of training data read what is in one.

Source: MLCommons, Croissant Format Specification, version 1.0 (docs.mlcommons.org/croissant).
"""

import hashlib
from typing import Any

from .sets import SampleSet

_TERMS = (
    "citeAs column equivalentProperty extract field fileProperty fileObject fileSet format includes isLiveDataset jsonPath "
    "key md5 parentField path recordSet references regex repeated replace samplingRate separator source subField transform"
)
_CONTEXT: dict[str, Any] = {
    "@language": "en",
    "@vocab": "https://schema.org/",
    "sc": "https://schema.org/",
    "cr": "http://mlcommons.org/croissant/",
    "rai": "http://mlcommons.org/croissant/RAI/",
    "dct": "http://purl.org/dc/terms/",
    "conformsTo": "dct:conformsTo",
    "data": {"@id": "cr:data", "@type": "@json"},
    "dataType": {"@id": "cr:dataType", "@type": "@vocab"},
    "examples": {"@id": "cr:examples", "@type": "@json"},
    **{term: f"cr:{term}" for term in _TERMS.split()},
}
"""The specification's, whole: readers compare it."""
_FILES = {
    "merl": ("*/*.binary", "application/octet-stream"),
    "bsdf": ("*/*.bsdf", "application/octet-stream"),
    "zarr": ("tables.zarr/*", "application/vnd.zarr"),
}
_FIELDS = {
    "name": "What the sample is called.",
    "split": "Which split it belongs to; no material of the library has a part in two.",
}


def croissant(folder: str, samples: SampleSet, recipes: str, format: str) -> dict[str, Any]:
    """The document; ``recipes`` is the text of recipes.json."""
    origin = samples.library.origin
    return {
        "@context": _CONTEXT,
        "@type": "sc:Dataset",
        "conformsTo": "http://mlcommons.org/croissant/1.0",
        "name": folder,
        "description": f"{len(samples):,} new materials (BRDFs), mixed from {samples.library.name}: {origin.description}. "
        "No measurements.",
        "license": origin.licence or "not stated",
        "citeAs": origin.source,
        "version": "1.0.0",
        "distribution": [_recipes_file(recipes), *_tables(format)],
        "recordSet": [
            {
                "@type": "cr:RecordSet",
                "@id": "samples",
                "name": "samples",
                "description": "The samples; recipes.json has also what each is mixed of.",
                "field": [_field(*each) for each in _FIELDS.items()],
            }
        ],
    }


def _recipes_file(text: str) -> dict[str, Any]:
    content = text.encode()
    return {
        "@type": "cr:FileObject",
        "@id": "recipes.json",
        "name": "recipes.json",
        "contentUrl": "recipes.json",
        "contentSize": f"{len(content)} B",
        "encodingFormat": "application/json",
        "sha256": hashlib.sha256(content).hexdigest(),
    }


def _tables(format: str) -> list[dict[str, Any]]:
    if format not in _FILES:
        return []
    includes, encoding = _FILES[format]
    return [
        {
            "@type": "cr:FileSet",
            "@id": "tables",
            "name": "tables",
            "encodingFormat": encoding,
            "includes": includes,
        }
    ]


def _field(name: str, description: str) -> dict[str, Any]:
    return {
        "@type": "cr:Field",
        "@id": f"samples/{name}",
        "name": name,
        "description": description,
        "dataType": "sc:Text",
        "source": {
            "fileObject": {"@id": "recipes.json"},
            "extract": {"jsonPath": f"$.recipes[*].{name}"},
        },
    }
