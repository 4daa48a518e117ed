#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>

#include <cstdint>
#include <optional>
#include <tuple>

#include "binding/released.hpp"
#include "quality/angles_within_faces.hpp"
#include "quality/edge_figures.hpp"
#include "quality/enclosed_volumes.hpp"
#include "quality/explained_losses.hpp"
#include "quality/face_figures.hpp"
#include "quality/joined_triangles.hpp"
#include "quality/mesh_arguments.hpp"
#include "quality/rim_losses.hpp"
#include "quality/surface_topology.hpp"

namespace surfmesh::binding {

void bind_joined_triangles(nb::module_& m);

namespace {

using VertexPairs = Matrix<std::int32_t, 2>;
using Uses = Vector<std::int32_t>;
using Figures = Vector<double>;
using Roots = Matrix<double, 6>;

std::span<const std::int32_t> numbers_in(const Triangles& rows_of_three) {
    return {rows_of_three.data(), rows_of_three.size()};
}

/// With the arrays that they are of, looked at once.
class HeldTriangles {
  public:
    HeldTriangles(const Points3& points, const Triangles& triangles, const Numbers& faces,
                  std::size_t faces_in_all, const VertexPairs& edges, const VertexPairs& half_edges,
                  const Uses& uses)
        : points_(points),
          triangles_(triangles),
          faces_(faces),
          edges_(edges),
          half_edges_(half_edges),
          uses_(uses),
          mesh_{rows<Point3>(points_),
                rows<TriangleCorners>(triangles_),
                rows<std::int32_t>(faces_),
                faces_in_all,
                {reinterpret_cast<const EdgeTable::Ends*>(edges_.data()), edges_.shape(0)},
                half_edge_pairs(half_edges_, triangles.shape(0)),
                rows<std::int32_t>(uses_)} {
        require_indices(numbers_in(triangles), points.shape(0), "triangles");
        require_indices(std::span(edges.data(), edges.size()), points.shape(0), "edges");
        require_rows(faces.shape(0), triangles.shape(0), "faces");
        require_indices(rows<std::int32_t>(faces), faces_in_all, "faces");
        require_rows(half_edges.shape(0), edges.shape(0), "half_edges");
        require_rows(uses.shape(0), edges.shape(0), "uses");
    }

    [[nodiscard]] const JoinedTriangles& mesh() const { return mesh_; }

