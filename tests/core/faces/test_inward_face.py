"""The size that bounds those inside planes and cylinders: that of the rules, as Python has them."""

import numpy as np
import pytest

from surfmesh._core import faces as core
from surfmesh._core.faces import BoundaryBuilder
from surfmesh._core.surfaces import cylinder, plane
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.principal_lattice import LEAST_ROWS
from surfmesh.sizing.rules.size_rules import SizeRules, asked_rules

O, X, Y, Z = np.zeros(3), *np.eye(3)
TURN = 2.0 * np.pi
PLAIN = core.FaceManner(None, None, 0.0)


def boundary(width, height, degenerate=False):
    """A rectangle of (u, v), whose sides are not cut."""
    builder = BoundaryBuilder()
    corners = np.array([[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]])
    for start, end in zip(corners, np.roll(corners, -1, axis=0)):
        uv = np.stack([start, end])
        builder.add(uv, np.arange(2), np.zeros((2, 3)), np.ones(2), degenerate, 0.0)
    builder.end_loop()
    return builder.boundary()


def tube_face(radius, height, sizing):
    domain = (0.0, TURN), (0.0, height)
    surface = cylinder(domain, O, X, Y, Z, radius)
    asked = asked_rules(sizing)
    return core.inward_face(surface, boundary(TURN, height), radius, asked, 0.2, PLAIN)


def by_rules(rules, radius):
    if not rules.follows_curvature:
        return rules.clamp[1]
    return float(rules.from_curvature(np.array([1.0 / radius]), np.zeros(1))[0])


@pytest.mark.parametrize(
    "asked",
    [dict(size=1.0), dict(chord=0.01), dict(chord=0.01, max_size=0.3), dict(angle=20.0),
     dict(angle=1.0, size=3.0), dict(max_size=0.2, angle=20.0, min_size=0.1)],
)  # fmt: skip
@pytest.mark.parametrize("radius", [1e-3, 1.0, 300.0])
def test_the_largest_size_is_that_of_the_rules(asked, radius):
    sizing, height = Sizing(**asked), 40.0
    box = np.array([2.0 * radius, 2.0 * radius, height])
    stated = "max_size" in asked
    diagonal = np.hypot(TURN * radius, height) if stated else np.linalg.norm(box)
    rules = SizeRules.of(sizing, float(diagonal))
    wanted, lattice = by_rules(rules, radius), rules.on_lattice()
    found = tube_face(radius, height, sizing)
    if found.on_lattice:
        assert lattice and min(TURN * radius, height) >= LEAST_ROWS * wanted
        wanted = by_rules(lattice, radius)
    assert found.largest == pytest.approx(wanted, rel=1e-14)


def test_triangles_form_a_lattice_where_there_is_room_for_one():
    wide, narrow = (tube_face(10.0, height, Sizing(chord=0.01, max_size=9.0)) for height in (99, 9))
    assert wide.on_lattice and not narrow.on_lattice and wide.largest > narrow.largest


def test_what_has_no_inside_is_none():
    surface, asked = plane(((0.0, 1.0), (0.0, 1.0)), O, X, Y), asked_rules(Sizing(size=0.5))
    flat, point = boundary(1.0, 0.0), boundary(1.0, 1.0, degenerate=True)
    assert core.inward_face(surface, flat, None, asked, 0.2, PLAIN) is None
    assert core.inward_face(surface, point, None, asked, 0.2, PLAIN) is None
    with pytest.raises(ValueError, match="slope"):
        core.inward_face(surface, boundary(1.0, 1.0), None, asked, 0.0, PLAIN)
