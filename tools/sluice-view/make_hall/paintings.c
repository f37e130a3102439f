#include "paintings.h"

#include "../../../samples/common/noise.h"

#include <math.h>
#include <stdbool.h>

#define TAU 6.283185307179586

/* Palettes begin with the ground and end with the lightest color. */
static const uint8_t palettes[][PAINTING_COLORS][3] = {
    {{16, 26, 48},
     {28, 62, 98},
     {46, 112, 140},
     {112, 176, 172},
     {214, 92, 60},
     {240, 160, 76},
     {250, 208, 132},
     {250, 240, 216}},
    {{44, 20, 36},
     {108, 28, 58},
     {184, 50, 68},
     {228, 110, 74},
     {60, 92, 108},
     {110, 158, 150},
     {240, 188, 110},
     {252, 238, 210}},
    {{18, 40, 34},
     {32, 84, 66},
     {74, 134, 84},
     {156, 184, 96},
     {204, 130, 54},
     {158, 72, 44},
     {232, 204, 128},
     {248, 242, 220}},
    {{26, 22, 54},
     {64, 48, 116},
     {122, 84, 164},
     {192, 124, 178},
     {44, 118, 150},
     {112, 190, 196},
     {244, 176, 160},
     {252, 236, 224}},
    {{34, 30, 28},
     {84, 66, 54},
     {142, 106, 76},
     {190, 150, 104},
     {52, 84, 92},
     {104, 138, 140},
     {222, 198, 152},
     {246, 238, 222}},
    {{12, 34, 60},
     {22, 78, 126},
     {52, 136, 182},
     {138, 198, 214},
     {226, 178, 50},
     {206, 74, 46},
     {240, 222, 150},
     {252, 246, 232}},
    {{28, 28, 34},
     {70, 70, 82},
     {206, 44, 40},
     {36, 80, 160},
     {244, 196, 42},
     {128, 132, 140},
     {214, 214, 210},
     {248, 246, 240}},
};

const uint8_t painting_floor_palette[PAINTING_COLORS][3] = {
    {52, 32, 20},   {120, 78, 46},  {136, 90, 54},  {150, 101, 62},
    {162, 112, 70}, {174, 123, 79}, {184, 134, 88}, {196, 148, 102}};

const uint8_t (*painting_palette(uint32_t number))[3]
{
    return palettes[number % (sizeof palettes / sizeof palettes[0])];
}

static double unit(int32_t x, int32_t y, uint32_t seed)
{
    return (double)noise_unit(noise_hash(x, y, seed));
}

static double fraction(double x)
{
    return x - floor(x);
}

/* Value noise in [0, 1] of several octaves. */
static double cloud(double x, double y, uint32_t seed)
{
    double sum = 0, weight = 0.5;
    for (uint32_t octave = 0; octave < 5; octave++, x *= 2.1, y *= 2.1, weight *= 0.5) {
        float dx, dy;
        sum += weight * (double)noise_value((float)x, (float)y, seed + octave, &dx, &dy);
    }
    return 0.5 + 0.5 * sum;
}

/* Quarter circles that join at random. */
static uint32_t truchet(const struct painting *p, double x, double y)
{
    const double cells = 9;
    const int32_t i = (int32_t)floor(x * cells), j = (int32_t)floor(y * cells);
    double u = fraction(x * cells), v = fraction(y * cells);
    if (noise_hash(i, j, p->seed) & 1u)
        u = 1 - u;
    const double from = fmin(hypot(u, v), hypot(1 - u, 1 - v)), away = fabs(from - 0.5);
    if (away < 0.05)
        return 7;
    if (away < 0.16)
        return 4 + (noise_hash(i / 3, j / 3, p->seed + 1) & 1u);
    if (away < 0.20)
        return 0;
    return away < 0.27 ? 6 : from < 0.5 ? 1 : 2;
}

