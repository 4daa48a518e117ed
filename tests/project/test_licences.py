"""`make licences`: what is needed is found, and its licence is judged by its words."""

import importlib.util
from email.message import Message
from pathlib import Path
from types import SimpleNamespace

import pytest

SCRIPT = Path(__file__).resolve().parents[2] / "tools" / "licences.py"
_spec = importlib.util.spec_from_file_location("licences", SCRIPT)
licences = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(licences)


@pytest.mark.parametrize(
    ("licence", "within", "kind"),
    [
        ("MIT", "", "permissive"),
        ("Apache-2.0 AND MIT", "", "permissive"),
        ("BSD-3-Clause", "GEOS inside: LGPL-2.1", "LGPL"),
        ("MIT OR GPL-3.0-only", "", "permissive"),
        ("Apache-2.0 AND GPL-3.0-or-later", "", "GPL"),
        ("GNU Lesser General Public License v2 or later (LGPLv2+)", "", "LGPL"),
        ("GNU General Public License v2 or later (GPLv2+)", "", "GPL"),
        ("AGPL-3.0-only", "", "GPL"),
        ("Mozilla Public License 2.0 (MPL 2.0)", "", "MPL"),
        ("Ask the author", "", "unknown"),
    ],
)
def test_kinds(licence, within, kind):
    assert licences.kind_of(licence, within) == kind


@pytest.mark.parametrize(
    ("field", "value", "licence"),
    [
        ("License-Expression", "MIT", "MIT"),
        ("Classifier", "License :: OSI Approved :: BSD License", "BSD License"),
        ("Classifier", "License :: OSI Approved", "unknown"),
        ("License", "MIT License\n\nCopyright (c)", "MIT"),
        ("Summary", "says nothing", "unknown"),
    ],
)
def test_what_metadata_state(field, value, licence):
    stated = Message()
    stated[field] = value
    assert licences.stated_licence(SimpleNamespace(metadata=stated)) == licence


def test_all_that_is_named_is_listed_once():
    found = list(licences.packages())
    names = [package.name for package in found]
    assert len(names) == len(set(names))
    direct = {package.name for package in found if package.direct}
    assert direct >= {"numpy", "cadquery", "pyvista", "shapely", "pytest"}
    through = {package.name for package in found if not package.direct}
    assert through >= {"cadquery-ocp", "vtk", "llvmlite"}
    own = [package for package in found if package.wanted_by == "surfmesh"]
    assert len(own) > 5 and found[: len(own)] == own


def test_an_ordinary_install_is_free_to_use():
    ordinary = [p for p in licences.packages() if p.wanted_by == "surfmesh"]
    assert [p for p in ordinary if p.kind not in licences.GOOD] == []
