#include "surfaces/elementary_curves.hpp"

#include <algorithm>
#include <cmath>

#include "elementary_functions/sine_cosine.hpp"

namespace surfmesh {

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

void Conic::evaluate(std::span<const double> t, int order, std::span<Point3> out) const {
    const auto& [origin, x, y] = axes_;
    for (std::size_t i = 0; i < t.size(); ++i) {
        double f = 0.0, g = 0.0;  // cosine and sine, or the hyperbolic ones
        if (kind_ == ConicKind::ELLIPSE) {
            const elementary::SineCosine turn = elementary::sincos(t[i]);
            f = turn.cosine;
            g = turn.sine;
        } else if (kind_ == ConicKind::HYPERBOLA) {
            f = std::cosh(t[i]);
            g = std::sinh(t[i]);
        }
        for (int k = 0; k <= order; ++k) {
            const Point2 at = kind_ == ConicKind::PARABOLA ? on_parabola(t[i], k)
                                                           : Point2{major_ * f, minor_ * g};
            const Point3 value = at.x * x + at.y * y;
            out[static_cast<std::size_t>(k) * t.size() + i] = k == 0 ? origin + value : value;
            std::swap(f, g);
            if (kind_ == ConicKind::ELLIPSE) f = -f;
        }
    }
}

}  // namespace surfmesh
