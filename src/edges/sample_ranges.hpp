// Samples next to each other along an edge: the box around them and the range of their sizes.
//
// Which tell, before any two samples are looked at, that sizes growing from some samples lower none
// of others.
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

inline constexpr double INFINITE_SIZE = std::numeric_limits<double>::infinity();

/// A bounding box.
struct SampleBox {
    Point3 low{INFINITE_SIZE, INFINITE_SIZE, INFINITE_SIZE};
    Point3 high{-INFINITE_SIZE, -INFINITE_SIZE, -INFINITE_SIZE};

    void add(Point3 p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
};

/// Square of the distance between two boxes.
inline double squared_way(const SampleBox& a, const SampleBox& b) {
    const auto apart = [](double low_a, double high_a, double low_b, double high_b) {
        return std::max(std::max(low_a - high_b, low_b - high_a), 0.0);
    };
    const Point3 way{apart(a.low.x, a.high.x, b.low.x, b.high.x),
                     apart(a.low.y, a.high.y, b.low.y, b.high.y),
                     apart(a.low.z, a.high.z, b.low.z, b.high.z)};
    return dot(way, way);
}

/// Samples next to each other: where they are, and the range of their sizes.
struct SampleRange {
    SampleBox box;
    double smallest = INFINITE_SIZE, largest = 0.0;

    void add(double size) {
        smallest = std::min(smallest, size);
        largest = std::max(largest, size);
    }
    void add(const SampleRange& other) {
        box.add(other.box.low);
        box.add(other.box.high);
        smallest = std::min(smallest, other.smallest);
        largest = std::max(largest, other.largest);
    }
};

/// Boxes in rows of numbers, so that several are looked at together.
class SampleBoxes {
  public:
    [[nodiscard]] bool empty() const { return rows_[0].empty(); }
    void clear() {
        for (Array<double>& row : rows_) row.clear();
    }
    void add(const SampleBox& box) {
        const double values[] = {box.low.x,  box.low.y,  box.low.z,
                                 box.high.x, box.high.y, box.high.z};
        for (std::size_t k = 0; k < 6; ++k) rows_[k].push_back(values[k]);
    }

    /// ``squared_way`` of each to one box.
    const Array<double>& squared_ways(const SampleBox& to) {
        const std::size_t count = rows_[0].size();
        ways_.resize(count);
        const double *lx = rows_[0].data(), *ly = rows_[1].data(), *lz = rows_[2].data();
        const double *hx = rows_[3].data(), *hy = rows_[4].data(), *hz = rows_[5].data();
        double* way = ways_.data();
        for (std::size_t i = 0; i < count; ++i) {
            const double x = std::max(std::max(to.low.x - hx[i], lx[i] - to.high.x), 0.0);
            const double y = std::max(std::max(to.low.y - hy[i], ly[i] - to.high.y), 0.0);
            const double z = std::max(std::max(to.low.z - hz[i], lz[i] - to.high.z), 0.0);
            way[i] = x * x + y * y + z * z;
        }
        return ways_;
    }

  private:
    std::array<Array<double>, 6> rows_;
    Array<double> ways_;
};

}  // namespace surfmesh
