// Two numbers that are computed with at once, as processors do; each of them as it would be alone.
#pragma once

namespace surfmesh {

struct NumberPair {
    double first, second;
};

constexpr NumberPair operator+(NumberPair a, NumberPair b) {
    return {a.first + b.first, a.second + b.second};
}
constexpr NumberPair operator-(NumberPair a, NumberPair b) {
    return {a.first - b.first, a.second - b.second};
}
constexpr NumberPair operator*(NumberPair a, NumberPair b) {
    return {a.first * b.first, a.second * b.second};
}
constexpr NumberPair operator/(NumberPair a, NumberPair b) {
    return {a.first / b.first, a.second / b.second};
}
constexpr NumberPair operator+(NumberPair a, double b) { return a + NumberPair{b, b}; }
constexpr NumberPair operator-(NumberPair a, double b) { return a - NumberPair{b, b}; }
constexpr NumberPair operator-(double a, NumberPair b) { return NumberPair{a, a} - b; }
constexpr NumberPair operator*(double a, NumberPair b) { return NumberPair{a, a} * b; }
constexpr NumberPair operator*(NumberPair a, double b) { return a * NumberPair{b, b}; }

}  // namespace surfmesh
