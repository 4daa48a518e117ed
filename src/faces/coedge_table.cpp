#include "faces/coedge_table.hpp"

#include <limits>
#include <utility>

namespace surfmesh {
namespace {

/// The nodes of some coedges, coedge after coedge.
struct CoedgeNodeRows {
    Array<std::int64_t> coedge, first;
    Array<double> t;
    Array<std::int64_t> numbers;
    Array<Point3> points;
    Array<double> sizes;

    [[nodiscard]] EdgeNodeRows of(std::size_t k, std::span<const Point2> uv) const {
        const auto from = static_cast<std::size_t>(first.data()[k]);
        const std::size_t count = static_cast<std::size_t>(first.data()[k + 1]) - from;
        return {uv.subspan(from, count),
                {numbers.data() + from, count},
                {points.data() + from, count},
                {sizes.data() + from, count}};
    }
};

bool is_point(const CutEdgeRows& nodes, std::int64_t edge) {
    return nodes.first[edge] == nodes.first[edge + 1];
}

/// Of an edge that is one point in space both ends.
void add_point(CoedgeNodeRows& rows, const CoedgeTable& table, std::int64_t edge) {
    const std::int64_t vertex = table.start[edge];
    for (const double t : {0.0, 1.0}) {
        rows.t.push_back(t);
        rows.numbers.push_back(vertex);
        rows.points.push_back(table.corners[vertex]);
        rows.sizes.push_back(std::numeric_limits<double>::infinity());
    }
}

void add_nodes(CoedgeNodeRows& rows, const CutEdgeRows& nodes, std::int64_t edge) {
    for (std::int64_t at = nodes.first[edge]; at < nodes.first[edge + 1]; ++at) {
        rows.t.push_back(nodes.t[at]);
        rows.numbers.push_back(nodes.numbers[at]);
        rows.points.push_back(nodes.points[at]);
        rows.sizes.push_back(nodes.sizes[at]);
    }
}

CoedgeNodeRows nodes_of(const CoedgeTable& table, std::span<const std::int64_t> faces,
                        const CutEdgeRows& nodes) {
    CoedgeNodeRows rows;
    rows.first.push_back(0);
    for (const std::int64_t face : faces) {
        const std::int64_t from = table.first_coedge(face), to = table.first_coedge(face + 1);
        for (std::int64_t coedge = from; coedge < to; ++coedge) {
            const std::int64_t edge = table.edge[coedge];
            if (is_point(nodes, edge))
                add_point(rows, table, edge);
            else
                add_nodes(rows, nodes, edge);
            rows.coedge.push_back(coedge);
            rows.first.push_back(static_cast<std::int64_t>(rows.t.size()));
        }
    }
    return rows;
}

template <class T>
std::span<const T> all_of(const Array<T>& rows) {
    return {rows.data(), rows.size()};
}

/// Where their p-curves have them.
Array<Point2> places_of(const CoedgeTable& table, const CoedgeNodeRows& rows) {
    auto found = Array<Point2>::unfilled(rows.t.size());
    const Array<Point3> points =
        points_on(table.pcurves, {all_of(rows.coedge), all_of(rows.first), all_of(rows.t)});
    for (std::size_t i = 0; i < points.size(); ++i)
        found.data()[i] = {points.data()[i].x, points.data()[i].y};
    return found;
}

/// Of one face whose coedges are those of the rows from ``k`` on, which moves on behind them.
FaceBoundary boundary_of(const CoedgeTable& table, std::int64_t face, const CutEdgeRows& nodes,
                         const CoedgeNodeRows& rows, std::span<const Point2> uv, std::size_t& k) {
    BoundaryBuilder builder;
    const std::size_t uses = table.coedges_of(face);
    builder.reserve(static_cast<std::size_t>(rows.first.data()[k + uses] - rows.first.data()[k]),
                    uses);
    for (auto loop = table.first_loop_of_face[face]; loop < table.first_loop_of_face[face + 1];
         ++loop) {
        const std::int64_t count = table.first_of_loop[loop + 1] - table.first_of_loop[loop];
        for (std::int64_t c = 0; c < count; ++c, ++k) {
            const std::int64_t coedge = rows.coedge.data()[k], edge = table.edge[coedge];
            builder.add(rows.of(k, uv), {table.is_reversed[coedge] != 0, is_point(nodes, edge),
                                         table.tolerance[edge]});
        }
        builder.end_loop();
    }
    return std::move(builder).boundary();
}

}  // namespace

std::vector<FaceBoundary> boundaries_of(const CoedgeTable& table,
                                        std::span<const std::int64_t> faces,
                                        const CutEdgeRows& nodes) {
    const CoedgeNodeRows rows = nodes_of(table, faces, nodes);
    const Array<Point2> uv = places_of(table, rows);
    std::vector<FaceBoundary> found;
    found.reserve(faces.size());
    std::size_t k = 0;
    for (const std::int64_t face : faces)
        found.push_back(boundary_of(table, face, nodes, rows, all_of(uv), k));
    return found;
}

}  // namespace surfmesh
