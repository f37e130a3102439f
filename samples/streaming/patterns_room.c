#include "patterns.h"

#include "../common/noise.h"

/** Value noise whose lattice repeats after `period` cells. */
static float repeating_noise(float x, float y, int32_t period, uint32_t seed)
{
    int32_t ix = noise_floor(x), iy = noise_floor(y);
    float fx = x - (float)ix, fy = y - (float)iy;
    float u = fx * fx * (3.0f - 2.0f * fx), v = fy * fy * (3.0f - 2.0f * fy);
    int32_t x0 = ((ix % period) + period) % period, y0 = ((iy % period) + period) % period;
    int32_t x1 = (x0 + 1) % period, y1 = (y0 + 1) % period;
    float top =
        noise_mix(noise_unit(noise_hash(x0, y0, seed)), noise_unit(noise_hash(x1, y0, seed)), u);
    float bottom =
        noise_mix(noise_unit(noise_hash(x0, y1, seed)), noise_unit(noise_hash(x1, y1, seed)), u);
    return 2.0f * noise_mix(top, bottom, v) - 1.0f;
}

static float repeating_octaves(float x, float y, int32_t period, int octaves, float gain,
                               float footprint, uint32_t seed)
{
    float sum = 0.0f, amplitude = 1.0f;
    for (int i = 0; i < octaves; i++, period *= 2, amplitude *= gain) {
        float frequency = (float)period, visible = noise_visible(frequency, footprint);
        if (visible == 0.0f)
            break;
        sum += amplitude * visible *
               repeating_noise(x * frequency, y * frequency, period, seed + (uint32_t)i);
    }
    return sum;
}

/* Oak boards, 16 to the repeat, each of its own tone, with grain, pores and dark joints. */
void pattern_parquet(float u, float v, float footprint, float rgb[3])
{
    const float boards = 16.0f, lengths = 4.0f;
    float across = u * boards;
    int32_t board = noise_floor(across) % 16;
    float along = v * lengths + noise_unit(noise_hash(board, 0, 9));
    int32_t piece = noise_floor(along) % 4;
    uint32_t id = noise_hash(board, piece, 31);
    float tone = noise_unit(id);

    float shift = (float)(id % 64u) / 64.0f;
    float grain = repeating_octaves(u + shift, v * 0.125f + shift, 64, 5, 0.6f, footprint, 5);
    float rings = 0.5f + 0.5f * sinf(NOISE_TAU * (across * 3.0f + 2.2f * grain + 9.0f * tone));
    float light = 0.62f + 0.30f * tone + 0.10f * grain +
                  0.14f * rings * noise_visible(boards * 3.0f, footprint);
    float pores = repeating_octaves(u, v * 0.0625f, 512, 3, 0.7f, footprint, 17);
    light *= 1.0f - 0.18f * noise_smoothstep(0.1f, 0.9f, pores);

    float fx = across - floorf(across), fy = along - floorf(along);
    float joint = noise_line(fminf(fx, 1.0f - fx), 0.012f, footprint * boards);
    joint = fmaxf(joint, noise_line(fminf(fy, 1.0f - fy), 0.0025f, footprint * lengths));
    light *= 1.0f - 0.7f * joint;
    rgb[0] = 0.30f * light, rgb[1] = 0.165f * light, rgb[2] = 0.080f * light;
}

/** 1 inside a flower of four petals around (0, 0), 0 outside. */
static float flower(float x, float y, float size, float depth, float footprint)
{
    float squared = x * x + y * y + 1e-9f, radius = sqrtf(squared);
    float c = x * x / squared; /* squared cosine of the angle: cos 4a = 8 c^2 - 8 c + 1 */
    float edge = size * (1.0f + depth * (8.0f * c * c - 8.0f * c + 1.0f));
    return noise_clamp((edge - radius) / (footprint + 0.004f) + 0.5f, 0.0f, 1.0f);
}

/* A muted damask: flowers in a diamond lattice, a shade brighter than the weave they are in. */
void pattern_wallpaper(float u, float v, float footprint, float rgb[3])
{
    float x = u * 4.0f, y = v * 4.0f, size = footprint * 4.0f;
    float fx = x - floorf(x) - 0.5f, fy = y - floorf(y) - 0.5f;
    float gx = 0.5f - fabsf(fx), gy = 0.5f - fabsf(fy); /* distances to the nearest corner */
    float ornament = flower(fx, fy, 0.24f, 0.30f, size) - flower(fx, fy, 0.17f, 0.30f, size) +
                     flower(fx, fy, 0.10f, -0.35f, size) + flower(gx, gy, 0.16f, -0.35f, size) -
                     flower(gx, gy, 0.08f, 0.2f, size);
    float lattice = fabsf(fabsf(fx) + fabsf(fy) - 0.5f);
    ornament = fmaxf(ornament, noise_line(lattice, 0.012f, size * 1.5f));
    float weave = sinf(NOISE_TAU * 384.0f * u) * sinf(NOISE_TAU * 384.0f * v) *
                  noise_visible(384.0f, footprint);
    float plaster = repeating_octaves(u, v, 8, 7, 0.62f, footprint, 71);
    float light = 0.78f + 0.11f * ornament + 0.06f * weave + 0.04f * plaster;
    rgb[0] = 0.155f * light, rgb[1] = 0.225f * light, rgb[2] = 0.215f * light;
}

void pattern_canvas(float u, float v, float footprint, float rgb[3])
{
    const float threads = 520.0f;
    float weave = sinf(NOISE_TAU * threads * u) * sinf(NOISE_TAU * threads * v);
    struct noise_sum bend = noise_octaves(u, v, 5.0f, 2, 0.5f, footprint, 7);
    struct noise_sum strokes = noise_octaves(u + 0.02f * bend.value, v * 0.3f + 0.1f * bend.value,
                                             60.0f, 4, 0.6f, footprint, 41);
    rgb[0] = noise_clamp(0.5f + 0.10f * weave * noise_visible(threads, footprint) +
                             0.16f * strokes.value,
                         0.0f, 1.0f);
    rgb[1] = rgb[2] = rgb[0];
}
