"""What is intersected, each as a model: a surface over a rectangle becomes one face.

v1 +-----2-----+      sides that are one curve in space become a seam, sides that are one point a
   3           1      degenerate edge; the others are free edges. Sides that join with a turn
v0 +-----0-----+      (a Moebius strip) have two faces, so that none uses an edge twice one way.
   u0          u1
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from surfmesh.cad.model.cad_model import (
    CadCoedge,
    CadEdge,
    CadFace,
    CadModel,
    CadNode,
    CadSolid,
    CadVertex,
)
from surfmesh.cad.model.extent import diagonal
from surfmesh.cad.model.invariants import signed_area
from surfmesh.errors import SurfaceError
from surfmesh.geometry.cad_surfaces.curve_on_surface import CurveOnSurface
from surfmesh.geometry.cad_surfaces.curves import Line
from surfmesh.geometry.cad_surfaces.sheet_surface import SheetSurface
from surfmesh.geometry.differential.sides import SideTopology, find_sides
from surfmesh.geometry.inside_loops import nesting_depth
from surfmesh.geometry.parameter_grid import parameter_grid
from surfmesh.geometry.small_matrices import norm
from surfmesh.geometry.surface import Surface, surface_label
from surfmesh.intersection.complex import measured_length
from surfmesh.intersection.contents import region_area, region_cone

TOLERANCE = 1e-10
"""Of the diagonal: sides that join, and edges on their surface."""

CORNERS = ((0, 0), (1, 0), (1, 1), (0, 1))
"""Of the rectangle, counter-clockwise; side k runs from corner k to corner k + 1."""


def as_model(thing: Any, name: str) -> CadModel:
    """A CAD model as it is, a surface as the model of one face, called ``name``.

    Raises ``SurfaceError`` for what cannot be a face.
    """
    if isinstance(thing, CadModel):
        if thing.left_out:
            raise SurfaceError(f"{name}: faces are missing: {thing.left_out[0]}")
        return thing
    if not isinstance(thing, Surface):
        raise SurfaceError(f"{name} is a {type(thing).__name__}: a surface or a model is needed")
    if getattr(thing, "constraints", None):
        raise SurfaceError(f"{name} has constraint lines, which surfaces that meet cannot have")
    return _Sheet(thing, name).model()


class _Sheet:
    """The face of one surface, while it is made."""

    def __init__(self, surface: Surface, name: str) -> None:
        self.name = name
        self.under = SheetSurface(basis=surface, domain=surface.domain, name=name)
        self.vertices: list[CadVertex] = []
        self.edges: list[CadEdge] = []
        points = self.under.evaluate(parameter_grid(surface.domain, 17))[0]
        self.size = norm(np.ptp(points, axis=0))
        self.tolerance = TOLERANCE * self.size
        self.loops_given = tuple(surface.loops)

    def model(self) -> CadModel:
        if self.loops_given:
            loops = self._polygons()
            closed = False
        else:
            sides = find_sides(self.under)
            closed = sides.closed
            if sides.one_sided or any(sides.reversed) or not _opposite(sides):
                raise SurfaceError(
                    f"the sides of {surface_label(self.under)} join with a turn: surfaces with "
                    "one side cannot be intersected yet; cut the domain in two"
                )
            loops = (self._rectangle(sides),)
        face = CadFace(
            surface=self.under, loops=loops, reversed=False, tolerance=self.tolerance,
            name=self.name, colour=None, area=0.0, kind=self.under.kind,
        )  # fmt: skip
        face = replace(face, area=region_area(face.surface, face.loops))
        solids = (self._solid(face),) if closed else ()
        vertices, edges, faces = tuple(self.vertices), tuple(self.edges), (face,)
        return CadModel(
            vertices=vertices, edges=edges, faces=faces, solids=solids, free_shells=(),
            free_faces=() if closed else (0,), name=self.name, unit="mm", file_unit="mm",
            diagonal=diagonal(vertices, edges, faces),
            tree=CadNode(self.name, (0,), ()) if closed else CadNode(self.name, (), (0,)),
            healing=(), source=self.name,
        )  # fmt: skip

    def _solid(self, face: CadFace) -> CadSolid:
        """What a closed surface encloses."""
        volume = region_cone(face.surface, face.loops, self.vertices[0].point)
        return CadSolid((((0, volume < 0.0),),), self.name, None, abs(volume), closed=True)

    def _rectangle(self, sides: SideTopology) -> tuple[CadCoedge, ...]:
        corner = self._corners(sides)
        edge_of: dict[int, int] = {}
        for side in range(4):
            partner = sides.partner[side]
            if partner in edge_of:
                edge_of[side] = edge_of[partner]
                continue
            ends = (corner[side], corner[(side + 1) % 4])
            start, end = ends if side in (0, 1) else ends[::-1]
            edge_of[side] = len(self.edges)
            line, length = _side(sides, side)
            self._add_edge(line, length, start, end, sides.collapsed[side])
        used = list(edge_of.values())
        coedges = []
        for side in range(4):
            line, length = _side(sides, side)
            seam = used.count(edge_of[side]) > 1
            coedges.append(CadCoedge(edge_of[side], side in (2, 3), line, 0.0, length, seam))
        return tuple(coedges)

    def _corners(self, sides: SideTopology) -> list[int]:
        """The vertex at each corner; corners that sides join are one."""
        of = list(range(4))

        def join(a: int, b: int) -> None:
            first, second = sorted((of[a], of[b]))
            of[:] = [first if k == second else k for k in of]

        for side in range(4):
            if sides.collapsed[side]:
                join(side, (side + 1) % 4)
            if sides.partner[side] >= 0:  # opposite: side 0 with 2, 1 with 3
                join(side, (sides.partner[side] + 1) % 4)
                join((side + 1) % 4, sides.partner[side])
        (u0, u1), (v0, v1) = self.under.domain
        places = np.array([((u0, u1)[i], (v0, v1)[j]) for i, j in CORNERS])
        points = self.under.evaluate(places)[0]
        number: dict[int, int] = {}
        for k in range(4):
            if of[k] not in number:
                number[of[k]] = len(self.vertices)
                self.vertices.append(CadVertex(points[k], self.tolerance))
        return [number[of[k]] for k in range(4)]

    def _add_edge(self, line: Line, length: float, start: int, end: int, degenerate: bool) -> None:
        curve = None if degenerate else CurveOnSurface(self.under, line, 0.0, 1.0)
        edge = CadEdge(
            curve=curve, t0=0.0, t1=length, start=start, end=end, tolerance=self.tolerance,
            degenerate=degenerate, name="", length=0.0,
        )  # fmt: skip
        self.edges.append(edge if degenerate else replace(edge, length=measured_length(edge)))

    def _polygons(self) -> tuple[tuple[CadCoedge, ...], ...]:
        """Trimming polygons: an edge a segment; outer ones counter-clockwise."""
        depth = nesting_depth(self.loops_given)
        loops = []
        for ring, level in zip(self.loops_given, depth):
            first = len(self.vertices)
            points = self.under.evaluate(ring)[0]
            self.vertices += [CadVertex(point, self.tolerance) for point in points]
            coedges = []
            for k in range(len(ring)):
                after = (k + 1) % len(ring)
                step = ring[after] - ring[k]
                length = norm(step)
                line = Line(ring[k], step / length)
                self._add_edge(line, length, first + k, first + after, False)
                coedges.append(CadCoedge(len(self.edges) - 1, False, line, 0.0, length, False))
            loop = tuple(coedges)
            if (signed_area(loop) > 0.0) != (level % 2 == 0):
                loop = tuple(
                    CadCoedge(c.edge, True, c.pcurve, c.p0, c.p1, False) for c in loop[::-1]
                )
            loops.append(loop)
        order = np.argsort([-signed_area(loop) for loop in loops])
        return tuple(loops[k] for k in order)


def _opposite(sides: SideTopology) -> bool:
    """Do sides join with opposite ones alone?"""
    return all(p < 0 or p == (k + 2) % 4 for k, p in enumerate(sides.partner))


def _side(sides: SideTopology, side: int) -> tuple[Line, float]:
    """The line of a side in (u, v), in the direction in which its variable rises; its length."""
    ends = sides.points(side, np.array([0.0, 1.0]))
    step = ends[1] - ends[0]
    length = float(np.abs(step).max())
    return Line(ends[0], step / length), length
