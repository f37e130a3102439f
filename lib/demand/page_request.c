#include "demand/page_changes.h"
#include "demand/page_eviction.h"
#include "demand/page_lru.h"
#include "demand/page_release.h"
#include "demand/page_settle.h"

#include <assert.h>

#define MOST_OTHERS 32u /* most pages of other kinds that are evicted for one page */

/* Notes that the launch needs a resident page: it is not evicted before the next launch. */
static void touch(struct slc_demand_residency *r, uint32_t index)
{
    struct slc_page_node *node = slc_node(r, index);
    if (node->touched == r->launch)
        return;
    node->touched = r->launch;
    node->last_use = r->launch;
    if (node->class_index == SLC_TILES && !node->pinned)
        r->use.touched++;
    if (node->home == SLC_HOME_LRU) {
        slc_residency_leave_home(r, index);
        slc_residency_enter_lru(r, index, r->launch);
    }
}

static void use(struct slc_demand_residency *residency, uint32_t page)
{
    uint32_t index = slc_page_nodes_find(&residency->nodes, page);
    if (index == SLC_NO_NODE || slc_node(residency, index)->state != SLC_PAGE_RESIDENT)
        return;
    const struct slc_page_node *node = slc_node(residency, index);
    if (node->touched != residency->launch && node->class_index == SLC_TILES) {
        residency->use.used += !node->pinned;
        residency->use.used_pinned += node->pinned;
    }
    touch(residency, index);
}

void slc_residency_use(struct slc_demand_residency *residency, uint32_t page)
{
    if (residency->observer.notify)
        slc_tell_use(residency, page);
    use(residency, page);
}

/* Pins a page that was requested without `pinned` before. */
static void pin(struct slc_demand_residency *r, uint32_t index)
{
    struct slc_page_node *node = slc_node(r, index);
    if (node->pinned || node->dropped)
        return;
    slc_residency_leave_home(r, index);
    node->pinned = true;
    slc_class_of(r, index)->pinned++;
}

static enum slc_request_answer answer_known(struct slc_demand_residency *r, uint32_t index,
                                            const struct slc_page_request *request)
{
    const struct slc_page_node *node = slc_node(r, index);
    if (node->state == SLC_PAGE_REFUSED)
        return SLC_REQUEST_REFUSED;
    if (request->class_index == SLC_TILES && !request->pinned)
        r->use.asked++;
    if (request->pinned)
        pin(r, index);
    if (node->state == SLC_PAGE_LOADING)
        return SLC_REQUEST_PENDING;
    touch(r, index);
    return SLC_REQUEST_RESIDENT;
}

static bool make_room(struct slc_demand_residency *r, uint32_t class_index)
{
    const struct slc_page_class *c = &r->classes[class_index];
    while (c->held >= c->limit)
        if (!slc_residency_evict(r, class_index, SLC_NO_LRU))
            return false;
    return true;
}

static uint32_t take(struct slc_demand_residency *r, const struct slc_page_memory *memory,
                     uint32_t kind)
{
    uint32_t place = memory->take(memory->user, kind);
    SLC_TELL_PAGES(r, .kind = SLC_PAGE_CALL_TAKE, .page_kind = kind, .place = place);
    return place;
}

static bool retake(struct slc_demand_residency *r, const struct slc_page_memory *memory,
                   uint32_t place, uint32_t page)
{
    bool answer = memory->retake(memory->user, place, page);
    SLC_TELL_PAGES(r, .kind = SLC_PAGE_CALL_RETAKE, .place = place, .page = page, .answer = answer);
    return answer;
}

/* Evicts pages of other kinds until their memory can be used. That may take several byte pages: a
 * slab changes its kind as a whole. */
static bool evict_others(struct slc_demand_residency *r, uint32_t class_index)
{
    uint32_t count = 0, most = class_index == SLC_TILES ? 1 : MOST_OTHERS;
    while (count < most && slc_residency_evict(r, class_index, SLC_NO_LRU))
        count++;
    return count > 0;
}

/* Takes a place, and evicts pages for it. A place of an equal kind can be reused at once, a place
 * of another kind only when all places beside it are free, too. */
static bool take_place(struct slc_demand_residency *r, uint32_t class_index, uint32_t lru,
                       uint32_t *place)
{
    struct slc_page_class *c = &r->classes[class_index];
    const struct slc_page_memory *memory = &c->memory;
    *place = SLC_NO_PLACE;
    if (!c->has_memory)
        return true;
    *place = take(r, memory, r->lrus[lru].kind);
    if (*place != SLC_NO_PLACE)
        return true;
    if (slc_residency_evict(r, class_index, lru) || evict_others(r, class_index))
        *place = take(r, memory, r->lrus[lru].kind);
    else if (class_index == SLC_TILES && c->held < r->use.full_at)
        r->use.full_at = c->held;
    return *place != SLC_NO_PLACE;
}

/* Gives an absent page the place `place`. */
static struct slc_page_node *hold(struct slc_demand_residency *r, uint32_t *index,
                                  const struct slc_page_request *request, uint32_t lru,
                                  uint32_t place)
{
    struct slc_page_class *c = &r->classes[request->class_index];
    if (*index == SLC_NO_NODE)
        *index = slc_page_nodes_add(&r->nodes, request->page);
    struct slc_page_node *node = slc_node(r, *index);
    node->class_index = request->class_index;
    node->rank = request->rank;
    node->lru = lru;
    node->place = place;
    node->pinned = request->pinned != 0;
    c->held++;
    c->pinned += node->pinned;
    r->valued += !c->has_memory;
    if (request->class_index == SLC_TILES)
        r->use.pinned_waiting -= node->pinned;
    return node;
}

