#include "quality/face_rims.hpp"

#include <algorithm>

namespace surfmesh {
namespace {

constexpr double COSINE_OF_CORNER = 0.5;  // of 60 degrees: no segment of an edge turns farther

}  // namespace

void FaceRims::note(std::int32_t segment) {
    for (const Vertex v : segments_[segment].ends) {
        AtVertex& at = at_[v];
        if (at.count < 2) at.segment[at.count] = segment;
        ++at.count;
    }
}

Vertex FaceRims::other_end(std::int32_t segment, Vertex v) const {
    const auto& ends = segments_[segment].ends;
    return ends[0] == v ? ends[1] : ends[0];
}

bool FaceRims::ends_at(Vertex v) const {
    const AtVertex& at = at_[v];
    if (at.count != 2 || is_corner_[v] != 0) return true;
    const Point3 in = points_[v] - points_[other_end(at.segment[0], v)];
    const Point3 out = points_[other_end(at.segment[1], v)] - points_[v];
    return !(dot(in, out) > COSINE_OF_CORNER * norm(in) * norm(out));
}

RimLine FaceRims::line_from(std::int32_t segment, Vertex start) {
    RimLine line{{}, false, 0.0};
    line.points.push_back(points_[start]);
    Vertex v = start;
    while (done_[segment] == 0) {
        done_[segment] = 1;
        line.chord = std::max(line.chord, segments_[segment].chord);
        v = other_end(segment, v);
        if (v == start || ends_at(v)) break;
        line.points.push_back(points_[v]);
        const auto& [count, both] = at_[v];
        segment = both[0] == segment ? both[1] : both[0];
    }
    line.closed = v == start && !ends_at(start);
    if (!line.closed) line.points.push_back(points_[v]);
    return line;
}

}  // namespace surfmesh
