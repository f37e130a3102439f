#include "corridor.h"

#include "../../tools/common/option_table.h"
#include "../../tools/common/output_file.h"
#include "../common/png_file.h"
#include "../../tools/common/text.h"

#include <stdio.h>
#include <stdlib.h>

#define REST_FRAMES 80u /* the lattice of room.frag needs 64 to reach every pixel */

struct settings read_settings(int argc, char **argv)
{
    struct settings settings = {0};
    int mode;
    const struct option options[] = {
        {OPTION_CHOICE, "residency", "auto|sparse|paged|dense", "auto", &mode,
         "how tiles get memory"},
        {OPTION_UINT, "frames", "N", "120", &settings.walk_frames,
         "frames of the walk, before the eye rests", 1, 100000},
        {OPTION_EXTENT, "size", "WxH", "640x360", settings.size, "pixels", 1, 4096},
        {OPTION_FLAG, "everything", .value = &settings.everything,
         .help = "have every tile, wanted or not"},
        {OPTION_TEXT, "output", "FILE", "minimal.png", &settings.output,
         "the last picture, as PNG"}};
    const struct option_table table = {
        "minimal",
        "usage: minimal [options]\n\n"
        "Walks along a corridor of streamed textures, without a window.\n",
        "Exit status: 0; 1 if something failed; 2 for wrong usage; 77 if no device can stream.\n",
        options, sizeof options / sizeof *options};
    const enum option_outcome outcome = options_parse(&table, argc, argv);
    if (outcome != OPTIONS_RUN)
        exit(outcome == OPTIONS_ERROR ? 2 : text_flush("") ? 0 : 1);
    if (!output_can_write(settings.output))
        exit(1);
    settings.mode = (SluiceResidencyMode)mode;
    settings.frames = settings.walk_frames + REST_FRAMES;
    return settings;
}

uint32_t texture_of_surface(uint32_t surface)
{
    static const uint32_t textures[SURFACES] = {0, 1, 1, 2};
    return textures[surface];
}

float eye_in_frame(const struct settings *settings, uint32_t frame)
{
    const uint32_t step = frame < settings->walk_frames ? frame : settings->walk_frames;
    return 1.0f - 4.0f * (float)step / (float)settings->walk_frames;
}

/* Returns 0 to 1, different for each stone. */
static float shade_of(uint32_t column, uint32_t row)
{
    uint32_t hash = column * 2654435761u ^ row * 2246822519u;
    hash = (hash ^ hash >> 15) * 3266489917u;
    return (float)(hash >> 8) / 16777216.0f;
}

/* Paints stones made of ever smaller stones, as fine as the level can show, so that edges are sharp
 * at any distance. Any thread. */
static void paint(void *pUserData, uint32_t mipLevel, uint32_t x, uint32_t y, uint32_t width,
                  uint32_t height, float rgba[4])
{
    const float *color = pUserData;
    const uint32_t least = width < height ? width : height;
    float value = 0.6f, strength = 0.4f;
    (void)mipLevel;
    for (uint32_t stones = 4; 4 * stones <= least; stones *= 4) {
        value += strength * (shade_of(x * stones / width, stones + y * stones / height) - 0.5f);
        strength *= 0.7f;
    }
    for (int c = 0; c < 4; c++)
        rgba[c] = c < 3 ? color[c] * value : 1.0f;
}

SluiceResult create_source(uint32_t texture, SluiceImageSource **source)
{
    static float colors[TEXTURES][3] = {{0.9f, 0.6f, 0.3f}, {0.4f, 0.8f, 0.5f}, {0.9f, 0.4f, 0.5f}};
    const SluiceProceduralImage image = {colors[texture], paint};
    const SluiceImageInfo info = {.structSize = sizeof info,
                                  .width = 4096u >> texture, /* a different size for each */
                                  .height = 2048,
                                  .format = SLUICE_FORMAT_R8G8B8A8_SRGB,
                                  .pName = "stones"};
    return sluiceCreateProceduralImageSource(&image, &info, NULL, source);
}

void print_statistics(const SluiceVulkanStreamer *streamer, uint32_t frames)
{
    static const char *const modes[] = {"auto", "sparse", "paged", "dense"};
    SluiceVulkanStreamerStatistics now = {.structSize = sizeof now};
    SluiceResidencyMode mode = SLUICE_RESIDENCY_MODE_AUTO;
    sluiceGetVulkanResidencyMode(streamer, &mode);
    sluiceGetVulkanStreamerStatistics(streamer, &now);
    printf(
        "%s, frame %u: %u of %u tiles mapped, %u loaded so far, %.1f MB of texels read, %.1f MB of "
        "device memory\n",
        modes[mode], frames, now.mappedTileCount, (unsigned)now.tileCount,
        (unsigned)now.tilesMapped, (double)now.bytesRead * 1e-6,
        (double)now.deviceMemorySize * 1e-6);
    fflush(stdout);
}

bool write_picture(const struct settings *settings, const uint8_t *texels)
{
    if (!png_file_write(settings->output, texels, settings->size[0], settings->size[1]))
        return false;
    fprintf(stderr, "wrote %s\n", settings->output);
    return text_flush("");
}
