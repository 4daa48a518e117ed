// Metric length along the samples of an edge.
#pragma once

#include <cstddef>
#include <span>

#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

/// From the first sample to each of them, the sum of 2 |dx| / (h + h').
inline void metric_lengths(std::span<const Point3> points, std::span<const double> sizes,
                           Array<double>& found) {
    found.clear();
    found.push_back(0.0);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const double step = norm(points[i + 1] - points[i]);
        found.push_back(found.back() + 2.0 * step / (sizes[i + 1] + sizes[i]));
    }
}

}  // namespace surfmesh
