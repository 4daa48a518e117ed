#include "insertion/inside_regions.hpp"

#include <algorithm>
#include <bit>
#include <vector>

namespace surfmesh {
namespace {

using Word = std::uint64_t;
constexpr std::size_t BITS = 64;

/// Sets of loops, one for each region or segment: bit k tells of loop k.
class LoopSets {
  public:
    LoopSets(std::size_t sets, std::size_t loops)
        : words_((loops + BITS - 1) / BITS), bits_(sets * words_, 0) {}

    [[nodiscard]] std::size_t words() const { return words_; }
    [[nodiscard]] Word word(std::size_t set, std::size_t k) const {
        return bits_[set * words_ + k];
    }
    void set_word(std::size_t set, std::size_t k, Word word) { bits_[set * words_ + k] = word; }
    void flip(std::size_t set, std::size_t loop) {
        bits_[set * words_ + loop / BITS] ^= Word{1} << (loop % BITS);
    }

  private:
    std::size_t words_;
    std::vector<Word> bits_;
};

/// For each region the segments along it: those of region r are ``segment[first[r] ..]``.
struct SegmentsOfRegions {
    std::vector<std::size_t> first;
    std::vector<std::int32_t> segment;

    SegmentsOfRegions(std::span<const SegmentSides> sides, std::size_t regions)
        : first(regions + 2, 0), segment(2 * sides.size()) {
        for (const SegmentSides& s : sides) {
            ++first[s.left + 2];
            ++first[s.right + 2];
        }
        for (std::size_t r = 2; r < first.size(); ++r) first[r] += first[r - 1];
        for (std::size_t k = 0; k < sides.size(); ++k) {
            segment[first[sides[k].left + 1]++] = static_cast<std::int32_t>(k);
            segment[first[sides[k].right + 1]++] = static_cast<std::int32_t>(k);
        }
    }
};

/// Walks from the infinite region over segments, and knows of each region the loops around it.
class RegionWalk {
  public:
    RegionWalk(std::span<const SegmentSides> sides, std::size_t regions,
               std::span<const LoopSegment> loop_segments, std::size_t loops)
        : sides_(sides),
          along_(sides, regions),
          crossed_(sides.size(), loops),
          around_(regions, loops),
          reached_(regions, 0) {
        for (const LoopSegment& pair : loop_segments) crossed_.flip(pair.segment, pair.loop);
    }

    /// The region that contradicts, or NIL.
    std::int32_t walk_from(std::int32_t infinite) {
        std::vector<std::int32_t> queue{infinite};
        reached_[infinite] = 1;
        for (std::size_t next = 0; next < queue.size(); ++next) {
            const std::int32_t region = queue[next];
            for (std::size_t i = along_.first[region]; i < along_.first[region + 1]; ++i) {
                const std::int32_t k = along_.segment[i];
                const SegmentSides& s = sides_[k];
                const std::int32_t other = s.left == region ? s.right : s.left;
                if (!reached_[other]) {
                    reached_[other] = 1;
                    queue.push_back(other);
                    for (std::size_t w = 0; w < around_.words(); ++w)
                        around_.set_word(other, w, across(region, k, w));
                }
                for (std::size_t w = 0; w < around_.words(); ++w)
                    if (around_.word(other, w) != across(region, k, w)) return other;
            }
        }
        return NIL;
    }

    [[nodiscard]] std::int32_t first_unreached() const {
        const auto at = std::find(reached_.begin(), reached_.end(), 0);
        return at == reached_.end() ? NIL : static_cast<std::int32_t>(at - reached_.begin());
    }

    /// Does the region lie in more outer loops than holes? ``holes``: one set of loops.
    [[nodiscard]] bool is_inside(std::size_t region, const LoopSets& holes) const {
        int outer = 0, hole = 0;
        for (std::size_t w = 0; w < around_.words(); ++w) {
            outer += std::popcount(around_.word(region, w) & ~holes.word(0, w));
            hole += std::popcount(around_.word(region, w) & holes.word(0, w));
        }
        return outer > hole;
    }

  private:
    /// The loops around what lies on the other side of segment k.
    [[nodiscard]] Word across(std::int32_t region, std::int32_t k, std::size_t w) const {
        return around_.word(region, w) ^ crossed_.word(k, w);
    }

    std::span<const SegmentSides> sides_;
    SegmentsOfRegions along_;
    LoopSets crossed_, around_;
    std::vector<char> reached_;
};

}  // namespace

InsideRegions inside_regions(std::span<const SegmentSides> sides,
                             std::span<const LoopSegment> loop_segments,
                             std::span<const std::uint8_t> is_hole, std::int32_t infinite) {
    std::int32_t last = infinite;
    for (const SegmentSides& s : sides) last = std::max({last, s.left, s.right});
    const auto regions = static_cast<std::size_t>(last) + 1;
    RegionWalk walk(sides, regions, loop_segments, is_hole.size());
    const std::int32_t contradicting = walk.walk_from(infinite);
    if (contradicting >= 0) return {{}, Recovery::different_loops, contradicting};
    const std::int32_t lost = walk.first_unreached();
    if (lost >= 0) return {{}, Recovery::unreachable_region, lost};
    LoopSets holes(1, is_hole.size());
    for (std::size_t k = 0; k < is_hole.size(); ++k)
        if (is_hole[k]) holes.flip(0, k);
    InsideRegions found{Array<std::uint8_t>(regions, 0)};
    for (std::size_t r = 0; r < regions; ++r) found.inside[r] = walk.is_inside(r, holes);
    return found;
}

}  // namespace surfmesh
