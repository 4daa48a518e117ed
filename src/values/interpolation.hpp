// Values of a piecewise linear function.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace surfmesh {

/// Goes through (at[i], value[i]) and is constant beyond; at: one or more places that do not fall.
class Interpolation {
  public:
    Interpolation(std::span<const double> at, std::span<const double> value)
        : at_(at), value_(value) {}

    double operator()(double x) const {
        const std::size_t last = at_.size() - 1;
        if (x > at_[last]) return value_[last];
        if (x < at_[0]) return value_[0];
        const auto after = std::upper_bound(at_.begin(), at_.end(), x);
        const std::size_t j = static_cast<std::size_t>(after - at_.begin()) - 1;
        if (j == last || at_[j] == x) return value_[j];
        const double slope = (value_[j + 1] - value_[j]) / (at_[j + 1] - at_[j]);
        const double found = slope * (x - at_[j]) + value_[j];
        return std::isnan(found) ? slope * (x - at_[j + 1]) + value_[j + 1] : found;
    }

  private:
    std::span<const double> at_, value_;
};

}  // namespace surfmesh
