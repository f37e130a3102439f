/**
 * The sources that a loader has been given reads of, found by their address: a fixed number, of
 * which those without reads give way to new ones, the one longest without first. Tables that are
 * shared find each other's records of a source. Not synchronized.
 */
#ifndef SLC_IMAGE_READ_SOURCES_H
#define SLC_IMAGE_READ_SOURCES_H

#include "image/pairing_heap.h"
#include "image/read_statistics.h"

struct slc_read_source {
    SluiceImageSource *source;               ///< NULL: free
    struct slc_read_source *previous, *next; ///< among those without reads
    struct slc_read_sources *sources;        ///< the table that it is in
    struct slc_read_source *twin;            ///< ring of the source's records in shared tables
    uint32_t read_count;                     ///< not collected
    uint32_t running_count;
    struct slc_heap_node node;      ///< among the sources that could start a read
    struct slc_pairing_heap queued; ///< its reads, the most urgent first
    SluiceFormat format;            ///< UNDEFINED until a read has found out
    struct slc_read_statistics statistics;
};

struct slc_read_sources {
    uint32_t count;
    bool has_recycled;             ///< some source was forgotten to make room
    struct slc_read_sources *peer; ///< ring of tables that are shared
    struct slc_read_source *records;
    struct slc_read_source idle; ///< head of a ring of those without reads, the oldest next to it
    uint32_t place_count;        ///< a power of two
    struct slc_read_source **places; ///< by address; NULL: free
};

/** `count` > 0. Errors: OUT_OF_HOST_MEMORY; nothing to finish then. Must not be moved afterwards.
 */
SluiceResult slc_read_sources_init(struct slc_read_sources *sources,
                                   const SluiceAllocationCallbacks *cb, uint32_t count);
void slc_read_sources_finish(struct slc_read_sources *sources, const SluiceAllocationCallbacks *cb);

/** Records of a source in both tables, and in those that `peer` is shared with, become twins. Both
 *  tables stay where they are; `sources` is still empty. */
void slc_read_sources_share(struct slc_read_sources *sources, struct slc_read_sources *peer);

/** NULL if it is not known. */
struct slc_read_source *slc_read_sources_find(const struct slc_read_sources *sources,
                                              const SluiceImageSource *source);

/** The one that is known, or a new one, zeroed but for its source, with a read more. Fewer sources
 *  than there is room for may have reads. */
struct slc_read_source *slc_read_sources_add_read(struct slc_read_sources *sources,
                                                  SluiceImageSource *source);

/** A read of it was collected. */
void slc_read_sources_remove_read(struct slc_read_sources *sources, struct slc_read_source *source);

/** It must have no reads. */
void slc_read_sources_forget(struct slc_read_sources *sources, struct slc_read_source *source);

#endif /* SLC_IMAGE_READ_SOURCES_H */
