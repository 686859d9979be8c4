"""Materials for another renderer: one fills the folder with its scene, several have a folder each in it; USD holds all in one."""

import json
from collections.abc import Sequence
from pathlib import Path

from ..files import write_text
from ..recipes import NamedBrdf, file_names
from ..tasks import HERE, Work
from .scenes import SceneFolder, readme, write_scene
from .usd import MATERIALS, SCENE, Fits, write_usd


def write_scenes(
    folder: Path, materials: Sequence[NamedBrdf], renderer: str, *, work: Work = HERE
) -> list[SceneFolder]:
    """Write each material with a scene for ``renderer``; see `write_scene`.

    Raises
    ------
    OutputError
        As `write_scene`.
    """
    if whole := {"usd": _write_usd, "blender": _write_blender}.get(renderer):
        return [whole(folder, materials, work)]
    one = len(materials) == 1
    folders = [folder] if one else [folder / name for name in file_names(materials, "")]
    pairs = list(zip(materials, folders, strict=True))
    return [
        write_scene(own, brdf.load(), renderer, name=brdf.label, origin=_origin(brdf))
        for brdf, own in work.track(pairs, "Exporting", len(pairs))
    ]


def _write_usd(folder: Path, materials: Sequence[NamedBrdf], work: Work) -> SceneFolder:
    from ..fit import fit  # what optimises takes a second to load

    fits: list[Fits] = []
    for material in work.track(materials, "Exporting", len(materials)):
        # USD's sphere has no tangents.
        brdf = material.load().turned_mean()
        fits.append(Fits(*(fit(brdf, model, name=material.label) for model in Fits._fields)))
    write_usd(folder, fits)
    # Materials of one library share most lines.
    origin = "\n".join(dict.fromkeys("\n".join(map(_origin, materials)).splitlines())).strip()
    what = "Spheres that wear the materials, in any program that opens USD; for instance:"
    page = folder / "README.md"
    write_text(page, readme("Materials for USD", origin, what, f"usdview {SCENE}", _USD))
    return SceneFolder(folder, (folder / MATERIALS, folder / SCENE, page), f"usdview {SCENE}")


def _write_blender(folder: Path, materials: Sequence[NamedBrdf], work: Work) -> SceneFolder:
    from .blender import write_blender

    path = write_blender(folder, materials, work)
    return SceneFolder(folder, (path,), f"blender, and in it File > Import > halfway: {path.name}")


_USD = f"""`{MATERIALS}` holds each material as MaterialX's OpenPBR and as UsdPreviewSurface, both fitted; what each fit is worth stands in its
`doc`. An anisotropic material is fitted as its mean over turns about the normal. Add the layer to a stage and bind `/Materials/NAME`."""


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
