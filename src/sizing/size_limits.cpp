#include "sizing/size_limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "elementary_functions/inverse_trigonometric.hpp"
#include "elementary_functions/power.hpp"
#include "elementary_functions/sine_cosine.hpp"

namespace surfmesh {
namespace {

constexpr double UNLIMITED = std::numeric_limits<double>::infinity();
constexpr double TINY = std::numeric_limits<double>::min();

/// Square of |W e|.
double square_along(const MetricRoot3& w, Point3 e) {
    const Point3 found = apply(w, e);
    return found.x * found.x + found.y * found.y + found.z * found.z;
}

/// e^T W f
double form(const MetricRoot3& w, Point3 e, Point3 f) {
    const double square = w.xx * e.x * f.x + w.yy * e.y * f.y + w.zz * e.z * f.z;
    return square + (w.xy * (e.x * f.y + e.y * f.x) + w.xz * (e.x * f.z + e.z * f.x) +
                     w.yz * (e.y * f.z + e.z * f.y));
}

/// A unit vector at right angles to a unit normal.
Point3 across(Point3 n) {
    const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
    const Point3 axis = x <= y && x <= z ? Point3{1.0, 0.0, 0.0}
                        : y <= z         ? Point3{0.0, 1.0, 0.0}
                                         : Point3{0.0, 0.0, 1.0};
    const Point3 found = cross(n, axis);
    const double length = norm(found);
    return {found.x / length, found.y / length, found.z / length};
}

}  // namespace

SizeLimits::SizeLimits(std::span<const Point3> points, std::span<const double> sizes, double slope,
                       std::span<const MetricRoot3> metric_root_3d)
    : tree_(points), sizes_(sizes), slope_(slope), metric_root_3d_(metric_root_3d) {}

double SizeLimits::Here::least() const {
    double least = UNLIMITED;
    for (std::size_t k = 0; k < count_; ++k)
        least =
            std::min(least, limits_.sizes_[near_[k].number] + limits_.slope_ * near_[k].distance);
    return least;
}

double SizeLimits::Here::along(Point3 direction) const {
    if (limits_.metric_root_3d_.empty()) return least();
    double least = UNLIMITED;
    for (std::size_t k = 0; k < count_; ++k) {
        const double square = square_along(limits_.metric_root_3d_[near_[k].number], direction);
        const double inverse = std::max(std::sqrt(square), TINY);
        least = std::min(least, 1.0 / inverse + limits_.slope_ * near_[k].distance);
    }
    return least;
}

SizeLimits::Tightest SizeLimits::Here::tightest(Point3 normal) const {
    const Point3 first = across(normal), second = cross(normal, first);
    if (limits_.metric_root_3d_.empty()) return {least(), first};
    Tightest found{UNLIMITED, first};
    double best_b = 0.0, best_half = 0.0;
    for (std::size_t k = 0; k < count_; ++k) {
        const MetricRoot3& w = limits_.metric_root_3d_[near_[k].number];
        const double a = form(w, first, first), b = form(w, first, second);
        const double c = form(w, second, second), mean = 0.5 * (a + c), half = 0.5 * (a - c);
        const double largest = std::max(mean + elementary::hypot(half, b), TINY);
        const double size = 1.0 / largest + limits_.slope_ * near_[k].distance;
        if (k > 0 && !(size < found.size)) continue;
        found.size = size;
        best_b = b;
        best_half = half;
    }
    const auto [sine, cosine] = elementary::sincos(0.5 * elementary::atan2(best_b, best_half));
    found.direction = cosine * first + sine * second;
    return found;
}

}  // namespace surfmesh
