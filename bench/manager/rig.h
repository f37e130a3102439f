/** A manager whose heaps cost nothing and whose loads are over at once. */
#ifndef BENCH_RIG_H
#define BENCH_RIG_H

#include <sluice/manager.h>

#include <stdint.h>

/** Microseconds from one map of a texture to its next; a map counts for six of them. */
enum { STEP = 166667, TIMEOUT = 1000000 };

struct rig {
    SluiceStreamedTextureManager *manager;
    uint32_t next_heap_id;
    uint64_t time; ///< microseconds
    SluiceTile *tiles;
    uint32_t *indices;
    uint32_t room; ///< of tiles and indices
};

/** Ends the program with a message if a call failed. */
void must(SluiceResult result, const char *what);

void *must_allocate(size_t size);

/** `room`: tiles that rig_drain takes at a time. */
void rig_init(struct rig *rig, uint32_t heap_capacity,
              const SluiceStreamedTextureManagerConfig *config, uint32_t room);
void rig_finish(struct rig *rig);

/** Maps what is requested and unmaps what is listed until nothing is left. Returns tiles mapped. */
uint64_t rig_drain(struct rig *rig);

/** Answers rig->tiles[0 .. count) as mapped, one call per texture if they are grouped so. */
void rig_answer(struct rig *rig, uint32_t count);

/** Square texture, square tiles, every level that fills a tile regular. */
SluiceStreamedTextureDesc square_desc(uint32_t size, uint32_t tile);

SluiceTextureId rig_add(struct rig *rig, const SluiceStreamedTextureDesc *desc);

/** Advances the time by `step` and brings a map. */
void rig_feedback(struct rig *rig, SluiceTextureId id, const SluiceFeedbackDesc *feedback,
                  uint64_t step, uint64_t timeout);

SluiceStreamedTextureStatistics rig_statistics(const struct rig *rig);

/** Regions of one map. */
uint32_t region_count(const SluiceStreamedTextureDesc *desc);

/** A map of the size that the texture has. */
SluiceFeedbackDesc map_for(const SluiceStreamedTextureDesc *desc, const uint8_t *map);

#endif /* BENCH_RIG_H */
