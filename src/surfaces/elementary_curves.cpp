#include "surfaces/elementary_curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "elementary_functions/hyperbolic.hpp"
#include "elementary_functions/sine_cosine.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t PARAMETERS_AT_ONCE = 64;  // parameters whose sines are computed at a time

}  // namespace

void Line::evaluate(std::span<const double> t, int order, std::span<Point3> out) const {
    for (std::size_t i = 0; i < t.size(); ++i) out[i] = origin_ + t[i] * direction_;
    if (order < 1) return;
    const auto rest = out.subspan(t.size());
    std::fill(rest.begin(), rest.end(), Point3{0.0, 0.0, 0.0});
    std::fill_n(rest.begin(), t.size(), direction_);
}

Point2 Conic::on_parabola(double t, int derivative) const {
    switch (derivative) {
        case 0:
            return {t * t / (4.0 * major_), t};
        case 1:
            return {t / (2.0 * major_), 1.0};
        case 2:
            return {1.0 / (2.0 * major_), 0.0};
        default:
            return {0.0, 0.0};
    }
}

/// The cosines and sines of a block, or the hyperbolic ones: what f and g of the others are of.
void Conic::compute_functions(std::span<const double> t, std::span<double> f,
                              std::span<double> g) const {
    if (kind_ == ConicKind::ELLIPSE) elementary::sincos(t, g, f);
    if (kind_ != ConicKind::HYPERBOLA) return;
    elementary::cosh(t, f);
    elementary::sinh(t, g);
}

void Conic::evaluate(std::span<const double> t, int order, std::span<Point3> out) const {
    const auto& [origin, x, y] = axes_;
    std::array<double, PARAMETERS_AT_ONCE> first{}, second{};
    for (std::size_t start = 0; start < t.size(); start += PARAMETERS_AT_ONCE) {
        const std::size_t count = std::min(PARAMETERS_AT_ONCE, t.size() - start);
        compute_functions(t.subspan(start, count), {first.data(), count}, {second.data(), count});
        for (std::size_t i = 0; i < count; ++i) {
            double f = first[i], g = second[i];
            for (int k = 0; k <= order; ++k) {
                const Point2 at = kind_ == ConicKind::PARABOLA ? on_parabola(t[start + i], k)
                                                               : Point2{major_ * f, minor_ * g};
                const Point3 value = at.x * x + at.y * y;
                out[static_cast<std::size_t>(k) * t.size() + start + i] =
                    k == 0 ? origin + value : value;
                std::swap(f, g);
                if (kind_ == ConicKind::ELLIPSE) f = -f;
            }
        }
    }
}

}  // namespace surfmesh
