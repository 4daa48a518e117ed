"""Sphinx: `make docs` builds these pages, with the notebooks executed, into outputs/docs."""

import os
import shutil
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
os.environ["PYTHONPATH"] = os.pathsep.join(  # of the kernels that run the notebooks
    filter(None, [str(HERE.parent), os.environ.get("PYTHONPATH")])
)

project = "surfmesh"
extensions = ["sphinx.ext.autodoc", "myst_nb"]
exclude_patterns = ["figures.py"]
html_theme = "furo"
html_title = "surfmesh"

myst_enable_extensions = ["dollarmath", "amsmath"]
nb_execution_mode = "force"
nb_execution_timeout = 300  # seconds a cell, when kernels have to be compiled first
nb_execution_in_temp = True
nb_execution_raise_on_error = True

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"


def notebooks_beside_the_pages() -> None:
    """Sphinx reads one folder only: a copy of notebooks/, which git does not see."""
    copies = HERE / "notebooks"
    shutil.rmtree(copies, ignore_errors=True)
    copies.mkdir()
    for path in sorted((HERE.parent / "notebooks").glob("*.ipynb")):
        shutil.copy(path, copies)


notebooks_beside_the_pages()
