/** Where the gallery keeps what it made: its own pictures, and stores of those it was given. */
#ifndef SAMPLES_STREAMING_CACHE_H
#define SAMPLES_STREAMING_CACHE_H

#include <sluice/input.h>

#include <stdbool.h>
#include <stddef.h>

/**
 * "cache/name"; for a cache of NULL the user's, $XDG_CACHE_HOME/sluice or ~/.cache/sluice. Makes
 * nothing. False if it does not fit into `size` bytes.
 */
bool cache_path(const char *cache, const char *name, char *path, size_t size);

/** Writes bytes into "cache/folder/HASH-SIZE-name", unless it is there; an empty name is left
 *  out. `path` receives its path. False with a line on stderr. */
bool cache_keep(const char *cache, const char *folder, const char *name, const void *bytes,
                size_t size, char *path, size_t path_size);

/** Keeps all bytes of an input in "cache/fetched": what reads files alone can read it there. `name`
 *  is the end of the file's name. False with a line on stderr. */
bool cache_keep_input(const char *cache, const char *name, const SluiceInput *input, char *path,
                      size_t path_size);

#endif /* SAMPLES_STREAMING_CACHE_H */
