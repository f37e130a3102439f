/** One call of demand loading as bytes of a "SLUICEDR" recording, and back; and its decisions. */
#ifndef SLC_REPLAY_DEMAND_RECORD_H
#define SLC_REPLAY_DEMAND_RECORD_H

#include "demand/page_calls.h"
#include "replay/byte_buffer.h"

#define SLC_DEMAND_TRACE_MAGIC "SLUICEDR"
#define SLC_DEMAND_TRACE_VERSION 1u
/** The calls follow a snapshot. */
#define SLC_DEMAND_TRACE_VERSION_SNAPSHOT 2u
#define SLC_DEMAND_FLAG_NO_EVICTION 1u
#define SLC_DEMAND_FLAG_NO_LOD_BIAS 2u
#define SLC_DEMAND_FLAGS 3u
/** Kinds of pages are image formats. Each has a list of its own, so a recording may not name many.
 */
#define SLC_DEMAND_PAGE_KINDS 256u

struct slc_demand_record {
    struct slc_page_call call; ///< without lists
    uint64_t hash;             ///< if the kind has it: over all decisions up to this call
};

/** An answer of memory stands before the slc_residency_request that asked for it. */
bool slc_page_call_is_answer(enum slc_page_call_kind kind);
/** Whether records of this kind have the hash of all decisions. */
bool slc_page_call_has_hash(enum slc_page_call_kind kind);

/**
 * Appends a call; GIVE is none: it follows from the others. `last_page` is kept from call to call,
 * 0 at first.
 */
void slc_put_demand_record(struct slc_bytes *out, const struct slc_page_call *call, uint64_t hash,
                           uint32_t *last_page);
void slc_get_demand_record(struct slc_cursor *in, struct slc_demand_record *record,
                           uint32_t *last_page);

/** Goes on with `hash` over what came out of a call. */
uint64_t slc_hash_page_call(uint64_t hash, const struct slc_page_call *call);

#endif /* SLC_REPLAY_DEMAND_RECORD_H */
