/**
 * Regions that the members of a read pool read once: those that are being read, and texels that
 * are kept for members that ask later.
 *
 * A region is found by the address of its source and its rectangle. Its first reader reads into
 * memory of the pool. Later readers wait for this read, or copy. Texels are kept up to a limit, the
 * least recently used ones leave first. Not synchronized: the pool's mutex is around every call.
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
    struct slc_shared_region **link_by_source; ///< which points to it
    struct slc_shared_region *older, *newer;   ///< while kept and not held
    struct slc_read *reader;                   ///< whose source reads it; NULL: kept
    struct slc_read *waiting;                  ///< reads that wait for it, linked by next_waiting
    uint32_t holder_count;                     ///< its reader, and readers that copy or will copy
    bool is_reading;
    bool is_listed; ///< can be found
};

struct slc_shared_reads {
    SluiceAllocationCallbacks cb;
    uint64_t limit; ///< bytes that are kept
    uint32_t member_count;
    uint32_t bucket_count; ///< of each table; 0 or a power of two
    struct slc_shared_region **by_region, **by_source;
    uint64_t listed_count;
    struct slc_shared_region *oldest, *newest; ///< kept and not held
    uint64_t size;                             ///< bytes of all regions, also of those held
    uint64_t count;
    SluiceReadPoolStatistics statistics; ///< totals and the peak
};

enum slc_delivery {
    SLC_DELIVER_ALONE, ///< read it as if there were no pool
    SLC_DELIVER_READ,  ///< the caller reads it into the region's texels, and ends it
    SLC_DELIVER_COPY,  ///< the caller copies, and releases it
    SLC_DELIVER_WAIT   ///< somebody else reads it
};

void slc_shared_reads_init(struct slc_shared_reads *shares, const SluiceAllocationCallbacks *cb,
                           uint64_t limit);
/** Nothing is held. */
void slc_shared_reads_finish(struct slc_shared_reads *shares);

/** Changes the number of members. The texels of a pool with less than two are dropped: see
 *  slc_shared_reads_drop. */
void slc_shared_reads_add_member(struct slc_shared_reads *shares);
void slc_shared_reads_remove_member(struct slc_shared_reads *shares,
                                    struct slc_shared_region **dropped);
/** There is somebody to share with. */
bool slc_shared_reads_are_on(const struct slc_shared_reads *shares);

/** Returns how `read` gets the texels of `at`, which have `size` bytes. `*region` is theirs, but
 * for SLC_DELIVER_ALONE. SLC_DELIVER_READ and SLC_DELIVER_COPY hold the region for the read. A
 *  copy is never told to read: it is to be queued again. */
enum slc_delivery slc_shared_reads_claim(struct slc_shared_reads *shares, struct slc_read *read,
                                         const SluiceImageRegion *at, size_t size,
                                         struct slc_shared_region **region);
/** Ends a SLC_DELIVER_READ; the caller still holds the region. Returns the reads that waited. They
 *  hold the region each if `read` is true. */
struct slc_read *slc_shared_reads_end(struct slc_shared_reads *shares,
                                      struct slc_shared_region *region, bool read);
/** Lets a region go that the caller holds. */
void slc_shared_reads_release(struct slc_shared_reads *shares, struct slc_shared_region *region);

/** The region has this rectangle. */
bool slc_shared_region_is_at(const struct slc_shared_region *region, const SluiceImageRegion *at);
/** The region of the source if it is being read, or NULL. */
struct slc_shared_region *slc_shared_reads_find_reading(const struct slc_shared_reads *shares,
                                                        const SluiceImageSource *source,
                                                        const SluiceImageRegion *at);
/** The texels of the region can be copied. */
bool slc_shared_reads_keep(const struct slc_shared_reads *shares, const SluiceImageSource *source,
                           const SluiceImageRegion *at);
/** Puts a read on the list of a region that is being read; takes it off. */
void slc_shared_region_await(struct slc_shared_region *region, struct slc_read *read);
void slc_shared_region_leave(struct slc_shared_region *region, struct slc_read *read);

/** Later readers do not find the region. */
void slc_shared_reads_hide(struct slc_shared_reads *shares, struct slc_shared_region *region);
/** Later readers find no region of the source; of any source. Adds to `*dropped` what
 *  slc_shared_regions_free is to free. */
void slc_shared_reads_drop(struct slc_shared_reads *shares, const SluiceImageSource *source,
                           struct slc_shared_region **dropped);
void slc_shared_reads_drop_all(struct slc_shared_reads *shares, struct slc_shared_region **dropped);
/** Frees texels that were dropped. Takes long, so without the mutex. */
void slc_shared_regions_free(const SluiceAllocationCallbacks *cb,
                             struct slc_shared_region *dropped);

void slc_shared_reads_write_statistics(const struct slc_shared_reads *shares,
                                       SluiceReadPoolStatistics *statistics);

#endif /* SLC_IMAGE_SHARED_READS_H */
