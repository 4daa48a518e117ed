"""One picture before it is drawn: colours, lines over them, title and size, however it is drawn."""

from dataclasses import replace
from typing import NamedTuple, TypedDict

import numpy as np

from surfmesh.result.facets import facets
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.truth_value import truth_value
from surfmesh.view.colour_maps import map_of
from surfmesh.view.colouring import CURVATURES, HUES, Colouring, colouring
from surfmesh.view.faces_apart import faces_apart
from surfmesh.view.legend import named_faces, title_of, with_edges
from surfmesh.view.lines import Lines, sides
from surfmesh.view.overlays import overlays

READABLE = 0.45  # the lightest that letters on white may be; 1: white


class Look(TypedDict, total=False):
    """What is asked of a picture; see ``plot``."""

    by: str
    edges: bool | None
    circles: bool
    directions: bool
    worst: int | None
    title: str | None


class Drawing(NamedTuple):
    """What is drawn of a mesh."""

    mesh: SurfaceMesh
    colours: Colouring
    lines: list[Lines]  # the last over the others
    title: str
    edges: bool  # those of the triangles
    size: tuple[int, int]  # pixels


def drawing(
    mesh: SurfaceMesh,
    size: tuple[int, int],
    *,
    by: str = "alpha",
    edges: bool | None = None,
    circles: bool = False,
    directions: bool = False,
    worst: int | None = None,
    title: str | None = None,
) -> Drawing:
    """The drawing of ``mesh``; options and errors as of ``plot``."""
    edges = None if edges is None else truth_value("edges", edges)
    circles, directions = truth_value("circles", circles), truth_value("directions", directions)
    shown = faces_apart(mesh) if by in CURVATURES else mesh
    drawn = Drawing(
        shown,
        colouring(shown, by),
        overlays(mesh, by, draw_circles=circles, directions=directions, worst=worst),
        title_of(mesh) if title is None else title,
        with_edges(mesh, edges, circles),
        size,
    )
    return drawn if shown.mid_points is None else _curved(drawn)


def _curved(drawn: Drawing) -> Drawing:
    """Of quadratic triangles: their facets, with their own sides as lines."""
    mesh, colours = drawn.mesh, drawn.colours
    flat = facets(mesh)
    if colours.per_vertex:
        values = flat.interpolated(mesh, colours.values)
    else:
        values = colours.values[flat.parent]
    lines = [sides(mesh), *drawn.lines] if drawn.edges else drawn.lines
    return drawn._replace(
        mesh=SurfaceMesh(
            points=flat.points, triangles=flat.triangles, face_ids=mesh.face_ids[flat.parent],
            groups=mesh.groups,
        ),
        colours=replace(colours, values=values), lines=lines, edges=False,
    )  # fmt: skip


def face_legend(drawn: Drawing) -> list[tuple[int, str, str]]:
    """Number, name and colour of the faces that have names, where colours tell faces apart; pale
    colours darker, to be read on white."""
    colours = drawn.colours
    if not colours.hues:
        return []
    fractions = (np.arange(colours.hues) + 0.5) / colours.hues
    shades = map_of(colours)(fractions)[:, :3]
    light = shades @ (0.2126, 0.7152, 0.0722)  # as it is seen
    shades *= (READABLE / np.maximum(light, READABLE))[:, None]
    table = np.round(255 * shades).astype(int).tolist()
    return [
        (face, name, "#{:02x}{:02x}{:02x}".format(*table[face % HUES]))
        for face, name in named_faces(drawn.mesh)
    ]
