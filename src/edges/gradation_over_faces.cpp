#include "edges/gradation_over_faces.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "edges/sample_ranges.hpp"
#include "values/threads.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t BLOCK = 8;       // segments of an edge that are looked at together
constexpr double CHANGE = 1e-3;        // relative: a size is not lowered for less
constexpr double ROUNDING = 1e-12;     // relative: sizes that are told apart by less are the same
constexpr double MARGIN = 1.0 + 1e-6;  // of a bound: rounding does not reach so far
constexpr double LESS = MARGIN * (1.0 - CHANGE);  // of a size: it is lowered to less alone
constexpr double OF_SIZE = 0.25;    // samples are no farther apart than this part of a size,
constexpr double MOST_STRIDE = 16;  // and each stands for no more of those that there are
constexpr std::size_t EDGES_A_BLOCK = 256;
constexpr std::size_t FACES_A_BLOCK = 1;  // the largest are often side by side

/// Some of the samples of each edge, its ends among them.
///
/// Samples lie as dense as curves may need; what grows across faces needs a few for each size.
struct ThinnedEdges {
    Array<std::int64_t> first, row;  // of the edges; of the samples, among all
    Array<Point3> points;
    Array<double> sizes;

    ThinnedEdges(const EdgeNetwork& edges, const Array<double>& all) {
        Array<std::int64_t> steps(edges.ends.size());
        for_each_block(steps.size(), EDGES_A_BLOCK, [&](std::size_t from, std::size_t to) {
            for (std::size_t e = from; e < to; ++e)
                steps.data()[e] = stride(edges, all, edges.first[e], edges.first[e + 1]);
        });
        count_kept(edges, steps);
        const auto kept = static_cast<std::size_t>(first.back());
        row = Array<std::int64_t>::unfilled(kept);
        points = Array<Point3>::unfilled(kept);
        sizes = Array<double>::unfilled(kept);
        for_each_block(steps.size(), EDGES_A_BLOCK, [&](std::size_t from, std::size_t to) {
            for (std::size_t e = from; e < to; ++e) put(edges, all, e, steps.data()[e]);
        });
    }

    /// Lower sizes of all samples to those between the thinned ones.
    void lower(std::span<const double> thinned, Array<double>& all) const {
        for (std::size_t e = 0; e + 1 < first.size(); ++e)
            for (std::int64_t k = first[e]; k + 1 < first[e + 1]; ++k) {
                if (!(thinned[k] < sizes[k] || thinned[k + 1] < sizes[k + 1])) continue;
                const auto steps = static_cast<double>(row[k + 1] - row[k]);
                for (std::int64_t i = row[k]; i <= row[k + 1]; ++i) {
                    const double t = static_cast<double>(i - row[k]) / steps;
                    all[i] = std::min(all[i], (1.0 - t) * thinned[k] + t * thinned[k + 1]);
                }
            }
    }

  private:
    /// Where the samples that are kept of each edge begin.
    void count_kept(const EdgeNetwork& edges, const Array<std::int64_t>& steps) {
        first = Array<std::int64_t>(steps.size() + 1, 0);
        for (std::size_t e = 0; e < steps.size(); ++e) {
            const std::int64_t last = edges.first[e + 1] - edges.first[e] - 1, step = steps[e];
            first[e + 1] = first[e] + (last < 0 ? 0 : 1 + (last + step - 1) / step);
        }
    }

    void put(const EdgeNetwork& edges, const Array<double>& all, std::size_t e, std::int64_t step) {
        const std::int64_t last = edges.first[e + 1] - 1;
        for (std::int64_t k = first[e], i = edges.first[e]; k < first[e + 1]; ++k, i += step) {
            const std::int64_t from = std::min(i, last);
            row[k] = from;
            points[k] = edges.points[from];
            sizes[k] = all[from];
        }
    }

    /// How many steps from sample to sample are no longer than a fraction of any size there.
    static std::int64_t stride(const EdgeNetwork& edges, const Array<double>& all,
                               std::int64_t begin, std::int64_t end) {
        double longest = 0.0, smallest = INFINITE_SIZE;
        for (std::int64_t i = begin; i < end; ++i) {
            smallest = std::min(smallest, all[i]);
            if (i == begin) continue;
            const Point3 step = edges.points[i] - edges.points[i - 1];
            longest = std::max(longest, dot(step, step));
        }
        const double most =  // nan: no length
            std::min(OF_SIZE * smallest / std::sqrt(longest), MOST_STRIDE);
        return most > 1.0 ? static_cast<std::int64_t>(most) : 1;
    }
};

