#include <nanobind/stl/tuple.h>

#include <tuple>

#include "binding/arrays.hpp"
#include "quality/face_figures.hpp"
#include "quality/histogram.hpp"
#include "quality/largest_values.hpp"
#include "quality/mesh_arguments.hpp"

namespace surfmesh::binding {

namespace {

using FaceNumbers = Vector<std::int32_t>;

void bind_face_triangles(nb::module_& m) {
    m.def(
        "face_shapes",
        [](const FaceNumbers& faces, const Vector<double>& area, const Vector<double>& alpha,
           std::size_t count) {
            require_indices(rows<std::int32_t>(faces), count, "faces");
            require_rows(area.shape(0), faces.shape(0), "area");
            require_rows(alpha.shape(0), faces.shape(0), "alpha");
            FaceShapes found;
            {
                const nb::gil_scoped_release released;
                found = face_shapes(rows<std::int32_t>(faces), rows<double>(area),
                                    rows<double>(alpha), count);
            }
            return std::tuple(view(found.triangles), view(found.area), view(found.alpha_sum),
                              view(found.alpha_min));
        },
        nb::arg("faces"), nb::arg("area"), nb::arg("alpha"), nb::arg("count"),
        "Of ``count`` faces the triangles, the area, the sum of alpha and the least alpha, "
        "(count,) "
        "each, infinite without a triangle; by triangles of faces (m,), area (m,), alpha (m,).");
    m.def(
        "face_distances",
        [](const FaceNumbers& faces, const Vector<double>& distance,
           const Vector<double>& mean_square, const Vector<double>& area,
           const Vector<std::uint8_t>& marked, std::size_t count) {
            require_indices(rows<std::int32_t>(faces), count, "faces");
            for (const std::size_t found :
                 {distance.shape(0), mean_square.shape(0), area.shape(0), marked.shape(0)})
                require_rows(found, faces.shape(0), "a figure of the triangles");
            FaceDistances found;
            {
                const nb::gil_scoped_release released;
                found = face_distances(rows<std::int32_t>(faces), rows<double>(distance),
                                       rows<double>(mean_square), rows<double>(area),
                                       rows<std::uint8_t>(marked), count);
            }
            return std::tuple(view(found.largest), view(found.worst), view(found.square),
                              view(found.marked));
        },
        nb::arg("faces"), nb::arg("distance"), nb::arg("mean_square"), nb::arg("area"),
        nb::arg("marked"), nb::arg("count"),
        "Of ``count`` faces the largest distance, the first triangle where it is, the sum of mean "
        "square times area, and how many triangles are marked, not 0, (count,) each; by triangles "
        "of faces (m,), all others (m,).");
    m.def(
        "face_angles",
        [](const FaceNumbers& faces, const Vector<double>& degrees, const Vector<double>& most,
           std::size_t count) {
            require_indices(rows<std::int32_t>(faces), count, "faces");
            require_rows(degrees.shape(0), faces.shape(0), "degrees");
            if (most.shape(0) != 1) require_rows(most.shape(0), count, "most");
            FaceAngles found;
            {
                const nb::gil_scoped_release released;
                found = face_angles(rows<std::int32_t>(faces), rows<double>(degrees),
                                    rows<double>(most), count);
            }
            return std::tuple(view(found.largest), view(found.above), view(found.number));
        },
        nb::arg("faces"), nb::arg("degrees"), nb::arg("most"), nb::arg("count"),
        "Of ``count`` faces the largest angle across an edge within, 0 without any, how many are "
        "above most (f,), or (1,) of all, and how many there are, (count,) each; by edges within "
        "faces (k,), degrees (k,).");
}

void bind_order(nb::module_& m) {
    m.def(
        "largest_values",
        [](const Vector<double>& values, std::size_t count) {
            Array<std::int32_t> found;
            {
                const nb::gil_scoped_release released;
                found = largest_values(rows<double>(values), count);
            }
            return view(found);
        },
        nb::arg("values"), nb::arg("count"),
        "Numbers of the ``count`` largest of values (n,), rising, or of all where there are no "
        "more; of equal ones those that come first. NaN is as large as infinity.");
    m.def(
        "quantile",
        [](const Vector<double>& values, double fraction) {
            if (values.shape(0) == 0) throw nb::value_error("values is empty");
            if (!(fraction >= 0.0 && fraction <= 1.0))
                throw nb::value_error("fraction is from 0 to 1");
            const nb::gil_scoped_release released;
            return quantile(rows<double>(values), fraction);
        },
        nb::arg("values"), nb::arg("fraction"),
        "As ``np.quantile`` has it, of values (n,), n > 0: linear between two of them in their "
        "order, NaN where one is.");
}

}  // namespace

void bind_figures(nb::module_& m) {
    bind_face_triangles(m);
    bind_order(m);
    m.def(
        "face_edge_means",
        [](const FaceNumbers& faces, const Matrix<std::int32_t, 2>& half_edges,
           const Vector<double>& values, std::size_t count) {
            require_indices(rows<std::int32_t>(faces), count, "faces");
            require_rows(values.shape(0), half_edges.shape(0), "values");
            const auto sides = half_edge_pairs(half_edges, faces.shape(0));
            Array<double> found;
            {
                const nb::gil_scoped_release released;
                found =
                    face_edge_means(rows<std::int32_t>(faces), sides, rows<double>(values), count);
            }
            return view(found);
        },
        nb::arg("faces"), nb::arg("half_edges"), nb::arg("values"), nb::arg("count"),
        "Mean (count,) of values (k,) over the edges of each face, 0 where there is none; "
        "half_edges (k, 2): the triangles beside them are of faces (m,), -1 in the second column "
        "for none. An edge between two faces counts for both.");
    m.def(
        "binned_counts",
        [](const Vector<double>& values, double low, double high, std::size_t bins) {
            if (!(low < high) || bins < 1) throw nb::value_error("there is no bin");
            Array<std::int64_t> counts;
            {
                const nb::gil_scoped_release released;
                counts = binned_counts(rows<double>(values), low, high, bins);
            }
            return view(counts);
        },
        nb::arg("values"), nb::arg("low"), nb::arg("high"), nb::arg("bins"),
        "How many of values (k,) lie in each of ``bins`` equal bins from low to high: others in "
        "those at the ends, what is not finite in none.");
}

}  // namespace surfmesh::binding
