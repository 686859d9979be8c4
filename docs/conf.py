"""The documentation site: ``make docs``. Builds without a network, every warning an error."""

import sys
from pathlib import Path

import halfway

HERE = Path(__file__).parent
ROOT = HERE.parent
sys.path.insert(0, str(HERE / "_ext"))


project = "halfway"
author = "The halfway developers"
copyright = "The halfway developers, BSD-3-Clause"  # noqa: A001 (what Sphinx calls it)
release = version = halfway.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "sphinx_design",
    "sphinx_gallery.gen_gallery",
    "command_line",
    "public_name",
]
exclude_patterns = ["_build", "_ext", "gallery/*.ipynb", "gallery/*.py.md5"]

myst_enable_extensions = ["colon_fence", "deflist"]
smartquotes = False  # --option is two hyphens
myst_heading_anchors = 4

default_role = "py:obj"
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # numpydoc says shapes and units, which types do not
autodoc_preserve_defaults = True
napoleon_google_docstring = False
napoleon_use_param = False  # "shape" in a type is no link
napoleon_use_rtype = False
napoleon_use_ivar = True
add_module_names = False
toc_object_entries_show_parents = "hide"

copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True

sphinx_gallery_conf = {
    "examples_dirs": str(ROOT / "examples"),
    "gallery_dirs": "gallery",
    "filename_pattern": r"plot_",
    "within_subsection_order": "FileNameSortKey",
    "download_all_examples": False,
    "show_memory": False,
    "write_computation_times": False,
    "show_signature": False,
    "remove_config_comments": True,
    "min_reported_time": 0,
    "abort_on_example_error": True,
}

html_theme = "furo"
html_title = "halfway"
html_static_path = ["_static"]
html_css_files = ["halfway.css"]
html_copy_source = False
html_show_sphinx = False
html_theme_options = {"navigation_with_keys": True}
