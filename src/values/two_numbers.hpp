// Two numbers that are computed with at once, as processors do; each of them as it would be alone.
#pragma once

namespace surfmesh {

struct TwoNumbers {
    double first, second;
};

constexpr TwoNumbers operator+(TwoNumbers a, TwoNumbers b) {
    return {a.first + b.first, a.second + b.second};
}
constexpr TwoNumbers operator-(TwoNumbers a, TwoNumbers b) {
    return {a.first - b.first, a.second - b.second};
}
constexpr TwoNumbers operator*(TwoNumbers a, TwoNumbers b) {
    return {a.first * b.first, a.second * b.second};
}
constexpr TwoNumbers operator/(TwoNumbers a, TwoNumbers b) {
    return {a.first / b.first, a.second / b.second};
}
constexpr TwoNumbers operator+(TwoNumbers a, double b) { return a + TwoNumbers{b, b}; }
constexpr TwoNumbers operator-(TwoNumbers a, double b) { return a - TwoNumbers{b, b}; }
constexpr TwoNumbers operator-(double a, TwoNumbers b) { return TwoNumbers{a, a} - b; }
constexpr TwoNumbers operator*(double a, TwoNumbers b) { return TwoNumbers{a, a} * b; }
constexpr TwoNumbers operator*(TwoNumbers a, double b) { return a * TwoNumbers{b, b}; }

}  // namespace surfmesh
