#include "exr/plain_exr.h"

#include <openexr.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Everything that is needed to decode one chunk into its place in a level. */
static bool decode(exr_context_t context, const exr_chunk_info_t *info, struct plain_level *level,
                   uint32_t x, uint32_t y)
{
    exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
    bool good = exr_decoding_initialize(context, 0, info, &pipeline) == EXR_ERR_SUCCESS;
    for (int c = 0; good && c < pipeline.channel_count; c++) {
        struct plain_channel *channel = &level->channels[c];
        pipeline.channels[c].user_pixel_stride = channel->bytes;
        pipeline.channels[c].user_line_stride = (int32_t)level->width * channel->bytes;
        pipeline.channels[c].decode_to_ptr =
            (uint8_t *)channel->texels + ((size_t)y * level->width + x) * (size_t)channel->bytes;
    }
    good = good && exr_decoding_choose_default_routines(context, 0, &pipeline) == EXR_ERR_SUCCESS &&
           exr_decoding_run(context, 0, &pipeline) == EXR_ERR_SUCCESS;
    exr_decoding_destroy(context, &pipeline);
    return good;
}

static bool allocate(exr_context_t context, struct plain_level *level)
{
    const exr_attr_chlist_t *list;
    if (exr_get_channels(context, 0, &list) != EXR_ERR_SUCCESS || list->num_channels > 8)
        return false;
    level->channel_count = list->num_channels;
    for (int c = 0; c < list->num_channels; c++) {
        struct plain_channel *channel = &level->channels[c];
        snprintf(channel->name, sizeof channel->name, "%s", list->entries[c].name.str);
        channel->bytes = list->entries[c].pixel_type == EXR_PIXEL_HALF ? 2 : 4;
        channel->texels = calloc((size_t)level->width * level->height, (size_t)channel->bytes);
    }
    return true;
}

static bool read_scanlines(exr_context_t context, struct plain_level *level, int32_t first)
{
    int32_t lines = 0;
    bool good = exr_get_scanlines_per_chunk(context, 0, &lines) == EXR_ERR_SUCCESS;
    for (uint32_t y = 0; good && y < level->height; y += (uint32_t)lines) {
        exr_chunk_info_t info;
        good = exr_read_scanline_chunk_info(context, 0, first + (int32_t)y, &info) ==
                   EXR_ERR_SUCCESS &&
               decode(context, &info, level, 0, y);
    }
    return good;
}

static bool read_tiles(exr_context_t context, struct plain_level *level, int number)
{
    int32_t width = 0, height = 0;
    bool good = exr_get_tile_sizes(context, 0, number, number, &width, &height) == EXR_ERR_SUCCESS;
    for (int32_t y = 0; good && y * height < (int32_t)level->height; y++)
        for (int32_t x = 0; good && x * width < (int32_t)level->width; x++) {
            exr_chunk_info_t info;
            good = exr_read_tile_chunk_info(context, 0, x, y, number, number, &info) ==
                       EXR_ERR_SUCCESS &&
                   decode(context, &info, level, (uint32_t)(x * width), (uint32_t)(y * height));
        }
    return good;
}

bool plain_exr_read(const char *path, int number, struct plain_level *level)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t context;
    exr_storage_t storage;
    exr_attr_box2i_t window;
    int32_t width, height;
    memset(level, 0, sizeof *level);
    if (exr_start_read(&context, path, &init) != EXR_ERR_SUCCESS)
        return false;
    exr_get_storage(context, 0, &storage);
    exr_get_data_window(context, 0, &window);
    width = window.max.x - window.min.x + 1;
    height = window.max.y - window.min.y + 1;
    if (storage == EXR_STORAGE_TILED)
        exr_get_level_sizes(context, 0, number, number, &width, &height);
    level->width = (uint32_t)width;
    level->height = (uint32_t)height;
    bool good = allocate(context, level);
    if (good)
        good = storage == EXR_STORAGE_TILED ? read_tiles(context, level, number)
                                            : read_scanlines(context, level, window.min.y);
    exr_finish(&context);
    return good;
}

void plain_exr_free(struct plain_level *level)
{
    for (int c = 0; c < level->channel_count; c++)
        free(level->channels[c].texels);
}

const struct plain_channel *plain_exr_find(const struct plain_level *level, const char *name)
{
    for (int c = 0; c < level->channel_count; c++)
        if (strcmp(level->channels[c].name, name) == 0)
            return &level->channels[c];
    return NULL;
}
