#include "image/small_float.h"

#include <math.h>

/* Constants of the specification: mantissa bits, exponent bias, largest exponent. */
enum { N = 9, B = 15, E_MAX = 31 };

static double clamp(float value)
{
    const double max = (double)((1 << N) - 1) / (1 << N) * (1 << (E_MAX - B)); /* 65408 */
    if (!(value > 0.0f))
        return 0.0;
    return value < max ? value : max;
}

/* In double all operations are exact, except the intended roundings. */
uint32_t slc_e5b9g9r9_from_float(const float rgb[3])
{
    double clamped[3] = {clamp(rgb[0]), clamp(rgb[1]), clamp(rgb[2])};
    double largest = fmax(clamped[0], fmax(clamped[1], clamped[2]));
    int exponent = 0; /* power of 2 as in frexp: largest = [0.5, 1) * 2^exponent */
    frexp(largest, &exponent);
    int shared = largest > 0.0 && exponent > -B ? exponent + B : 0;
    if (floor(ldexp(largest, B + N - shared) + 0.5) >= 1 << N)
        shared++;
    uint32_t texel = (uint32_t)shared << 27;
    for (int c = 0; c < 3; c++)
        texel |= (uint32_t)floor(ldexp(clamped[c], B + N - shared) + 0.5) << (N * c);
    return texel;
}

void slc_float_from_e5b9g9r9(uint32_t texel, float rgb[3])
{
    int exponent = (int)(texel >> 27) - B - N;
    for (int c = 0; c < 3; c++)
        rgb[c] = ldexpf((float)(texel >> (N * c) & 0x1FFu), exponent);
}
