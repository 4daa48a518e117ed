// Coefficients of the elementary functions, made by tools/elementary_coefficients.py: do not edit.
#pragma once

#include <cstdint>

namespace surfmesh::elementary {

// 2/pi
inline constexpr double TWO_OVER_PI = 0x1.45f306dc9c883p-1;

// pi/2 = their sum; 33 bits each
inline constexpr double HALF_PI_PARTS[] = {
    0x1.921fb544p0,
    0x1.0b4611a6p-34,
    0x1.3198a2ep-69,
    0x1.b839a252049c1p-104,
};

// pi/2 = their sum
inline constexpr double HALF_PI[] = {
    0x1.921fb54442d18p0,
    0x1.1a62633145c07p-54,
};

// 2/pi = sum of TWO_OVER_PI_WORDS[i] 2^(-32 (i + 1))
inline constexpr std::uint32_t TWO_OVER_PI_WORDS[] = {
    0xa2f9836e, 0x4e441529, 0xfc2757d1, 0xf534ddc0, 0xdb629599, 0x3c439041, 0xfe5163ab, 0xdebbc561,
    0xb7246e3a, 0x424dd2e0, 0x06492eea, 0x09d1921c, 0xfe1deb1c, 0xb129a73e, 0xe88235f5, 0x2ebb4484,
    0xe99c7026, 0xb45f7e41, 0x3991d639, 0x835339f4, 0x9c845f8b, 0xbdf9283b, 0x1ff897ff, 0xde05980f,
    0xef2f118b, 0x5a0a6d1f, 0x6d367ecf, 0x27cb09b7, 0x4f463f66, 0x9e5fea2d, 0x7527bac7, 0xebe5f17b,
    0x3d0739f7, 0x8a5292ea, 0x6bfb5fb1, 0x1f8d5d08, 0x56033046, 0xfc7b6bab, 0xf0cfbc20, 0x9af4361d,
};

// (sin x - x) / x^3 in x^2, |x| <= pi/4; error 2.0e-17
inline constexpr double SINE[] = {
    -0x1.5555555555555p-3, 0x1.1111111110bb2p-7,   -0x1.a01a019e83816p-13,
    0x1.71de379654304p-19, -0x1.ae600aca92c64p-26, 0x1.5e0b05bff20f2p-33,
};

// (cos x - 1 + x^2 / 2) / x^4 in x^2, likewise; error 1.3e-18
inline constexpr double COSINE[] = {
    0x1.5555555555555p-5,   -0x1.6c16c16c16967p-10, 0x1.a01a019f4e9b4p-16,
    -0x1.27e4fa17bf139p-22, 0x1.1eeb68cd22f56p-29,  -0x1.907d8f29fe831p-37,
};

}  // namespace surfmesh::elementary
