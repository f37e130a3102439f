/**
 * Proxy set: states of indices, and a slot per index. Independent of device, clock and files.
 *
 * An index is live, removed (launches may still report the index), free (used before), or new.
 * Slots lie in chunks: growth moves no slots and wastes little memory.
 */
#ifndef SLC_PROXY_PROXY_SET_H
#define SLC_PROXY_PROXY_SET_H

#include "proxy/bit_tree.h"

#include <sluice/proxy.h>

#define SLC_PROXY_CHUNK 1024u /* slots */
#define SLC_PROXY_GROUP 64u   /* boxes per unit of writing */
#define SLC_NO_INDEX UINT32_MAX

/** Slot of a proxy. A launch's 64 bits are two words, to avoid padding. */
struct slc_proxy {
    uint32_t generation;
    union {
        SluiceProxyBox box; ///< live, geometry
        struct {
            float min[3];       ///< corner of its former box
            uint32_t next;      ///< next removed index; SLC_NO_INDEX: end of list
            uint32_t launch[2]; ///< last launch that may report the index: low, high; set later
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
    uint32_t index_count; ///< number of indices ever used
    struct slc_bit_tree live, requested, free;
    /** List of removed indices, oldest first. From first_fresh on, `launch` is not set yet. */
    uint32_t first_removed, last_removed, first_fresh, removed_count;
    uint64_t version;  ///< version of the last change of a box
    uint64_t *changed; ///< owned; [groups]: version of the last change
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

/** Finds the index of an id. Errors: UNKNOWN_TEXTURE, STALE_TEXTURE. */
SluiceResult slc_proxy_find(const SluiceProxySet *set, SluiceProxyId id, uint32_t *index);

/** Frees removed indices whose last launch is at most `processed`. Sets the last launch of proxies
 *  removed since the last call to `begun`. */
void slc_proxy_release(SluiceProxySet *set, uint64_t begun, uint64_t processed);

/** Refuses a set of materials. Errors: INVALID_ARGUMENT, logged with the name of the function. */
SluiceResult slc_proxy_require_boxes(const SluiceProxySet *set, const char *function);

#endif /* SLC_PROXY_PROXY_SET_H */
