#include "surfaces/spline_polynomials.hpp"

#include <algorithm>
#include <utility>

#include "surfaces/closest_point.hpp"
#include "values/conventions.hpp"

namespace surfmesh {
namespace {

// of the extent of the control points: so large may the coefficients be together. They are summed
// with as many units of round-off as there are powers
constexpr double LARGEST_SUM = 32.0;
constexpr double NEAR_KNOT = 1e-9;  // of the knots' range: there the spline finds the span itself

/// Two points, or derivatives at two places.
struct PairOfPoints {
    TwoNumbers x{}, y{}, z{};

    /// This times s, plus another.
    void continue_by(TwoNumbers s, const PairOfPoints& other) {
        x = x * s + other.x;
        y = y * s + other.y;
        z = z * s + other.z;
    }
    void continue_by(TwoNumbers s, Point3 other) {
        x = x * s + other.x;
        y = y * s + other.y;
        z = z * s + other.z;
    }
    [[nodiscard]] Point3 first() const { return {x.first, y.first, z.first}; }
    [[nodiscard]] Point3 second() const { return {x.second, y.second, z.second}; }
};

/// A polynomial and its first derivatives in s and t at two places.
struct PairOfPlanes {
    PairOfPoints r, by_s, by_t;
};

/// Horner's rule in t within that in s.
template <int order>
PairOfPlanes sums_at(const Point3* coefficient, std::size_t rows, std::size_t columns, TwoNumbers s,
                     TwoNumbers t) {
    PairOfPlanes sums;
    for (std::size_t k = 0; k < rows; ++k) {
        PairOfPoints row, slope;
        for (std::size_t l = 0; l < columns; ++l) {
            if constexpr (order > 0) slope.continue_by(t, row);
            row.continue_by(t, *coefficient++);
        }
        if constexpr (order > 0) {
            sums.by_s.continue_by(s, sums.r);
            sums.by_t.continue_by(s, slope);
        }
        sums.r.continue_by(s, row);
    }
    return sums;
}

/// Of a range, with what searches for a nearest point may look at beside it.
PreparedSpans spans_over(const SplineBasis& basis, double low, double high) {
    const double beside = PROJECTION_MARGIN * (high - low);
    return {basis, low - beside, high + beside};
}

}  // namespace

PreparedSpans::PreparedSpans(const SplineBasis& basis, double low, double high)
    : basis_(&basis), number_(basis.knots().size(), NIL) {
    const std::span<const double> knots = basis.knots();
    const double near =
        NEAR_KNOT * (knots[knots.size() - basis.degree() - 1] - knots[basis.degree()]);
    const auto [first, last] = basis.spans(low, high);
    for (std::int64_t span = first; span <= last; ++span) {
        const double start = knots[static_cast<std::size_t>(span)],
                     end = knots[static_cast<std::size_t>(span) + 1];
        if (!(start < end)) continue;
        number_[span] = static_cast<std::int32_t>(spans_.size());
        spans_.push_back(
            {span, start + near, end - near, 0.5 * (start + end), 2.0 / (end - start)});
    }
}

PreparedSpans::Place PreparedSpans::located(double t) const {
    const KnotPlace place = basis_->locate(t);
    const std::int32_t number = number_[place.span];
    if (number == NIL) return {NIL, 0.0};
    return {number, spans_[number].rate * (place.t - spans_[number].middle)};
}

Array<double> PreparedSpans::series(std::int32_t number) const {
    const Prepared& of = spans_[number];
    const auto degree = static_cast<int>(basis_->degree());
    SplineFunctions functions(basis_->degree(), degree);
    functions.evaluate(*basis_, {of.span, of.middle});
    Array<double> found;
    double factor = 1.0;
    for (int k = 0; k <= degree; ++k) {
        if (k > 0) factor /= k * of.rate;
        for (int a = 0; a <= degree; ++a) found.push_back(factor * functions[k][a]);
    }
    return found;
}

SplinePolynomials::SplinePolynomials(std::shared_ptr<const SplineSurface> spline, PreparedSpans u,
                                     PreparedSpans v)
    : FaceSurface(spline->domain()),
      spline_(std::move(spline)),
      u_(std::move(u)),
      v_(std::move(v)),
      rows_(spline_->u().degree() + 1),
      columns_(spline_->v().degree() + 1) {}

std::shared_ptr<SplinePolynomials> SplinePolynomials::of(
    std::shared_ptr<const SplineSurface> spline, std::size_t most) {
    if (spline->is_rational()) return nullptr;
    const auto [low, high] = spline->domain();
    const PreparedSpans u = spans_over(spline->u(), low.x, high.x),
                        v = spans_over(spline->v(), low.y, high.y);
    if (u.size() == 0 || v.size() == 0 || u.size() * v.size() > most) return nullptr;
    const std::shared_ptr<SplinePolynomials> made(new SplinePolynomials(std::move(spline), u, v));
    for (std::size_t i = 0; i < u.size(); ++i)
        for (std::size_t j = 0; j < v.size(); ++j)
            if (!made->prepare(static_cast<std::int32_t>(i), static_cast<std::int32_t>(j)))
                return nullptr;
    return made;
}

/// The polynomial over a pair of spans; false where its coefficients are too large.
bool SplinePolynomials::prepare(std::int32_t u, std::int32_t v) {
    const Array<Point3> control = spline_->control_of(u_.span(u), v_.span(v));
    const Array<double> by_u = u_.series(u), by_v = v_.series(v);
    const Point3 about = control[static_cast<std::ptrdiff_t>(control.size() / 2)];
    const auto rows = static_cast<std::ptrdiff_t>(rows_),
               columns = static_cast<std::ptrdiff_t>(columns_);
    Array<Point3> along(rows_ * columns_);  // of row a of the control points, by powers of t
    double extent = 0.0, sum = 0.0;
    for (std::ptrdiff_t a = 0; a < rows; ++a)
        for (std::ptrdiff_t b = 0; b < columns; ++b) {
            const Point3 x = control[a * columns + b] - about;
            extent = std::max(extent, norm(x));
            for (std::ptrdiff_t l = 0; l < columns; ++l) {
                Point3& to = along[a * columns + l];
                to = to + by_v[l * columns + b] * x;
            }
        }
    for (std::ptrdiff_t k = rows - 1; k >= 0; --k)
        for (std::ptrdiff_t l = columns - 1; l >= 0; --l) {
            Point3 coefficient{0.0, 0.0, 0.0};
            for (std::ptrdiff_t a = 0; a < rows; ++a)
                coefficient = coefficient + by_u[k * rows + a] * along[a * columns + l];
            coefficients_.push_back(coefficient);
            sum += norm(coefficient);
        }
    about_.push_back(about);
    return sum <= LARGEST_SUM * extent;
}

/// ``before``: a place whose spans are looked at first.
SplinePolynomials::Place SplinePolynomials::place_of(Point2 uv, const Place& before) const {
    return {u_.place_of(uv.x, std::max(before.u.number, 0)),
            v_.place_of(uv.y, std::max(before.v.number, 0))};
}

template <int order>
void SplinePolynomials::evaluate_as(std::span<const Point2> uv, std::span<Point3> out) const {
    const std::size_t count = uv.size();
    Place here{{0, 0.0}, {0, 0.0}};
    for (std::size_t i = 0; i < count; ++i) {
        here = place_of(uv[i], here);
        if (here.u.number == NIL || here.v.number == NIL) {
            std::array<Point3, derivative_count(order)> own;
            static_cast<void>(spline_->evaluate(uv.subspan(i, 1), order, own));  // never fails
            for (std::size_t k = 0; k < own.size(); ++k) out[k * count + i] = own[k];
            continue;
        }
        const Place next = i + 1 < count ? place_of(uv[i + 1], here) : here;
        const bool are_two =
            i + 1 < count && next.u.number == here.u.number && next.v.number == here.v.number;
        const Place& other = are_two ? next : here;
        const auto polynomial =
            static_cast<std::ptrdiff_t>(here.u.number * v_.size()) + here.v.number;
        const PairOfPlanes sums = sums_at<order>(
            coefficients_.data() + polynomial * static_cast<std::ptrdiff_t>(rows_ * columns_),
            rows_, columns_, {here.u.s, other.u.s}, {here.v.s, other.v.s});
        const auto put = [&](std::size_t point, Point3 r, Point3 by_s, Point3 by_t) {
            out[point] = r + about_[polynomial];
            if constexpr (order > 0) {
                out[count + point] = u_.rate(here.u.number) * by_s;
                out[2 * count + point] = v_.rate(here.v.number) * by_t;
            }
        };
        put(i, sums.r.first(), sums.by_s.first(), sums.by_t.first());
        if (are_two) put(++i, sums.r.second(), sums.by_s.second(), sums.by_t.second());
    }
}

SurfaceStatus SplinePolynomials::evaluate(std::span<const Point2> uv, int order,
                                          std::span<Point3> out) const {
    if (order > 1) return spline_->evaluate(uv, order, out);
    order == 0 ? evaluate_as<0>(uv, out) : evaluate_as<1>(uv, out);
    return SurfaceStatus::DONE;
}

}  // namespace surfmesh
