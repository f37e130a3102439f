/**
 * Table of the sources that a loader reads, by address. Its size is fixed: new sources replace
 * those without reads, longest idle first. Shared tables find each other's records of a source. Not
 * synchronized.
 */
#ifndef SLC_IMAGE_READ_SOURCES_H
#define SLC_IMAGE_READ_SOURCES_H

#include "image/pairing_heap.h"
#include "image/read_statistics.h"

struct slc_read_source {
    SluiceImageSource *source;               ///< NULL: free
    struct slc_read_source *previous, *next; ///< ring of sources without reads
    struct slc_read_sources *sources;        ///< table of the record
    struct slc_read_source *twin;            ///< ring of the source's records in shared tables
    uint32_t read_count;                     ///< reads that are not collected
    uint32_t running_count;
    struct slc_heap_node node;      ///< in the queue's `startable`
    struct slc_pairing_heap queued; ///< queued reads, the most urgent first
    SluiceFormat format;            ///< UNDEFINED until a read knows it
    struct slc_read_statistics statistics;
};

struct slc_read_sources {
    uint32_t count;
    bool has_recycled;             ///< some source was forgotten to make room
    struct slc_read_sources *peer; ///< ring of tables that are shared
    struct slc_read_source *records;
    struct slc_read_source idle; ///< head of the ring of sources without reads, longest idle first
    uint32_t place_count;        ///< a power of two
    struct slc_read_source **places; ///< by address; NULL: free
};

/** Makes a table, which must not be moved. `count` > 0. Errors: OUT_OF_HOST_MEMORY; nothing to
 * finish then. */
SluiceResult slc_read_sources_init(struct slc_read_sources *sources,
                                   const SluiceAllocationCallbacks *cb, uint32_t count);
void slc_read_sources_finish(struct slc_read_sources *sources, const SluiceAllocationCallbacks *cb);

/** Shares tables: records of a source in both tables, and in tables shared with `peer`, become
 * twins. `sources` must be empty. */
void slc_read_sources_share(struct slc_read_sources *sources, struct slc_read_sources *peer);

/** Finds the record of a source. NULL if there is none. */
struct slc_read_source *slc_read_sources_find(const struct slc_read_sources *sources,
                                              const SluiceImageSource *source);

/** Adds a read to the record of a source. Makes a record, zeroed except for the source, if there is
 *  none. At least one record must be without reads. */
struct slc_read_source *slc_read_sources_add_read(struct slc_read_sources *sources,
                                                  SluiceImageSource *source);

/** Removes a read that was collected. */
void slc_read_sources_remove_read(struct slc_read_sources *sources, struct slc_read_source *source);

/** Forgets a source without reads. */
void slc_read_sources_forget(struct slc_read_sources *sources, struct slc_read_source *source);

#endif /* SLC_IMAGE_READ_SOURCES_H */
