"""What kind of surface the triangles form, and where they meet that should not."""

from dataclasses import dataclass

from surfmesh.quality.figures.part import Part
from surfmesh.quality.measures.bodies import BodyPair
from surfmesh.quality.measures.loose_edges import LooseEdges
from surfmesh.quality.measures.measurements import LISTED, Measurements
from surfmesh.quality.measures.self_intersection import MeetingPair, located


@dataclass(frozen=True, kw_only=True)
class TopologyFigures(Part):
    """From connectivity alone."""

    euler: int  # V - E + F
    euler_exact: int | None  # of the model
    closed: bool  # no boundary edge
    manifold: bool  # every edge in one or two triangles, every vertex in one fan of them
    oriented: bool  # neighbours run along their common edge in opposite directions
    one_sided: bool  # by nature of the surface: no orientation is demanded
    components: int
    boundary_loops: int
    boundary_edges: int  # of one triangle
    nonmanifold_edges: int  # of three triangles or more

    @classmethod
    def of(cls, measured: Measurements) -> "TopologyFigures":
        """Of the mesh, whatever the model says."""
        topology = measured.topology
        return cls(
            euler=topology.euler,
            euler_exact=measured.facts.euler,
            closed=topology.closed,
            manifold=topology.manifold,
            oriented=topology.oriented,
            one_sided=measured.mesh.one_sided,
            components=topology.components,
            boundary_loops=topology.boundary_loops,
            boundary_edges=topology.boundary_edges,
            nonmanifold_edges=len(topology.crowded_edges),
        )


@dataclass(frozen=True, kw_only=True)
class ContactFigures(Part):
    """Triangles that meet where they share nothing. None: points are not finite."""

    self_intersections: int | None  # pairs of triangles of one body
    crosses_itself: bool  # by nature of the surface: self-intersections are no fault
    meeting: tuple[MeetingPair, ...]  # the first twenty of them
    contacts: int | None  # pairs that meet between two bodies of a CAD model that only touch
    overlapping_bodies: int | None  # pairs of solids that share volume
    touching_bodies: int | None  # pairs of bodies that touch without a common face
    bodies: tuple[BodyPair, ...]  # the first twenty of both, and of those whose facets meet
    loose_edges: LooseEdges | None  # rims of faces that lie edge to edge and share nothing

    @classmethod
    def of(cls, measured: Measurements) -> "ContactFigures":
        """Of the mesh, and of the bodies of its model."""
        pairs, bodies, mesh = measured.meeting, measured.bodies, measured.mesh
        crosses, loose = measured.crosses_itself, measured.loose_edges
        if pairs is None or bodies is None:
            return cls(
                self_intersections=None, crosses_itself=crosses, meeting=(), contacts=None,
                overlapping_bodies=None, touching_bodies=None, bodies=(), loose_edges=loose,
            )  # fmt: skip
        return cls(
            self_intersections=len(pairs),
            crosses_itself=crosses,
            meeting=located(mesh, pairs[:LISTED]),
            contacts=None if mesh.solid_ids is None else bodies.contacts,
            overlapping_bodies=len(bodies.overlapping),
            touching_bodies=len(bodies.touching),
            bodies=(*bodies.overlapping, *bodies.touching, *bodies.near)[:LISTED],
            loose_edges=loose,
        )
