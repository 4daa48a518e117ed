// Segments of CAD edges as a caller hands them over: shapes and nodes are looked at, nothing is
// copied.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "quality/mesh_arguments.hpp"
#include "quality/segment_samples.hpp"

namespace surfmesh::binding {

/// Curves by edge; None for an edge without one.
inline std::vector<const Curve*> curves_of(const nb::list& given) {
    std::vector<const Curve*> curves;
    curves.reserve(given.size());
    for (const nb::handle curve : given)
        curves.push_back(curve.is_none() ? nullptr : &nb::cast<const Curve&>(curve));
    return curves;
}

template <class Row, class Given>
std::span<const Row> rows_of(const Given& given) {
    return {reinterpret_cast<const Row*>(given.data()), given.shape(0)};
}

/// Numbers of edges are left to the caller.
inline EdgeSegments edge_segments(const std::vector<const Curve*>& curves,
                                  const Matrix<double, 2>& limits, const Numbers& edges,
                                  const Matrix<double, 2>& ends,
                                  const Matrix<std::int32_t, 2>& segments, const Points3& points) {
    require_rows(limits.shape(0), curves.size(), "limits");
    require_rows(ends.shape(0), edges.shape(0), "ends");
    require_rows(segments.shape(0), edges.shape(0), "segments");
    require_indices(std::span(segments.data(), segments.size()), points.shape(0), "segments");
    return {curves,
            rows_of<ParameterRange>(limits),
            rows<std::int32_t>(edges),
            rows_of<std::array<double, 2>>(ends),
            rows_of<std::array<Vertex, 2>>(segments),
            rows<Point3>(points)};
}

}  // namespace surfmesh::binding
