#include "thumbs.h"

#include "stage.h"

#include "../common/clock.h"

#include <stdlib.h>
#include <string.h>

#define ROW (THUMBS_COLUMNS * THUMBS_CELL)
#define MOST_SIDE 256u /* longest side of a level that is read */
#define TRIES 40       /* attempts to read, since a source may still be baking */
#define TRY_SECONDS 0.5
#define FRAMES_BETWEEN 20u

static uint32_t bytes_of(SluiceFormat format)
{
    switch (format) {
    case SLUICE_FORMAT_R8_UNORM: return 1;
    case SLUICE_FORMAT_R8G8B8A8_UNORM:
    case SLUICE_FORMAT_R8G8B8A8_SRGB: return 4;
    default: return 0;
    }
}

static uint32_t side_of(uint32_t size, uint32_t level)
{
    return size >> level > 0 ? size >> level : 1;
}

/* Fills a cell with the nearest texel per pixel, keeping the picture's proportions. */
static void shrink(const uint8_t *texels, uint32_t width, uint32_t height, uint32_t bytes,
                   uint8_t cell[THUMBS_CELL][THUMBS_CELL][4])
{
    const uint32_t longer = width > height ? width : height;
    for (uint32_t y = 0; y < THUMBS_CELL; y++)
        for (uint32_t x = 0; x < THUMBS_CELL; x++) {
            const uint32_t u = (2 * x + 1) * longer / (2 * THUMBS_CELL);
            const uint32_t v = (2 * y + 1) * longer / (2 * THUMBS_CELL);
            const uint8_t *from = texels + ((size_t)v * width + u) * bytes;
            for (uint32_t i = 0; u < width && v < height && i < 3; i++)
                cell[y][x][i] = from[bytes == 4 ? i : 0];
            cell[y][x][3] = u < width && v < height ? 255 : 0;
        }
}

/* Returns the finest level that fits a cell, or the last level. */
static uint32_t level_of(const SluiceImageInfo *info)
{
    uint32_t level = 0;
    while (level + 1 < info->mipLevelCount && (side_of(info->width, level) > THUMBS_CELL ||
                                               side_of(info->height, level) > THUMBS_CELL))
        level++;
    return level;
}

static bool read_source(SluiceImageSource *source, struct thumb_texels *texels)
{
    SluiceImageInfo info = {.structSize = sizeof info};
    if (sluiceGetImageInfo(source, &info) != SLUICE_SUCCESS)
        return false;
    const uint32_t level = level_of(&info);
    const SluiceImageRegion region = {.mipLevel = level,
                                      .width = side_of(info.width, level),
                                      .height = side_of(info.height, level)};
    if (region.width > MOST_SIDE || region.height > MOST_SIDE)
        return false;
    const uint64_t size = sluiceGetFormatRegionSize(info.format, region.width, region.height);
    const uint64_t row = sluiceGetFormatRegionSize(info.format, region.width, 1);
    *texels = (struct thumb_texels){info.format, region.width, region.height, malloc(size + 1)};
    if (texels->bytes &&
        sluiceReadImageRegion(source, &region, texels->bytes, (size_t)row) == SLUICE_SUCCESS)
        return true;
    thumb_texels_finish(texels);
    return false;
}

/* Reads the texels of a texture. False if its source cannot be shown, or is not ready. */
static bool read_texels(const struct stage *stage, uint32_t texture, struct thumb_texels *texels)
{
    SluiceImageSource *source = stage_borrow_source(stage, texture);
    const bool read = source && read_source(source, texels);
    if (source)
        stage_return_source(stage, texture, source);
    return read;
}

static void keep(struct thumbs *t, uint32_t texture, uint8_t cell[THUMBS_CELL][THUMBS_CELL][4])
{
    const size_t left = texture % THUMBS_COLUMNS * THUMBS_CELL;
    const size_t top = (size_t)(texture / THUMBS_COLUMNS) * THUMBS_CELL;
    pthread_mutex_lock(&t->lock);
    for (size_t y = 0; y < THUMBS_CELL; y++)
        memcpy(t->pixels + ((top + y) * ROW + left) * 4, cell[y], sizeof cell[y]);
    t->known[texture] = true;
    pthread_mutex_unlock(&t->lock);
    atomic_fetch_add(&t->changes, 1);
}

static bool is_read(struct thumbs *t, uint32_t texture)
{
    pthread_mutex_lock(&t->lock);
    const bool read = t->known[texture] || t->raw[texture].bytes;
    pthread_mutex_unlock(&t->lock);
    return read;
}

/* Takes the texels. thumbs_record lets the device convert most formats. */
static bool take(struct thumbs *t, uint32_t texture, struct thumb_texels *texels)
{
    uint8_t cell[THUMBS_CELL][THUMBS_CELL][4] = {{{0}}};
    const uint32_t bytes = bytes_of(texels->format);
    if (bytes == 0 && thumb_texels_fit(t->gpu, texels->format)) {
        pthread_mutex_lock(&t->lock);
        t->raw[texture] = *texels;
        pthread_mutex_unlock(&t->lock);
        return true;
    }
    if (bytes > 0) {
        shrink(texels->bytes, texels->width, texels->height, bytes, cell);
        keep(t, texture, cell);
    }
    thumb_texels_finish(texels);
    return bytes > 0;
}

