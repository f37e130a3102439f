#include "demand/renderer.h"

#include "demand/random.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static uint32_t level_size(uint32_t tiles, uint32_t level)
{
    return tiles >> level ? tiles >> level : 1;
}

static void init_pyramid(struct renderer *r, struct pyramid *t, uint32_t kinds)
{
    t->width = 1u << random_below(&r->random, RENDERER_LEVELS);
    t->height = 1u << random_below(&r->random, RENDERER_LEVELS);
    t->kind = random_below(&r->random, kinds);
    for (uint32_t l = 0; l < RENDERER_LEVELS; l++) {
        t->first[l] = r->page_end;
        r->page_end += level_size(t->width, l) * level_size(t->height, l);
        t->level_count = l + 1;
        if (t->width >> l <= 1 && t->height >> l <= 1)
            break;
    }
    t->tail = r->page_end++;
    assert_true(r->page_end <= RENDERER_PAGES);
}

void renderer_init(struct renderer *r, uint64_t seed, uint32_t texture_count, uint32_t kinds)
{
    memset(r, 0, sizeof *r);
    r->random = seed * 0x9E3779B97F4A7C15u + 1;
    r->texture_count = texture_count;
    r->page_end = texture_count; /* page i opens texture i */
    r->list_limit = RENDERER_PAGES;
    r->in_flight = 1;
    for (uint32_t t = 0; t < texture_count; t++)
        init_pyramid(r, &r->textures[t], kinds);
    for (uint32_t i = 0; i < RENDERER_IN_FLIGHT; i++) {
        r->flights[i].used = malloc(RENDERER_PAGES * sizeof(uint32_t));
        r->flights[i].missed = malloc(RENDERER_PAGES * sizeof(uint32_t));
        assert_true(r->flights[i].used && r->flights[i].missed);
    }
}

void renderer_start(struct renderer *r, const struct slc_page_residency_create_info *info,
                    uint64_t limit, uint32_t memory_places, uint32_t chunk_size)
{
    struct slc_page_memory memory = fake_page_memory(&r->memory);
    fake_memory_init(&r->memory, memory_places, chunk_size);
    CHECK_OK(slc_residency_create(info, &r->residency));
    CHECK_OK(slc_residency_set_class(r->residency, 0, limit, &memory));
    CHECK_OK(slc_residency_set_class(r->residency, 1, UINT64_MAX, NULL));
}

void renderer_finish(struct renderer *r)
{
    slc_residency_destroy(r->residency);
    for (uint32_t i = 0; i < RENDERER_IN_FLIGHT; i++) {
        free(r->flights[i].used);
        free(r->flights[i].missed);
    }
}

void renderer_random_views(struct renderer *r, uint32_t count)
{
    r->view_count = count;
    for (uint32_t i = 0; i < count; i++) {
        struct view *v = &r->views[i];
        v->texture = random_below(&r->random, r->texture_count);
        v->width = (float)(1 + random_below(&r->random, 1000)) / 1000;
        v->height = (float)(1 + random_below(&r->random, 1000)) / 1000;
        v->x = (1 - v->width) * (float)random_below(&r->random, 1000) / 1000;
        v->y = (1 - v->height) * (float)random_below(&r->random, 1000) / 1000;
        v->lod = (float)random_below(&r->random, 3000) / 1000;
    }
}

typedef void visit_page(void *user, struct renderer *r, const struct pyramid *t, uint32_t level,
                        uint32_t page);

static void visit_level(struct renderer *r, const struct view *v, uint32_t level, visit_page *visit,
                        void *user)
{
    const struct pyramid *t = &r->textures[v->texture];
    if (level >= t->level_count) {
        visit(user, r, t, level, t->tail);
        return;
    }
    uint32_t width = level_size(t->width, level), height = level_size(t->height, level);
    uint32_t x1 = (uint32_t)fminf((v->x + v->width) * (float)width, (float)(width - 1));
    uint32_t y1 = (uint32_t)fminf((v->y + v->height) * (float)height, (float)(height - 1));
    for (uint32_t y = (uint32_t)(v->y * (float)height); y <= y1; y++)
        for (uint32_t x = (uint32_t)(v->x * (float)width); x <= x1; x++)
            visit(user, r, t, level, t->first[level] + y * width + x);
}

/* Trilinear: visits two levels, or one if the level of detail is whole. */
static void visit_view(struct renderer *r, const struct view *v, float bias, visit_page *visit,
                       void *user)
{
    float lod = v->lod + bias;
    uint32_t level = (uint32_t)lod;
    visit_level(r, v, level, visit, user);
    if (lod > (float)level)
        visit_level(r, v, level + 1, visit, user);
}

static void count_page(void *user, struct renderer *r, const struct pyramid *t, uint32_t level,
                       uint32_t page)
{
    (void)level;
    uint32_t *counts = user;
    if (!r->marks[page])
        counts[page == t->tail]++;
    r->marks[page] = 1;
}

uint32_t renderer_need(struct renderer *r, float bias, bool tails)
{
    uint32_t counts[2] = {0};
    memset(r->marks, 0, sizeof r->marks);
    for (uint32_t i = 0; i < r->view_count; i++)
        visit_view(r, &r->views[i], bias, count_page, counts);
    return counts[tails];
}

static uint32_t parent(const struct pyramid *t, uint32_t level, uint32_t page)
{
    if (level + 1 >= t->level_count)
        return t->tail;
    uint32_t width = level_size(t->width, level), index = page - t->first[level];
    uint32_t x = index % width / 2, y = index / width / 2;
    uint32_t parent_width = level_size(t->width, level + 1);
    uint32_t parent_height = level_size(t->height, level + 1);
    x = x < parent_width ? x : parent_width - 1;
    y = y < parent_height ? y : parent_height - 1;
    return t->first[level + 1] + y * parent_width + x;
}

