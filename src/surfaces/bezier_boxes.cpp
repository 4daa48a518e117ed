#include "surfaces/bezier_boxes.hpp"

#include <algorithm>

#include "surfaces/boxed_vectors.hpp"

namespace surfmesh {
namespace {

using DerivativeRanges = std::array<Interval, derivative_count(3)>;

/// Of A / w, in the sequence of derivatives; s: the range of the quotient itself.
DerivativeRanges quotient_ranges(const DerivativeRanges& a, const DerivativeRanges& w, Interval s,
                                 std::size_t order) {
    constexpr std::array<std::array<double, 4>, 4> OVER = {
        {{1.0, 0.0, 0.0, 0.0}, {1.0, 1.0, 0.0, 0.0}, {1.0, 2.0, 1.0, 0.0}, {1.0, 3.0, 3.0, 1.0}}};
    DerivativeRanges found{};
    found[0] = s;
    for (std::size_t n = 1; n <= order; ++n)
        for (std::size_t l = 0; l <= n; ++l) {
            const std::size_t k = n - l;
            Interval sum = a[derivative_number(k, l)];
            for (std::size_t i = 0; i <= k; ++i)
                for (std::size_t j = 0; j <= l; ++j) {
                    if (i + j == 0) continue;
                    const Interval term = outward::multiply(w[derivative_number(i, j)],
                                                            found[derivative_number(k - i, l - j)]);
                    const Interval times = outward::exactly(OVER[k][i] * OVER[l][j]);
                    sum = outward::subtract(sum, outward::multiply(times, term));
                }
            found[derivative_number(k, l)] = outward::divide(sum, w[0]);
        }
    return found;
}

/// What is asked of one net.
class NetBounds {
  public:
    NetBounds(const BezierNet& net, int order, const BezierCorner* corner, BezierWork& work)
        : net_(net),
          order_(order),
          corner_(corner),
          count_(net.rows * net.columns),
          numbers_(work.numbers.data(), count_),
          differences_(work.differences.data(), 2 * count_) {
        if (!net.is_rational) return;
        const Homogeneous& c = net.control[(net.rows / 2) * net.columns + net.columns / 2];
        about_ = {c[0] / c[3], c[1] / c[3], c[2] / c[3]};
        const std::span<double> weights(work.weights.data(), count_);
        for (std::size_t k = 0; k < count_; ++k) weights[k] = net.control[k][3];
        least_weight_ = *std::min_element(weights.begin(), weights.end());
        weight_ = ranges_of(weights, net.error);
    }

    [[nodiscard]] DerivativeRanges along(Point3 direction) const {
        return net_.is_rational ? of_quotient(direction) : of_polynomial(direction);
    }

  private:
    [[nodiscard]] DerivativeRanges ranges_of(std::span<const double> values, double error) const {
        const BezierNumbers given{net_.rows,    net_.columns,  net_.width_u,
                                  net_.width_v, values.data(), error};
        DerivativeRanges found{};
        derivative_ranges(given, order_, corner_, differences_, found);
        return found;
    }
    [[nodiscard]] DerivativeRanges of_polynomial(Point3 direction) const {
        for (std::size_t k = 0; k < count_; ++k) {
            const Homogeneous& x = net_.control[k];
            numbers_[k] = dot(direction, Point3{x[0], x[1], x[2]});
        }
        return ranges_of(numbers_, 4.0 * net_.error);
    }
    [[nodiscard]] DerivativeRanges of_quotient(Point3 direction) const {
        const double moved = net_.error * (5.0 + norm(about_));
        NumberRange quotients;
        for (std::size_t k = 0; k < count_; ++k) {
            const Homogeneous& x = net_.control[k];
            numbers_[k] = dot(direction, Point3{x[0], x[1], x[2]} - x[3] * about_);
            if (corner_ == nullptr || k == at_corner()) quotients.take(numbers_[k] / x[3]);
        }
        const double off = quotient_error(4.0 * moved, net_.error, net_.largest, least_weight_);
        const bool is_known = off < intervals::INFINITE && weight_[0].lo > 0.0;
        const Interval s = is_known ? quotients.scaled(1.0, off) : UNBOUNDED;
        DerivativeRanges found = quotient_ranges(ranges_of(numbers_, 4.0 * moved), weight_, s,
                                                 static_cast<std::size_t>(order_));
        found[0] =
            outward::add(found[0], outward::along_between(direction, {0.0, 0.0, 0.0}, about_));
        return found;
    }
    [[nodiscard]] std::size_t at_corner() const {
        return (corner_->last_u ? count_ - net_.columns : 0) +
               (corner_->last_v ? net_.columns - 1 : 0);
    }

    const BezierNet& net_;
    int order_;
    const BezierCorner* corner_;
    std::size_t count_;
    std::span<double> numbers_, differences_;
    Point3 about_{0.0, 0.0, 0.0};
    double least_weight_ = 1.0;
    DerivativeRanges weight_{};
};

}  // namespace

DerivativeBoxes boxes_of_net(const BezierNet& net, const Directions& directions, int order,
                             const BezierCorner* corner, BezierWork& work) {
    const NetBounds bounds(net, order, corner, work);
    DerivativeBoxes boxes{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const DerivativeRanges found = bounds.along(directions[axis]);
        for (std::size_t k = 0; k < found.size(); ++k)
            outward::coordinate(boxes[k], axis) = found[k];
    }
    return boxes;
}

}  // namespace surfmesh
