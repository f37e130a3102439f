/** One call as bytes of a "SLUICERT" trace, and back. docs/replay.md lists every field. */
#ifndef SLC_REPLAY_RECORD_H
#define SLC_REPLAY_RECORD_H

#include "core/observer.h"
#include "replay/byte_buffer.h"

#define SLC_TRACE_MAGIC "SLUICERT"
#define SLC_TRACE_VERSION 1u
/** The calls follow a snapshot. */
#define SLC_TRACE_VERSION_SNAPSHOT 2u
#define SLC_TRACE_FLAG_PACKED 1u

/** What is written of an input that the caller gives by pointer. */
enum slc_input {
    SLC_INPUT_NULL = 0,   ///< the pointer was NULL
    SLC_INPUT_ABSENT = 1, ///< the call was refused before it could matter, and it is not kept
    SLC_INPUT_PRESENT = 2
};

/** What a record of some kind holds, in this order. */
enum slc_field {
    SLC_FIELD_TEXTURE = 1,
    SLC_FIELD_PRIMARY = 2,
    SLC_FIELD_TIME = 4,
    SLC_FIELD_TIMEOUT = 8,
    SLC_FIELD_RETIRE = 16,
    SLC_FIELD_KEEP = 32,
    SLC_FIELD_HEAP = 64,
    SLC_FIELD_CONFIG = 128,
    SLC_FIELD_DESC = 256, ///< and the id it got
    SLC_FIELD_FEEDBACK = 512,
    SLC_FIELD_INDICES = 1024,
    SLC_FIELD_LIST = 2048,
    SLC_FIELD_UV = 4096,
    SLC_FIELD_PRIORITY = 8192
};

/** The fields of a kind of call; 0 if there is no such kind. */
uint32_t slc_call_fields(uint32_t kind);

/** A call with everything that it takes to make it again. */
struct slc_record {
    struct slc_call call;    ///< result and count as recorded
    uint64_t hash;           ///< list calls: over all decisions up to and with this one
    enum slc_input contents; ///< of the feedback map, or of the tile indices
    SluiceStreamedTextureManagerConfig config;
    SluiceStreamedTextureDesc desc;
    SluiceFeedbackDesc feedback;
    SluiceUvTransform uv;
    /** Encoded map or tile indices, in the trace. */
    struct slc_cursor encoded;
};

/** Appends a call that was just made; `hash` is over all decisions so far, this call's included. */
void slc_put_record(struct slc_bytes *bytes, const struct slc_call *call, uint64_t hash);

/**
 * Reads one call. Its pointers point into `record` or, for arrays, are NULL: slc_get_runs and
 * slc_get_tile_indices decode them.
 */
void slc_get_record(struct slc_cursor *cursor, struct slc_record *record);

/** Decodes call.count indices, which were checked by slc_get_record. */
void slc_get_tile_indices(struct slc_record *record, uint32_t *indices);

#endif /* SLC_REPLAY_RECORD_H */
