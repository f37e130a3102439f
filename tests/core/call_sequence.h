/** Makes up sequences of calls: mostly sensible ones, some with every kind of mistake. */
#ifndef TESTS_CORE_CALL_SEQUENCE_H
#define TESTS_CORE_CALL_SEQUENCE_H

#include "core/choice.h"
#include "core/naive_manager.h"

struct call_sequence {
    struct choice choice;
    /* The character of this sequence. */
    uint32_t capacity;
    bool always_packed;
    uint32_t weights[CALL_KIND_COUNT];
    uint32_t mistakes;  ///< one call in so many is wrong; 0: none
    uint32_t starving;  ///< one call in so many gets too little memory; 0: none
    uint32_t refusing;  ///< the heap allocator refuses one time in so many; 0: never
    uint32_t max_tiles; ///< of most textures
    uint32_t max_textures;
    uint32_t visibility; ///< of 16 regions in view so many are sampled in a map
    uint32_t wandering;  ///< the camera moves on once in so many calls
    uint32_t favoring;   ///< so many in 4 maps are of one texture, until the camera moves on
    uint64_t camera, favorite;
    bool sets;        ///< most textures have one shape and follow the first one
    bool configured;  ///< config comes first
    bool small_rooms; ///< lists are mostly read in small pieces
    uint64_t time, timeout;
    uint64_t time_spent; ///< how far time went on, or might have
    uint32_t next_heap;
    uint32_t last_map_size;
    uint8_t last_map[CALL_MAX_MAP];
};

void call_sequence_start(struct call_sequence *s, struct choice choice);
void call_sequence_next(struct call_sequence *s, struct naive_manager *n, struct call *call);
/** What the heap allocator says next; `living` are the heaps that there are. */
struct heap_answer call_sequence_heap_answer(struct call_sequence *s, const uint32_t *living,
                                             uint32_t living_count);

/* Between the files of the generator. */
void call_sequence_desc(struct call_sequence *s, SluiceStreamedTextureDesc *desc);
void call_sequence_bad_desc(struct call_sequence *s, SluiceStreamedTextureDesc *desc);
void call_sequence_map(struct call_sequence *s, const SluiceStreamedTextureLayout *layout,
                       struct call *call);

#endif /* TESTS_CORE_CALL_SEQUENCE_H */
