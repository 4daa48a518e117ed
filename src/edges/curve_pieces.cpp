#include "edges/curve_pieces.hpp"

#include "values/threads.hpp"

namespace surfmesh {

void parameters_of(const CurvePieces& pieces, const PiecePlaces& places, std::size_t i,
                   Array<double>& t) {
    const std::int64_t piece = places.which[i];
    const double t0 = pieces.t0[piece], length = pieces.t1[piece] - t0;
    t.clear();
    for (const double fraction : places.fraction.subspan(places.start(i), places.count(i)))
        t.push_back(t0 + fraction * length);
}

Array<Point3> points_on(const CurvePieces& pieces, const PiecePlaces& places) {
    auto found = Array<Point3>::unfilled(places.fraction.size());
    for_each_block(places.which.size(), PIECES_AT_ONCE, [&](std::size_t from, std::size_t to) {
        Array<double> t;
        for (std::size_t i = from; i < to; ++i) {
            parameters_of(pieces, places, i, t);
            pieces.curves[static_cast<std::size_t>(places.which[i])]->evaluate(
                t, 0, {found.data() + places.start(i), t.size()});
        }
    });
    return found;
}

}  // namespace surfmesh
