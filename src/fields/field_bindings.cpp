// The builder of size fields, with laws that are the caller's own objects in Python.
#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>

#include <exception>
#include <tuple>
#include <utility>

#include "binding/arrays.hpp"
#include "fields/field_builder.hpp"
#include "fields/field_node_arrays.hpp"
#include "fields/field_outcome_tuple.hpp"
#include "fields/field_plan.hpp"

namespace surfmesh::binding {

void bind_field_builder(nb::module_& m);

template <>
struct Row<SmallSource> : RowOf<std::int64_t, 3> {};

namespace {

using Numbers = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;
using Flags = nb::ndarray<const bool, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

/// The rows of an array that a law returned: one for each place, or none.
template <class T>
Array<T> returned(const nb::tuple& arrays, std::size_t number) {
    Numbers kept;
    constexpr std::size_t columns = Row<T>::columns;
    if (!nb::try_cast(arrays[number], kept) || kept.size() % columns != 0)
        throw nb::value_error(
            ("a law returned what is no array of numbers, as array " + std::to_string(number))
                .c_str());
    return Array<T>(
        std::span<const T>{reinterpret_cast<const T*>(kept.data()), kept.size() / columns});
}

/// Sizes that an object in Python asks for; its first exception is kept.
class CallbackLaw final : public NodeLaw {
  public:
    explicit CallbackLaw(const nb::object& law) : law_(law) {}

    bool ask(std::span<const Point2> xy, FieldNodes& nodes) override {
        const nb::gil_scoped_acquire held;
        try {
            const nb::tuple arrays(law_(view(Array<Point2>(xy))));
            if (arrays.size() != 12) throw nb::value_error("a law returns twelve arrays");
            nodes = {returned<double>(arrays, 0),        returned<double>(arrays, 1),
                     returned<SizeTensor>(arrays, 2),    returned<Point3>(arrays, 3),
                     returned<Point3>(arrays, 4),        returned<double>(arrays, 5),
                     returned<double>(arrays, 6),        returned<Point3>(arrays, 7),
                     returned<PlaneJacobian>(arrays, 8), returned<NumberPair>(arrays, 9),
                     returned<NumberPair>(arrays, 10),   returned<NumberPair>(arrays, 11)};
            if (nodes.count() != xy.size() || !nodes.is_complete())
                throw nb::value_error("a law returned arrays that do not fit the places");
            return true;
        } catch (...) {
            failure_ = std::current_exception();
            return false;
        }
    }
    std::exception_ptr take_failure() override { return std::exchange(failure_, nullptr); }

  private:
    std::exception_ptr failure_;
    const nb::object& law_;
};

/// Features that an object in Python looks for; its first exception is kept.
class CallbackFeatures final : public HiddenFeatures {
  public:
    explicit CallbackFeatures(const nb::object& search) : search_(search) {}

    bool find(const SeenCells& cells, bool deep, std::span<std::uint8_t> found) override {
        const nb::gil_scoped_acquire held;
        try {
            const nb::object given =
                search_(deep, view(cells.low), view(cells.high), view(cells.normal),
                        view(cells.root), view(cells.smallest_size));
            Flags flags;
            if (!nb::try_cast(given, flags) || flags.size() != found.size())
                throw nb::value_error("a search for features returns a flag for each cell");
            std::copy(flags.data(), flags.data() + flags.size(), found.begin());
            return true;
        } catch (...) {
            failure_ = std::current_exception();
            return false;
        }
    }
    std::exception_ptr take_failure() override { return std::exchange(failure_, nullptr); }

