#include <nanobind/stl/tuple.h>
#include <tuple>

#include "binding/arrays.hpp"
#include "patch/seam_identification.hpp"

namespace surfmesh::binding {
namespace {

using Numbers = Vector<std::int32_t>;

SurfaceTriangles identified(const Numbers& tri, const Numbers& adj,
                            const Vector<std::uint8_t>& region, std::int32_t vertices,
                            const Numbers& node, const Matrix<std::int32_t, 2>& segments,
                            const Vector<std::int64_t>& identity) {
    const std::size_t half_edges = 3 * region.shape(0);
    require_rows(tri.shape(0), half_edges, "tri");
    require_rows(adj.shape(0), half_edges, "adj");
    if (vertices < 0) throw nb::value_error("vertices is negative");
    const auto count = static_cast<std::size_t>(vertices);
    require_indices(rows<Vertex>(tri), count, "tri");
    require_rows(identity.shape(0), node.shape(0), "identity");
    require_indices(rows<std::int64_t>(identity), node.shape(0), "identity");
    require_indices(std::span<const std::int32_t>(segments.data(), segments.size()), node.shape(0),
                    "segments");
    for (const Vertex v : rows<Vertex>(node))
        if (v != NIL && (v < 0 || static_cast<std::size_t>(v) >= count))
            throw nb::value_error("node has a vertex that is out of range");
    const nb::gil_scoped_release released;
    return identify_seams(
        {rows<Vertex>(tri), rows<HalfEdge>(adj), rows<Region>(region), vertices},
        {rows<Vertex>(node), rows<Segment>(segments), rows<std::int64_t>(identity)});
}

}  // namespace

void bind_seams(nb::module_& m) {
    m.def(
        "identify_seams",
        [](const Numbers& tri, const Numbers& adj, const Vector<std::uint8_t>& region,
           std::int32_t vertices, const Numbers& node, const Matrix<std::int32_t, 2>& segments,
           const Vector<std::int64_t>& identity) {
            const SurfaceTriangles found =
                identified(tri, adj, region, vertices, node, segments, identity);
            return std::tuple(view(found.triangles), view(found.corners), view(found.vertex),
                              view(found.non_manifold));
        },
        nb::arg("tri"), nb::arg("adj"), nb::arg("region"), nb::arg("vertices"), nb::arg("node"),
        nb::arg("segments"), nb::arg("identity"),
        "The triangles in space of a domain, whose boundary nodes may be one point there.\n\n"
        "tri, adj (3 m,), region (m,), vertices: of the domain's triangulation. node (k,) int32: "
        "the vertex of each\nnode of the boundary, or NIL. segments (s, 2) int32: pairs of nodes. "
        "identity (k,) int64: the first node\nthat is the same point. Returns triangles (3 t,) "
        "int32 of points, their corners (3 t,) int32 in the domain,\nthe vertex (n,) of each "
        "point, "
        "and the points (j,) where there is no surface.");
}

}  // namespace surfmesh::binding
