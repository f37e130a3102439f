#include "pbrt/names.h"

#include "pbrt/growth.h"

#include <string.h>

uint64_t slc_pbrt_hash(const void *bytes, size_t size)
{
    const unsigned char *byte = bytes;
    uint64_t hash = UINT64_C(0xCBF29CE484222325);
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ byte[i]) * UINT64_C(0x100000001B3);
    hash ^= hash >> 32;
    return hash * UINT64_C(0x9E3779B97F4A7C15) >> 16;
}

/* Returns the place of a string, or the free place for a new string. */
static size_t find_place(const struct slc_pbrt_names *names, const char *string, size_t length)
{
    size_t mask = names->place_count - 1;
    size_t place = (size_t)slc_pbrt_hash(string, length) & mask;
    for (; names->places[place]; place = (place + 1) & mask) {
        const char *other = slc_pbrt_name(names, names->places[place] - 1);
        if (strlen(other) == length && memcmp(other, string, length) == 0)
            break;
    }
    return place;
}

static bool grow_places(struct slc_pbrt_names *names, const SluiceAllocationCallbacks *cb)
{
    struct slc_pbrt_names bigger = *names;
    bigger.place_count = names->place_count ? 2 * names->place_count : 64;
    bigger.places = slc_calloc(cb, bigger.place_count, sizeof *bigger.places);
    if (!bigger.places)
        return false;
    for (size_t i = 0; i < names->count; i++) {
        const char *string = slc_pbrt_name(names, (uint32_t)i);
        bigger.places[find_place(&bigger, string, strlen(string))] = (uint32_t)i + 1;
    }
    slc_free(cb, names->places, names->place_count, sizeof *names->places);
    *names = bigger;
    return true;
}

bool slc_pbrt_names_add(struct slc_pbrt_names *names, const SluiceAllocationCallbacks *cb,
                        const char *string, size_t length, uint32_t *number)
{
    const char *end = memchr(string, 0, length);
    length = end ? (size_t)(end - string) : length;
    if (2 * (names->count + 1) > names->place_count && !grow_places(names, cb))
        return false;
    size_t place = find_place(names, string, length);
    if (names->places[place]) {
        *number = names->places[place] - 1;
        return true;
    }
    if (names->char_count + length + 1 > UINT32_MAX ||
        !slc_pbrt_grow(cb, &names->chars, &names->char_capacity, names->char_count + length + 1,
                       1) ||
        !slc_pbrt_grow(cb, &names->starts, &names->start_capacity, names->count + 1,
                       sizeof *names->starts))
        return false;
    names->starts[names->count] = (uint32_t)names->char_count;
    memcpy(names->chars + names->char_count, string, length);
    names->chars[names->char_count + length] = 0;
    names->char_count += length + 1;
    *number = (uint32_t)names->count++;
    names->places[place] = *number + 1;
    return true;
}

void slc_pbrt_names_finish(struct slc_pbrt_names *names, const SluiceAllocationCallbacks *cb)
{
    slc_free(cb, names->chars, names->char_capacity, 1);
    slc_free(cb, names->starts, names->start_capacity, sizeof *names->starts);
    slc_free(cb, names->places, names->place_count, sizeof *names->places);
    *names = (struct slc_pbrt_names){0};
}
