#include "device/resolve_oracle.h"

#include "vulkan/feedback_map.h"

#include <string.h>

static struct SluiceResolveResult measure(const struct oracle_item *item)
{
    const struct oracle_texture *t = item->texture;
    struct SluiceResolveResult result = {.state = SLUICE_RESOLVED_CHANGES};
    for (uint32_t i = 0; i < t->count; i++) {
        result.count += t->written[i] != t->reported[i];
        result.checksum += slc_resolve_weight(i) * (255u - t->written[i]);
    }
    uint32_t map_size = (t->count + 3) / 4;
    if (result.count > map_size || item->flags & SLUICE_RESOLVE_WHOLE) {
        result.state = SLUICE_RESOLVED_MAP;
        result.count = map_size;
    }
    return result;
}

static uint32_t write_map(const struct oracle_texture *t, uint32_t *data)
{
    uint32_t count = (t->count + 3) / 4;
    memset(data, 0xFF, count * 4);
    for (uint32_t i = 0; i < t->count; i++)
        data[i / 4] ^= (255u ^ t->written[i]) << 8 * (i % 4);
    return count;
}

static uint32_t write_changes(const struct oracle_texture *t, uint32_t *data)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < t->count; i++)
        if (t->written[i] != t->reported[i])
            data[count++] = i << 8 | t->written[i];
    return count;
}

uint32_t oracle_resolve(const struct oracle_item *items, uint32_t item_count, uint32_t capacity,
                        struct SluiceResolveResult *results, uint32_t *data)
{
    uint32_t at = 0, written = 0; /* they part where the room ends */
    for (uint32_t i = 0; i < item_count; i++) {
        const struct oracle_texture *t = items[i].texture;
        results[i] = measure(&items[i]);
        at += results[i].count;
        if (results[i].count && at > capacity) {
            results[i] = (struct SluiceResolveResult){.state = SLUICE_RESOLVED_NOTHING};
            continue;
        }
        if (results[i].count)
            results[i].offset = written;
        written += results[i].state == SLUICE_RESOLVED_MAP ? write_map(t, data + written)
                                                           : write_changes(t, data + written);
        memcpy(t->reported, t->written, t->count);
        memset(t->written, SLUICE_MIP_UNTOUCHED, t->count);
    }
    return written;
}
