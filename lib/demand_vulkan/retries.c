/*
 * Retries of failures: docs/decisions/0039-given-up-tiles-are-probed.md.
 *
 * The failed tiles of an image, or pages of a resource, are a group. The group rests for
 * failureRetryDelayNs. Then a few of its pages are no longer refused, so that shaders request them.
 * When one of them is loaded, all others follow. Textures that could not be opened rest one by one,
 * because their files may be unrelated.
 */
#include "demand_vulkan/loader.h"
#include "demand_vulkan/pages.h"

#include "base/alloc.h"
#include "platform/time_now.h"

#include <stdio.h>

#define GROUPS_PER_LAUNCH 16u
#define OPENINGS_PER_LAUNCH 64u
#define EARLY_PART 8u /* delay / time after which a success starts a probe */

static uint64_t rested(const struct slc_retries *r, uint64_t since)
{
    return r->now - since;
}

/* Pages ------------------------------------------------------------------------------------- */

static bool reserve_page(SluiceDemandLoader *loader)
{
    struct slc_retries *r = &loader->retries;
    if (r->free_page != 0)
        return true;
    uint32_t old = r->page_capacity, capacity = old ? 2 * old : 64;
    struct slc_failed_page *pages = slc_regrow(&loader->cb, r->pages, old, capacity, sizeof *pages);
    if (!pages)
        return false;
    r->pages = pages;
    r->page_capacity = capacity;
    for (uint32_t i = capacity; i-- > (old ? old : 1);) { /* 0 is none */
        pages[i].next = r->free_page;
        r->free_page = i;
    }
    return true;
}

static void append_page(struct slc_retries *r, struct slc_failed_list *list, uint32_t page)
{
    uint32_t at = r->free_page;
    r->free_page = r->pages[at].next;
    r->pages[at] = (struct slc_failed_page){.page = page, .since = r->now};
    if (list->first)
        r->pages[list->last].next = at;
    else
        list->first = at;
    list->last = at;
}

static uint32_t pop_page(struct slc_retries *r, struct slc_failed_list *list)
{
    uint32_t at = list->first, page = r->pages[at].page;
    list->first = r->pages[at].next;
    r->pages[at].next = r->free_page;
    r->free_page = at;
    return page;
}

/* Groups ------------------------------------------------------------------------------------ */

static bool reserve_group(SluiceDemandLoader *loader)
{
    struct slc_retries *r = &loader->retries;
    if (r->free_group != 0)
        return true;
    uint32_t old = r->group_capacity, capacity = old ? 2 * old : 16;
    struct slc_retry_group *groups =
        slc_regrow(&loader->cb, r->groups, old, capacity, sizeof *groups);
    if (!groups)
        return false;
    r->groups = groups;
    r->group_capacity = capacity;
    for (uint32_t i = capacity; i-- > (old ? old : 1);) {
        groups[i].next = r->free_group;
        r->free_group = i;
    }
    return true;
}

/* Begins the rest of a group: appends it to the list. */
static void enqueue(struct slc_retries *r, uint32_t index)
{
    struct slc_retry_group *group = &r->groups[index];
    group->since = r->now;
    group->previous = r->last_group;
    group->next = 0;
    if (r->last_group)
        r->groups[r->last_group].next = index;
    else
        r->first_group = index;
    r->last_group = index;
}

static void dequeue(struct slc_retries *r, uint32_t index)
{
    const struct slc_retry_group *group = &r->groups[index];
    if (group->previous)
        r->groups[group->previous].next = group->next;
    else
        r->first_group = group->next;
    if (group->next)
        r->groups[group->next].previous = group->previous;
    else
        r->last_group = group->previous;
}

static void free_group(struct slc_retries *r, uint32_t index)
{
    struct slc_retry_group *group = &r->groups[index];
    dequeue(r, index);
    *group->owner = 0;
    group->next = r->free_group;
    r->free_group = index;
}

/* Lets the next page of a group be requested. Ids forgotten meanwhile may have new owners:
 * harmless. */
static uint32_t retry_next(SluiceDemandLoader *loader, struct slc_retry_group *group)
{
    uint32_t page = pop_page(&loader->retries, &group->pages);
    if (slc_residency_retry(loader->residency, page))
        loader->counts.retriedCount++;
    return page;
}

static void probe(SluiceDemandLoader *loader, uint32_t index)
{
    struct slc_retries *r = &loader->retries;
    struct slc_retry_group *group = &r->groups[index];
    group->probe_count = 0;
    while (group->pages.first && group->probe_count < SLC_PAGES_PER_PROBE)
        group->probes[group->probe_count++] = retry_next(loader, group);
    dequeue(r, index);
    enqueue(r, index);
}

