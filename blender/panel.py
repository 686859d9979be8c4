"""The library in the sidebar of the 3D view: its materials as pictures, a route of stops, a slider, what is made of it."""

import tempfile
from functools import lru_cache
from pathlib import Path
from typing import ClassVar

import bpy
import bpy.utils.previews

from . import making
from .halfway.errors import HalfwayError
from .space import SpaceFile

_pictures: dict[str, object] = {}
_items: dict[str, list] = {}


@lru_cache(2)
def _opened(path: str, _changed: float) -> SpaceFile:
    return SpaceFile(path)


def space_of(scene: bpy.types.Scene) -> SpaceFile | None:
    """The library that is open."""
    path = Path(bpy.path.abspath(scene.halfway.path))
    return _opened(str(path), path.stat().st_mtime) if path.is_file() else None


def open_space(scene: bpy.types.Scene, path: Path) -> None:
    """Open a library, and go from its first stop to its second."""
    settings = scene.halfway
    settings.path = str(path)
    space = space_of(scene)
    settings.stops.clear()
    for name in space.stops[:2]:
        settings.stops.add().name = name


def table_at(scene: bpy.types.Scene, t: float):
    """The table at t on the route, its name, and its Principled inputs where it is one material."""
    space = space_of(scene)
    stops = [stop.name for stop in scene.halfway.stops]
    if space is None or not stops:
        raise HalfwayError(
            "there is no route: expected a library and one stop or more. Import a .brdfspace file."
        )
    weights = space.weights(stops, t)
    if len(weights) == 1:
        (name,) = weights
        return space.mix(weights), name, space.fit(name)
    return space.mix(weights), f"{stops[0]} to {stops[-1]} {t:.2f}", None


def wear(context: bpy.types.Context, material: bpy.types.Material) -> None:
    """Put a material on the active object."""
    active = context.active_object
    if active is not None and hasattr(active.data, "materials"):
        if not active.data.materials:
            active.data.materials.append(material)
        active.material_slots[active.active_material_index].material = material


def _moved(settings: "Settings", context: bpy.types.Context) -> None:
    """The slider was: the material that follows it shows what is there."""
    if settings.follower and settings.stops:
        table, _, parameters = table_at(context.scene, settings.t)
        making.show(settings.follower, table, settings.kind, parameters=parameters)


def _materials(settings: "Settings", _context: bpy.types.Context) -> list:
    """The library's materials with their pictures, for a menu; kept, since Blender does not keep them."""
    space = space_of(settings.id_data)
    if space is None:
        return []
    if settings.path not in _items:
        loaded = bpy.utils.previews.new()
        with tempfile.TemporaryDirectory() as folder:
            for i, name in enumerate(space.stops):
                path = Path(folder, f"{i}.png")
                path.write_bytes(space.pictures[name])
                loaded.load(name, str(path), "IMAGE").icon_size[
                    :
                ]  # read now, before the folder goes
        _pictures[settings.path] = loaded
        _items[settings.path] = [
            (name, name, "", loaded[name].icon_id, i) for i, name in enumerate(space.stops)
        ]
    return _items[settings.path]


class Stop(bpy.types.PropertyGroup):
    """A material that the route goes through, by its name."""


class Settings(bpy.types.PropertyGroup):
    path: bpy.props.StringProperty(name="Library", subtype="FILE_PATH")
    choice: bpy.props.EnumProperty(name="Material", items=_materials)
    stops: bpy.props.CollectionProperty(type=Stop)
    active: bpy.props.IntProperty()
    kind: bpy.props.EnumProperty(name="As", items=making.KINDS)
    t: bpy.props.FloatProperty(name="t", min=0, max=1, update=_moved)
    follower: bpy.props.PointerProperty(type=bpy.types.Material, name="Follows t")
    n: bpy.props.IntProperty(name="Steps", min=2, default=5)


class _Operator(bpy.types.Operator):
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            self.do(context)
        except HalfwayError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class AddStop(_Operator):
    """Let the route go on to the chosen material."""

    bl_idname = "halfway.add_stop"
    bl_label = "Add stop"

    def do(self, context: bpy.types.Context) -> None:
        context.scene.halfway.stops.add().name = context.scene.halfway.choice


class RemoveStop(_Operator):
    """Take the selected stop out of the route."""

    bl_idname = "halfway.remove_stop"
    bl_label = "Remove stop"

    def do(self, context: bpy.types.Context) -> None:
        context.scene.halfway.stops.remove(context.scene.halfway.active)


