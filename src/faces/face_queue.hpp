// Faces of a model meshed one after the other, by as many threads as call for work.
//
// In: faces whose sizes grow inward from their edges, or follow from their curvature too, in the order
// in which they are to be begun.
// Out, of each call of ``work``: the faces that it has finished; those that ask for nothing in rows
// of one array each, any other as it is, for whoever knows the exceptional ways and the words. The
// mesh of a face does not depend on who makes it, or when.
#pragma once

#include <atomic>
#include <functional>
#include <variant>
#include <vector>

#include "faces/graded_face.hpp"

namespace surfmesh {

/// Meshes of faces in rows: those of a face up to its ends, from those of the face before it.
struct FaceRows {
    Array<std::int64_t> face;  // numbers in the queue
    Array<std::int64_t> point_end, triangle_end, corner_end;
    Array<Point3> points;
    Array<std::int64_t> slots;  // of the points
    Array<double> sizes;        // of the points
    Array<std::int32_t> triangles, uv_triangles;
    Array<Point2> uv;  // of the corners

    void append(std::int64_t number, FaceMesh made);
};

/// A face that asks for smaller sizes, or is not done.
struct OtherFace {
    std::int64_t face;
    FaceMesh made;
};

struct FinishedFaces {
    FaceRows rows;
    std::vector<OtherFace> others;

    [[nodiscard]] bool empty() const { return rows.face.empty() && others.empty(); }
};

/// A face that the core meshes by itself.
using QueuedFace = std::variant<InwardFace, GradedFace>;

class FaceQueue {
  public:
    explicit FaceQueue(std::vector<QueuedFace> faces) : faces_(std::move(faces)) {}

    /// Mesh faces that nobody has begun, until so many triangles are made or none is left.
    /// ``goes_on`` is asked now and then within a face; where it says no, all work ends.
    [[nodiscard]] FinishedFaces work(std::int64_t triangles, const std::function<bool()>& goes_on);
    /// No face is begun any more; those that are under way are not finished.
    void stop() { stopped_ = true; }
    /// That of a face, over whatever box.
    [[nodiscard]] const Surface& surface_of(std::int64_t number) const;

  private:
    const std::vector<QueuedFace> faces_;
    std::atomic<std::size_t> begun_ = 0;
    std::atomic<bool> stopped_ = false;
};

}  // namespace surfmesh
