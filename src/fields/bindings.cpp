#include <nanobind/stl/optional.h>

#include <optional>

#include "binding/arrays.hpp"
#include "fields/background.hpp"
#include "fields/tensors.hpp"

namespace surfmesh::binding {

template <>
struct Row<NodeSize> {
    using Number = double;
    static constexpr std::size_t columns = 4;
};
template <>
struct Row<CellCorners> {
    using Number = std::int32_t;
    static constexpr std::size_t columns = 4;
};

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

/// A property that gives an array of the background as a view that cannot be written to.
template <class T>
void bind_array(nb::class_<Background>& c, const char* name, Array<T> Background::* member,
                const char* doc) {
    c.def_prop_ro(
        name, [member](const Background& b) { return read_only_view(b.*member); },
        nb::rv_policy::reference, doc);
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
    bind_array(c, "child", &Background::child,
               "(cells,): first of four children, or -1 for a leaf");
    bind_array(c, "corner", &Background::corner, "(cells, 4): nodes; of no meaning but in leaves");
    bind_array(c, "metric_root", &Background::metric_root, "(nodes, 4): A = H^-1, and 1 / h");
    bind_array(c, "metric_root_3d", &Background::metric_root_3d,
               "(nodes, 6): W, or (0, 6) where sizes are isotropic");
    c.def(
        "__reduce__",
        [](nb::handle b) {
            return nb::make_tuple(
                b.type(),
                nb::make_tuple(b.attr("box"), b.attr("grid"), b.attr("child"), b.attr("corner"),
                               b.attr("metric_root"), b.attr("metric_root_3d")));
        },
        "So that it can be copied and sent to other processes.");
    c.def_prop_ro("is_anisotropic", &Background::is_anisotropic);
    bind_look_up(c, "sizes", &sizes, "Size tensors H (n, 3) at points (n, 2).");
    bind_look_up(c, "metric_roots", &metric_roots, "A = H^-1 (n, 3) at points (n, 2).");
    bind_look_up(c, "scalar_sizes", &scalar_sizes,
                 "Wanted edge length in space (n,), the shorter of two, at points (n, 2).");
    bind_look_up(c, "metric_roots_3d", &metric_roots_3d,
                 "W (n, 6) at points (n, 2): Id / h where sizes are isotropic.");
}

}  // namespace

void bind_fields(nb::module_& m) {
    m.doc() = "Size tensors, their gradation, and the look-up in a background.";
    bind_background(m);
}

}  // namespace surfmesh::binding
