// Bounds of derivatives over ranges: of lines and conics in closed form, of curves on surfaces by
// those of the surface and of the p-curve.
#include <algorithm>
#include <cmath>

#include "elementary_functions/hyperbolic.hpp"
#include "surfaces/curve_on_surface.hpp"
#include "surfaces/elementary_curves.hpp"

namespace surfmesh {
namespace {

Point3 absolute(Point3 p) { return {std::abs(p.x), std::abs(p.y), std::abs(p.z)}; }

double hypotenuse(double a, double b) { return std::sqrt(a * a + b * b); }

double farthest(const ParameterRange& range) {
    return std::max(std::abs(range.first), std::abs(range.last));
}

}  // namespace

bool Line::derivative_magnitudes(std::span<const ParameterRange> ranges, int order,
                                 std::span<Point3> out) const {
    std::fill(out.begin(), out.end(), Point3{0.0, 0.0, 0.0});
    for (std::size_t i = 0; i < ranges.size(); ++i)
        out[i * static_cast<std::size_t>(order + 1) + 1] = absolute(direction_);
    return true;
}

bool Conic::derivative_magnitudes(std::span<const ParameterRange> ranges, int order,
                                  std::span<Point3> out) const {
    const Point3 x = absolute(axes_.x), y = absolute(axes_.y);
    const double a = std::abs(major_), b = std::abs(minor_);
    const auto rows = static_cast<std::size_t>(order + 1);
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        out[i * rows] = {0.0, 0.0, 0.0};
        for (int k = 1; k <= order; ++k) {
            Point3& value = out[i * rows + static_cast<std::size_t>(k)];
            if (kind_ == ConicKind::ELLIPSE) {
                value = {hypotenuse(a * x.x, b * y.x), hypotenuse(a * x.y, b * y.y),
                         hypotenuse(a * x.z, b * y.z)};
            } else if (kind_ == ConicKind::HYPERBOLA) {
                value = elementary::cosh(farthest(ranges[i])) * (a * x + b * y);
            } else {
                const Point2 at = on_parabola(farthest(ranges[i]), k);
                value = std::abs(at.x) * x + std::abs(at.y) * y;
            }
        }
    }
    return true;
}

bool CurveOnSurface::derivative_magnitudes(std::span<const ParameterRange> ranges, int order,
                                           std::span<Point3> out) const {
    if (order > 2) return false;
    Array<ParameterRange> own;
    Array<double> middles;
    for (const auto& [first, last] : ranges) {
        own.push_back({shift_ + rate_ * first, shift_ + rate_ * last});
        middles.push_back(shift_ + rate_ * 0.5 * (first + last));
    }
    Array<Point3> plane(3 * ranges.size());
    if (!pcurve_->derivative_magnitudes(own, 2, plane)) return false;
    const CurveValues middle(*pcurve_, middles, 0);
    Array<ParameterBox> boxes;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        const auto k = static_cast<std::ptrdiff_t>(i);
        const double half = 0.5 * std::abs(own[k].last - own[k].first);
        const Point2 at{middle[0][i].x, middle[0][i].y};
        const Point2 reach{half * plane[3 * k + 1].x, half * plane[3 * k + 1].y};
        boxes.push_back({at - reach, at + reach});
    }
    Array<Point3> r(6 * ranges.size());
    if (surface_->derivative_magnitudes(boxes, 2, r) != SurfaceStatus::DONE) return false;
    const double rate = std::abs(rate_);
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        const Point3 *s = r.data() + 6 * i, *p = plane.data() + 3 * i;
        const double du = rate * p[1].x, dv = rate * p[1].y;
        Point3* value = out.data() + i * static_cast<std::size_t>(order + 1);
        value[0] = {0.0, 0.0, 0.0};
        value[1] = du * s[1] + dv * s[2];
        if (order < 2) continue;
        value[2] = du * du * s[3] + (2.0 * du * dv) * s[4] + dv * dv * s[5] +
                   (rate * rate * p[2].x) * s[1] + (rate * rate * p[2].y) * s[2];
    }
    return true;
}

}  // namespace surfmesh
