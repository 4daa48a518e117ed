#include "quality/histogram.hpp"

#include <algorithm>
#include <cmath>

namespace surfmesh {

Array<std::int64_t> binned_counts(std::span<const double> values, double low, double high,
                                  std::size_t bins) {
    Array<std::int64_t> counts(bins, 0);
    const double scale = static_cast<double>(bins) / (high - low);
    const double last = static_cast<double>(bins) - 1.0;
    for (const double value : values) {
        if (!std::isfinite(value)) continue;
        const double place = std::min(std::max((value - low) * scale, 0.0), last);
        ++counts[static_cast<std::size_t>(place)];
    }
    return counts;
}

}  // namespace surfmesh
