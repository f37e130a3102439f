#include "bake/astc_pool.h"

#include "bake/block_astc.h"
#include "base/alloc.h"
#include "base/checked.h"

#include <string.h>

struct slc_astc_context {
    struct slc_astc_context *next;
    uint32_t extent;
    bool srgb;
    SluiceBakeQuality quality;
    void *context;
};

void slc_astc_pool_init(struct slc_astc_pool *pool, const SluiceAllocationCallbacks *cb)
{
    *pool = (struct slc_astc_pool){.allocator = *cb, .is_ready = true};
    slc_mutex_init(&pool->mutex);
}

static void destroy_context(struct slc_astc_pool *pool, struct slc_astc_context *context)
{
#ifdef SLC_HAVE_ASTC
    slc_astc_close(context->context);
#endif
    slc_free(&pool->allocator, context, 1, sizeof *context);
}

void slc_astc_pool_finish(struct slc_astc_pool *pool)
{
    while (pool->idle) {
        struct slc_astc_context *context = pool->idle;
        pool->idle = context->next;
        destroy_context(pool, context);
    }
    if (pool->is_ready)
        slc_mutex_finish(&pool->mutex);
    pool->is_ready = false;
}

#ifdef SLC_HAVE_ASTC
static struct slc_astc_context *create_context(struct slc_astc_pool *pool, uint32_t extent,
                                               bool srgb, SluiceBakeQuality quality)
{
    static const enum slc_astc_quality qualities[] = {
        [SLUICE_BAKE_QUALITY_NORMAL] = SLC_ASTC_MEDIUM,
        [SLUICE_BAKE_QUALITY_FAST] = SLC_ASTC_FAST,
        [SLUICE_BAKE_QUALITY_BEST] = SLC_ASTC_THOROUGH,
    };
    struct slc_astc_context *context = slc_calloc(&pool->allocator, 1, sizeof *context);
    if (!context)
        return NULL;
    context->extent = extent;
    context->srgb = srgb;
    context->quality = quality;
    context->context = slc_astc_open(extent, srgb, qualities[quality]);
    if (context->context)
        return context;
    destroy_context(pool, context);
    return NULL;
}

static struct slc_astc_context *take_context(struct slc_astc_pool *pool, uint32_t extent, bool srgb,
                                             SluiceBakeQuality quality)
{
    slc_mutex_lock(&pool->mutex);
    struct slc_astc_context **at = &pool->idle;
    while (*at && ((*at)->extent != extent || (*at)->srgb != srgb || (*at)->quality != quality))
        at = &(*at)->next;
    struct slc_astc_context *found = *at;
    if (found)
        *at = found->next;
    slc_mutex_unlock(&pool->mutex);
    return found ? found : create_context(pool, extent, srgb, quality);
}

static void put_back(struct slc_astc_pool *pool, struct slc_astc_context *context)
{
    slc_mutex_lock(&pool->mutex);
    context->next = pool->idle;
    pool->idle = context;
    slc_mutex_unlock(&pool->mutex);
}

SluiceResult slc_astc_pool_encode(struct slc_astc_pool *pool, uint32_t extent, bool srgb,
                                  SluiceBakeQuality quality, const void *texels, size_t pitch,
                                  uint32_t width, uint32_t height, void *blocks)
{
    size_t row = 4 * (size_t)width;
    size_t size = (size_t)slc_div_up_u32(width, extent) * slc_div_up_u32(height, extent) * 16;
    uint8_t *rgba = slc_alloc(&pool->allocator, height, row);
    struct slc_astc_context *context = take_context(pool, extent, srgb, quality);
    bool is_done = rgba && context;
    for (uint32_t y = 0; y < height && is_done; y++)
        memcpy(rgba + y * row, (const char *)texels + y * pitch, row);
    is_done = is_done && slc_astc_compress(context->context, rgba, width, height, blocks, size);
    if (context)
        put_back(pool, context);
    slc_free(&pool->allocator, rgba, height, row);
    return is_done ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}
#else
SluiceResult slc_astc_pool_encode(struct slc_astc_pool *pool, uint32_t extent, bool srgb,
                                  SluiceBakeQuality quality, const void *texels, size_t pitch,
                                  uint32_t width, uint32_t height, void *blocks)
{
    (void)pool, (void)extent, (void)srgb, (void)quality, (void)texels, (void)pitch, (void)width;
    (void)height, (void)blocks;
    return SLUICE_ERROR_UNSUPPORTED;
}
#endif
