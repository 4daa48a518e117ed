// The coedges of a model as numpy has them.
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "binding/arrays.hpp"
#include "binding/released.hpp"
#include "faces/coedge_table.hpp"

namespace surfmesh::binding {

void bind_coedges(nb::module_& m);

namespace {

using Indices64 = Vector<std::int64_t>;
using Reals = Vector<double>;

/// Offsets that rise from 0 to ``last``.
void require_rising(const Indices64& offsets, std::size_t last, const char* what) {
    const auto values = rows<std::int64_t>(offsets);
    if (values.empty() || values.front() != 0 || values.back() != static_cast<std::int64_t>(last) ||
        !std::is_sorted(values.begin(), values.end()))
        throw nb::value_error((std::string(what) + " has no offsets of its rows").c_str());
}

void make_table(CoedgeTable* made, const CurvePieces& pcurves, const Indices64& edge,
                const Vector<std::uint8_t>& is_reversed, const Indices64& first_of_loop,
                const Indices64& first_loop_of_face, const Reals& tolerance, const Indices64& start,
                const Points3& corners) {
    const std::size_t count = pcurves.size();
    for (const auto& curve : pcurves.curves)
        if (!curve) throw nb::value_error("a coedge has no p-curve");
    require_rows(edge.shape(0), count, "edge");
    require_rows(is_reversed.shape(0), count, "is_reversed");
    require_rising(first_of_loop, count, "first_of_loop");
    require_rising(first_loop_of_face, first_of_loop.shape(0) - 1, "first_loop_of_face");
    require_rows(tolerance.shape(0), start.shape(0), "tolerance");
    require_indices(rows<std::int64_t>(edge), start.shape(0), "edge");
    require_indices(rows<std::int64_t>(start), corners.shape(0), "start");
    const auto first = rows<std::int64_t>(first_of_loop);
    if (std::adjacent_find(first.begin(), first.end()) != first.end())
        throw nb::value_error("a loop has no coedge");
    new (made) CoedgeTable{pcurves,
                           Array<std::int64_t>(rows<std::int64_t>(edge)),
                           Array<std::uint8_t>(rows<std::uint8_t>(is_reversed)),
                           Array<std::int64_t>(first),
                           Array<std::int64_t>(rows<std::int64_t>(first_loop_of_face)),
                           Array<double>(rows<double>(tolerance)),
                           Array<std::int64_t>(rows<std::int64_t>(start)),
                           Array<Point3>(rows<Point3>(corners))};
}

std::vector<FaceBoundary> boundaries(const CoedgeTable& table, const Indices64& faces,
                                     const Indices64& first, const Reals& t, const Points3& points,
                                     const Indices64& numbers, const Reals& sizes) {
    require_indices(rows<std::int64_t>(faces), table.faces(), "faces");
    require_rows(first.shape(0), table.edges() + 1, "first");
    require_rising(first, t.shape(0), "first");
    require_rows(points.shape(0), t.shape(0), "points");
    require_rows(numbers.shape(0), t.shape(0), "numbers");
    require_rows(sizes.shape(0), t.shape(0), "sizes");
    for (std::size_t edge = 0; edge < table.edges(); ++edge)
        if (first(edge + 1) == first(edge) + 1)
            throw nb::value_error("an edge has two nodes at least");
    auto found = released([&] {
        return boundaries_of(
            table, rows<std::int64_t>(faces),
            {rows<std::int64_t>(first), rows<double>(t), rows<std::int64_t>(numbers),
             rows<Point3>(points), rows<double>(sizes)});
    });
    for (const FaceBoundary& boundary : found)
        for (const Point2 uv : boundary.uv)
            if (!std::isfinite(uv.x + uv.y)) throw nb::value_error("a p-curve has no place");
    return found;
}

}  // namespace

void bind_coedges(nb::module_& m) {
    nb::class_<CoedgeTable>(m, "CoedgeTable", "The coedges of all faces of a model.")
        .def("__init__", &make_table, nb::arg("pcurves"), nb::arg("edge"), nb::arg("is_reversed"),
             nb::arg("first_of_loop"), nb::arg("first_loop_of_face"), nb::arg("tolerance"),
             nb::arg("start"), nb::arg("corners"),
             "edge, is_reversed (c,): of the coedges, loop after loop, face after face. "
             "first_of_loop (l + 1,): coedges of the loops; first_loop_of_face (f + 1,): loops of "
             "the faces. tolerance, start (e,): of the edges, the vertex of the mesh that they "
             "start at; corners (v, 3): points of these.")
        .def("boundaries", &boundaries, nb::arg("faces"), nb::arg("first"), nb::arg("t"),
             nb::arg("points"), nb::arg("numbers"), nb::arg("sizes"),
             "Of some faces (f,), when their edges have these nodes.\n\nfirst (e + 1,): rows of "
             "the edges, none of one that is a point in space. t, points (n, 3), numbers, sizes: "
             "normalised parameters, places, numbers in the mesh and wanted lengths.");
}

}  // namespace surfmesh::binding
