/** Fits texels of SLC_LANES blocks by two ends that a mode of BC7 can store. */
#ifndef SLC_BAKE_BC7_FIT_H
#define SLC_BAKE_BC7_FIT_H

#include "bake/block_fit.h"

#include <stdbool.h>

/** p bits: the lowest bit of all channels, per end (OWN) or of both ends (SHARED). */
enum slc_p_bits { SLC_P_BITS_NONE, SLC_P_BITS_OWN, SLC_P_BITS_SHARED };

/** Precision of a mode's ends and indices. */
struct slc_bc7_precision {
    int bits; ///< per channel of an end, p bit included
    enum slc_p_bits p_bits;
    int index_count; ///< 4, 8 or 16
};

struct slc_bc7_fit {
    slc_ints ends[2][4]; ///< codes with their p bits
    slc_ints indices[16];
    slc_floats error; ///< sum of squares over texels and channels
};

/* Decodes a code to 0 to 255. */
SLC_INLINE slc_floats slc_bc7_value(slc_ints code, int bits)
{
    return slc_to_floats((code << (8 - bits)) | (code >> (2 * bits - 8)));
}

/* Returns the nearest code with the p bit `p`. Adds the squared distance to `error`. */
SLC_INLINE slc_ints slc_bc7_code(slc_floats value, const struct slc_bc7_precision *precision, int p,
                                 slc_floats *error)
{
    int bits = precision->bits;
    slc_floats wanted = slc_clamp(value, 0.0f, 255.0f), code;
    code = wanted * ((float)((1 << bits) - 1) / 255.0f);
    slc_ints codes;
    if (precision->p_bits == SLC_P_BITS_NONE) {
        codes = slc_to_ints(code + 0.5f);
    } else {
        code = slc_clamp((code - (float)p) * 0.5f + 0.5f, 0.0f, (float)(1 << (bits - 1)) - 0.5f);
        codes = slc_to_ints(code) * 2 + p;
    }
    slc_floats off = slc_bc7_value(codes, bits) - wanted;
    *error += off * off;
    return codes;
}

SLC_INLINE void slc_bc7_quantize(const struct slc_fit_points *points,
                                 const struct slc_bc7_precision *precision, slc_ints sets_p,
                                 slc_floats ends[2][4], slc_ints codes[2][4])
{
    slc_ints other[2][4];
    slc_floats error[2][2] = {{{0}}};
    bool has_p = precision->p_bits != SLC_P_BITS_NONE;
    for (int e = 0; e < 2; e++)
        for (int c = 0; c < points->channel_count; c++) {
            codes[e][c] = slc_bc7_code(ends[e][c], precision, 0, &error[e][0]);
            if (has_p)
                other[e][c] = slc_bc7_code(ends[e][c], precision, 1, &error[e][1]);
        }
    for (int e = 0; e < 2 && has_p; e++) {
        slc_ints set = error[e][1] < error[e][0];
        if (precision->p_bits == SLC_P_BITS_SHARED)
            set = error[0][1] + error[1][1] < error[0][0] + error[1][0];
        set |= sets_p;
        for (int c = 0; c < points->channel_count; c++)
            codes[e][c] = slc_select_ints(set, other[e][c], codes[e][c]);
    }
}

/* Returns round(64 index / (count - 1)), which equals the weight tables of the specification. */
SLC_INLINE slc_floats slc_bc7_weight(slc_ints index, int count)
{
    slc_floats scaled = slc_to_floats(index) * (64.0f / (float)(count - 1)) + 0.5f;
    return slc_to_floats(slc_to_ints(scaled));
}

