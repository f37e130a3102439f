/** Where the gallery keeps what it made: its own pictures, and stores of those it was given. */
#ifndef SAMPLES_STREAMING_CACHE_H
#define SAMPLES_STREAMING_CACHE_H

#include <stdbool.h>
#include <stddef.h>

/**
 * "cache/name"; for a cache of NULL the user's, $XDG_CACHE_HOME/sluice or ~/.cache/sluice. Makes
 * nothing. False if it does not fit into `size` bytes.
 */
bool cache_path(const char *cache, const char *name, char *path, size_t size);

#endif /* SAMPLES_STREAMING_CACHE_H */
