"""Where an installed ``halfway`` is, for what Blender cannot read by itself."""

import subprocess
import tempfile
from pathlib import Path

import bpy

from .halfway.brdf import Brdf
from .halfway.errors import HalfwayError
from .halfway.formats import read_brdf


class Preferences(bpy.types.AddonPreferences):
    bl_idname = __package__
    command: bpy.props.StringProperty(
        name="halfway",
        description="The installed command; for recipes and other files that need more than numpy",
        default="halfway",
        subtype="FILE_PATH",
    )

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.prop(self, "command")


def read(path: Path) -> Brdf:
    """The material in a file; a recipe by the installed ``halfway``."""
    return _converted(path) if path.suffix.lower() == ".json" else read_brdf(path)


def _converted(path: Path) -> Brdf:
    command = bpy.context.preferences.addons[__package__].preferences.command
    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder, f"{path.name.split('.')[0]}.binary")
        try:
            subprocess.run(
                [command, "convert", str(path), str(table)],
                check=True,
                capture_output=True,
                text=True,
            )
        except FileNotFoundError:
            raise HalfwayError(
                f"{path.name} is a recipe, and there is no command {command}: expected an installed halfway. "
                "Say where it is in the add-on's preferences."
            ) from None
        except subprocess.CalledProcessError as error:
            raise HalfwayError(error.stderr.strip()) from None
        return read_brdf(table)


def register() -> None:
    bpy.utils.register_class(Preferences)


def unregister() -> None:
    bpy.utils.unregister_class(Preferences)
