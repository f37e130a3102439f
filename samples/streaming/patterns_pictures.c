#include "patterns.h"

#include <math.h>
#include <string.h>

#include "../common/noise.h"

static void mix_into(float rgb[3], const float other[3], float share)
{
    for (int i = 0; i < 3; i++)
        rgb[i] += (other[i] - rgb[i]) * share;
}

/* An archipelago from above: warped noise as height, colored by height, lit from the north-west.
 */
void pattern_coast(float u, float v, float footprint, float rgb[3])
{
    static const float deep[3] = {0.01f, 0.04f, 0.11f}, shallow[3] = {0.05f, 0.32f, 0.36f};
    static const float sand[3] = {0.55f, 0.45f, 0.28f}, grass[3] = {0.09f, 0.18f, 0.045f};
    static const float rock[3] = {0.24f, 0.20f, 0.17f}, snow[3] = {0.85f, 0.88f, 0.93f};
    struct noise_sum bend_x = noise_octaves(u, v, 2.0f, 3, 0.5f, footprint, 11);
    struct noise_sum bend_y = noise_octaves(u, v, 2.0f, 3, 0.5f, footprint, 23);
    struct noise_sum land = noise_octaves(u + 0.09f * bend_x.value, v + 0.09f * bend_y.value, 2.4f,
                                          12, 0.53f, footprint, 37);
    float height = 0.55f * land.value + 0.02f;
    float slope_x = 0.55f * land.dx, slope_y = 0.55f * land.dy;

    memcpy(rgb, deep, sizeof deep);
    mix_into(rgb, shallow, noise_smoothstep(-0.45f, -0.005f, height));
    mix_into(rgb, sand, noise_smoothstep(-0.004f, 0.003f, height));
    mix_into(rgb, grass, noise_smoothstep(0.02f, 0.06f, height));
    float steepness = sqrtf(slope_x * slope_x + slope_y * slope_y);
    mix_into(rgb, rock, noise_smoothstep(0.2f, 0.42f, height + 0.012f * steepness));
    mix_into(rgb, snow, noise_smoothstep(0.52f, 0.6f, height - 0.008f * steepness));

    float flatness = height < 0.0f ? 0.02f : 0.12f;
    float nx = -slope_x * flatness, ny = -slope_y * flatness;
    float light = (1.0f - 0.6f * nx - 0.6f * ny) / sqrtf(1.0f + nx * nx + ny * ny);
    for (int i = 0; i < 3; i++)
        rgb[i] *= noise_clamp(light, 0.15f, 1.9f);
}

/** Iterates z^2 + c; returns a smooth count, or -1 inside, and how near the orbit came to 0. */
static float escape_time(float zx, float zy, float cx, float cy, int limit, float *nearest)
{
    float old_x = zx, old_y = zy;
    *nearest = 1e9f;
    for (int i = 0; i < limit; i++) {
        float xx = zx * zx, yy = zy * zy, size = xx + yy;
        if (size > 256.0f)
            return (float)i + 1.0f - log2f(0.5f * log2f(size));
        if (size < *nearest)
            *nearest = size;
        zy = 2.0f * zx * zy + cy;
        zx = xx - yy + cx;
        if (zx == old_x && zy == old_y) /* a cycle never escapes */
            return -1.0f;
        if ((i & (i + 1)) == 0)
            old_x = zx, old_y = zy;
    }
    return -1.0f;
}

void pattern_julia(float u, float v, float footprint, float rgb[3])
{
    static const float phase[3] = {0.02f, 0.11f, 0.22f};
    (void)footprint;
    float nearest;
    float count =
        escape_time((u - 1.0f) * 1.72f, (v - 0.5f) * 1.72f, -0.79f, 0.152f, 320, &nearest);
    if (count < 0.0f) {
        float depth = sqrtf(sqrtf(nearest));
        rgb[0] = 0.03f + 0.9f * depth;
        rgb[1] = 0.01f + 0.35f * depth;
        rgb[2] = 0.02f;
        return;
    }
    noise_palette(0.11f * sqrtf(count) + 0.5f, phase, rgb);
    float glow = noise_clamp(count / 60.0f, 0.03f, 1.0f);
    for (int i = 0; i < 3; i++)
        rgb[i] = rgb[i] * rgb[i] * glow * 1.4f;
}

void pattern_mandelbrot(float u, float v, float footprint, float rgb[3])
{
    static const float phase[3] = {0.55f, 0.62f, 0.72f};
    (void)footprint;
    float cx = -0.7451f + (u - 0.5f) * 0.0115f, cy = 0.1318f + (v - 0.5f) * 0.0115f, nearest;
    float count = escape_time(0.0f, 0.0f, cx, cy, 500, &nearest);
    if (count < 0.0f) {
        rgb[0] = rgb[1] = rgb[2] = 0.004f;
        return;
    }
    noise_palette(0.19f * sqrtf(count), phase, rgb);
    for (int i = 0; i < 3; i++)
        rgb[i] = 0.02f + 0.9f * rgb[i] * rgb[i];
}

