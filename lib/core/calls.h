/** A call of the manager, with what went in and what came out. */
#ifndef SLC_CORE_CALLS_H
#define SLC_CORE_CALLS_H

#include <sluice/manager.h>

/** One per public call that changes a manager, and one per answer of the heap allocator. */
enum slc_call_kind {
    SLC_CALL_SET_CONFIG = 1,
    SLC_CALL_ADD_TEXTURE = 2,
    SLC_CALL_REMOVE_TEXTURE = 3,
    SLC_CALL_UPDATE_FEEDBACK = 4,
    SLC_CALL_MATCH_PRIMARY = 5,
    SLC_CALL_SET_PRIMARY = 6,
    SLC_CALL_GET_TILES_TO_MAP = 7,
    SLC_CALL_UPDATE_MAPPING = 8,
    SLC_CALL_REPORT_FAILED = 9,
    SLC_CALL_RETRY_FAILED = 10,
    SLC_CALL_GET_GIVEN_UP = 11,
    SLC_CALL_GET_TILES_TO_CANCEL = 12,
    SLC_CALL_REPORT_CANCELED = 13,
    SLC_CALL_GET_TILES_TO_UNMAP = 14,
    SLC_CALL_COMPLETE_RETIRE = 15,
    SLC_CALL_TRIM_STANDBY = 16,
    SLC_CALL_DEFRAGMENT = 17,
    SLC_CALL_RELEASE_HEAP = 18,
    SLC_CALL_GET_MINMIP_UPDATES = 19,
    /** During GET_TILES_TO_MAP, before that call itself is reported. */
    SLC_CALL_HEAP_ANSWER = 20,
    SLC_CALL_EVACUATE_HEAPS = 21,
    SLC_CALL_FORGET_TEXTURE = 22,
    SLC_CALL_EVICT_TEXTURE = 23,
    SLC_CALL_SET_UV = 24,
    SLC_CALL_SET_PRIORITY = 25
};

/**
 * Inputs and outputs of a call. Only the fields of its kind are set. Pointers are valid during the
 * notification. A call refused for a NULL pointer or an unknown texture is reported, too: its
 * pointers may be NULL.
 */
struct slc_call {
    enum slc_call_kind kind;
    SluiceResult result;
    SluiceTextureId texture_id; ///< also the follower of MATCH_PRIMARY and SET_PRIMARY
    SluiceTextureId primary_id; ///< MATCH_PRIMARY, SET_PRIMARY
    uint64_t time_stamp;        ///< UPDATE_FEEDBACK, MATCH_PRIMARY, REPORT_FAILED
    uint64_t timeout;           ///< UPDATE_FEEDBACK, MATCH_PRIMARY
    uint64_t retire_value;      ///< calls with a retire value
    const SluiceStreamedTextureManagerConfig *config; ///< SET_CONFIG
    const SluiceStreamedTextureDesc *desc;            ///< ADD_TEXTURE
    const SluiceFeedbackDesc *feedback;               ///< UPDATE_FEEDBACK
    const SluiceUvTransform *uv;                      ///< SET_UV
    int32_t priority;                                 ///< SET_PRIORITY
    uint32_t keep_count; ///< TRIM_STANDBY, EVICT_TEXTURE; EVACUATE_HEAPS: the most tiles
    uint32_t heap_id;    ///< RELEASE_HEAP, HEAP_ANSWER
    uint32_t room;       ///< list calls: *pCount on entry
    bool query;          ///< list calls: the array was NULL
    uint32_t count;      ///< list calls: *pCount on return; answers: number of tile_indices
    const uint32_t *tile_indices;  ///< UPDATE_MAPPING, REPORT_FAILED, REPORT_CANCELED
    const SluiceTile *tiles;       ///< out: GET_TILES_TO_*, GET_GIVEN_UP
    const SluiceTileMove *moves;   ///< out: DEFRAGMENT
    const SluiceMinMipRect *rects; ///< out: GET_MINMIP_UPDATES
};

struct slc_observer {
    void *user;
    void (*notify)(void *user, const SluiceStreamedTextureManager *manager,
                   const struct slc_call *call);
};

#endif /* SLC_CORE_CALLS_H */
