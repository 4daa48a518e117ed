#include <nanobind/stl/array.h>
#include <nanobind/stl/tuple.h>

#include <array>
#include <tuple>
#include <vector>

#include "quality/segment_arguments.hpp"
#include "quality/surface_search.hpp"

namespace surfmesh::binding {

void bind_surface_search(nb::module_& m);

namespace {

using Pairs = Matrix<std::int32_t, 2>;

/// The arguments of a search, which outlive it.
struct SearchArguments {
    nb::tuple surfaces;
    Points3 points;
    Triangles triangles;
    Points2 uv;
    Triangles uv_triangles;
    Numbers faces;
    Vector<double> deviation, chord;
    std::vector<const Surface*> all;

    [[nodiscard]] MeasuredMesh mesh() const {
        return measured_mesh(all, points, triangles, uv, uv_triangles, faces);
    }
};

/// What the caller's function says of a place; it takes the interpreter for it.
SurfaceSearch::IsOffFace asked(nb::callable is_off_face) {
    return [is_off_face = std::move(is_off_face)](Point2 uv, std::int32_t triangle) {
        const nb::gil_scoped_acquire held;
        return nb::cast<bool>(is_off_face(std::array{uv.x, uv.y}, triangle));
    };
}

class HeldSearch {
  public:
    HeldSearch(SearchArguments arguments, double largest, nb::callable is_off_face)
        : arguments_(std::move(arguments)),
          search_(arguments_.mesh(), {rows<double>(arguments_.deviation), largest},
                  rows<double>(arguments_.chord), asked(std::move(is_off_face))) {}

    [[nodiscard]] const SearchArguments& given() const { return arguments_; }
    [[nodiscard]] std::size_t triangles() const { return arguments_.triangles.shape(0); }
    SurfaceSearch& search() { return search_; }

    /// Call work(search) with the interpreter released.
    template <class Work>
    auto released(const Work& work) {
        const auto found = [&] {
            const nb::gil_scoped_release released;
            return work(search_);
        }();
        if (search_.failed() != NIL)
            raise_failure(*arguments_.all[search_.failed()], SurfaceStatus::FAILED);
        return found;
    }

