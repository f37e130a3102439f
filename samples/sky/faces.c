#include "faces.h"

#include "../common/noise.h"

static const float sun[3] = {0.552f, 0.258f, -0.793f};

/* Computes the direction of a position on a face, in [0, 1] from its upper left, as Vulkan defines
 * it. */
static void direction_of(uint32_t face, float u, float v, float d[3])
{
    float s = 2 * u - 1, t = 2 * v - 1;
    const float directions[FACES][3] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t},
                                        {s, -1, -t}, {s, -t, 1},  {-s, -t, -1}};
    const float *along = directions[face];
    float length = sqrtf(along[0] * along[0] + along[1] * along[1] + along[2] * along[2]);
    for (int i = 0; i < 3; i++)
        d[i] = along[i] / length;
}

static void blend(float rgb[3], float r, float g, float b, float share)
{
    rgb[0] = noise_mix(rgb[0], r, share);
    rgb[1] = noise_mix(rgb[1], g, share);
    rgb[2] = noise_mix(rgb[2], b, share);
}

/* Paints directions above the horizon: blue that fades to haze, the sun, clouds on a plane, and
 * mountains. `texel`: radians per texel. */
static void paint_sky(const float d[3], float texel, float rgb[3])
{
    float up = d[1] > 0 ? d[1] : 0, to_sun = d[0] * sun[0] + d[1] * sun[1] + d[2] * sun[2];
    rgb[0] = 0.16f, rgb[1] = 0.36f, rgb[2] = 0.68f;
    blend(rgb, 0.86f, 0.83f, 0.80f, expf(-5 * up));
    blend(rgb, 1.0f, 0.86f, 0.62f, 0.6f * powf(noise_clamp(to_sun, 0, 1), 24));
    float height = 1 / (up + 0.12f), x = d[0] * height, z = d[2] * height;
    struct noise_sum cloud = noise_octaves(x, z, 0.9f, 9, 0.55f, texel * height * height, 11);
    float cover = noise_smoothstep(0.05f, 0.75f, cloud.value) * noise_smoothstep(0.02f, 0.25f, up);
    float lit = noise_clamp(0.85f - 0.05f * (cloud.dx * sun[0] + cloud.dy * sun[2]), 0.55f, 1.0f);
    blend(rgb, lit, lit, 0.03f + 0.97f * lit, cover);
    blend(rgb, 1.0f, 0.98f, 0.92f, noise_smoothstep(0.9994f, 0.9997f, to_sun));
    float across = sqrtf(d[0] * d[0] + d[2] * d[2]) + 1e-6f, a = d[0] / across, b = d[2] / across;
    struct noise_sum ridge = noise_octaves(a, b, 4.1f, 10, 0.52f, texel, 71);
    float top = 0.07f + 0.06f * ridge.value;
    float rock = noise_clamp((top - d[1]) / texel + 0.5f, 0, 1);
    struct noise_sum stone =
        noise_octaves(a + 9 * d[1], b - 9 * d[1], 12.0f, 6, 0.6f, 6 * texel, 5);
    float shade = 0.36f + 0.10f * stone.value,
          snow = noise_smoothstep(0.06f, 0.11f, d[1] + 0.02f * stone.value);
    blend(rgb, noise_mix(shade, 0.86f, snow), noise_mix(shade, 0.88f, snow),
          noise_mix(shade + 0.08f, 0.93f, snow), rock * 0.9f);
}

/* Paints a texel. Below the horizon is a lake that reflects, with waves that get smaller with the
 * distance. */
static void paint(void *pUserData, uint32_t mipLevel, uint32_t x, uint32_t y, uint32_t width,
                  uint32_t height, float rgba[4])
{
    uint32_t face = *(const uint32_t *)pUserData;
    float d[3], texel = 1.6f / (float)width;
    (void)mipLevel;
    direction_of(face, ((float)x + 0.5f) / (float)width, ((float)y + 0.5f) / (float)height, d);
    rgba[3] = 1;
    if (d[1] >= 0) {
        paint_sky(d, texel, rgba);
        return;
    }
    float distance = 1 / (0.02f - d[1]);
    struct noise_sum wave = noise_octaves(d[0] * distance, d[2] * distance, 6.0f, 7, 0.6f,
                                          texel * distance * distance, 31);
    float down = -d[1], tilt = 0.35f * down * wave.value;
    const float mirrored[3] = {d[0], fabsf(down + tilt) + 0.002f, d[2]};
    paint_sky(mirrored, texel * (1 + 40 * down), rgba);
    float clear = noise_clamp(0.25f + 0.75f * down, 0, 0.85f);
    blend(rgba, 0.05f, 0.16f, 0.20f, clear);
}

SluiceResult faces_create(uint32_t size, struct faces *faces)
{
    static const uint32_t numbers[FACES] = {0, 1, 2, 3, 4, 5};
    const SluiceImageInfo info = {.structSize = sizeof info,
                                  .width = size,
                                  .height = size,
                                  .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                  .pName = "sky"};
    *faces = (struct faces){0};
    for (uint32_t i = 0; i < FACES; i++) {
        const SluiceProceduralImage image = {(void *)&numbers[i], paint};
        SluiceResult result =
            sluiceCreateProceduralImageSource(&image, &info, NULL, &faces->faces[i]);
        if (result != SLUICE_SUCCESS)
            return result;
    }
    return sluiceCreateArrayImageSource(faces->faces, FACES, NULL, &faces->cube);
}

void faces_destroy(struct faces *faces)
{
    sluiceDestroyImageSource(faces->cube);
    for (uint32_t i = 0; i < FACES; i++)
        sluiceDestroyImageSource(faces->faces[i]);
    *faces = (struct faces){0};
}