static enum slc_request_answer restore(struct slc_demand_residency *r, uint32_t index,
                                       const struct slc_page_request *request, uint32_t lru,
                                       uint32_t place)
{
    struct slc_page_class *c = &r->classes[request->class_index];
    struct slc_page_node *node = hold(r, &index, request, lru, place);
    node->state = SLC_PAGE_RESIDENT;
    node->value = place;
    c->counts.resident++;
    c->counts.restored++;
    touch(r, index);
    slc_residency_note(r, index);
    return SLC_REQUEST_RESTORED;
}

static enum slc_request_answer load(struct slc_demand_residency *r, uint32_t index,
                                    const struct slc_page_request *request, uint32_t lru,
                                    uint32_t place)
{
    struct slc_page_node *node = hold(r, &index, request, lru, place);
    node->state = SLC_PAGE_LOADING;
    r->classes[request->class_index].counts.loading++;
    r->use.loads += request->class_index == SLC_TILES;
    return SLC_REQUEST_LOAD;
}

static enum slc_request_answer turn_away(struct slc_demand_residency *r, uint32_t index,
                                         const struct slc_page_request *request)
{
    bool refuse = slc_residency_is_hopeless(r, request->class_index);
    r->use.turned_away += request->class_index != SLC_TILES;
    if (refuse) {
        r->use.refused = true;
        if (index == SLC_NO_NODE)
            index = slc_page_nodes_add(&r->nodes, request->page);
        slc_residency_leave_home(r, index);
        struct slc_page_node *node = slc_node(r, index);
        node->class_index = request->class_index;
        node->rank = request->rank;
        node->place = SLC_NO_PLACE;
        node->state = SLC_PAGE_REFUSED;
        r->classes[request->class_index].counts.refused++;
        slc_page_list_append(&r->nodes, &r->overflow, index, SLC_HOME_OVERFLOW);
    }
    if (index != SLC_NO_NODE)
        slc_residency_note(r, index);
    return refuse ? SLC_REQUEST_REFUSED : SLC_REQUEST_POSTPONED;
}

static void count_missing(struct slc_demand_residency *r, const struct slc_page_request *request)
{
    if (request->class_index != SLC_TILES)
        return;
    r->use.asked += !request->pinned;
    r->use.pinned_waiting += request->pinned != 0;
}

static enum slc_request_answer answer_absent(struct slc_demand_residency *r, uint32_t index,
                                             const struct slc_page_request *request, uint32_t lru)
{
    const struct slc_page_memory *memory = &r->classes[request->class_index].memory;
    uint32_t old_place = SLC_NO_PLACE, place;
    count_missing(r, request);
    if (index != SLC_NO_NODE) { /* not restorable meanwhile: evictions could drop the node */
        slc_residency_leave_home(r, index);
        if (slc_node(r, index)->class_index == request->class_index)
            old_place = slc_node(r, index)->place;
        slc_node(r, index)->place = SLC_NO_PLACE;
    }
    if (!make_room(r, request->class_index)) {
        if (old_place != SLC_NO_PLACE)
            slc_residency_become_restorable(r, index, old_place);
        return turn_away(r, index, request);
    }
    if (old_place != SLC_NO_PLACE && retake(r, memory, old_place, request->page))
        return restore(r, index, request, lru, old_place);
    if (!take_place(r, request->class_index, lru, &place))
        return turn_away(r, index, request);
    return load(r, index, request, lru, place);
}

static enum slc_request_answer answer(struct slc_demand_residency *r,
                                      const struct slc_page_request *request, SluiceResult *result)
{
    assert(request->class_index < r->class_count);
    *result = SLUICE_SUCCESS;
    uint32_t index = slc_page_nodes_find(&r->nodes, request->page);
    if (index != SLC_NO_NODE && slc_node(r, index)->state != SLC_PAGE_ABSENT) {
        r->use.requests++;
        return answer_known(r, index, request);
    }
    uint32_t lru = slc_residency_lru(r, request->class_index, request->kind);
    if (lru == SLC_NO_LRU || !slc_page_nodes_reserve(&r->nodes, &r->cb) ||
        (!r->classes[request->class_index].has_memory && !slc_residency_reserve_evicted(r))) {
        *result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        return SLC_REQUEST_POSTPONED;
    }
    r->use.requests++;
    return answer_absent(r, index, request, lru);
}

enum slc_request_answer slc_residency_request(struct slc_demand_residency *residency,
                                              const struct slc_page_request *request,
                                              SluiceResult *result)
{
    residency->used = true;
    enum slc_request_answer given = answer(residency, request, result);
    SLC_TELL_PAGES(residency, .kind = SLC_PAGE_CALL_REQUEST, .request = *request, .result = *result,
                   .request_answer = given);
    return given;
}

uint64_t slc_residency_turned_away_count(const struct slc_demand_residency *residency)
{
    return residency->use.turned_away;
}

uint64_t slc_residency_overflow_count(const struct slc_demand_residency *residency)
{
    return residency->overflow.count;
}

bool slc_residency_is_absent(const struct slc_demand_residency *residency, uint32_t page)
{
    uint32_t index = slc_page_nodes_find(&residency->nodes, page);
    return index == SLC_NO_NODE || residency->nodes.at[index].state == SLC_PAGE_ABSENT;
}

uint32_t slc_residency_place(const struct slc_demand_residency *residency, uint32_t page)
{
    uint32_t index = slc_page_nodes_find(&residency->nodes, page);
    if (index == SLC_NO_NODE)
        return SLC_NO_PLACE;
    const struct slc_page_node *node = &residency->nodes.at[index];
    return node->state == SLC_PAGE_LOADING && !node->dropped ? node->place : SLC_NO_PLACE;
}
