"""Settings of the site that Sphinx makes of these pages: `sh scripts/docs`."""

from __future__ import annotations

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE.parent), str(HERE / "_extensions")]

import strutwork  # noqa: E402 - from this checkout

project = "Strutwork"
author = "The Strutwork developers"
copyright = "The Strutwork developers, BSD-3-Clause"  # noqa: A001 - Sphinx's name
release = version = strutwork.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "sphinx_design",
    # of this folder
    "pages",
    "mathml",
    "package_reference",
    "command_reference",
    "example_files",
]
exclude_patterns = ["_build", "**/.ipynb_checkpoints"]

myst_enable_extensions = ["colon_fence", "dollarmath"]
myst_heading_anchors = 4
# formulas are MathML already
myst_update_mathjax = False
html_math_renderer = "mathml"

# types stand in the docstrings, with their shapes
autodoc_typehints = "none"
autodoc_member_order = "bysource"
autodoc_preserve_defaults = True
autosummary_generate = False
napoleon_google_docstring = False
# a shape such as (n, 3) is no name to be looked up
napoleon_use_param = False
napoleon_use_rtype = False
napoleon_use_ivar = True
# `name` in a docstring: a link where the site has it, else code (see package_reference)
default_role = "py:obj"
toc_object_entries_show_parents = "hide"
maximum_signature_line_length = 88

nitpicky = True
nitpick_ignore_regex = [
    # the site links to nothing outside, so that it can be read without a network
    (r"py:.*", r"(numpy|np|scipy|sfepy|xarray|xr|pandas|plotly|go|pint|pyvista|trimesh)(\..*)?"),
    (r"py:.*", r"(collections|pathlib|typing|enum|concurrent|warnings)\..*"),
    # exceptions and bases of Python itself
    (r"py:(exc|class)", r"[A-Z][A-Za-z]*(Error|Warning|Exception|Interrupt)|object|tuple|str|int"),
]
html_theme = "pydata_sphinx_theme"
html_title = "Strutwork"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sourcelink = False
# the summaries would be fetched from the pages, which a browser forbids for files
html_show_search_summary = False
# else the first page that a reader opens complains in the console
html_context = {"default_mode": "auto"}
html_theme_options = {
    "logo": {"text": "Strutwork"},
    "navbar_align": "left",
    "header_links_before_dropdown": 8,
    "show_toc_level": 2,
    "navigation_with_keys": False,
    "show_prev_next": True,
    "footer_start": ["copyright"],
    "footer_end": ["theme-version"],
    "pygments_light_style": "a11y-high-contrast-light",
    "pygments_dark_style": "a11y-high-contrast-dark",
}
html_sidebars = {"index": [], "validation": [], "search": []}

copybutton_prompt_text = "$ "
copybutton_only_copy_prompt_lines = True
