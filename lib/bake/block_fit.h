/** Lines through the texels of SLC_LANES blocks. */
#ifndef SLC_BAKE_BLOCK_FIT_H
#define SLC_BAKE_BLOCK_FIT_H

#include "bake/block_lanes.h"

/** Texels to be fitted: up to four channels of 16 numbers. */
struct slc_fit_points {
    int channel_count;
    const slc_floats *channels[4]; ///< [16] each
    const slc_floats *weights;     ///< [16]: 1 for texels that count, 0 for others; NULL: all 1
};

/** Always inlined, so that the compiler sees counts and precision as constants. */
#define SLC_INLINE static inline __attribute__((always_inline))

/** Computes the covariance of the channels, times the number of texels. */
SLC_INLINE void slc_fit_covariance(const struct slc_fit_points *points, slc_floats mean[4],
                                   slc_floats cov[4][4])
{
    slc_floats count = slc_all(points->weights ? 0.0f : 16.0f);
    for (int i = 0; i < 16 && points->weights; i++)
        count += points->weights[i];
    slc_floats inverse = 1.0f / slc_greater(count, slc_all(1.0f));
    for (int a = 0; a < points->channel_count; a++) {
        slc_floats sum = slc_all(0.0f), products[4] = {sum, sum, sum, sum};
        for (int i = 0; i < 16; i++) {
            slc_floats value = points->channels[a][i];
            if (points->weights)
                value *= points->weights[i];
            sum += value;
            for (int b = 0; b <= a; b++)
                products[b] += value * points->channels[b][i];
        }
        mean[a] = sum * inverse;
        for (int b = 0; b <= a; b++)
            cov[a][b] = cov[b][a] = products[b] - sum * mean[b];
    }
}

/** Finds the main axis by power iteration, from the column with the largest variance. */
SLC_INLINE void slc_fit_axis(int count, slc_floats cov[4][4], int rounds, slc_floats axis[4])
{
    slc_floats largest = cov[0][0], trace = cov[0][0];
    for (int c = 0; c < count; c++)
        axis[c] = cov[0][c];
    for (int a = 1; a < count; a++) {
        slc_ints larger = cov[a][a] > largest;
        largest = slc_select(larger, cov[a][a], largest);
        trace += cov[a][a];
        for (int c = 0; c < count; c++)
            axis[c] = slc_select(larger, cov[a][c], axis[c]);
    }
    slc_floats scale = 1.0f / (trace + 1e-6f);
    for (int r = 0; r < rounds; r++) {
        slc_floats next[4];
        for (int a = 0; a < count; a++) {
            next[a] = cov[a][0] * axis[0];
            for (int b = 1; b < count; b++)
                next[a] += cov[a][b] * axis[b];
        }
        for (int a = 0; a < count; a++)
            axis[a] = next[a] * scale;
    }
}

/** Finds the two ends: the outermost texels, projected on the axis through the mean. */
SLC_INLINE void slc_fit_line(const struct slc_fit_points *points, slc_floats ends[2][4])
{
    slc_floats mean[4], cov[4][4], axis[4];
    int count = points->channel_count;
    slc_fit_covariance(points, mean, cov);
    slc_fit_axis(count, cov, 3, axis);
    slc_floats length = slc_all(0.0f), offset = length, low = length, high = length;
    for (int c = 0; c < count; c++) {
        length += axis[c] * axis[c];
        offset += axis[c] * mean[c];
    }
    for (int i = 0; i < 16; i++) {
        slc_floats t = axis[0] * points->channels[0][i] - offset;
        for (int c = 1; c < count; c++)
            t += axis[c] * points->channels[c][i];
        if (points->weights)
            t *= points->weights[i];
        low = slc_lesser(low, t);
        high = slc_greater(high, t);
    }
    slc_floats inverse = 1.0f / slc_greater(length, slc_all(1e-20f));
    for (int c = 0; c < count; c++) {
        slc_floats first = mean[c] + axis[c] * (low * inverse);
        slc_floats last = mean[c] + axis[c] * (high * inverse);
        /* If all texels are one color, the axis is rounding error and may overflow. */
        ends[0][c] = slc_select(first - first == 0.0f, first, mean[c]);
        ends[1][c] = slc_select(last - last == 0.0f, last, mean[c]);
    }
}

#endif /* SLC_BAKE_BLOCK_FIT_H */