static bool is_probe(const struct slc_retry_group *group, uint32_t page)
{
    for (uint32_t i = 0; i < group->probe_count; i++)
        if (group->probes[i] == page)
            return true;
    return false;
}

bool slc_retries_add(SluiceDemandLoader *loader, uint32_t *owner, uint32_t page)
{
    struct slc_retries *r = &loader->retries;
    if (!reserve_page(loader) || (*owner == 0 && !reserve_group(loader)))
        return false;
    r->now = slc_monotonic_time();
    if (*owner == 0) {
        *owner = r->free_group;
        r->free_group = r->groups[*owner].next;
        r->groups[*owner] = (struct slc_retry_group){.owner = owner};
        enqueue(r, *owner);
    }
    append_page(r, &r->groups[*owner].pages, page);
    return true;
}

void slc_retries_all(SluiceDemandLoader *loader, uint32_t *owner)
{
    if (*owner == 0)
        return;
    while (loader->retries.groups[*owner].pages.first)
        retry_next(loader, &loader->retries.groups[*owner]);
    free_group(&loader->retries, *owner);
}

void slc_retries_success(SluiceDemandLoader *loader, uint32_t *owner, uint32_t page)
{
    struct slc_retries *r = &loader->retries;
    uint64_t delay = loader->info.failureRetryDelayNs;
    if (*owner == 0 || delay == UINT64_MAX)
        return;
    struct slc_retry_group *group = &r->groups[*owner];
    r->now = slc_monotonic_time();
    if (is_probe(group, page))
        slc_retries_all(loader, owner);
    else if (rested(r, group->since) >= delay / EARLY_PART)
        probe(loader, *owner);
}

/* Openings ---------------------------------------------------------------------------------- */

bool slc_retries_add_opening(SluiceDemandLoader *loader, uint32_t texture)
{
    struct slc_retries *r = &loader->retries;
    if (loader->textures[texture].retry_queued)
        return true;
    if (!reserve_page(loader))
        return false;
    r->now = slc_monotonic_time();
    append_page(r, &r->openings, texture);
    loader->textures[texture].retry_queued = true;
    return true;
}

void slc_retries_note_opened(SluiceDemandLoader *loader)
{
    struct slc_retries *r = &loader->retries;
    r->now = slc_monotonic_time();
    r->opened = r->now;
    r->has_opened = true;
}

static void retry_opening(SluiceDemandLoader *loader)
{
    uint32_t texture = pop_page(&loader->retries, &loader->retries.openings);
    loader->textures[texture].retry_queued = false;
    if (slc_texture_retry(loader, texture))
        loader->counts.retriedCount++;
}

/* True if the next opening has rested, or another failed texture could be opened since. */
static bool opening_is_due(const struct slc_retries *r, uint64_t delay)
{
    if (r->openings.first == 0)
        return false;
    uint64_t since = r->pages[r->openings.first].since;
    return rested(r, since) >= delay ||
           (r->has_opened && since < r->opened && r->opened - since >= delay / EARLY_PART);
}

/* Public functions -------------------------------------------------------------------------- */

void slc_retries_advance(SluiceDemandLoader *loader)
{
    struct slc_retries *r = &loader->retries;
    uint64_t delay = loader->info.failureRetryDelayNs;
    if ((r->first_group == 0 && r->openings.first == 0) || delay == UINT64_MAX)
        return;
    r->now = slc_monotonic_time();
    for (uint32_t i = 0; i < OPENINGS_PER_LAUNCH && opening_is_due(r, delay); i++)
        retry_opening(loader);
    for (uint32_t i = 0; i < GROUPS_PER_LAUNCH && r->first_group; i++) {
        uint32_t index = r->first_group;
        if (rested(r, r->groups[index].since) < delay)
            break;
        if (r->groups[index].pages.first)
            probe(loader, index);
        else
            free_group(r, index);
    }
}

void slc_retries_everything(SluiceDemandLoader *loader)
{
    struct slc_retries *r = &loader->retries;
    while (r->openings.first)
        retry_opening(loader);
    while (r->first_group)
        slc_retries_all(loader, r->groups[r->first_group].owner);
}

const char *slc_retries_words(const SluiceDemandLoader *loader, char *words, size_t size)
{
    uint64_t delay = loader->info.failureRetryDelayNs;
    if (delay == UINT64_MAX)
        snprintf(words, size, "not retrying");
    else
        snprintf(words, size, "retrying in %.3g s", (double)delay / 1e9);
    return words;
}

void slc_retries_finish(SluiceDemandLoader *loader)
{
    struct slc_retries *r = &loader->retries;
    slc_free(&loader->cb, r->pages, r->page_capacity, sizeof *r->pages);
    slc_free(&loader->cb, r->groups, r->group_capacity, sizeof *r->groups);
    *r = (struct slc_retries){0};
}
