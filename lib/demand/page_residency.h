/**
 * Which pages are resident: the deterministic core of demand loading. Knows no device, no clock, no
 * files and no threads; the same calls give the same answers.
 *
 * A page is absent (nothing is kept of it), loading, resident or refused. Pages belong to classes:
 * those of a class compete for the same memory (tiles: one class for all formats, because each is
 * 64 KiB; each resource with a limit of its own has its class). Each resident page has a place that
 * the owner of the memory gave: an opaque word.
 *
 * The protocol of a launch:
 *
 *     slc_residency_prepare(launch)          it is recorded, and has this LOD bias,
 *     slc_residency_take_changes             and its page table shows this
 *     slc_residency_begin(launch)            it is over; launches are numbered from 1
 *     slc_residency_use                      every resident page that the launch looked up
 *     slc_residency_request                  every page that it missed, in the order of the scan
 *     slc_residency_settle                   that was all: budgets and bias
 *     slc_residency_loaded, _failed          whenever reads are over
 *
 * Several launches may be prepared before the first of them begins here. Requests between settle
 * and begin are for pages that no launch asked for (preloading).
 *
 * What goes first: pages whose last use is oldest, of these the finest rank, of these the lowest
 * id. Where no page of a kind can go, pages of other kinds do: one tile, or 32 pages of any other
 * class. Never: pages that the launch used or asked for, pinned ones, and those that no launch that
 * is over could have used. An evicted page keeps its place in mind, and has it back if nobody took
 * it.
 *
 * Tiles that need more places than there are. If what a launch used and missed exceeds the
 * limit, or there is no memory for it, the LOD bias rises by as many quarters of a level as
 * should do, and what has no place is POSTPONED: the next launches ask for coarser pages. It
 * falls again when two launches in a row, more after failures, show that a finer one fits, and
 * what did not fit is remembered: a view that does not change comes to rest, see lod_bias.h.
 * Without a bias (no_lod_bias, no_eviction), at the largest one, and where pinned pages alone fill
 * the class, pages that have no place are REFUSED, so that shaders take coarser ones. They are
 * absent again, and may be asked for, when a launch leaves more places idle than when they were
 * refused, an eighth of all at least; half as many at a time as there are such places. Pages of
 * other classes are POSTPONED until a launch does not use those that are there.
 *
 * A bias only tells of the launches that had it: what of their requests was not listed should not
 * be asked for again when it has changed.
 *
 * Each use and request takes constant time on average, and a launch none beyond these; changes are
 * sorted, and pages that may be evicted once for each launch that used them last. Memory follows
 * the most pages that were ever loading, resident, refused or changed at a time, about 150 bytes
 * each. Externally synchronized.
 */
#ifndef SLC_DEMAND_PAGE_RESIDENCY_H
#define SLC_DEMAND_PAGE_RESIDENCY_H

#include <sluice/base.h>

struct slc_demand_residency;

#define SLC_NO_PLACE UINT32_MAX
#define SLC_NO_PAGE UINT32_MAX

/** The memory of a class. All functions are called from within the calls below. */
struct slc_page_memory {
    void *user;
    /** A place for a page; SLC_NO_PLACE if there is none, even though the budget has room. `kind`
     * is the page's (its format): pages that differ in it may not get each other's places. */
    uint32_t (*take)(void *user, uint32_t kind);
    /** The place is free; `page` may ask for it again until it is taken by another. SLC_NO_PAGE:
     *  nobody will. */
    void (*give)(void *user, uint32_t place, uint32_t page);
    /** True: nobody has taken the place since `page` gave it, and now it has it again, with all
     * that was in it. */
    bool (*retake)(void *user, uint32_t place, uint32_t page);
};

enum slc_request_answer {
    SLC_REQUEST_LOAD,     ///< the caller reads it, and says loaded or failed
    SLC_REQUEST_PENDING,  ///< is being loaded; or was forgotten, and that read must end first
    SLC_REQUEST_RESIDENT, ///< is there: the launch did not see it yet
    SLC_REQUEST_RESTORED, ///< is there again, without a read
    SLC_REQUEST_REFUSED,  ///< will not be there: the page table says so from the next launch on
    SLC_REQUEST_POSTPONED ///< no place now, but perhaps later
};

struct slc_page_residency_create_info {
    const SluiceAllocationCallbacks *cb; ///< NULL: malloc and free
    uint32_t class_count;                ///< 1 to 256; class 0 is that of tiles
    bool no_eviction;                    ///< the bias stays 0, too
    bool no_lod_bias;
};

/** Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_residency_create(const struct slc_page_residency_create_info *info,
                                  struct slc_demand_residency **residency);
void slc_residency_destroy(struct slc_demand_residency *residency);

/** `limit`: pages that may be loading or resident at once; UINT64_MAX at first. `memory` is copied;
 *  NULL: pages of the class have no places, only values. May be called again with another limit,
 * which evicts what it can now and the rest after launches; and with other memory while none is
 * held. Always succeeds. */
SluiceResult slc_residency_set_class(struct slc_demand_residency *residency, uint32_t class_index,
                                     uint64_t limit, const struct slc_page_memory *memory);

/** As at creation. A bias that is switched off is 0 from the next launch that is prepared. */
void slc_residency_set_switches(struct slc_demand_residency *residency, bool no_eviction,
                                bool no_lod_bias);

/** Whether a request for the page would need a place. */
bool slc_residency_is_absent(const struct slc_demand_residency *residency, uint32_t page);
/** True if the page is resident. `*place`: SLC_NO_PLACE if it has none. */
bool slc_residency_is_resident(const struct slc_demand_residency *residency, uint32_t page,
                               uint32_t *place);