  private:
    SearchArguments arguments_;
    SurfaceSearch search_;
};

HeldSearch held_search(const nb::list& surfaces, const Points3& points, const Triangles& triangles,
                       const Points2& uv, const Triangles& uv_triangles, const Numbers& faces,
                       const Vector<double>& deviation, double largest, const Vector<double>& chord,
                       const nb::callable& is_off_face) {
    SearchArguments given{nb::tuple(surfaces),  points, triangles, uv,
                          uv_triangles,         faces,  deviation, chord,
                          surfaces_of(surfaces)};
    require_mesh(given.mesh());
    require_rows(deviation.shape(0), triangles.shape(0), "deviation");
    if (triangles.shape(0) == 0) throw nb::value_error("there are no triangles");
    if (chord.shape(0) == 0) throw nb::value_error("chord is empty");
    return {std::move(given), largest, is_off_face};
}

/// The two sides beside each segment, by rows (k,) of half-edges (ne, 2); NIL where there is none.
Array<EdgeSides> sides_of_segments(const Vector<std::int64_t>& edge_rows, const Pairs& half_edges,
                                   std::size_t triangles) {
    const std::span<const EdgeSides> all = sides_of(half_edges, triangles);
    Array<EdgeSides> sides;
    sides.reserve(edge_rows.shape(0));
    for (const std::int64_t row : rows<std::int64_t>(edge_rows)) {
        if (row >= static_cast<std::int64_t>(all.size()))
            throw nb::value_error("edge_rows has an index that is out of range");
        sides.push_back(row < 0 ? EdgeSides{NIL, NIL} : all[static_cast<std::size_t>(row)]);
    }
    return sides;
}

std::size_t look_along_curves(HeldSearch& held, const nb::list& curves,
                              const Matrix<double, 2>& limits, const Numbers& edges,
                              const Matrix<double, 2>& ends, const Pairs& segments,
                              const Vector<std::int64_t>& edge_rows, const Pairs& half_edges,
                              const Vector<double>& fractions, double beside_middle,
                              double on_curve) {
    const std::vector<const Curve*> known = curves_of(curves);
    const EdgeSegments given =
        edge_segments(known, limits, edges, ends, segments, held.given().points);
    require_rows(edge_rows.shape(0), edges.shape(0), "edge_rows");
    const Array<EdgeSides> sides = sides_of_segments(edge_rows, half_edges, held.triangles());
    return held.released([&](SurfaceSearch& search) {
        return search.look_along_curves({given, {sides.data(), sides.size()}},
                                        rows<double>(fractions), beside_middle, on_curve);
    });
}

void look_over(HeldSearch& held, const Vector<std::uint8_t>& left_out,
               const Matrix<double, 3>& weights) {
    require_rows(left_out.shape(0), held.triangles(), "left_out");
    if (weights.shape(0) == 0) throw nb::value_error("weights is empty");
    held.released([&](SurfaceSearch& search) {
        search.look_over(rows<std::uint8_t>(left_out), rows<Weights>(weights));
        return true;
    });
}

void look_along_rims(HeldSearch& held, const Pairs& half_edges, const Vector<double>& fractions) {
    const std::span<const EdgeSides> sides = sides_of(half_edges, held.triangles());
    held.released([&](SurfaceSearch& search) {
        search.look_along_rims(sides, rows<double>(fractions));
        return true;
    });
}

void look_closely(HeldSearch& held, const Vector<std::uint8_t>& left_out,
                  const Matrix<double, 3>& weights, std::size_t count) {
    require_rows(left_out.shape(0), held.triangles(), "left_out");
    held.released([&](SurfaceSearch& search) {
        search.look_closely(rows<std::uint8_t>(left_out), rows<Weights>(weights), count);
        return true;
    });
}

auto farthest(HeldSearch& held) {
    const FarthestPoint found =
        held.released([](SurfaceSearch& search) { return search.farthest(); });
    const auto& [distance, p, q, triangle, at_rim] = found;
    return std::tuple(distance, std::array{p.x, p.y, p.z}, std::array{q.x, q.y}, triangle, at_rim);
}

}  // namespace

void bind_surface_search(nb::module_& m) {
    nb::class_<HeldSearch>(m, "SurfaceSearch",
                           "How far points of the surfaces lie from a mesh: the largest distance "
                           "over each triangle, and the farthest point.")
        .def(nb::new_(&held_search), nb::arg("surfaces"), nb::arg("points"), nb::arg("triangles"),
             nb::arg("uv"), nb::arg("uv_triangles"), nb::arg("faces"), nb::arg("deviation"),
             nb::arg("largest"), nb::arg("chord"), nb::arg("is_off_face"),
             "The mesh is as for ``mesh_deviation``. deviation (m,): of its triangles from the "
             "surfaces; largest: the largest one; chord (f,) of each face, or (1,) of all, up to "
             "which it does not matter which triangle is the nearest; is_off_face: does (u, v) "
             "over a triangle lie beyond an edge of its face?")
        .def("look_over", &look_over, nb::arg("left_out"), nb::arg("weights"),
             "Look at barycentric weights (w, 3) over the triangles of which left_out (m,) is 0.")
        .def("look_along_rims", &look_along_rims, nb::arg("half_edges"), nb::arg("fractions"),
             "Look along the edges of one triangle only, by half_edges (ne, 2) or -1, at fractions "
             "(j,) of their length.")
        .def("look_along_curves", &look_along_curves, nb::arg("curves"), nb::arg("limits"),
             nb::arg("edges"), nb::arg("ends"), nb::arg("segments"), nb::arg("edge_rows"),
             nb::arg("half_edges"), nb::arg("fractions"), nb::arg("beside_middle"),
             nb::arg("on_curve"),
             "Look at the curves of edges between the ends of their segments, first in the middle "
             "and where that does not settle it at all fractions (j,). Returns how many segments "
             "that are.\n\ncurves to segments: as for ``segment_samples``, but edges may be out of "
             "range: of these nothing is known. edge_rows (k,): rows of half_edges (ne, 2), -1 for "
             "no side of a triangle. The middle of an arc settles it where it is as far from the "
             "triangle as ``beside_middle`` of its height over the segment.")
        .def(
            "look_closely", &look_closely, nb::arg("left_out"), nb::arg("weights"),
            nb::arg("count"),
            "Look at weights (w, 3) over the ``count`` triangles that are farthest, one way or the "
            "other, but those of which left_out (m,) is not 0.")
        .def("farthest", &farthest,
             "The farthest point: its distance, place, (u, v), the triangle that it is over, and "
             "whether it was seen along a free rim.")
        .def(
            "largest_over_each",
            [](HeldSearch& held) { return view(held.search().largest_over_each()); },
            "Over each triangle (m,) the largest distance that was seen; 0 where the triangle "
            "itself is too far from the surface. Call it after ``farthest``.");
}

}  // namespace surfmesh::binding
