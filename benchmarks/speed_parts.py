"""CAD models of a given number of faces for ``speed.py``: plates with holes, and lofts."""

import math
from pathlib import Path

import cadquery as cq

PITCH = 6.0  # between holes
FACES = (11, 81, 978)
LOFTS = 4


def plate(faces: int) -> cq.Workplane:
    """A plate with rounded corners and holes: counterbored, three faces, or plain.

    The smallest has ten faces without its holes; the others a rounded edge besides, eight more.
    """
    bored, plain = divmod(faces - (10 if faces < 20 else 18), 3)
    columns = math.ceil(math.sqrt(1.5 * (bored + plain)))
    rows = math.ceil((bored + plain) / columns)
    places = [
        (PITCH * (k % columns - 0.5 * (columns - 1)), PITCH * (k // columns - 0.5 * (rows - 1)))
        for k in range(bored + plain)
    ]
    made = cq.Workplane().box(PITCH * columns + 4, PITCH * rows + 4, 4).edges("|Z").fillet(1.5)
    if faces >= 20:
        made = made.faces(">Z").edges().fillet(0.5)
    if bored:
        made = made.faces(">Z").workplane(origin=(0, 0, 2)).pushPoints(places[:bored])
        made = made.cboreHole(2.0, 3.5, 1.5)
    if plain:
        made = made.faces(">Z").workplane(origin=(0, 0, 2)).pushPoints(places[bored:]).hole(2.5)
    return made


def lofts() -> cq.Workplane:
    """From squares to smaller circles, side by side."""
    one = cq.Workplane().rect(20, 20).workplane(offset=25).circle(6).loft().val()
    moved = [one.moved(cq.Location(cq.Vector(30 * k, 0, 0))) for k in range(LOFTS)]
    return cq.Workplane(cq.Compound.makeCompound(moved))


def written(folder: Path, faces: int | None) -> Path:
    """A STEP file of the plate, or of the lofts where no number is given."""
    name = f"plate_{faces}.step" if faces else "lofts.step"
    made = plate(faces) if faces else lofts()
    if faces and (found := made.faces().size()) != faces:
        raise RuntimeError(f"the plate has {found} faces, not {faces}")
    cq.exporters.export(made, str(folder / name))
    return folder / name