/* Seeds of a sunflower: the golden angle from each to the next. */
static uint32_t sunflower(const struct painting *p, double x, double y)
{
    const double dx = x - p->aspect / 2, dy = y - 0.5, r = hypot(dx, dy), step = 0.0118;
    const int first = (int)fmax(0, pow(fmax(0, r - step) / step, 2));
    const int last = (int)pow((r + step) / step, 2) + 1;
    for (int i = first; i <= last && i < 1500; i++) {
        const double turn = i * 2.39996322972865332, at = step * sqrt(i);
        const double away = hypot(dx - at * cos(turn), dy - at * sin(turn));
        const double size = step * (0.42 + 0.40 * sqrt(i / 1500.0));
        if (away < size * 0.45)
            return i % 13 == 0 ? 7 : 6;
        if (away < size)
            return 2 + (uint32_t)(i % 8 < 3) + 2 * (uint32_t)(i % 5 < 2);
    }
    return r < 0.465 ? 0 : 1;
}

/* Rectangles that are halved again and again, with black lines. */
static uint32_t rectangles(const struct painting *p, double x, double y)
{
    double left = 0, right = p->aspect, top = 0, bottom = 1;
    uint32_t node = 1;
    for (int depth = 0; depth < 7; depth++) {
        const double cut = 0.3 + 0.4 * unit((int32_t)node, 0, p->seed);
        const bool upright = right - left > bottom - top;
        double *low = upright ? &left : &top, *high = upright ? &right : &bottom;
        const double at = *low + (*high - *low) * cut, here = upright ? x : y;
        if (unit((int32_t)node, 1, p->seed) < 0.12 * depth - 0.2)
            break;
        node = node * 2 + (here >= at);
        *(here < at ? high : low) = at;
    }
    const double edge = fmin(fmin(x - left, right - x), fmin(y - top, bottom - y));
    if (edge < 0.006)
        return 0;
    const double kind = unit((int32_t)node, 2, p->seed);
    if (kind < 0.12 && fraction((x + y) * 40) < 0.5)
        return 1;
    return kind < 0.5 ? 7 : kind < 0.6 ? 6 : 2 + noise_hash((int32_t)node, 3, p->seed) % 4;
}

/* Cells around scattered points, with lines of lead. */
static uint32_t stained_glass(const struct painting *p, double x, double y)
{
    const double cells = 11, bend = 0.03 * sin(TAU * (x + y));
    const double u = (x + bend) * cells, v = (y - bend) * cells;
    const int32_t i = (int32_t)floor(u), j = (int32_t)floor(v);
    double nearest = 1e9, second = 1e9;
    uint32_t who = 0;
    for (int32_t b = j - 2; b <= j + 2; b++)
        for (int32_t a = i - 2; a <= i + 2; a++) {
            const double du = a + unit(a, b, p->seed) - u, dv = b + unit(a, b, p->seed + 1) - v;
            const double away = hypot(du, dv);
            second = away < nearest ? nearest : fmin(second, away);
            who = away < nearest ? noise_hash(a, b, p->seed + 2) : who;
            nearest = fmin(nearest, away);
        }
    if (second - nearest < 0.09)
        return 0;
    const double r = hypot(x - p->aspect / 2, y - 0.5);
    if (fabs(r - 0.36) < 0.01 || fabs(r - 0.44) < 0.006)
        return 0;
    return r < 0.36 ? 4 + who % 4 : r < 0.44 ? 2 : 1 + who % 3;
}

/* Overlapping rings in rows, as on Japanese cloth. */
static uint32_t waves(const struct painting *p, double x, double y)
{
    const double radius = 0.085;
    for (int row = (int)(y / (radius * 0.5)) + 3; row >= -1; row--) {
        const double cy = row * radius * 0.5, shift = (row & 1) * radius;
        const double column = floor((x - shift) / (2 * radius) + 0.5);
        const double away = hypot(x - shift - column * 2 * radius, y - cy) / radius;
        if (away > 1 || y > cy)
            continue;
        const int ring = (int)(away * 6);
        const uint32_t hue = cloud(column * 0.31 + row * 0.13, row * 0.21, p->seed) > 0.5 ? 4 : 1;
        return ring % 2 == 1 ? 7 : ring >= 4 ? hue : ring >= 2 ? hue + 1 : 0;
    }
    return 0;
}

