// Points and steps of the plane and of space, as values.
#pragma once

#include <cmath>

namespace surfmesh {

struct Point2 {
    double x, y;
};

struct Point3 {
    double x, y, z;
};

constexpr Point2 operator+(Point2 a, Point2 b) { return {a.x + b.x, a.y + b.y}; }
constexpr Point2 operator-(Point2 a, Point2 b) { return {a.x - b.x, a.y - b.y}; }
constexpr Point2 operator*(double s, Point2 a) { return {s * a.x, s * a.y}; }
constexpr double dot(Point2 a, Point2 b) { return a.x * b.x + a.y * b.y; }
inline double norm(Point2 a) { return std::sqrt(dot(a, a)); }

constexpr Point3 operator+(Point3 a, Point3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Point3 operator-(Point3 a, Point3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Point3 operator*(double s, Point3 a) { return {s * a.x, s * a.y, s * a.z}; }
constexpr double dot(Point3 a, Point3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Point3 cross(Point3 a, Point3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm(Point3 a) { return std::sqrt(dot(a, a)); }
/// The sum of the absolute values of the coordinates.
inline double norm_1(Point3 a) { return std::abs(a.x) + std::abs(a.y) + std::abs(a.z); }

}  // namespace surfmesh
