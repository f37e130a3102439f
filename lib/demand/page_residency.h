/**
 * Page residency: the deterministic core of demand loading. Knows no device, no clock, no files and
 * no threads. Equal calls give equal answers.
 *
 * A page is absent, loading, resident or refused. Pages of one class compete for the same memory.
 * All tiles are one class, whatever their format, because each has 64 KiB. Each resource with a
 * limit of its own has a class. Each resident page has a place: an opaque word from the owner of
 * the memory.
 *
 * The protocol of a launch:
 *
 *     slc_residency_prepare(launch)          when the launch is recorded: returns its LOD bias
 *     slc_residency_take_changes             changes for its page table
 *     slc_residency_begin(launch)            when the launch is complete; numbers count from 1
 *     slc_residency_use                      for every resident page that the launch looked up
 *     slc_residency_request                  for every page that it missed, in the order of the
 * scan slc_residency_settle                   after the last request: decides budgets and bias
 *     slc_residency_loaded, _failed          whenever reads end
 *
 * Several launches may be prepared before the first of them begins here. Requests between settle
 * and begin are for pages that no launch asked for (preloading).
 *
 * Eviction order: oldest last use first, then finest rank, then lowest id. If no page of a kind can
 * be evicted, pages of other kinds are: one tile, or 32 pages of any other class. Never evicted:
 * pages that the launch used or requested, pinned pages, and pages that no complete launch could
 * have used. An evicted page can be restored to its place until the place is taken.
 *
 * Too many tiles: if the tiles that a launch used and missed exceed the limit, or memory runs out,
 * the LOD bias rises by as many quarters of a level as should suffice. Tiles without a place are
 * POSTPONED: the next launches request coarser pages. The bias falls again when two consecutive
 * launches, more after failures, show that a finer one fits. Failures are remembered, so that a
 * still view comes to rest, see lod_bias.h.
 *
 * Pages without a place are REFUSED, so that shaders use coarser pages: without a bias
 * (no_lod_bias, no_eviction), at the largest bias, and if pinned pages fill the class. Refused
 * pages become absent again, and may be requested, when a launch leaves more places idle than when
 * they were refused, and at least an eighth of all: half as many pages at a time as places are
 * idle. Pages of other classes are POSTPONED until a launch does not use resident ones.
 *
 * A bias is judged only by launches that had it. If the bias has changed, requests of earlier
 * launches that were not listed should not be repeated.
 *
 * Each use and request takes constant time on average, and a launch no other time, except sorting:
 * changes, and evictable pages once per launch that used them last. Memory: about 150 bytes per
 * page, for the most pages that were ever loading, resident, refused or changed at a time.
 * Externally synchronized.
 */
#ifndef SLC_DEMAND_PAGE_RESIDENCY_H
#define SLC_DEMAND_PAGE_RESIDENCY_H

#include <sluice/base.h>

struct slc_demand_residency;

#define SLC_NO_PLACE UINT32_MAX
#define SLC_NO_PAGE UINT32_MAX

/** Memory of a class. Its functions are called only from within the functions below. */
struct slc_page_memory {
    void *user;
    /** Takes a place for a page; SLC_NO_PLACE if there is none, even if the budget has room.
     * `kind`: the page's kind (format). Pages of different kinds may not be able to share places.
     */
    uint32_t (*take)(void *user, uint32_t kind);
    /** Frees a place. `page` may retake it until another page takes it. SLC_NO_PAGE: no page will.
     */
    void (*give)(void *user, uint32_t place, uint32_t page);
    /** Takes a place again, with its contents, and returns true if no page took it since `page`
     * gave it. */
    bool (*retake)(void *user, uint32_t place, uint32_t page);
};

