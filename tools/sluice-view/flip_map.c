#include "flip_map.h"

#include "frames.h"

#include "../common/clock.h"
#include "../common/text.h"

#include <sluice/metrics.h>

#include <stdlib.h>
#include <string.h>

#define FRAMES_BETWEEN 15u
#define REST 3.0 /* pause after a map, as a multiple of its computing time */

static void fail(struct flip_map *m, const char *why)
{
    text_say("sluice-view: FLIP cannot be computed: %s", why);
    m->state = FLIP_FAILED;
    m->known = false;
}

static void compute(struct flip_map *m)
{
    const double begin = clock_seconds();
    const SluicePicturePair pair = {.structSize = sizeof pair,
                                    .pA = m->pictures[0].mapped,
                                    .pB = m->pictures[1].mapped,
                                    .width = m->width,
                                    .height = m->height,
                                    .format = SLUICE_PIXEL_FORMAT_RGBA8_SRGB};
    const SluiceMetricMap map = {.pValues = m->values};
    m->good = sluiceComputeFlip(&pair, 0, &map, NULL, &m->mean) == SLUICE_SUCCESS;
    m->seconds = clock_seconds() - begin;
}

static void *run(void *user_data)
{
    struct flip_map *m = user_data;
    compute(m);
    atomic_store(&m->done, true);
    return NULL;
}

static void take(struct flip_map *m)
{
    m->state = FLIP_IDLE;
    m->next_frame = m->frame + FRAMES_BETWEEN;
    if (!m->good || !ui_texels_fit(m->gpu, m->width, m->height, &m->texels)) {
        fail(m, "out of memory");
        return;
    }
    float *before = m->shown;
    m->shown = m->values;
    m->values = before;
    sluiceColorMagma(m->shown, (size_t)m->width * m->height, m->texels.staging.mapped);
    m->texels.changed = true;
    m->shown_mean = m->mean;
    m->shown_frame = m->frame;
    m->known = true;
}

static void free_copies(struct flip_map *m)
{
    for (int i = 0; i < 2; i++) {
        gpu_destroy_buffer(m->gpu, &m->pictures[i]);
        m->pictures[i] = (struct gpu_buffer){0};
    }
    free(m->values);
    free(m->shown);
    m->values = m->shown = NULL;
    m->known = false;
}

static bool fit(struct flip_map *m, uint32_t width, uint32_t height)
{
    const VkDeviceSize size = (VkDeviceSize)width * height * 4;
    if (m->values && m->width == width && m->height == height)
        return true;
    free_copies(m);
    m->width = width;
    m->height = height;
    m->values = malloc((size_t)size);
    m->shown = malloc((size_t)size);
    for (int i = 0; i < 2; i++)
        if (!gpu_create_buffer(m->gpu, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, &m->pictures[i]))
            return false;
    return m->values && m->shown;
}

static void join(struct flip_map *m)
{
    pthread_join(m->thread, NULL);
    m->next_seconds = clock_seconds() + REST * m->seconds;
}

void flip_map_destroy(struct flip_map *m)
{
    if (!m->gpu)
        return;
    if (m->state == FLIP_RUNNING)
        join(m);
    free_copies(m);
    ui_texels_destroy(&m->texels);
    *m = (struct flip_map){0};
}

static void go_on(struct flip_map *m, uint64_t frame, bool wanted)
{
    if (m->state == FLIP_COPYING && frame >= m->frame + FRAMES_SLOTS) {
        atomic_store(&m->done, false);
        if (pthread_create(&m->thread, NULL, run, m) == 0)
            m->state = FLIP_RUNNING;
        else
            fail(m, "no thread");
    } else if (m->state == FLIP_RUNNING && atomic_load(&m->done)) {
        join(m);
        take(m);
    }
    m->known = m->known && wanted;
}

bool flip_map_begin_frame(struct flip_map *m, const struct gpu *gpu, uint64_t frame, bool wanted,
                          uint32_t width, uint32_t height)
{
    m->gpu = gpu;
    go_on(m, frame, wanted);
    if (!wanted || m->state != FLIP_IDLE ||
        (m->known && (frame < m->next_frame || clock_seconds() < m->next_seconds)))
        return false;
    if (!fit(m, width, height)) {
        free_copies(m);
        fail(m, "out of memory");
        return false;
    }
    m->frame = frame;
    m->state = FLIP_COPYING;
    return true;
}

void flip_map_settle(struct flip_map *m)
{
    if (m->state != FLIP_COPYING)
        return;
    compute(m);
    take(m);
}

float flip_map_at(const struct flip_map *m, float x, float y)
{
    if (!m->known || !(x >= 0 && x < 1 && y >= 0 && y < 1))
        return -1;
    return m->shown[(size_t)(y * (float)m->height) * m->width + (size_t)(x * (float)m->width)];
}
