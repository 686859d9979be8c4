"""File > Import: tables as materials, ``.brdfspace`` files as libraries."""

from pathlib import Path
from typing import ClassVar

import bpy
from bpy_extras.io_utils import ImportHelper

from . import making, panel
from .halfway.errors import HalfwayError
from .preferences import read
from .space import SUFFIX

FILES = "*.binary;*.bsdf;*.h5;*.json;*" + SUFFIX


class ImportMaterial(bpy.types.Operator, ImportHelper):
    """Make materials of measured tables, or open a library."""

    bl_idname = "halfway.import_files"
    bl_label = "Import measured materials"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    filter_glob: bpy.props.StringProperty(default=FILES, options={"HIDDEN"})
    files: bpy.props.CollectionProperty(type=bpy.types.OperatorFileListElement)
    directory: bpy.props.StringProperty(subtype="DIR_PATH")
    kind: bpy.props.EnumProperty(name="As", items=making.KINDS)

    def execute(self, context: bpy.types.Context) -> set[str]:
        names = [file.name for file in self.files if file.name]
        paths = [Path(self.directory, name) for name in names] or [Path(self.filepath)]
        try:
            for path in paths:
                self._open(context, path)
        except HalfwayError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}

    def _open(self, context: bpy.types.Context, path: Path) -> None:
        if path.suffix == SUFFIX:
            panel.open_space(context.scene, path)
            return
        material = making.make(path.stem, read(path), self.kind)
        panel.wear(context, material)
        self.report({"INFO"}, f"{path.name}: the material {material.name}")


def _in_menu(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.operator(ImportMaterial.bl_idname, text="halfway (.binary, .bsdf, .h5, .brdfspace)")


def register() -> None:
    bpy.utils.register_class(ImportMaterial)
    bpy.types.TOPBAR_MT_file_import.append(_in_menu)


def unregister() -> None:
    bpy.types.TOPBAR_MT_file_import.remove(_in_menu)
    bpy.utils.unregister_class(ImportMaterial)
