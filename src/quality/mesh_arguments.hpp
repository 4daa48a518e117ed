// A mesh on its surfaces as a caller hands it over: shapes and numbers are looked at, nothing is
// copied.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "binding/arrays.hpp"
#include "quality/measured_mesh.hpp"
#include "space/edge_table.hpp"
#include "space/measure.hpp"
#include "surfaces/callback_surface.hpp"

namespace surfmesh::binding {

template <>
struct Row<Weights> : RowOf<double, 3> {};

using Triangles = Matrix<std::int32_t, 3>;
using Numbers = Vector<std::int32_t>;

inline std::vector<const Surface*> surfaces_of(const nb::list& given) {
    std::vector<const Surface*> surfaces;
    surfaces.reserve(given.size());
    for (const nb::handle surface : given) surfaces.push_back(&nb::cast<const Surface&>(surface));
    return surfaces;
}

inline MeasuredMesh measured_mesh(const std::vector<const Surface*>& surfaces,
                                  const Points3& points, const Triangles& triangles,
                                  const Points2& uv, const Triangles& uv_triangles,
                                  const Numbers& faces) {
    require_rows(uv_triangles.shape(0), triangles.shape(0), "uv_triangles");
    require_rows(faces.shape(0), triangles.shape(0), "faces");
    return {surfaces,
            rows<Point3>(points),
            rows<TriangleCorners>(triangles),
            rows<Point2>(uv),
            rows<TriangleCorners>(uv_triangles),
            rows<std::int32_t>(faces)};
}

/// All numbers in a mesh are in range.
inline void require_mesh(const MeasuredMesh& mesh) {
    const auto numbers = [](std::span<const TriangleCorners> rows) {
        return std::span(reinterpret_cast<const Vertex*>(rows.data()), 3 * rows.size());
    };
    require_indices(numbers(mesh.triangles), mesh.points.size(), "triangles");
    require_indices(numbers(mesh.uv_triangles), mesh.uv.size(), "uv_triangles");
    require_indices(mesh.faces, mesh.surfaces.size(), "faces");
}

/// Refuse pairs (k, 2) that are not half-edges of so many triangles; NIL may stand in the second
/// column. Several are looked at at once, by signs.
inline void require_half_edges(const Matrix<std::int32_t, 2>& pairs, std::size_t triangles,
                               const char* what) {
    constexpr auto LARGEST = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
    if (triangles == 0 && pairs.size() > 0) throw nb::value_error(what);
    const auto last = static_cast<std::uint32_t>(std::min(3 * triangles - 1, LARGEST));
    const std::span numbers(pairs.data(), pairs.size());
    std::uint32_t signs = 0;
    for (const std::int32_t number : numbers) {
        const auto e = static_cast<std::uint32_t>(number);
        signs |= (e + 1) | (last - e);
    }
    for (std::size_t k = 0; k < numbers.size(); k += 2)
        signs |= static_cast<std::uint32_t>(numbers[k]);
    if (static_cast<std::int32_t>(signs) < 0) throw nb::value_error(what);
}

/// Both sides of edges (k, 2) of so many triangles, in range.
inline std::span<const EdgeSides> sides_of(const Matrix<std::int32_t, 2>& edges,
                                           std::size_t triangles) {
    const std::span<const EdgeSides> sides{reinterpret_cast<const EdgeSides*>(edges.data()),
                                           edges.shape(0)};
    require_half_edges(edges, triangles, "edges has a half-edge that is out of range");
    return sides;
}

/// Half-edges of so many triangles, in range; NIL may stand in the second column.
inline std::span<const EdgeTable::Sides> half_edge_pairs(const Matrix<std::int32_t, 2>& half_edges,
                                                         std::size_t triangles) {
    const std::span<const EdgeTable::Sides> sides{
        reinterpret_cast<const EdgeTable::Sides*>(half_edges.data()), half_edges.shape(0)};
    require_half_edges(half_edges, triangles, "half_edges has an index that is out of range");
    return sides;
}

}  // namespace surfmesh::binding
