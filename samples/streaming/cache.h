/** Cache of the gallery: its own pictures, and stores made of pictures it was given. */
#ifndef SAMPLES_STREAMING_CACHE_H
#define SAMPLES_STREAMING_CACHE_H

#include <sluice/input.h>

#include <stdbool.h>
#include <stddef.h>

/**
 * Makes the path "cache/name". If `cache` is NULL, the user's cache is $XDG_CACHE_HOME/sluice or
 * ~/.cache/sluice. Creates no folder. Returns false if the path does not fit into `size` bytes.
 */
bool cache_path(const char *cache, const char *name, char *path, size_t size);

/** Writes bytes to "cache/folder/HASH-SIZE-name", unless the file exists. Leaves out an empty name.
 * `path` receives the path. Reports errors on stderr. */
bool cache_keep(const char *cache, const char *folder, const char *name, const void *bytes,
                size_t size, char *path, size_t path_size);

/** Copies an input to "cache/fetched", for readers that only read files. `name`: the end of the
 * file's name. Reports errors on stderr. */
bool cache_keep_input(const char *cache, const char *name, const SluiceInput *input, char *path,
                      size_t path_size);

#endif /* SAMPLES_STREAMING_CACHE_H */
