"""Materials for another renderer: one fills the folder with its scene, several have a folder each in it."""

import json
from collections.abc import Sequence
from pathlib import Path

from ..recipes import NamedBrdf, file_names
from ..tasks import HERE, Work
from .scenes import SceneFolder, write_scene


def write_scenes(
    folder: Path,
    materials: Sequence[NamedBrdf],
    renderer: str,
    *,
    work: Work = HERE,
) -> list[SceneFolder]:
    """Write each material with a scene for ``renderer``; see `write_scene`.

    Raises
    ------
    OutputError
        As `write_scene`.
    """
    one = len(materials) == 1
    folders = [folder] if one else [folder / name for name in file_names(materials, "")]
    pairs = list(zip(materials, folders, strict=True))
    return [
        write_scene(own, brdf.load(), renderer, name=brdf.label, origin=_origin(brdf))
        for brdf, own in work.track(pairs, "Exporting", len(pairs))
    ]


def _origin(material: NamedBrdf) -> str:
    """What the page says of a mixed material: of what, and whose numbers those are."""
    if material.library is None or material.recipe is None:
        return ""
    recipe = json.dumps(material.recipe.to_json()["weights"])
    about = material.library.origin
    licence = f"Licence: {about.licence}" if about.licence else ""
    sentences = [text for text in (about.description, about.source, licence) if text]
    mixed = f"Made by halfway from `{material.library.name}`: `{recipe}`."
    return "\n".join([mixed, *(f"{sentence}." for sentence in sentences)])
