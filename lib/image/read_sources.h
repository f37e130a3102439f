/** The sources that a loader has been given reads of, found by their address. Not synchronised. */
#ifndef SLC_IMAGE_READ_SOURCES_H
#define SLC_IMAGE_READ_SOURCES_H

#include "image/pairing_heap.h"
#include "image/read_statistics.h"

struct slc_read_source {
    SluiceImageSource *source;
    struct slc_heap_node node;      ///< among the sources that could start a read
    struct slc_pairing_heap queued; ///< its reads, the most urgent first
    uint32_t uncollected_count, running_count;
    SluiceFormat format; ///< UNDEFINED until a read has found out
    struct slc_read_statistics statistics;
};

struct slc_read_sources {
    uint32_t place_count; ///< a power of two, or 0
    uint32_t count;
    struct slc_read_source **places; ///< NULL: free
};

void slc_read_sources_finish(struct slc_read_sources *sources, const SluiceAllocationCallbacks *cb);

/** NULL if it is not known. */
struct slc_read_source *slc_read_sources_find(const struct slc_read_sources *sources,
                                              const SluiceImageSource *source);

/** The one that is known, or a new one, zeroed but for its source; NULL: out of memory. */
struct slc_read_source *slc_read_sources_get(struct slc_read_sources *sources,
                                             const SluiceAllocationCallbacks *cb,
                                             SluiceImageSource *source);

/** Frees it. */
void slc_read_sources_remove(struct slc_read_sources *sources, const SluiceAllocationCallbacks *cb,
                             struct slc_read_source *source);

#endif /* SLC_IMAGE_READ_SOURCES_H */
