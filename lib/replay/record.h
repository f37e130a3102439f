/** Conversion of a call to and from bytes of a "SLUICERT" trace. docs/replay.md lists the fields.
 */
#ifndef SLC_REPLAY_RECORD_H
#define SLC_REPLAY_RECORD_H

#include "core/observer.h"
#include "replay/byte_buffer.h"

#define SLC_TRACE_MAGIC "SLUICERT"
#define SLC_TRACE_VERSION 1u
/** The calls follow a snapshot. */
#define SLC_TRACE_VERSION_SNAPSHOT 2u
#define SLC_TRACE_FLAG_PACKED 1u

/** Presence of an input that the caller gives by pointer. */
enum slc_input {
    SLC_INPUT_NULL = 0,   ///< the pointer was NULL
    SLC_INPUT_ABSENT = 1, ///< not recorded: the call was refused before reading it
    SLC_INPUT_PRESENT = 2
};

/** Fields of a record, in this order. */
enum slc_field {
    SLC_FIELD_TEXTURE = 1,
    SLC_FIELD_PRIMARY = 2,
    SLC_FIELD_TIME = 4,
    SLC_FIELD_TIMEOUT = 8,
    SLC_FIELD_RETIRE = 16,
    SLC_FIELD_KEEP = 32,
    SLC_FIELD_HEAP = 64,
    SLC_FIELD_CONFIG = 128,
    SLC_FIELD_DESC = 256, ///< description of a texture, and the new id
    SLC_FIELD_FEEDBACK = 512,
    SLC_FIELD_INDICES = 1024,
    SLC_FIELD_LIST = 2048,
    SLC_FIELD_UV = 4096,
    SLC_FIELD_PRIORITY = 8192
};

/** Returns the fields of a kind of call; 0: unknown kind. */
uint32_t slc_call_fields(uint32_t kind);

/** Recorded call with all inputs for a replay. */
struct slc_record {
    struct slc_call call;    ///< with the recorded result and count
    uint64_t hash;           ///< list calls: hash of all decisions up to and including this call
    enum slc_input contents; ///< presence of the feedback map or tile indices
    SluiceStreamedTextureManagerConfig config;
    SluiceStreamedTextureDesc desc;
    SluiceFeedbackDesc feedback;
    SluiceUvTransform uv;
    /** Encoded map or tile indices, in the trace. */
    struct slc_cursor encoded;
};

/** Appends the last call. `hash` covers all decisions including this call's. */
void slc_put_record(struct slc_bytes *bytes, const struct slc_call *call, uint64_t hash);

/**
 * Reads one call. Pointers of the call point into `record`. Array pointers are NULL: use
 * slc_get_runs and slc_get_tile_indices to decode arrays.
 */
void slc_get_record(struct slc_cursor *cursor, struct slc_record *record);

/** Decodes call.count indices. slc_get_record has checked them. */
void slc_get_tile_indices(struct slc_record *record, uint32_t *indices);

#endif /* SLC_REPLAY_RECORD_H */
