#include "surfaces/spline_surface.hpp"

#include <limits>

namespace surfmesh {
namespace {

constexpr double NOT_A_NUMBER = std::numeric_limits<double>::quiet_NaN();
constexpr Point2 NOWHERE{NOT_A_NUMBER, NOT_A_NUMBER};

/// The derivatives of one point, in their sequence.
template <int order>
using PointDerivatives = std::array<Point3, derivative_count(order)>;

/// Derivatives of r from those of w r and of w; A4.4.
template <int order>
void divide_by_weight(PointDerivatives<order>& r,
                      const std::array<double, derivative_count(order)>& weight) {
    const double inverse = 1.0 / weight[0];
    for (std::size_t number = 0; number < r.size(); ++number) {
        const auto [k, l] = DERIVATIVES[number];
        Point3 value = r[number];
        double outer = 1.0;  // binomial coefficients k over i, and l over j
        for (int i = 0; i <= k; ++i) {
            double inner = outer;
            for (int j = 0; j <= l; ++j) {
                if (i + j > 0)
                    value = value - inner * weight[derivative_number(i, j)] *
                                        r[derivative_number(k - i, l - j)];
                inner = inner * (l - j) / (j + 1);
            }
            outer = outer * (k - i) / (i + 1);
        }
        r[number] = inverse * value;
    }
}

/// A sum of vectors times numbers.
template <class Number>
struct Sum {
    Number x, y, z;

    template <class Vector>
    void add(Number factor, const Vector& v) {
        x = x + factor * v.x;
        y = y + factor * v.y;
        z = z + factor * v.z;
    }
};

/// Those of all derivatives, and of the weights.
template <class Number, std::size_t count>
struct ControlSums {
    std::array<Sum<Number>, count> r;
    std::array<Number, count> weight;
};

}  // namespace

Array<Point3> SplineSurface::control_of(std::int64_t u_span, std::int64_t v_span) const {
    Array<Point3> found;
    const Point3* row = control_.data() + corner_at(u_span, v_span);
    for (std::size_t a = 0; a <= u_.degree(); ++a, row += columns_)
        for (std::size_t b = 0; b <= v_.degree(); ++b) found.push_back(row[b]);
    return found;
}

/// Sums over the control points from one corner on, for all derivatives: about the one in the
/// middle, times weights where there are some, and sums of these.
template <int order, bool rational, class Number>
auto SplineSurface::sums_at(std::int64_t corner, const FunctionsOfSpline<Number>& by_u,
                            const FunctionsOfSpline<Number>& by_v) const {
    constexpr std::size_t COUNT = derivative_count(order);
    const auto rows = static_cast<std::int64_t>(u_.degree()) + 1;
    const auto columns = static_cast<std::int64_t>(v_.degree()) + 1;
    const Point3 middle = control_[middle_from(corner)];
    ControlSums<Number, COUNT> all{};
    for (std::int64_t a = 0; a < rows; ++a) {
        const Point3* control = control_.data() + corner + a * columns_;
        const double* weights = weights_.data() + (rational ? corner + a * columns_ : 0);
        std::array<Sum<Number>, order + 1> sums{};  // of the row, for each derivative by v
        std::array<Number, order + 1> weight_sums{};
        for (std::int64_t b = 0; b < columns; ++b) {
            Point3 x = control[b] - middle;
            if constexpr (rational) x = weights[b] * x;
            for (int l = 0; l <= order; ++l) {
                sums[l].add(by_v[l][b], x);
                if constexpr (rational) weight_sums[l] = weight_sums[l] + by_v[l][b] * weights[b];
            }
        }
        for (std::size_t number = 0; number < COUNT; ++number) {
            const auto [k, l] = DERIVATIVES[number];
            all.r[number].add(by_u[k][a], sums[l]);
            if constexpr (rational)
                all.weight[number] = all.weight[number] + by_u[k][a] * weight_sums[l];
        }
    }
    return all;
}

template <int order, bool rational>
void SplineSurface::evaluate_as(std::span<const Point2> uv, std::span<Point3> out) const {
    constexpr std::size_t COUNT = derivative_count(order);
    SplineFunctions by_u(u_.degree(), order), by_v(v_.degree(), order);
    PairsOfSplineFunctions both_by_u(u_.degree(), order), both_by_v(v_.degree(), order);
    const auto put = [&](std::size_t point, std::int64_t corner, const auto& sums, auto part) {
        PointDerivatives<order> r;
        std::array<double, COUNT> weight{};
        for (std::size_t number = 0; number < COUNT; ++number) {
            const auto& sum = sums.r[number];
            r[number] = {part(sum.x), part(sum.y), part(sum.z)};
            if constexpr (rational) weight[number] = part(sums.weight[number]);
        }
        if constexpr (rational) divide_by_weight<order>(r, weight);
        r[0] = r[0] + control_[middle_from(corner)];
        for (std::size_t number = 0; number < COUNT; ++number)
            out[number * uv.size() + point] = r[number];
    };
    KnotPlace u{}, v{};
    Point2 known = NOWHERE;  // what by_u and by_v are of
    for (std::size_t point = 0; point < uv.size(); ++point) {
        const Point2 here = uv[point];
        // points often lie in rows, along which one parameter is the same
        const bool is_new = here.x != known.x && here.y != known.y;
        if (here.x != known.x) u = u_.locate(here.x);
        if (here.y != known.y) v = v_.locate(here.y);
        const std::int64_t corner = corner_at(u.span, v.span);
        if (is_new && point + 1 < uv.size() && uv[point + 1].x != here.x &&
            uv[point + 1].y != here.y) {
            const KnotPlace next_u = u_.locate(uv[point + 1].x),
                            next_v = v_.locate(uv[point + 1].y);
            if (next_u.span == u.span && next_v.span == v.span) {
                both_by_u.evaluate(u_, u.span, {u.t, next_u.t});
                both_by_v.evaluate(v_, v.span, {v.t, next_v.t});
                const auto sums = sums_at<order, rational>(corner, both_by_u, both_by_v);
                put(point, corner, sums, [](TwoNumbers n) { return n.first; });
                put(++point, corner, sums, [](TwoNumbers n) { return n.second; });
                known = NOWHERE;
                continue;
            }
        }
        if (here.x != known.x) by_u.evaluate(u_, u);
        if (here.y != known.y) by_v.evaluate(v_, v);
        known = here;
        put(point, corner, sums_at<order, rational>(corner, by_u, by_v),
            [](double x) { return x; });
    }
}

SurfaceStatus SplineSurface::evaluate(std::span<const Point2> uv, int order,
                                      std::span<Point3> out) const {
    const bool rational = !weights_.empty();
    switch (order) {
        case 0:
            rational ? evaluate_as<0, true>(uv, out) : evaluate_as<0, false>(uv, out);
            break;
        case 1:
            rational ? evaluate_as<1, true>(uv, out) : evaluate_as<1, false>(uv, out);
            break;
        case 2:
            rational ? evaluate_as<2, true>(uv, out) : evaluate_as<2, false>(uv, out);
            break;
        case 3:
            rational ? evaluate_as<3, true>(uv, out) : evaluate_as<3, false>(uv, out);
            break;
        default:
            return SurfaceStatus::UNKNOWN;
    }
    return SurfaceStatus::DONE;
}

}  // namespace surfmesh
