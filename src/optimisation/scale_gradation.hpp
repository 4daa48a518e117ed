// Gradation of sizes that the optimiser has lowered below those of the size field.
//
// In: vertices, some with a scale below one, as triangles there were too far from the surface or
// bent too much. Out: around these, or around all, sizes are lowered until along no edge they grow
// faster than `slope` per length; the vertices are marked active. Compared are sizes in the
// direction of the edge. What a scale lowers is the whole metric.
#pragma once

#include <span>

#include "optimisation/stars.hpp"
#include "optimisation/surface_frames.hpp"
#include "optimisation/vertex_marks.hpp"
#include "triangulation/triangulation.hpp"

namespace surfmesh {

/// Returns how many vertices were lowered. around_all: else around those with a scale below one.
int grade_scales(const Triangulation& t, SurfaceFrames& s, const Stars& stars, VertexMarks& marks,
                 double slope, bool around_all);

/// Give ``vertices``, which do not move, back the sizes of the size field, as far as sizes grow to
/// them along no edge faster than ``slope`` per length; none becomes smaller. Sizes around them that
/// were lowered rise with them, but not above those of the size field. For sizes that are the same
/// all ways.
void restore_scales(const Triangulation& t, SurfaceFrames& s, const Stars& stars,
                    std::span<const Vertex> vertices, double slope);

}  // namespace surfmesh
