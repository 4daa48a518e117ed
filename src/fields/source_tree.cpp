#include "fields/source_tree.hpp"

#include <bit>
#include <cmath>
#include <limits>

namespace surfmesh {
namespace {

constexpr double EVEN = 0.04;      // relative spread of the size over a cell not worth a split
constexpr double ALLOWED = 0.045;  // relative error of interpolation that a leaf may be expected
                                   // to have; see is_coarse

// Relative rise of the size from a source within a cell to the corners of the cell that is
// allowed: with a growth of 1.2 such cells are half a size wide.
constexpr double NEAR_SOURCE = 0.06;

// Cells narrower than this many sizes are not split, however steep the growth.
constexpr double FINEST_AT_SOURCE = 0.25, FINEST = 0.5;

constexpr double ROUGHER = 2.0;  // factor on all of these for an estimate

constexpr std::uint64_t NO_KEY = std::numeric_limits<std::uint64_t>::max();

/// Place of a cell or a node, and how often a root cell was split down to it.
struct Place {
    std::int32_t i, j, depth;
};

/// Sources of a cell: a part of the list.
struct Listed {
    std::size_t first, last;
    [[nodiscard]] bool empty() const { return first == last; }
};

struct Visit {
    Cell cell;
    Listed sources;
};

/// What is known at the centre of a cell: the size, infinite without sources; the distance to
/// the source that decides; and at most how far the unit vectors to the sources are apart.
struct AtMiddle {
    double size, distance, turn;
};

class SourceTree {
  public:
    SourceTree(const Sources& sources, const RootCells& roots, std::int64_t most_cells,
               Fineness fineness)
        : sources_(sources),
          roots_(roots),
          most_cells_(most_cells),
          is_rough_(fineness == Fineness::for_estimate),
          allowed_(is_rough_ ? ROUGHER : 1.0) {}

    [[nodiscard]] bool grow() {
        for (std::int32_t row = 0; row < roots_.ny; ++row)
            for (std::int32_t column = 0; column < roots_.nx; ++column)
                add_cell({column << DEEPEST, row << DEEPEST, 0});
        if (is_rough_) {
            clear_nodes();
            return walk(Walk::both);
        }
        if (!walk(Walk::splitting) || !balance()) return false;
        clear_nodes();
        return walk(Walk::numbering);
    }

    [[nodiscard]] Background background(double largest) && {
        Background made;
        made.box = {roots_.x0, roots_.y0, 1.0 / roots_.wide, 1.0 / roots_.high, largest};
        made.grid = {roots_.nx, roots_.ny};
        made.child = std::move(child_);
        made.corner = std::move(corner_);
        made.metric_root = std::move(metric_root_);
        return made;
    }

  private:
    /// Leaves are split where they have to be; leaves are given their nodes; both at once, where
    /// no leaf is split for its neighbours.
    enum class Walk { splitting, numbering, both };

    [[nodiscard]] bool walk(Walk what);
    [[nodiscard]] Listed chosen(Cell cell, Listed from, AtMiddle& middle);
    [[nodiscard]] AtMiddle nearest_source(Cell cell, Listed from, std::int32_t& nearest);
    [[nodiscard]] bool is_coarse(Cell cell, Listed from, const AtMiddle& middle) const;
    [[nodiscard]] bool holds_small_source(Cell cell, Listed from, double width, double rise) const;
    [[nodiscard]] bool balance();
    [[nodiscard]] bool split(Cell cell);
    void make_nodes(Cell cell, Listed from);
    void clear_nodes();
    void make_room();
    [[nodiscard]] std::size_t slot(std::uint64_t key) const;
    [[nodiscard]] Cell leaf_at(std::int32_t i, std::int32_t j) const;

    void add_cell(Place place) {
        child_.push_back(NIL);
        place_.push_back(place);
    }

    /// Width and height of a cell.
    [[nodiscard]] Point2 steps(Cell cell) const {
        const double scale = 1.0 / (1 << place_[cell].depth);
        return {roots_.wide * scale, roots_.high * scale};
    }

    [[nodiscard]] Point2 position(std::int64_t i, std::int64_t j) const {
        const double unit = 1.0 / (1 << DEEPEST);
        return {roots_.x0 + static_cast<double>(i) * unit * roots_.wide,
                roots_.y0 + static_cast<double>(j) * unit * roots_.high};
    }

