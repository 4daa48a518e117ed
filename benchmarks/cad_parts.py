"""Parts made with CadQuery, small and each hard in its own way, that stand beside the corpus."""

import math

import cadquery as cq


def bracket() -> cq.Workplane:
    """A plate with rounded edges, four holes and a boss with a countersunk bore."""
    plate = cq.Workplane().box(60, 40, 8).edges("|Z").fillet(6).faces(">Z").edges().fillet(1.5)
    drilled = plate.faces(">Z").workplane().rect(44, 24, forConstruction=True).vertices().hole(5)
    boss = drilled.faces(">Z").workplane(origin=(0, 0, 4)).circle(9).extrude(12)
    return boss.faces(">Z").workplane().cskHole(6, 10, 82)


def elbow() -> cq.Workplane:
    """A pipe round a quarter circle, with a flange at each end."""
    bend = (
        cq.Workplane("XY").center(30, 0).circle(10).circle(8)
        .revolve(90, (-30, 0, 0), (-30, 1, 0))
    )  # fmt: skip
    flange = cq.Workplane("XY").center(30, 0).circle(16).circle(8).extrude(4)
    other = cq.Workplane("YZ").center(0, -30).circle(16).circle(8).extrude(-4)
    return bend.union(flange).union(other)


def spring() -> cq.Workplane:
    """A round wire along three turns of a helix."""
    path = cq.Wire.makeHelix(6.0, 18.0, 10.0)
    return cq.Workplane("XZ").center(10, 0).circle(1.5).sweep(cq.Workplane(path), isFrenet=True)


def thread() -> cq.Workplane:
    """The ridge of a screw thread: a triangle with a blunt tip along four turns."""
    path = cq.Wire.makeHelix(2.0, 8.0, 5.0)
    profile = cq.Workplane("XZ").moveTo(5, -0.85).lineTo(6.2, -0.15).lineTo(6.2, 0.15)
    return profile.lineTo(5, 0.85).close().sweep(cq.Workplane(path), isFrenet=True)


def transition() -> cq.Workplane:
    """A loft from a square to a smaller circle."""
    return cq.Workplane().rect(20, 20).workplane(offset=25).circle(6).loft()


def shelled_box() -> cq.Workplane:
    """A box with rounded edges, hollow, open at the top, its wall a twentieth of its width."""
    return cq.Workplane().box(40, 30, 20).edges("|Z or <Z").fillet(4).faces(">Z").shell(-2)


def touching_boxes() -> cq.Shape:
    """Two boxes that share a face."""
    from OCP.BOPAlgo import BOPAlgo_Builder

    fuse = BOPAlgo_Builder()
    fuse.AddArgument(cq.Solid.makeBox(1, 1, 1).wrapped)
    fuse.AddArgument(cq.Solid.makeBox(2, 1, 1, cq.Vector(1, 0, 0)).wrapped)
    fuse.Perform()
    return cq.Shape.cast(fuse.Shape())


def torus() -> cq.Solid:
    """One face, two seams."""
    return cq.Solid.makeTorus(10, 3)


def hollow_ball() -> cq.Workplane:
    """A sphere with a void: two shells, four poles."""
    ball = cq.Workplane().sphere(10)
    return ball.cut(cq.Workplane().sphere(6))


PARTS = {
    part.__name__: part
    for part in (
        bracket, elbow, spring, thread, transition, shelled_box, touching_boxes, torus, hollow_ball
    )
}  # fmt: skip

EULER = {
    "bracket": [2 - 2 * 5], "elbow": [0], "spring": [2], "thread": [2], "transition": [2],
    "shelled_box": [2], "touching_boxes": [2, 2], "torus": [0], "hollow_ball": [4],
}  # fmt: skip
"""V - E + F of the solids' boundaries, from their number of tunnels and voids."""


def part(name: str) -> cq.Shape:
    """The shape of a part."""
    made = PARTS[name]()
    shape = made.val() if isinstance(made, cq.Workplane) else made
    if not math.isfinite(shape.Volume()) or shape.Volume() <= 0:
        raise ValueError(f"the part {name} has no volume")
    return shape
