# SPDX-License-Identifier: MIT OR Apache-2.0

"""Settings of the documentation: `make docs` builds it, warnings are errors.

Sphinx with MyST-NB, because autodoc reads the docstrings of the compiled classes from the module
itself, and because pages and notebooks are executed: what they print and draw is what the installed
version prints and draws.
"""

import shapespline

project = "shapespline"
author = "The shapespline developers"
release = shapespline.__version__
version = release

# The source is python/, so that the notebooks of python/examples are pages too.
root_doc = "docs/index"
include_patterns = ["docs/**", "examples/*.ipynb"]
exclude_patterns = ["docs/performance-table.md"]
# MathJax comes with the pages: formulas are set without a network too.
extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.mathjax",
    "sphinx-mathjax-offline",
]

# Pages

myst_enable_extensions = ["colon_fence", "dollarmath", "amsmath", "deflist"]
myst_heading_anchors = 3
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 120
# Matplotlib's figures, sharp on dense screens.
nb_mime_priority_overrides = [("html", "image/png", 5)]

# Reference

default_role = "py:obj"
autodoc_typehints = "none"
autodoc_member_order = "bysource"
napoleon_numpy_docstring = True
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True

# Looks

html_theme = "furo"
html_static_path = ["static"]
html_css_files = ["style.css"]
html_title = f"shapespline {release}"
html_copy_source = False
html_show_sphinx = False
html_show_copyright = False
