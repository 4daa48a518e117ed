#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>

#include "binding/arrays.hpp"
#include "optimisation/surface_frames.hpp"
#include "optimisation/vertex_arguments.hpp"

namespace surfmesh::binding {

template <>
struct Row<TangentMap> : RowOf<double, 6> {};
namespace {

using Numbers = Vector<std::int32_t>;

void bind_measures(nb::module_& m) {
    m.def(
        "chord",
        [](const SurfaceFrames& s, Vertex v, Vertex p) {
            require_vertex(s, v);
            require_vertex(s, p);
            const Point2 found = chord(s, v, p);
            return std::pair(found.x, found.y);
        },
        nb::arg("frames"), nb::arg("v"), nb::arg("p"),
        "The chord from v to p in the unit tangent plane of v.");
    m.def(
        "edge_length",
        [](const SurfaceFrames& s, Vertex v, Vertex p) {
            require_vertex(s, v);
            require_vertex(s, p);
            return edge_length(s, v, p);
        },
        nb::arg("frames"), nb::arg("v"), nb::arg("p"),
        "Length of the chord in units of the mean wanted size, in its direction, of its ends.");
    m.def(
        "lift",
        [](const SurfaceFrames& s, Vertex v, double x, double y) {
            require_vertex(s, v);
            const Point3 found = lift(s, v, {x, y});
            return std::tuple(found.x, found.y, found.z);
        },
        nb::arg("frames"), nb::arg("v"), nb::arg("x"), nb::arg("y"),
        "The step in space, along the tangent plane of v, that looks like (x, y) there.");
    m.def(
        "shorten",
        [](SurfaceFrames& s, Vertex v, double factor) {
            require_vertex(s, v);
            shorten(s, v, factor);
        },
        nb::arg("frames"), nb::arg("v"), nb::arg("factor"), "Scale the wanted lengths at v.");
    const auto of_triangle = [&m](const char* name,
                                  double (*measure)(const SurfaceFrames&, Vertex, Vertex, Vertex),
                                  const char* doc) {
        m.def(
            name,
            [measure](const SurfaceFrames& s, Vertex a, Vertex b, Vertex c) {
                for (const Vertex v : {a, b, c}) require_vertex(s, v);
                return measure(s, a, b, c);
            },
            nb::arg("frames"), nb::arg("a"), nb::arg("b"), nb::arg("c"), doc);
    };
    of_triangle("triangle_shape", &triangle_shape,
                "alpha of abc in space, negative when it is turned over against the normals.");
    of_triangle("triangle_deviation", &triangle_deviation,
                "About how far abc lies from a surface with these tangent planes.");
}

}  // namespace

void bind_frames(nb::module_& m) {
    nb::class_<SurfaceFrames> c(m, "SurfaceFrames",
                                "Where the vertices lie in space, and how to measure there. "
                                "Arrays are views: they go stale where vertices are added.");
    c.def(nb::init<std::size_t, bool>(), nb::arg("vertices"), nb::arg("anisotropic") = false,
          "Frames of so many vertices, all zero but for ``scale``, which is 1.");
    bind_array(c, "point", &SurfaceFrames::point, "(vertices, 3): r");
    bind_array(c, "tangent_map", &SurfaceFrames::tangent_map,
               "(vertices, 6): B, its two rows one after the other");
    bind_array(c, "normal", &SurfaceFrames::normal,
               "(vertices, 3): unit normal, zero at a degenerate point");
    bind_array(c, "size", &SurfaceFrames::size, "(vertices,): wanted edge length h");
    bind_array(c, "scale", &SurfaceFrames::scale,
               "(vertices,): h over that of the size field, at most 1");
    bind_array(c, "metric_root_3d", &SurfaceFrames::metric_root,
               "(vertices, 6): W; empty where sizes are isotropic");
    c.def_ro("is_anisotropic", &SurfaceFrames::is_anisotropic,
             "Do the sizes depend on the direction?");
    c.def_prop_rw(
        "most_vertices", [](const SurfaceFrames& s) { return s.limits.most_vertices; },
        [](SurfaceFrames& s, std::size_t most) { s.limits.most_vertices = most; },
        "No edge is split once there are so many.");
    c.def(
        "set",
        [](SurfaceFrames& s, Triangulation& t, const Background& background,
           const Numbers& vertices, const Points3& r, const Points3& rx, const Points3& ry,
           double largest) {
            require_rows(s.point.size(), t.xy.size(), "frames");
            require_indices(rows<Vertex>(vertices), t.xy.size(), "vertices");
            require_rows(r.shape(0), vertices.shape(0), "r");
            require_rows(rx.shape(0), vertices.shape(0), "rx");
            require_rows(ry.shape(0), vertices.shape(0), "ry");
            if (s.is_anisotropic && background.metric_root_3d.empty())
                throw nb::value_error("the background has no metric_root_3d");
            for (std::size_t k = 0; k < vertices.shape(0); ++k) {
                set_size(t, s, background, vertices(k));
                set_frame(t, s, vertices(k),
                          {rows<Point3>(r)[k], rows<Point3>(rx)[k], rows<Point3>(ry)[k]}, largest);
            }
        },
        nb::arg("t"), nb::arg("background"), nb::arg("vertices"), nb::arg("r"), nb::arg("rx"),
        nb::arg("ry"), nb::arg("largest"),
        "Set the frames of vertices (n,), and their size tensors, from r, r_x, r_y (n, 3).");
    bind_measures(m);
}

}  // namespace surfmesh::binding
