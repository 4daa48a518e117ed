#include "fields/field_builder.hpp"

#include <algorithm>
#include <cmath>

namespace surfmesh {
namespace {

constexpr int DEPTH = 13;  // most splits of a root cell for accuracy

// Splits of a root cell within which features between the samples are looked for: all of them,
// and where they would rise by more than a fraction of the chord error.
constexpr int HIDDEN_DEPTH = 6, DEEPEST_HIDDEN = 19;

constexpr std::int64_t MOST_HIDDEN = 60'000;  // cells looked into beyond HIDDEN_DEPTH, at most

// Error that a leaf may have: of what its cell, twice as wide, has at the test nodes, the same
// part that the cell has of its parent's: a quarter where the field is smooth, half at a kink. Where
// gradation decides, the field is a cone and all slopes are small. Where directions turn the ratio of
// both sizes counts as often: the same triangles come of a somewhat coarser field.
constexpr double LEAF_ERROR = 0.015, LEAF_STRETCHED = 0.02;
constexpr double GRADED_ERROR = 0.06, GRADED_STRETCHED = 0.065;
constexpr double SMOOTH_PART = 0.25, KINK_PART = 0.5;
constexpr double LOWERED = 0.98;  // of the target size: below it gradation decides

// A cell narrower than this many edges is not split: no circle would notice. The same where sizes
// are graded from points of known size, which have cells of their own size already; and where
// they depend on the direction too, so that gradation brings kinks of its own.
constexpr double FINEST_EXTENT = 0.2, FINEST_GRADED = 1.0, FINEST_STRETCHED = 2.0;

// A field may have so many cells; and beyond those that are free no more than the second number for
// each triangle that it asks for so far: what needs more is no size, but a place where r is
// singular.
constexpr double MAX_CELLS = 800'000, CELLS_OF_TRIANGLE = 4;
constexpr int MAX_ROUNDS = 60;

// Visits of nodes by the gradation, in all rounds: most nodes are visited once a round. Where
// directions turn on a surface as steep as a wall sizes may creep.
constexpr std::int64_t MOST_VISITS = 60'000'000;

constexpr std::size_t MANY_CELLS = 100'000;  // made before the triangles are counted

constexpr FieldOutcome DONE_WELL{FieldStatus::done, {0.0, 0.0}, 0.0};
constexpr FieldOutcome FAILED{FieldStatus::failed, {0.0, 0.0}, 0.0};

/// The error of the leaves of a cell, told from its own and its parent's.
double error_of_leaves(double own, double parents) {
    const double part = parents > 0.0 ? own / parents : KINK_PART;
    return own * std::clamp(part, SMOOTH_PART, KINK_PART);
}

constexpr Patch NO_NODES{{NIL, NIL, NIL, NIL, NIL, NIL, NIL, NIL, NIL}};

/// The patch of a child as far as its parent knows it: its corners.
Patch quarter(const Patch& parent, int child) {
    Patch patch = NO_NODES;
    for (int c = 0; c < 4; ++c) patch.node[CORNERS[c]] = parent.node[CORNERS_OF_CHILDREN[child][c]];
    return patch;
}

/// The metric area at a node: 1 / det H.
double density(SizeTensor metric_root) { return determinant(metric_root); }

}  // namespace

FieldBuilder::FieldBuilder(FieldPlan plan) : plan_(std::move(plan)), cells_(plan_.grid) {
    fresh_.resize(cells_.leaves().size(), 1);
    deep_.resize(cells_.leaves().size(), 0);
    error_.resize(cells_.leaves().size(), CellError{0.0, 0.0});
    patches_.resize(cells_.leaves().size(), NO_NODES);
}

FieldOutcome FieldBuilder::refine(NodeLaw& law, HiddenFeatures& hidden) {
    if (!make_patches(0, law)) return FAILED;
    for (int round = 0; round < MAX_ROUNDS + GRID_DEPTH; ++round) {
        const std::int32_t seen = number_;
        if (const FieldOutcome found = grade_nodes(); found.status != FieldStatus::done)
            return found;
        if (const FieldOutcome found = far_beyond(); found.status != FieldStatus::done)
            return found;
        const auto leaves = cells_.leaves();
        Marks marks{Array<std::uint8_t>(leaves.size(), 0), deep_};
        mark_inaccurate(seen, marks.split);
        if (!mark_hidden(hidden, marks)) return FAILED;
        Array<std::uint8_t> demanded(leaves.size(), 0);
        cells_.mark_for_sources(plan_.sources, demanded);
        std::size_t count = 0;
        bool is_demanded = false;
        for (std::size_t k = 0; k < leaves.size(); ++k) {
            if (leaves[k].depth >= (marks.deep[k] != 0 ? DEEPEST_HIDDEN : DEPTH))
                marks.split[k] = 0;
            if (marks.split[k] != 0 && marks.deep[k] != 0) demanded[k] = 1;
            if (demanded[k] != 0) marks.split[k] = 1;
            is_demanded = is_demanded || demanded[k] != 0;
            count += marks.split[k];
        }
        // after so many rounds all features are found; a few cells creep along fronts
        const std::size_t few = round <= DEPTH ? 0 : leaves.size() / 1000;
        if (count <= few && !is_demanded) break;
        cells_.balance(marks.split);
        const std::size_t kept = replace(marks);
        if (static_cast<double>(cells_.total()) > plan_.free_cells &&
            static_cast<double>(cells_.total()) > most_cells())
            return refused(marks.split);
        if (!make_patches(kept, law)) return FAILED;
    }
    finished_ = true;
    return DONE_WELL;
}

/// Split the marked cells: their children come behind the others, and are fresh; of their nodes they
/// have the corners. Returns how many are kept.
std::size_t FieldBuilder::replace(const Marks& marks) {
    Array<Patch> patches, of_quarters;
    Array<std::uint8_t> deep, children;
    Array<CellError> error, of_children;
    for (std::size_t k = 0; k < marks.split.size(); ++k) {
        if (marks.split[k] == 0) {
            patches.push_back(patches_[k]);
            deep.push_back(marks.deep[k]);
            error.push_back(error_[k]);
        } else {
            for (int q = 0; q < 4; ++q) {
                of_quarters.push_back(quarter(patches_[k], q));
                children.push_back(marks.deep[k]);
                of_children.push_back({0.0, error_[k].own});
            }
        }
    }
    for (const std::uint8_t value : children) deep.push_back(value);
    for (const CellError value : of_children) error.push_back(value);
    before_ = std::move(patches_);
    patches_ = std::move(patches);
    const std::size_t kept = patches_.size();
    for (const Patch& patch : of_quarters) patches_.push_back(patch);
    deep_ = std::move(deep);
    error_ = std::move(error);
    leaves_before_ = Array<FieldCell>(cells_.leaves());
    cells_.split(marks.split);
    fresh_ = Array<std::uint8_t>(kept, 0);
    fresh_.resize(cells_.leaves().size(), 1);
    return kept;
}

// sizes

FieldOutcome FieldBuilder::grade_nodes() {
    changed_.resize(nodes.count(), number_);
    for (std::size_t n = round_.size(); n < nodes.asked.size(); ++n)
        round_.push_back(nodes.is_round(static_cast<std::ptrdiff_t>(n)) ? 1 : 0);
    return spread(nodes.size, nodes.is_anisotropic());
}

FieldOutcome FieldBuilder::spread(std::span<double> size) { return spread(size, false); }

FieldOutcome FieldBuilder::spread(std::span<double> size, bool stretched) {
    GradedSizes graded{size, {}, {}, {}, {}, nodes.point, changed_, plan_.slope};
    if (stretched) {
        graded.longer = nodes.longer;
        graded.along = nodes.along;
        graded.normal = nodes.normal;
        graded.round = round_;
    }
    const std::int32_t number = number_++;
    const GradationDone done = grade(patches_, joined_, graded, number, MOST_VISITS - visits_);
    visits_ += done.visits;
    if (done.finished) return DONE_WELL;
    const std::int64_t key = done.last == NIL ? 0 : key_[done.last];
    return {FieldStatus::not_graded, place_of(key / stride(), key % stride()), 0.0};
}

/// Is the size lowered by gradation at one of the nodes?
bool FieldBuilder::is_graded(const Patch& patch) const {
    for (const Node n : patch.node) {
        if (nodes.size[n] < LOWERED * nodes.target_size[n]) return true;
        if (nodes.is_anisotropic() && nodes.longer[n] < LOWERED * nodes.longer_target[n])
            return true;
    }
    return false;
}

PatchRoots FieldBuilder::metric_roots(const Patch& patch) const {
    PatchRoots found;
    for (std::size_t i = 0; i < 9; ++i) found[i] = nodes.metric_root(patch.node[i]);
    return found;
}

/// Mark cells whose sizes have changed since a gradation and are not bilinear enough.
void FieldBuilder::mark_inaccurate(std::int32_t seen, std::span<std::uint8_t> split) {
    const double coarse = nodes.is_anisotropic() ? FINEST_STRETCHED : FINEST_GRADED;
    const double graded_error = nodes.is_anisotropic() ? GRADED_STRETCHED : GRADED_ERROR;
    const double leaf_error = nodes.is_anisotropic() ? LEAF_STRETCHED : LEAF_ERROR;
    const auto leaves = cells_.leaves();
    for (std::size_t k = 0; k < leaves.size(); ++k) {
        const Patch& patch = patches_[k];
        std::int32_t latest = 0;
        for (const Node n : patch.node) latest = std::max(latest, changed_[n]);
        if (fresh_[k] == 0 && latest < seen) continue;
        const auto parts = static_cast<double>(std::int64_t{1} << leaves[k].depth);
        const Point2 step{plan_.root_step.x / parts, plan_.root_step.y / parts};
        const PatchError found = patch_error(metric_roots(patch), step, plan_.largest);
        error_[k].own = found.error;
        const bool graded = is_graded(patch);
        const double finest = graded && plan_.known_sizes ? coarse : FINEST_EXTENT;
        const double most = plan_.coarseness * (graded ? graded_error : leaf_error);
        if (error_of_leaves(found.error, error_[k].parents) > most && found.extent > finest)
            split[k] = 1;
    }
}

// features between the nodes

/// Mark fresh cells whose bounds admit curvature that would at least halve the sizes seen.
bool FieldBuilder::mark_hidden(HiddenFeatures& hidden, Marks& marks) {
    if (!plan_.looks_for_hidden) return true;
    const auto leaves = cells_.leaves();
    Array<std::int32_t> shallow, deep;
    for (std::size_t k = 0; k < leaves.size(); ++k)
        if (fresh_[k] != 0 && marks.split[k] == 0)
            (leaves[k].depth < HIDDEN_DEPTH ? shallow : deep)
                .push_back(static_cast<std::int32_t>(k));
    if (!ask_hidden(hidden, shallow, false, marks.split)) return false;
    if (deep.empty() || !plan_.looks_deep || looked_into_ >= MOST_HIDDEN) return true;
    looked_into_ += static_cast<std::int64_t>(deep.size());
    if (!ask_hidden(hidden, deep, true, marks.split)) return false;
    for (const std::int32_t k : deep)
        if (marks.split[k] != 0) marks.deep[k] = 1;
    return true;
}

bool FieldBuilder::ask_hidden(HiddenFeatures& hidden, std::span<const std::int32_t> cells,
                              bool deep, std::span<std::uint8_t> split) const {
    if (cells.empty()) return true;
    SeenCells seen;
    for (const std::int32_t k : cells) {
        const FieldCell& cell = cells_.leaves()[k];
        const std::int64_t wide = 2 * cell.half();
        seen.low.push_back(place_of(cell.x, cell.y));
        seen.high.push_back(place_of(cell.x + wide, cell.y + wide));
        seen.normal.push_back(nodes.normal[patches_[k].node[4]]);
        double smallest = nodes.size[patches_[k].node[0]];
        for (const Node n : patches_[k].node) {
            seen.root.push_back(nodes.root[n]);
            smallest = std::min(smallest, nodes.size[n]);
        }
        seen.smallest_size.push_back(smallest);
    }
    Array<std::uint8_t> found(cells.size(), 0);
    if (!hidden.find(seen, deep, found)) return false;
    for (std::size_t i = 0; i < cells.size(); ++i)
        if (found[i] != 0) split[cells[i]] = 1;
    return true;
}

// how much is too much

/// Triangles that a cell asks for.
double FieldBuilder::triangles(const FieldCell& cell, double at) const {
    const double area = std::ldexp(plan_.root_step.x * plan_.root_step.y, -2 * cell.depth);
    return area * at * (4.0 / std::sqrt(3.0));
}

/// Are far more triangles asked for than there may be?
FieldOutcome FieldBuilder::far_beyond() const {
    if (patches_.size() < MANY_CELLS || !std::isfinite(plan_.most_triangles)) return DONE_WELL;
    double total = 0.0, most = -1.0;
    std::size_t worst = 0;
    for (std::size_t k = 0; k < patches_.size(); ++k) {
        std::array<double, 9> at{};
        const PatchRoots metric_root = metric_roots(patches_[k]);
        for (std::size_t i = 0; i < 9; ++i) at[i] = density(metric_root[i]);
        std::nth_element(at.begin(), at.begin() + 4, at.end());
        const double asked = triangles(cells_.leaves()[k], at[4]);
        total += asked;
        if (asked > most) {
            most = asked;
            worst = k;
        }
    }
    if (total <= plan_.most_triangles) return DONE_WELL;
    const FieldCell& cell = cells_.leaves()[worst];
    return {FieldStatus::too_many_triangles, place_of(cell.x + cell.half(), cell.y + cell.half()),
            total};
}

/// How many cells are allowed for what the leaves ask for, those that were split last whole.
double FieldBuilder::most_cells() const {
    if (!plan_.counts_triangles) return MAX_CELLS;
    double total = 0.0;
    for (std::size_t k = 0; k < before_.size(); ++k)
        total += triangles(leaves_before_[k], density(nodes.metric_root(before_[k].node[4])));
    const double free = plan_.free_cells + 4.0 * static_cast<double>(looked_into_);
    return std::min(MAX_CELLS, std::max(free, CELLS_OF_TRIANGLE * total));
}

/// Too many cells: the place is in the midst of the smallest.
FieldOutcome FieldBuilder::refused(std::span<const std::uint8_t> split) const {
    std::int32_t deepest = 0;
    for (std::size_t k = 0; k < split.size(); ++k)
        if (split[k] != 0) deepest = std::max(deepest, leaves_before_[k].depth);
    Array<std::int32_t> smallest;
    for (std::size_t k = 0; k < split.size(); ++k)
        if (split[k] != 0 && leaves_before_[k].depth == deepest)
            smallest.push_back(static_cast<std::int32_t>(k));
    const FieldCell& cell = leaves_before_[smallest[smallest.size() / 2]];
    return {FieldStatus::too_many_cells, place_of(cell.x, cell.y),
            static_cast<double>(cells_.total())};
}

}  // namespace surfmesh
