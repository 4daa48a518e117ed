// Coefficients of the elementary functions, made by tools/elementary_coefficients.py: do not edit.
#pragma once

#include <cstdint>

namespace surfmesh::elementary {
// clang-format off

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
    -0x1.5555555555555p-3,
    0x1.1111111110bb2p-7,
    -0x1.a01a019e83816p-13,
    0x1.71de379654304p-19,
    -0x1.ae600aca92c64p-26,
    0x1.5e0b05bff20f2p-33,
};

// (cos x - 1 + x^2 / 2) / x^4 in x^2, likewise; error 1.3e-18
inline constexpr double COSINE[] = {
    0x1.5555555555555p-5,
    -0x1.6c16c16c16967p-10,
    0x1.a01a019f4e9b4p-16,
    -0x1.27e4fa17bf139p-22,
    0x1.1eeb68cd22f56p-29,
    -0x1.907d8f29fe831p-37,
};

// 1 / ln 2
inline constexpr double LOG2_E = 0x1.71547652b82fep0;

// ln 2 = their sum; 42 bits each
inline constexpr double LN2_PARTS[] = {
    0x1.62e42fefa38p-1,
    0x1.ef35793c76p-45,
    0x1.cc01f97b57a08p-87,
};

// (e^x - 1 - x) / x^2, |x| <= ln 2 / 2; error 1.4e-18
inline constexpr double EXPONENTIAL[] = {
    0x1p-1,
    0x1.5555555555557p-3,
    0x1.5555555555556p-5,
    0x1.11111111100dcp-7,
    0x1.6c16c16c162d4p-10,
    0x1.a01a01abe7fe1p-13,
    0x1.a01a01a6d889cp-16,
    0x1.71de0231960ebp-19,
    0x1.27e4db646b17ep-22,
    0x1.af4de97ca4194p-26,
    0x1.1f730349868cep-29,
};

// (log((1 + s) / (1 - s)) - 2 s) / s^3 in s^2, (1 + s) / (1 - s) in [sqrt(1/2), sqrt(2)]; error 2.1e-18
inline constexpr double LOGARITHM[] = {
    0x1.5555555555555p-1,
    0x1.9999999999a38p-2,
    0x1.2492492476c87p-2,
    0x1.c71c720160b47p-3,
    0x1.745cf901605f7p-3,
    0x1.3b1c360763b8ap-3,
    0x1.0fbe83c2cbcf3p-3,
    0x1.0c04595972ab8p-3,
};

// 2/3 = their sum
inline constexpr double TWO_THIRDS[] = {
    0x1.5555555555555p-1,
    0x1.5555555555555p-55,
};

// (sinh x - x) / x^3 in x^2, |x| <= 1; error 3.5e-19
inline constexpr double HYPERBOLIC_SINE[] = {
    0x1.5555555555555p-3,
    0x1.11111111110fdp-7,
    0x1.a01a01a01ee7p-13,
    0x1.71de3a4e14f4p-19,
    0x1.ae6460fae3728p-26,
    0x1.611cb330c1fe8p-33,
    0x1.b41232cf9950fp-41,
};

// (cosh x - 1) / x^2 in x^2, |x| <= 1; error 5.9e-18
inline constexpr double HYPERBOLIC_COSINE[] = {
    0x1p-1,
    0x1.5555555555502p-5,
    0x1.6c16c16c212cp-10,
    0x1.a01a01907b7eep-16,
    0x1.27e5069de9344p-22,
    0x1.1ee5640e638a2p-29,
    0x1.99848a67700e4p-37,
};

// pi/4 = their sum
inline constexpr double QUARTER_PI[] = {
    0x1.921fb54442d18p-1,
    0x1.1a62633145c07p-55,
};

// tan(pi/8)
inline constexpr double TAN_OF_PI_8 = 0x1.a827999fcef32p-2;

