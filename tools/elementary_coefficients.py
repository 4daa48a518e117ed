"""Coefficients of the core's elementary functions, computed with mpmath to 60 digits.

    python tools/elementary_coefficients.py > src/elementary_functions/coefficients.hpp

Polynomials are truncated Chebyshev series, which are within a few per cent of the minimax
polynomials of their degree; constants that are needed beyond double precision are sums of doubles.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import mpmath as mp

mp.mp.dps = 60
factorial = mp.factorial

HEAD = """\
// Coefficients of the elementary functions, made by tools/elementary_coefficients.py: do not edit.
#pragma once

#include <cstdint>

namespace surfmesh::elementary {
// clang-format off
"""


def hexadecimal(x: mp.mpf) -> str:
    """The double nearest to x as C++ writes it."""
    mantissa, exponent = float(x).hex().split("p")
    return f"{mantissa.rstrip('0').rstrip('.')}p{int(exponent)}"


def parts(x: mp.mpf, bits: Sequence[int] = (53,)) -> list[mp.mpf]:
    """x as a sum of numbers of so many bits each, the last one rounded to a double."""
    found = []
    for count in bits:
        unit = mp.mpf(2) ** (int(mp.floor(mp.log(abs(x), 2))) + 1 - count)
        found.append((mp.nint if count == 53 else mp.floor)(x / unit) * unit)
        x -= found[-1]
    return [*found, x]


def table(name: str, numbers: Sequence[mp.mpf], comment: str) -> None:
    print(f"\n// {comment}")
    print(f"inline constexpr double {name}[] = {{")
    for number in numbers:
        print(f"    {hexadecimal(number)},")
    print("};")


def constant(name: str, number: mp.mpf, comment: str) -> None:
    print(f"\n// {comment}")
    print(f"inline constexpr double {name} = {hexadecimal(number)};")


def power_series(coefficient: Callable[[int], mp.mpf], terms: int = 120) -> Callable:
    """x -> sum of coefficient(k) x^k."""
    falling = [mp.mpf(coefficient(k)) for k in range(terms)][::-1]
    return lambda x: mp.polyval(falling, x)


def polynomial(name: str, function: Callable, first: float, last: float, terms: int, what: str):
    """`terms` coefficients, constant first, of a function on [first, last]."""
    ends = [mp.mpf(first), mp.mpf(last)]
    falling, error = mp.chebyfit(function, ends, terms, error=True)
    table(name, falling[::-1], f"{what}; error {mp.nstr(error, 2)}")


def words_of_two_over_pi() -> None:
    """The bits of 2/pi behind the point, for arguments up to the largest double."""
    with mp.workprec(1400):
        bits = int(mp.floor(2 / mp.pi * mp.mpf(2) ** 1280))
    print("\n// 2/pi = sum of TWO_OVER_PI_WORDS[i] 2^(-32 (i + 1))")
    print("inline constexpr std::uint32_t TWO_OVER_PI_WORDS[] = {")
    words = [f"0x{bits >> (1248 - 32 * k) & 0xFFFFFFFF:08x}" for k in range(40)]
    for start in range(0, 40, 8):
        print(f"    {', '.join(words[start : start + 8])},")
    print("};")


def sine_and_cosine() -> None:
    constant("TWO_OVER_PI", 2 / mp.pi, "2/pi")
    table("HALF_PI_PARTS", parts(mp.pi / 2, [33, 33, 33]), "pi/2 = their sum; 33 bits each")
    table("HALF_PI", parts(mp.pi / 2), "pi/2 = their sum")
    words_of_two_over_pi()
    last = (mp.pi / 4) ** 2 * 1.0001
    sine = power_series(lambda k: (-1) ** (k + 1) / factorial(2 * k + 3))
    cosine = power_series(lambda k: (-1) ** k / factorial(2 * k + 4))
    polynomial("SINE", sine, 0, last, 6, "(sin x - x) / x^3 in x^2, |x| <= pi/4")
    polynomial("COSINE", cosine, 0, last, 6, "(cos x - 1 + x^2 / 2) / x^4 in x^2, likewise")


def exponential_and_logarithm() -> None:
    constant("LOG2_E", 1 / mp.ln(2), "1 / ln 2")
    table("LN2_PARTS", parts(mp.ln(2), [42, 42]), "ln 2 = their sum; 42 bits each")
    last = mp.ln(2) / 2 * mp.mpf("1.0001")
    exponential = power_series(lambda k: 1 / factorial(k + 2))
    polynomial("EXPONENTIAL", exponential, -last, last, 11, "(e^x - 1 - x) / x^2, |x| <= ln 2 / 2")
    last = ((mp.sqrt(2) - 1) / (mp.sqrt(2) + 1)) ** 2 * mp.mpf("1.0001")
    what = "(log((1 + s) / (1 - s)) - 2 s) / s^3 in s^2, (1 + s) / (1 - s) in [sqrt(1/2), sqrt(2)]"
    polynomial("LOGARITHM", power_series(lambda k: mp.mpf(2) / (2 * k + 3)), 0, last, 8, what)
    table("TWO_THIRDS", parts(mp.mpf(2) / 3), "2/3 = their sum")
    sinh = power_series(lambda k: 1 / factorial(2 * k + 3))
    cosh = power_series(lambda k: 1 / factorial(2 * k + 2))
    polynomial("HYPERBOLIC_SINE", sinh, 0, 1, 7, "(sinh x - x) / x^3 in x^2, |x| <= 1")
    polynomial("HYPERBOLIC_COSINE", cosh, 0, 1, 7, "(cosh x - 1) / x^2 in x^2, |x| <= 1")


def central(k: int) -> mp.mpf:
    """Of asin x = sum of central(k) x^(2k + 1)."""
    return mp.binomial(2 * k, k) / (mp.mpf(4) ** k * (2 * k + 1))


def inverse_functions() -> None:
    table("QUARTER_PI", parts(mp.pi / 4), "pi/4 = their sum")
    constant("TAN_OF_PI_8", mp.tan(mp.pi / 8), "tan(pi/8)")
    last = mp.tan(mp.pi / 8) ** 2 * mp.mpf("1.0001")
    atan = power_series(lambda k: mp.mpf((-1) ** (k + 1)) / (2 * k + 3))
    polynomial("ARC_TANGENT", atan, 0, last, 12, "(atan x - x) / x^3 in x^2, |x| <= tan(pi/8)")
    asin = power_series(lambda k: central(k + 1))
    polynomial("ARC_SINE", asin, 0, mp.mpf(1) / 4, 14, "(asin x - x) / x^3 in x^2, |x| <= 1/2")
    asinh = power_series(lambda k: (-1) ** (k + 1) * central(k + 1))
    last = mp.mpf(1) / 64
    polynomial("AREA_SINE", asinh, 0, last, 7, "(asinh x - x) / x^3 in x^2, |x| <= 1/8")
    polynomial("CUBE_ROOT", mp.cbrt, 1, 8, 8, "cbrt x, 1 <= x <= 8, a first approximation")


def error_function() -> None:
    """erf on [0, 6] in 12 pieces."""
    first = power_series(
        lambda k: 2 / mp.sqrt(mp.pi) * (-1) ** (k + 1) / (factorial(k + 1) * (2 * k + 3))
    )
    table("TWO_OVER_ROOT_PI", parts(2 / mp.sqrt(mp.pi)), "2 / sqrt(pi) = their sum")
    what = "(erf x - 2 x / sqrt(pi)) / x^3 in x^2, |x| <= 1/2"
    polynomial("ERROR_FUNCTION", first, 0, mp.mpf(1) / 4, 9, what)
    print("\n// erf x, k/2 <= x < (k + 1)/2, k = 1 ... 11, in x - (2 k + 1)/4: high, low, slopes")
    print("inline constexpr double ERROR_FUNCTION_PIECES[][16] = {")
    for k in range(1, 12):
        middle = mp.mpf(2 * k + 1) / 4
        high, low = parts(mp.erf(middle))

        def rest(d: mp.mpf, middle: mp.mpf = middle) -> mp.mpf:
            if abs(d) < mp.mpf("1e-20"):
                return 2 / mp.sqrt(mp.pi) * mp.exp(-(middle**2))
            return (mp.erf(middle + d) - mp.erf(middle)) / d

        with mp.workdps(100):
            falling = mp.chebyfit(rest, [-mp.mpf(1) / 4, mp.mpf(1) / 4], 14)
        numbers = ", ".join(hexadecimal(number) for number in [high, low, *falling[::-1]])
        print(f"    {{{numbers}}},")
    print("};")


def bessel_functions() -> None:
    for n, last, terms in ((1, 4, 10), (2, 9, 12)):
        series = power_series(
            lambda k, n=n: mp.mpf(-1) ** k / (2**k * factorial(k) * mp.fac2(2 * n + 2 * k + 1)), 60
        )
        what = f"j{n}(x) / x^{n} in x^2, |x| <= {int(last**0.5)}"
        polynomial(f"BESSEL_{n}", series, 0, last, terms, what)


def main() -> None:
    print(HEAD, end="")
    sine_and_cosine()
    exponential_and_logarithm()
    inverse_functions()
    error_function()
    bessel_functions()
    print("\n// clang-format on")
    print("}  // namespace surfmesh::elementary")


if __name__ == "__main__":
    main()
