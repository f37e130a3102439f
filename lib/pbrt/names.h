/** Names: unique strings of a scene, identified by numbers. */
#ifndef SLC_PBRT_NAMES_H
#define SLC_PBRT_NAMES_H

#include <sluice/base.h>

struct slc_pbrt_names {
    char *chars; ///< owned; strings, each with a 0 behind it
    size_t char_count, char_capacity;
    uint32_t *starts; ///< owned; [count], in chars
    size_t count, start_capacity;
    uint32_t *places; ///< owned; [place_count]: number + 1, or 0; a hash table
    size_t place_count;
};

/** Finds or adds a string. False: out of memory, or more than 2^32 - 1 bytes of strings. */
bool slc_pbrt_names_add(struct slc_pbrt_names *names, const SluiceAllocationCallbacks *cb,
                        const char *string, size_t length, uint32_t *number);
/** Returns a string, valid until the next string is added. */
static inline const char *slc_pbrt_name(const struct slc_pbrt_names *names, uint32_t number)
{
    return names->chars + names->starts[number];
}
void slc_pbrt_names_finish(struct slc_pbrt_names *names, const SluiceAllocationCallbacks *cb);

/** Returns FNV-1a with a final mix, for hash tables. */
uint64_t slc_pbrt_hash(const void *bytes, size_t size);

#endif /* SLC_PBRT_NAMES_H */