class MakeMaterial(_Operator):
    """Make a material of what is at t, put it on the active object, and let it follow the slider."""

    bl_idname = "halfway.make_material"
    bl_label = "Make material"

    def do(self, context: bpy.types.Context) -> None:
        settings = context.scene.halfway
        table, name, parameters = table_at(context.scene, settings.t)
        settings.follower = making.make(name, table, settings.kind, parameters=parameters)
        wear(context, settings.follower)


class MakeRoute(_Operator):
    """Make a material for each of some even steps of the route."""

    bl_idname = "halfway.make_route"
    bl_label = "Make route"

    def do(self, context: bpy.types.Context) -> None:
        settings = context.scene.halfway
        for i in range(settings.n):
            table, name, parameters = table_at(context.scene, i / (settings.n - 1))
            made = making.make(name, table, settings.kind, parameters=parameters)
            made.use_fake_user = True


class MakeAssets(_Operator):
    """Write an asset library with every stop of the library, and show it in the asset browser."""

    bl_idname = "halfway.make_assets"
    bl_label = "Write asset library"

    directory: bpy.props.StringProperty(subtype="DIR_PATH")

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def do(self, context: bpy.types.Context) -> None:
        space = space_of(context.scene)
        if space is None:
            raise HalfwayError("there is no library: expected a .brdfspace file. Import one.")
        kind = context.scene.halfway.kind
        # The scene may have materials of these names already; in the library they are called what they are.
        taken = {name: bpy.data.materials.get(name) for name in space.stops}
        for material in filter(None, taken.values()):
            material.name = f"{material.name} (scene)"
        made = [_asset(space, name, kind) for name in space.stops]
        path = Path(self.directory, f"{Path(space.name).name.replace(':', '-')}.blend")
        bpy.data.libraries.write(str(path), set(made), fake_user=True)
        for material in made:
            bpy.data.materials.remove(material)
        for name, material in taken.items():
            if material is not None:
                material.name = name
        known = context.preferences.filepaths.asset_libraries
        if all(Path(library.path) != path.parent for library in known):
            known.new(name=space.name, directory=str(path.parent))
        self.report({"INFO"}, f"{path}: {len(made)} materials")


def _asset(space: SpaceFile, name: str, kind: str) -> bpy.types.Material:
    material = making.make(name, space.mix({name: 1.0}), kind, parameters=space.fit(name))
    material.asset_mark()
    about = material.asset_data
    about.description, about.license = space.origin.description, space.origin.licence
    about.author = space.origin.source
    about.tags.new("measured")
    making.set_preview(material, space.pictures[name])
    return material


class Panel(bpy.types.Panel):
    bl_idname = "VIEW3D_PT_halfway"
    bl_label = "Measured materials"
    bl_category = "halfway"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"

    def draw(self, context: bpy.types.Context) -> None:
        layout, settings = self.layout, context.scene.halfway
        layout.prop(settings, "path")
        if space_of(context.scene) is None:
            layout.operator("halfway.import_files", text="Open a library or a table")
            return
        layout.template_icon_view(settings, "choice", show_labels=True)
        layout.label(text=settings.choice)
        row = layout.row()
        row.template_list("UI_UL_list", "halfway", settings, "stops", settings, "active", rows=3)
        buttons = row.column(align=True)
        buttons.operator(AddStop.bl_idname, text="", icon="ADD")
        buttons.operator(RemoveStop.bl_idname, text="", icon="REMOVE")
        layout.prop(settings, "kind")
        layout.prop(settings, "t", slider=True)
        layout.prop(settings, "follower")
        layout.operator(MakeMaterial.bl_idname)
        row = layout.row()
        row.operator(MakeRoute.bl_idname)
        row.prop(settings, "n")
        layout.operator(MakeAssets.bl_idname)


CLASSES = (Stop, Settings, AddStop, RemoveStop, MakeMaterial, MakeRoute, MakeAssets, Panel)


def register() -> None:
    for each in CLASSES:
        bpy.utils.register_class(each)
    bpy.types.Scene.halfway = bpy.props.PointerProperty(type=Settings)


def unregister() -> None:
    del bpy.types.Scene.halfway
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
    for loaded in _pictures.values():
        bpy.utils.previews.remove(loaded)
    _pictures.clear()
    _items.clear()
