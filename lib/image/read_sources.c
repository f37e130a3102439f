#include "image/read_sources.h"

#include "base/alloc.h"

#include <assert.h>

void slc_read_sources_finish(struct slc_read_sources *sources, const SluiceAllocationCallbacks *cb)
{
    for (uint32_t i = 0; i < sources->place_count; i++)
        slc_free(cb, sources->places[i], 1, sizeof **sources->places);
    slc_free(cb, sources->places, sources->place_count, sizeof *sources->places);
    *sources = (struct slc_read_sources){0};
}

/* Where it is, or the free place where it would be. */
static uint32_t place_of(const struct slc_read_sources *sources, const SluiceImageSource *source)
{
    uint64_t hash = (uint64_t)(uintptr_t)source * 0x9E3779B97F4A7C15u >> 32;
    uint32_t at = (uint32_t)hash & (sources->place_count - 1);
    while (sources->places[at] && sources->places[at]->source != source)
        at = (at + 1) & (sources->place_count - 1);
    return at;
}

struct slc_read_source *slc_read_sources_find(const struct slc_read_sources *sources,
                                              const SluiceImageSource *source)
{
    return sources->place_count ? sources->places[place_of(sources, source)] : NULL;
}

/* Half of the places stay free, so that searches end soon. */
static bool make_room(struct slc_read_sources *sources, const SluiceAllocationCallbacks *cb)
{
    if (2 * (sources->count + 1) <= sources->place_count)
        return true;
    struct slc_read_sources bigger = {sources->place_count ? 2 * sources->place_count : 16,
                                      sources->count, NULL};
    bigger.places = slc_calloc(cb, bigger.place_count, sizeof *bigger.places);
    if (!bigger.places)
        return false;
    for (uint32_t i = 0; i < sources->place_count; i++)
        if (sources->places[i])
            bigger.places[place_of(&bigger, sources->places[i]->source)] = sources->places[i];
    slc_free(cb, sources->places, sources->place_count, sizeof *sources->places);
    *sources = bigger;
    return true;
}

struct slc_read_source *slc_read_sources_get(struct slc_read_sources *sources,
                                             const SluiceAllocationCallbacks *cb,
                                             SluiceImageSource *source)
{
    struct slc_read_source *known = slc_read_sources_find(sources, source);
    if (known || !make_room(sources, cb))
        return known;
    struct slc_read_source *added = slc_calloc(cb, 1, sizeof *added);
    if (!added)
        return NULL;
    added->source = source;
    sources->places[place_of(sources, source)] = added;
    sources->count++;
    return added;
}

void slc_read_sources_remove(struct slc_read_sources *sources, const SluiceAllocationCallbacks *cb,
                             struct slc_read_source *source)
{
    uint32_t mask = sources->place_count - 1, at = place_of(sources, source->source);
    assert(sources->places[at] == source);
    sources->places[at] = NULL;
    sources->count--;
    /* Those behind it may have wished to be nearer. */
    for (at = (at + 1) & mask; sources->places[at]; at = (at + 1) & mask) {
        struct slc_read_source *moved = sources->places[at];
        sources->places[at] = NULL;
        sources->places[place_of(sources, moved->source)] = moved;
    }
    slc_free(cb, source, 1, sizeof *source);
}
