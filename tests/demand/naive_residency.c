#include "demand/naive_residency.h"

#include "support/test.h"

static bool has_memory(const struct naive_residency *n, uint32_t class_index)
{
    return n->memories[class_index].take != NULL;
}

static uint64_t count_held(const struct naive_residency *n, uint32_t class_index, bool pinned_alone)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < NAIVE_PAGES; i++) {
        const struct naive_page *p = &n->pages[i];
        bool held = p->state == NAIVE_LOADING || p->state == NAIVE_RESIDENT;
        count += held && p->class_index == class_index && (p->pinned || !pinned_alone);
    }
    return count;
}

void naive_begin(struct naive_residency *n, uint64_t launch)
{
    n->launch = launch;
    n->touched = 0;
    n->refused = false;
    for (uint32_t i = 0; i < NAIVE_PAGES; i++) {
        struct naive_page *p = &n->pages[i];
        if (p->state == NAIVE_RESIDENT && p->waiting && p->visible_from <= launch) {
            p->waiting = false;
            p->last_use = launch - 1;
        }
    }
}

static void touch(struct naive_residency *n, struct naive_page *p)
{
    n->touched += p->last_use != n->launch && p->class_index == 0 && !p->pinned;
    p->last_use = n->launch;
}

void naive_use(struct naive_residency *n, uint32_t page)
{
    if (n->pages[page].state == NAIVE_RESIDENT)
        touch(n, &n->pages[page]);
}

/* From loading or resident to absent. */
static void release(struct naive_residency *n, struct naive_page *p, bool evicted)
{
    const struct slc_page_memory *memory = &n->memories[p->class_index];
    if (has_memory(n, p->class_index))
        memory->give(memory->user, p->place, evicted ? p->id : SLC_NO_PAGE);
    else if (p->state == NAIVE_RESIDENT)
        n->evicted[n->evicted_end++] = (struct slc_page_evicted){p->id, p->class_index, p->value};
    assert_true(n->evicted_end < NAIVE_VALUES);
    p->restorable = evicted && has_memory(n, p->class_index);
    p->state = NAIVE_ABSENT;
    p->pinned = p->dropped = p->waiting = false;
}

static bool goes_before(const struct naive_page *a, const struct naive_page *b)
{
    if (a->last_use != b->last_use)
        return a->last_use < b->last_use;
    return a->rank != b->rank ? a->rank > b->rank : a->id < b->id;
}

static bool evict(struct naive_residency *n, uint32_t class_index, const uint32_t *kind)
{
    struct naive_page *best = NULL;
    for (uint32_t i = 0; i < NAIVE_PAGES && !n->no_eviction; i++) {
        struct naive_page *p = &n->pages[i];
        if (p->state == NAIVE_RESIDENT && p->class_index == class_index && !p->pinned &&
            !p->waiting && p->last_use < n->launch && (!kind || p->kind == *kind) &&
            (!best || goes_before(p, best)))
            best = p;
    }
    if (!best)
        return false;
    n->counts[class_index].evicted++;
    release(n, best, true);
    return true;
}

static enum slc_request_answer turn_away(struct naive_residency *n, struct naive_page *p,
                                         const struct slc_page_request *request)
{
    if (request->class_index != 0 || !(n->no_eviction || n->no_lod_bias || n->blurriest ||
                                       count_held(n, 0, true) >= n->limits[0]))
        return SLC_REQUEST_POSTPONED;
    p->class_index = request->class_index;
    p->rank = request->rank;
    p->restorable = false;
    p->state = NAIVE_REFUSED;
    p->overflow = ++n->refusals;
    n->refused = true;
    return SLC_REQUEST_REFUSED;
}

static enum slc_request_answer answer_known(struct naive_residency *n, struct naive_page *p,
                                            const struct slc_page_request *request)
{
    if (p->state == NAIVE_REFUSED)
        return SLC_REQUEST_REFUSED;
    if (request->pinned && !p->dropped) {
        p->pinned = true;
        p->waiting = false;
    }
    if (p->state == NAIVE_LOADING)
        return SLC_REQUEST_PENDING;
    touch(n, p);
    return SLC_REQUEST_RESIDENT;
}

static bool find_place(struct naive_residency *n, const struct slc_page_request *request,
                       uint32_t *place)
{
    const struct slc_page_memory *memory = &n->memories[request->class_index];
    *place = SLC_NO_PLACE;
    if (!has_memory(n, request->class_index))
        return true;
    *place = memory->take(memory->user, request->kind);
    if (*place != SLC_NO_PLACE)
        return true;
    bool evicted = evict(n, request->class_index, &request->kind);
    if (!evicted) /* one tile, or up to 32 byte pages */
        for (int i = request->class_index ? 32 : 1; i > 0; i--)
            evicted |= evict(n, request->class_index, NULL);
    if (evicted)
        *place = memory->take(memory->user, request->kind);
    return *place != SLC_NO_PLACE;
}

