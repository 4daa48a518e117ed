"""Random CadQuery parts and sizings: pure functions of what is drawn.

A part: a base shape, one to four features (holes, bosses, cuts, fillets, chamfers, shells,
patterns), of random sizes, turned at random. Invalid results of OpenCASCADE are left out.
"""

from random import Random

import cadquery as cq

import surfmesh as sm


def sizing_of(draw: Random, part: cq.Shape, stretched: bool) -> sm.Sizing:
    box = part.BoundingBox()
    chord = box.DiagonalLength * 10 ** draw.uniform(-3.3, -2.0)
    options = {"growth": draw.choice((1.2, 1.3, 1.5))}
    if stretched:
        options["anisotropy"] = draw.choice((3.0, 5.0, 30.0))
    if draw.random() < 0.3:
        options["max_size"] = box.DiagonalLength * draw.uniform(0.03, 0.15)
    return sm.Sizing(chord=chord, **options)


def valid_part(draw: Random) -> cq.Shape | None:
    """None where OpenCASCADE fails or calls its own result invalid."""
    try:
        part = _base(draw)
        for _ in range(draw.randint(1, 4)):
            part = draw.choice(_FEATURES)(draw, part)
        shape = part.val()
        axis = cq.Vector(draw.uniform(-1, 1), draw.uniform(-1, 1), draw.uniform(0.1, 1))
        shape = shape.rotate(cq.Vector(0, 0, 0), axis, draw.uniform(0, 360))
        sound = shape.isValid() and shape.Volume() > 0.0 and len(part.solids().vals()) == 1
    except Exception:  # OCP's own exceptions have no common parent
        return None
    return shape if sound else None


def _base(draw: Random) -> cq.Workplane:
    a, b, c = (draw.uniform(4, 20) for _ in range(3))
    kind = draw.choice(("box", "cylinder", "prism", "cone", "sphere", "revolved", "loft", "tube"))
    plane = cq.Workplane()
    if kind == "box":
        return plane.box(a, b, c)
    if kind == "cylinder":
        return plane.cylinder(c, a / 2)
    if kind == "prism":
        return plane.polygon(draw.randint(3, 9), a).extrude(c, taper=draw.choice((0, 5)))
    if kind == "cone":
        return cq.Workplane(obj=cq.Solid.makeCone(a / 2, draw.choice((0, a / 5)), c))
    if kind == "sphere":
        return plane.sphere(a / 2)
    if kind == "tube":
        return plane.circle(a / 2).circle(a / 2 * draw.uniform(0.5, 0.95)).extrude(c)
    if kind == "revolved":
        outline = plane.moveTo(a / 4, 0).lineTo(a / 2, 0)
        outline = outline.spline([(a / 3, c / 2), (a / 2.5, c)], includeCurrent=True)
        return outline.lineTo(a / 4, c).close().revolve(draw.choice((360, 200)), (0, 0), (0, 1))
    first = plane.rect(a, b).workplane(offset=c)
    return first.circle(min(a, b) / 3).loft()


def _reach(part: cq.Workplane) -> float:
    return part.val().BoundingBox().DiagonalLength


def _hole(draw: Random, part: cq.Workplane) -> cq.Workplane:
    size = _reach(part)
    tool = cq.Workplane().cylinder(3 * size, size * 10 ** draw.uniform(-2.2, -0.8))
    return part.cut(_placed(draw, tool, size / 5))


def _boss(draw: Random, part: cq.Workplane) -> cq.Workplane:
    size = _reach(part)
    tool = draw.choice((
        cq.Workplane().cylinder(size, size * draw.uniform(0.05, 0.15)),
        cq.Workplane().box(size / 4, size / 3, size),
        cq.Workplane().sphere(size / 4),
    ))  # fmt: skip
    return part.union(_placed(draw, tool, size / 5))


def _pocket(draw: Random, part: cq.Workplane) -> cq.Workplane:
    size = _reach(part)
    tool = draw.choice((
        cq.Workplane().box(size / 3, size / 4, size / 3),
        cq.Workplane().sphere(size / 5),
        cq.Workplane(obj=cq.Solid.makeTorus(size / 4, size / 16)),
        cq.Workplane(obj=cq.Solid.makeCone(size / 6, 0, size / 2)),
    ))  # fmt: skip
    return part.cut(_placed(draw, tool, size / 3))


def _fillet(draw: Random, part: cq.Workplane) -> cq.Workplane:
    edges = part.edges(draw.choice(("|Z", ">Z", "<Z", "%CIRCLE")))
    return edges.fillet(_reach(part) * draw.uniform(0.005, 0.06))


def _chamfer(draw: Random, part: cq.Workplane) -> cq.Workplane:
    return part.edges(draw.choice((">Z", "<Z"))).chamfer(_reach(part) * draw.uniform(0.002, 0.04))


def _shell(draw: Random, part: cq.Workplane) -> cq.Workplane:
    return part.faces(draw.choice((">Z", "<Z"))).shell(-_reach(part) * draw.uniform(0.01, 0.05))


def _pattern(draw: Random, part: cq.Workplane) -> cq.Workplane:
    step = _reach(part) / 8
    face = part.faces(">Z").workplane(centerOption="CenterOfBoundBox")
    return face.rarray(step, step, 2, draw.randint(1, 3)).hole(step * draw.uniform(0.05, 0.7))


_FEATURES = (_hole, _hole, _boss, _pocket, _fillet, _chamfer, _shell, _pattern)


def _placed(draw: Random, tool: cq.Workplane, away: float) -> cq.Workplane:
    axis = (draw.uniform(-1, 1), draw.uniform(-1, 1), draw.uniform(0.1, 1))
    angle = draw.choice((0, 0, 90, draw.uniform(0, 180)))
    return tool.rotate((0, 0, 0), axis, angle).translate(
        tuple(draw.uniform(-away, away) for _ in range(3))
    )