enum slc_request_answer {
    SLC_REQUEST_LOAD,     ///< the caller must read the page, and report loaded or failed
    SLC_REQUEST_PENDING,  ///< being loaded; or forgotten, and the old read must end first
    SLC_REQUEST_RESIDENT, ///< resident, but the launch did not see the page yet
    SLC_REQUEST_RESTORED, ///< resident again, without a read
    SLC_REQUEST_REFUSED,  ///< refused; the page table shows that from the next launch on
    SLC_REQUEST_POSTPONED ///< no place now, but perhaps later
};

struct slc_page_residency_create_info {
    const SluiceAllocationCallbacks *cb; ///< NULL: malloc and free
    uint32_t class_count;                ///< 1 to 256; class 0: tiles
    bool no_eviction;                    ///< the bias stays 0, too
    bool no_lod_bias;
};

/** Creates a residency. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_residency_create(const struct slc_page_residency_create_info *info,
                                  struct slc_demand_residency **residency);
void slc_residency_destroy(struct slc_demand_residency *residency);

/** Sets limit and memory of a class. `limit`: most pages that are loading or resident; UINT64_MAX
 * at first. `memory` is copied; NULL: pages of the class have no places, only values. A lower limit
 *  evicts pages now and after the next launches. Other memory may be set only while no page of the
 *  class is loading or resident. Always succeeds. */
SluiceResult slc_residency_set_class(struct slc_demand_residency *residency, uint32_t class_index,
                                     uint64_t limit, const struct slc_page_memory *memory);

/** Changes settings of the create-info. Without a bias, the next prepared launch has bias 0. */
void slc_residency_set_switches(struct slc_demand_residency *residency, bool no_eviction,
                                bool no_lod_bias);

/** True if the page is absent, so that a request would need a place. */
bool slc_residency_is_absent(const struct slc_demand_residency *residency, uint32_t page);
/** True if the page is resident. `*place`: SLC_NO_PLACE if the page has none. */
bool slc_residency_is_resident(const struct slc_demand_residency *residency, uint32_t page,
                               uint32_t *place);
/** Returns an upper bound of the pages that slc_residency_visit visits. */
uint32_t slc_residency_known_count(const struct slc_demand_residency *residency);
/** Visits all pages that are loading, resident or refused, or were evicted and can be restored, in
 *  any order. The visitor may forget the page. */
void slc_residency_visit(const struct slc_demand_residency *residency,
                         void (*visit)(void *user, uint32_t page), void *user);
/** Returns the last use of the page of a class that is evicted next; UINT64_MAX if none can be. */
uint64_t slc_residency_oldest_use(const struct slc_demand_residency *residency,
                                  uint32_t class_index);

/** Begins the uses and requests of a complete launch. `launch` must be larger than before. */
void slc_residency_begin(struct slc_demand_residency *residency, uint64_t launch);
/** Notes a use of a page. Ignored if the page is not resident any more. */
void slc_residency_use(struct slc_demand_residency *residency, uint32_t page);

struct slc_page_request {
    uint32_t page;
    uint8_t class_index;
    uint8_t rank;   ///< low for coarse pages
    uint8_t pinned; ///< not 0: never evicted once resident (tails, opened textures)
    uint32_t kind;  ///< see slc_page_memory.take
};
/**
 * Requests a page. If necessary, evicts the least recently used pages that the launch did not use.
 * Errors, in `*result`, with nothing changed: OUT_OF_HOST_MEMORY; the answer is POSTPONED then.
 */
enum slc_request_answer slc_residency_request(struct slc_demand_residency *residency,
                                              const struct slc_page_request *request,
                                              SluiceResult *result);
/** Returns the place of a page that is loading. SLC_NO_PLACE if the page has none, is not loading,
 * or was forgotten meanwhile. */
uint32_t slc_residency_place(const struct slc_demand_residency *residency, uint32_t page);

/** Ends the requests of a launch, and decides about the LOD bias. `missing`: pages that the launch
 *  missed, listed or not. Pages that were not listed count as tiles. */
