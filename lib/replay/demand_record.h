/** Conversion of a demand-loading call to and from bytes of a "SLUICEDR" recording; its hash. */
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
/** Limit for kinds of pages in a recording. A kind is an image format and has its own list. */
#define SLC_DEMAND_PAGE_KINDS 256u

struct slc_demand_record {
    struct slc_page_call call; ///< without lists
    uint64_t hash;             ///< hash of all decisions up to this call, for kinds with hash
};

/** Tells whether a call is an answer of memory. Answers precede their slc_residency_request. */
bool slc_page_call_is_answer(enum slc_page_call_kind kind);
/** Tells whether records of this kind have the hash of all decisions. */
bool slc_page_call_has_hash(enum slc_page_call_kind kind);

/**
 * Appends a call. GIVE is not recorded, because it follows from the other calls. `last_page` is
 * kept between calls and starts at 0.
 */
void slc_put_demand_record(struct slc_bytes *out, const struct slc_page_call *call, uint64_t hash,
                           uint32_t *last_page);
void slc_get_demand_record(struct slc_cursor *in, struct slc_demand_record *record,
                           uint32_t *last_page);

/** Extends `hash` by the outputs of a call. */
uint64_t slc_hash_page_call(uint64_t hash, const struct slc_page_call *call);

#endif /* SLC_REPLAY_DEMAND_RECORD_H */