/* A checkerboard over which spheres bulge. */
static uint32_t bulges(const struct painting *p, double x, double y)
{
    uint32_t inside = 0;
    for (uint32_t k = 0; k < 3; k++) {
        const double cx = p->aspect * (0.25 + 0.5 * unit((int32_t)k, 0, p->seed));
        const double cy = 0.25 + 0.5 * unit((int32_t)k, 1, p->seed);
        const double size = 0.18 + 0.12 * unit((int32_t)k, 2, p->seed);
        const double dx = x - cx, dy = y - cy, r = hypot(dx, dy) / size;
        if (r >= 1)
            continue;
        const double flat = asin(r) / (TAU / 4) / fmax(r, 1e-9);
        x = cx + dx * flat * 0.9;
        y = cy + dy * flat * 0.9;
        inside = k + 1;
    }
    const double cells = 24, u = fraction(x * cells) - 0.5, v = fraction(y * cells) - 0.5;
    const bool odd = ((int)floor(x * cells) + (int)floor(y * cells)) & 1;
    const bool dot = hypot(u, v) < 0.34;
    return dot ? (odd ? 7 : inside ? 3 + inside : 6) : odd ? inside : inside ? 0 : 1;
}

/* Houses with windows under stars. */
static uint32_t skyline(const struct painting *p, double x, double y)
{
    for (int layer = 2; layer >= 0; layer--) {
        const double width = 0.05 + 0.012 * layer;
        const int32_t i = (int32_t)floor(x / width + layer * 0.37);
        const double u = fraction(x / width + layer * 0.37), high = unit(i, layer, p->seed);
        const double top = 0.90 - 0.16 * (2 - layer) - 0.34 * high * high;
        if (y < top || (u < 0.5 + 0.5 * (high - 0.5) && y < top + 0.03))
            continue;
        const double wu = fraction(u * 6), wv = fraction((y - top) * 60);
        const int32_t window = (int32_t)(u * 6) + i * 8, floors = (int32_t)((y - top) * 60);
        if (wu > 0.25 && wu < 0.75 && wv > 0.3 && wv < 0.8 && u > 0.08 && u < 0.92 &&
            unit(window, floors, p->seed + 7) < 0.45)
            return unit(window, floors, p->seed + 8) < 0.7 ? 6 : 5;
        return layer == 2 ? 0 : layer == 1 ? 1 : 2;
    }
    const double moon = hypot(x - p->aspect * 0.72, y - 0.2);
    if (moon < 0.09)
        return cloud(x * 14, y * 14, p->seed) > 0.62 ? 6 : 7;
    const int32_t i = (int32_t)floor(x * 40), j = (int32_t)floor(y * 40);
    const double su = fraction(x * 40) - 0.5, sv = fraction(y * 40) - 0.5;
    if (unit(i, j, p->seed + 3) < 0.25 && hypot(su, sv) < 0.02 + 0.08 * unit(i, j, p->seed + 4))
        return 7;
    return y < 0.30 + 0.03 * sin(x * 9) ? 0 : y < 0.52 + 0.03 * sin(x * 7 + 1) ? 1 : 3;
}

/* Ridges one behind the other before a setting sun. */
static uint32_t mountains(const struct painting *p, double x, double y)
{
    for (int layer = 0; layer < 5; layer++) {
        const double rough = cloud(x * (1.5 + layer * 0.4) + layer * 9.7, layer, p->seed);
        const double ridge = 0.92 - 0.11 * layer - 0.34 * (rough - 0.5);
        if (y < ridge)
            continue;
        const double lines = fraction((y - ridge) * (90 - 10 * layer));
        return layer == 0 && lines < 0.12 ? 1u : (uint32_t)layer;
    }
    const double sun = hypot(x - p->aspect * 0.38, y - 0.36);
    if (sun < 0.15)
        return fraction(y * 26) < 0.25 + (y - 0.36) ? 5 : 7;
    return fraction(sun * 9) < 0.08 ? 7 : y < 0.2 ? 5 : 6;
}