class GradationOverFaces {
  public:
    GradationOverFaces(const EdgeNetwork& edges, const EdgesOfFaces& faces, double slope,
                       double least_step)
        : edges_(edges), faces_(faces), slope_(slope), along_(edges, slope, least_step) {}

    /// asked: graded along edges. is_lower: edges from which sizes have not grown yet.
    Array<double> sizes(std::span<const double> asked, const Array<std::uint8_t>& is_lower) {
        sizes_ = Array<double>(asked);
        const std::size_t count = edges_.ends.size();
        for (const std::uint8_t lower : is_lower) lowered_.push_back(lower);
        ranges_.resize(count);
        first_block_.resize(count + 1, 0);
        for (std::size_t e = 0; e < count; ++e) first_block_[e + 1] = first_block_[e] + blocks(e);
        blocks_.resize(first_block_[count]);
        for_each_block(count, EDGES_A_BLOCK, [&](std::size_t from, std::size_t to) {
            for (std::size_t e = from; e < to; ++e) find_ranges(e);
        });
        for (int round = 1; cross_faces(round); ++round) {
            const Array<double> before = sizes_;
            sizes_ = along_.graded(before);
            for (std::size_t e = 0; e < count; ++e)
                if (!std::equal(&before.data()[edges_.first[e]],
                                &before.data()[edges_.first[e + 1]],
                                &sizes_.data()[edges_.first[e]]))
                    renew(e, round + 1);
        }
        return std::move(sizes_);
    }

  private:
    struct Rows {
        std::size_t first, last;  // and behind the last
    };

    [[nodiscard]] Rows samples(std::size_t e) const {
        return {static_cast<std::size_t>(edges_.first[e]),
                static_cast<std::size_t>(edges_.first[e + 1])};
    }
    [[nodiscard]] std::size_t blocks(std::size_t e) const {
        const Rows own = samples(e);
        return own.last < own.first + 2 ? 0 : (own.last - own.first - 2) / BLOCK + 1;
    }
    /// The samples of one block, which shares its ends with its neighbours.
    [[nodiscard]] Rows block(std::size_t e, std::size_t k) const {
        const Rows own = samples(e);
        const std::size_t first = own.first + k * BLOCK;
        return {first, std::min(first + BLOCK + 1, own.last)};
    }

    [[nodiscard]] SampleRange range(Rows rows) const {
        SampleRange found;
        for (std::size_t i = rows.first; i < rows.last; ++i) {
            found.box.add(edges_.points[i]);
            found.add(sizes_.data()[i]);
        }
        return found;
    }

    void find_ranges(std::size_t e) {
        for (std::size_t k = 0; k < blocks(e); ++k)
            blocks_[first_block_[e] + k] = range(block(e, k));
        ranges_[e] = blocks(e) == 0 ? range(samples(e)) : SampleRange{};
        for (std::size_t k = 0; k < blocks(e); ++k) ranges_[e].add(blocks_[first_block_[e] + k]);
    }

    /// The sizes of an edge were lowered in some round.
    void renew(std::size_t e, int round) {
        lowered_[e] = round;
        find_ranges(e);
    }

    [[nodiscard]] std::span<const std::int64_t> edges_of(std::size_t face) const {
        return faces_.edges.subspan(
            static_cast<std::size_t>(faces_.first[face]),
            static_cast<std::size_t>(faces_.first[face + 1] - faces_.first[face]));
    }

