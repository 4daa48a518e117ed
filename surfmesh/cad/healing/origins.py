"""What shapes were made of when bodies were imprinted or faces sewn, and the names that follow."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Protocol

from OCP.TopAbs import TopAbs_FACE, TopAbs_SHELL, TopAbs_SOLID
from OCP.TopoDS import TopoDS_Shape

from surfmesh.cad.model.cad_model import AND
from surfmesh.cad.parts import Detail, Part, Tag
from surfmesh.cad.sub_shapes import ByShape, Numbering, each


class History(Protocol):
    """What became of the shapes of the parts."""

    def images(self, shape: TopoDS_Shape) -> list[TopoDS_Shape]:
        """Several where it was cut, none where nothing is left of it."""
        ...


class Origins:
    """Names and colours of new shapes: of all that they were made of, in the tree's order."""

    def __init__(self, root: Part, history: History) -> None:
        self._of: ByShape[list[Detail]] = ByShape()  # new shape -> of what it was made of
        met = Numbering()
        for part in root:
            for detail in _details(part):
                if detail.shape not in met:  # what is said first of a shape counts
                    met.add(detail.shape)
                    for image in history.images(detail.shape):
                        self.add(image, detail)

    def add(self, shape: TopoDS_Shape, detail: Detail) -> None:
        """One more thing that a new shape was made of."""
        self._of.setdefault(shape, []).append(detail)

    def details(self, shapes: Iterable[TopoDS_Shape]) -> list[Detail]:
        """Of new shapes and all below them."""
        found = []
        for image in Numbering(shapes):
            origins = self._of.get(image)
            if origins:
                each_name = [name for d in origins for name in (d.names or (d.name,)) if name]
                names = tuple(dict.fromkeys(each_name))
                colour = next((d.colour for d in origins if d.colour is not None), None)
                found.append(Detail(image, AND.join(names), colour, names[1:] and names))
        return found


def _details(part: Part) -> Iterator[Detail]:
    """Those of a part, its solids among them: these bear its name where they have none."""
    said: ByShape[Detail] = ByShape()
    for detail in part.details:
        if not detail.shape.IsNull():
            said.setdefault(detail.shape, detail)
    if part.shape is not None:
        for solid in each(part.shape, TopAbs_SOLID):
            said.setdefault(solid, Detail(solid, "", None))
    for shape, detail in said.items():
        nameless = shape.ShapeType() == TopAbs_SOLID and not detail.name
        yield detail._replace(name=part.name) if nameless else detail
        if detail.colour is not None:  # of a shell: its faces, as shells are made anew
            for shell in each(shape, TopAbs_SHELL, TopAbs_SOLID):
                yield from (Detail(face, "", detail.colour) for face in each(shell, TopAbs_FACE))


def tags_again(part: Part, history: History) -> list[Tag]:
    """The tags of a part, of what stands for it now."""
    return [
        tag._replace(shapes=[image for shape in tag.shapes for image in history.images(shape)])
        for tag in part.tags
    ]


def remarks_again(part: Part, history: History) -> list[tuple[TopoDS_Shape | None, str]]:
    """What was said of shapes, of their images; of the part where there is none."""
    return [
        (image, text)
        for shape, text in part.remarks
        for image in (([] if shape is None else history.images(shape)) or [None])
    ]
