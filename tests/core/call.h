/** A call of sluice/manager.h as data, and its outcome. */
#ifndef TESTS_CORE_CALL_H
#define TESTS_CORE_CALL_H

#include <sluice/manager.h>

#include <stdio.h>

enum call_kind {
    CALL_SET_CONFIG,
    CALL_ADD_TEXTURE,
    CALL_REMOVE_TEXTURE,
    CALL_FEEDBACK,
    CALL_MATCH_PRIMARY,
    CALL_SET_PRIMARY,
    CALL_TILES_TO_MAP,
    CALL_MAPPED,
    CALL_FAILED,
    CALL_CANCELED,
    CALL_RETRY,
    CALL_GIVEN_UP,
    CALL_TILES_TO_CANCEL,
    CALL_TILES_TO_UNMAP,
    CALL_COMPLETE,
    CALL_TRIM,
    CALL_DEFRAGMENT,
    CALL_EMPTY_HEAPS,
    CALL_RELEASE_HEAP,
    CALL_MINMIP_UPDATES,
    CALL_WRITE_MINMIP,
    CALL_WRITE_RECT,
    CALL_TILE_STATE,
    CALL_LAYOUT,
    CALL_TEXTURE_LAYOUT,
    CALL_STATISTICS,
    CALL_EVACUATE, ///< made from a CALL_TRIM, so that sequences in files keep their meaning
    CALL_FORGET,   ///< made from a CALL_TRIM, too
    CALL_EVICT,    ///< made from a CALL_TRIM, too
    CALL_KIND_COUNT
};

/** The pointer of a call that is NULL. `second`: the array of a list call, which makes it a
 * query. */
enum call_null { NULL_NONE, NULL_MANAGER, NULL_FIRST, NULL_SECOND };

/** Length of the arrays in calls, and limit of heap answers per call. */
#define CALL_MAX_ROOM 4096u
#define CALL_MAX_INDICES 4096u
#define CALL_MAX_MAP 4096u

/** A call. Only the fields that its kind uses are set. */
struct call {
    enum call_kind kind;
    enum call_null null;
    SluiceTextureId texture; ///< SET_PRIMARY and MATCH_PRIMARY: the follower
    SluiceTextureId primary;
    uint64_t time, timeout, retire;
    SluiceStreamedTextureManagerConfig config;
    SluiceStreamedTextureDesc desc;
    uint32_t map_width, map_height;
    int32_t bias;
    uint32_t streamed_levels;
    bool null_map;
    uint32_t room;  ///< list calls and DEFRAGMENT
    uint32_t count; ///< number of indices
    uint32_t keep, heap, tile;
    SluiceMinMipRect rect;
    size_t pitch, size;
    /** Number of allocations in this call that succeed; UINT64_MAX: all. */
    uint64_t refuse_after;
    /* Kept between calls. */
    uint8_t map[CALL_MAX_MAP];
    uint32_t indices[CALL_MAX_INDICES];
};

struct heap_answer {
    SluiceResult result;
    uint32_t id;
};

struct outcome {
    SluiceResult result;
    bool memory_refused;     ///< true: an allocation failed, even if the call succeeded
    SluiceTextureId texture; ///< ADD_TEXTURE
    uint32_t count;          ///< list calls
    SluiceTile tiles[CALL_MAX_ROOM];
    SluiceTileMove moves[CALL_MAX_ROOM];
    SluiceMinMipRect rects[CALL_MAX_ROOM];
    uint32_t heaps[CALL_MAX_ROOM];
    uint8_t bytes[CALL_MAX_MAP]; ///< WRITE_MINMIP, WRITE_RECT
    SluiceTileState state;       ///< TILE_STATE, with tiles[0]
    SluiceStreamedTextureLayout layout;
    SluiceStreamedTextureStatistics statistics;
    uint32_t answer_count; ///< answers of the heap allocator, in order
    struct heap_answer answers[CALL_MAX_ROOM];
};

/** Makes the call and writes its outcome, except for the heap allocator's answers. */
void call_make(SluiceStreamedTextureManager *manager, const struct call *call, struct outcome *out);
/** Returns whether the call takes an array and a count in and out. */
bool call_is_list(enum call_kind kind);
const char *call_kind_name(enum call_kind kind);
/** Prints one line. Feedback maps follow row by row. */
void call_print(FILE *file, const struct call *call);

#endif /* TESTS_CORE_CALL_H */
