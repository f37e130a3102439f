/**
 * A set of proxies: which indices are live, and what is kept of each. Knows no device, no clock and
 * no files.
 *
 * An index is live, removed (launches may still name it), free (it was used before) or new. Slots
 * lie in chunks, so that growing moves none and wastes little.
 */
#ifndef SLC_PROXY_PROXY_SET_H
#define SLC_PROXY_PROXY_SET_H

#include "proxy/bit_tree.h"

#include <sluice/proxy.h>

#define SLC_PROXY_CHUNK 1024u /* slots */
#define SLC_PROXY_GROUP 64u   /* boxes that are written together */
#define SLC_NO_INDEX UINT32_MAX

/** The 64 bits of a launch are two words: a slot has no padding. */
struct slc_proxy {
    uint32_t generation;
    union {
        SluiceProxyBox box; ///< live, geometry
        struct {
            float min[3];       ///< of its box
            uint32_t next;      ///< removed later; SLC_NO_INDEX: none
            uint32_t launch[2]; ///< the last that may name it: low, high; once it is noted
        } removed;
    } is;
};

struct SluiceProxySet {
    SluiceAllocationCallbacks cb;
    SluiceLogCallback log;
    SluiceProxyKind kind;
    uint32_t max_count;
    struct slc_proxy **chunks; ///< owned
    uint32_t chunk_count, chunk_capacity;
    uint32_t index_count; ///< indices that were ever used
    struct slc_bit_tree live, requested, free;
    /** Removed indices, oldest first. Those from first_fresh on wait for a launch to be noted. */
    uint32_t first_removed, last_removed, first_fresh, removed_count;
    uint64_t version;  ///< of the last change of a box
    uint64_t *changed; ///< owned; by group: the version of its last change
    uint32_t group_capacity;
};

static inline struct slc_proxy *slc_proxy_at(const SluiceProxySet *set, uint32_t index)
{
    return &set->chunks[index / SLC_PROXY_CHUNK][index % SLC_PROXY_CHUNK];
}

static inline SluiceProxyId slc_proxy_id(const SluiceProxySet *set, uint32_t index)
{
    return (uint64_t)slc_proxy_at(set, index)->generation << 32 | index;
}

/** Errors: UNKNOWN_TEXTURE, STALE_TEXTURE. */
SluiceResult slc_proxy_find(const SluiceProxySet *set, SluiceProxyId id, uint32_t *index);

/** Frees the indices of proxies that were removed before launches up to `processed` ended. Proxies
 *  removed since the last call may be named by launches up to `begun`. */
void slc_proxy_release(SluiceProxySet *set, uint64_t begun, uint64_t processed);

/** Refuses a set of materials. Errors: INVALID_ARGUMENT, logged with the name of the function. */
SluiceResult slc_proxy_require_boxes(const SluiceProxySet *set, const char *function);

#endif /* SLC_PROXY_PROXY_SET_H */
