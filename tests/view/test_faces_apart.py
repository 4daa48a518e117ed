"""Curvature jumps where faces meet, and has one sign on all that is convex."""

from dataclasses import replace

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm
from surfmesh.view.camera import direction_of
from surfmesh.view.colouring import colouring
from surfmesh.view.drawing import drawing, face_legend
from surfmesh.view.faces_apart import faces_apart


@pytest.fixture(scope="module")
def rounded():
    part = cq.Workplane().box(4, 3, 2).edges("|Z").fillet(0.5).faces(">Z").tag("top").end()
    return sm.mesh(part, 0.5)


def test_every_face_has_vertices_of_its_own(rounded):
    apart = faces_apart(rounded)
    np.testing.assert_array_equal(apart.points[apart.triangles], rounded.points[rounded.triangles])
    faces = np.full(len(apart.points), -1)
    faces[apart.triangles] = apart.face_ids[:, None]
    assert (faces[apart.triangles] == apart.face_ids[:, None]).all()
    segments = [mesh.points[mesh.edge_segments] for mesh in (apart, rounded)]
    np.testing.assert_array_equal(*segments)


def test_convex_fillets_have_one_sign(rounded):
    values = colouring(faces_apart(rounded), "mean").values
    assert np.unique(values.round(12)).tolist() == [-1.0, 0.0]


def test_names_of_faces_stand_beside_their_colours(rounded):
    drawn = drawing(rounded, (400, 300), by="face")
    assert [name for _, name, _ in face_legend(drawn)] == ["top"]
    assert face_legend(drawing(rounded, (400, 300))) == []
    pale = drawn.mesh.replaced(groups=replace(drawn.mesh.groups, face_names=("a", "b", "c", "d")))
    colours = [colour for _, _, colour in face_legend(drawn._replace(mesh=pale))]
    for red, green, blue in ([int(c[i : i + 2], 16) / 255 for i in (1, 3, 5)] for c in colours):
        assert 0.2126 * red + 0.7152 * green + 0.0722 * blue < 0.46  # read on white
    assert drawn.title.startswith("workplane: ")


def test_planar_domains_are_seen_from_above():
    flat = np.array([(0, 0, 2.0), (1, 0, 2.0), (0, 1, 2.0)])
    assert direction_of(flat)[2] > 0.999999
