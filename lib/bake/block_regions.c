#include "bake/block_regions.h"

#include "bake/block_fit.h"
#include "bake/block_partitions.h"

#include <float.h>

/* Sums over texels of three colors (0 to 2) and their products (3 to 8). */
struct moments {
    slc_floats count, sums[9];
};

/* Returns the sum of squared distances from the best line. */
static slc_floats line_error(const struct moments *m)
{
    static const int at[3][3] = {{3, 4, 5}, {4, 6, 7}, {5, 7, 8}};
    slc_floats cov[4][4], axis[4], trace = slc_all(0.0f), length = trace, along = trace;
    slc_floats inverse = 1.0f / slc_greater(m->count, slc_all(1.0f));
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            cov[a][b] = m->sums[at[a][b]] - m->sums[a] * m->sums[b] * inverse;
    slc_fit_axis(3, cov, 2, axis);
    for (int a = 0; a < 3; a++) {
        slc_floats product = cov[a][0] * axis[0] + cov[a][1] * axis[1] + cov[a][2] * axis[2];
        trace += cov[a][a];
        length += axis[a] * axis[a];
        along += axis[a] * product;
    }
    return trace - along / slc_greater(length, slc_all(1e-20f));
}

void slc_estimate_regions(const slc_floats channels[3][16], int partitions, slc_floats *estimates)
{
    slc_floats products[16][9];
    struct moments all = {.count = slc_all(16.0f)};
    for (int i = 0; i < 16; i++) {
        slc_floats r = channels[0][i], g = channels[1][i];
        slc_floats b = channels[2][i];
        const slc_floats own[9] = {r, g, b, r * r, r * g, r * b, g * g, g * b, b * b};
        for (int k = 0; k < 9; k++) {
            products[i][k] = own[k];
            all.sums[k] += own[k];
        }
    }
    for (int p = 0; p < partitions; p++) {
        struct moments one = {.count = slc_all(0.0f)}, zero = all;
        for (int i = 0; i < 16; i++) {
            if (!(slc_partitions[p] >> i & 1))
                continue;
            one.count += 1.0f;
            for (int k = 0; k < 9; k++)
                one.sums[k] += products[i][k];
        }
        zero.count -= one.count;
        for (int k = 0; k < 9; k++)
            zero.sums[k] -= one.sums[k];
        estimates[p] = line_error(&zero) + line_error(&one);
    }
}

slc_ints slc_take_regions(slc_floats *estimates, int partitions)
{
    slc_floats least = estimates[0];
    slc_ints chosen = {0};
    for (int p = 1; p < partitions; p++) {
        slc_ints less = estimates[p] < least;
        least = slc_select(less, estimates[p], least);
        chosen = slc_select_ints(less, (slc_ints){0} + p, chosen);
    }
    for (int l = 0; l < SLC_LANES; l++)
        estimates[chosen[l]][l] = FLT_MAX;
    return chosen;
}
