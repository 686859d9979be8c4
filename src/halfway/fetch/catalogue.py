"""What can be fetched: where it is, how large, under which licence.

Sizes and checksums are those of the publishers or of downloads that were compared with them; where none is known, a file
is checked by its length and its first bytes.
"""

from dataclasses import dataclass, replace

from ..errors import FetchError

TENSOR_FILE = b"tensor_file\0"
ZIP = b"PK\x03\x04"

_RGL = "https://d38rqfq1h7iukm.cloudfront.net/media/materials"
_NAMES = "nbrdf-merl, merl, rgl:NAME or rgl:all"


@dataclass(frozen=True)
class Download:
    """One file to get."""

    file: str
    """What it is called on disk."""
    url: str
    magic: bytes
    """Its first bytes."""
    n_bytes: int | None = None
    md5: str = ""
    """Hex digits; empty where it is not known."""


@dataclass(frozen=True)
class Dataset:
    """Files that come together, and what their authors ask for."""

    name: str
    title: str
    licence: str
    source: str
    """Whom to cite."""
    downloads: tuple[Download, ...]
    unpack: bool = False
    """Whether the file is a zip to be unpacked."""


def dataset(name: str, *, base_url: str = "") -> Dataset:
    """The data set of that name; ``base_url`` stands for the part of the addresses before the files' names.

    Raises
    ------
    FetchError
        When there is none.
    """
    known = _rgl(name.removeprefix("rgl:")) if name.startswith("rgl:") else _DATASETS.get(name)
    if known is None:
        raise FetchError(f"{name} is no data set: expected {_NAMES}.")
    if not base_url:
        return known
    moved = (replace(d, url=f"{base_url.rstrip('/')}/{d.file}") for d in known.downloads)
    return replace(known, downloads=tuple(moved))


def rgl_names() -> tuple[str, ...]:
    """The materials of the RGL database, isotropic and then anisotropic."""
    return (*_RGL_ISOTROPIC.split(), *_RGL_ANISOTROPIC.split())


def _rgl(name: str) -> Dataset:
    if name != "all" and name not in rgl_names():
        close = [known for known in rgl_names() if name and name in known]
        hint = f"perhaps {' or '.join(close[:3])}" if close else f"such as {rgl_names()[0]}, or all"
        raise FetchError(
            f"{name!r} is none of the {len(rgl_names())} materials of the RGL database: {hint}."
        )
    names = rgl_names() if name == "all" else (name,)
    return Dataset(
        name=f"rgl-{name}",
        title="RGL material database, measured BRDFs",
        licence="CC0 1.0, https://creativecommons.org/publicdomain/zero/1.0/",
        source=(
            "J. Dupuy, W. Jakob, An Adaptive Parameterization for Efficient Material Acquisition and Rendering, "
            "ACM TOG 37(6), 2018, https://rgl.epfl.ch/materials"
        ),
        downloads=tuple(_rgl_file(known) for known in names),
    )


def _rgl_file(name: str) -> Download:
    n_bytes, md5 = _RGL_CHECKSUMS.get(name, (None, ""))
    file = f"{name}_rgb.bsdf"
    return Download(file, f"{_RGL}/{name}/{file}", TENSOR_FILE, n_bytes, md5)


_DATASETS = {
    "nbrdf-merl": Dataset(
        name="nbrdf-merl",
        title="Neural fits of the 100 MERL materials; a stand-in, not the measurements",
        licence="MIT, Copyright (c) 2022 asztr",
        source=(
            "A. Sztrajman, G. Rainer, T. Ritschel, T. Weyrich, Neural BRDF Representation and Importance Sampling, "
            "CGF 40(6), 2021, https://github.com/asztr/Neural-BRDF"
        ),
        downloads=(
            Download(
                "merl_nbrdf.zip",
                "https://raw.githubusercontent.com/asztr/Neural-BRDF/HEAD/data/merl_nbrdf.zip",
                ZIP,
                461_136,
                "9eecb962f6941e1d4876bf45aa1c8ee6",
            ),
        ),
    ),
    "merl": Dataset(
        name="merl",
        title="MERL BRDF database, measured BRDFs of 100 materials",
        licence="CC BY-SA 4.0, https://creativecommons.org/licenses/by-sa/4.0/",
        source=(
            "W. Matusik, H. Pfister, M. Brand, L. McMillan, A Data-Driven Reflectance Model, ACM TOG 22(3), 2003, "
            "https://doi.org/10.5281/zenodo.8101680"
        ),
        downloads=(
            Download(
                "BRDFDatabase.zip",
                "https://zenodo.org/records/8101680/files/BRDFDatabase.zip?download=1",
                ZIP,
                1_253_117_184,
                "7141af4c12b4c4feed299769260b3604",
            ),
        ),
        unpack=True,
    ),
}

_RGL_ISOTROPIC = """
    acrylic_felt_green acrylic_felt_orange acrylic_felt_pink acrylic_felt_purple acrylic_felt_white
    acrylic_felt_yellow aurora_white cardboard cc_amber_citrine cc_blue_agat cc_green_malachite
    cc_ibiza_sunset cc_iris_purple_gem cc_nothern_aurora cg_sunflower chm_light_blue chm_mint chm_orange
    cm_military_green cm_toxic_green cm_white colodur_azure_4e colodur_connemara_4c colodur_kalahari_2a
    colodur_napoli_4f ilm_l3_37_dark_green ilm_l3_37_matte ilm_l3_37_metallic ilm_solo_m_68
    ilm_solo_millennium_falcon irid_flake_paint1 irid_flake_paint1_fine irid_flake_paint2
    laika_ceiling_paint_18_gray leaf_maple paper_blue paper_green paper_red paper_white paper_yellow
    satin_blue satin_gold satin_purple satin_rosaline satin_white spectralon vch_dragon_eye_red
    vch_frozen_amethyst vch_golden_yellow vch_silk_blue vch_ultra_pink
"""

_RGL_ANISOTROPIC = """
    aniso_brushed_aluminium_1 aniso_copper_sheet aniso_green_pvc aniso_metallic_paper_copper
    aniso_metallic_paper_gold aniso_miro_7 aniso_morpho_melenaus aniso_sari_silk_2color
    ilm_aniso_darth_vader_pants ilm_aniso_tarkin_tunic weta_brushed_steel_satin_pink
"""

_RGL_CHECKSUMS: dict[str, tuple[int, str]] = {
    "acrylic_felt_green": (658_936, "6a363ab5d822bfd32e26e52d4aac8005"),
    "cc_green_malachite": (658_960, "969033aab6e9172c19a3b94f30ea90bf"),
    "cc_iris_purple_gem": (658_960, "4cab87d0d093efc68af8a89eff42c91f"),
    "cg_sunflower": (1_055_240, "070a7da6e18337894102a32a93972d9d"),
    "chm_mint": (658_952, "a4ccb0be5e05f7300b6d0fc857d1c45f"),
    "cm_military_green": (658_960, "8363bebaa3f4e8cbd4c594db8754db81"),
    "ilm_l3_37_matte": (659_016, "ecf37302f1c8506ef3871d682cb07aae"),
    "ilm_solo_m_68": (658_992, "bd72696703cf5a037f6e52bb73fc5263"),
    "irid_flake_paint1": (659_000, "f3a2d975a4f83c3c75ef170d0c9d5b74"),
    "satin_rosaline": (658_960, "4f65ff22f41d6fd1a530dfc06d913c31"),
    "vch_silk_blue": (658_952, "516181076564c539cd6127a75d2452b2"),
}