/* Bands of equal escape times. */
static uint32_t mandelbrot(const struct painting *p, double x, double y)
{
    static const double views[3][3] = {
        {-0.745, 0.113, 0.02}, {-0.16, 1.036, 0.06}, {-1.25, 0.02, 0.09}};
    const double *view = views[p->seed % 3];
    const double cx = view[0] + (x - p->aspect / 2) * view[2], cy = view[1] + (y - 0.5) * view[2];
    double a = 0, b = 0;
    for (uint32_t i = 0; i < 120; i++) {
        const double next = a * a - b * b + cx;
        b = 2 * a * b + cy;
        a = next;
        if (a * a + b * b > 64)
            return 1 + (i / 3) % 7;
    }
    return 0;
}

/* Stars, lines between some of them, circles of declination. */
static uint32_t star_map(const struct painting *p, double x, double y)
{
    const double r = hypot(x - p->aspect / 2, y - 0.5);
    if (r > 0.47)
        return r < 0.475                                                                    ? 6
               : fraction(atan2(y - 0.5, x - p->aspect / 2) / TAU * 180) < 0.06 && r < 0.49 ? 6
                                                                                            : 0;
    const int32_t i = (int32_t)floor(x * 14), j = (int32_t)floor(y * 14);
    for (int32_t b = j - 1; b <= j + 1; b++)
        for (int32_t a = i - 1; a <= i + 1; a++) {
            const double sx = (a + unit(a, b, p->seed)) / 14,
                         sy = (b + unit(a, b, p->seed + 1)) / 14;
            const double size = 0.0015 + 0.006 * pow(unit(a, b, p->seed + 2), 3);
            const double away = hypot(x - sx, y - sy);
            if (away < size)
                return 7;
            if (away < size * 1.6 && size > 0.005)
                return 5;
            if (unit(a, b, p->seed + 3) > 0.4)
                continue;
            const double ex = (a + 1 + unit(a + 1, b, p->seed)) / 14 - sx;
            const double ey = (b + unit(a + 1, b, p->seed + 1)) / 14 - sy;
            const double along = ((x - sx) * ex + (y - sy) * ey) / (ex * ex + ey * ey);
            const double off = fabs((x - sx) * ey - (y - sy) * ex) / hypot(ex, ey);
            if (along > 0.12 && along < 0.88 && off < 0.0011)
                return 4;
        }
    const double turn = fraction(atan2(y - 0.5, x - p->aspect / 2) / TAU * 12);
    if (fraction(r * 10 + 0.5 * 0.02) < 0.016 || (turn < 0.0016 / fmax(r, 0.02) && r > 0.05))
        return 2;
    return cloud(x * 3, y * 3, p->seed + 5) > 0.6 ? 1 : 0;
}

/* Stars with eight points, of two squares each. */
static uint32_t girih(const struct painting *p, double x, double y)
{
    const double cells = 7;
    const int32_t i = (int32_t)floor(x * cells), j = (int32_t)floor(y * cells);
    const double u = fabs(fraction(x * cells) - 0.5), v = fabs(fraction(y * cells) - 0.5);
    const double square = fmax(u, v) / 0.36, diamond = (u + v) / (0.36 * 1.41421356);
    const double star = fmin(square, diamond), core = fmax(square, diamond);
    const uint32_t hue = noise_hash(i, j, p->seed) % 3;
    if (fabs(star - 1) < 0.045 || fabs(core - 1) < 0.02)
        return 7;
    if (core < 0.62)
        return core < 0.3 ? 6 : core < 0.36 ? 7 : 3 + hue;
    if (star < 1)
        return core < 1 ? 1 + hue : 5;
    const double corner = hypot(0.5 - u, 0.5 - v);
    return corner < 0.11 ? 6 : corner < 0.14 ? 7 : fraction(corner * 30) < 0.18 ? 1 : 0;
}

