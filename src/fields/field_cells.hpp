// The cells of a size field under construction: the leaves of a forest of quadtrees.
//
// A cell is split into four children; `balance` adds to the cells to be split what would be left
// two levels coarser than a neighbour. Corners are in units of the finest grid of nodes, of which
// a root cell is 2^(GRID_DEPTH + 1) wide.
#pragma once

#include <cstdint>
#include <span>

#include "fields/background.hpp"
#include "values/array.hpp"
#include "values/conventions.hpp"

namespace surfmesh {

inline constexpr int GRID_DEPTH = 20;  // most splits around small sources; also the depth of the
                                       // finest grid that nodes lie on

/// A leaf: lower left corner, splits of a root cell down to it, and its number in the tree.
struct FieldCell {
    std::int64_t x, y;
    std::int32_t depth;
    Cell number;

    /// Half its width, in units of the finest grid.
    [[nodiscard]] std::int64_t half() const { return std::int64_t{1} << (GRID_DEPTH - depth); }
};

/// A place that wants a small size, and how deep the leaf there shall be.
struct SmallSource {
    std::int64_t x, y;  // on the grid of GRID_DEPTH
    std::int64_t depth;
};

class FieldCells {
  public:
    explicit FieldCells(RootGrid grid);

    [[nodiscard]] std::span<const FieldCell> leaves() const { return leaves_; }
    /// Cells of the tree, those that were split included.
    [[nodiscard]] std::int64_t total() const { return static_cast<std::int64_t>(child_.size()); }
    /// Of the cells of the tree: first of four children, or NIL.
    [[nodiscard]] const Array<Cell>& child() const { return child_; }

    /// The leaf that contains a place of the finest grid; its place among the leaves.
    [[nodiscard]] std::int32_t leaf_at(std::int64_t x, std::int64_t y) const;
    /// Mark leaves that are too shallow for a source within: what is smaller than a cell would be
    /// missed by its nodes.
    void mark_for_sources(std::span<const SmallSource> sources,
                          std::span<std::uint8_t> split) const;
    /// Mark what would be left more than one level coarser than a neighbour. With it a fine node
    /// in the middle of a coarse side would bind nobody across it.
    void balance(std::span<std::uint8_t> split) const;
    /// Replace the marked leaves by their children, which come behind the others.
    void split(std::span<const std::uint8_t> marked);
    /// Give every leaf four children, without places: the tree is done.
    void split_all();

  private:
    [[nodiscard]] Cell cell_at(std::int64_t x, std::int64_t y) const;

    RootGrid grid_;
    Array<FieldCell> leaves_;
    Array<Cell> child_;
    Array<std::int32_t> place_;  // of the cells of the tree: among the leaves
};

}  // namespace surfmesh
