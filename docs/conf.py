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
html_show_copyright = False

myst_enable_extensions = ["dollarmath", "amsmath"]
myst_heading_anchors = 3
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


def from_plain_text(app, what, name, obj, options, lines: list[str]) -> None:
    """Docstrings are plain text: what is indented after a blank line is a drawing or an example,
    and bars and stars mean themselves."""
    made: list[str] = []
    drawing = False
    for line in lines:
        indented = line.startswith(" ")
        if drawing:
            drawing = indented or not line
        elif indented and (not made or not made[-1]):
            made += ["::", ""]
            drawing = True
        if not drawing:
            parts = line.split("``")  # code stands at the odd places
            parts[::2] = [part.replace("|", r"\|").replace("*", r"\*") for part in parts[::2]]
            line = "``".join(parts)
        made.append(line)
    lines[:] = made


def setup(app) -> None:
    app.connect("autodoc-process-docstring", from_plain_text)
