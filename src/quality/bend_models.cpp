#include "quality/bend_models.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace surfmesh {
namespace {

bool is_finite(Point3 p) { return norm_1(p) < std::numeric_limits<double>::infinity(); }

}  // namespace

double most_between(double a, double b, double c) {
    const double amid = larger_or_nan(larger_or_nan(a, b), c) / 4.0;
    if (!(a * (b + c - a) > 0.0 && b * (c + a - b) > 0.0 && c * (a + b - c) > 0.0)) return amid;
    const double inner = 2.0 * (a * b + b * c + c * a) - a * a - b * b - c * c;
    return larger_or_nan(inner > 0.0 ? a * b * c / inner : 0.0, amid);
}

BendModel::BendModel(Point2 centre, const HighDerivatives& there, const HighDerivatives& over)
    : centre_(centre), known_(true) {
    constexpr std::size_t THIRD = BENDS, FOURTH = THIRD + 4;
    for (std::size_t j = 0; j < BENDS; ++j) {
        second_[j] = there.mid[j];
        second_off_[j] = there.rad[j];
    }
    for (std::size_t j = 0; j < third_.size(); ++j) {
        third_[j] = there.mid[THIRD + j];
        third_off_[j] = there.rad[THIRD + j];
    }
    for (std::size_t j = 0; j < fourth_.size(); ++j) {
        fourth_[j] = 0.5 * over.mid[FOURTH + j];
        fourth_off_[j] = 0.5 * over.rad[FOURTH + j];
        known_ = known_ && is_finite(fourth_[j]) && is_finite(fourth_off_[j]);
    }
    for (std::size_t j = 0; j < FOURTH; ++j)
        known_ = known_ && is_finite(there.mid[j]) && is_finite(there.rad[j]);
}

MiddleBends BendModel::over(const ParameterBox& box) const {
    const Point2 step = 0.5 * (box.low + box.high) - centre_, half = 0.5 * (box.high - box.low);
    const double s = step.x, t = step.y, a = half.x, b = half.y;
    const double reach_s = std::abs(s) + a, reach_t = std::abs(t) + b;
    MiddleBends found;
    for (std::size_t j = 0; j < BENDS; ++j) {
        const Point3 &ss = fourth_[j], &st = fourth_[j + 1], &tt = fourth_[j + 2];
        // the slopes in the middle of the box
        const Point3 slope_s = third_[j] + 2.0 * (s * ss + t * st),
                     slope_t = third_[j + 1] + 2.0 * (s * st + t * tt);
        found.middle[j] = second_[j] + s * third_[j] + t * third_[j + 1] + (s * s) * ss +
                          (2.0 * s * t) * st + (t * t) * tt;
        found.half[j] = a * sizes(slope_s) + b * sizes(slope_t) + (a * a) * sizes(ss) +
                        (2.0 * a * b) * sizes(st) + (b * b) * sizes(tt) + second_off_[j] +
                        reach_s * third_off_[j] + reach_t * third_off_[j + 1] +
                        (reach_s * reach_s) * fourth_off_[j] +
                        (2.0 * reach_s * reach_t) * fourth_off_[j + 1] +
                        (reach_t * reach_t) * fourth_off_[j + 2];
    }
    return found;
}

SurfaceStatus bend_models(const FourthDerivatives& surface, std::span<const ParameterBox> cells,
                          Array<BendModel>& models) {
    const std::size_t count = cells.size();
    Array<ParameterBox> all(cells);
    for (const ParameterBox& cell : cells) {
        const Point2 centre = 0.5 * (cell.low + cell.high);
        all.push_back({centre, centre});
    }
    Array<HighDerivatives> found(2 * count);
    const auto status = surface.enclose_high(all, found);
    models.clear();
    for (std::size_t k = 0; k < count && status == SurfaceStatus::DONE; ++k) {
        const auto over = static_cast<std::ptrdiff_t>(k);
        const auto there = static_cast<std::ptrdiff_t>(count + k);
        models.push_back({all[there].low, found[there], found[over]});
    }
    return status;
}

}  // namespace surfmesh
