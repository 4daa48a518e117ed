// Vertices that make bad triangles go, where what they leave is filled with better ones.
//
//     o-----------o              o-----------o
//    / \         / \            / \         / \      between a row along the boundary
//   /   \       /   \          /   \       /   \     and the next there is one vertex
//  /     \     /     \   ->   /     \     /     \    too many
// o-------o---o       o      o       \   /       o
//  `--.     v     .--'        `--.    \ /    .--'
// ------o-----o-----o--      ------o---o---o------
//
// In: a domain with its frames and stars. Moves and swaps keep the number of vertices; where a
// boundary leaves room for one less, its triangles stay flat whatever they do. Out: the domain with
// two triangles less for each vertex that went; fixed edges and the border stay, every triangle is
// positive, exactly. Triangles are measured in space.
#pragma once

#include "optimisation/stars.hpp"
#include "optimisation/surface_frames.hpp"
#include "optimisation/vertex_marks.hpp"

namespace surfmesh {

/// A star with a triangle of less alpha lies at a fold: what its shapes are like means nothing.
inline constexpr double FOLDED = 0.2;

/// What the triangles may be like that fill the star of a vertex.
struct FillingLimits {
    double longest;   // edge, metric length
    double farthest;  // distance from the surface by the estimate, model units
};

/// Remove free corners of triangles below the alpha ``least`` where that raises the smallest alpha
/// of their stars. ``shape``: alpha of the triangles.
///
/// Returns how many were removed; stars must be found anew afterwards. Vertices around those that
/// go become active and dirty.
int remove_worst(Triangulation& t, const SurfaceFrames& s, Stars& stars, VertexMarks& marks,
                 const Array<double>& shape, double least, const FillingLimits& limits);

/// The same where they touch a straight border and the degrees of the vertices around, those on the
/// border above all, get nearer to regular: three there, six inside. What is in their place is to
/// be smoothed; moves of the border's neighbours alone do not get there.
///
///     --a---b---c--        the border: a and c have 4 triangles, b has 2; v has 6
///       |\  |  /|
///       | \ v / |          without v all three have 3
///       p--...--q
int remove_at_border(Triangulation& t, const SurfaceFrames& s, Stars& stars, VertexMarks& marks,
                     const Array<double>& shape, double bad, const FillingLimits& limits);

/// Remove free vertices from number ``first`` on with a triangle below ``least``: on the surface they
/// are not where they seemed to be. Returns how many; stars must be found anew afterwards.
int remove_bad_stars(Triangulation& t, const SurfaceFrames& s, Stars& stars, VertexMarks& marks,
                     Vertex first, double least);

}  // namespace surfmesh
