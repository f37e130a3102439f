/** The calls of page_residency.h and the answers of slc_page_memory, one by one. */
#ifndef SLC_DEMAND_PAGE_CALLS_H
#define SLC_DEMAND_PAGE_CALLS_H

#include "demand/page_residency.h"

enum slc_page_call_kind {
    /* Calls of a class's memory, within slc_residency_request; `give` within other calls, too. */
    SLC_PAGE_CALL_TAKE = 1,
    SLC_PAGE_CALL_RETAKE,
    SLC_PAGE_CALL_GIVE,
    /* Calls of the residency. */
    SLC_PAGE_CALL_SET_CLASS,
    SLC_PAGE_CALL_BEGIN,
    SLC_PAGE_CALL_USE,
    SLC_PAGE_CALL_REQUEST,
    SLC_PAGE_CALL_SETTLE,
    SLC_PAGE_CALL_PREPARE,
    SLC_PAGE_CALL_ABANDON,
    SLC_PAGE_CALL_LOADED,
    SLC_PAGE_CALL_FAILED,
    SLC_PAGE_CALL_RETRY,
    SLC_PAGE_CALL_FORGET,
    SLC_PAGE_CALL_TAKE_CHANGES,
    SLC_PAGE_CALL_TAKE_EVICTED,
    SLC_PAGE_CALL_SET_SWITCHES,
    SLC_PAGE_CALL_KINDS
};

/** Fields that the kind does not have are 0. */
struct slc_page_call {
    enum slc_page_call_kind kind;
    uint8_t class_index; ///< SET_CLASS
    bool flag;           ///< SET_CLASS: has memory; FAILED: refuse; SET_SWITCHES: no eviction
    bool answer;         ///< RETAKE, RETRY; SET_SWITCHES: no LOD bias
    uint32_t page;       ///< calls for one page; FORGET: first page
    uint32_t page_kind;  ///< TAKE
    uint32_t place;      ///< TAKE, RETAKE, GIVE
    uint64_t launch;     ///< BEGIN, PREPARE, ABANDON
    uint64_t value;      ///< SET_CLASS: limit; SETTLE: missing; LOADED: value
    uint64_t count;      ///< FORGET; TAKE_...: entries
    uint32_t capacity;   ///< TAKE_...
    struct slc_page_request request; ///< REQUEST
    SluiceResult result;             ///< REQUEST
    enum slc_request_answer request_answer;
    float bias; ///< PREPARE
    const struct slc_page_change *changes;
    const struct slc_page_evicted *evicted;
};

struct slc_page_observer {
    void *user;
    /** Called after a call was made, or after the memory has answered. */
    void (*notify)(void *user, const struct slc_page_call *call);
};

#endif /* SLC_DEMAND_PAGE_CALLS_H */
