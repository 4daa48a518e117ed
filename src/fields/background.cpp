#include "fields/background.hpp"

namespace surfmesh {
namespace {

bool is_box(const BackgroundBox& box) {
    return std::isfinite(box.x0) && std::isfinite(box.y0) && std::isfinite(box.across) &&
           std::isfinite(box.up) && box.across > 0.0 && box.up > 0.0 && box.largest > 0.0;
}

}  // namespace

Background::Check Background::check() const {
    if (!is_box(box)) return {BackgroundFault::box, 0};
    const auto cells = static_cast<std::int64_t>(child.size());
    const auto nodes = static_cast<std::int64_t>(metric_root.size());
    if (grid.nx < 1 || grid.ny < 1 || std::int64_t{grid.nx} * grid.ny > cells ||
        corner.size() != child.size())
        return {BackgroundFault::grid, 0};
    for (std::int64_t cell = 0; cell < cells; ++cell) {
        const std::int64_t first = child[cell];
        if (first >= 0) {
            if (first <= cell || first + 4 > cells) return {BackgroundFault::child, cell};
            continue;
        }
        for (const Node n : corner[cell].node)
            if (n < 0 || n >= nodes) return {BackgroundFault::corner, cell};
    }
    if (!metric_root_3d.empty() && metric_root_3d.size() != metric_root.size())
        return {BackgroundFault::root_3d, 0};
    return {BackgroundFault::none, 0};
}

Array<SizeTensor> sizes(const Background& b, std::span<const Point2> xy) {
    Array<SizeTensor> out;
    out.reserve(xy.size());
    for (const Point2 p : xy) out.push_back(b.size_at(p.x, p.y));
    return out;
}

Array<SizeTensor> metric_roots(const Background& b, std::span<const Point2> xy) {
    Array<SizeTensor> out;
    out.reserve(xy.size());
    for (const Point2 p : xy) out.push_back(b.metric_root_at(p.x, p.y));
    return out;
}

Array<MetricRoot3> metric_roots_3d(const Background& b, std::span<const Point2> xy) {
    Array<MetricRoot3> out;
    out.reserve(xy.size());
    for (const Point2 p : xy) out.push_back(b.metric_root_3d_at(p.x, p.y));
    return out;
}

Array<double> scalar_sizes(const Background& b, std::span<const Point2> xy) {
    Array<double> out;
    out.reserve(xy.size());
    for (const Point2 p : xy) out.push_back(b.scalar_size_at(p.x, p.y));
    return out;
}

}  // namespace surfmesh
