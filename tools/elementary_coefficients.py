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


def main() -> None:
    print(HEAD, end="")
    sine_and_cosine()
    print("\n}  // namespace surfmesh::elementary")


if __name__ == "__main__":
    main()
