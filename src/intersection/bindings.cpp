#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>

#include <cmath>
#include <optional>
#include <tuple>

#include "binding/arrays.hpp"
#include "binding/released.hpp"
#include "intersection/strip_integrals.hpp"
#include "intersection/tracing.hpp"
#include "surfaces/callback_surface.hpp"
#include "surfaces/vectors.hpp"

namespace surfmesh::binding {

template <>
struct Row<FourNumbers> : RowOf<double, 4> {};

namespace {

using Corners = nb::ndarray<const double, nb::shape<-1, -1, 3>, nb::c_contig, nb::device::cpu>;
using CornerArray = nb::ndarray<nb::numpy, double, nb::shape<-1, -1, 3>>;
using Indices = Vector<std::int64_t>;
using Flags = Vector<std::uint8_t>;
using Widths = Matrix<double, 4>;
using Vector2 = nb::ndarray<const double, nb::shape<2>, nb::c_contig, nb::device::cpu>;

/// Throw what a caller's own surface raised.
void finish(const Surface& a, const Surface& b, const MeetingSurfaces& surfaces) {
    raise_failure(a, surfaces.a.status());
    raise_failure(b, surfaces.b.status());
}

auto pulled_onto_both(const Surface& a, const Surface& b, const Points2& uv_a, const Points2& uv_b,
                      const std::optional<Points3>& normal, const std::optional<Points3>& through,
                      const std::optional<Widths>& widths, int steps) {
    const std::size_t count = uv_a.shape(0);
    require_rows(uv_b.shape(0), count, "uv_b");
    if (normal.has_value() != through.has_value())
        throw nb::value_error("a plane has both a normal and a point");
    PullLimits limits;
    if (normal && through) {
        require_rows(normal->shape(0), count, "normal");
        require_rows(through->shape(0), count, "through");
        if (count > 0) limits = {rows<Point3>(*normal), rows<Point3>(*through), {}};
    }
    if (widths) {
        require_rows(widths->shape(0), count, "widths");
        limits.widths = rows<FourNumbers>(*widths);
    }
    MeetingSurfaces surfaces{SurfaceReader(a), SurfaceReader(b)};
    const auto found = released([&] {
        return pull_onto_both(surfaces, rows<Point2>(uv_a), rows<Point2>(uv_b), limits, steps);
    });
    finish(a, b, surfaces);
    return std::tuple(view(found.uv_a), view(found.uv_b), view(found.point), view(found.gap));
}

auto pulled_onto_curve(const Curve& curve, double first, double last, const Surface& surface,
                       const Vector<double>& fraction, const Points2& uv) {
    require_rows(uv.shape(0), fraction.shape(0), "uv");
    if (curve.dimension() != 3) throw nb::value_error("the curve lies in the plane");
    SurfaceReader reader(surface);
    Piercings found;
    {
        const nb::gil_scoped_release released;
        found =
            pull_onto_curve({curve, first, last}, reader, rows<double>(fraction), rows<Point2>(uv));
    }
    raise_failure(surface, reader.status());
    return std::tuple(view(found.fraction), view(found.uv), view(found.point), view(found.gap));
}

auto arrays_of(const CellBounds& bounds) {
    const std::size_t shape[] = {bounds.low.size(), bounds.corners_each, 3};
    const CornerArray corners(reinterpret_cast<double*>(bounds.corners.data()), 3, shape,
                              owner_of(bounds.corners));
    return std::tuple(view(bounds.low), view(bounds.high), corners, view(bounds.sag),
                      view(bounds.axis), view(bounds.angle));
}

auto cells_bounded(const Surface& surface, const Points2& lo, const Points2& hi) {
    require_rows(hi.shape(0), lo.shape(0), "hi");
    Array<ParameterBox> cells;
    for (std::size_t i = 0; i < lo.shape(0); ++i)
        cells.push_back({rows<Point2>(lo)[i], rows<Point2>(hi)[i]});
    SurfaceReader reader(surface);
    const auto bounds = released([&] { return bound_cells(reader, cells); });
    raise_failure(surface, reader.status());
    return arrays_of(bounds);
}

auto pieces_bounded(const Curve& curve, double first, double last, const Vector<double>& lo,
                    const Vector<double>& hi) {
    require_rows(hi.shape(0), lo.shape(0), "hi");
    if (curve.dimension() != 3) throw nb::value_error("the curve lies in the plane");
    Array<ParameterRange> ranges;
    for (std::size_t i = 0; i < lo.shape(0); ++i) ranges.push_back({lo.data()[i], hi.data()[i]});
    const nb::gil_scoped_release released;
    const CellBounds bounds = bound_pieces({curve, first, last}, ranges);
    const nb::gil_scoped_acquire held;
    return arrays_of(bounds);
}

/// Cells as Python keeps them: ``Boxes`` and ``Cones`` of surfmesh.intersection.bounds.
using BoxArrays = std::tuple<Points3, Points3, Corners, Points3>;
using ConeArrays = std::tuple<Points3, Vector<double>>;

CellView with_boxes(const BoxArrays& boxes) {
    const auto& [low, high, corners, sag] = boxes;
    require_rows(high.shape(0), low.shape(0), "high");
    require_rows(corners.shape(0), low.shape(0), "corners");
    require_rows(sag.shape(0), low.shape(0), "sag");
    const std::span<const Point3> every{reinterpret_cast<const Point3*>(corners.data()),
                                        corners.shape(0) * corners.shape(1)};
    return {rows<Point3>(low), rows<Point3>(high), every, rows<Point3>(sag), {}, {}};
}

CellView with_cones(const ConeArrays& cones) {
    const auto& [axis, angle] = cones;
    require_rows(angle.shape(0), axis.shape(0), "angle");
    return {{}, {}, {}, {}, rows<Point3>(axis), rows<double>(angle)};
}

/// For each pair of indices, the answer of a test.
template <class Test>
auto answers(const Indices& i, std::size_t count_i, const Indices& j, std::size_t count_j,
             Test test) {
    require_rows(j.shape(0), i.shape(0), "j");
    require_indices(rows<std::int64_t>(i), count_i, "i");
    require_indices(rows<std::int64_t>(j), count_j, "j");
    Array<std::uint8_t> found(i.shape(0));
    const nb::gil_scoped_release released;
    for (std::size_t k = 0; k < found.size(); ++k)
        found[static_cast<std::ptrdiff_t>(k)] =
            test(static_cast<std::size_t>(i.data()[k]), static_cast<std::size_t>(j.data()[k]));
    const nb::gil_scoped_acquire held;
    return view(found);
}

using Test = bool (*)(const CellView&, std::size_t, const CellView&, std::size_t);

template <Test test>
auto compared(const ConeArrays& one, const Indices& i, const ConeArrays& other, const Indices& j) {
    const CellView a = with_cones(one), b = with_cones(other);
    return answers(i, a.axis.size(), j, b.axis.size(),
                   [&](std::size_t k, std::size_t l) { return test(a, k, b, l); });
}

auto overlap(const BoxArrays& one, const Indices& i, const BoxArrays& other, const Indices& j,
             const Points3& axis) {
    const CellView a = with_boxes(one);
    CellView b = with_boxes(other);
    require_rows(axis.shape(0), b.low.size(), "axis");
    b.axis = rows<Point3>(axis);
    return answers(i, a.low.size(), j, b.low.size(),
                   [&](std::size_t k, std::size_t l) { return may_meet(a, k, b, l); });
}

std::optional<Point2> as_rate(const std::optional<Vector2>& rate) {
    if (!rate) return std::nullopt;
    return Point2{rate->data()[0], rate->data()[1]};
}

constexpr double LEAST_FIRST_STEP = 1e-280;  // its halves are no zeros

/// Row 0 is the start.
auto traced(const Surface& a, const Surface& b, const Points2& uv_a, const Points2& uv_b,
            const Points3& point, const Points3& way, const Flags& singular, double step,
            double gap, bool closed, const std::optional<Vector2>& rate_a,
            const std::optional<Vector2>& rate_b) {
    const std::size_t count = uv_a.shape(0);
    require_rows(uv_b.shape(0), count, "uv_b");
    require_rows(point.shape(0), count, "point");
    require_rows(way.shape(0), count, "way");
    require_rows(singular.shape(0), count, "singular");
    if (count < 1) throw nb::value_error("a branch has a start");
    if (!(step >= LEAST_FIRST_STEP && std::isfinite(step)))
        throw nb::value_error("the first step is a length");
    Array<TraceEnd> ends;
    for (std::size_t i = 0; i < count; ++i)
        ends.push_back({rows<Point2>(uv_a)[i], rows<Point2>(uv_b)[i], rows<Point3>(point)[i],
                        rows<Point3>(way)[i], singular.data()[i] != 0});
    MeetingSurfaces surfaces{SurfaceReader(a), SurfaceReader(b)};
    const auto branch = released([&] {
        return trace_branch(surfaces, ends[0], {as_rate(rate_a), as_rate(rate_b)},
                            std::span<const TraceEnd>(ends.data() + 1, count - 1),
                            {step, gap, closed});
    });
    finish(a, b, surfaces);
    return std::tuple(branch.found, branch.end + 1, view(branch.points), view(branch.uv_a),
                      view(branch.uv_b));
}

auto on_branch(const Surface& a, const Surface& b, const Points3& trace, const Points2& uv_a,
               const Points2& uv_b, const Points3& points, double tolerance) {
    require_rows(uv_a.shape(0), trace.shape(0), "uv_a");
    require_rows(uv_b.shape(0), trace.shape(0), "uv_b");
    MeetingSurfaces surfaces{SurfaceReader(a), SurfaceReader(b)};
    Array<std::uint8_t> found;
    {
        const nb::gil_scoped_release released;
        found =
            lie_on_branch(surfaces, {rows<Point3>(trace), rows<Point2>(uv_a), rows<Point2>(uv_b)},
                          rows<Point3>(points), tolerance);
    }
    finish(a, b, surfaces);
    return view(found);
}

constexpr int MOST_HALVINGS = 12;

auto integrals_over_strips(const Surface& surface, double fixed, const Points2& ends,
                           const Vector<double>& knots, const Vector<double>& places,
                           const Vector<double>& weights, double agree, int halvings,
                           const std::optional<Vector3>& origin) {
    require_rows(weights.shape(0), places.shape(0), "weights");
    if (places.shape(0) < 1) throw nb::value_error("a rule has one place at least");
    if (halvings < 0 || halvings > MOST_HALVINGS)
        throw nb::value_error("pieces are halved 0 to 12 times");
    std::optional<Point3> from;
    if (origin) from = point(*origin);
    SurfaceReader reader(surface);
    Array<double> found;
    {
        const nb::gil_scoped_release released;
        found =
            strip_integrals(reader, fixed, rows<Point2>(ends), rows<double>(knots),
                            {rows<double>(places), rows<double>(weights), agree, halvings}, from);
    }
    raise_failure(surface, reader.status());
    return view(found);
}

void bind_newton(nb::module_& m) {
    m.def("pull_onto_both", &pulled_onto_both, nb::arg("a"), nb::arg("b"), nb::arg("uv_a"),
          nb::arg("uv_b"), nb::arg("normal") = nb::none(), nb::arg("through") = nb::none(),
          nb::arg("widths") = nb::none(), nb::arg("steps") = NEWTON_STEPS,
          "Points on two surfaces near guesses (n, 2): uv_a, uv_b (n, 2), the points amid both "
          "(n, 3), the gaps (n,).\n\nnormal, through: (n, 3) planes in which they lie. widths: "
          "(n, 4) of u, v, s, t that count as equally long steps; None: in space.");
    m.def("pull_onto_curve", &pulled_onto_curve, nb::arg("curve"), nb::arg("first"),
          nb::arg("last"), nb::arg("surface"), nb::arg("fraction"), nb::arg("uv"),
          "Where a curve from ``first`` to ``last`` meets a surface, near guesses (n,), (n, 2): "
          "fractions (n,), uv (n, 2), points of the curve (n, 3), gaps (n,).");
}

void bind_bounds(nb::module_& m) {
    m.def("bound_cells", &cells_bounded, nb::arg("surface"), nb::arg("lo"), nb::arg("hi"),
          "Boxes around a surface over cells with the corners lo, hi (n, 2), and cones of its "
          "normals: low, high (n, 3), corners (n, 4, 3), sag (n, 3), axis (n, 3), angle (n,).");
    m.def("bound_pieces", &pieces_bounded, nb::arg("curve"), nb::arg("first"), nb::arg("last"),
          nb::arg("lo"), nb::arg("hi"),
          "The same for a curve from ``first`` to ``last`` over its fractions lo to hi (n,), with "
          "cones of its directions; corners (n, 2, 3).");
    m.def("overlap", &overlap, nb::arg("one"), nb::arg("i"), nb::arg("other"), nb::arg("j"),
          nb::arg("axis"),
          "May cell i of the one and cell j of the other meet? (n,) 0 or 1.\n\nBoxes: low, high, "
          "corners, sag. axis: (m, 3) of the other, along which slabs are compared too.");
    m.def("cross_surely", &compared<&cross_surely>, nb::arg("one"), nb::arg("i"), nb::arg("other"),
          nb::arg("j"), "Is no normal of cell i parallel to one of cell j? (n,) 0 or 1.");
    m.def("pierces_surely", &compared<&pierces_surely>, nb::arg("one"), nb::arg("i"),
          nb::arg("other"), nb::arg("j"),
          "Is no direction of piece i at right angles to a normal of cell j? (n,) 0 or 1.");
}

}  // namespace

void bind_intersection(nb::module_& m) {
    m.doc() = "Two surfaces that meet: places on both, bounds over cells, traced branches.";
    bind_newton(m);
    bind_bounds(m);
    m.def("trace_branch", &traced, nb::arg("a"), nb::arg("b"), nb::arg("uv_a"), nb::arg("uv_b"),
          nb::arg("point"), nb::arg("way"), nb::arg("singular"), nb::arg("step"), nb::arg("gap"),
          nb::arg("closed"), nb::arg("rate_a") = nb::none(), nb::arg("rate_b") = nb::none(),
          "The branch from row 0 of (m, ...) arrays of ends along its way, to one of the others: "
          "whether it came to one, its row, the points (n, 3), their uv_a, uv_b (n, 2).\n\n"
          "rate_a, rate_b: (2,) of u and v along the way at the start, where the surfaces do not "
          "say. step: the first; gap: what is on both surfaces.");
    m.def("strip_integrals", &integrals_over_strips, nb::arg("surface"), nb::arg("fixed"),
          nb::arg("ends"), nb::arg("knots"), nb::arg("places"), nb::arg("weights"),
          nb::arg("agree"), nb::arg("halvings"), nb::arg("origin") = nb::none(),
          "Integrals (n,) over u from ``fixed`` to ends (n, 2), each at its v: of the area, or of "
          "the volume between the surface and an origin.\n\nplaces, weights: a rule over [0, 1], "
          "used between all knots (k,), which rise, and on halves until two results agree, "
          "relative to "
          "the integral of the absolute value.");
    m.def("lie_on_branch", &on_branch, nb::arg("a"), nb::arg("b"), nb::arg("trace"),
          nb::arg("uv_a"), nb::arg("uv_b"), nb::arg("points"), nb::arg("tolerance"),
          "Which points (n, 3), on both surfaces, lie on a traced branch? (n,) 0 or 1.");
}

}  // namespace surfmesh::binding
