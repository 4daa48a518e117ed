"""Whatever satisfies the published Surface protocol works everywhere, without a name too."""

import json

import numpy as np
import pytest

import surfmesh as sm
from surfmesh.geometry.surface import (
    BoundedSurface,
    Surface,
    stated_facts,
    stated_sizes,
    surface_kind,
)
from surfmesh.io import read


class Bowl:
    name, domain, loops = "", ((-1.0, 1.0), (-1.0, 1.0)), ()

    def evaluate(self, uv, order=0):
        (u, v), one, zero = np.asarray(uv, float).T, np.ones(len(uv)), np.zeros(len(uv))
        values = [(u, v, u * u + v * v), (one, zero, 2 * u), (zero, one, 2 * v)]
        values += [(zero, zero, 2 * one), (zero, zero, zero), (zero, zero, 2 * one)]
        return tuple(np.stack(value, axis=1) for value in values[: (1, 3, 6)[order]])

    def derivative_bounds(self, lo, hi):
        return None


class Trimmed(Bowl):
    """Lists where the protocol says tuples, arrays in Fortran's order."""

    __slots__ = ()
    domain = np.array([[-1, 1], [-1, 1]])
    loops = ([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)],)

    def evaluate(self, uv, order=0):
        return [np.asfortranarray(array) for array in super().evaluate(uv, order)]


SURFACES = [
    Bowl(),
    Trimmed(),
    sm.NumericSurface(lambda u, v: (u, v, u * u + v * v), u=(-1, 1), v=(-1, 1), name=""),
]


@pytest.fixture(params=SURFACES, ids=lambda surface: type(surface).__name__)
def surface(request):
    assert isinstance(request.param, Surface)
    return request.param


def test_what_it_does_not_say_is_nothing(surface):
    assert not isinstance(surface, BoundedSurface)
    assert (surface_kind(surface), stated_facts(surface), stated_sizes(surface)) == ("", {}, {})


@pytest.mark.parametrize("ratio", [1.0, 5.0])
def test_it_is_meshed_explained_and_estimated(surface, ratio):
    sizing = sm.Sizing(chord=0.03, anisotropy=ratio)
    mesh = sm.mesh(surface, sizing)
    report = sm.check(mesh)
    assert report.clean and report.deviation_two_sided <= 0.03
    assert json.loads(report.to_json())["by_face"][0]["kind"] == "" and report.to_text()
    found = sm.explain(surface, sizing, (0.1, 0.2, 0.0))
    assert found.place == "surface" and found.size > 0.0 and str(found)
    assert sm.estimate(surface, sizing).triangles > 0
    assert sm.mesh(surface, sizing, order=2).order == 2


def test_it_is_saved_and_drawn(tmp_path, surface):
    mesh = sm.mesh(surface, 0.3)
    for name in ("m.vtu", "m.stl"):
        assert len(read(mesh.save(tmp_path / name)).triangles) == len(mesh.triangles)
    sm.show(surface, 0.3, path=tmp_path / "field.png")
    assert (tmp_path / "field.png").exists() and "SurfaceMesh" in mesh._repr_html_()
