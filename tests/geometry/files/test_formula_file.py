"""Formula files: what is wrong in them is named; what the gallery states as fact is true."""

import numpy as np
import pytest

from surfmesh.errors import FormulaError, SurfaceError
from surfmesh.geometry.differential.fundamental_forms import area, curvatures, forms
from surfmesh.geometry.files.formula_file import gallery, load_formula_file
from surfmesh.geometry.formulas.compilation import compiled
from surfmesh.geometry.formulas.expression import parse
from surfmesh.geometry.formulas.parser import symbol

GOOD = """
name = "bump"
description = "one"
x = "u"
y = "a*v"
z = 0
[parameters]
a = 2
[domain]
u = [0, "2*pi"]
v = [-1, 1.5]
[sizing]
chord = 0.1
[facts]
euler = 1
closed = false
"""

WRONG = [
    ('name = "bump"', "", "'name' is missing"),
    ('x = "u"', "", "'x' is missing"),
    ('x = "u"', "x = true", "'x' must be text or a whole number"),
    ('x = "u"', 'x = "u"\nw = 1', "unknown key 'w'"),
    ("v = [-1, 1.5]", "", "'domain.v' is missing"),
    ("v = [-1, 1.5]", "v = [-1, 1.5, 2]", "'domain.v' is a pair"),
    ("v = [-1, 1.5]", "v = [1.5, -1]", "reversed"),
    ("v = [-1, 1.5]", "v = [false, true]", "'domain.v' must be"),
    ("v = [-1, 1.5]", "v = 3", "'domain.v' must be a list"),
    ("v = [-1, 1.5]", "v = [-1, 1.5]\nw = [0, 1]", "unknown key 'domain.w'"),
    ("a = 2", 'a = "2"', "parameter 'a' is not a number"),
    ("a = 2", "pi = 2", "known already"),
    ("chord = 0.1", 'chord = "small"', "'sizing.chord' must be a whole number or a number"),
    ("chord = 0.1", "cord = 0.1", "unknown key 'sizing.cord'"),
    ("euler = 1", "euler = 1.5", "'facts.euler' must be a whole number"),
    ("closed = false", "closed = 0", "'facts.closed' must be true or false"),
    ("closed = false", "colour = 0", "unknown key 'facts.colour'"),
    ("[parameters]", "[parameters", "not a TOML file"),
    ("z = 0", "z = 0\nloops = [[[0, 0], [1]]]", r"'loops\[0\]' holds \[1\]"),
    ("z = 0", 'z = 0\nloops = [[[0, 0], [1, 0], [1, "u"]]]', r"'loops\[0\]': unknown name"),
]


def test_a_good_file(tmp_path):
    path = tmp_path / "bump.toml"
    path.write_text(GOOD)
    surface = load_formula_file(path)
    assert (surface.name, surface.description) == ("bump", "one")
    assert surface.domain == ((0.0, 2 * np.pi), (-1.0, 1.5))
    assert surface.sizing_defaults == {"chord": 0.1}
    assert surface.facts == {"euler": 1, "closed": False}
    assert surface.evaluate([[1, 1]])[0].tolist() == [[1, 2, 0]]


@pytest.mark.parametrize("right, wrong, reason", WRONG, ids=lambda x: x[:24])
def test_wrong_files_are_named_with_the_key(tmp_path, right, wrong, reason):
    path = tmp_path / "wrong.toml"
    assert right in GOOD
    path.write_text(GOOD.replace(right, wrong, 1))
    with pytest.raises(SurfaceError, match=reason) as caught:
        load_formula_file(path)
    assert "wrong.toml" in str(caught.value)


def test_a_refused_formula_keeps_its_column(tmp_path):
    path = tmp_path / "hostile.toml"
    path.write_text(GOOD.replace('"a*v"', "\"v + __import__('os')\""))
    with pytest.raises(FormulaError, match=r"hostile.toml: y: ") as caught:
        load_formula_file(path)
    assert caught.value.column == 16


def test_files_that_cannot_be_read(tmp_path):
    with pytest.raises(SurfaceError, match="no such file"):
        load_formula_file(tmp_path / "absent.toml")
    with pytest.raises(SurfaceError, match="cannot be read"):
        load_formula_file(tmp_path)
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(SurfaceError, match="not a TOML file"):
        load_formula_file(tmp_path / "bytes.toml")


def test_the_gallery_holds_what_is_promised():
    promised = """two_peaks wavy plane sphere ellipsoid torus cylinder cone catenoid helicoid
        hyperbolic_paraboloid monkey_saddle enneper mobius klein dini bad_speed"""
    assert set(promised.split()) <= gallery().keys()


@pytest.mark.parametrize("name", gallery())
def test_facts(name):
    surface = load_formula_file(gallery()[name])
    assert surface.name == name and surface.description and surface.sizing_defaults
    assert {"area", "euler", "closed", "one_sided"} <= surface.facts.keys()

    coarse = 8 if surface.loops else 64
    assert area(surface, coarse) == pytest.approx(surface.facts["area"], rel=1e-10)

    lo, hi = np.array(surface.domain).T
    uv = lo + (hi - lo) * np.random.default_rng(0).uniform(0.01, 0.99, (300, 2))
    found = curvatures(forms(surface, uv))
    size = np.abs(found.k1) + np.abs(found.k2) + 1e-12
    u, v = symbol("u"), symbol("v")
    for fact, value, scale in (("gaussian", found.gaussian, size**2), ("mean", found.mean, size)):
        if fact in surface.facts:
            formula = parse(surface.facts[fact], parameters=surface.parameters)
            expected = compiled([formula] * 3, (u, v)).evaluate(uv)[0][:, 0]
            assert np.abs((value - expected) / scale).max() < 1e-8

    if "volume" in surface.facts:
        assert _volume(surface) == pytest.approx(surface.facts["volume"], rel=1e-10)


def _volume(surface, cells=64):
    """A third of the flux of r, by the midpoint rule in u and Gauss's rule in v."""
    (u0, u1), (v0, v1) = surface.domain
    u = u0 + (u1 - u0) * (np.arange(4 * cells) + 0.5) / (4 * cells)
    nodes, weights = np.polynomial.legendre.leggauss(cells)
    v = v0 + 0.5 * (v1 - v0) * (nodes + 1)
    uv = np.stack(np.meshgrid(u, v), axis=-1).reshape(-1, 2)
    r, r_u, r_v = surface.evaluate(uv, 1)
    flux = np.einsum("ij,ij->i", r, np.cross(r_u, r_v)).reshape(len(v), len(u))
    return weights @ flux.mean(axis=1) * (u1 - u0) * 0.5 * (v1 - v0) / 3
