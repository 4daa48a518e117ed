#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>

#include <optional>

#include "binding/arrays.hpp"
#include "binding/loop_arguments.hpp"
#include "fields/area_within_loops.hpp"
#include "fields/background.hpp"
#include "fields/coverage.hpp"
#include "fields/gradation.hpp"
#include "fields/grown_sizes.hpp"
#include "fields/tensors.hpp"

namespace surfmesh::binding {

void bind_field_builder(nb::module_& m);

template <>
struct Row<NodeSize> : RowOf<double, 4> {};
template <>
struct Row<CellCorners> : RowOf<std::int32_t, 4> {};

namespace {

std::string described(const Background::Check& found) {
    const std::string cell = "cell " + std::to_string(found.at);
    switch (found.fault) {
        case BackgroundFault::none:
            return "";
        case BackgroundFault::box:
            return "box is not finite, or has a scale that is not positive";
        case BackgroundFault::grid:
            return "grid is not positive, or does not fit child and corner";
        case BackgroundFault::child:
            return cell + " has children that do not come after it";
        case BackgroundFault::corner:
            return cell + " has a corner that is no node";
        case BackgroundFault::root_3d:
            return "metric_root_3d has not one row for each node";
    }
    return "";
}

void construct(Background* b, const Vector<double>& box, const Vector<std::int64_t>& grid,
               const Vector<std::int32_t>& child, const Matrix<std::int32_t, 4>& corner,
               const Matrix<double, 4>& metric_root,
               const std::optional<Matrix<double, 6>>& metric_root_3d) {
    require_rows(box.shape(0), 5, "box");
    require_rows(grid.shape(0), 2, "grid");
    require_rows(corner.shape(0), child.shape(0), "corner");
    for (int k = 0; k < 2; ++k)
        if (grid(k) < 1 || grid(k) > static_cast<std::int64_t>(child.shape(0)))
            throw nb::value_error("grid is not positive, or has more root cells than child");
    Background made;
    made.box = {box(0), box(1), box(2), box(3), box(4)};
    made.grid = {static_cast<std::int32_t>(grid(0)), static_cast<std::int32_t>(grid(1))};
    made.child = Array<Cell>(rows<Cell>(child));
    made.corner = Array<CellCorners>(rows<CellCorners>(corner));
    made.metric_root = Array<NodeSize>(rows<NodeSize>(metric_root));
    if (metric_root_3d)
        made.metric_root_3d = Array<MetricRoot3>(rows<MetricRoot3>(*metric_root_3d));
    const Background::Check found = made.check();
    if (found.fault != BackgroundFault::none) throw nb::value_error(described(found).c_str());
    new (b) Background(std::move(made));
}

/// A method that gives values at points.
template <class T>
void bind_look_up(nb::class_<Background>& c, const char* name,
                  Array<T> (*look_up)(const Background&, std::span<const Point2>),
                  const char* doc) {
    c.def(
        name,
        [look_up](const Background& b, const Points2& xy) {
            Array<T> found;
            {
                const nb::gil_scoped_release released;
                found = look_up(b, rows<Point2>(xy));
            }
            return view(found);
        },
        nb::arg("xy"), doc);
}

void bind_areas(nb::class_<Background>& c) {
    c.def("metric_area", &metric_area_of_box, nb::arg("x1"), nb::arg("y1"),
          nb::call_guard<nb::gil_scoped_release>(),
          "Integral of 1 / det H over [x0, x1] x [y0, y1], (x0, y0) the corner of the box.");
    c.def(
        "leaf_areas",
        [](const Background& b, double x1, double y1) {
            LeafAreas found = [&] {
                const nb::gil_scoped_release released;
                return leaf_areas(b, x1, y1);
            }();
            return std::tuple(view(found.low), view(found.step), view(found.area));
        },
        nb::arg("x1"), nb::arg("y1"),
        "Of the leaves in the same rectangle: lower left corners (n, 2), sides (n, 2), metric "
        "areas (n,).");
    c.def(
        "metric_area_within",
        [](const Background& b, const Points2& corners, const Vector<std::int64_t>& first) {
            const PlaneLoops loops = plane_loops(corners, first);
            const nb::gil_scoped_release released;
            return metric_area_within(b, loops);
        },
        nb::arg("corners"), nb::arg("first"),
        "The same over what lies within an odd number of loops that do not cross.\n\n"
        "corners (m, 2), finite, of loop k from first[k] to first[k + 1], not closed.");
    c.def(
        "expected_circles",
        [](const Background& b, double x1, double y1) { return expected_circles(b, {x1, y1}); },
        nb::arg("x1"), nb::arg("y1"), nb::call_guard<nb::gil_scoped_release>(),
        "About how many circles cover the same rectangle.");
}

void bind_background(nb::module_& m) {
    nb::class_<Background> c(
        m, "Background", "Size tensors on a forest of quadtrees over a box of the scaled plane.");
    c.def("__init__", &construct, nb::arg("box"), nb::arg("grid"), nb::arg("child"),
          nb::arg("corner"), nb::arg("metric_root"), nb::arg("metric_root_3d") = nb::none(),
          "box (5,): x0, y0, root cells per unit of x and y, largest size. grid (2,): root cells "
          "along x and y.\nchild (cells,): first of four children, which come after their parent, "
          "or -1 for a leaf.\ncorner (cells, 4): nodes. metric_root (nodes, 4): A = H^-1, and "
          "1 / h.\nmetric_root_3d (nodes, 6): W, xx, xy, xz, yy, yz, zz; left out where sizes are "
          "isotropic.\nRaises ValueError for what a look-up could not walk through.");
    c.def_prop_ro(
        "box",
        [](const Background& b) {
            const double box[] = {b.box.x0, b.box.y0, b.box.across, b.box.up, b.box.largest};
            return read_only_view(Array<double>(std::span<const double>(box)));
        },
        nb::rv_policy::reference,
        "(5,): x0, y0, root cells per unit of x and y, largest size (unit length)");
    c.def_prop_ro(
        "grid",
        [](const Background& b) {
            const std::int64_t grid[] = {b.grid.nx, b.grid.ny};
            return read_only_view(Array<std::int64_t>(std::span<const std::int64_t>(grid)));
        },
        nb::rv_policy::reference, "(2,): root cells along x and y");
    bind_read_only_array(c, "child", &Background::child,
                         "(cells,): first of four children, or -1 for a leaf");
    bind_read_only_array(c, "corner", &Background::corner,
                         "(cells, 4): nodes; of no meaning but in leaves");
    bind_read_only_array(c, "metric_root", &Background::metric_root,
                         "(nodes, 4): A = H^-1, and 1 / h");
    bind_read_only_array(c, "metric_root_3d", &Background::metric_root_3d,
                         "(nodes, 6): W, or (0, 6) where sizes are isotropic");
    c.def_prop_ro("is_anisotropic", &Background::is_anisotropic);
    c.def(
        "__reduce__",
        [](nb::handle b) {
            return nb::make_tuple(
                b.type(),
                nb::make_tuple(b.attr("box"), b.attr("grid"), b.attr("child"), b.attr("corner"),
                               b.attr("metric_root"), b.attr("metric_root_3d")));
        },
        "So that it can be copied and sent to other processes.");
    bind_look_up(c, "sizes", &sizes, "Size tensors H (n, 3) at points (n, 2).");
    bind_look_up(c, "metric_roots", &metric_roots, "A = H^-1 (n, 3) at points (n, 2).");
    bind_look_up(c, "scalar_sizes", &scalar_sizes,
                 "Wanted edge length in space (n,), the shorter of two, at points (n, 2).");
    bind_look_up(c, "metric_roots_3d", &metric_roots_3d,
                 "W (n, 6) at points (n, 2): Id / h where sizes are isotropic.");
    bind_areas(c);
}

/// An array that is changed in place.
template <class T>
using Changed = nb::ndarray<T, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

using Patches = Matrix<std::int32_t, 9>;
using Pairs = Matrix<std::int32_t, 2>;

/// What makes sizes anisotropic; nothing where they are isotropic.
struct Directions {
    std::span<double> longer;
    std::span<const Point3> along, normal;
    std::span<const std::uint8_t> round;
};

GradedSizes graded_sizes(const Points3& point, double slope, Changed<double>& size,
                         Changed<std::int32_t>& changed, const Directions& directions) {
    const std::size_t nodes = point.shape(0);
    require_rows(size.size(), nodes, "size");
    require_rows(changed.size(), nodes, "changed");
    if (!directions.longer.empty()) {
        require_rows(directions.longer.size(), nodes, "longer");
        require_rows(directions.along.size(), nodes, "along");
        require_rows(directions.normal.size(), nodes, "normal");
        if (!directions.round.empty()) require_rows(directions.round.size(), nodes, "round");
    }
    return {{size.data(), nodes}, directions.longer,   directions.along,        directions.normal,
            directions.round,     rows<Point3>(point), {changed.data(), nodes}, slope};
}

std::pair<std::int64_t, bool> graded(const Patches& patches, const Pairs& joined,
                                     const GradedSizes& sizes, std::int32_t number,
                                     std::int64_t most_visits) {
    require_indices(std::span(patches.data(), patches.size()), sizes.size.size(), "patches");
    require_indices(std::span(joined.data(), joined.size()), sizes.size.size(), "joined");
    if (patches.shape(0) >= std::size_t{1} << 27)
        throw nb::value_error("there are 2^27 patches or more");
    const nb::gil_scoped_release released;
    const GradationDone done =
        grade(rows<Patch>(patches), rows<JoinedNodes>(joined), sizes, number, most_visits);
    return {done.visits, done.finished};
}

void bind_gradation(nb::module_& m) {
    m.attr("TURN_SLOPE") = TURN_SLOPE;
    m.def(
        "grade",
        [](const Patches& patches, const Pairs& joined, const Points3& point, double slope,
           Changed<double> size, Changed<std::int32_t> changed, std::int32_t number,
           std::int64_t most_visits) {
            const auto sizes = graded_sizes(point, slope, size, changed, {});
            return graded(patches, joined, sizes, number, most_visits);
        },
        nb::arg("patches"), nb::arg("joined"), nb::arg("point"), nb::arg("slope"),
        nb::arg("size").noconvert(), nb::arg("changed").noconvert(), nb::arg("number"),
        nb::arg("most_visits"),
        "Lower size (nodes,), in place, until no neighbours differ by more than slope allows.\n\n"
        "patches (cells, 9), joined (k, 2): nodes; point (nodes, 3). changed (nodes,): the number "
        "of the last gradation that lowered a node; those with the number of this one, and what "
        "they lower, are looked at.\nReturns how often a node was visited, and whether "
        "most_visits sufficed.");
    m.def(
        "grade_stretched",
        [](const Patches& patches, const Pairs& joined, const Points3& point, double slope,
           Changed<double> size, Changed<double> longer, const Points3& along,
           const Points3& normal, const Vector<std::uint8_t>& round, Changed<std::int32_t> changed,
           std::int32_t number, std::int64_t most_visits) {
            const Directions directions{{longer.data(), longer.size()},
                                        rows<Point3>(along),
                                        rows<Point3>(normal),
                                        rows<std::uint8_t>(round)};
            require_rows(longer.size(), point.shape(0), "longer");
            const auto sizes = graded_sizes(point, slope, size, changed, directions);
            return graded(patches, joined, sizes, number, most_visits);
        },
        nb::arg("patches"), nb::arg("joined"), nb::arg("point"), nb::arg("slope"),
        nb::arg("size").noconvert(), nb::arg("longer").noconvert(), nb::arg("along"),
        nb::arg("normal"), nb::arg("round"), nb::arg("changed").noconvert(), nb::arg("number"),
        nb::arg("most_visits"),
        "The same of two sizes: longer (nodes,) along the unit tangents along (nodes, 3), size at "
        "right angles to them.\n\nnormal (nodes, 3): unit, or zero where there is none. round: "
        "(nodes,) where longer stays the longer one, or (0,).");
}

void bind_patch_errors(nb::module_& m) {
    m.def(
        "patch_errors",
        [](const Patches& patches, const SizeTensors& metric_root, const Points2& step,
           double largest) {
            require_indices(std::span(patches.data(), patches.size()), metric_root.shape(0),
                            "patches");
            require_rows(step.shape(0), patches.shape(0), "step");
            Array<double> error, extent;
            for (std::size_t k = 0; k < patches.shape(0); ++k) {
                PatchRoots roots;
                for (std::size_t i = 0; i < 9; ++i)
                    roots[i] = rows<SizeTensor>(metric_root)[rows<Patch>(patches)[k].node[i]];
                const PatchError found = patch_error(roots, rows<Point2>(step)[k], largest);
                error.push_back(found.error);
                extent.push_back(found.extent);
            }
            return std::pair(view(error), view(extent));
        },
        nb::arg("patches"), nb::arg("metric_root"), nb::arg("step"), nb::arg("largest"),
        "How far the field in each patch (cells, 9) is from bilinear, relative, (cells,); and how "
        "many edges wide it is, (cells,).\n\nmetric_root (nodes, 3): A = H^-1. step (cells, 2): "
        "width and height. largest: size above which none counts.");
}

void bind_sources(nb::module_& m) {
    m.def(
        "grow_sizes",
        [](const Points2& place, const Vector<double>& size,
           std::tuple<double, double, double> metric, double slope, double largest,
           std::tuple<double, double, double, double> box) -> std::optional<Background> {
            require_rows(size.shape(0), place.shape(0), "size");
            if (place.shape(0) > (std::size_t{1} << 30))
                throw nb::value_error("there are more than 2^30 sources");
            const auto [e, f, g] = metric;
            const auto [x0, y0, x1, y1] = box;
            constexpr double MOST = std::numeric_limits<double>::max();
            if (!(0.0 < x1 - x0 && x1 - x0 <= MOST && 0.0 < y1 - y0 && y1 - y0 <= MOST))
                throw nb::value_error("box has no width or no height, or is not finite");
            if (!(e > 0.0 && e * g > f * f)) throw nb::value_error("metric is not positive");
            const Sources sources{rows<Point2>(place), rows<double>(size), e, f, g, slope, largest};
            const nb::gil_scoped_release released;
            GrownTree grown = grow_sizes(sources, {{x0, y0}, {x1, y1}});
            if (grown.status == TreeStatus::too_many_cells) return std::nullopt;
            return std::move(grown.background);
        },
        nb::arg("place"), nb::arg("size"), nb::arg("metric"), nb::arg("slope"), nb::arg("largest"),
        nb::arg("box"),
        "The background of the sizes min(largest, size_k + slope distance_k) of sources at place "
        "(n, 2), over box: x0, y0, x1, y1.\n\nmetric: the constant E, F, G. What lies beyond the "
        "upper and right sides may be covered too. None where more than MOST_SOURCE_CELLS cells "
        "are needed.");
    m.attr("MOST_SOURCE_CELLS") = MOST_SOURCE_CELLS;
}

void bind_tensors(nb::module_& m) {
    m.def(
        "solve",
        [](std::tuple<double, double, double> h, double x, double y) {
            const auto [xx, xy, yy] = h;
            const Point2 found = solve(SizeTensor{xx, xy, yy}, Point2{x, y});
            return std::pair(found.x, found.y);
        },
        nb::arg("h"), nb::arg("x"), nb::arg("y"), "H^-1 (x, y).");
    m.def(
        "invert",
        [](double xx, double xy, double yy, double largest) {
            const SizeTensor h = invert({xx, xy, yy}, largest);
            return std::tuple(h.xx, h.xy, h.yy);
        },
        nb::arg("xx"), nb::arg("xy"), nb::arg("yy"), nb::arg("largest"),
        "H = A^-1 with its eigenvalues capped at largest.");
    m.def(
        "edge_lengths",
        [](const Points2& xy, const SizeTensors& size, const Pairs& edges) {
            require_rows(size.shape(0), xy.shape(0), "size");
            require_indices(std::span(edges.data(), edges.size()), xy.shape(0), "edges");
            const Array<Point2> point(rows<Point2>(xy));
            const Array<SizeTensor> tensor(rows<SizeTensor>(size));
            Array<double> length;
            for (std::size_t k = 0; k < edges.shape(0); ++k)
                length.push_back(edge_length(point, tensor, edges(k, 0), edges(k, 1)));
            return view(length);
        },
        nb::arg("xy"), nb::arg("size"), nb::arg("edges"),
        "Metric lengths (n,) of edges (n, 2) between vertices at xy (v, 2) with size tensors "
        "(v, 3).");
    m.def(
        "shape",
        [](double ux, double uy, double vx, double vy) { return shape({ux, uy}, {vx, vy}); },
        nb::arg("ux"), nb::arg("uy"), nb::arg("vx"), nb::arg("vy"),
        "alpha = 4 sqrt(3) area / sum of squared edges, of a triangle with edge vectors u, v.");
    m.def(
        "triangle_shape",
        [](const Points2& xy, const SizeTensors& size) {
            require_rows(xy.shape(0), 3, "xy");
            require_rows(size.shape(0), 3, "size");
            return triangle_shape(Array<Point2>(rows<Point2>(xy)),
                                  Array<SizeTensor>(rows<SizeTensor>(size)), 0, 1, 2);
        },
        nb::arg("xy"), nb::arg("size"),
        "alpha of the triangle xy (3, 2) in the mean metric of its corners' tensors (3, 3).");
}

}  // namespace

void bind_fields(nb::module_& m) {
    m.doc() = "Size tensors, their gradation, and the look-up in a background.";
    bind_tensors(m);
    bind_background(m);
    bind_sources(m);
    bind_gradation(m);
    bind_patch_errors(m);
    bind_field_builder(m);
}

}  // namespace surfmesh::binding
