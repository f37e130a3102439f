#include "patterns.h"

#include <string.h>

#include "periodic.h"

enum style { STYLE_TILES, STYLE_STONE, STYLE_WOOD, STYLE_CLOTH, STYLE_WORLD, STYLE_MOSAIC };
#define STYLE_COUNT 6u

static void mix_into(float rgb[3], const float other[3], float share)
{
    for (int i = 0; i < 3; i++)
        rgb[i] += (other[i] - rgb[i]) * share;
}

static void scale(float rgb[3], float factor)
{
    for (int i = 0; i < 3; i++)
        rgb[i] = noise_clamp(rgb[i] * factor, 0.0f, 1.0f);
}

/** Mixes in a field's mean color: half the first color, and a quarter of each of the others. */
static void mix_mean(const struct pattern *p, float rgb[3], float share)
{
    for (int i = 0; i < 3; i++) {
        float mean = 0.5f * p->colors[0][i] + 0.25f * (p->colors[1][i] + p->colors[2][i]);
        rgb[i] += (mean - rgb[i]) * share;
    }
}

/* Digits of 3 x 5 dots, the top row in the highest bits. */
static const uint16_t digit_dots[10] = {075557, 026227, 071747, 071717, 055711,
                                        074717, 074757, 071222, 075757, 075717};

/** Tests whether (x, y) in [0, 1)^2, y down, is ink of four decimal digits. */
static bool is_ink(uint32_t number, float x, float y)
{
    int column = (int)(x * 16.0f), row = (int)(y * 5.0f);
    if (column % 4 == 3)
        return false;
    for (int place = 3 - column / 4; place > 0; place--)
        number /= 10;
    return digit_dots[number % 10] >> (3 * (4 - row) + (2 - column % 4)) & 1;
}

/* Glazed tiles with a diamond or a ring each. Each tile has a number and smaller numbered tiles
 * inside. */
static void tiles(const struct pattern *p, float u, float v, float footprint, float rgb[3])
{
    static const float ink[3] = {0.02f, 0.022f, 0.03f};
    float x = u, y = v, size = footprint;
    memcpy(rgb, p->colors[0], 3 * sizeof *rgb);
    for (uint32_t level = 0, number = p->seed; level < 4; level++) {
        float visible = noise_visible(1.2f, size * 8.0f);
        if (visible == 0.0f)
            break;
        int column = noise_floor(x * 8.0f), row = noise_floor(y * 8.0f);
        number = number * 64u + (uint32_t)(column + 8 * row);
        x = x * 8.0f - (float)column, y = y * 8.0f - (float)row, size *= 8.0f;
        uint32_t hash = noise_hash(column, row, number);
        float share = level == 0 ? 1.0f : 0.35f;
        mix_into(rgb, p->colors[1 + (hash & 1)], share * visible * noise_unit(hash * 0x2c1b3c6du));
        float dx = fabsf(x - 0.5f), dy = fabsf(y - 0.5f);
        float ornament = hash & 2 ? dx + dy - 0.34f : 1.3f * (sqrtf(dx * dx + dy * dy) - 0.27f);
        mix_into(rgb, p->colors[2], share * visible * noise_line(ornament, 0.045f, 1.4f * size));
        float edge = 0.5f - fmaxf(dx, dy);
        mix_into(rgb, ink, share * visible * noise_line(edge, 0.022f, size));
        float tx = (x - 0.07f) / 0.36f, ty = (y - 0.06f) / 0.11f;
        if (tx >= 0.0f && tx < 1.0f && ty >= 0.0f && ty < 1.0f && is_ink(number % 10000u, tx, ty))
            mix_into(rgb, ink, 0.8f * visible * noise_visible(0.3f, size * 45.0f));
    }
    mix_mean(p, rgb, 1.0f - noise_visible(1.2f, 8.0f * footprint));
    scale(rgb, 0.94f + 0.12f * periodic_octaves(u, v, 64, 64, 6, 0.7f, footprint, p->seed));
}