void slc_residency_settle(struct slc_demand_residency *residency, uint64_t missing);
/** Prepares a launch that is being recorded: it sees all changes that take_changes returns from now
 *  on. Returns its LOD bias. Required if several launches are in flight; by default the launch
 * after the last one begun sees the changes. */
float slc_residency_prepare(struct slc_demand_residency *residency, uint64_t launch);
/** Abandons prepared launches from `launch` on, which were not begun. The next prepared launch has
 *  this number, and sees their changes at the latest. */
void slc_residency_abandon(struct slc_demand_residency *residency, uint64_t launch);
/** Returns the LOD bias of launches prepared from now on: 0 to 24 levels, in quarters. */
float slc_residency_lod_bias(const struct slc_demand_residency *residency);

/** Makes a loading page resident. `value`: value in the page table, for pages without a place
 *  (resources). Other pages have their place there. */
void slc_residency_loaded(struct slc_demand_residency *residency, uint32_t page, uint64_t value);
/** Ends a load that failed. `refuse`: the page is refused until it is forgotten or retried;
 * otherwise it is absent again. */
void slc_residency_failed(struct slc_demand_residency *residency, uint32_t page, bool refuse);
/** Makes a refused page absent, so that it may be requested. Returns false if it is not refused. */
bool slc_residency_retry(struct slc_demand_residency *residency, uint32_t page);
/** Makes `count` pages absent, whatever their state. A loading page must still be reported as
 * loaded or failed, and is dropped then. Places are given back without the option to restore the
 * page: at once, or when the read ends. */
void slc_residency_forget(struct slc_demand_residency *residency, uint32_t first, uint64_t count);

enum slc_page_shown { SLC_SHOW_ABSENT, SLC_SHOW_RESIDENT, SLC_SHOW_REFUSED };
struct slc_page_change {
    uint32_t page;
    enum slc_page_shown shown;
    uint64_t value; ///< SLC_SHOW_RESIDENT
    uint8_t class_index;
};
/** Takes changes that the page table does not show yet: each page once, with its present state,
 *  ascending within a call, at most `capacity` per call. Returns how many. Pages whose state is as
 *  shown are left out. */
uint32_t slc_residency_take_changes(struct slc_demand_residency *residency,
                                    struct slc_page_change *changes, uint32_t capacity);

struct slc_page_evicted {
    uint32_t page;
    uint8_t class_index;
    uint64_t value;
};
/** Takes the values of pages without a place that were evicted or forgotten: each loaded value
 * once, in the order of eviction, at most `capacity` per call. Returns how many. If the changes
 * were taken before, launches prepared later see none of these values. */
uint32_t slc_residency_take_evicted(struct slc_demand_residency *residency,
                                    struct slc_page_evicted *evicted, uint32_t capacity);

struct slc_residency_counts {
    uint64_t resident, loading, refused; ///< current pages
    uint64_t evicted, restored;          ///< totals, without forgotten pages
};
void slc_residency_get_counts(const struct slc_demand_residency *residency, uint32_t class_index,
                              struct slc_residency_counts *counts);

/** Returns the pages other than tiles that were requested without memory since the last begin. */
uint64_t slc_residency_turned_away_count(const struct slc_demand_residency *residency);
/** Returns the tiles that are refused for lack of memory. */
uint64_t slc_residency_overflow_count(const struct slc_demand_residency *residency);

struct slc_placed_page {
    uint32_t page, place;
    bool stays;  ///< pinned, being loaded, or not seen by a complete launch yet
    bool in_use; ///< used by the last launch begun, if launches report use
};
/** Visits all pages of the class that have a place, in any order. Changes nothing. */
void slc_residency_visit_placed(const struct slc_demand_residency *residency, uint32_t class_index,
                                void (*visit)(void *user, const struct slc_placed_page *page),
                                void *user);

/** Checks all invariants, slowly. For tests. */
bool slc_residency_check(const struct slc_demand_residency *residency);

#endif /* SLC_DEMAND_PAGE_RESIDENCY_H */
