#include "surfaces/spline_curve.hpp"

namespace surfmesh {

void SplineCurve::evaluate(std::span<const double> t, int order, std::span<Point3> out) const {
    const auto degree = static_cast<std::int64_t>(basis_.degree());
    const bool rational = !weights_.empty();
    SplineFunctions functions(basis_.degree(), order);
    Array<double> weight_sums(static_cast<std::size_t>(order + 1));
    for (std::size_t point = 0; point < t.size(); ++point) {
        const KnotPlace place = basis_.locate(t[point]);
        functions.evaluate(basis_, place);
        const std::int64_t first = place.span - degree;
        const Point3 middle = control_[place.span - degree / 2];
        const auto derivative = [&](int k) -> Point3& {
            return out[static_cast<std::size_t>(k) * t.size() + point];
        };
        for (int k = 0; k <= order; ++k) {
            Point3 sum{0.0, 0.0, 0.0};
            double weight_sum = 0.0;
            for (std::int64_t a = 0; a <= degree; ++a) {
                Point3 x = control_[first + a] - middle;
                if (rational) {
                    x = weights_[first + a] * x;
                    weight_sum += functions[k][a] * weights_[first + a];
                }
                sum = sum + functions[k][a] * x;
            }
            if (rational) {  // A4.2
                weight_sums[k] = weight_sum;
                double binomial = 1.0;
                for (int i = 1; i <= k; ++i) {
                    binomial = binomial * (k - i + 1) / i;
                    sum = sum - binomial * weight_sums[i] * derivative(k - i);
                }
                const double w = weight_sums[0];
                sum = {sum.x / w, sum.y / w, sum.z / w};
            }
            derivative(k) = sum;
        }
        derivative(0) = derivative(0) + middle;
    }
}

}  // namespace surfmesh