/* Finds the nearest indices and the error of the decoded block. */
SLC_INLINE void slc_bc7_index(const struct slc_fit_points *points,
                              const struct slc_bc7_precision *precision, struct slc_bc7_fit *fit)
{
    int count = points->channel_count, last = precision->index_count - 1;
    slc_floats low[4], step[4], along[4], length = slc_all(0.0f), offset = slc_all(0.5f);
    for (int c = 0; c < count; c++) {
        low[c] = slc_bc7_value(fit->ends[0][c], precision->bits);
        step[c] = slc_bc7_value(fit->ends[1][c], precision->bits) - low[c];
        length += step[c] * step[c];
    }
    slc_floats scale = (float)last / slc_greater(length, slc_all(1.0f));
    for (int c = 0; c < count; c++) {
        along[c] = step[c] * scale;
        offset -= low[c] * along[c];
        low[c] = low[c] * 64.0f + 32.0f;
    }
    fit->error = slc_all(0.0f);
    for (int i = 0; i < 16; i++) {
        slc_floats t = offset, error = slc_all(0.0f);
        for (int c = 0; c < count; c++)
            t += along[c] * points->channels[c][i];
        fit->indices[i] = slc_to_ints(slc_clamp(t, 0.0f, (float)last + 0.5f));
        slc_floats weight = slc_bc7_weight(fit->indices[i], precision->index_count);
        for (int c = 0; c < count; c++) {
            slc_ints decoded = slc_to_ints(low[c] + step[c] * weight) >> 6;
            slc_floats off = slc_to_floats(decoded) - points->channels[c][i];
            error += off * off;
        }
        fit->error += points->weights ? error * points->weights[i] : error;
    }
}

/* Finds the ends with the least squared error. Ends stay as they are if all indices are equal. */
SLC_INLINE void slc_bc7_solve(const struct slc_fit_points *points,
                              const struct slc_bc7_precision *precision,
                              const struct slc_bc7_fit *fit, slc_floats ends[2][4])
{
    slc_floats zero = slc_all(0.0f), n = zero, b = zero, bb = zero;
    slc_floats sum[4] = {zero, zero, zero, zero}, b_sum[4] = {zero, zero, zero, zero};
    for (int i = 0; i < 16; i++) {
        slc_floats one = points->weights ? points->weights[i] : slc_all(1.0f);
        slc_floats weight = slc_bc7_weight(fit->indices[i], precision->index_count) * 0.015625f;
        if (points->weights)
            weight *= one;
        n += one;
        b += weight;
        bb += weight * weight;
        for (int c = 0; c < points->channel_count; c++) {
            sum[c] += points->channels[c][i] * one;
            b_sum[c] += points->channels[c][i] * weight;
        }
    }
    slc_floats ab = b - bb, aa = n - b - ab, det = aa * bb - ab * ab;
    slc_ints solvable = det > 1e-3f;
    slc_floats inverse = 1.0f / slc_greater(det, slc_all(1e-3f));
    for (int c = 0; c < points->channel_count; c++) {
        slc_floats a_sum = sum[c] - b_sum[c];
        slc_floats low = (a_sum * bb - b_sum[c] * ab) * inverse;
        slc_floats high = (b_sum[c] * aa - a_sum * ab) * inverse;
        ends[0][c] = slc_select(solvable, low, ends[0][c]);
        ends[1][c] = slc_select(solvable, high, ends[1][c]);
    }
}

/**
 * Fits texels and improves the ends `rounds` times. p bits are 1 in lanes where `sets_p` is -1, so
 * that alpha 255 is exact.
 */
SLC_INLINE void slc_bc7_fit_points(const struct slc_fit_points *points,
                                   const struct slc_bc7_precision *precision, slc_ints sets_p,
                                   int rounds, struct slc_bc7_fit *best)
{
    slc_floats ends[2][4];
    struct slc_bc7_fit fit;
    slc_fit_line(points, ends);
    slc_bc7_quantize(points, precision, sets_p, ends, best->ends);
    slc_bc7_index(points, precision, best);
    fit = *best;
    for (int r = 0; r < rounds; r++) {
        slc_bc7_solve(points, precision, &fit, ends);
        slc_bc7_quantize(points, precision, sets_p, ends, fit.ends);
        slc_bc7_index(points, precision, &fit);
        slc_ints better = fit.error < best->error;
        best->error = slc_select(better, fit.error, best->error);
        for (int e = 0; e < 2; e++)
            for (int c = 0; c < points->channel_count; c++)
                best->ends[e][c] = slc_select_ints(better, fit.ends[e][c], best->ends[e][c]);
        for (int i = 0; i < 16; i++)
            best->indices[i] = slc_select_ints(better, fit.indices[i], best->indices[i]);
    }
}

#endif /* SLC_BAKE_BC7_FIT_H */