  private:
    Points3 points_;
    Triangles triangles_;
    Numbers faces_;
    VertexPairs edges_, half_edges_;
    Uses uses_;
    JoinedTriangles mesh_;  // of the arrays above
};

/// An array that may be missing as a span that may be empty.
template <class T, class Given>
std::span<const T> rows_if_any(const std::optional<Given>& array) {
    return array ? rows<T>(*array) : std::span<const T>();
}

EdgeFigures edge_figures_of(const HeldTriangles& held, const std::optional<Figures>& sizes,
                            const std::optional<Roots>& roots,
                            const std::optional<Triangles>& root_triangles, double slope,
                            double most) {
    if (sizes) require_rows(sizes->shape(0), held.mesh().points.size(), "sizes");
    if (roots) {
        if (!root_triangles) throw nb::value_error("root_triangles are missing");
        require_rows(root_triangles->shape(0), held.mesh().triangles.size(), "root_triangles");
        require_indices(numbers_in(*root_triangles), roots->shape(0), "root_triangles");
    }
    const TargetSizes targets{rows_if_any<double>(sizes), rows_if_any<MetricRoot3>(roots),
                              rows_if_any<TriangleCorners>(root_triangles)};
    return released([&] { return edge_figures(held.mesh(), targets, {slope, most}); });
}

auto angles_of(const HeldTriangles& held, const Figures& limits) {
    require_rows(limits.shape(0), held.mesh().faces_in_all, "limits");
    const auto found =
        released([&] { return angles_within_faces(held.mesh(), rows<double>(limits)); });
    return std::tuple(view(found.edges), view(found.degrees), view(found.largest),
                      view(found.number), found.largest_edge);
}

auto explained_areas_of(const HeldTriangles& held, const Figures& area, const Figures& distance,
                        const std::optional<Figures>& bend, double slant) {
    const std::size_t count = held.mesh().triangles.size();
    require_rows(area.shape(0), count, "area");
    require_rows(distance.shape(0), count, "distance");
    if (bend) require_rows(bend->shape(0), count, "bend");
    const LossFigures figures{rows<double>(area), rows<double>(distance),
                              rows_if_any<double>(bend)};
    return view(released([&] { return explained_areas(held.mesh(), figures, slant); }));
}

auto rim_losses_of(const HeldTriangles& held, const Vector<std::int64_t>& edge,
                   const Figures& sagitta, const Figures& distance, double sharpest) {
    require_rows(sagitta.shape(0), edge.shape(0), "sagitta");
    require_rows(distance.shape(0), held.mesh().triangles.size(), "distance");
    const std::span<const std::int64_t> given = rows<std::int64_t>(edge);
    for (const std::int64_t row : given)
        if (row < NIL || row >= static_cast<std::int64_t>(held.mesh().edges.size()))
            throw nb::value_error("edge has a row that is out of range");
    const auto lost = released([&] {
        return rim_losses(held.mesh(), {given, rows<double>(sagitta)}, rows<double>(distance),
                          sharpest);
    });
    return std::pair(view(lost.of_edges), view(lost.of_faces));
}

auto topology_of(const HeldTriangles& held, const VertexPairs& chains) {
    const auto joined = half_edge_pairs(chains, held.mesh().triangles.size());
    const auto found = released([&] { return surface_topology(held.mesh(), joined); });
    return std::tuple(found.vertices, found.components, found.boundary_edges, view(found.fans),
                      view(found.pinched), view(found.crowded), view(found.clashing));
}

auto solid_figures_of(const HeldTriangles& held, const VertexPairs& solids, const Figures& area,
                      const std::optional<Figures>& bulge, std::size_t count) {
    const JoinedTriangles& mesh = held.mesh();
    require_rows(solids.shape(0), mesh.triangles.size(), "solids");
    require_rows(area.shape(0), mesh.triangles.size(), "area");
    if (bulge) require_rows(bulge->shape(0), mesh.triangles.size(), "bulge");
    for (const std::int32_t solid : std::span(solids.data(), solids.size()))
        if (solid >= static_cast<std::int64_t>(count))
            throw nb::value_error("solids has an index that is out of range");
    const std::span<const SolidsBeside> beside{reinterpret_cast<const SolidsBeside*>(solids.data()),
                                               solids.shape(0)};
    const SolidParts parts{rows<double>(area), rows_if_any<double>(bulge)};
    const auto found =
        released([&] { return solid_figures(mesh.points, mesh.triangles, beside, parts, count); });
    return std::tuple(view(found.triangles), view(found.area), view(found.volume), found.behind,
                      found.before, found.both);
}

auto face_shapes_of(const HeldTriangles& held, const Figures& area, const Figures& alpha) {
    require_rows(area.shape(0), held.mesh().triangles.size(), "area");
    require_rows(alpha.shape(0), held.mesh().triangles.size(), "alpha");
    const auto found =
        released([&] { return face_shapes(held.mesh(), rows<double>(area), rows<double>(alpha)); });
    return std::tuple(view(found.triangles), view(found.area), view(found.alpha_sum),
                      view(found.alpha_min));
}

auto face_distances_of(const HeldTriangles& held, const Figures& distance,
                       const Figures& mean_square, const Figures& area,
                       const Vector<std::uint8_t>& marked) {
    for (const std::size_t found :
         {distance.shape(0), mean_square.shape(0), area.shape(0), marked.shape(0)})
        require_rows(found, held.mesh().triangles.size(), "a figure of the triangles");
    const auto found = released([&] {
        return face_distances(held.mesh(), {rows<double>(distance), rows<double>(mean_square),
                                            rows<double>(area), rows<std::uint8_t>(marked)});
    });
    return std::tuple(view(found.largest), view(found.worst), view(found.square),
                      view(found.marked));
}

std::tuple<double, double, double, double> four_of(const Spread& spread) {
    return {spread.least, spread.mean, spread.largest, spread.deviation};
}

void bind_edge_figures(nb::module_& m) {
    nb::class_<EdgeFigures> c(m, "EdgeFigures", "Lengths of the edges (ne,) of a mesh.");
    bind_array(c, "lengths", &EdgeFigures::lengths, "(ne,) model units");
    bind_array(c, "metric_lengths", &EdgeFigures::metric_lengths,
               "(ne,) in target sizes; (0,) without these");
    c.def_prop_ro(
         "length", [](const EdgeFigures& found) { return four_of(found.length); },
         "Least, mean, largest and standard deviation of ``lengths``, NaN where one is, or none.")
        .def_prop_ro(
            "metric_length", [](const EdgeFigures& found) { return four_of(found.metric_length); },
            "The same of ``metric_lengths``.")
        .def_prop_ro(
            "ratios",
            [](const EdgeFigures& found) {
                return std::pair(found.ratios.largest, found.ratios.p99);
            },
            "Longest over shortest edge at a vertex: the largest, and what 99 of 100 are below; in "
            "target sizes where these depend on the direction. NaN without edges of a length.")
        .def_prop_ro(
            "changes",
            [](const EdgeFigures& found) {
                return std::tuple(found.changes.steepest, found.changes.largest,
                                  found.changes.above);
            },
            "The first edge, -1 for none, along which the difference of sizes is largest over "
            "slope times length, that quotient, and how many quotients are above ``most``.");
    bind_array(c, "face_lengths", &EdgeFigures::face_lengths,
               "(f,) mean of the lengths of the edges of each face, 0 without any; an edge between "
               "two faces counts for both");
    bind_array(c, "face_sizes", &EdgeFigures::face_sizes, "(f,) likewise of their target sizes");
}

}  // namespace

void bind_joined_triangles(nb::module_& m) {
    bind_edge_figures(m);
    nb::class_<HeldTriangles>(
        m, "JoinedTriangles",
        "Triangles (m, 3) of points (n, 3) on ``faces_in_all`` faces (m,), with their edge table: "
        "edges (ne, 2), half_edges (ne, 2), uses (ne,). Kept, not copied, and looked at once.")
        .def(nb::init<const Points3&, const Triangles&, const Numbers&, std::size_t,
                      const VertexPairs&, const VertexPairs&, const Uses&>(),
             nb::arg("points"), nb::arg("triangles"), nb::arg("faces"), nb::arg("faces_in_all"),
             nb::arg("edges"), nb::arg("half_edges"), nb::arg("uses"))
        .def(
            "topology", &topology_of, nb::arg("chains"),
            "How many vertices are used, components, and edges of one triangle; fans (n,) of "
            "triangles at each vertex, as shared edges join them; vertices (k,) of two fans or "
            "more, edges (k,) of three triangles or more, edges (k,) that both triangles run along "
            "the same way.\n\nchains (k, 2): half-edges of edges of three triangles or more that "
            "are joined.")
        .def("edge_figures", &edge_figures_of, nb::arg("sizes").none(), nb::arg("roots").none(),
             nb::arg("root_triangles").none(), nb::arg("slope"), nb::arg("most"),
             "By target sizes (n,), or where these depend on the direction roots (k, 6) of metrics "
             "at the corners root_triangles (m, 3); slope: what they may differ by along an edge, "
             "over its length, 0: not asked.")
        .def("angles_within_faces", &angles_of, nb::arg("limits"),
             "Of the edges between two triangles of one face those (k,) whose angle is beyond the "
             "limit (f,) of that face, degrees, and the angle (k,); of the others the largest (f,) "
             "in each face, 0 without any; how many (f,) there are in all; the first edge where "
             "the largest of the others is, -1 for none.")
        .def("face_shapes", &face_shapes_of, nb::arg("area"), nb::arg("alpha"),
             "Of each face the triangles, the area, the sum of alpha and the least alpha, (f,) "
             "each, "
             "infinite without a triangle; by triangles of area (m,), alpha (m,).")
        .def("face_distances", &face_distances_of, nb::arg("distance"), nb::arg("mean_square"),
             nb::arg("area"), nb::arg("marked"),
             "Of each face the largest distance, the first triangle where it is, the sum of mean "
             "square times area, and how many triangles are marked, not 0, (f,) each; by triangles "
             "(m,) all.")
        .def("solid_figures", &solid_figures_of, nb::arg("solids"), nb::arg("area"),
             nb::arg("bulge").none(), nb::arg("count"),
             "Triangles, area and enclosed volume of so many solids, (count,) each, and how many "
             "triangles have a solid behind them, before them, and both; solids (m, 2): behind and "
             "before each triangle, below 0 for none; bulge (m,): volume between each triangle, if "
             "it is curved, and its straight one.")
        .def("explained_areas", &explained_areas_of, nb::arg("area"), nb::arg("distance"),
             nb::arg("bend").none(), nb::arg("slant"),
             "Area (f,) that faces lose or win by the distance (m,) of their triangles, of an area "
             "(m,), from the surface.\n\nslant: of (distance / height)^2, what the area may differ "
             "by; bend (m,): twice the curvature of the sides of quadratic triangles.")
        .def("rim_losses", &rim_losses_of, nb::arg("edge"), nb::arg("sagitta"), nb::arg("distance"),
             nb::arg("sharpest"),
             "Area that rims lose: of edges (ne,), 0 where one is none, and of faces (f,), of "
             "edges of one or two triangles. It is length times the larger of sagitta and the "
             "distance (m,) of their triangles over the sine between these, not below "
             "``sharpest``, at most the length.\n\nRims are edges of one triangle, and the rows "
             "edge (k,) with sagitta (k,), -1 for none.");
}

}  // namespace surfmesh::binding
