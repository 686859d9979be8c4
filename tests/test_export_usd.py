"""USD layers: what USD itself makes of them, however materials are called."""

from importlib import import_module
from typing import Any

import numpy as np
import pytest
from fits import NAMES, OPENPBR, a_fit
from numpy.testing import assert_allclose

from halfway.errors import OutputError
from halfway.export.materialx import printable
from halfway.export.usd import MATERIALS, SCENE, Fits, identifiers, to_usda, write_usd
from halfway.fit.gltf import PreviewSurface

PREVIEW = PreviewSurface(np.array([0.8, 0.4, 0.2]), 0.25, 0.5, 1.7, clearcoat=0.5)
OPENPBR_ID = "ND_open_pbr_surface_surfaceshader"
ODD = [*NAMES, "gold_paint", "gold_paint_2", "back\\slash", "x\t\r", "@a@", "</Materials>", "{}"]


@pytest.fixture
def stage(tmp_path, capfd):
    """The scene of many oddly named materials, opened; whatever USD says of it is an error."""
    from pxr import Usd, UsdValidation

    write_usd(tmp_path, [Fits(a_fit(OPENPBR, name), a_fit(PREVIEW, name)) for name in ODD])
    opened = Usd.Stage.Open(str(tmp_path / SCENE))
    validators: Any = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    found = UsdValidation.ValidationContext(validators).Validate(opened)
    # USD from PyPI is built without its MaterialX plugin, so it knows no node of MaterialX: the test of documents has their names.
    unknown = f"shaderId '{OPENPBR_ID}'"
    assert [e.GetMessage() for e in found if not e.GetMessage().startswith(unknown)] == []
    assert capfd.readouterr() == ("", "")
    return opened


def test_each_sphere_wears_the_material_of_its_name(stage):
    from pxr import Usd, UsdGeom, UsdShade

    spheres = [prim for prim in Usd.PrimRange(stage.GetDefaultPrim()) if prim.IsA(UsdGeom.Sphere)]
    worn = [
        UsdShade.MaterialBindingAPI(sphere).ComputeBoundMaterial()[0].GetPrim()
        for sphere in spheres
    ]
    shown = [printable(name) or "material" for name in ODD]
    assert [prim.GetMetadata("displayName") for prim in worn] == shown
    assert all("as OpenPBR 1.1: 40.0 dB" in prim.GetDocumentation() for prim in worn)


def test_a_material_has_both_shaders_with_the_numbers_of_the_fits(stage):
    from pxr import UsdShade

    material = UsdShade.Material.Get(stage, "/Materials/gold_paint")
    for context, model, names in (
        ("mtlx", OPENPBR, {}),
        ("", PREVIEW, {"base_color": "diffuseColor", "clearcoat_roughness": "clearcoatRoughness"}),
    ):
        shader, *_ = material.ComputeSurfaceSource(context)
        assert shader.GetIdAttr().Get() == (OPENPBR_ID if context else "UsdPreviewSurface")
        for name, value in model.parameters().items():
            if name == "tangent_rotation":
                continue
            assert_allclose(shader.GetInput(names.get(name, name)).Get(), value, rtol=1e-6)


def test_materialx_has_the_node_and_its_inputs():
    mx: Any = import_module("MaterialX")
    library = mx.createDocument()
    mx.loadLibraries(mx.getDefaultDataLibraryFolders(), mx.getDefaultDataSearchPath(), library)
    node = library.getNodeDef(OPENPBR_ID)
    names = OPENPBR.parameters().keys() - {"tangent_rotation"}
    assert all(node.getActiveInput(name) for name in names)


@pytest.mark.usefixtures("stage")
def test_the_same_materials_stand_in_the_layer_alone(tmp_path):
    from pxr import Usd

    alone = Usd.Stage.Open(str(tmp_path / MATERIALS))
    assert alone.GetDefaultPrim().GetChildrenNames() == identifiers(ODD)


def test_names_that_become_one_identifier_are_counted_around_those_that_are_taken():
    names = ["a-b", "a_b", "a-b", "a_b_2"]
    assert identifiers(names) == ["a_b", "a_b_3", "a_b_4", "a_b_2"]


def test_other_models_are_refused():
    with pytest.raises(OutputError, match="expected openpbr and preview"):
        to_usda([Fits(a_fit(PREVIEW), a_fit(OPENPBR))])