/** Upper bound of the pages that slc_residency_visit visits. */
uint32_t slc_residency_known_count(const struct slc_demand_residency *residency);
/** Visits all pages that are loading, resident or refused, or were evicted and can be restored, in
 *  any order. The visitor may forget the page. */
void slc_residency_visit(const struct slc_demand_residency *residency,
                         void (*visit)(void *user, uint32_t page), void *user);
/** The last use of the page of the class that would be evicted first; UINT64_MAX if none can be. */
uint64_t slc_residency_oldest_use(const struct slc_demand_residency *residency,
                                  uint32_t class_index);

/** `launch` is larger than before. */
void slc_residency_begin(struct slc_demand_residency *residency, uint64_t launch);
/** Of a page that is not resident any more: ignored. */
void slc_residency_use(struct slc_demand_residency *residency, uint32_t page);

struct slc_page_request {
    uint32_t page;
    uint8_t class_index;
    uint8_t rank;   ///< coarse ones are low
    uint8_t pinned; ///< once resident it is never evicted: tails, opened textures. Not 0: yes
    uint32_t kind;  ///< see slc_page_memory.take
};
/**
 * Evicts, if it must, pages that the launch did not use and that were used longest ago. Errors, in
 * `*result`, with nothing changed: OUT_OF_HOST_MEMORY; the answer is POSTPONED then.
 */
enum slc_request_answer slc_residency_request(struct slc_demand_residency *residency,
                                              const struct slc_page_request *request,
                                              SluiceResult *result);
/** The place of a page that is loading: where its texels go. SLC_NO_PLACE if it has none, is not
 *  loading, or was forgotten meanwhile. */
uint32_t slc_residency_place(const struct slc_demand_residency *residency, uint32_t page);

/** `missing`: pages that the launch asked for, listed or not; those that were not requested count
 * as tiles. Decides about the LOD bias. */
void slc_residency_settle(struct slc_demand_residency *residency, uint64_t missing);
/** The launch that is recorded now sees what take_changes gives from here on, and has the LOD bias
 *  that is returned: which launch knows what, where several are in flight. Left out: the launch
 * after the last one begun does. */
float slc_residency_prepare(struct slc_demand_residency *residency, uint64_t launch);
/** Launches from this one on, which were not begun here, will never be: the next one that is
 * prepared has this number. What they were to see is seen by it at the latest. */
void slc_residency_abandon(struct slc_demand_residency *residency, uint64_t launch);
/** Of launches prepared from now on: 0 to 24, in quarters. */
float slc_residency_lod_bias(const struct slc_demand_residency *residency);

/** Of a page that is loading. `value`: what the page table shows, for pages without a place
 *  (resources); for others it is the place. */
void slc_residency_loaded(struct slc_demand_residency *residency, uint32_t page, uint64_t value);
/** `refuse`: not to be asked for again until it is forgotten or retried; else it is absent again.
 */
void slc_residency_failed(struct slc_demand_residency *residency, uint32_t page, bool refuse);
/** A refused page is absent again: it may be asked for. Returns false if it is not refused. */
bool slc_residency_retry(struct slc_demand_residency *residency, uint32_t page);
/** Absent from now on, whatever it was; a page that is loading still gets its loaded or failed, and
 *  is dropped then. Its place is given back, not to be retaken: at once, or when the read is over.
 */
void slc_residency_forget(struct slc_demand_residency *residency, uint32_t first, uint64_t count);

enum slc_page_shown { SLC_SHOW_ABSENT, SLC_SHOW_RESIDENT, SLC_SHOW_REFUSED };
struct slc_page_change {
    uint32_t page;
    enum slc_page_shown shown;
    uint64_t value; ///< SLC_SHOW_RESIDENT
    uint8_t class_index;
};
/** What the page table does not show yet: each page once, with what it is now, ascending within a
 *  call; in pieces of `capacity`. Returns how many. A page that is what it was is left out. */
uint32_t slc_residency_take_changes(struct slc_demand_residency *residency,
                                    struct slc_page_change *changes, uint32_t capacity);

struct slc_page_evicted {
    uint32_t page;
    uint8_t class_index;
    uint64_t value;
};
/** Values of pages without a place that went, be it by eviction or because they were forgotten:
 * each value that was loaded is told once, in the order in which they went; in pieces of
 * `capacity`. Returns how many. What takes the changes first, and then these, knows that launches
 * prepared later see none of them. */
uint32_t slc_residency_take_evicted(struct slc_demand_residency *residency,
                                    struct slc_page_evicted *evicted, uint32_t capacity);

struct slc_residency_counts {
    uint64_t resident, loading, refused; ///< now
    uint64_t evicted, restored;          ///< ever; forgotten ones do not count
};
void slc_residency_get_counts(const struct slc_demand_residency *residency, uint32_t class_index,
                              struct slc_residency_counts *counts);

/** Pages that are no tiles and that were requested and found no memory since the last begin. */
uint64_t slc_residency_turned_away_count(const struct slc_demand_residency *residency);
/** Tiles that are refused because they found no memory. */
uint64_t slc_residency_overflow_count(const struct slc_demand_residency *residency);

struct slc_placed_page {
    uint32_t page, place;
    bool stays;  ///< pinned, being loaded, or not seen by any launch that is over
    bool in_use; ///< used by the last launch begun, if launches report use
};
/** Visits all pages of the class that have a place, in any order. Changes nothing. */
void slc_residency_visit_placed(const struct slc_demand_residency *residency, uint32_t class_index,
                                void (*visit)(void *user, const struct slc_placed_page *page),
                                void *user);

/** Every invariant, slowly. For tests. */
bool slc_residency_check(const struct slc_demand_residency *residency);

#endif /* SLC_DEMAND_PAGE_RESIDENCY_H */
