// Algebra of size tensors H, metric lengths and shapes in the plane; see values/conventions.hpp.
#pragma once

#include <cmath>

#include "values/array.hpp"
#include "values/conventions.hpp"
#include "values/size_tensor.hpp"

namespace surfmesh {

/// Metric length of a step between points with tensors p and q.
inline double metric_length(Point2 step, SizeTensor p, SizeTensor q) {
    const SizeTensor h = 0.5 * (p + q);
    return norm(solve(h, step));
}

/// Metric length of the edge between vertices p and q.
inline double edge_length(const Array<Point2>& xy, const Array<SizeTensor>& size, Vertex p,
                          Vertex q) {
    return metric_length(xy[q] - xy[p], size[p], size[q]);
}

/// alpha = 4 sqrt(3) area / sum of squared edges, of a triangle with edge vectors u, v.
inline double shape(Point2 u, Point2 v) {
    const Point2 w = u - v;
    const double total = u.x * u.x + u.y * u.y + v.x * v.x + v.y * v.y + w.x * w.x + w.y * w.y;
    if (total == 0.0) return 0.0;
    return 3.4641016151377544 * (u.x * v.y - u.y * v.x) / total;
}

/// alpha of abc in the mean metric of its corners.
inline double triangle_shape(const Array<Point2>& xy, const Array<SizeTensor>& size, Vertex a,
                             Vertex b, Vertex c) {
    const SizeTensor h = size[a] + size[b] + size[c];
    return shape(solve(h, xy[b] - xy[a]), solve(h, xy[c] - xy[a]));
}

}  // namespace surfmesh
