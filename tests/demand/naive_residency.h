/** The rules of residency.h, with arrays and linear scans. Does not choose the LOD bias. */
#ifndef TESTS_DEMAND_NAIVE_RESIDENCY_H
#define TESTS_DEMAND_NAIVE_RESIDENCY_H

#include "demand/fake_memory.h"

enum { NAIVE_PAGES = 48, NAIVE_CLASSES = 3, NAIVE_VALUES = 1 << 16 };

enum naive_state { NAIVE_ABSENT, NAIVE_LOADING, NAIVE_RESIDENT, NAIVE_REFUSED };

struct naive_page {
    uint32_t id, place, kind;
    enum naive_state state;
    enum slc_page_shown shown;
    uint8_t class_index, rank;
    bool pinned, dropped, restorable;
    bool waiting; ///< resident, but not visible to launches yet
    uint64_t visible_from, last_use, value, shown_value;
    uint64_t overflow; ///< time when it was refused for lack of memory; else 0
};

struct naive_residency {
    bool no_eviction, no_lod_bias, blurriest;
    struct naive_page pages[NAIVE_PAGES]; ///< in the order of ids
    uint64_t limits[NAIVE_CLASSES], launch, prepared, touched, refusals, refused_idle;
    bool refused;
    struct slc_page_memory memories[NAIVE_CLASSES];
    struct slc_residency_counts counts[NAIVE_CLASSES];
    struct slc_page_evicted evicted[NAIVE_VALUES];
    uint32_t evicted_begin, evicted_end;
};

void naive_begin(struct naive_residency *n, uint64_t launch);
void naive_use(struct naive_residency *n, uint32_t page);
enum slc_request_answer naive_request(struct naive_residency *n, uint32_t page,
                                      const struct slc_page_request *request);
void naive_settle(struct naive_residency *n);
void naive_loaded(struct naive_residency *n, uint32_t page, uint64_t value);
void naive_failed(struct naive_residency *n, uint32_t page, bool refuse);
void naive_forget(struct naive_residency *n, uint32_t page);
void naive_set_limit(struct naive_residency *n, uint32_t class_index, uint64_t limit);
uint32_t naive_take_changes(struct naive_residency *n, struct slc_page_change *changes,
                            uint32_t capacity);

#endif /* TESTS_DEMAND_NAIVE_RESIDENCY_H */
