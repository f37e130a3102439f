#include "device/cube_oracle.h"

#include <assert.h>
#include <math.h>

/* Axis and sign of s, t and r of each face. */
static const struct {
    int axis;
    double sign;
} table[CUBE_ORACLE_FACES][3] = {{{2, -1}, {1, -1}, {0, 1}}, {{2, 1}, {1, -1}, {0, -1}},
                                 {{0, 1}, {2, 1}, {1, 1}},   {{0, 1}, {2, -1}, {1, -1}},
                                 {{0, 1}, {1, -1}, {2, 1}},  {{0, -1}, {1, -1}, {2, -1}}};

void cube_oracle_direction(uint32_t face, double u, double v, double direction[3])
{
    direction[table[face][0].axis] = table[face][0].sign * (2 * u - 1);
    direction[table[face][1].axis] = table[face][1].sign * (2 * v - 1);
    direction[table[face][2].axis] = table[face][2].sign;
}

void cube_oracle_derivative(uint32_t face, double du, double dv, double derivative[3])
{
    derivative[table[face][0].axis] = table[face][0].sign * 2 * du;
    derivative[table[face][1].axis] = table[face][1].sign * 2 * dv;
    derivative[table[face][2].axis] = 0;
}

void cube_oracle_position(const double d[3], uint32_t *face, double uv[2])
{
    int axis = 2;
    if (fabs(d[1]) > fabs(d[axis]))
        axis = 1;
    if (fabs(d[0]) > fabs(d[axis]))
        axis = 0;
    *face = 2 * (uint32_t)axis + (d[axis] < 0);
    for (int i = 0; i < 2; i++)
        uv[i] = 0.5 * (table[*face][i].sign * d[table[*face][i].axis] / fabs(d[axis]) + 1);
}

static void center_of(uint32_t size, uint32_t face, int32_t x, int32_t y, double center[3])
{
    cube_oracle_direction(face, (x + 0.5) / size, (y + 0.5) / size, center);
}

static double distance2(const double a[3], const double b[3])
{
    double sum = 0;
    for (int i = 0; i < 3; i++)
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum;
}

/* The nearest of the texels at the edges of the other faces. */
static struct cube_texel find_beyond(uint32_t size, uint32_t from, int32_t x, int32_t y)
{
    double wanted[3], best = INFINITY;
    struct cube_texel found = {0};
    center_of(size, from, x, y, wanted);
    for (uint32_t face = 0; face < CUBE_ORACLE_FACES; face++)
        for (uint32_t i = 0; i < size && face != from; i++) {
            const struct cube_texel rim[] = {
                {face, i, 0}, {face, i, size - 1}, {face, 0, i}, {face, size - 1, i}};
            for (uint32_t k = 0; k < 4; k++) {
                double at[3];
                center_of(size, face, (int32_t)rim[k].x, (int32_t)rim[k].y, at);
                if (distance2(at, wanted) < best) {
                    best = distance2(at, wanted);
                    found = rim[k];
                }
            }
        }
    return found;
}

struct cube_taps cube_oracle_bilinear(uint32_t size, const double direction[3])
{
    struct cube_taps taps = {.count = 0};
    uint32_t face;
    double uv[2], corner = 0;
    cube_oracle_position(direction, &face, uv);
    double x = uv[0] * size - 0.5, y = uv[1] * size - 0.5;
    int32_t left = (int32_t)floor(x), top = (int32_t)floor(y), end = (int32_t)size;
    for (int32_t i = 0; i < 4; i++) {
        int32_t tx = left + i % 2, ty = top + i / 2;
        double weight = (i % 2 ? x - left : 1 - (x - left)) * (i / 2 ? y - top : 1 - (y - top));
        bool out_x = tx < 0 || tx >= end, out_y = ty < 0 || ty >= end;
        if (out_x && out_y) {
            corner = weight;
            continue;
        }
        taps.weights[taps.count] = weight;
        taps.texels[taps.count++] = out_x || out_y
                                        ? find_beyond(size, face, tx, ty)
                                        : (struct cube_texel){face, (uint32_t)tx, (uint32_t)ty};
    }
    for (uint32_t i = 0; i < taps.count; i++)
        taps.weights[i] += corner / 3;
    return taps;
}

double cube_oracle_distance(const double direction[3], uint32_t size, uint32_t face, uint32_t left,
                            uint32_t top, uint32_t right, uint32_t bottom)
{
    double low[3], high[3], at[3], nearest[3];
    double longest = fmax(fabs(direction[0]), fmax(fabs(direction[1]), fabs(direction[2])));
    cube_oracle_direction(face, (double)left / size, (double)top / size, low);
    cube_oracle_direction(face, (double)right / size, (double)bottom / size, high);
    for (int i = 0; i < 3; i++) {
        at[i] = direction[i] / longest;
        nearest[i] = fmin(fmax(at[i], fmin(low[i], high[i])), fmax(low[i], high[i]));
    }
    return sqrt(distance2(at, nearest));
}