// (atan x - x) / x^3 in x^2, |x| <= tan(pi/8); error 1.2e-18
inline constexpr double ARC_TANGENT[] = {
    -0x1.5555555555555p-2,
    0x1.9999999999953p-3,
    -0x1.249249248d7dcp-3,
    0x1.c71c71c303dbbp-4,
    -0x1.745d165dc9713p-4,
    0x1.3b1392d519db1p-4,
    -0x1.110e87b4357d2p-4,
    0x1.e19a0bfa3eef9p-5,
    -0x1.ac7a5a79b3f26p-5,
    0x1.74dccfb93fffp-5,
    -0x1.1b311bb48c215p-5,
    0x1.0acd9e91a5a35p-6,
};

// (asin x - x) / x^3 in x^2, |x| <= 1/2; error 9.8e-19
inline constexpr double ARC_SINE[] = {
    0x1.5555555555555p-3,
    0x1.3333333333388p-4,
    0x1.6db6db6dac1ep-5,
    0x1.f1c71c7a52ba3p-6,
    0x1.6e8ba123e494cp-6,
    0x1.1c4efce23019fp-6,
    0x1.c990ad3d8fdcap-7,
    0x1.7b027ee1dd585p-7,
    0x1.3b49de7121487p-7,
    0x1.31622469ce5adp-7,
    0x1.8f193743418ffp-9,
    0x1.406192d124629p-6,
    -0x1.3b416bb7d9257p-6,
    0x1.e529c6fce9bb4p-6,
};

// (asinh x - x) / x^3 in x^2, |x| <= 1/8; error 3.1e-19
inline constexpr double AREA_SINE[] = {
    -0x1.5555555555555p-3,
    0x1.33333333332a9p-4,
    -0x1.6db6db6d719a2p-5,
    0x1.f1c71ba1ba081p-6,
    -0x1.6e8b0df0f5e81p-6,
    0x1.1c17e86e3e76dp-6,
    -0x1.b57798388daf8p-7,
};

// cbrt x, 1 <= x <= 8, a first approximation; error 0.00025
inline constexpr double CUBE_ROOT[] = {
    0x1.171824adc18aap-1,
    0x1.417c128aef599p-1,
    -0x1.d2e6c45182729p-3,
    0x1.10a679807fa0ap-4,
    -0x1.9f829cb2fdbbbp-7,
    0x1.82cc1c40bc138p-10,
    -0x1.8e234751b23bap-14,
    0x1.5a7ca1362129ep-19,
};

// 2 / sqrt(pi) = their sum
inline constexpr double TWO_OVER_ROOT_PI[] = {
    0x1.20dd750429b6dp0,
    0x1.1ae3a914fed8p-56,
};

// (erf x - 2 x / sqrt(pi)) / x^3 in x^2, |x| <= 1/2; error 3.9e-19
inline constexpr double ERROR_FUNCTION[] = {
    -0x1.812746b0379e7p-2,
    0x1.ce2f21a042bcfp-4,
    -0x1.b82ce31286cbcp-6,
    0x1.565bcd0d2ff6ep-8,
    -0x1.c02db335c071dp-11,
    0x1.f9a2dd9e25187p-14,
    -0x1.f4c2b861c2c9cp-17,
    0x1.b7f36af42c55ep-20,
    -0x1.3d8e8315e4ddep-23,
};

