#include "traced_tiles.h"

#include <stdlib.h>
#include <string.h>

#define NO_PAGE UINT32_MAX
#define SLOTS_PER_FRAME 16384u /* with more slots, looks become rarer in proportion */

void traced_tiles_finish(struct traced_tiles *t)
{
    free(t->entries);
    free(t->slots);
    free(t->images);
    free(t->first_slots);
    free(t->by_slot);
    *t = (struct traced_tiles){0};
}

/* Finds the entry of a page. traced_show.comp has the same hash function. */
static struct traced_tile *entry_of(struct traced_tile *entries, uint32_t capacity, uint32_t page)
{
    uint32_t at = (page * 0x9e3779b1u) & (capacity - 1);
    while (entries[at].slot.page != page && entries[at].slot.page != NO_PAGE)
        at = (at + 1) & (capacity - 1);
    return &entries[at];
}

const struct traced_tile *traced_tiles_find(const struct traced_tiles *t, uint32_t page)
{
    if (t->capacity == 0 || page == NO_PAGE)
        return NULL;
    const struct traced_tile *entry = entry_of(t->entries, t->capacity, page);
    return entry->slot.page == page ? entry : NULL;
}

bool traced_tile_thrashes(const struct traced_tile *tile, uint64_t now)
{
    return tile->loads >= TRACED_TILE_THRASHES &&
           now - tile->loaded[TRACED_TILE_THRASHES - 1] < TRACED_TILE_WINDOW;
}

static bool list_slots(struct traced_tiles *t, const SluiceDemandLoader *loader)
{
    uint32_t count = 0;
    if (sluiceGetDemandSlots(loader, &count, NULL) != SLUICE_SUCCESS)
        return false;
    t->is_cut = count > TRACED_TILE_MOST;
    count = t->is_cut ? TRACED_TILE_MOST : count;
    if (count > t->slot_room) {
        SluiceDemandSlot *grown = realloc(t->slots, 2 * (size_t)count * sizeof *grown);
        if (!grown)
            return false;
        t->slots = grown;
        t->slot_room = 2 * count;
    }
    t->slot_count = count;
    return sluiceGetDemandSlots(loader, &t->slot_count, t->slots) >= SLUICE_SUCCESS;
}

static bool list_images(struct traced_tiles *t, const SluiceDemandLoader *loader)
{
    uint32_t count = 0, slots = 0;
    if (sluiceGetDemandSlotImages(loader, &count, NULL) != SLUICE_SUCCESS)
        return false;
    SluiceDemandSlotImage *images = malloc((count + 1u) * sizeof *images);
    uint32_t *first = malloc((count + 1u) * sizeof *first), *by_slot = NULL;
    if (images && first && sluiceGetDemandSlotImages(loader, &count, images) >= SLUICE_SUCCESS) {
        for (uint32_t i = 0; i < count; slots += images[i++].slotCount)
            first[i] = slots;
        by_slot = calloc(slots + 1u, sizeof *by_slot);
    }
    if (!by_slot) {
        free(images);
        free(first);
        return false;
    }
    free(t->images);
    free(t->first_slots);
    free(t->by_slot);
    t->images = images;
    t->first_slots = first;
    t->by_slot = by_slot;
    t->image_count = count;
    return true;
}

static uint32_t find_image(const struct traced_tiles *t, uint32_t image)
{
    uint32_t i = 0;
    while (i < t->image_count && t->images[i].image != image)
        i++;
    return i;
}

/* Enters the slots into `by_slot`. Mip tails may share a slot: the last one is entered. */
static void place_slots(struct traced_tiles *t)
{
    for (uint32_t i = 0, image = 0; i < t->slot_count; i++) {
        const SluiceDemandSlot *slot = &t->slots[i];
        if (image >= t->image_count || t->images[image].image != slot->image)
            image = find_image(t, slot->image);
        if (image < t->image_count && slot->layer < t->images[image].slotCount)
            t->by_slot[t->first_slots[image] + slot->layer] = 1 + i;
    }
}

const SluiceDemandSlot *traced_tiles_at(const struct traced_tiles *t, uint32_t image,
                                        uint32_t layer)
{
    const uint32_t at = t->by_slot[t->first_slots[image] + layer];
    return at > 0 ? &t->slots[at - 1] : NULL;
}