/* Reads all pictures. Returns the number of pictures that are still missing. */
static uint32_t read_all(struct thumbs *t)
{
    uint32_t left = 0;
    for (uint32_t i = 0; i < t->count && !atomic_load(&t->stop); i++) {
        struct thumb_texels texels;
        if (is_read(t, i))
            continue;
        if (!read_texels(t->stage, i, &texels) || !take(t, i, &texels))
            left++;
    }
    return left;
}

/* Converts the texels of one texture. False if none wait. */
static bool convert_next(struct thumbs *t)
{
    uint8_t cell[THUMBS_CELL][THUMBS_CELL][4];
    struct thumb_texels texels = {0};
    uint32_t texture = 0;
    pthread_mutex_lock(&t->lock);
    for (uint32_t i = 0; i < t->count && !texels.bytes; i++) {
        texture = (t->next_raw + i) % t->count;
        texels = t->raw[texture];
        t->raw[texture] = (struct thumb_texels){0};
    }
    pthread_mutex_unlock(&t->lock);
    t->next_raw = texture;
    if (!texels.bytes)
        return false;
    if (thumb_texels_convert(t->gpu, &texels, cell))
        keep(t, texture, cell);
    thumb_texels_finish(&texels);
    return true;
}

static void convert_all(struct thumbs *t)
{
    while (convert_next(t))
        continue;
}

static void *run(void *user_data)
{
    struct thumbs *t = user_data;
    /* Rays may open pictures at any time. */
    for (int i = 0; (i < TRIES || stage_traced(t->stage)) && read_all(t) > 0; i++) {
        const double until = clock_seconds() + TRY_SECONDS;
        while (!atomic_load(&t->stop) && clock_seconds() < until)
            clock_sleep_until(clock_seconds() + 0.02);
    }
    return NULL;
}

void thumbs_begin(struct thumbs *t, const struct gpu *gpu, const struct stage *stage, bool wait)
{
    if (t->stage && wait && stage_traced(stage) && t->count > 0) {
        read_all(t);
        convert_all(t);
    }
    if (t->stage)
        return;
    const uint32_t all = stage_texture_count(stage);
    *t =
        (struct thumbs){.gpu = gpu, .stage = stage, .count = all < THUMBS_MOST ? all : THUMBS_MOST};
    const uint32_t rows = (t->count + THUMBS_COLUMNS - 1) / THUMBS_COLUMNS;
    pthread_mutex_init(&t->lock, NULL);
    t->pixels = calloc((size_t)rows * THUMBS_CELL * ROW + 1, 4);
    t->known = calloc(t->count + 1u, sizeof *t->known);
    t->raw = calloc(t->count + 1u, sizeof *t->raw);
    if (!t->pixels || !t->known || !t->raw || rows == 0 ||
        !ui_texels_fit(gpu, ROW, rows * THUMBS_CELL, &t->texels))
        t->count = 0;
    else if (wait)
        read_all(t), convert_all(t);
    else
        t->threaded = pthread_create(&t->thread, NULL, run, t) == 0;
}

void thumbs_record(struct thumbs *t, uint64_t frame, VkCommandBuffer commands)
{
    if (t->count > 0)
        convert_next(t); /* one per frame, since it delays the frame */
    const unsigned changes = atomic_load(&t->changes);
    if (t->count == 0 || changes == t->shown || frame < t->next)
        return;
    pthread_mutex_lock(&t->lock);
    memcpy(t->texels.staging.mapped, t->pixels, (size_t)ROW * t->texels.height * 4);
    pthread_mutex_unlock(&t->lock);
    t->shown = changes;
    t->next = frame + FRAMES_BETWEEN;
    t->texels.changed = true;
    ui_texels_record(&t->texels, commands);
}

void thumbs_end(struct thumbs *t)
{
    if (!t->stage)
        return;
    atomic_store(&t->stop, true);
    if (t->threaded)
        pthread_join(t->thread, NULL);
    ui_texels_destroy(&t->texels);
    pthread_mutex_destroy(&t->lock);
    for (uint32_t i = 0; t->raw && i < t->count; i++)
        thumb_texels_finish(&t->raw[i]);
    free(t->pixels);
    free(t->known);
    free(t->raw);
    t->raw = NULL;
    t->stage = NULL;
    t->pixels = NULL;
    t->known = NULL;
    t->count = 0;
    t->threaded = false;
}

bool thumbs_find(struct thumbs *t, uint32_t texture, float uv[4])
{
    if (texture >= t->count || !t->texels.filled)
        return false;
    pthread_mutex_lock(&t->lock);
    const bool known = t->known[texture];
    pthread_mutex_unlock(&t->lock);
    uv[0] = (float)(texture % THUMBS_COLUMNS) / THUMBS_COLUMNS;
    uv[1] = (float)(texture / THUMBS_COLUMNS * THUMBS_CELL) / (float)t->texels.height;
    uv[2] = uv[0] + 1.0f / THUMBS_COLUMNS;
    uv[3] = uv[1] + (float)THUMBS_CELL / (float)t->texels.height;
    return known;
}