  private:
    std::exception_ptr failure_;
    const nb::object& search_;
};

OutcomeTuple refine(FieldBuilder& builder, NodeLaw& law, HiddenFeatures& hidden) {
    FieldOutcome outcome{};
    {
        const nb::gil_scoped_release released;
        outcome = builder.refine(law, hidden);
    }
    if (outcome.status == FieldStatus::failed) {
        if (const std::exception_ptr failure = law.take_failure()) std::rethrow_exception(failure);
        if (const std::exception_ptr failure = hidden.take_failure())
            std::rethrow_exception(failure);
    }
    return outcome_tuple(outcome);
}

/// With a law and a search of the core, or with objects of Python that are called for blocks.
OutcomeTuple refine_by(FieldBuilder& builder, const nb::object& law, const nb::object& search) {
    CallbackLaw called_law(law);
    CallbackFeatures called_search(search);
    NodeLaw* own_law = nullptr;
    HiddenFeatures* own_search = nullptr;
    return refine(builder, nb::try_cast(law, own_law) ? *own_law : called_law,
                  nb::try_cast(search, own_search) ? *own_search : called_search);
}

void require_finished(const FieldBuilder& builder) {
    if (!builder.is_finished()) throw nb::value_error("the field is not refined yet");
}

using Sides = std::pair<std::array<int, 4>, std::array<bool, 4>>;
using Places = nb::ndarray<const std::int64_t, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;

void construct_builder(FieldBuilder* builder, std::pair<std::int32_t, std::int32_t> grid,
                       std::pair<double, double> extent, std::pair<double, double> root_step,
                       double slope, double largest, const Sides& sides, const Places& sources,
                       bool known_sizes, bool counts_triangles, double free_cells,
                       double most_triangles, std::pair<bool, bool> looks_for_hidden,
                       double coarseness) {
    const auto [nx, ny] = grid;
    if (nx < 1 || ny < 1 || std::int64_t{nx} * ny > (1 << 20))
        throw nb::value_error("grid is not positive, or has more than 2^20 root cells");
    if (!(coarseness >= 1.0)) throw nb::value_error("coarseness is below 1");
    for (int side = 0; side < 4; ++side)
        if (const int other = sides.first[side];
            other < -1 || other > 3 || other == side || (other >= 0 && sides.first[other] != side))
            throw nb::value_error("a side is joined with one that is not joined with it");
    FieldPlan plan{{nx, ny},
                   {extent.first, extent.second},
                   {root_step.first, root_step.second},
                   slope,
                   largest,
                   sides.first,
                   sides.second,
                   {},
                   known_sizes,
                   counts_triangles,
                   free_cells,
                   most_triangles,
                   looks_for_hidden.first,
                   looks_for_hidden.second,
                   coarseness};
    for (std::size_t k = 0; k < sources.shape(0); ++k) {
        const SmallSource source{sources(k, 0), sources(k, 1), sources(k, 2)};
        if (source.x < 0 || source.y < 0 || source.x >> GRID_DEPTH >= nx ||
            source.y >> GRID_DEPTH >= ny || source.depth > GRID_DEPTH)
            throw nb::value_error("a source lies outside the grid, or is too deep");
        plan.sources.push_back(source);
    }
    new (builder) FieldBuilder(std::move(plan));
}

void bind_field_plan(nb::module_& m) {
    m.def("root_cells_of_face", &root_cells_of_face, nb::arg("pieces"),
          "About how many cells the search starts with on a face of so many smooth pieces.");
    m.def(
        "root_grid",
        [](std::pair<double, double> extent, int cells) {
            if (!(extent.first > 0.0 && extent.second > 0.0) || cells < 16)
                throw nb::value_error("there is no plane, or fewer than 16 cells");
            const RootGrid grid = root_grid({extent.first, extent.second}, cells);
            return std::pair(grid.nx, grid.ny);
        },
        nb::arg("extent"), nb::arg("cells"),
        "How many cells along x and y: about so many, as near to squares as they can be.");
    m.def(
        "small_sources",
        [](const Points2& places, const Vector<double>& sizes,
           std::pair<std::int32_t, std::int32_t> grid, std::pair<double, double> extent) {
            require_rows(sizes.shape(0), places.shape(0), "sizes");
            if (grid.first < 1 || grid.second < 1 || !(extent.first > 0.0 && extent.second > 0.0))
                throw nb::value_error("there is no grid, or no plane");
            for (const Point2 p : rows<Point2>(places))
                if (!std::isfinite(p.x) || !std::isfinite(p.y))
                    throw nb::value_error("a place is not finite");
            const Array<SmallSource> found =
                small_sources(rows<Point2>(places), rows<double>(sizes), {grid.first, grid.second},
                              {extent.first, extent.second});
            return view(found);
        },
        nb::arg("places"), nb::arg("sizes"), nb::arg("grid"), nb::arg("extent"),
        "x, y on the grid of GRID_DEPTH of places (n, 2) in the scaled plane, and how deep the "
        "cell there shall be for sizes (n,): (n, 3) int64.");
}

}  // namespace

void bind_field_builder(nb::module_& m) {
    bind_field_plan(m);
    m.attr("GRID_DEPTH") = GRID_DEPTH;
    nb::class_<NodeLaw>(m, "NodeLaw", "What sizes are asked for at the nodes of a field.");
    nb::class_<HiddenFeatures>(m, "HiddenFeatures",
                               "Where a surface may have features between the nodes of a cell.");
    nb::class_<FieldBuilder> c(m, "FieldBuilder", "Makes the background of one size field.");
    c.def("__init__", &construct_builder, nb::arg("grid"), nb::arg("extent"), nb::arg("root_step"),
          nb::arg("slope"), nb::arg("largest"), nb::arg("sides"), nb::arg("sources"),
          nb::arg("known_sizes"), nb::arg("counts_triangles"), nb::arg("free_cells"),
          nb::arg("most_triangles"), nb::arg("looks_for_hidden"), nb::arg("coarseness") = 1.0,
          "grid: root cells along x and y. extent: of the scaled plane. root_step: width and "
          "height of a root cell. slope: growth of the size per length. largest: size in the "
          "scaled plane above which none counts.\nsides: of each the one that it is joined with, "
          "or -1, and whether it runs against it. sources (k, 3): x, y of small sizes on the grid "
          "of GRID_DEPTH, and how deep the cell there shall be.\nknown_sizes: points of known "
          "size have such cells. counts_triangles: beyond free_cells, cells may not be many more "
          "than triangles. "
          "most_triangles: more are refused, or inf.\nlooks_for_hidden: features between the "
          "nodes are looked for at all, and in deep cells. coarseness: times the error that a cell "
          "may have for a mesh, at least 1.");
    c.def("refine", &refine_by, nb::arg("law"), nb::arg("hidden"),
          "Split cells until the field is accurate: status, place, and number of triangles or "
          "cells.\n\nlaw, hidden: of the core, or callables: law(xy (n, 2)) -> the twelve arrays "
          "of FieldNodes. hidden(deep, low, high "
          "(n, 2), normal (n, 3), root (9 n, 3), smallest size (n,)) -> (n,) bool.\nRaises what "
          "they raise. The status is done, too_many_triangles, too_many_cells or not_graded.");
    c.def(
        "nodes", [](const FieldBuilder& builder) { return node_arrays(builder.nodes); },
        "The twelve arrays of FieldNodes, as views; the jacobian (nodes, 6).");
    c.def(
        "plane", [](const FieldBuilder& builder) { return view(builder.plane()); },
        "Places (nodes, 2) of the nodes in the scaled plane.");
    c.def(
        "background",
        [](FieldBuilder& builder) {
            require_finished(builder);
            const nb::gil_scoped_release released;
            return builder.background();
        },
        "The background; the builder is done with.");
}

}  // namespace surfmesh::binding
