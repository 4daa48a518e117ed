"""Domain files: what is wrong in them is named; what the gallery states as fact is true."""

import numpy as np
import pytest
import shapely

import surfmesh as sm
from surfmesh.errors import DomainError, FileFormatError
from surfmesh.geometry.files.domain_file import load_domain_file
from surfmesh.geometry.planar.domain_faces import inside_faces
from surfmesh.loading import load
from surfmesh.sizing.options.distance_size import DistanceSize, default_options

GOOD = """
name = "plate"
description = "one"
outer = [[0, 0], [4, 0], [4, 3], [0, 3]]
holes = [[[1, 1], [2, 1], [2, 2.5]]]
constraints = [[[0, 2], [4, 2]]]
points = [[3, 1]]
crossings = "split"
[sizing]
growth = 1.3
[sizing.distance]
near = 0.02
far = 0.2
reach = 1
[facts]
area = 11.25
regions = 2
"""

WRONG = [
    ('name = "plate"', "", "'name' is missing"),
    ("outer = [[0, 0]", "outer = 3 # ", "'outer' must be a list"),
    ("outer = [[0, 0]", 'outer = [["a", 0]', "outer loop 0 is not an array"),
    ("outer = ", "outr = ", "unknown key 'outr'"),
    ("[2, 2.5]]", "[2]]", "hole 0 is not an array"),
    ("[2, 1], ", "", "hole 0 has 2 distinct points"),
    ('crossings = "split"', "", "crosses"),
    ('"split"', '"both"', "crossings is"),
    ("growth = 1.3", 'growth = "much"', "'sizing.growth' must be"),
    ("growth = 1.3", "size = 1.3", "exclude each other"),
    ("far = 0.2", "", "'sizing.distance.far' is missing"),
    ("far = 0.2", "fra = 0.2", "unknown key 'sizing.distance.fra'"),
    ("far = 0.2", 'far = "2"', "'sizing.distance.far' must be"),
    ("[sizing.distance]", "[sizing.distances]", "unknown key 'sizing.distances'"),
    ("regions = 2", "regions = 2.5", "'facts.regions' must be a whole number"),
    ("regions = 2", "colour = 2", "unknown key 'facts.colour'"),
    ("[facts]", "[facts", "not a TOML file"),
]


def test_a_good_file(tmp_path):
    path = tmp_path / "plate.toml"
    path.write_text(GOOD)
    domain = load(path)
    assert isinstance(domain, sm.PlanarDomain)
    assert (domain.name, domain.description) == ("plate", "one")
    assert (domain.area, domain.regions) == (11.25, 2)
    asked = default_options(domain)
    assert asked.keys() == {"growth", "size"} and asked["growth"] == 1.3
    assert sm.Sizing.of(asked).size(np.array([[0.0, 0, 0], [4, 1, 0], [1.5, 1.5, 0]])).max() < 0.2
    assert (asked["size"].near, asked["size"].far, asked["size"].reach) == (0.02, 0.2, 1.0)


@pytest.mark.parametrize("right, wrong, reason", WRONG, ids=lambda x: x[:24])
def test_wrong_files_are_named_with_the_key(tmp_path, right, wrong, reason):
    path = tmp_path / "wrong.toml"
    assert right in GOOD
    path.write_text(GOOD.replace(right, wrong, 1))
    with pytest.raises(DomainError, match=reason) as caught:
        load_domain_file(path)
    assert "wrong.toml" in str(caught.value)


def test_files_are_told_apart(tmp_path):
    path = tmp_path / "square.svg"
    path.write_text('<svg xmlns="http://www.w3.org/2000/svg"><rect width="2" height="3"/></svg>')
    assert load(path).area == pytest.approx(6.0)
    assert isinstance(load("plane"), sm.ParametricSurface)
    with pytest.raises(FileFormatError, match=r"CAD models come from \.step .* \.toml \.svg"):
        load(tmp_path / "drawing.dxf")


DOMAINS = ["floor_plate", "letter_a"]


def test_the_gallery_holds_both_kinds():
    assert {*DOMAINS, "wavy", "plane"} <= sm.gallery().keys()


@pytest.mark.parametrize("name", DOMAINS)
def test_facts(name):
    domain = load(name)
    assert domain.name == name and domain.description and domain.warnings == ()
    assert domain.graph.broken_invariant() is None
    shoelace = [abs(shapely.Polygon(loop).area) for loop in (*domain.outer, *domain.holes)]
    assert shoelace[0] - sum(shoelace[1:]) == pytest.approx(domain.facts["area"], rel=1e-11)
    assert domain.area == pytest.approx(domain.facts["area"], rel=1e-11)
    assert domain.regions == domain.facts["regions"]
    whole = shapely.union_all(inside_faces(domain.graph))
    assert whole.geom_type == "Polygon" and 1 - len(whole.interiors) == domain.facts["euler"]
    law = default_options(domain)["size"]
    assert isinstance(law, DistanceSize) and (law.far - law.near) / law.reach < 0.25
