#include "fields/field_cells.hpp"

namespace surfmesh {

FieldCells::FieldCells(RootGrid grid) : grid_(grid) {
    for (Cell k = 0; k < grid.nx * grid.ny; ++k) {
        const std::int64_t unit = std::int64_t{1} << (GRID_DEPTH + 1);
        leaves_.push_back({(k % grid.nx) * unit, (k / grid.nx) * unit, 0, k});
        child_.push_back(NIL);
        place_.push_back(k);
    }
}

Cell FieldCells::cell_at(std::int64_t x, std::int64_t y) const {
    const std::int64_t column = x >> (GRID_DEPTH + 1), row = y >> (GRID_DEPTH + 1);
    auto cell = static_cast<Cell>(row * grid_.nx + column);
    for (int bit = GRID_DEPTH; child_[cell] >= 0; --bit)
        cell = child_[cell] + static_cast<Cell>(((x >> bit) & 1) + 2 * ((y >> bit) & 1));
    return cell;
}

std::int32_t FieldCells::leaf_at(std::int64_t x, std::int64_t y) const {
    return place_[cell_at(x, y)];
}

void FieldCells::mark_for_sources(std::span<const SmallSource> sources,
                                  std::span<std::uint8_t> split) const {
    for (const SmallSource& source : sources) {
        const std::int32_t leaf = leaf_at(2 * source.x, 2 * source.y);
        if (leaves_[leaf].depth < source.depth) split[leaf] = 1;
    }
}

void FieldCells::balance(std::span<std::uint8_t> split) const {
    const std::int64_t end_x = std::int64_t{grid_.nx} << (GRID_DEPTH + 1);
    const std::int64_t end_y = std::int64_t{grid_.ny} << (GRID_DEPTH + 1);
    Array<std::int32_t> open;
    for (std::size_t k = 0; k < split.size(); ++k)
        if (split[k] != 0) open.push_back(static_cast<std::int32_t>(k));
    while (!open.empty()) {
        const FieldCell fine = leaves_[open.pop_back()];
        const std::int64_t half = fine.half(), x = fine.x + half, y = fine.y + half;
        // a point just outside each side
        const std::int64_t beside[4][2] = {
            {fine.x - 1, y}, {x + half, y}, {x, fine.y - 1}, {x, y + half}};
        for (const auto& p : beside) {
            if (p[0] < 0 || p[1] < 0 || p[0] >= end_x || p[1] >= end_y) continue;
            const std::int32_t leaf = leaf_at(p[0], p[1]);
            if (split[leaf] != 0 || leaves_[leaf].depth >= fine.depth) continue;
            split[leaf] = 1;
            open.push_back(leaf);
        }
    }
}

void FieldCells::split(std::span<const std::uint8_t> marked) {
    Array<FieldCell> kept, children;
    for (std::size_t k = 0; k < marked.size(); ++k) {
        const FieldCell cell = leaves_[k];
        if (marked[k] == 0) {
            kept.push_back(cell);
            continue;
        }
        child_[cell.number] = static_cast<Cell>(child_.size());
        for (int q = 0; q < 4; ++q) {
            children.push_back({cell.x + cell.half() * (q % 2), cell.y + cell.half() * (q / 2),
                                cell.depth + 1, static_cast<Cell>(child_.size())});
            child_.push_back(NIL);
        }
    }
    for (const FieldCell& cell : children) kept.push_back(cell);
    leaves_ = std::move(kept);
    place_.resize(child_.size(), NIL);
    for (std::size_t k = 0; k < leaves_.size(); ++k)
        place_[leaves_[k].number] = static_cast<std::int32_t>(k);
}

void FieldCells::split_all() {
    for (const FieldCell& cell : leaves_) {
        child_[cell.number] = static_cast<Cell>(child_.size());
        for (int q = 0; q < 4; ++q) child_.push_back(NIL);
    }
}

}  // namespace surfmesh