static void stone(const struct pattern *p, float u, float v, float footprint, float rgb[3])
{
    float bend = periodic_octaves(u, v, 4, 4, 4, 0.55f, footprint, p->seed);
    float cloud = periodic_octaves(u + 0.06f * bend, v + 0.05f * bend, 4, 4, 11, 0.58f, footprint,
                                   p->seed + 7);
    float vein =
        fabsf(periodic_octaves(u - 0.05f * bend, v, 2, 2, 10, 0.5f, footprint, p->seed + 3));
    float fine = periodic_octaves(u, v, 256, 256, 5, 0.7f, footprint, p->seed + 9);
    memcpy(rgb, p->colors[0], 3 * sizeof *rgb);
    mix_into(rgb, p->colors[1], noise_clamp(0.5f + 0.5f * cloud, 0.0f, 1.0f));
    float veined = 1.0f - noise_smoothstep(0.0f, 0.09f + 4.0f * footprint, vein);
    mix_into(rgb, p->colors[2], noise_mix(0.1f, 0.85f * veined, noise_visible(4.0f, footprint)));
    scale(rgb, 1.0f + 0.10f * fine);
}

static void wood(const struct pattern *p, float u, float v, float footprint, float rgb[3])
{
    const float rings = 24.0f;
    float bend = periodic_octaves(u, v, 4, 2, 5, 0.5f, footprint, p->seed);
    float phase = NOISE_TAU * (rings * u + 2.6f * bend);
    float ring = 0.5f + 0.5f * sinf(phase) * noise_visible(2.0f * rings, footprint);
    float grain = periodic_octaves(u, v, 256, 16, 6, 0.65f, footprint, p->seed + 5);
    float pores = periodic_octaves(u, v, 1024, 64, 3, 0.7f, footprint, p->seed + 6);
    memcpy(rgb, p->colors[0], 3 * sizeof *rgb);
    mix_into(rgb, p->colors[1], ring * ring);
    scale(rgb, (1.0f + 0.16f * grain) * (1.0f - 0.25f * noise_smoothstep(0.2f, 1.0f, pores)));
}

/** Returns how much of a texel at x a stripe of a tartan covers. */
static float stripe(float x, float at, float half_width, float footprint)
{
    footprint = fminf(footprint, 1.0f); /* wider texels all see the same mean */
    float distance = fabsf(x - floorf(x) - at);
    return noise_line(fminf(distance, 1.0f - distance), half_width, footprint);
}

/* Tartan cloth of threads that cross over and under each other, each made of fibers. */
static void cloth(const struct pattern *p, float u, float v, float footprint, float rgb[3])
{
    const float threads = 384.0f;
    float over = sinf(NOISE_TAU * threads * u) * sinf(NOISE_TAU * threads * v);
    float soft = noise_visible(2.0f * threads, footprint);
    float warp = noise_clamp(0.5f + over * soft, 0.0f, 1.0f);
    float x = 3.0f * u, y = 3.0f * v, size = 3.0f * footprint;
    memcpy(rgb, p->colors[0], 3 * sizeof *rgb);
    mix_into(rgb, p->colors[1], warp * stripe(x, 0.25f, 0.11f, size));
    mix_into(rgb, p->colors[1], (1.0f - warp) * stripe(y, 0.25f, 0.11f, size));
    mix_into(rgb, p->colors[2], warp * stripe(x, 0.75f, 0.025f, size));
    mix_into(rgb, p->colors[2], (1.0f - warp) * stripe(y, 0.75f, 0.025f, size));
    float fibers = periodic_octaves(u, v, 1024, 1024, 3, 0.7f, footprint, p->seed);
    scale(rgb, (0.92f + 0.16f * fabsf(over) * soft) * (1.0f + 0.16f * fibers));
}

/* Land and sea from far above. */
static void world(const struct pattern *p, float u, float v, float footprint, float rgb[3])
{
    static const float snow[3] = {0.86f, 0.88f, 0.92f};
    float bend = periodic_octaves(u, v, 4, 4, 4, 0.5f, footprint, p->seed);
    float land = periodic_octaves(u + 0.05f * bend, v - 0.04f * bend, 4, 4, 12, 0.55f, footprint,
                                  p->seed + 2);
    float soft = 0.01f + 6.0f * footprint;
    memcpy(rgb, p->colors[0], 3 * sizeof *rgb);
    scale(rgb, 1.0f + 0.5f * noise_clamp(land, -1.0f, 0.0f));
    mix_into(rgb, p->colors[1], noise_smoothstep(-soft, soft, land));
    mix_into(rgb, p->colors[2], noise_smoothstep(0.12f - soft, 0.42f + soft, land));
    mix_into(rgb, snow, noise_smoothstep(0.62f, 0.75f, land + 0.1f * bend));
    float shade = periodic_octaves(u, v, 64, 64, 7, 0.7f, footprint, p->seed + 4);
    scale(rgb, 1.0f + 0.14f * shade * noise_smoothstep(-0.1f, 0.1f, land));
}

