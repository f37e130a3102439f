#include "thumbs.h"

#include "stage.h"

#include "../common/clock.h"

#include <stdlib.h>
#include <string.h>

#define ROW (THUMBS_COLUMNS * THUMBS_CELL)
#define MOST_SIDE 256u /* of a level that is read */
#define TRIES 40       /* sources may still be baked */
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

/* The nearest texel for each pixel, in the picture's proportions. */
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

static bool read_source(SluiceImageSource *source, uint8_t cell[THUMBS_CELL][THUMBS_CELL][4])
{
    SluiceImageInfo info = {.structSize = sizeof info};
    uint32_t level = 0;
    if (sluiceGetImageInfo(source, &info) != SLUICE_SUCCESS)
        return false;
    while (level + 1 < info.mipLevelCount &&
           (side_of(info.width, level) > THUMBS_CELL || side_of(info.height, level) > THUMBS_CELL))
        level++;
    const SluiceImageRegion region = {.mipLevel = level,
                                      .width = side_of(info.width, level),
                                      .height = side_of(info.height, level)};
    const uint32_t bytes = bytes_of(info.format);
    if (bytes == 0 || region.width > MOST_SIDE || region.height > MOST_SIDE)
        return false;
    uint8_t *texels = malloc((size_t)region.width * region.height * bytes);
    const bool read =
        texels && sluiceReadImageRegion(source, &region, texels, (size_t)region.width * bytes) ==
                      SLUICE_SUCCESS;
    if (read)
        shrink(texels, region.width, region.height, bytes, cell);
    free(texels);
    return read;
}

/* False if the source cannot be shown, or is not ready. */
static bool read_cell(const struct stage *stage, uint32_t texture,
                      uint8_t cell[THUMBS_CELL][THUMBS_CELL][4])
{
    SluiceImageSource *source = stage_borrow_source(stage, texture);
    const bool read = source && read_source(source, cell);
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

/* Returns how many are not there. */
static uint32_t read_all(struct thumbs *t)
{
    uint8_t cell[THUMBS_CELL][THUMBS_CELL][4] = {{{0}}};
    uint32_t left = 0;
    for (uint32_t i = 0; i < t->count && !atomic_load(&t->stop); i++) {
        if (t->known[i]) /* only this thread writes it */
            continue;
        if (read_cell(t->stage, i, cell))
            keep(t, i, cell);
        else
            left++;
    }
    return left;
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
    if (t->stage && wait && stage_traced(stage) && t->count > 0)
        read_all(t);
    if (t->stage)
        return;
    const uint32_t all = stage_texture_count(stage);
    *t = (struct thumbs){.stage = stage, .count = all < THUMBS_MOST ? all : THUMBS_MOST};
    const uint32_t rows = (t->count + THUMBS_COLUMNS - 1) / THUMBS_COLUMNS;
    pthread_mutex_init(&t->lock, NULL);
    t->pixels = calloc((size_t)rows * THUMBS_CELL * ROW + 1, 4);
    t->known = calloc(t->count + 1u, sizeof *t->known);
    if (!t->pixels || !t->known || rows == 0 ||
        !ui_texels_fit(gpu, ROW, rows * THUMBS_CELL, &t->texels))
        t->count = 0;
    else if (wait)
        read_all(t);
    else
        t->threaded = pthread_create(&t->thread, NULL, run, t) == 0;
}

void thumbs_record(struct thumbs *t, uint64_t frame, VkCommandBuffer commands)
{
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
    free(t->pixels);
    free(t->known);
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