/* Looks a page up like a shader: replaces refused pages by coarser ones. */
static void look_up(void *user, struct renderer *r, const struct pyramid *t, uint32_t level,
                    uint32_t page)
{
    struct flight *flight = user;
    while (r->shown[page] == SLC_SHOW_REFUSED && page != t->tail)
        page = parent(t, level++, page);
    if (r->marks[page] || r->shown[page] == SLC_SHOW_REFUSED)
        return;
    r->marks[page] = 1;
    if (r->shown[page] == SLC_SHOW_RESIDENT)
        flight->used[flight->used_count++] = page;
    else
        flight->missed[flight->missed_count++] = page;
}

/* Repeats requests that did not fit into the last list, unless the bias has changed. */
static void add_left_over(struct renderer *r, float bias, struct flight *flight)
{
    if (bias != r->bias)
        memset(r->left_over, 0, sizeof r->left_over);
    r->bias = bias;
    for (uint32_t page = 0; page < r->page_end; page++)
        if (r->left_over[page] && !r->marks[page])
            flight->missed[flight->missed_count++] = page;
}

static void trace(struct renderer *r, float bias, struct flight *flight)
{
    memset(r->marks, 0, sizeof r->marks);
    flight->used_count = flight->missed_count = 0;
    for (uint32_t i = 0; i < r->view_count; i++) {
        uint32_t t = r->views[i].texture;
        if (r->shown[t] == SLC_SHOW_RESIDENT) {
            visit_view(r, &r->views[i], bias, look_up, flight);
        } else if (!r->marks[t]) {
            r->marks[t] = 1;
            flight->missed[flight->missed_count++] = t;
        }
    }
    add_left_over(r, bias, flight);
}

static void show(struct renderer *r)
{
    struct slc_page_change changes[100];
    uint32_t count;
    do {
        count = slc_residency_take_changes(r->residency, changes, 100);
        for (uint32_t i = 0; i < count; i++)
            r->shown[changes[i].page] = (uint8_t)changes[i].shown;
    } while (count == 100);
}

static uint32_t rank_of(uint32_t tiles)
{
    uint32_t rank = 1;
    for (; tiles > 1; tiles = (tiles + 3) / 4)
        rank++;
    return rank;
}

static struct slc_page_request request_of(const struct renderer *r, uint32_t page)
{
    if (page < r->texture_count)
        return (struct slc_page_request){page, 1, 0, 1, 0};
    const struct pyramid *t = r->textures;
    while (page > t->tail)
        t++;
    if (page == t->tail)
        return (struct slc_page_request){page, 0, 0, 1, t->kind};
    uint32_t level = t->level_count - 1;
    while (page < t->first[level])
        level--;
    uint32_t tiles = level_size(t->width, level) * level_size(t->height, level);
    return (struct slc_page_request){page, 0, (uint8_t)rank_of(tiles), 0, t->kind};
}

static int compare_requests(const void *a, const void *b)
{
    const struct slc_page_request *p = a, *q = b;
    if (p->rank != q->rank)
        return p->rank < q->rank ? -1 : 1;
    return p->page < q->page ? -1 : p->page > q->page;
}

static void serve(struct renderer *r, const struct flight *flight)
{
    for (uint32_t i = 0; i < flight->missed_count; i++)
        r->requests[i] = request_of(r, flight->missed[i]);
    qsort(r->requests, flight->missed_count, sizeof *r->requests, compare_requests);
    for (uint32_t i = 0; i < flight->missed_count; i++)
        r->left_over[r->requests[i].page] = i >= r->list_limit;
    for (uint32_t i = 0; i < flight->missed_count && i < r->list_limit; i++) {
        SluiceResult result;
        uint32_t page = r->requests[i].page;
        switch (slc_residency_request(r->residency, &r->requests[i], &result)) {
        case SLC_REQUEST_LOAD:
            assert_true(r->ready[page] == 0);
            r->ready[page] = r->launch + random_below(&r->random, r->slowest_load + 1);
            r->loads++;
            break;
        case SLC_REQUEST_PENDING: assert_true(r->ready[page] > 0); break;
        case SLC_REQUEST_REFUSED: r->refused++; break;
        case SLC_REQUEST_RESIDENT:
        case SLC_REQUEST_RESTORED:
        case SLC_REQUEST_POSTPONED: break;
        }
        CHECK_OK(result);
    }
}

static void end_reads(struct renderer *r)
{
    for (uint32_t page = 0; page < r->page_end; page++) {
        if (r->ready[page] == 0 || r->ready[page] > r->launch)
            continue;
        slc_residency_loaded(r->residency, page, page);
        r->ready[page] = 0;
    }
}

/* Traces a launch with the current page table, and processes it after later launches have begun. */
void renderer_launch(struct renderer *r)
{
    uint64_t recorded = r->launch + r->in_flight;
    for (uint64_t l = r->launch == 0 ? 1 : recorded; l <= recorded; l++) {
        float bias = slc_residency_prepare(r->residency, l);
        show(r);
        trace(r, bias, &r->flights[l % r->in_flight]);
    }
    r->launch++;
    const struct flight *flight = &r->flights[r->launch % r->in_flight];
    r->loads = r->refused = 0;
    r->missing = flight->missed_count;
    slc_residency_begin(r->residency, r->launch);
    for (uint32_t i = 0; i < flight->used_count; i++)
        slc_residency_use(r->residency, flight->used[i]);
    serve(r, flight);
    slc_residency_settle(r->residency, r->missing);
    end_reads(r);
}
