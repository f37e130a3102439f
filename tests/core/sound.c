#include "core/sound.h"

#include "core/check.h"

void check_sound(const struct fixture *f, int line)
{
    const char *wrong = slc_manager_check(f->manager);
    if (wrong)
        fail_msg("line %d: %s", line, wrong);
    SluiceStreamedTextureStatistics s = fixture_statistics(f);
    uint64_t capacity = f->heaps.size / SLUICE_DEFAULT_TILE_SIZE; /* 0 before the first heap */
    uint64_t held = (uint64_t)s.allocatedTileCount + s.mappedTileCount + s.standbyTileCount +
                    s.canceledTileCount;
    if (held + s.retiringSlotCount + s.freeSlotCount != s.heapCount * capacity)
        fail_msg("line %d: %u held, %u retiring and %u free slots in %u heaps of %u", line,
                 (unsigned)held, (unsigned)s.retiringSlotCount, (unsigned)s.freeSlotCount,
                 (unsigned)s.heapCount, (unsigned)capacity);
    if (s.heapCount != f->heaps.living_count || s.hostMemorySize != f->memory.live_bytes)
        fail_msg("line %d: the statistics disagree about heaps or memory", line);
}

void sound_feed(struct fixture *f, SluiceTextureId id, uint8_t level, uint64_t time,
                uint64_t timeout)
{
    fixture_feed(f, id, level, time, timeout);
    CHECK_SOUND(f);
}

void sound_feed_region(struct fixture *f, SluiceTextureId id, uint32_t region, uint8_t level,
                       uint64_t time, uint64_t timeout)
{
    fixture_feed_region(f, id, region, level, time, timeout);
    CHECK_SOUND(f);
}

void sound_answer_mapped(struct fixture *f)
{
    for (uint32_t i = 0; i < f->count; i++)
        SOUND(f, sluiceUpdateTilesMapping(f->manager, f->tiles[i].textureId, 1,
                                          &f->tiles[i].tileIndex));
}

void sound_load(struct fixture *f)
{
    do {
        assert_true(fixture_to_map(f, SLUICE_ALL_TEXTURES) >= 0);
        CHECK_SOUND(f);
        uint32_t indices[FIXTURE_ROOM];
        for (uint32_t first = 0, end; first < f->count; first = end) {
            SluiceTextureId id = f->tiles[first].textureId;
            for (end = first; end < f->count && f->tiles[end].textureId == id; end++)
                indices[end - first] = f->tiles[end].tileIndex;
            SOUND(f, sluiceUpdateTilesMapping(f->manager, id, end - first, indices));
        }
    } while (f->count);
}