// erf x, k/2 <= x < (k + 1)/2, k = 1 ... 11, in x - (2 k + 1)/4: high, low, slopes
inline constexpr double ERROR_FUNCTION_PIECES[][16] = {
    {0x1.6c1c9759d0e5fp-1, 0x1.b1432f2cbc455p-55, 0x1.492e42d78d2c5p-1, -0x1.edc5644353c27p-2, 0x1.b6e8591f668b1p-6, 0x1.349b5eaa145eap-3, -0x1.b42a1890a0eb8p-5, -0x1.b8477966dbf42p-6, 0x1.2e0afae9b530ep-6, 0x1.2db3337432936p-9, -0x1.04104485a7efbp-8, 0x1.8621f0de0d331p-13, 0x1.4713cff8b7184p-11, -0x1.bd1e9c7fe50afp-14, -0x1.372fab2a1ba55p-14, 0x1.675395e3bdbd7p-16},
    {0x1.d8865d98abe01p-1, -0x1.fcec4afb974d9p-55, 0x1.e4652fadcb6b2p-3, -0x1.2ebf3dcc9f22fp-2, 0x1.571d01c5c576p-3, -0x1.93a9a7bb7f1c7p-8, -0x1.8281ce0b5d725p-5, 0x1.5d0003af8124bp-6, 0x1.db43ca6554e5ap-9, -0x1.75672d04e991p-8, 0x1.cc21a7ad7d28ap-11, 0x1.a00773a339255p-11, -0x1.539192b8c3af5p-12, -0x1.ba9b344b2cf88p-15, 0x1.c8ae910f36d87p-15, -0x1.6dbb6aec33a68p-19},
    {0x1.f92d077f8d56dp-1, 0x1.8b55ef493fce7p-56, 0x1.b055303221016p-5, -0x1.7a4a8a2bdce13p-4, 0x1.7148c3d57c26ep-4, -0x1.8a0da54306143p-5, 0x1.b22257dda5c39p-8, 0x1.25b378c926554p-7, -0x1.8d10fba945f4bp-8, 0x1.7ec1d1f17005dp-11, 0x1.d4cf632c29957p-11, -0x1.d041f779426fp-12, -0x1.717f97218bc12p-18, 0x1.200aed2ea315cp-14, -0x1.1d7248362f9a5p-16, -0x1.38d78c66b245ep-18},
    {0x1.ff404760319b4p-1, 0x1.f142071432025p-56, 0x1.d4143a9dfe964p-8, -0x1.074b60f8df349p-6, 0x1.63ef61e8244dp-6, -0x1.38a98327890c5p-6, 0x1.5d3b17bbcb923p-7, -0x1.7cae0d45c2258p-9, -0x1.5f8313369b94p-11, 0x1.0602e347fbee3p-10, -0x1.8352faf51808cp-12, -0x1.80c24d48c8063p-17, 0x1.11430333dd2cep-14, -0x1.7c985a3b48a98p-16, -0x1.971515026dcb1p-20, 0x1.c65b166c6301p-19},
    {0x1.fff2cfb0453d9p-1, 0x1.9a913686042a3p-55, 0x1.3360ccd23db3ap-11, -0x1.a6a519a114d7p-10, 0x1.69cf466ccdf6ap-9, -0x1.ab0c273ac26ecp-9, 0x1.69359606645b3p-9, -0x1.b2755bfd5d9dbp-10, 0x1.52b6263fbd742p-11, -0x1.755772e5cf495p-14, -0x1.2abb3d9b15bcp-14, 0x1.cd5952dfd66bp-15, -0x1.09d0591ac5944p-16, -0x1.20104c843c482p-20, 0x1.68a9225d22a6dp-19, -0x1.de97da11a909fp-21},
    {0x1.ffff6f9f67e55p-1, 0x1.e1e4483ba034bp-55, 0x1.e9b5e8d00ce8p-16, -0x1.8de3cd290a7c1p-14, 0x1.9aa489e3ca63dp-13, -0x1.2c7d5ef053d4dp-12, 0x1.490a4d2345c9dp-12, -0x1.145464ea3ea46p-12, 0x1.647f71f2bfb67p-13, -0x1.567479a82ea0dp-14, 0x1.b2c35b1c8c428p-16, -0x1.3893fa844ef4dp-19, -0x1.809bd02211cc8p-19, 0x1.ff552dcb696bfp-20, -0x1.1e7cc89ce34dfp-21, -0x1.5a9cc83adb821p-29},
    {0x1.fffffc2f171e3p-1, 0x1.85edd0395f475p-55, 0x1.d9371e2ff7bf9p-21, -0x1.bba3ac4cf847p-19, 0x1.0b6a7b0f1cc93p-17, -0x1.d06f58609413ep-17, 0x1.3436bc9f0bfd4p-16, -0x1.4357b55459e4dp-16, 0x1.110de4e13c93dp-16, -0x1.7566befdb0014p-17, 0x1.99f593d6ebea4p-18, -0x1.5d68f88f822cbp-19, 0x1.a06761d95439fp-21, -0x1.835421a5a833bp-24, -0x1.037beec04147dp-24, 0x1.70fe33beff00bp-25},
    {0x1.fffffff01a8b6p-1, 0x1.23370eca5ca6ap-60, 0x1.155a09065d4b8p-26, -0x1.26afa996c3232p-24, 0x1.95ea6fdffe3e1p-23, -0x1.96ba7366c1e94p-22, 0x1.3b468018fcb3p-21, -0x1.8868e1d18b0f7p-21, 0x1.916e9278424b6p-21, -0x1.566f02264ebcfp-21, 0x1.eab4cd71f6037p-22, -0x1.275891fcab90bp-22, 0x1.27de23e0bfae1p-23, -0x1.e0569906939e8p-25, 0x1.2496c69a00a91p-26, -0x1.8e903fcd79c1ap-29},
    {0x1.ffffffffd759dp-1, 0x1.f7bee7eb2342p-55, 0x1.8a61745ec8f2p-33, -0x1.d453ba308d59dp-31, 0x1.6a8aeba4080a2p-29, -0x1.9b017abbe490ap-28, 0x1.6b43c96e96861p-27, -0x1.042f2a6971f11p-26, 0x1.35dc7dedbca55p-26, -0x1.3834e3aec9615p-26, 0x1.0d4de0d7704f3p-26, -0x1.90aa80b288d06p-27, 0x1.01b972fdd330ap-27, -0x1.1ed6e9878149fp-28, 0x1.19bad55fa1f3bp-29, -0x1.bffd73223bb84p-31},
    {0x1.ffffffffffc05p-1, 0x1.07ba96a6b2e1ap-55, 0x1.5422ef5d93bf3p-40, -0x1.be6dda2ac53e3p-38, 0x1.7f8a0f3a22a32p-36, -0x1.e4cb4ae9a2e52p-35, 0x1.e044b4eb32629p-34, -0x1.83ea4bd5e0266p-33, 0x1.065940b2186f7p-32, -0x1.2ec544ec7ce54p-32, 0x1.2e3ca696517a6p-32, -0x1.07831523c117dp-32, 0x1.935d883f87f62p-33, -0x1.1176acf1145ccp-33, 0x1.5a5a77795b393p-34, -0x1.6a98a7d902e7fp-35},
    {0x1.ffffffffffffcp-1, 0x1.8115fd1b12786p-56, 0x1.63daf8b4f56dfp-48, -0x1.ff8ac583c84d4p-46, 0x1.e2d06d55f8efbp-44, -0x1.505d953256cb2p-42, 0x1.70b70451091d2p-41, -0x1.4aed68fbd911fp-40, 0x1.f3c4f7d4b2dfbp-40, -0x1.43c0fc7dd0662p-39, 0x1.6d26b2b537a5ep-39, -0x1.6a55415e480e7p-39, 0x1.3dc604ba24573p-39, -0x1.f4671b928c8edp-40, 0x1.7ec7f88c56bb2p-40, -0x1.de94f3adccf22p-41},
};

