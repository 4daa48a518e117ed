#include "elementary_functions/sine_cosine.hpp"

#include "elementary_functions/blocks.hpp"

namespace surfmesh::elementary {
namespace {

bool is_moderate(double x) { return std::abs(x) <= MODERATE; }

std::uint64_t is_large(double x) { return is_above(x, MODERATE); }

double tan_moderate(double x) { return tan(reduce_moderate(x)); }

}  // namespace

SineCosine sincos_beyond(double x) {
    if (!std::isfinite(x)) return {x - x, x - x};
    return sincos(reduce_large(x));
}

double tan(double x) {
    if (is_moderate(x)) return tan_moderate(x);
    return std::isfinite(x) ? tan(reduce_large(x)) : x - x;
}

void sin(std::span<const double> x, std::span<double> out) {
    map_blocks(
        x, out, [](double a) { return sincos_moderate(a).sine; }, is_large,
        [](double a) { return sin(a); });
}

void cos(std::span<const double> x, std::span<double> out) {
    map_blocks(
        x, out, [](double a) { return sincos_moderate(a).cosine; }, is_large,
        [](double a) { return cos(a); });
}

void sincos(std::span<const double> x, std::span<double> sine, std::span<double> cosine) {
    for (std::size_t start = 0; start < x.size(); start += CHUNK) {
        const std::size_t count = std::min(CHUNK, x.size() - start);
        std::array<double, CHUNK> given, s, c;
        std::copy_n(x.data() + start, count, given.data());
        std::uint64_t special = 0;
        for (std::size_t k = 0; k < count; ++k) special |= is_large(given[k]);
        for (std::size_t k = 0; k < count; ++k) {
            const SineCosine both = sincos_moderate(given[k]);
            s[k] = both.sine;
            c[k] = both.cosine;
        }
        for (std::size_t k = 0; special >> 63 != 0 && k < count; ++k)
            if (!is_moderate(given[k])) {
                const SineCosine both = sincos_beyond(given[k]);
                s[k] = both.sine;
                c[k] = both.cosine;
            }
        std::copy_n(s.data(), count, sine.data() + start);
        std::copy_n(c.data(), count, cosine.data() + start);
    }
}

void tan(std::span<const double> x, std::span<double> out) {
    map_blocks(x, out, tan_moderate, is_large, [](double a) { return tan(a); });
}

}  // namespace surfmesh::elementary
