#include "patterns.h"

#include "../common/noise.h"

/* A stone of a mosaic. Rows are shifted against each other, and each stone is moved a little. */
struct stone {
    uint32_t id;
    float edge;        ///< distance to the joint, in stones; negative inside the joint
    float row, column; ///< place in the stone, -0.5 to 0.5
};

#define STONES 14.0f
#define JOINT 0.055f

static struct stone stone_at(float u, float v)
{
    float y = v * STONES;
    int32_t row = noise_floor(y);
    float x = u * STONES + 0.5f * (float)(row & 1) + 0.3f * noise_unit(noise_hash(row, 7, 3));
    int32_t column = noise_floor(x);
    struct stone stone = {.id = noise_hash(column, row, 91)};
    stone.column = x - (float)column - 0.5f;
    stone.row = y - (float)row - 0.5f;
    float jitter = 0.05f * noise_unit(stone.id);
    stone.edge = 0.5f - JOINT - jitter - fmaxf(fabsf(stone.column), fabsf(stone.row));
    return stone;
}

/** Returns 1 on a stone, 0 in a joint. */
static float on_stone(const struct stone *stone, float footprint)
{
    return noise_clamp(0.5f + stone->edge / (footprint * STONES + 0.03f), 0.0f, 1.0f);
}

/* Light and dark stones whose colors follow rings around the middle, with veins of marble. */
void pattern_mosaic(float u, float v, float footprint, float rgb[3])
{
    static const float phase[3] = {0.02f, 0.12f, 0.24f};
    struct stone stone = stone_at(u, v);
    float du = u - 0.5f, dv = v - 0.5f, tone = noise_unit(stone.id);
    float ring = floorf(12.0f * sqrtf(du * du + dv * dv)) / 7.0f;
    struct noise_sum bend = noise_octaves(u + tone, v, 9.0f, 3, 0.5f, footprint, 51);
    struct noise_sum vein =
        noise_octaves(u + tone + 0.05f * bend.value, v, 24.0f, 4, 0.6f, footprint, 61);
    float light = 0.30f + 0.45f * tone + 0.16f * vein.value, stones = on_stone(&stone, footprint);
    noise_palette(ring + 0.10f * tone, phase, rgb);
    for (int c = 0; c < 3; c++) {
        float color = noise_clamp(light * (0.25f + 0.75f * rgb[c]), 0.0f, 1.0f);
        rgb[c] = noise_mix(0.10f + 0.03f * vein.value, color, stones);
    }
}

void pattern_mosaic_height(float u, float v, float footprint, float rgb[3])
{
    struct stone stone = stone_at(u, v);
    struct noise_sum rough = noise_octaves(u, v, 60.0f, 3, 0.6f, footprint, 71);
    float dome = 1.0f - 1.2f * (stone.row * stone.row + stone.column * stone.column);
    float height = 0.45f + 0.45f * dome + 0.05f * rough.value;
    rgb[0] = rgb[1] = rgb[2] =
        noise_mix(0.12f + 0.06f * rough.value, height, on_stone(&stone, footprint));
}

void pattern_mosaic_roughness(float u, float v, float footprint, float rgb[3])
{
    struct stone stone = stone_at(u, v);
    struct noise_sum worn = noise_octaves(u, v, 6.0f, 4, 0.6f, footprint, 81);
    float polished = 0.25f + 0.35f * noise_unit(stone.id * 2654435761u) + 0.15f * worn.value;
    rgb[0] = rgb[1] = rgb[2] = noise_clamp(
        noise_mix(0.85f + 0.1f * worn.value, polished, on_stone(&stone, footprint)), 0.0f, 1.0f);
}
