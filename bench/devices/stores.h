/** Tile stores to fill devices from. */
#ifndef BENCH_DEVICES_STORES_H
#define BENCH_DEVICES_STORES_H

#include <sluice/store.h>

/** Writes a store of zstd level 3: an RGBA8 picture of smooth shapes and some noise, whose tiles
 * are about half as large as their texels. Reports errors on stderr. */
bool stores_write(const char *path, uint32_t size);
/** Opens the store `count` times, each as a source of its own. NULL if that fails. */
SluiceImageSource **stores_open(const char *path, uint32_t count);
void stores_close(SluiceImageSource **sources, uint32_t count);

#endif /* BENCH_DEVICES_STORES_H */