enum slc_request_answer naive_request(struct naive_residency *n, uint32_t page,
                                      const struct slc_page_request *request)
{
    struct naive_page *p = &n->pages[page];
    const struct slc_page_memory *memory = &n->memories[request->class_index];
    if (p->state != NAIVE_ABSENT)
        return answer_known(n, p, request);
    while (count_held(n, request->class_index, false) >= n->limits[request->class_index])
        if (!evict(n, request->class_index, NULL))
            return turn_away(n, p, request);
    bool restored = p->restorable && memory->retake(memory->user, p->place, p->id);
    p->restorable = false;
    if (!restored && !find_place(n, request, &p->place))
        return turn_away(n, p, request);
    p->class_index = request->class_index;
    p->rank = request->rank;
    p->kind = request->kind;
    p->pinned = request->pinned;
    p->state = restored ? NAIVE_RESIDENT : NAIVE_LOADING;
    if (!restored)
        return SLC_REQUEST_LOAD;
    n->counts[p->class_index].restored++;
    p->value = p->place;
    p->waiting = !p->pinned;
    p->visible_from = UINT64_MAX;
    touch(n, p);
    return SLC_REQUEST_RESTORED;
}

static void trim(struct naive_residency *n, uint32_t class_index)
{
    while (count_held(n, class_index, false) > n->limits[class_index])
        if (!evict(n, class_index, NULL))
            return;
}

static uint64_t idle_places(const struct naive_residency *n)
{
    uint64_t needed = count_held(n, 0, true) + n->touched;
    for (uint32_t i = 0; i < NAIVE_PAGES; i++)
        needed += n->pages[i].state == NAIVE_LOADING && n->pages[i].class_index == 0;
    if (n->no_eviction)
        needed = count_held(n, 0, false);
    return n->limits[0] > needed ? n->limits[0] - needed : 0;
}

static void lift(struct naive_residency *n)
{
    uint64_t idle = idle_places(n);
    if (n->refused)
        n->refused_idle = idle;
    if (idle <= n->refused_idle || idle * 8 < n->limits[0])
        return;
    for (uint64_t count = (idle + 1) / 2; count > 0; count--) {
        struct naive_page *first = NULL;
        for (uint32_t i = 0; i < NAIVE_PAGES; i++)
            if (n->pages[i].overflow && (!first || n->pages[i].overflow < first->overflow))
                first = &n->pages[i];
        if (!first)
            return;
        first->overflow = 0;
        first->state = NAIVE_ABSENT;
    }
}

void naive_settle(struct naive_residency *n)
{
    lift(n);
    for (uint32_t c = 0; c < NAIVE_CLASSES; c++)
        trim(n, c);
}

void naive_loaded(struct naive_residency *n, uint32_t page, uint64_t value)
{
    struct naive_page *p = &n->pages[page];
    p->state = NAIVE_RESIDENT;
    p->value = has_memory(n, p->class_index) ? p->place : value;
    p->last_use = n->launch;
    p->waiting = !p->pinned;
    p->visible_from = UINT64_MAX;
    if (p->dropped)
        release(n, p, false);
}

void naive_failed(struct naive_residency *n, uint32_t page, bool refuse)
{
    struct naive_page *p = &n->pages[page];
    refuse = refuse && !p->dropped;
    release(n, p, false);
    p->state = refuse ? NAIVE_REFUSED : NAIVE_ABSENT;
}

void naive_forget(struct naive_residency *n, uint32_t page)
{
    struct naive_page *p = &n->pages[page];
    if (p->state == NAIVE_LOADING)
        p->dropped = true;
    else if (p->state == NAIVE_RESIDENT)
        release(n, p, false);
    else
        p->state = NAIVE_ABSENT;
    p->restorable = false;
    p->overflow = 0;
}

void naive_set_limit(struct naive_residency *n, uint32_t class_index, uint64_t limit)
{
    n->limits[class_index] = limit;
    trim(n, class_index);
}

uint32_t naive_take_changes(struct naive_residency *n, struct slc_page_change *changes,
                            uint32_t capacity)
{
    const enum slc_page_shown shown[] = {SLC_SHOW_ABSENT, SLC_SHOW_ABSENT, SLC_SHOW_RESIDENT,
                                         SLC_SHOW_REFUSED};
    uint32_t count = 0;
    for (uint32_t i = 0; i < NAIVE_PAGES && count < capacity; i++) {
        struct naive_page *p = &n->pages[i];
        enum slc_page_shown now = shown[p->state];
        if (now != p->shown || (now == SLC_SHOW_RESIDENT && p->value != p->shown_value))
            changes[count++] = (struct slc_page_change){p->id, now, p->value, p->class_index};
        p->shown = now;
        p->shown_value = p->value;
        if (p->state == NAIVE_RESIDENT && p->waiting && p->visible_from == UINT64_MAX)
            p->visible_from = n->prepared > n->launch ? n->prepared : n->launch + 1;
    }
    return count;
}
