// The background of a size field: the sizes of one surface, graded, on a balanced quadtree.
//
// In: what sizes a law asks for at blocks of nodes, and where features may hide between them.
// Out: a background. It is built level by level. Every cell carries nine nodes (see
// fields/gradation.hpp); at each level the sizes of all nodes are graded together, each cell is
// compared with its test nodes, and the cells that miss are split into four. The test nodes of a
// leaf are kept: they make the final field twice as fine as the one that was tested.
//
// Samples alone cannot see a feature that lies between them. Where the surface can bound its
// derivatives over a cell, a cell is split as well while the bound admits a curvature that would
// at least halve the size.
#pragma once

#include <array>
#include <cstdint>
#include <exception>
#include <span>

#include "fields/field_cells.hpp"
#include "fields/field_nodes.hpp"
#include "fields/gradation.hpp"
#include "fields/key_table.hpp"

namespace surfmesh {

/// What sizes are asked for. Says whether it could tell.
class NodeLaw {
  public:
    virtual ~NodeLaw() = default;
    [[nodiscard]] virtual bool ask(std::span<const Point2> xy, FieldNodes& nodes) = 0;
    /// The exception of the caller's own code for which it could not, once.
    [[nodiscard]] virtual std::exception_ptr take_failure() { return {}; }
};

/// Cells in which features may hide, with what is known at their nine nodes.
struct SeenCells {
    Array<Point2> low, high;      // corners in the scaled plane
    Array<Point3> normal;         // at the middle
    Array<SizeTensor> root;       // nine a cell: I^(1/2)
    Array<double> smallest_size;  // of the nine
};

/// Where a surface may have features between the nodes of a cell. Says whether it could tell.
class HiddenFeatures {
  public:
    virtual ~HiddenFeatures() = default;
    /// deep: only what rises by more than a fraction of the chord error counts.
    [[nodiscard]] virtual bool find(const SeenCells& cells, bool deep,
                                    std::span<std::uint8_t> found) = 0;
    /// The exception of the caller's own code for which it could not, once.
    [[nodiscard]] virtual std::exception_ptr take_failure() { return {}; }
};

struct FieldPlan {
    RootGrid grid;
    Point2 extent;               // of the scaled plane
    Point2 root_step;            // width and height of a root cell
    double slope;                // growth of the size per length
    double largest;              // size in the scaled plane above which none counts
    std::array<int, 4> partner;  // the side that each side is joined with, or -1
    std::array<bool, 4> reversed;
    Array<SmallSource> sources;
    bool known_sizes;       // sizes are limited by points of known size, which have cells
    bool counts_triangles;  // cells may not be many more than the triangles that are asked for
    double free_cells;      // so many are allowed before cells are held to triangles
    double most_triangles;  // so many are not asked for by mistake; infinite: not looked at
    bool looks_for_hidden, looks_deep;
    double coarseness;  // times the error that a cell may have for a mesh: more makes fewer cells
};

enum class FieldStatus {
    done,
    too_many_triangles,  // far more than most_triangles
    too_many_cells,
    not_graded,  // sizes cannot be graded from one place to the next
    failed       // the law or the search for features could not tell
};

struct FieldOutcome {
    FieldStatus status;
    Point2 place;   // in the scaled plane, of what is wrong
    double number;  // of triangles or of cells
};

class FieldBuilder {
  public:
    explicit FieldBuilder(FieldPlan plan);

    /// Split cells until the field is accurate everywhere.
    [[nodiscard]] FieldOutcome refine(NodeLaw& law, HiddenFeatures& hidden);
    /// Grade the sizes of the nodes.
    [[nodiscard]] FieldOutcome grade_nodes();
    /// Grade other isotropic sizes of the nodes.
    [[nodiscard]] FieldOutcome spread(std::span<double> size);
    /// All nodes count as new to the gradation.
    void touch_all() { changed_.fill(number_); }
    void touch(Node n) { changed_[n] = number_; }
    /// Every leaf is split once more, onto its test nodes.
    [[nodiscard]] Background background();

    [[nodiscard]] Array<Point2> plane() const;
    [[nodiscard]] bool is_finished() const { return finished_; }

    FieldNodes nodes;

  private:
    struct Marks {
        Array<std::uint8_t> split, deep;
    };

    [[nodiscard]] bool make_patches(std::size_t first, NodeLaw& law);
    [[nodiscard]] bool create(std::span<const std::int64_t> keys, NodeLaw& law);
    void find_joined();
    void join_sides(int a, int b);
    [[nodiscard]] Point2 place_of(std::int64_t x, std::int64_t y) const;
    [[nodiscard]] std::int64_t stride() const;
    [[nodiscard]] FieldOutcome spread(std::span<double> size, bool stretched);
    [[nodiscard]] FieldOutcome far_beyond() const;
    [[nodiscard]] FieldOutcome refused(std::span<const std::uint8_t> split) const;
    void mark_inaccurate(std::int32_t seen, std::span<std::uint8_t> split);
    [[nodiscard]] bool is_graded(const Patch& patch) const;
    [[nodiscard]] PatchRoots metric_roots(const Patch& patch) const;
    [[nodiscard]] bool mark_hidden(HiddenFeatures& hidden, Marks& marks);
    [[nodiscard]] bool ask_hidden(HiddenFeatures& hidden, std::span<const std::int32_t> cells,
                                  bool deep, std::span<std::uint8_t> found) const;
    [[nodiscard]] double triangles(const FieldCell& cell, double density) const;
    [[nodiscard]] double most_cells() const;
    [[nodiscard]] std::size_t replace(const Marks& marks);

    FieldPlan plan_;
    FieldCells cells_;
    Array<Patch> patches_;  // of the leaves
    Array<Patch> before_;   // of the leaves before the last split
    Array<FieldCell> leaves_before_;
    Array<std::uint8_t> fresh_;  // leaves of this round
    Array<std::uint8_t> deep_;   // in search of what hides: they may be split further
    struct CellError {
        double own, parents;  // as ``patch_error`` has them; 0: not known
    };
    Array<CellError> error_;      // of the leaves
    KeyTable turn_;               // of the nodes by their keys, but for those amid a patch
    Array<Node> number_in_turn_;  // of the nodes, in the order in which they were asked for
    Array<std::int64_t> key_;     // of the nodes
    struct SideNode {
        double t;
        Node node;
    };
    std::array<Array<SideNode>, 4> side_;  // nodes on each side, along it
    Array<JoinedNodes> joined_;    // nodes next to each other, or one point in space, across joints
    Array<std::uint8_t> round_;    // of the nodes, where sizes are anisotropic
    Array<std::int32_t> changed_;  // last gradation that lowered a node
    std::int32_t number_ = 1;      // of the next one
    std::int64_t looked_into_ = 0;  // cells beyond HIDDEN_DEPTH, for what hides in them
    std::int64_t visits_ = 0;       // of nodes by the gradation
    bool finished_ = false;
};

}  // namespace surfmesh