    /// A cell's centre.
    [[nodiscard]] Point2 middle(Cell cell) const {
        const Point2 low = position(place_[cell].i, place_[cell].j);
        const Point2 step = steps(cell);
        return {low.x + 0.5 * step.x, low.y + 0.5 * step.y};
    }

    [[nodiscard]] double length(Point2 d) const {
        const double square =
            sources_.e * d.x * d.x + 2.0 * sources_.f * d.x * d.y + sources_.g * d.y * d.y;
        return std::sqrt(std::max(square, 0.0));
    }

    /// From the centre of a cell to its farthest corner.
    [[nodiscard]] double radius(Point2 step) const {
        const double square = sources_.e * step.x * step.x +
                              2.0 * std::abs(sources_.f) * step.x * step.y +
                              sources_.g * step.y * step.y;
        return 0.5 * std::sqrt(square);
    }

    [[nodiscard]] double size_at(Listed from, Point2 p) const {
        double size = sources_.largest;
        for (std::size_t k = from.first; k < from.last; ++k) {
            const std::int32_t s = listed_[k];
            const double d = length(sources_.place[s] - p);
            size = std::min(size, sources_.size[s] + sources_.slope * d);
        }
        return size;
    }

    [[nodiscard]] NodeSize stored(double size) const;

    Sources sources_;
    RootCells roots_;
    std::int64_t most_cells_;
    bool is_rough_;
    double allowed_;  // factor on what cells are held to
    Array<Cell> child_;
    Array<Place> place_;  // lower left corners
    Array<CellCorners> corner_;
    Array<NodeSize> metric_root_;
    Array<std::uint64_t> key_;  // a power of two of them: nodes by place
    Array<Node> node_;          // as key_
    Array<Visit> stack_;
    Array<std::int32_t> listed_;  // sources of the cells on the way down, one cell's after another
    Array<double> reach_;         // as listed_
};

/// Visit all cells, each with the sources that matter in it.
bool SourceTree::walk(Walk what) {
    listed_.clear();
    for (std::size_t k = 0; k < sources_.size.size(); ++k)
        if (sources_.size[k] < sources_.largest) listed_.push_back(static_cast<std::int32_t>(k));
    const Listed all{0, listed_.size()};
    for (Cell root = 0; root < roots_.nx * roots_.ny; ++root) {
        stack_.push_back({root, all});
        while (!stack_.empty()) {
            const auto [cell, given] = stack_.pop_back();
            AtMiddle middle{};
            const Listed here = chosen(cell, given, middle);
            if (what != Walk::numbering && is_coarse(cell, here, middle) && !split(cell))
                return false;
            const Cell child = child_[cell];
            if (child < 0) {
                if (what != Walk::splitting) make_nodes(cell, here);
                continue;
            }
            for (int k = 0; k < 4; ++k) stack_.push_back({child + k, here});
        }
    }
    return true;
}

/// The sources that matter in a cell, of those in `from`, and what is known at its centre.
///
/// They are put behind `from`, or stay where they are when all of them matter.
///
/// Sources in about the same direction rise alike: by Dunkl's and Williams's inequality the
/// unit vectors to k and j differ by no more than 2 |x_k - x_j| / (d_k + d_j), and u_k - u_j
/// changes by slope times that towards the corners.
Listed SourceTree::chosen(Cell cell, Listed from, AtMiddle& at) {
    const std::size_t count = from.last - from.first;
    if (listed_.size() < from.last + count) listed_.resize(from.last + count);
    if (reach_.size() < listed_.size()) reach_.resize(listed_.size());
    std::int32_t nearest = 0;
    at = nearest_source(cell, from, nearest);
    const double slope = sources_.slope;
    const double r = radius(steps(cell));
    const double rise = slope * r;
    const double limit = std::min(at.size + 2.0 * rise, sources_.largest + rise) * (1.0 + 1e-12);
    std::size_t kept = from.last;
    for (std::size_t k = from.first; k < from.last; ++k) {
        const double u = reach_[from.last + k - from.first];
        if (u > limit) continue;
        const std::int32_t s = listed_[k];
        const double apart = length(sources_.place[s] - sources_.place[nearest]);
        const double far = (u - sources_.size[s]) + slope * (at.distance - 2.0 * r);
        if ((u - at.size) * far > 2.0 * rise * slope * apart * (1.0 + 1e-9) && far > 0.0) continue;
        if (apart > 0.0) at.turn = std::max(at.turn, 2.0 * slope * apart / (far + 2.0 * rise));
        listed_[kept++] = s;
    }
    at.turn = std::min(at.turn, 2.0);
    if (kept - from.last == count) return from;
    return {from.last, kept};
}

/// The source that decides at the centre of a cell; `reach_` behind `from` becomes their sizes.
AtMiddle SourceTree::nearest_source(Cell cell, Listed from, std::int32_t& nearest) {
    const Point2 p = middle(cell);
    AtMiddle at{std::numeric_limits<double>::infinity(), 0.0, 0.0};
    for (std::size_t k = from.first; k < from.last; ++k) {
        const std::int32_t s = listed_[k];
        const double d = length(sources_.place[s] - p);
        const double u = sources_.size[s] + sources_.slope * d;
        reach_[from.last + k - from.first] = u;
        if (u < at.size) {
            at.size = u;
            at.distance = d;
            nearest = s;
        }
    }
    return at;
}

/// Is the size in this cell too uneven for the values at its corners?
///
/// With w the width, h the size and d the distance at the centre, and rise = slope r, bilinear
/// interpolation is expected to miss, relative to h, by
///
///     0.18 turn rise / h      where two sources of different direction are equal: a ridge
///     0.5 (rise / h)^2        along the rise, as 1 / h is what is interpolated
///     0.18 rise / h  w / d    across it: circles about the source
bool SourceTree::is_coarse(Cell cell, Listed from, const AtMiddle& at) const {
    if (from.empty() || place_[cell].depth >= DEEPEST) return false;
    const Point2 step = steps(cell), p = middle(cell);
    const bool beyond = p.x - 0.5 * step.x > roots_.x1 || p.y - 0.5 * step.y > roots_.y1;
    if (beyond) return false;
    const double rise = sources_.slope * radius(step);
    double smallest = sources_.size[listed_[from.first]];
    for (std::size_t k = from.first + 1; k < from.last; ++k)
        smallest = std::min(smallest, sources_.size[listed_[k]]);
    const double low = std::max(at.size - rise, smallest);
    if (std::min(at.size + rise, sources_.largest) <= low * (1.0 + allowed_ * EVEN)) return false;
    const double width = std::max(std::sqrt(sources_.e) * step.x, std::sqrt(sources_.g) * step.y);
    double error = 0.18 * at.turn + 0.5 * rise / at.size;
    error += 0.18 * (width < 2.0 * at.distance ? width / at.distance : 2.0);
    if (width > allowed_ * FINEST * at.size && rise * error > allowed_ * ALLOWED * at.size)
        return true;
    return holds_small_source(cell, from, width, rise);
}

/// Does a source lie in the cell that is small beside it? One on its side counts as within.
bool SourceTree::holds_small_source(Cell cell, Listed from, double width, double rise) const {
    const Point2 step = steps(cell), p = middle(cell);
    const double half_wide = 0.5000001 * step.x, half_high = 0.5000001 * step.y;
    for (std::size_t k = from.first; k < from.last; ++k) {
        const std::int32_t s = listed_[k];
        const double size = sources_.size[s];
        if (width > allowed_ * FINEST_AT_SOURCE * size && rise > allowed_ * NEAR_SOURCE * size) {
            const Point2 d = sources_.place[s] - p;
            if (std::abs(d.x) <= half_wide && std::abs(d.y) <= half_high) return true;
        }
    }
    return false;
}

/// Give a cell four children; says whether there may be so many cells.
bool SourceTree::split(Cell cell) {
    const std::size_t first = child_.size();
    if (static_cast<std::int64_t>(first) + 4 > most_cells_) return false;
    child_[cell] = static_cast<Cell>(first);
    const Place low = place_[cell];
    const int depth = low.depth + 1;
    const std::int32_t half = 1 << (DEEPEST - depth);
    for (int k = 0; k < 4; ++k) add_cell({low.i + (k % 2) * half, low.j + (k / 2) * half, depth});
    return true;
}

/// The leaf that contains a place, its lower left corner included; NIL outside.
Cell SourceTree::leaf_at(std::int32_t i, std::int32_t j) const {
    if (i < 0 || j < 0) return NIL;
    const std::int32_t column = i >> DEEPEST, row = j >> DEEPEST;
    if (column >= roots_.nx || row >= roots_.ny) return NIL;
    Cell cell = row * roots_.nx + column;
    for (int bit = DEEPEST - 1; child_[cell] >= 0; --bit)
        cell = child_[cell] + ((i >> bit) & 1) + 2 * ((j >> bit) & 1);
    return cell;
}

/// Split leaves until none lies beside one that is two levels finer.
///
/// A new leaf stands at the end of the list and is looked at in its turn.
bool SourceTree::balance() {
    for (Cell cell = 0; cell < static_cast<Cell>(child_.size()); ++cell) {
        const auto [i, j, depth] = place_[cell];
        if (child_[cell] >= 0 || depth <= 1) continue;
        const std::int32_t size = 1 << (DEEPEST - depth);
        const Place beside[] = {{i - 1, j, 0}, {i + size, j, 0}, {i, j - 1, 0}, {i, j + size, 0}};
        for (const Place p : beside) {
            Cell other = leaf_at(p.i, p.j);
            while (other >= 0 && place_[other].depth < depth - 1) {
                if (!split(other)) return false;
                other = leaf_at(p.i, p.j);
            }
        }
    }
    return true;
}

/// An empty table of nodes with room for those of all cells that there are: a split makes five at
/// most.
void SourceTree::clear_nodes() {
    const std::size_t roots = static_cast<std::size_t>(roots_.nx) * roots_.ny;
    const std::size_t most = (static_cast<std::size_t>(roots_.nx) + 1) * (roots_.ny + 1) +
                             5 * ((child_.size() - roots) / 4);
    const std::size_t slots = std::bit_ceil(2 * most);
    key_.resize(slots, NO_KEY);
    node_.resize(slots, NIL);
}

/// Room for four nodes and for the corners of all cells, where cells are still split.
void SourceTree::make_room() {
    if (corner_.size() < child_.size()) corner_.resize(child_.size());
    if (2 * (metric_root_.size() + 4) <= key_.size()) return;
    Array<std::uint64_t> keys(2 * key_.size(), NO_KEY);
    Array<Node> nodes(2 * node_.size(), NIL);
    key_.swap(keys);
    node_.swap(nodes);
    for (std::size_t k = 0; k < keys.size(); ++k) {
        if (keys[k] == NO_KEY) continue;
        const std::size_t at = slot(keys[k]);
        key_[at] = keys[k];
        node_[at] = nodes[k];
    }
}

/// The corner nodes of a leaf, with their sizes when they are new.
void SourceTree::make_nodes(Cell cell, Listed from) {
    make_room();
    const Place low = place_[cell];
    const std::int64_t size = std::int64_t{1} << (DEEPEST - low.depth);
    for (int k = 0; k < 4; ++k) {
        const std::int64_t i = low.i + (k % 2) * size, j = low.j + (k / 2) * size;
        const std::uint64_t key =
            (static_cast<std::uint64_t>(i) << 32) | static_cast<std::uint64_t>(j);
        const std::size_t at = slot(key);
        if (key_[at] == NO_KEY) {
            key_[at] = key;
            node_[at] = static_cast<Node>(metric_root_.size());
            metric_root_.push_back(stored(size_at(from, position(i, j))));
        }
        corner_[cell].node[k] = node_[at];
    }
}

/// Where a key stands in the table of nodes, or the free slot that it will have.
std::size_t SourceTree::slot(std::uint64_t key) const {
    const std::size_t mask = key_.size() - 1;
    // places of coarse cells are multiples of high powers of two: high bits have to come down
    std::uint64_t mixed = (key ^ (key >> 32)) * 0x9E3779B97F4A7C1U;
    mixed = (mixed ^ (mixed >> 32)) * 0x9E3779B97F4A7C1U;
    std::size_t at = (mixed ^ (mixed >> 32)) & mask;
    while (key_[at] != NO_KEY && key_[at] != key) at = (at + 1) & mask;
    return at;
}

/// I^(1/2) / h and 1 / h; the root is (I + s Id) / t, s^2 = det I, t^2 = trace I + 2 s.
NodeSize SourceTree::stored(double size) const {
    const double e = sources_.e, f = sources_.f, g = sources_.g;
    const double s = std::sqrt(std::max(e * g - f * f, 0.0));
    const double t = std::sqrt(e + g + 2.0 * s);
    return {{(e + s) / (t * size), f / (t * size), (g + s) / (t * size)}, 1.0 / size};
}

}  // namespace

GrownTree grow_tree(const Sources& sources, const RootCells& roots, double largest,
                    std::int64_t most_cells, Fineness fineness) {
    SourceTree tree(sources, roots, most_cells, fineness);
    if (!tree.grow()) return {TreeStatus::too_many_cells, {}};
    return {TreeStatus::grown, std::move(tree).background(largest)};
}

}  // namespace surfmesh
