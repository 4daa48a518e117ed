"""Any file that holds a surface: formulas, a planar domain, a drawing; and the whole gallery."""

from __future__ import annotations

from pathlib import Path

from surfmesh.errors import FileFormatError
from surfmesh.geometry.files.formula_file import gallery_folder, load_formula_file
from surfmesh.geometry.files.toml_entries import sets_key
from surfmesh.geometry.surface import Surface

OF_SURFACES = (".toml", ".svg")
"""Extensions of files that hold a surface or a planar domain."""


def load_surface_file(path: str | Path) -> Surface:
    """The surface of a ``.toml`` or ``.svg`` file; a TOML file with ``outer`` is a domain.

    Raises FileFormatError for another extension, SurfaceError or DomainError for the content.
    """
    path = Path(path)
    extension = path.suffix.lower()
    if extension not in OF_SURFACES:
        raise FileFormatError(
            f"cannot read {path.name!r}: surfaces come from .toml files, domains from .toml or .svg"
        )
    if extension == ".toml" and not sets_key(path, "outer"):
        return load_formula_file(path)
    # shapely is for domains only
    from surfmesh.geometry.files.domain_file import load_domain_file
    from surfmesh.geometry.planar.planar_domain import PlanarDomain

    return load_domain_file(path) if extension == ".toml" else PlanarDomain.from_svg(path)


def gallery() -> dict[str, Path]:
    """Name -> file of everything in the gallery, in alphabetical order."""
    return {path.stem: path for path in sorted(gallery_folder().glob("*.toml"))}