/* The curve of Hilbert: 64 x 64 cells in one line. */
static uint32_t hilbert_place(int32_t x, int32_t y)
{
    uint32_t place = 0;
    for (int32_t side = 32; side > 0; side /= 2) {
        const int32_t rx = (x & side) != 0, ry = (y & side) != 0;
        place += (uint32_t)side * (uint32_t)side * (uint32_t)((3 * rx) ^ ry);
        if (ry == 0) {
            if (rx == 1) {
                x = 63 - x;
                y = 63 - y;
            }
            const int32_t other = x;
            x = y;
            y = other;
        }
    }
    return place;
}

static uint32_t hilbert(const struct painting *p, double x, double y)
{
    const double cells = 64;
    const int32_t i = (int32_t)floor(x * cells), j = (int32_t)floor(y * cells);
    const double u = fraction(x * cells) - 0.5, v = fraction(y * cells) - 0.5;
    if (i < 0 || j < 0 || i > 63 || j > 63)
        return 0;
    const uint32_t place = hilbert_place(i, j);
    static const int32_t steps[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    bool line = hypot(u, v) < 0.3;
    for (int k = 0; k < 4 && !line; k++) {
        const int32_t a = i + steps[k][0], b = j + steps[k][1];
        if (a < 0 || b < 0 || a > 63 || b > 63)
            continue;
        const uint32_t other = hilbert_place(a, b);
        const double along = u * steps[k][0] + v * steps[k][1];
        const double off = fabs(u * steps[k][1]) + fabs(v * steps[k][0]);
        line = (other == place + 1 || place == other + 1) && along > 0 && off < 0.3;
    }
    return line ? 1 + (place * 7 / 4096 + p->seed) % 7 : 0;
}

/* Lines of a rosette, as on banknotes. */
static uint32_t guilloche(const struct painting *p, double x, double y)
{
    const double dx = x - p->aspect / 2, dy = y - 0.5, r = hypot(dx, dy), turn = atan2(dy, dx);
    const double petals = 6 + (double)(p->seed % 5);
    const double one = r * 30 + 1.6 * sin(petals * turn) * sin(r * 7);
    const double two = r * 30 - 1.6 * sin(petals * turn + 1) * sin(r * 7);
    if (r > 0.475)
        return 1;
    if (fraction(one) < 0.13)
        return 7;
    if (fraction(two) < 0.13)
        return 5;
    return 1 + ((uint32_t)floor(one) + (uint32_t)floor(two)) % 3;
}

/* Squares of strips around strips, as quilts are sewn. */
static uint32_t quilt(const struct painting *p, double x, double y)
{
    const double cells = 6;
    const int32_t i = (int32_t)floor(x * cells), j = (int32_t)floor(y * cells);
    const double u = fraction(x * cells) - 0.5, v = fraction(y * cells) - 0.5;
    const int ring = (int)(fmax(fabs(u), fabs(v)) * 13);
    const bool light = u + v > 0, turned = (i + j) & 1;
    if (fmod(fabs(fmax(fabs(u), fabs(v)) * 13), 1) < 0.09 || fabs(u + v) < 0.004)
        return 0;
    if (ring == 0)
        return 4;
    const uint32_t pick = noise_hash(i * 7 + ring, j, p->seed) % 2;
    return light != turned ? 6 + pick : (ring & 1 ? 2 : 1) + 2 * pick;
}

/* Basins of Newton's method for z^n = 1, striped by the number of steps. */
static uint32_t newton(const struct painting *p, double x, double y)
{
    const int roots = 3 + (int)(p->seed % 3);
    double a = (x - p->aspect / 2) * 2.6, b = (y - 0.5) * 2.6;
    for (uint32_t i = 0; i < 13; i++) {
        double pa = 1, pb = 0;
        for (int k = 1; k < roots; k++) {
            const double next = pa * a - pb * b;
            pb = pa * b + pb * a;
            pa = next;
        }
        const double za = pa * a - pb * b - 1, zb = pa * b + pb * a, square = pa * pa + pb * pb;
        if (square < 1e-12)
            return 0;
        a -= (za * pa + zb * pb) / square / roots;
        b -= (zb * pa - za * pb) / square / roots;
        if (za * za + zb * zb < 1e-3) {
            const int root = (int)floor(atan2(b, a) / TAU * roots + roots + 0.5) % roots;
            return i % 2 ? 2 + (uint32_t)root : i > 7 ? 7 : 1 + (uint32_t)(root % 2) * 5;
        }
    }
    return 0;
}

/* Paths of a maze, colored by how far they are from the middle. */
static uint32_t maze(const struct painting *p, double x, double y)
{
    const double cells = 40;
    const int32_t i = (int32_t)floor(x * cells), j = (int32_t)floor(y * cells);
    const double u = fraction(x * cells), v = fraction(y * cells), wall = 0.17;
    const bool down = noise_hash(i, j, p->seed) & 1u;
    const bool corner = u < wall && v < wall;
    if (corner || (u < wall && down) || (v < wall && !down))
        return 0;
    const double r = hypot(x - p->aspect / 2, y - 0.5);
    return 1 + (uint32_t)floor(r * 12) % 7;
}

/* Squares in squares, each turned a little. */
static uint32_t turned_squares(const struct painting *p, double x, double y)
{
    const double cells = 4;
    const int32_t i = (int32_t)floor(x * cells), j = (int32_t)floor(y * cells);
    double u = fraction(x * cells) - 0.5, v = fraction(y * cells) - 0.5;
    const double turn = ((i + j) & 1 ? 0.10 : -0.10), shrink = cos(turn) + fabs(sin(turn));
    uint32_t depth = 0;
    for (double half = 0.5; depth < 26; depth++, half /= shrink) {
        if (fmax(fabs(u), fabs(v)) > half)
            break;
        const double a = u * cos(turn) - v * sin(turn);
        v = u * sin(turn) + v * cos(turn);
        u = a;
    }
    const uint32_t hue = noise_hash(i, j, p->seed) % 2 ? 1 : 3;
    return depth & 1u ? (depth / 2) % 5 == 4 ? 6 : 7 : depth > 18 ? 5 : hue + (depth / 8) % 2;
}

uint32_t painting_color(const struct painting *painting, double x, double y)
{
    static uint32_t (*const kinds[PAINTING_KINDS])(const struct painting *, double, double) = {
        mountains, stained_glass, skyline,    girih,          sunflower, rectangles,
        waves,     truchet,       mandelbrot, quilt,          star_map,  bulges,
        newton,    hilbert,       guilloche,  turned_squares, maze};
    return kinds[painting->kind](painting, x, y);
}

/* Planks of 4 x 1 cells; a cell is 1/64 of the floor's picture wide. */
uint32_t painting_floor(double x, double y)
{
    const int32_t i = (int32_t)floor(x * 64), j = (int32_t)floor(y * 64), k = (i - j) & 7;
    const bool across = k < 4;
    const int32_t first_x = across ? i - k : i, first_y = across ? j : j - (7 - k);
    double along = across ? x * 64 - first_x : y * 64 - first_y;
    double beside = across ? y * 64 - first_y : x * 64 - first_x;
    if (beside < 0.025 || beside > 0.975 || along < 0.02 || along > 3.98)
        return 0;
    const uint32_t plank = noise_hash(first_x & 63, first_y & 63, 5);
    const double grain = cloud(along * 0.35 + plank % 97, beside * 4 + plank % 89, plank % 61);
    const uint32_t tone = 2 + plank % 4;
    return grain > 0.66 ? tone + 1 : grain < 0.36 ? tone - 1 : tone;
}