/* Panes of glass, or pebbles, with joints between them. */
static void mosaic(const struct pattern *p, float u, float v, float footprint, float rgb[3])
{
    static const float joint[3] = {0.07f, 0.065f, 0.06f};
    const int32_t period = 16;
    const float size = footprint * (float)period;
    struct periodic_cell cell = periodic_cells(u, v, period, p->seed);
    float tone = noise_unit(cell.id * 0x9e3779b1u), pick = noise_unit(cell.id * 0x85ebca77u);
    memcpy(rgb, p->colors[0], 3 * sizeof *rgb);
    mix_into(rgb, p->colors[1 + (cell.id & 1)], pick);
    float apart = noise_visible(0.7f, size); /* 0 where panes are smaller than texels */
    mix_mean(p, rgb, 1.0f - apart);
    tone = noise_mix(0.5f, tone, apart);
    float streaks = periodic_octaves(u, v, 64, 32, 8, 0.62f, footprint, p->seed + cell.id % 8);
    scale(rgb, (0.65f + 0.6f * tone) * (1.0f + 0.16f * streaks));
    mix_into(rgb, joint, noise_line(cell.second - cell.nearest, 0.075f, 2.0f * size));
}

/* Moss and gravel; stones lie where there is no moss. */
static void soil(const struct pattern *p, float u, float v, float footprint, float rgb[3])
{
    const int32_t period = 64;
    const float size = footprint * (float)period;
    float moss = periodic_octaves(u, v, 4, 4, 10, 0.6f, footprint, p->seed);
    float fine = periodic_octaves(u, v, 256, 256, 5, 0.75f, footprint, p->seed + 1);
    float green = noise_smoothstep(-0.35f, 0.35f, moss + 0.2f * fine);
    memcpy(rgb, p->colors[0], 3 * sizeof *rgb);
    float visible = noise_visible(1.0f, size);
    if (visible > 0.0f && green < 1.0f) {
        struct periodic_cell cell = periodic_cells(u, v, period, p->seed + 2);
        float inside = noise_smoothstep(0.0f, 0.25f + size, cell.second - cell.nearest);
        float tone = 0.55f + 0.8f * noise_unit(cell.id * 0x9e3779b1u);
        float light = noise_mix(0.86f, (0.35f + 0.65f * inside) * tone, visible);
        scale(rgb, light);
    } else {
        scale(rgb, 0.86f);
    }
    mix_into(rgb, p->colors[1], 0.92f * green);
    scale(rgb, 1.0f + 0.24f * fine);
}

/** A leaf from its stalk at v = 0 to its tip at v = 1. Alpha is 0 outside. */
static void leaf(const struct pattern *p, float u, float v, float footprint, float rgba[4])
{
    float x = u - 0.5f, notch = sinf(NOISE_TAU * 14.0f * v) * noise_visible(28.0f, footprint);
    float width = 0.44f * powf(fmaxf(sinf(0.5f * NOISE_TAU * powf(v, 0.85f)), 0.0f), 0.8f);
    width = fmaxf(width * (1.0f + 0.05f * notch), 0.022f * (v < 0.97f ? 1.0f : 0.0f));
    rgba[3] = noise_clamp((width - fabsf(x)) / fmaxf(footprint, 1e-6f) + 0.5f, 0.0f, 1.0f);
    float cloud = periodic_octaves(u, v, 4, 4, 9, 0.6f, footprint, p->seed);
    float slant = 9.0f * (v - 0.55f * fabsf(x)), side = slant - floorf(slant) - 0.5f;
    float veins =
        fmaxf(noise_line(x, 0.012f, footprint), 0.6f * noise_line(side, 0.035f, 12.0f * footprint));
    struct periodic_cell cell = {1.0f, 9.0f, 0};
    float net = 0.0f, seen = noise_visible(64.0f, footprint);
    if (seen > 0.0f) {
        cell = periodic_cells(u, v, 64, p->seed + 3);
        net = seen * noise_line(cell.second - cell.nearest, 0.06f, 128.0f * footprint);
    }
    memcpy(rgba, p->colors[0], 3 * sizeof *rgba);
    mix_into(rgba, p->colors[1], noise_clamp(0.4f + 0.6f * cloud + 0.5f * (v - 0.5f), 0.0f, 1.0f));
    mix_into(rgba, p->colors[2], 0.65f * fmaxf(veins, 0.45f * net));
}

