/** A manager whose heaps cost nothing and whose loads complete at once. */
#ifndef BENCH_RIG_H
#define BENCH_RIG_H

#include <sluice/manager.h>

#include <stdint.h>

/** Microseconds between maps of a texture. A timeout spans six maps. */
enum { STEP = 166667, TIMEOUT = 1000000 };

struct rig {
    SluiceStreamedTextureManager *manager;
    uint32_t next_heap_id;
    uint64_t time; ///< microseconds
    SluiceTile *tiles;
    uint32_t *indices;
    uint32_t room; ///< length of `tiles` and `indices`
};

/** Exits with a message if a call failed. */
void must(SluiceResult result, const char *what);

void *must_allocate(size_t size);

/** `room`: most tiles per step of rig_drain. */
void rig_init(struct rig *rig, uint32_t heap_capacity,
              const SluiceStreamedTextureManagerConfig *config, uint32_t room);
void rig_finish(struct rig *rig);

/** Maps requested tiles and unmaps listed ones until nothing is left. Returns the number of mapped
 * tiles. */
uint64_t rig_drain(struct rig *rig);

/** Answers rig->tiles[0 .. count) as mapped, one call per run of equal textures. */
void rig_answer(struct rig *rig, uint32_t count);

/** Describes a square texture with square tiles. Every level that fills a tile is regular. */
SluiceStreamedTextureDesc square_desc(uint32_t size, uint32_t tile);

SluiceTextureId rig_add(struct rig *rig, const SluiceStreamedTextureDesc *desc);

/** Advances the time by `step`, and feeds a map. */
void rig_feedback(struct rig *rig, SluiceTextureId id, const SluiceFeedbackDesc *feedback,
                  uint64_t step, uint64_t timeout);

SluiceStreamedTextureStatistics rig_statistics(const struct rig *rig);

/** Returns the number of regions in a map. */
uint32_t region_count(const SluiceStreamedTextureDesc *desc);

/** Describes a map of the texture's size. */
SluiceFeedbackDesc map_for(const SluiceStreamedTextureDesc *desc, const uint8_t *map);

#endif /* BENCH_RIG_H */
