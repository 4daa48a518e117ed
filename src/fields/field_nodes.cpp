#include "fields/field_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace surfmesh {
namespace {

constexpr double ALIKE = 1.01;  // ratio up to which they are one size: on flat places `along` is
                                // round-off

template <class T>
void extend(Array<T>& array, const Array<T>& more) {
    const std::size_t first = array.size();
    array.resize(first + more.size());
    std::copy(more.begin(), more.end(), array.begin() + first);
}

/// Square root of the symmetric (e f; f g), s = sqrt(det): (I + s Id) / t, t^2 = tr I + 2 s.
SizeTensor symmetric_root(SizeTensor i, double s) {
    const double t = std::sqrt(std::max(i.xx + i.yy + 2.0 * s, std::numeric_limits<double>::min()));
    return {(i.xx + s) / t, i.xy / t, (i.yy + s) / t};
}

double inverse_square(double x) { return 1.0 / (x * x); }

}  // namespace

bool FieldNodes::is_complete() const {
    const std::size_t n = size.size(), m = is_anisotropic() ? n : 0;
    return target_size.size() == n && root.size() == n && normal.size() == n && point.size() == n &&
           longer.size() == m && longer_target.size() == m && along.size() == m &&
           jacobian.size() == m && asked.size() == m && curvature.size() == m &&
           turn_rates.size() == m;
}

void FieldNodes::append(const FieldNodes& others) {
    extend(size, others.size);
    extend(target_size, others.target_size);
    extend(root, others.root);
    extend(normal, others.normal);
    extend(point, others.point);
    extend(longer, others.longer);
    extend(longer_target, others.longer_target);
    extend(along, others.along);
    extend(jacobian, others.jacobian);
    extend(asked, others.asked);
    extend(curvature, others.curvature);
    extend(turn_rates, others.turn_rates);
}

bool FieldNodes::is_round(std::ptrdiff_t node) const {
    return asked[node].second <= ALIKE * asked[node].first;
}

void FieldNodes::put_in_order() {
    for (std::size_t n = 0; n < longer.size(); ++n) {
        if (longer[n] >= size[n]) continue;
        along[n] = cross(normal[n], along[n]);
        std::swap(size[n], longer[n]);
    }
}

SizeTensor FieldNodes::metric_root(std::ptrdiff_t n) const {
    const SizeTensor r = root[n];
    const double h = size[n];
    if (!is_anisotropic()) return {r.xx / h, r.xy / h, r.yy / h};
    // M = I / h^2 - (1 / h^2 - 1 / longer^2) p p^T, with p = J^T along
    const auto& j = jacobian[n].x;
    const Point3 t = along[n];
    const double p = j[0][0] * t.x + j[1][0] * t.y + j[2][0] * t.z;
    const double q = j[0][1] * t.x + j[1][1] * t.y + j[2][1] * t.z;
    const double e = r.xx * r.xx + r.xy * r.xy, f = r.xy * (r.xx + r.yy);
    const double g = r.xy * r.xy + r.yy * r.yy;
    const double scale = inverse_square(h), less = scale - inverse_square(longer[n]);
    // det M without cancellation, as det I = det(root)^2
    const double det = (r.xx * r.yy - r.xy * r.xy) / (h * longer[n]);
    return symmetric_root(
        {scale * e - less * p * p, scale * f - less * p * q, scale * g - less * q * q},
        std::max(det, 0.0));
}

Array<MetricRoot3> FieldNodes::metric_roots_3d() const {
    Array<MetricRoot3> found;
    found.reserve(longer.size());
    for (std::size_t n = 0; n < longer.size(); ++n) {
        const double inverse = 1.0 / size[n], less = inverse - 1.0 / longer[n];
        const Point3 t = along[n], s = -less * t;
        found.push_back({s.x * t.x + inverse, s.x * t.y, s.x * t.z, s.y * t.y + inverse, s.y * t.z,
                         s.z * t.z + inverse});
    }
    return found;
}

}  // namespace surfmesh
