/**
 * Regions that the members of a read pool read once: regions being read, and texels kept for later
 * reads of other members.
 *
 * A region is found by the address of its source and its rectangle. Its first reader reads into
 * memory of the pool. Later readers wait for this read, or copy. Texels are kept up to a limit; the
 * least recently used ones are dropped first. Not synchronized: callers hold the pool's mutex.
 */
#ifndef SLC_IMAGE_SHARED_READS_H
#define SLC_IMAGE_SHARED_READS_H

#include <sluice/loader.h>

struct slc_read;

/** Texels of one region. */
struct slc_shared_region {
    unsigned char *texels;
    SluiceImageSource *source;
    SluiceImageRegion region;
    size_t size; ///< bytes of texels
    struct slc_shared_region *next_by_region, *next_by_source;
    struct slc_shared_region **link_by_source; ///< the pointer to this region
    struct slc_shared_region *older, *newer;   ///< neighbors while kept and not held
    struct slc_read *reader;                   ///< read that fills the region; NULL: kept
    struct slc_read *waiting;                  ///< reads that wait, linked by next_waiting
    uint32_t holder_count;                     ///< the reader, and reads that copy or will copy
    bool is_reading;
    bool is_listed; ///< can be found
};

struct slc_shared_reads {
    SluiceAllocationCallbacks cb;
    uint64_t limit; ///< most bytes that are kept
    uint32_t member_count;
    uint32_t bucket_count; ///< buckets per table; 0 or a power of two
    struct slc_shared_region **by_region, **by_source;
    uint64_t listed_count;
    struct slc_shared_region *oldest, *newest; ///< kept and not held
    uint64_t size;                             ///< bytes of all regions, including held ones
    uint64_t count;
    SluiceReadPoolStatistics statistics; ///< totals and the peak
};

enum slc_delivery {
    SLC_DELIVER_ALONE, ///< the caller reads as without a pool
    SLC_DELIVER_READ,  ///< the caller reads into the region's texels, then ends the region
    SLC_DELIVER_COPY,  ///< the caller copies, then releases the region
    SLC_DELIVER_WAIT   ///< another read is reading the region
};

void slc_shared_reads_init(struct slc_shared_reads *shares, const SluiceAllocationCallbacks *cb,
                           uint64_t limit);
/** Frees all regions. None may be held. */
void slc_shared_reads_finish(struct slc_shared_reads *shares);

/** Changes the number of members. The texels of a pool with less than two are dropped: see
 *  slc_shared_reads_drop. */
void slc_shared_reads_add_member(struct slc_shared_reads *shares);
void slc_shared_reads_remove_member(struct slc_shared_reads *shares,
                                    struct slc_shared_region **dropped);
/** True if there are members to share with. */
bool slc_shared_reads_are_on(const struct slc_shared_reads *shares);

/** Returns how `read` gets the texels of `at`, which have `size` bytes. `*region` is their region,
 *  except for SLC_DELIVER_ALONE. SLC_DELIVER_READ and SLC_DELIVER_COPY hold the region for the
 * read. A copy never gets SLC_DELIVER_READ: it must be queued again. */
enum slc_delivery slc_shared_reads_claim(struct slc_shared_reads *shares, struct slc_read *read,
                                         const SluiceImageRegion *at, size_t size,
                                         struct slc_shared_region **region);
/** Ends a SLC_DELIVER_READ; the caller still holds the region. Returns the reads that waited. They
 *  hold the region each if `read` is true. */
struct slc_read *slc_shared_reads_end(struct slc_shared_reads *shares,
                                      struct slc_shared_region *region, bool read);
/** Releases a region that the caller holds. */
void slc_shared_reads_release(struct slc_shared_reads *shares, struct slc_shared_region *region);

/** True if the region has this rectangle. */
bool slc_shared_region_is_at(const struct slc_shared_region *region, const SluiceImageRegion *at);
/** Returns the region if it is being read, or NULL. */
struct slc_shared_region *slc_shared_reads_find_reading(const struct slc_shared_reads *shares,
                                                        const SluiceImageSource *source,
                                                        const SluiceImageRegion *at);
/** True if the texels of the region can be copied. */
bool slc_shared_reads_keep(const struct slc_shared_reads *shares, const SluiceImageSource *source,
                           const SluiceImageRegion *at);
/** Adds a read to the waiting reads of a region that is being read, and removes it. */
void slc_shared_region_await(struct slc_shared_region *region, struct slc_read *read);
void slc_shared_region_leave(struct slc_shared_region *region, struct slc_read *read);

/** Hides the region from later reads. */
void slc_shared_reads_hide(struct slc_shared_reads *shares, struct slc_shared_region *region);
/** Hide all regions of the source, or of all sources, from later reads. Add regions that
 *  slc_shared_regions_free must free to `*dropped`. */
void slc_shared_reads_drop(struct slc_shared_reads *shares, const SluiceImageSource *source,
                           struct slc_shared_region **dropped);
void slc_shared_reads_drop_all(struct slc_shared_reads *shares, struct slc_shared_region **dropped);
/** Frees texels that were dropped. Takes long, so without the mutex. */
void slc_shared_regions_free(const SluiceAllocationCallbacks *cb,
                             struct slc_shared_region *dropped);

void slc_shared_reads_write_statistics(const struct slc_shared_reads *shares,
                                       SluiceReadPoolStatistics *statistics);

#endif /* SLC_IMAGE_SHARED_READS_H */
