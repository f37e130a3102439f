#include "base/struct_size.h"
#include "core/lookup.h"
#include "core/observer.h"
#include "core/refusal.h"
#include "core/state.h"

SluiceResult sluiceGetStatistics(const SluiceStreamedTextureManager *manager,
                                 SluiceStreamedTextureStatistics *pStatistics)
{
    if (!manager || !pStatistics)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_struct_check(SLC_STRUCT(SluiceStreamedTextureStatistics), pStatistics,
                                           &manager->info.log);
    if (result != SLUICE_SUCCESS)
        return result;
    const slc_manager *m = manager;
    SluiceStreamedTextureStatistics statistics = {
        .structSize = sizeof statistics,
        .textureCount = m->texture_count,
        .tileCount = m->tile_count,
        .requestedTileCount = m->residency.state_counts[SLUICE_TILE_STATE_REQUESTED],
        .allocatedTileCount = m->residency.state_counts[SLUICE_TILE_STATE_ALLOCATED],
        .mappedTileCount = m->residency.state_counts[SLUICE_TILE_STATE_MAPPED],
        .standbyTileCount = m->residency.state_counts[SLUICE_TILE_STATE_STANDBY],
        .canceledTileCount = m->residency.state_counts[SLUICE_TILE_STATE_CANCELED],
        .failedTileCount = m->residency.state_counts[SLUICE_TILE_STATE_FAILED],
        .givenUpTileCount = m->residency.state_counts[SLUICE_TILE_STATE_GIVEN_UP],
        .retiringSlotCount = m->residency.retiring.count,
        .heapCount = m->residency.heaps.live_count,
        .freeSlotCount = m->residency.heaps.free_total < UINT32_MAX
                             ? (uint32_t)m->residency.heaps.free_total
                             : UINT32_MAX,
        .reservedSlotCount = slc_tile_heaps_reserved(&m->residency.heaps),
        .globalMipBias = m->bias.value,
        .handedOutTotal = m->handed_out_total,
        .mappedTotal = m->mapped_total,
        .unmappedTotal = m->unmapped_total,
        .canceledTotal = m->canceled_total,
        .failedTotal = m->failed_total,
        .restoredTotal = m->residency.restored_total,
        .movedTotal = m->moved_total,
        .givenUpRetriedTotal = m->given_up_retried_total,
        .hostMemorySize = m->host_memory_size,
    };
    slc_struct_write(SLC_STRUCT(SluiceStreamedTextureStatistics), pStatistics, &statistics);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceGetTextureStatistics(const SluiceStreamedTextureManager *manager,
                                        SluiceTextureId textureId,
                                        SluiceTextureStatistics *pStatistics)
{
    if (!manager || !pStatistics)
        return SLUICE_ERROR_NULL_POINTER;
    const struct slc_struct *type = SLC_STRUCT(SluiceTextureStatistics);
    struct slc_managed_texture *t;
    SluiceResult result = slc_struct_check(type, pStatistics, &manager->info.log);
    if (result == SLUICE_SUCCESS)
        result = slc_find_texture(manager, textureId, &t);
    if (result != SLUICE_SUCCESS)
        return result;
    bool packed_wanted = manager->info.alwaysMapPackedTiles || t->held_regions > 0;
    uint32_t packed = t->shape->desc.packedTileCount, inside = !t->shape->desc.packedTilesOutside;
    uint32_t wanted_packed = packed_wanted ? packed : 0;
    const SluiceTextureStatistics statistics = {
        .structSize = sizeof statistics,
        .residentTileCount = t->resident_tiles + t->packed_resident,
        .requestedTileCount = t->requested_count,
        .mappedTotal = t->mapped_total,
        .unmappedTotal = t->unmapped_total,
        .failedTotal = t->failed_total,
        .wanted = t->held_regions > 0,
        .seen = t->seen,
        .seenTime = t->seen_time,
        .wantedTileCount = t->wanted_tiles + wanted_packed,
        .residentSize =
            ((uint64_t)t->resident_tiles + inside * t->packed_resident) * manager->info.tileSize,
        .wantedSize = ((uint64_t)t->wanted_tiles + inside * wanted_packed) * manager->info.tileSize,
    };
    slc_struct_write(type, pStatistics, &statistics);
    return SLUICE_SUCCESS;
}

static SluiceTextureLevelStatistics
level_statistics(const slc_manager *m, const struct slc_managed_texture *t, uint32_t level)
{
    const SluiceStreamedTextureDesc *d = &t->shape->desc;
    SluiceTextureLevelStatistics s = {.structSize = sizeof s};
    uint64_t size = m->info.tileSize;
    if (level == d->regularMipCount) {
        s.tileCount = d->packedTileCount;
        s.residentTileCount = t->packed_resident;
        s.wantedTileCount =
            m->info.alwaysMapPackedTiles || t->held_regions > 0 ? d->packedTileCount : 0;
        size = d->packedTilesOutside ? 0 : size;
    } else {
        s.tileCount = t->shape->levels[level].width * t->shape->levels[level].height;
        s.residentTileCount = t->nodes ? *slc_resident_in_level(t, level) : 0;
        s.wantedTileCount = t->nodes ? *slc_wanted_in_level(t, level) : 0;
    }
    s.residentSize = s.residentTileCount * size;
    s.wantedSize = s.wantedTileCount * size;
    return s;
}

SluiceResult sluiceGetTextureLevelStatistics(const SluiceStreamedTextureManager *manager,
                                             SluiceTextureId textureId, uint32_t level,
                                             SluiceTextureLevelStatistics *pStatistics)
{
    if (!manager || !pStatistics)
        return SLUICE_ERROR_NULL_POINTER;
    const struct slc_struct *type = SLC_STRUCT(SluiceTextureLevelStatistics);
    struct slc_managed_texture *t;
    SluiceResult result = slc_struct_check(type, pStatistics, &manager->info.log);
    if (result == SLUICE_SUCCESS)
        result = slc_find_texture(manager, textureId, &t);
    if (result != SLUICE_SUCCESS)
        return result;
    if (level > t->shape->desc.regularMipCount)
        return slc_refuse(manager, "sluiceGetTextureLevelStatistics",
                          "level is %u; regular levels end at %u, which stands for packed levels",
                          level, t->shape->desc.regularMipCount);
    const SluiceTextureLevelStatistics statistics = level_statistics(manager, t, level);
    slc_struct_write(type, pStatistics, &statistics);
    return SLUICE_SUCCESS;
}

SluiceStreamedTextureStatistics
slc_manager_slot_statistics(const SluiceStreamedTextureManager *manager)
{
    const struct slc_machine *r = &manager->residency;
    SluiceStreamedTextureStatistics s = {.structSize = sizeof s};
    sluiceGetStatistics(manager, &s);
    s.requestedTileCount = slc_count_with_slots(r, SLUICE_TILE_STATE_REQUESTED);
    s.allocatedTileCount = slc_count_with_slots(r, SLUICE_TILE_STATE_ALLOCATED);
    s.mappedTileCount = slc_count_with_slots(r, SLUICE_TILE_STATE_MAPPED);
    s.standbyTileCount = slc_count_with_slots(r, SLUICE_TILE_STATE_STANDBY);
    s.canceledTileCount = slc_count_with_slots(r, SLUICE_TILE_STATE_CANCELED);
    s.failedTileCount = slc_count_with_slots(r, SLUICE_TILE_STATE_FAILED);
    s.givenUpTileCount = slc_count_with_slots(r, SLUICE_TILE_STATE_GIVEN_UP);
    return s;
}
