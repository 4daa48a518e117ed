// Triangles by what is wrong with them, or by the marks of their corners.
#pragma once

#include <span>

#include "optimisation/stars.hpp"
#include "optimisation/surface_frames.hpp"
#include "optimisation/vertex_marks.hpp"

namespace surfmesh {

/// For each triangle whether it is turned against the surface at one of its corners.
///
/// ``least``: cosine of the largest angle allowed between the normals; ``at_apex``: the same
/// for a triangle that ends at a pole or an apex, where the surface has no normal: around the
/// apex of a cone it turns by as much as a right angle at any size.
Array<std::uint8_t> find_folded(const Triangulation& t, const SurfaceFrames& s, double least,
                                double at_apex);

/// The triangles with a corner that is marked in ``vertices``, in their order.
///
/// stars: of all vertices, by which those at a few are found; null where they are stale.
Array<Triangle> triangles_at(const Triangulation& t, const Stars* stars,
                             const Array<std::uint8_t>& vertices);

/// The triangles with alpha below ``least``, in their order.
Array<Triangle> triangles_below(const Triangulation& t, const SurfaceFrames& s, double least);

/// The same by ``shape``, alpha of the triangles as swaps have last seen it.
Array<Triangle> triangles_below(const Triangulation& t, const Array<double>& shape, double least);

/// Make the corners of triangles with alpha below ``least`` active; returns how many there are.
///
/// shape: alpha of the triangles that are not dirty, as swaps have seen it; or empty.
int activate_bad(const Triangulation& t, const SurfaceFrames& s, std::span<const double> shape,
                 VertexMarks& marks, double least);

}  // namespace surfmesh