/* Notes a load, unless the tile was restored from standby. */
static void note_slot(struct traced_tile *entry, const SluiceDemandSlot *slot, uint64_t now)
{
    const bool was = entry->here && entry->slot.state != SLUICE_DEMAND_SLOT_LOADING;
    const bool is = slot->state == SLUICE_DEMAND_SLOT_RESIDENT;
    entry->slot = *slot;
    entry->here = true;
    if (!is || was)
        return;
    memmove(&entry->loaded[1], &entry->loaded[0],
            (TRACED_TILE_THRASHES - 1) * sizeof *entry->loaded);
    entry->loaded[0] = now;
    entry->loads++;
}

/* Rebuilds the hash map. Keeps an evicted tile for TRACED_TILE_WINDOW after its last load, so that
 * thrashing is noticed. */
static bool rebuild(struct traced_tiles *t, uint64_t now)
{
    uint32_t kept = t->slot_count, capacity = 64;
    for (uint32_t i = 0; i < t->capacity; i++)
        kept += t->entries[i].slot.page != NO_PAGE;
    while (capacity < 2 * kept)
        capacity *= 2;
    struct traced_tile *entries = malloc(capacity * sizeof *entries);
    if (!entries)
        return false;
    memset(entries, 0, capacity * sizeof *entries);
    for (uint32_t i = 0; i < capacity; i++)
        entries[i].slot.page = NO_PAGE;
    for (uint32_t i = 0; i < t->slot_count; i++) {
        const struct traced_tile *before = traced_tiles_find(t, t->slots[i].page);
        struct traced_tile *entry = entry_of(entries, capacity, t->slots[i].page);
        if (before && before->slot.textureId == t->slots[i].textureId)
            *entry = *before;
        note_slot(entry, &t->slots[i], now);
    }
    for (uint32_t i = 0; i < t->capacity; i++) {
        const struct traced_tile *before = &t->entries[i];
        if (before->slot.page == NO_PAGE || before->loads == 0 ||
            now - before->loaded[0] > TRACED_TILE_WINDOW)
            continue;
        struct traced_tile *entry = entry_of(entries, capacity, before->slot.page);
        if (entry->slot.page != NO_PAGE)
            continue;
        *entry = *before;
        entry->here = false;
    }
    free(t->entries);
    t->entries = entries;
    t->capacity = capacity;
    return true;
}

void traced_tiles_look(struct traced_tiles *t, const SluiceDemandLoader *loader,
                       const SluiceDemandStatistics *s, uint64_t frame, uint64_t now)
{
    const uint64_t seen[4] = {s->servedCount + s->restoredCount, s->evictedCount,
                              s->residentTileCount, s->tileMemorySize};
    if (frame < t->next_look || (t->capacity > 0 && memcmp(seen, t->seen, sizeof seen) == 0))
        return;
    if (!list_slots(t, loader) || !list_images(t, loader) || !rebuild(t, now))
        return;
    place_slots(t);
    memcpy(t->seen, seen, sizeof seen);
    t->next_look = frame + 1 + t->slot_count / SLOTS_PER_FRAME;
}

static int by_size(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x < y) - (x > y);
}

/* Slots of the smallest images of a format that all its tiles do not need. */
static uint32_t spare_of_format(const struct traced_tiles *t, SluiceFormat format, uint32_t *sizes)
{
    uint32_t count = 0, used = 0, spare = 0, room = 0;
    for (uint32_t i = 0; i < t->image_count; i++) {
        const SluiceDemandSlotImage *image = &t->images[i];
        if (image->format != format)
            continue;
        sizes[count++] = image->slotCount;
        used += image->usedSlotCount + image->otherSlotCount;
    }
    qsort(sizes, count, sizeof *sizes, by_size);
    for (uint32_t i = 0; i < count; room += sizes[i++])
        spare += room >= used ? sizes[i] : 0;
    return spare;
}

struct traced_tile_sums traced_tiles_sums(const struct traced_tiles *t)
{
    struct traced_tile_sums sums = {0};
    uint32_t *sizes = malloc((t->image_count + 1u) * sizeof *sizes);
    for (uint32_t i = 0; i < t->image_count; i++) {
        bool first = true;
        for (uint32_t k = 0; k < i; k++)
            first = first && t->images[k].format != t->images[i].format;
        sums.slots += t->images[i].slotCount;
        sums.used += t->images[i].usedSlotCount + t->images[i].otherSlotCount;
        sums.spare += first && sizes ? spare_of_format(t, t->images[i].format, sizes) : 0;
    }
    free(sizes);
    for (uint32_t i = 0; i < t->slot_count; i++)
        sums.standby += t->slots[i].state == SLUICE_DEMAND_SLOT_STANDBY;
    sums.fragmentation = sums.slots > 0 ? (double)sums.spare / sums.slots : 0.0;
    return sums;
}
