"""A triangulation made of given arrays: what is wrong with them is refused, not followed."""

import numpy as np
import pytest
from naive.triangulation import check_triangulation, half_edges, plane_triangulation

from surfmesh._core import NIL
from surfmesh._core.triangulation import DEAD, Triangulation

ARRAYS = ("xy", "size", "tri", "adj", "region", "fixed")


def given():
    t = plane_triangulation(np.random.default_rng(1).uniform(0, 1, (12, 2)))
    return {name: getattr(t, name).copy() for name in ARRAYS}


def test_arrays_come_back_as_they_were_given():
    arrays = given()
    t = Triangulation(**arrays)
    assert (t.vertices, t.triangles) == (12, 22)
    for name in ARRAYS:
        assert (getattr(t, name) == arrays[name]).all()
    arrays["xy"][0] = 9.0
    assert t.xy[0, 0] != 9.0
    arrays["fixed"] = np.zeros(0, np.uint8)
    assert len(Triangulation(**arrays).fixed) == 0


@pytest.mark.parametrize("name, length", [("size", 11), ("tri", 65), ("adj", 67), ("fixed", 60)])
def test_lengths_must_agree(name, length):
    arrays = given()
    arrays[name] = np.resize(arrays[name], (length, *arrays[name].shape[1:]))
    with pytest.raises(ValueError, match=f"{name} has {length} rows"):
        Triangulation(**arrays)


@pytest.mark.parametrize("name", ["tri", "adj"])
@pytest.mark.parametrize("number", [-2, 66, 2**31 - 1])
def test_numbers_must_exist(name, number):
    arrays = given()
    arrays[name][4] = number
    with pytest.raises(ValueError, match=f"{name} has a .* out of range"):
        Triangulation(**arrays)


def test_twins_must_fit():
    arrays = given()
    arrays["adj"][[0, 1]] = arrays["adj"][[1, 0]]
    with pytest.raises(ValueError, match="does not point back"):
        Triangulation(**arrays)
    arrays = given()
    arrays["tri"][:3] = np.roll(arrays["tri"][:3], 1)
    with pytest.raises(ValueError, match="do not share an edge"):
        Triangulation(**arrays)
    arrays = given()
    arrays["fixed"][0] = 1
    with pytest.raises(ValueError, match="fixed differs"):
        Triangulation(**arrays)


def test_shapes_and_types_must_be_right():
    arrays = given()
    with pytest.raises(TypeError):
        Triangulation(**(arrays | {"xy": arrays["size"]}))
    with pytest.raises(TypeError):
        Triangulation(**(arrays | {"tri": arrays["tri"].reshape(-1, 3)}))
    with pytest.raises(TypeError):
        Triangulation(**(arrays | {"tri": None}))


def test_operations_refuse_what_is_not_there():
    t = Triangulation(**given())
    for e in (-1, 66):
        for call in (t.is_convex, t.swap_edge, t.remove_vertex):
            with pytest.raises(ValueError, match="no such half-edge"):
                call(e)
        with pytest.raises(ValueError, match="no such half-edge"):
            t.locate(e, 0.5, 0.5)
    hull = next(e for (a, b), e in half_edges(t).items() if b == NIL)
    with pytest.raises(ValueError, match="not convex"):
        t.swap_edge(hull)
    arrays = given()
    arrays["region"][0] = DEAD
    arrays["adj"][arrays["adj"] // 3 == 0] = NIL
    with pytest.raises(ValueError, match="has a border"):
        Triangulation(**arrays).locate(5, 0.5, 0.5)


def test_a_star_that_ends_at_the_border_stays():
    arrays = given()
    t = Triangulation(**arrays)
    ghosts = (t.tri.reshape(-1, 3) == NIL).any(axis=1)
    arrays["region"][ghosts] = DEAD
    arrays["adj"][ghosts[arrays["adj"] // 3]] = NIL
    t = Triangulation(**arrays)
    on_border = set(t.tri[(t.adj == NIL) & ~np.repeat(ghosts, 3)].tolist())
    for (a, _), e in half_edges(t).items():
        if a in on_border:
            assert t.remove_vertex(e) == NIL


def test_inserted_vertices():
    """Anywhere, on edges too, and with wide stars beyond the hull; not twice at one place."""
    rng = np.random.default_rng(2)
    t = Triangulation(**given())
    unit = (1.0, 0.0, 1.0)
    for wide, low, high in ((True, -1.0, 2.0), (False, 0.0, 1.0)):
        for x, y in rng.uniform(low, high, (20, 2)).tolist():
            before = t.vertices
            assert t.insert_vertex(0, x, y, unit, wide) == before
            assert check_triangulation(t) is None
    a, b = t.tri[t.locate(0, 0.5, 0.5)[0] * 3 : t.locate(0, 0.5, 0.5)[0] * 3 + 2]
    assert t.insert_vertex(0, *t.xy[a].tolist(), unit) == NIL
    middle = (0.5 * (t.xy[a] + t.xy[b])).tolist()
    assert t.insert_vertex(0, *middle, unit) == t.vertices - 1
    assert check_triangulation(t) is None


def test_a_walk_stops_at_a_fixed_edge():
    t = plane_triangulation([(0, 0), (1, 0), (1, 1), (0, 1)])
    e = next(e for (a, b), e in half_edges(t).items() if {a, b} in ({0, 2}, {1, 3}))
    inside = t.xy[t.tri[3 * (e // 3) : 3 * (e // 3) + 3]].mean(axis=0)
    f = int(t.adj[e])
    assert t.locate(f, *inside, stop=True) == (e // 3, NIL)
    t.fixed[e] = t.fixed[f] = 1
    assert t.locate(f, *inside, stop=True) == (f // 3, f)
    assert t.locate(f, *inside) == (e // 3, NIL)
    assert t.insert_vertex(f, *inside, (1.0, 0.0, 1.0)) == NIL
