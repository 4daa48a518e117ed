"""From OCP's edges and vertices to plain ones: each once, by number, and the loops of faces.

Faces walk along loops of coedges; an edge is taken in when a face uses it first.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.GCPnts import GCPnts_AbscissaPoint
from OCP.Precision import Precision
from OCP.ShapeFix import ShapeFix_Edge
from OCP.TopAbs import (
    TopAbs_EXTERNAL,
    TopAbs_FORWARD,
    TopAbs_INTERNAL,
    TopAbs_REVERSED,
    TopAbs_WIRE,
)
from OCP.TopExp import TopExp
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shape

from surfmesh.cad.conversion.convert import curve2d_of, curve_of
from surfmesh.cad.conversion.points_inside import short_edges, vertices_inside
from surfmesh.cad.model.cad_model import CadCoedge, CadEdge, CadVertex
from surfmesh.cad.model.loops import Loop, chained, there_and_back
from surfmesh.cad.parts import Details
from surfmesh.cad.sub_shapes import Numbering, below
from surfmesh.errors import CadError
from surfmesh.geometry.cad_surfaces.curves import Curve
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.small_matrices import norm


class EdgesMet:
    """Vertices and edges that have been met, and the loops that faces make of them.

    details: names of edges. remarks: what was found, with how often; the caller's.
    """

    def __init__(self, details: Details, remarks: Counter[str]) -> None:
        self.vertices: list[CadVertex] = []
        self.edges: list[CadEdge] = []
        self.numbers = Numbering()  # of edges
        self._vertex_numbers = Numbering()
        self._vertices_met: list[int] = []  # a closed edge may have a vertex of its own besides
        self._details = details
        self._remarks = remarks

    def counts(self) -> tuple[int, ...]:
        """For ``go_back``."""
        return (
            len(self.vertices), len(self.edges), len(self._vertices_met),
            len(self._vertex_numbers), len(self.numbers),
        )  # fmt: skip

    def go_back(self, counts: tuple[int, ...]) -> None:
        """As if nothing had been met since ``counts`` said so."""
        vertices, edges, vertices_met, vertex_numbers, numbers = counts
        del self.vertices[vertices:]
        del self.edges[edges:]
        del self._vertices_met[vertices_met:]
        self._vertex_numbers.forget_after(vertex_numbers)
        self.numbers.forget_after(numbers)

    def loops(self, face: TopoDS_Face, called: str) -> list[Loop]:
        """Of a face: around, there and back inside it; its edges are taken in."""
        found = [below(wire) for wire in below(face) if wire.ShapeType() == TopAbs_WIRE]
        wires = [[TopoDS.Edge_s(shape) for shape in wire] for wire in found]
        numbers = {id(edge): self.edge(edge, face) for wire in wires for edge in wire}
        ways = {id(edge): edge.Orientation() for wire in wires for edge in wire}
        uses: Counter[int] = Counter()
        for use, way in ways.items():
            uses[numbers[use]] += 2 if way == TopAbs_INTERNAL else 1
        loops, inside = [], []
        for wire in wires:
            around = []
            for edge in wire:
                number, way = numbers[id(edge)], ways[id(edge)]
                if way == TopAbs_EXTERNAL:
                    self._remarks[f"{called}: an edge outside the face is left out"] += 1
                    continue
                seam = uses[number] > 1
                if way == TopAbs_INTERNAL:
                    edge = TopoDS.Edge_s(edge.Oriented(TopAbs_FORWARD))
                    forward = self._coedge(edge, face, number, seam, called)
                    inside.append((forward, replace(forward, reversed=True)))
                else:
                    around.append(self._coedge(edge, face, number, seam, called))
            if around:
                loops += chained(around, self.edges)
        return loops + there_and_back(inside, self.edges)

    def points_inside(
        self, face: TopoDS_Face, surface: FaceSurface, loops: list[Loop], called: str
    ) -> list[Loop]:
        """Loops of short edges, there and back, from vertices inside the face."""
        vertices = vertices_inside(face)
        found: list[Loop] = []
        edges = short_edges(face, surface, loops, vertices) if vertices else []
        for vertex, short in zip(vertices, edges):
            if short is None:
                continue
            named = TopoDS_Edge()
            BRep_Builder().MakeEdge(named)
            number = self.numbers.add(named)
            start, tolerance = self._vertex(vertex), BRep_Tool.Tolerance_s(vertex)
            (_, far) = short.curve.evaluate(np.array([0.0, short.end]), 0)[0]
            end = self._new_vertex(far, tolerance)
            self.edges.append(
                CadEdge(
                    curve=short.curve,
                    t0=0.0,
                    t1=short.end,
                    start=start,
                    end=end,
                    tolerance=tolerance,
                    degenerate=False,
                    name="",
                    length=short.length,
                )
            )
            there = CadCoedge(number, False, short.pcurve, 0.0, short.end, True)
            found.append((there, replace(there, reversed=True)))
            self._remarks[f"{called} is touched in a point: a short edge makes a node of it"] += 1
        return found

    def _coedge(
        self, edge: TopoDS_Edge, face: TopoDS_Face, number: int, seam: bool, called: str
    ) -> CadCoedge:
        pcurve = BRep_Tool.CurveOnSurface_s(edge, face, 0.0, 0.0)
        if pcurve is None:
            ShapeFix_Edge().FixAddPCurve(edge, face, False, Precision.Confusion_s())
            pcurve = BRep_Tool.CurveOnSurface_s(edge, face, 0.0, 0.0)
        if pcurve is None:
            raise CadError(f"{called}: edge {number} cannot be projected onto it")
        p0, p1 = BRep_Tool.Range_s(edge, face)
        try:
            curve = curve2d_of(pcurve).with_limits(p0, p1)
        except CadError as error:
            raise CadError(f"{called}, edge {number}: {error}") from None
        return CadCoedge(number, edge.Orientation() == TopAbs_REVERSED, curve, p0, p1, seam)

    def edge(self, shape: TopoDS_Edge, face: TopoDS_Face) -> int:
        """Number of an edge, taken in when it is met first; face: one that uses it."""
        number = self.numbers.find(shape)
        if number is not None:
            return number
        number = self.numbers.add(shape)
        edge = TopoDS.Edge_s(shape.Oriented(TopAbs_FORWARD))
        # Degenerated_s also holds for an edge whose curve has merely been forgotten
        geometry = BRep_Tool.Curve_s(edge, 0.0, 0.0)
        degenerate = BRep_Tool.Degenerated_s(edge) or geometry is None
        t0, t1 = BRep_Tool.Range_s(edge, face) if degenerate else BRep_Tool.Range_s(edge)
        if not (abs(t0) < Precision.Infinite_s() and abs(t1) < Precision.Infinite_s()):
            raise CadError(f"edge {number} goes on to infinity; trim it in the CAD system")
        try:
            curve = None if degenerate else curve_of(geometry).with_limits(t0, t1)
        except CadError as error:
            raise CadError(f"edge {number}: {error}") from None
        start, end = self._ends(edge, curve, t0, t1)
        known = self._details.of(shape)
        length = 0.0
        if not degenerate:
            length = GCPnts_AbscissaPoint.Length_s(BRepAdaptor_Curve(edge), t0, t1, 1e-9)
        self.edges.append(
            CadEdge(
                curve=curve,
                t0=t0,
                t1=t1,
                start=start,
                end=end,
                tolerance=BRep_Tool.Tolerance_s(edge),
                degenerate=degenerate,
                name=known.name,
                length=length,
                names=known.names,
            )
        )
        return number

    def _ends(
        self, edge: TopoDS_Edge, curve: Curve | None, t0: float, t1: float
    ) -> tuple[int, int]:
        """Vertices at the ends; an edge that is closed without a vertex gets one."""
        first, last = TopExp.FirstVertex_s(edge), TopExp.LastVertex_s(edge)
        start, end = (None if v.IsNull() else self._vertex(v) for v in (first, last))
        if start is not None and end is not None:
            return start, end
        if curve is None:
            raise CadError("a degenerate edge has no vertex; let the CAD system repair the model")
        tolerance = BRep_Tool.Tolerance_s(edge)
        points = curve.evaluate(np.array([t0, t1]), 0)[0]
        meet = norm(points[1] - points[0]) <= 2.0 * tolerance
        if start is None:
            alone = end is None and meet
            start = self._new_vertex(points[0], tolerance)
            if alone:
                return start, start
        return start, self._new_vertex(points[1], tolerance) if end is None else end

    def _new_vertex(self, point: np.ndarray, tolerance: float) -> int:
        self.vertices.append(CadVertex(point, tolerance))
        return len(self.vertices) - 1

    def _vertex(self, shape: TopoDS_Shape) -> int:
        known = self._vertex_numbers.find(shape)
        if known is not None:
            return self._vertices_met[known]
        self._vertex_numbers.add(shape)
        vertex = TopoDS.Vertex_s(shape)
        point = np.array(BRep_Tool.Pnt_s(vertex).Coord())
        self._vertices_met.append(self._new_vertex(point, BRep_Tool.Tolerance_s(vertex)))
        return self._vertices_met[-1]

    def vertex_number(self, shape: TopoDS_Shape) -> int | None:
        """Number of a vertex that has been met."""
        known = self._vertex_numbers.find(shape)
        return None if known is None else self._vertices_met[known]