    /// Let sizes grow across all faces that have an edge lowered in the last round or in this one.
    /// Says whether any size was lowered.
    bool cross_faces(int round) {
        const Array<std::uint8_t> idle = idle_faces(round);
        SampleBoxes boxes;
        bool any = false;
        for (std::size_t f = 0; f < idle.size(); ++f) {
            const auto own = edges_of(f);
            const auto is_as_before = [&](std::int64_t edge) { return lowered_[edge] <= round; };
            if (idle.data()[f] && std::all_of(own.begin(), own.end(), is_as_before)) continue;
            for_pairs(own, round, boxes, [&](std::size_t from, std::size_t to) {
                bool is_lower = false;
                grow(from, to, [&](std::size_t i, double size) {
                    sizes_.data()[i] = size;
                    return is_lower = true;
                });
                if (is_lower) renew(to, round + 1);
                any = any || is_lower;
                return true;
            });
        }
        return any;
    }

    /// Of the faces: would no size be lowered across it as all are now? Threads find that of many
    /// faces, so that few are left to be crossed in turn; one thread alone crosses all of them.
    [[nodiscard]] Array<std::uint8_t> idle_faces(int round) const {
        Array<std::uint8_t> idle(faces_.first.size() - 1, 0);
        if (allowed_threads() < 2) return idle;
        for_each_block(idle.size(), FACES_A_BLOCK, [&](std::size_t first, std::size_t last) {
            SampleBoxes boxes;
            for (std::size_t f = first; f < last; ++f) {
                bool is_idle = true;
                for_pairs(edges_of(f), round, boxes, [&](std::size_t from, std::size_t to) {
                    grow(from, to, [&](std::size_t, double) { return is_idle = false; });
                    return is_idle;
                });
                idle.data()[f] = is_idle;
            }
        });
        return idle;
    }

    /// Call visit(from, to) for edges of one face, the first of which was lowered and may lower the
    /// second, as long as it says yes.
    template <class Visit>
    void for_pairs(std::span<const std::int64_t> own, int round, SampleBoxes& boxes,
                   const Visit& visit) const {
        double coarsest = 0.0;
        for (const std::int64_t edge : own)
            coarsest = std::max(coarsest, ranges_[static_cast<std::size_t>(edge)].largest);
        boxes.clear();
        for (const std::int64_t from : own) {
            if (lowered_[from] < round) continue;
            const SampleRange& source = ranges_[static_cast<std::size_t>(from)];
            const double above = LESS * coarsest - source.smallest;
            if (!(above > 0.0)) continue;
            if (boxes.empty())
                for (const std::int64_t edge : own)
                    boxes.add(ranges_[static_cast<std::size_t>(edge)].box);
            const Array<double>& ways = boxes.squared_ways(source.box);
            for (std::size_t k = 0; k < own.size(); ++k) {
                if (!(slope_ * slope_ * ways.data()[k] < above * above)) continue;  // see may_lower
                if (own[k] == from) continue;  // by itself an edge is graded already
                if (!visit(static_cast<std::size_t>(from), static_cast<std::size_t>(own[k])))
                    return;
            }
        }
    }

    /// May sizes that grow from one range lower those of the other?
    [[nodiscard]] bool may_lower(const SampleRange& from, const SampleRange& to) const {
        const double above = LESS * to.largest - from.smallest;
        return above > 0.0 && slope_ * slope_ * squared_way(from.box, to.box) < above * above;
    }

    /// Call lower(i, size) for samples of one edge that are coarser than what grows to them from
    /// another one, as long as it says yes.
    template <class Lower>
    void grow(std::size_t from, std::size_t to, const Lower& lower) const {
        if (!may_lower(ranges_[from], ranges_[to])) return;
        for (std::size_t i = 0; i < blocks(from); ++i) {
            const SampleRange& source = blocks_[first_block_[from] + i];
            if (!may_lower(source, ranges_[to])) continue;
            for (std::size_t k = 0; k < blocks(to); ++k)
                if (may_lower(source, blocks_[first_block_[to] + k]) &&
                    !grow(source, block(from, i), block(to, k), lower))
                    return;
        }
    }

    template <class Lower>
    bool grow(const SampleRange& source, Rows from, Rows to, const Lower& lower) const {
        for (std::size_t i = to.first; i < to.last; ++i) {
            const double size = sizes_.data()[i];
            SampleRange here;
            here.box.add(edges_.points[i]);
            here.add(size);
            if (!may_lower(source, here)) continue;
            const double most = (1.0 - CHANGE) * size;
            double least = most;
            for (std::size_t j = from.first; j + 1 < from.last; ++j)
                if (may_be_below(MARGIN * least, j, edges_.points[i]))
                    least = std::min(least, grown_from(j, edges_.points[i]));
            if (least < most && !lower(i, least)) return false;
        }
        return true;
    }