/* Digits of 3 x 5 dots, the top row in the highest bits. */
static const uint16_t digit_dots[10] = {075557, 026227, 071747, 071717, 055711,
                                        074717, 074757, 071222, 075757, 075717};

/** Tests whether (x, y) in [0, 1)^2 is ink of a text of `count` decimal digits. */
static int digits_ink(uint32_t number, int count, float x, float y)
{
    int column = (int)(x * (float)(4 * count)), row = (int)(y * 5.0f);
    int place = count - 1 - column / 4;
    if (column % 4 == 3 || row > 4)
        return 0;
    while (place-- > 0)
        number /= 10;
    return digit_dots[number % 10] >> (3 * (4 - row) + (2 - column % 4)) & 1;
}

/*
 * Test chart with detail at every scale: each field is framed and numbered, and is cut into 4 x 4
 * fields that are framed and numbered again, six times over.
 */
void pattern_chart(float u, float v, float footprint, float rgb[3])
{
    static const float ink[3] = {0.012f, 0.014f, 0.02f};
    float x = u, y = v, size = footprint;
    uint32_t number = 0;
    rgb[0] = 0.82f, rgb[1] = 0.79f, rgb[2] = 0.70f;
    for (int level = 0; level < 6; level++) {
        float visible = noise_visible(1.5f, size);
        if (visible == 0.0f)
            break;
        int column = noise_floor(x * 4.0f), row = noise_floor(y * 4.0f);
        number = number * 16u + (uint32_t)(column + 4 * row);
        x = x * 4.0f - (float)column, y = y * 4.0f - (float)row, size *= 4.0f;

        static const float phase[3] = {0.0f, 0.33f, 0.67f};
        float tint[3];
        noise_palette(noise_unit(noise_hash(column, row, number)), phase, tint);
        if (noise_hash(row, column, number + 7) % 3 == 0)
            mix_into(rgb, tint, 0.42f * visible);
        float edge = fminf(fminf(x, 1.0f - x), fminf(y, 1.0f - y));
        mix_into(rgb, ink, noise_line(edge, 0.012f, size) * visible);
        /* The label fills the upper left of a field; the finer fields show through beside it. */
        float tx = (x - 0.06f) / 0.42f, ty = (y - 0.06f) / 0.16f;
        if (tx >= 0.0f && tx < 1.0f && ty >= 0.0f && ty < 1.0f &&
            digits_ink(number % 10000u, 4, tx, ty))
            mix_into(rgb, ink, 0.85f * noise_visible(0.25f, size * 24.0f) * visible);
    }
}

struct pane {
    float nearest, second; ///< distances to the two nearest centers
    uint32_t id;
};

/** Columns repeat after `period`. */
static struct pane find_pane(float x, float y, int32_t period, uint32_t seed)
{
    struct pane pane = {9.0f, 9.0f, 0};
    int32_t ix = noise_floor(x), iy = noise_floor(y);
    for (int32_t row = iy - 1; row <= iy + 1; row++)
        for (int32_t column = ix - 1; column <= ix + 1; column++) {
            uint32_t hash = noise_hash(column & (period - 1), row, seed);
            float dx = (float)column + (float)(hash & 0xffff) / 65536.0f - x;
            float dy = (float)row + (float)(hash >> 16) / 65536.0f - y;
            float distance = sqrtf(dx * dx + dy * dy);
            if (distance < pane.nearest) {
                pane.second = pane.nearest;
                pane.nearest = distance;
                pane.id = hash;
            } else if (distance < pane.second) {
                pane.second = distance;
            }
        }
    return pane;
}

/* Stained glass: panes in lead, a rose in the upper half, bubbles and streaks in the glass. */
void pattern_glass(float u, float v, float footprint, float rgb[3])
{
    float dx = u - 0.293f, dy = v - 0.32f, radius = sqrtf(dx * dx + dy * dy);
    float x = u * 14.0f, y = v * 14.0f, scale = 14.0f;
    if (radius < 0.25f && radius > 1e-4f) { /* rings of petals */
        x = atan2f(dy, dx) * (16.0f / NOISE_TAU) + 16.0f;
        y = radius * 26.0f;
        scale = 26.0f;
    }
    struct pane pane = find_pane(x, y, 16, 5);
    struct noise_sum streak = noise_octaves(u, v, 40.0f, 8, 0.6f, footprint, 77);
    float hue = noise_unit(pane.id * 0x9e3779b1u), shade = noise_unit(pane.id * 0x85ebca77u);
    static const float warm[3] = {0.0f, 0.12f, 0.28f}, cold[3] = {0.5f, 0.28f, 0.02f};
    noise_palette(radius < 0.25f ? 0.3f * hue + 0.95f : 0.4f * hue - 0.15f,
                  radius < 0.25f ? warm : cold, rgb);
    float light = (0.35f + 0.9f * shade) * (1.0f + 0.28f * streak.value);
    for (int i = 0; i < 3; i++)
        rgb[i] = rgb[i] * rgb[i] * light * (1.3f - 0.5f * v);

    static const float lead[3] = {0.015f, 0.016f, 0.018f};
    float seam = pane.second - pane.nearest, ring = fabsf(radius - 0.25f) * 26.0f;
    mix_into(rgb, lead, noise_line(seam, 0.055f, footprint * scale * 2.0f));
    mix_into(rgb, lead, noise_line(ring, 0.2f, footprint * 26.0f));
}

