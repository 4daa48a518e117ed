"""Colours of triangles as bytes, and back: a face's own colour, else that of its solid."""

import numpy as np
from numpy.typing import NDArray

from surfmesh.result.mesh_groups import Colour
from surfmesh.result.surface_mesh import SurfaceMesh

NO_COLOUR = 204  # of each channel: the light grey of what has none, where one is needed


def colour_of(mesh: SurfaceMesh, face: int, solid: int = -1) -> Colour | None:
    """The colour of a face, else of a solid that it bounds, or None."""
    return mesh.groups.face_colour(face) or mesh.groups.solid_colour(solid)


def triangle_colours(mesh: SurfaceMesh) -> NDArray[np.int16] | None:
    """(m, 3) from 0 to 255, -1 where there is none; None when nothing has a colour."""
    if not any(mesh.groups.face_colours) and not any(mesh.groups.solid_colours):
        return None
    solids = np.full(len(mesh.face_ids), -1)
    if mesh.solid_ids is not None:
        solids = np.where(mesh.solid_ids[:, 0] >= 0, mesh.solid_ids[:, 0], mesh.solid_ids[:, 1])
    pairs, which = np.unique(np.column_stack((mesh.face_ids, solids)), axis=0, return_inverse=True)
    table = np.full((len(pairs), 3), -1, np.int16)
    for row, (face, solid) in enumerate(pairs.tolist()):
        colour = colour_of(mesh, face, solid)
        if colour is not None:
            table[row] = as_bytes(colour)
    return table[which.reshape(-1)]


def as_bytes(colour: Colour) -> tuple[int, int, int]:
    """0..1 -> 0..255."""
    red, green, blue = (round(255 * min(max(channel, 0.0), 1.0)) for channel in colour)
    return red, green, blue


def hexadecimal(colour: Colour) -> str:
    """#RRGGBB."""
    return "#{:02X}{:02X}{:02X}".format(*as_bytes(colour))


def linear(channel: float) -> float:
    """sRGB -> linear light, as glTF wants it. Source: IEC 61966-2-1."""
    return channel / 12.92 if channel <= 0.04045 else ((channel + 0.055) / 1.055) ** 2.4


def gamma(channel: float) -> float:
    """Linear light -> sRGB, the inverse of ``linear``."""
    return channel * 12.92 if channel <= 0.0031308 else 1.055 * channel ** (1 / 2.4) - 0.055
