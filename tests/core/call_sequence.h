/** Makes random sequences of calls: mostly valid ones, and some with every kind of mistake. */
#ifndef TESTS_CORE_CALL_SEQUENCE_H
#define TESTS_CORE_CALL_SEQUENCE_H

#include "core/choice.h"
#include "core/naive_manager.h"

struct call_sequence {
    struct choice choice;
    /* Character of this sequence. */
    uint32_t capacity;
    bool always_packed;
    uint32_t weights[CALL_KIND_COUNT];
    uint32_t mistakes;  ///< one call in this many has a mistake; 0: none
    uint32_t starving;  ///< one call in this many gets too little memory; 0: none
    uint32_t refusing;  ///< the heap allocator refuses one time in this many; 0: never
    uint32_t max_tiles; ///< limit for most textures
    uint32_t max_textures;
    uint32_t visibility; ///< number of 16 visible regions that a map samples
    uint32_t wandering;  ///< the camera moves once in this many calls
    uint32_t favoring;   ///< number of 4 maps that belong to one texture, until the camera moves
    uint64_t camera, favorite;
    bool sets;        ///< true: most textures have one shape and follow the first one
    bool configured;  ///< true: config is called first
    bool small_rooms; ///< true: most lists are read in small pieces
    uint64_t time, timeout;
    uint64_t time_spent; ///< sum of all steps of time, refused ones included
    uint32_t next_heap;
    uint32_t last_map_size;
    uint8_t last_map[CALL_MAX_MAP];
};

void call_sequence_start(struct call_sequence *s, struct choice choice);
void call_sequence_next(struct call_sequence *s, struct naive_manager *n, struct call *call);
/** Returns the heap allocator's next answer. `living`: ids of the living heaps. */
struct heap_answer call_sequence_heap_answer(struct call_sequence *s, const uint32_t *living,
                                             uint32_t living_count);

/* Shared by the generator's files. */
void call_sequence_desc(struct call_sequence *s, SluiceStreamedTextureDesc *desc);
void call_sequence_bad_desc(struct call_sequence *s, SluiceStreamedTextureDesc *desc);
void call_sequence_map(struct call_sequence *s, const SluiceStreamedTextureLayout *layout,
                       struct call *call);

#endif /* TESTS_CORE_CALL_SEQUENCE_H */