// j1(x) / x^1 in x^2, |x| <= 2; error 1.6e-21
inline constexpr double BESSEL_1[] = {
    0x1.5555555555555p-2,
    -0x1.1111111111111p-5,
    0x1.381381381381p-10,
    -0x1.71de3a556c4b4p-16,
    0x1.0cfeb60f84702p-22,
    -0x1.08db48e44dcbbp-29,
    0x1.78af525347e19p-37,
    -0x1.952af17a064b8p-45,
    0x1.54dfdbf8c093bp-53,
    -0x1.ba7954d6d58b9p-62,
};

// j2(x) / x^2 in x^2, |x| <= 3; error 2.6e-24
inline constexpr double BESSEL_2[] = {
    0x1.1111111111111p-4,
    -0x1.3813813813814p-8,
    0x1.1566abc011567p-13,
    -0x1.0cfeb60f94b0cp-19,
    0x1.4b121b26de511p-26,
    -0x1.1a8380fb99362p-33,
    0x1.6286e82051ba6p-41,
    -0x1.5532ea56a7e6bp-49,
    0x1.03f5ec68f2cb1p-57,
    -0x1.4178e7d1e9e42p-66,
    0x1.483f545d1c42bp-75,
    -0x1.068f6394f13b1p-84,
};

// clang-format on
}  // namespace surfmesh::elementary
