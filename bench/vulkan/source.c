#include "source.h"

#include <string.h>

#define NOISE_SIZE 65536u

/* Bytes of every tile. Random, because devices compress and elide uniform data. */
static unsigned char noise[NOISE_SIZE];

static void fill_noise(void)
{
    uint32_t state = 12345;
    for (uint32_t i = 0; i < NOISE_SIZE; i++) {
        state = state * 1664525u + 1013904223u;
        noise[i] = (unsigned char)(state >> 24);
    }
}

static SluiceResult get_info(SluiceImageSource *source, SluiceImageInfo *info)
{
    *info = ((struct free_source *)source)->info;
    return SLUICE_SUCCESS;
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    const struct free_source *source = (struct free_source *)base;
    SluiceFormatInfo format = {.structSize = sizeof format};
    sluiceGetFormatInfo(source->info.format, &format);
    size_t row = (size_t)sluiceGetFormatRegionSize(source->info.format, region->width, 1);
    uint32_t rows = (region->height + format.blockHeight - 1) / format.blockHeight;
    if (row == row_pitch) { /* tiles are tightly packed */
        row *= rows;
        rows = 1;
    }
    for (uint32_t y = 0; y < rows; y++)
        for (size_t done = 0; done < row; done += NOISE_SIZE)
            memcpy((char *)texels + y * row_pitch + done, noise,
                   row - done < NOISE_SIZE ? row - done : NOISE_SIZE);
    return SLUICE_SUCCESS;
}

static void destroy(SluiceImageSource *source)
{
    (void)source;
}

void free_source_init(struct free_source *source, SluiceFormat format, uint32_t size)
{
    static const SluiceImageSourceInterface interface = {sizeof interface, get_info, read_region,
                                                         destroy};
    uint32_t levels = 1;
    while (size >> levels)
        levels++;
    fill_noise();
    *source = (struct free_source){.base = {&interface},
                                   .info = {.width = size,
                                            .height = size,
                                            .mipLevelCount = levels,
                                            .format = format,
                                            .pName = "noise"}};
}
