"""`check` names the first broken invariant of a model that was damaged on purpose."""

from dataclasses import replace

import pytest

cq = pytest.importorskip("cadquery")

from surfmesh.cad.cadquery.from_cadquery import from_cadquery  # noqa: E402


@pytest.fixture(scope="module")
def model():
    return from_cadquery(cq.Workplane().cylinder(3, 2))


def swapped(items, place, item):
    return (*items[:place], item, *items[place + 1 :])


def with_loop(model, change):
    face = model.faces[0]
    face = replace(face, loops=(change(face.loops[0]),))
    return replace(model, faces=swapped(model.faces, 0, face))


def with_edge(model, **changes):
    number = next(n for n, edge in enumerate(model.edges) if not edge.closed)
    return replace(
        model, edges=swapped(model.edges, number, replace(model.edges[number], **changes))
    )


DAMAGE = {
    "names a vertex": lambda m: with_edge(m, end=99),
    "names an edge": lambda m: with_loop(m, lambda loop: (replace(loop[0], edge=99), *loop[1:])),
    "is used by no face": lambda m: replace(m, edges=(*m.edges, m.edges[0])),
    "parameter range": lambda m: with_edge(m, t1=-1.0),
    "has no curve": lambda m: with_edge(m, curve=None),
    "from its vertex": lambda m: with_edge(m, t1=2.0),
    "more than a point": lambda m: with_edge(m, degenerate=True),
    "is open between edges": lambda m: with_loop(m, lambda loop: loop[:-1]),
    "is empty": lambda m: with_loop(m, lambda loop: ()),
    "has no loop": lambda m: replace(m, faces=swapped(m.faces, 0, replace(m.faces[0], loops=()))),
    "seam or not": lambda m: with_loop(
        m, lambda loop: tuple(replace(coedge, seam=False) for coedge in loop)
    ),
    "does not run counter-clockwise": lambda m: with_loop(
        m, lambda loop: tuple(replace(c, reversed=not c.reversed) for c in reversed(loop))
    ),
    "off face 0": lambda m: with_loop(
        m, lambda loop: tuple(replace(c, p1=c.p1 * 0.9) if not c.seam else c for c in loop)
    ),
    "outside its (u, v) box": lambda m: replace(
        m,
        faces=swapped(
            m.faces,
            0,
            replace(m.faces[0], surface=m.faces[0].surface.with_domain(((0, 1), (-1.5, 1.5)))),
        ),
    ),
    "is in no shell": lambda m: replace(m, faces=(*m.faces, m.faces[0])),
    "has the volume": lambda m: replace(m, solids=(replace(m.solids[0], volume=0.0),)),
    "said to be not closed": lambda m: replace(m, solids=(replace(m.solids[0], closed=False),)),
    "names a face": lambda m: replace(m, free_faces=(7,)),
}


@pytest.mark.parametrize("words", DAMAGE)
def test_damage_is_named(model, words):
    assert model.faces[0].kind == "cylinder"
    assert any(words in problem for problem in DAMAGE[words](model).problems())


def test_a_gap_in_uv_at_a_pole_is_seen():
    """In space there is no gap where the edge of the pole is left out."""
    model = from_cadquery(cq.Workplane().sphere(1))
    poles = [n for n, edge in enumerate(model.edges) if edge.degenerate]
    gone = with_loop(model, lambda loop: tuple(c for c in loop if c.edge not in poles))
    assert any("is open in (u, v)" in problem for problem in gone.problems())
