#include "edges/gradation_over_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "values/threads.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t BLOCK = 8;    // segments of an edge that are looked at together
constexpr double CHANGE = 1e-3;     // relative: a size is not lowered for less
constexpr double OF_SIZE = 0.25;    // samples are no farther apart than this part of a size,
constexpr double MOST_STRIDE = 16;  // and each stands for no more of those that there are
constexpr std::size_t THINNED_TOGETHER = 256;
constexpr double INFINITE_SIZE = std::numeric_limits<double>::infinity();

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
double squared_way(const SampleBox& a, const SampleBox& b) {
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

/// Some of the samples of each edge, its ends among them.
///
/// Samples lie as dense as curves may need; what grows across faces needs a few for each size.
struct ThinnedEdges {
    Array<std::int64_t> first, row;  // of the edges; of the samples, among all
    Array<Point3> points;
    Array<double> sizes;

    ThinnedEdges(const EdgeNetwork& edges, const Array<double>& all) {
        Array<std::int64_t> steps(edges.ends.size());
        for_each_block(steps.size(), THINNED_TOGETHER, [&](std::size_t from, std::size_t to) {
            for (std::size_t e = from; e < to; ++e)
                steps.data()[e] = stride(edges, all, edges.first[e], edges.first[e + 1]);
        });
        row.reserve(all.size());
        points.reserve(all.size());
        sizes.reserve(all.size());
        first.push_back(0);
        for (std::size_t e = 0; e < edges.ends.size(); ++e) {
            const std::int64_t begin = edges.first[e], end = edges.first[e + 1];
            for (std::int64_t i = begin; i < end; i += steps.data()[e]) add(edges, all, i);
            if (begin < end && row[row.size() - 1] != end - 1) add(edges, all, end - 1);
            first.push_back(static_cast<std::int64_t>(row.size()));
        }
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
    void add(const EdgeNetwork& edges, const Array<double>& all, std::int64_t i) {
        row.push_back(i);
        points.push_back(edges.points[i]);
        sizes.push_back(all[i]);
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

    /// asked: graded along edges.
    Array<double> sizes(std::span<const double> asked) {
        sizes_ = Array<double>(asked);
        const std::size_t count = edges_.ends.size();
        lowered_.resize(count, 1);
        first_block_.push_back(0);
        for (std::size_t e = 0; e < count; ++e) {
            ranges_.push_back(range(samples(e)));
            for (std::size_t k = 0; k < blocks(e); ++k) blocks_.push_back(range(block(e, k)));
            first_block_.push_back(blocks_.size());
        }
        for (int round = 1; cross_faces(round); ++round) {
            const Array<double> before = sizes_;
            sizes_ = along_.graded({before.data(), before.size()});
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

    /// The sizes of an edge were lowered in some round.
    void renew(std::size_t e, int round) {
        lowered_[e] = round;
        ranges_[e] = range(samples(e));
        for (std::size_t k = 0; k < blocks(e); ++k)
            blocks_[first_block_[e] + k] = range(block(e, k));
    }

    /// Let sizes grow across all faces that have an edge lowered in the last round or in this one.
    /// Says whether any size was lowered.
    bool cross_faces(int round) {
        bool any = false;
        for (std::size_t f = 0; f + 1 < faces_.first.size(); ++f) {
            const auto own = faces_.edges.subspan(
                static_cast<std::size_t>(faces_.first[f]),
                static_cast<std::size_t>(faces_.first[f + 1] - faces_.first[f]));
            double coarsest = 0.0;
            for (const std::int64_t edge : own)
                coarsest = std::max(coarsest, ranges_[static_cast<std::size_t>(edge)].largest);
            boxes_.clear();
            for (const std::int64_t from : own) {
                if (lowered_[from] < round) continue;
                const SampleRange& source = ranges_[static_cast<std::size_t>(from)];
                if (!(source.smallest < coarsest)) continue;
                any = cross_face(own, from, coarsest - source.smallest, round) || any;
            }
        }
        return any;
    }

    /// The same from one edge of a face to its others, which ask for ``above`` more at most.
    bool cross_face(std::span<const std::int64_t> own, std::int64_t from, double above, int round) {
        if (boxes_.empty())
            for (const std::int64_t edge : own)
                boxes_.add(ranges_[static_cast<std::size_t>(edge)].box);
        const Array<double>& ways =
            boxes_.squared_ways(ranges_[static_cast<std::size_t>(from)].box);
        bool any = false;
        for (std::size_t k = 0; k < own.size(); ++k) {
            if (!(slope_ * slope_ * ways.data()[k] < above * above)) continue;  // see may_lower
            const std::int64_t to = own[k];
            if (to == from) continue;  // by itself an edge is graded already
            if (!grow(static_cast<std::size_t>(from), static_cast<std::size_t>(to))) continue;
            renew(static_cast<std::size_t>(to), round + 1);
            any = true;
        }
        return any;
    }

    /// May sizes that grow from one range lower those of the other?
    [[nodiscard]] bool may_lower(const SampleRange& from, const SampleRange& to) const {
        const double above = to.largest - from.smallest;
        return above > CHANGE * to.largest &&
               slope_ * slope_ * squared_way(from.box, to.box) < above * above;
    }

    /// Lower the sizes of one edge to what grows from another one. Says whether any was lowered.
    bool grow(std::size_t from, std::size_t to) {
        if (!may_lower(ranges_[from], ranges_[to])) return false;
        bool any = false;
        for (std::size_t i = 0; i < blocks(from); ++i) {
            const SampleRange& source = blocks_[first_block_[from] + i];
            if (!may_lower(source, ranges_[to])) continue;
            for (std::size_t k = 0; k < blocks(to); ++k)
                if (may_lower(source, blocks_[first_block_[to] + k]))
                    any = grow(source, block(from, i), block(to, k)) || any;
        }
        return any;
    }

    bool grow(const SampleRange& source, Rows from, Rows to) {
        bool any = false;
        for (std::size_t i = to.first; i < to.last; ++i) {
            double& size = sizes_.data()[i];
            SampleRange here;
            here.box.add(edges_.points[i]);
            here.add(size);
            if (!may_lower(source, here)) continue;
            double least = size;
            for (std::size_t j = from.first; j + 1 < from.last; ++j)
                least = std::min(least, grown_from(j, edges_.points[i]));
            if (!(least < (1.0 - CHANGE) * size)) continue;
            size = least;
            any = true;
        }
        return any;
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
    SampleBoxes boxes_;                     // of the edges of one face
    std::vector<std::size_t> first_block_;  // of the edges
};

}  // namespace

Array<double> graded_over_faces(const EdgeNetwork& edges, const EdgesOfFaces& faces,
                                std::span<const double> sizes, double slope, double least_step) {
    const EdgeGradation along(edges, slope, least_step);
    Array<double> found = along.graded(sizes);
    const ThinnedEdges thinned(edges, found);
    const EdgeNetwork few{{thinned.points.data(), thinned.points.size()},
                          {thinned.first.data(), thinned.first.size()},
                          edges.ends,
                          edges.vertices};
    const Array<double> graded = GradationOverFaces(few, faces, slope, least_step)
                                     .sizes({thinned.sizes.data(), thinned.sizes.size()});
    if (std::equal(graded.begin(), graded.end(), thinned.sizes.begin())) return found;
    thinned.lower({graded.data(), graded.size()}, found);
    return along.graded({found.data(), found.size()});
}

}  // namespace surfmesh
