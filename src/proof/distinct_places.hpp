// Each place of the (u, v) plane once, though many triangles have it: corners, and points of sides.
//
// In: places. Out: the distinct ones, in the order in which they come first, and the number of each.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

class DistinctPlaces {
  public:
    explicit DistinctPlaces(std::span<const Point2> places) : number_(places.size()) {
        const std::size_t slots = std::bit_ceil(2 * places.size() + 1);
        Array<std::int32_t> table(slots, -1);
        for (std::size_t k = 0; k < places.size(); ++k) {
            const Point2 p = places[k];
            std::size_t slot = hash(p) & (slots - 1);
            while (table[slot] >= 0 && !same(all_[table[slot]], p)) slot = (slot + 1) & (slots - 1);
            if (table[slot] < 0) {
                table[slot] = static_cast<std::int32_t>(all_.size());
                all_.push_back(p);
            }
            number_[k] = table[slot];
        }
    }
    [[nodiscard]] std::span<const Point2> all() const { return {all_.data(), all_.size()}; }
    /// Of the k-th place that came in.
    [[nodiscard]] std::int32_t at(std::size_t k) const { return number_[k]; }

  private:
    static bool same(Point2 a, Point2 b) { return a.x == b.x && a.y == b.y; }
    static std::uint64_t hash(Point2 p) {
        const auto x = std::bit_cast<std::uint64_t>(p.x + 0.0);  // -0 is 0
        const auto y = std::bit_cast<std::uint64_t>(p.y + 0.0);
        std::uint64_t mixed = (x ^ (y << 1 | y >> 63)) * 0x9e3779b97f4a7c15U;
        mixed ^= mixed >> 29;
        return (mixed * 0xbf58476d1ce4e5b9U) >> 20;
    }

    Array<std::int32_t> number_;
    Array<Point2> all_;
};

}  // namespace surfmesh