void pattern_color(const struct pattern *p, float u, float v, float footprint, float rgba[4])
{
    static void (*const styles[STYLE_COUNT])(const struct pattern *, float, float, float,
                                             float[3]) = {tiles, stone, wood, cloth, world, mosaic};
    rgba[3] = 1.0f;
    if (p->use == TEXTURE_OF_LEAVES)
        leaf(p, u, v, footprint, rgba);
    else
        (p->use == TEXTURE_OF_GROUND ? soil : styles[p->style])(p, u, v, footprint, rgba);
}

static void from_hsv(float hue, float saturation, float value, float rgb[3])
{
    static const float phase[3] = {0.0f, 0.333f, 0.667f};
    for (int i = 0; i < 3; i++) {
        float wave = 0.5f + 0.5f * cosf(NOISE_TAU * (hue - phase[i]));
        rgb[i] = value * (1.0f - saturation * (1.0f - wave));
        rgb[i] *= rgb[i]; /* roughly linear */
    }
}

static void choose_leaf_colors(struct pattern *p)
{
    static const float turns[4][2] = {
        {0.30f, 0.62f}, {0.25f, 0.70f}, {0.36f, 0.55f}, {0.09f, 0.82f}};
    const float *turn = turns[p->seed % 7 == 0 ? 3 : p->seed % 3];
    from_hsv(turn[0], 0.72f, turn[1], p->colors[0]);
    from_hsv(turn[0] - 0.05f, 0.68f, turn[1] + 0.08f, p->colors[1]);
    from_hsv(turn[0] - 0.10f, 0.40f, 0.88f, p->colors[2]);
}

static void choose_thing_colors(struct pattern *p, uint32_t hash)
{
    float hue = noise_unit(hash * 0x9e3779b1u),
          vivid = 0.55f + 0.4f * noise_unit(hash * 0x85ebca77u);
    static const float wood_colors[3][3] = {
        {0.30f, 0.15f, 0.07f}, {0.52f, 0.31f, 0.16f}, {0, 0, 0}};
    from_hsv(hue, vivid, 0.62f, p->colors[0]);
    from_hsv(hue + 0.12f, 0.6f * vivid, 0.84f, p->colors[1]);
    from_hsv(hue + 0.5f, 0.8f * vivid, 0.72f, p->colors[2]);
    if (p->style == STYLE_WOOD) {
        memcpy(p->colors, wood_colors, sizeof p->colors);
        for (int i = 0; i < 2; i++)
            scale(p->colors[i], 0.6f + 0.9f * noise_unit(hash * 0x2c1b3c6du));
    } else if (p->style == STYLE_STONE) {
        from_hsv(hue, 0.18f, 0.45f + 0.4f * vivid, p->colors[0]);
        from_hsv(hue + 0.1f, 0.12f, 0.90f, p->colors[1]);
    } else if (p->style == STYLE_WORLD) {
        from_hsv(0.58f + 0.12f * hue, 0.75f, 0.50f, p->colors[0]);
        from_hsv(0.18f + 0.2f * hue, 0.45f, 0.72f, p->colors[1]);
        from_hsv(0.07f, 0.45f, 0.55f, p->colors[2]);
    }
}

struct pattern pattern_choose(enum texture_use use, uint32_t seed)
{
    uint32_t hash = noise_hash((int32_t)seed, (int32_t)use, 77);
    struct pattern p = {.seed = hash % 60000u + 1, .use = use, .style = seed % STYLE_COUNT};
    static const float ground[3][3] = {{0.40f, 0.34f, 0.27f}, {0.10f, 0.155f, 0.04f}, {0, 0, 0}};
    if (use == TEXTURE_OF_GROUND)
        memcpy(p.colors, ground, sizeof ground);
    else if (use == TEXTURE_OF_LEAVES)
        choose_leaf_colors(&p);
    else
        choose_thing_colors(&p, hash);
    return p;
}

static void source_texel(void *user_data, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                         uint32_t height, float rgba[4])
{
    (void)level;
    pattern_color(user_data, ((float)x + 0.5f) / (float)width, ((float)y + 0.5f) / (float)height,
                  1.0f / (float)height, rgba);
}

SluiceResult pattern_open(const struct pattern *pattern, uint32_t size, SluiceImageSource **source)
{
    SluiceProceduralImage image = {(void *)pattern, source_texel};
    SluiceImageInfo info = {sizeof info, size, size, 0, SLUICE_FORMAT_R8G8B8A8_SRGB, "pattern"};
    return sluiceCreateProceduralImageSource(&image, &info, NULL, source);
}
