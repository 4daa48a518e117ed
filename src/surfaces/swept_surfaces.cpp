#include "surfaces/swept_surfaces.hpp"

#include "elementary_functions/sine_cosine.hpp"

namespace surfmesh {

SurfaceStatus ExtrusionSurface::evaluate(std::span<const Point2> uv, int order,
                                         std::span<Point3> out) const {
    const std::size_t count = uv.size();
    Array<double> t(count);
    for (std::size_t i = 0; i < count; ++i) t[i] = uv[i].x;
    const CurveValues c(*curve_, {t.data(), count}, order);
    for (std::size_t number = 0; number < derivative_count(order); ++number) {
        const auto [k, l] = DERIVATIVES[number];
        for (std::size_t i = 0; i < count; ++i) {
            Point3& value = out[number * count + i];
            if (number == 0)
                value = c[0][i] + uv[i].y * direction_;
            else if (l == 0)
                value = c[k][i];
            else
                value = number == 2 ? direction_ : Point3{0.0, 0.0, 0.0};
        }
    }
    return SurfaceStatus::DONE;
}

SurfaceStatus RevolutionSurface::evaluate(std::span<const Point2> uv, int order,
                                          std::span<Point3> out) const {
    const std::size_t count = uv.size();
    Array<double> t(count);
    for (std::size_t i = 0; i < count; ++i) t[i] = uv[i].y;
    const CurveValues c(*curve_, {t.data(), count}, order);
    for (std::size_t i = 0; i < count; ++i) {
        const auto [sine, cosine] = elementary::sincos(uv[i].x);
        for (int l = 0; l <= order; ++l) {
            const Point3 q = l == 0 ? c[0][i] - origin_ : c[l][i];
            const Point3 along = dot(q, axis_) * axis_, across = q - along;
            const Point3 beside = cross(axis_, across);
            const Point3 turned = cosine * across + sine * beside;
            const Point3 ahead = cosine * beside - sine * across;  // its derivative
            for (int k = 0; k + l <= order; ++k) {
                const auto number = derivative_number(k, l);
                const Point3 value = k % 2 == 0 ? turned : ahead;
                Point3& result = out[number * count + i];
                result = k < 2 ? value : -1.0 * value;
                if (k == 0) result = result + along;
                if (number == 0) result = result + origin_;
            }
        }
    }
    return SurfaceStatus::DONE;
}

}  // namespace surfmesh
