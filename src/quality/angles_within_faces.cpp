#include "quality/angles_within_faces.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "elementary_functions/inverse_trigonometric.hpp"
#include "elementary_functions/sine_cosine.hpp"
#include "optimisation/dihedral.hpp"

namespace surfmesh {
namespace {

constexpr double IN_DEGREES = 180.0 / std::numbers::pi;
constexpr double CLEARLY = 1e-12;  // relative: rounding in sines and cosines of angles

double degrees_of(const DihedralTurn& turn) {
    constexpr double FLAT = 1e-4;
    if (turn.across <= FLAT * turn.along) {  // as most edges: x - x^3 / 3 is off by x^5 / 5
        const double x = turn.across == 0.0 ? 0.0 : turn.across / turn.along;
        return (x - x * x * x / 3.0) * IN_DEGREES;
    }
    return elementary::atan2(turn.across, turn.along) * IN_DEGREES;
}

/// Is one angle smaller than another by more than rounding? Both are from 0 to 180 degrees.
bool is_clearly_smaller(const DihedralTurn& turn, const DihedralTurn& other) {
    const double ahead = turn.across * other.along, behind = other.across * turn.along;
    return ahead - behind < -CLEARLY * (std::abs(ahead) + std::abs(behind));
}

/// Is one angle larger than another? One that is no number is the largest.
bool is_larger(double degrees, double other) {
    return degrees > other || (std::isnan(degrees) && !std::isnan(other));
}

/// What is known of the edges within a face.
struct FaceTurns {
    double limit;  // degrees
    DihedralTurn at_limit;
    DihedralTurn at_largest{0.0, 1.0};
    double largest = -1.0;
    std::int64_t edge = NIL;
    std::int64_t number = 0;
};

class AnglePass {
  public:
    AnglePass(const JoinedTriangles& mesh, std::span<const double> limits) : mesh_(mesh) {
        for (const double limit : limits) {
            const auto [sine, cosine] = elementary::sincos(std::min(limit, 180.0) / IN_DEGREES);
            faces_.push_back({limit, {sine, cosine}});
        }
    }

    AnglesWithinFaces run() {
        for (std::size_t k = 0; k < mesh_.half_edges.size(); ++k) {
            const auto [e, f] = mesh_.half_edges[k];
            if (mesh_.uses[k] != 2 || f == NIL || mesh_.faces[e / 3] != mesh_.faces[f / 3])
                continue;
            FaceTurns& face = faces_[mesh_.faces[e / 3]];
            ++face.number;
            const DihedralTurn turn = turn_across(e, f);
            if (is_clearly_smaller(turn, face.at_largest) &&
                is_clearly_smaller(turn, face.at_limit))
                continue;
            note(face, static_cast<std::int64_t>(k), turn);
        }
        add_up();
        return std::move(found_);
    }

  private:
    [[nodiscard]] DihedralTurn turn_across(HalfEdge e, HalfEdge f) const {
        const std::span<const Vertex> corners = corners_in_a_row(mesh_.triangles);
        const auto at = [&](HalfEdge h) { return mesh_.points[corners[h]]; };
        return dihedral_turn(at(e), at(next_half_edge(e)), at(prev_half_edge(e)),
                             at(prev_half_edge(f)));
    }

    void note(FaceTurns& face, std::int64_t edge, const DihedralTurn& turn) {
        const double degrees = degrees_of(turn);
        if (degrees > face.limit) {
            found_.edges.push_back(edge);
            found_.degrees.push_back(degrees);
            return;
        }
        if (!is_larger(degrees, face.largest)) return;
        face.largest = degrees;
        face.edge = edge;
        face.at_largest = turn;
    }

    void add_up() {
        double most = -1.0;
        for (const FaceTurns& face : faces_) {
            found_.largest.push_back(face.edge == NIL ? 0.0 : face.largest);
            found_.number.push_back(face.number);
            if (face.edge == NIL) continue;
            const bool is_equal =
                face.largest == most || (std::isnan(face.largest) && std::isnan(most));
            if (is_equal ? face.edge > found_.largest_edge : !is_larger(face.largest, most))
                continue;
            most = face.largest;
            found_.largest_edge = face.edge;
        }
    }

    const JoinedTriangles& mesh_;
    Array<FaceTurns> faces_;
    AnglesWithinFaces found_;
};

}  // namespace

AnglesWithinFaces angles_within_faces(const JoinedTriangles& mesh, std::span<const double> limits) {
    return AnglePass(mesh, limits).run();
}

}  // namespace surfmesh
