#include "surfaces/spline_surface.hpp"

namespace surfmesh {
namespace {

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

}  // namespace

template <int order, bool rational>
void SplineSurface::evaluate_as(std::span<const Point2> uv, std::span<Point3> out) const {
    constexpr std::size_t COUNT = derivative_count(order);
    const auto rows = static_cast<std::int64_t>(u_.degree()) + 1;
    const auto columns = static_cast<std::int64_t>(v_.degree()) + 1;
    SplineFunctions by_u(u_.degree(), order), by_v(v_.degree(), order);
    KnotPlace u{}, v{};
    for (std::size_t point = 0; point < uv.size(); ++point) {
        // points often lie in rows, along which one parameter is the same
        if (point == 0 || uv[point].x != uv[point - 1].x)
            by_u.evaluate(u_, u = u_.locate(uv[point].x));
        if (point == 0 || uv[point].y != uv[point - 1].y)
            by_v.evaluate(v_, v = v_.locate(uv[point].y));
        const std::int64_t corner = (u.span - rows + 1) * columns_ + v.span - columns + 1;
        const Point3 middle = control_[corner + (rows - 1) / 2 * columns_ + (columns - 1) / 2];
        PointDerivatives<order> r{};
        std::array<double, COUNT> weight{};
        for (std::int64_t a = 0; a < rows; ++a) {
            const Point3* control = control_.data() + corner + a * columns_;
            const double* weights = weights_.data() + (rational ? corner + a * columns_ : 0);
            std::array<Point3, order + 1> sums{};  // of the row, for each derivative by v
            std::array<double, order + 1> weight_sums{};
            for (std::int64_t b = 0; b < columns; ++b) {
                Point3 x = control[b] - middle;
                if constexpr (rational) x = weights[b] * x;
                for (int l = 0; l <= order; ++l) {
                    sums[l] = sums[l] + by_v[l][b] * x;
                    if constexpr (rational) weight_sums[l] += by_v[l][b] * weights[b];
                }
            }
            for (std::size_t number = 0; number < COUNT; ++number) {
                const auto [k, l] = DERIVATIVES[number];
                r[number] = r[number] + by_u[k][a] * sums[l];
                if constexpr (rational) weight[number] += by_u[k][a] * weight_sums[l];
            }
        }
        if constexpr (rational) divide_by_weight<order>(r, weight);
        r[0] = r[0] + middle;
        for (std::size_t number = 0; number < COUNT; ++number)
            out[number * uv.size() + point] = r[number];
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
