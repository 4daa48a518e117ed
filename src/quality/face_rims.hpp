// The lines around a face: its edges that bound it or belong to another face too, from corner to
// corner.
//
//     o---o---o        A corner is given as one, turns by more than 60 degrees, or has other than
//    /         \       two segments of the face. A line without one is closed.
//   o           o
//
// In: points, the segments around all faces, those of one face. Out: its lines, as points. Nothing
// is said of their sequence; a segment belongs to one line.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "space/box_tree.hpp"
#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

struct RimSegment {
    std::array<Vertex, 2> ends;
    std::int32_t face;
    double chord;  // allowed there
};

struct RimLine {
    Array<Point3> points;  // of a closed one the first is not repeated
    bool closed;
    double chord;  // the largest allowed along it
};

class FaceRims {
  public:
    FaceRims(std::span<const Point3> points, std::span<const std::uint8_t> is_corner,
             std::span<const RimSegment> segments)
        : points_(points),
          is_corner_(is_corner),
          segments_(segments),
          done_(segments.size(), 0),
          at_(points.size(), AtVertex{}) {}

    /// Call work(line) for each line of the face with these segments.
    template <class Work>
    void for_each_line(std::span<const std::int32_t> members, const Work& work) {
        for (const std::int32_t s : members) note(s);
        for (const bool everywhere : {false, true})  // lines from corners first
            for (const std::int32_t s : members)
                for (const Vertex start : segments_[s].ends)
                    if (done_[s] == 0 && (everywhere || ends_at(start))) work(line_from(s, start));
        for (const std::int32_t s : members)
            for (const Vertex v : segments_[s].ends) at_[v] = {};
    }

  private:
    /// The segments of the face at a vertex: two, unless it is a corner.
    struct AtVertex {
        std::int32_t count = 0;
        std::array<std::int32_t, 2> segment{};
    };

    void note(std::int32_t segment);
    [[nodiscard]] bool ends_at(Vertex v) const;
    [[nodiscard]] Vertex other_end(std::int32_t segment, Vertex v) const;
    RimLine line_from(std::int32_t segment, Vertex start);

    std::span<const Point3> points_;
    std::span<const std::uint8_t> is_corner_;
    std::span<const RimSegment> segments_;
    Array<std::uint8_t> done_;
    Array<AtVertex> at_;
};

}  // namespace surfmesh