    /// May what grows to a point from the segment between samples j and j + 1 be less than a size?
    /// Told by the box around the segment, without a root.
    [[nodiscard]] bool may_be_below(double size, std::size_t j, Point3 point) const {
        SampleBox segment, here;
        segment.add(edges_.points[j]);
        segment.add(edges_.points[j + 1]);
        here.add(point);
        const double smaller = std::min(sizes_.data()[j], sizes_.data()[j + 1]);
        const double above = size - smaller;
        return above > 0.0 && slope_ * slope_ * squared_way(segment, here) < above * above;
    }

    /// What grows to a point from the segment between samples j and j + 1.
    ///
    /// The formula of Hopf and Lax (Bornemann and Rasch 2006, section 3): with q and p the
    /// coordinates of the point along the segment and away from it, and k the rise of the sizes
    /// along it per length over the slope, the least is reached at q - k p / sqrt(1 - k^2).
    [[nodiscard]] double grown_from(std::size_t j, Point3 point) const {
        const Point3 a = edges_.points[j], ab = edges_.points[j + 1] - a, way = point - a;
        const double ha = sizes_.data()[j], hb = sizes_.data()[j + 1];
        const double l = norm(ab);
        const double least =
            std::min(ha + slope_ * norm(way), hb + slope_ * norm(edges_.points[j + 1] - point));
        if (!(l > 0.0)) return least;
        const double q = dot(way, ab) / l, p = std::sqrt(std::max(dot(way, way) - q * q, 0.0));
        const double k = (hb - ha) / (l * slope_), free = 1.0 - k * k;
        if (!(free > 0.0)) return least;
        const double root = std::sqrt(free), at = q - k * p / root;
        if (!(at > 0.0 && at < l)) return least;
        return std::min(least, ha + slope_ * (k * q + p * root));
    }

    const EdgeNetwork& edges_;
    const EdgesOfFaces& faces_;
    double slope_;
    EdgeGradation along_;
    Array<double> sizes_;
    Array<std::int32_t> lowered_;      // of the edges: the last round that lowered one
    std::vector<SampleRange> ranges_;  // of the edges
    std::vector<SampleRange> blocks_;
    std::vector<std::size_t> first_block_;  // of the edges, and how many there are
};

/// The edges of which a size is smaller than before, by more than rounding; all where none are
/// known.
Array<std::uint8_t> lowered_edges(const EdgeNetwork& edges, const Array<double>& sizes,
                                  std::span<const double> before) {
    Array<std::uint8_t> found(edges.ends.size(), before.empty());
    for (std::size_t e = 0; !before.empty() && e < edges.ends.size(); ++e)
        for (std::int64_t i = edges.first[e]; i < edges.first[e + 1]; ++i)
            if (sizes.data()[i] < (1.0 - ROUNDING) * before[static_cast<std::size_t>(i)])
                found.data()[e] = 1;
    return found;
}

}  // namespace

Array<double> graded_over_faces(const EdgeNetwork& edges, const EdgesOfFaces& faces,
                                std::span<const double> sizes, double slope, double least_step,
                                std::span<const double> before) {
    const EdgeGradation along(edges, slope, least_step);
    Array<double> asked(sizes);
    for (std::size_t i = 0; i < before.size(); ++i)
        asked.data()[i] = std::min(asked.data()[i], before[i]);
    Array<double> found = along.graded(asked);
    const Array<std::uint8_t> is_lower = lowered_edges(edges, found, before);
    if (std::none_of(is_lower.begin(), is_lower.end(), [](std::uint8_t lower) { return lower; }))
        return found;
    const ThinnedEdges thinned(edges, found);
    const EdgeNetwork few{thinned.points, thinned.first, edges.ends, edges.vertices};
    const Array<double> graded =
        GradationOverFaces(few, faces, slope, least_step).sizes(thinned.sizes, is_lower);
    if (std::equal(graded.begin(), graded.end(), thinned.sizes.begin())) return found;
    thinned.lower(graded, found);
    return along.graded(found);
}

}  // namespace surfmesh
