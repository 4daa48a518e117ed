#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/tuple.h>

#include <array>
#include <memory>
#include <tuple>
#include <vector>

#include "binding/arrays.hpp"
#include "quality/dense_deviation.hpp"
#include "quality/enclosed_volumes.hpp"
#include "quality/face_creases.hpp"
#include "quality/far_corners.hpp"
#include "quality/hidden_bounds.hpp"
#include "quality/mesh_arguments.hpp"
#include "quality/mesh_deviation.hpp"
#include "quality/plane_triangles.hpp"
#include "quality/sampled_surface.hpp"
#include "quality/solid_counts.hpp"
#include "quality/surface_points.hpp"
#include "surfaces/callback_surface.hpp"
#include "surfaces/spline_polynomials.hpp"

namespace surfmesh::binding {

void bind_least_triangles(nb::module_& m);
void bind_segments(nb::module_& m);
void bind_stars(nb::module_& m);
void bind_surface_search(nb::module_& m);

template <>
struct Row<float> : RowOf<float, 1> {};

namespace {

void require_corners(const Triangles& triangles, std::size_t count, const char* what) {
    require_indices(std::span(triangles.data(), triangles.size()), count, what);
}

void bind_surface_points(nb::module_& m) {
    m.def(
        "surface_points",
        [](const nb::list& surfaces, const Numbers& faces, const Points2& uv, int order) {
            if (order < 0 || order > 1) throw nb::value_error("order is 0 or 1");
            const std::vector<const Surface*> all = surfaces_of(surfaces);
            require_indices(rows<std::int32_t>(faces), all.size(), "faces");
            require_rows(uv.shape(0), faces.shape(0), "uv");
            SurfacePoints found;
            {
                const nb::gil_scoped_release released;
                found = surface_points(all, rows<std::int32_t>(faces), rows<Point2>(uv), order);
            }
            if (found.failed >= 0) raise_failure(*all[found.failed], SurfaceStatus::FAILED);
            nb::list values;
            for (const Array<Point3>& array : found.values) values.append(view(array));
            return nb::tuple(values);
        },
        nb::arg("surfaces"), nb::arg("faces"), nb::arg("uv"), nb::arg("order"),
        "Points (n, 3) of the surfaces of faces (n,) at uv (n, 2); at order 1 r_u and r_v too.");
}

/// How many triangles each of so many faces has.
Array<std::size_t> triangles_of_faces(const Numbers& faces, std::size_t count) {
    require_indices(rows<std::int32_t>(faces), count, "faces");
    Array<std::size_t> found(count, 0);
    for (const std::int32_t face : rows<std::int32_t>(faces)) ++found[face];
    return found;
}

/// Surfaces as they are looked at in many places: splines as polynomials.
nb::list prepared_surfaces(const nb::list& surfaces, const Numbers& faces) {
    constexpr std::size_t LEAST_TRIANGLES = 4;  // on a polynomial: fewer are not worth it
    nb::list prepared;
    Array<std::size_t> triangles;
    for (const nb::handle given : surfaces) {
        const auto spline =
            std::dynamic_pointer_cast<SplineSurface>(nb::cast<std::shared_ptr<Surface>>(given));
        std::shared_ptr<Surface> made;
        if (spline != nullptr) {
            if (triangles.empty()) triangles = triangles_of_faces(faces, surfaces.size());
            const auto face = static_cast<std::ptrdiff_t>(prepared.size());
            made = SplinePolynomials::of(spline, triangles[face] / LEAST_TRIANGLES);
        }
        prepared.append(made == nullptr ? nb::borrow(given) : nb::cast(made));
    }
    return prepared;
}

void bind_prepared_surfaces(nb::module_& m) {
    m.def("prepared_surfaces", &prepared_surfaces, nb::arg("surfaces"), nb::arg("faces"),
          "The surfaces, with their points and first derivatives to rounding, for many places: a "
          "spline is made polynomials where the triangles, those of faces (m,), are many enough.");
}

void bind_far_corners(nb::module_& m) {
    m.def(
        "far_corners",
        [](const nb::list& surfaces, const Points3& points, const Triangles& triangles,
           const Points2& uv, const Triangles& uv_triangles, const Numbers& faces,
           const Vector<std::uint8_t>& left_out, double limit) {
            const std::vector<const Surface*> all = surfaces_of(surfaces);
            const MeasuredMesh mesh =
                measured_mesh(all, points, triangles, uv, uv_triangles, faces);
            require_mesh(mesh);
            require_rows(left_out.shape(0), mesh.triangles.size(), "left_out");
            FarCorners found;
            {
                const nb::gil_scoped_release released;
                found = far_corners(mesh, rows<std::uint8_t>(left_out), limit);
            }
            if (found.failed >= 0) raise_failure(*all[found.failed], SurfaceStatus::FAILED);
            return view(found.half_edges);
        },
        nb::arg("surfaces"), nb::arg("points"), nb::arg("triangles"), nb::arg("uv"),
        nb::arg("uv_triangles"), nb::arg("faces"), nb::arg("left_out"), nb::arg("limit"),
        "Corners (k,), 3 t + i for corner i of triangle t, farther than limit from r(u, v): of "
        "each "
        "row of uv that a triangle uses the last, but of those of which left_out (m,) is 1.\n\n"
        "The mesh is as for ``mesh_deviation``.");
}

void bind_mesh_deviation(nb::module_& m) {
    m.def(
        "mesh_deviation",
        [](const nb::list& surfaces, const Points3& points, const Triangles& triangles,
           const Points2& uv, const Triangles& uv_triangles, const Numbers& faces,
           const Matrix<std::int32_t, 2>& edges, const Vector<double>& area,
           const Vector<std::uint8_t>& in_plane) {
            const std::vector<const Surface*> all = surfaces_of(surfaces);
            const MeasuredMesh mesh =
                measured_mesh(all, points, triangles, uv, uv_triangles, faces);
            require_mesh(mesh);
            require_rows(area.shape(0), mesh.triangles.size(), "area");
            require_rows(in_plane.shape(0), mesh.triangles.size(), "in_plane");
            const std::span<const EdgeSides> sides = sides_of(edges, mesh.triangles.size());
            MeshDeviation found;
            {
                const nb::gil_scoped_release released;
                found =
                    mesh_deviation(mesh, sides, rows<double>(area), rows<std::uint8_t>(in_plane));
            }
            if (found.failed >= 0) raise_failure(*all[found.failed], SurfaceStatus::FAILED);
            return std::tuple(view(found.largest), view(found.mean_square), view(found.cosine));
        },
        nb::arg("surfaces"), nb::arg("points"), nb::arg("triangles"), nb::arg("uv"),
        nb::arg("uv_triangles"), nb::arg("faces"), nb::arg("edges"), nb::arg("area"),
        nb::arg("in_plane"),
        "Of triangles (m, 3) with uv_triangles (m, 3), rows of points (n, 3) and uv (q, 2), on "
        "the surfaces of faces (m,): the largest distance (m,) at vertices, middles and centroid, "
        "the mean of its square (m,), the cosine (m,) between the normals, 1 where one is missing."
        "\n\nedges (k, 2): the half-edges of each, -1 where there is one; area (m,); "
        "in_plane (m,): as ``plane_triangles`` has it.");
    m.def(
        "plane_triangles",
        [](const nb::list& surfaces, const Points3& points, const Triangles& triangles,
           const Points2& uv, const Triangles& uv_triangles, const Numbers& faces) {
            const std::vector<const Surface*> all = surfaces_of(surfaces);
            const MeasuredMesh mesh =
                measured_mesh(all, points, triangles, uv, uv_triangles, faces);
            require_mesh(mesh);
            Array<std::uint8_t> found;
            {
                const nb::gil_scoped_release released;
                found = plane_triangles(mesh);
            }
            return view(found);
        },
        nb::arg("surfaces"), nb::arg("points"), nb::arg("triangles"), nb::arg("uv"),
        nb::arg("uv_triangles"), nb::arg("faces"),
        "1 for each triangle (m,) of a plane whose corners are r(u, v) to a billionth of its size: "
        "over it no point is farther from the plane, nor the plane from it; else 0.\n\nThe mesh "
        "is as for ``mesh_deviation``.");
}

/// The triangles (k,) of a mesh are numbers of rows, and their rows are in range.
void require_triangles(const MeasuredMesh& mesh, std::span<const std::int32_t> triangles) {
    require_indices(triangles, mesh.triangles.size(), "triangle");
    const auto require_corners_of = [](const TriangleCorners& t, std::size_t count,
                                       const char* what) {
        require_indices(std::span(&t.a, 3), count, what);
    };
    for (const std::int32_t t : triangles) {
        require_corners_of(mesh.triangles[t], mesh.points.size(), "triangles");
        require_corners_of(mesh.uv_triangles[t], mesh.uv.size(), "uv_triangles");
        require_indices(mesh.faces.subspan(t, 1), mesh.surfaces.size(), "faces");
    }
}

void bind_surface_distances(nb::module_& m) {
    m.def(
        "surface_distances",
        [](const nb::list& surfaces, const Points3& points, const Triangles& triangles,
           const Points2& uv, const Triangles& uv_triangles, const Numbers& faces,
           const Numbers& triangle, const Matrix<double, 3>& weights) {
            const std::vector<const Surface*> all = surfaces_of(surfaces);
            const MeasuredMesh mesh =
                measured_mesh(all, points, triangles, uv, uv_triangles, faces);
            require_mesh(mesh);
            const std::span<const std::int32_t> chosen = rows<std::int32_t>(triangle);
            require_triangles(mesh, chosen);
            SurfaceDistances found;
            {
                const nb::gil_scoped_release released;
                found = surface_distances(mesh, chosen, rows<Weights>(weights));
            }
            if (found.failed >= 0) raise_failure(*all[found.failed], SurfaceStatus::FAILED);
            return view(found.distance);
        },
        nb::arg("surfaces"), nb::arg("points"), nb::arg("triangles"), nb::arg("uv"),
        nb::arg("uv_triangles"), nb::arg("faces"), nb::arg("triangle"), nb::arg("weights"),
        "How far (k w,) points of the surfaces at barycentric weights (w, 3) over triangles (k,) "
        "are from them, triangle after triangle.\n\nThe mesh is as ``mesh_deviation`` takes it.");
}

void bind_samples(nb::module_& m) {
    m.def(
        "sampled_surface",
        [](const nb::list& surfaces, const Points3& points, const Triangles& triangles,
           const Points2& uv, const Triangles& uv_triangles, const Numbers& faces,
           const Numbers& triangle, const Numbers& rule, const Matrix<double, 3>& weights) {
            const std::vector<const Surface*> all = surfaces_of(surfaces);
            const MeasuredMesh mesh =
                measured_mesh(all, points, triangles, uv, uv_triangles, faces);
            require_triangles(mesh, rows<std::int32_t>(triangle));
            require_rows(rule.shape(0), triangle.shape(0), "rule");
            require_indices(rows<std::int32_t>(rule), weights.shape(0), "rule");
            SampledSurface found;
            {
                const nb::gil_scoped_release released;
                found = sampled_surface(mesh, rows<std::int32_t>(triangle),
                                        rows<std::int32_t>(rule), rows<Weights>(weights));
            }
            if (found.failed >= 0) raise_failure(*all[found.failed], SurfaceStatus::FAILED);
            return std::tuple(view(found.uv), view(found.points), view(found.distance));
        },
        nb::arg("surfaces"), nb::arg("points"), nb::arg("triangles"), nb::arg("uv"),
        nb::arg("uv_triangles"), nb::arg("faces"), nb::arg("triangle"), nb::arg("rule"),
        nb::arg("weights"),
        "Parameters (k, 2) at barycentric weights[rule] (w, 3) of triangles (k,), the points (k, "
        "3) of the surfaces there, and how far (k,) these are from the triangle.\n\nThe mesh is as "
        "for ``mesh_deviation``; only the triangles that are asked for are looked at.");
}

void bind_dense_deviation(nb::module_& m) {
    m.def(
        "dense_deviation",
        [](const nb::list& surfaces, const Points3& points, const Triangles& triangles,
           const Points2& uv, const Triangles& uv_triangles, const Numbers& faces,
           const Numbers& triangle, const Matrix<double, 3>& weights, double limit, int steps) {
            const std::vector<const Surface*> all = surfaces_of(surfaces);
            const MeasuredMesh mesh =
                measured_mesh(all, points, triangles, uv, uv_triangles, faces);
            require_triangles(mesh, rows<std::int32_t>(triangle));
            DenseDeviation found;
            {
                const nb::gil_scoped_release released;
                found = dense_deviation(mesh, rows<std::int32_t>(triangle), rows<Weights>(weights),
                                        limit, steps);
            }
            if (found.failed >= 0) raise_failure(*all[found.failed], SurfaceStatus::FAILED);
            const auto& [t, p, q, distance] = found.farthest;
            return std::tuple(view(found.largest), t, std::array{p.x, p.y, p.z},
                              std::array{q.x, q.y});
        },
        nb::arg("surfaces"), nb::arg("points"), nb::arg("triangles"), nb::arg("uv"),
        nb::arg("uv_triangles"), nb::arg("faces"), nb::arg("triangle"), nb::arg("weights"),
        nb::arg("limit"), nb::arg("steps"),
        "Largest distance (k,) of points of triangles (k,), at barycentric weights (w, 3), from "
        "the nearest point of the surface; of the farthest of all its triangle, place and "
        "parameters.\n\nThe mesh is as for ``mesh_deviation``; limit, steps: as for "
        "``closest_points_in_triangles``.");
}

void bind_creases(nb::module_& m) {
    m.def(
        "face_creases",
        [](const nb::list& surfaces, const Points3& points, const Triangles& triangles,
           const Points2& uv, const Triangles& uv_triangles, const Numbers& faces,
           const Matrix<std::int32_t, 2>& edges, const Vector<double>& angle) {
            const std::vector<const Surface*> all = surfaces_of(surfaces);
            const MeasuredMesh mesh =
                measured_mesh(all, points, triangles, uv, uv_triangles, faces);
            require_mesh(mesh);
            require_indices(std::span(edges.data(), edges.size()), 3 * mesh.triangles.size(),
                            "edges");
            require_rows(angle.shape(0), all.size(), "angle");
            const std::span<const HalfEdgePair> pairs{
                reinterpret_cast<const HalfEdgePair*>(edges.data()), edges.shape(0)};
            FaceCreases found;
            {
                const nb::gil_scoped_release released;
                found = face_creases(mesh, pairs, rows<double>(angle));
            }
            if (found.failed >= 0) raise_failure(*all[found.failed], SurfaceStatus::FAILED);
            return view(found.bent);
        },
        nb::arg("surfaces"), nb::arg("points"), nb::arg("triangles"), nb::arg("uv"),
        nb::arg("uv_triangles"), nb::arg("faces"), nb::arg("edges"), nb::arg("angle"),
        "Which edges (k,) within faces lie on a crease of their surface, at an apex, or as good as "
        "at one: 0 and 1.\n\nThe mesh is as for ``mesh_deviation``; edges (k, 2): the half-edges "
        "on both sides; angle (f,): what is asked for of each face, degrees. As good as at an "
        "apex: curved so much that this angle would ask for less than the finest size, a fraction "
        "of the diagonal of the face's triangles.");
}

void bind_solids(nb::module_& m) {
    m.def(
        "solid_counts",
        [](const Triangles& triangles, const Numbers& solid, std::size_t vertices,
           std::size_t solids) {
            require_corners(triangles, vertices, "triangles");
            require_rows(solid.shape(0), triangles.shape(0), "solid");
            require_indices(rows<std::int32_t>(solid), solids, "solid");
            SolidCounts found;
            {
                const nb::gil_scoped_release released;
                found = solid_counts(rows<TriangleCorners>(triangles), rows<std::int32_t>(solid),
                                     vertices, solids);
            }
            return std::tuple(view(found.vertices), view(found.edges), view(found.open_edges));
        },
        nb::arg("triangles"), nb::arg("solid"), nb::arg("vertices"), nb::arg("solids"),
        "Vertices, edges and open edges (s,) of each of so many solids, by triangles (k, 3) around "
        "solid (k,), facing outwards.\n\nAn edge is open where it is not run along as often one "
        "way as the other.");
}

void bind_hidden_bounds(nb::module_& m) {
    m.def(
        "hidden_bounds",
        [](const Surface& surface, const Points3& points, const Triangles& triangles,
           const Points2& uv, const Triangles& uv_triangles, const Numbers& rows_given,
           const Vector<double>& tolerance, const Vector<double>& seen,
           const Vector<std::uint8_t>& whole, int levels) {
            const std::span<const std::int32_t> chosen = rows<std::int32_t>(rows_given);
            require_rows(tolerance.shape(0), chosen.size(), "tolerance");
            require_rows(seen.shape(0), chosen.size(), "seen");
            require_rows(whole.shape(0), chosen.size(), "whole");
            require_rows(uv_triangles.shape(0), triangles.shape(0), "uv_triangles");
            if (levels < 0 || levels > 9) throw nb::value_error("levels is from 0 to 9");
            require_indices(chosen, triangles.shape(0), "triangle");
            require_corners(triangles, points.shape(0), "triangles");
            require_corners(uv_triangles, uv.shape(0), "uv_triangles");
            const MeasuredMesh mesh{{},
                                    rows<Point3>(points),
                                    rows<TriangleCorners>(triangles),
                                    rows<Point2>(uv),
                                    rows<TriangleCorners>(uv_triangles),
                                    {}};
            HiddenBounds found;
            {
                const nb::gil_scoped_release released;
                found = hidden_bounds(surface, mesh,
                                      {chosen, rows<double>(tolerance), rows<double>(seen),
                                       rows<std::uint8_t>(whole)},
                                      levels);
            }
            raise_failure(surface, found.status);
            return view(found.bounded);
        },
        nb::arg("surface"), nb::arg("points"), nb::arg("triangles"), nb::arg("uv"),
        nb::arg("uv_triangles"), nb::arg("triangle"), nb::arg("tolerance"), nb::arg("seen"),
        nb::arg("whole"), nb::arg("levels"),
        "Over which triangles (k,), rows of triangles (m, 3) of points (n, 3) and of uv_triangles "
        "(m, 3) of uv (q, 2), the surface surely hides nothing: 1, or 0 where its second "
        "derivatives do not say so, over triangles cut in four up to ``levels`` times either."
        "\n\ntolerance (k,): what may hide; seen (k,): the largest distance at the corners, in "
        "the middles of the sides and at the centroid; whole (k,): 1 where all of the box around "
        "the triangle in (u, v) counts. Without area it hides nothing.");
}

void bind_enclosed_volumes(nb::module_& m) {
    m.def(
        "enclosed_volumes",
        [](const Points3& points, const Triangles& triangles, const Numbers& solid,
           const Points3& apexes) {
            require_corners(triangles, points.shape(0), "triangles");
            require_rows(solid.shape(0), triangles.shape(0), "solid");
            require_indices(rows<std::int32_t>(solid), apexes.shape(0), "solid");
            Array<double> found;
            {
                const nb::gil_scoped_release released;
                found = enclosed_volumes(rows<Point3>(points), rows<TriangleCorners>(triangles),
                                         rows<std::int32_t>(solid), rows<Point3>(apexes));
            }
            return view(found);
        },
        nb::arg("points"), nb::arg("triangles"), nb::arg("solid"), nb::arg("apexes"),
        "Volumes (s,) that triangles (k, 3) around solid (k,), facing outwards, enclose.\n\n"
        "apexes (s, 3): a point near each solid, which the tetrahedra share that are summed up.");
}

}  // namespace

void bind_mesh_edges(nb::module_& m);
void bind_joined_triangles(nb::module_& m);
void bind_figures(nb::module_& m);

void bind_quality(nb::module_& m) {
    m.doc() = "What a report measures of a finished mesh: its distance from its surfaces and back.";
    bind_surface_points(m);
    bind_prepared_surfaces(m);
    bind_far_corners(m);
    bind_mesh_deviation(m);
    bind_least_triangles(m);
    bind_surface_distances(m);
    bind_samples(m);
    bind_segments(m);
    bind_dense_deviation(m);
    bind_creases(m);
    bind_stars(m);
    bind_surface_search(m);
    bind_solids(m);
    bind_hidden_bounds(m);
    bind_enclosed_volumes(m);
    bind_joined_triangles(m);
    bind_mesh_edges(m);
    bind_figures(m);
}

}  // namespace surfmesh::binding