/** Light of one layer of stars, at most one per cell. */
static float star_light(float u, float v, float frequency, float footprint, uint32_t seed)
{
    float x = u * frequency, y = v * frequency;
    int32_t ix = noise_floor(x), iy = noise_floor(y);
    uint32_t hash = noise_hash(ix, iy, seed);
    float magnitude = noise_unit(hash * 0x2c1b3c6du);
    float dx = x - (float)ix - 0.3f - 0.4f * (float)(hash & 0xff) / 255.0f;
    float dy = y - (float)iy - 0.3f - 0.4f * (float)(hash >> 8 & 0xff) / 255.0f;
    float size = 0.012f + 0.03f * magnitude * magnitude;
    float seen = fmaxf(size, 0.8f * footprint * frequency); /* spread thinner, same energy */
    float falloff = expf(-(dx * dx + dy * dy) / (seen * seen)) * (size * size) / (seen * seen);
    float power = magnitude * magnitude;
    return 26.0f * power * power * power * falloff;
}

/* A nebula; its stars are far brighter than white. */
void pattern_nebula(float u, float v, float footprint, float rgb[3])
{
    struct noise_sum bend = noise_octaves(u, v, 1.7f, 4, 0.5f, footprint, 3);
    struct noise_sum gas = noise_octaves(u + 0.25f * bend.value, v + 0.2f * bend.value, 1.9f, 11,
                                         0.56f, footprint, 51);
    struct noise_sum dust = noise_octaves(u - 0.18f * bend.value, v, 3.1f, 9, 0.6f, footprint, 90);
    float density = noise_clamp(0.42f + 0.5f * gas.value, 0.0f, 2.0f);
    float shadow = noise_smoothstep(-0.25f, 0.75f, dust.value);
    float glow = density * density * density * (1.0f - 0.85f * shadow);
    rgb[0] = 0.008f + 1.5f * glow;
    rgb[1] = 0.010f + 0.55f * glow * density + 0.03f * bend.value * bend.value;
    rgb[2] = 0.022f + 0.85f * glow * (1.3f - density) + 0.06f * shadow * density;

    static const float tints[4][3] = {
        {1.0f, 0.95f, 0.9f}, {0.75f, 0.85f, 1.0f}, {1.0f, 0.75f, 0.5f}, {0.9f, 0.95f, 1.0f}};
    static const float frequencies[4] = {9.0f, 31.0f, 97.0f, 260.0f};
    for (uint32_t layer = 0; layer < 4; layer++) {
        float light = star_light(u, v, frequencies[layer], footprint, 200 + layer);
        for (int i = 0; i < 3; i++)
            rgb[i] += light * tints[layer][i];
    }
}

/** Lines r = const, bent by petals around a center; gray where they are too fine to be seen. */
static float engraved_lines(float dx, float dy, float petals, float bend, float lines,
                            float footprint)
{
    float radius = sqrtf(dx * dx + dy * dy), angle = atan2f(dy, dx);
    float phase = lines * radius * (1.0f + bend * cosf(petals * angle));
    float wave = phase - floorf(phase) - 0.5f;
    float stretch = lines * (1.0f + 0.7f * bend * petals);
    return noise_mix(0.36f, noise_line(wave, 0.18f, footprint * stretch),
                     noise_visible(0.5f * stretch, footprint));
}

/* Security printing: three systems of engraved lines over each other, finer ones inside the lines.
 */
void pattern_guilloche(float u, float v, float footprint, float rgb[3])
{
    static const float inks[3][3] = {
        {0.02f, 0.19f, 0.15f}, {0.38f, 0.04f, 0.07f}, {0.03f, 0.07f, 0.35f}};
    static const float centers[3][2] = {{0.5f, 0.5f}, {1.0f, 0.5f}, {1.5f, 0.5f}};
    rgb[0] = 0.72f, rgb[1] = 0.68f, rgb[2] = 0.54f;
    for (int layer = 0; layer < 3; layer++) {
        float dx = u - centers[layer][0], dy = v - centers[layer][1];
        float line = engraved_lines(dx, dy, 8.0f + 4.0f * (float)layer, 0.16f, 26.0f, footprint);
        float fine = engraved_lines(dy, dx, 36.0f, 0.04f, 300.0f, footprint);
        float fade = 1.0f - noise_smoothstep(0.2f, 0.8f, sqrtf(dx * dx + dy * dy));
        mix_into(rgb, inks[layer], line * (0.6f + 0.4f * fine) * (0.35f + 0.65f * fade));
    }
    static const float border[3] = {0.02f, 0.10f, 0.09f};
    float edge = fminf(fminf(u, 1.9995f - u), fminf(v, 1.0f - v));
    float waves =
        engraved_lines(edge, 0.03f * sinf(40.0f * (u + v)), 2.0f, 0.2f, 110.0f, footprint);
    mix_into(rgb, border, waves * noise_line(edge, 0.07f, footprint));
}
