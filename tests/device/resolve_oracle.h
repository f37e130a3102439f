/**
 * Expected result of a resolve, by brute force on the host: scans whole maps, one texture after the
 * other. Shares only the layout of results with the passes.
 */
#ifndef TESTS_DEVICE_RESOLVE_ORACLE_H
#define TESTS_DEVICE_RESOLVE_ORACLE_H

#include <sluice/shared/resolve.h>
#include <sluice/shared/texture_table.h>

#include <stdbool.h>
#include <stdint.h>

struct oracle_texture {
    uint32_t first, count; ///< regions
    uint8_t *written;      ///< levels written since the last report
    uint8_t *reported;
};

struct oracle_item {
    struct oracle_texture *texture;
    uint32_t flags;
};

/** Fills in `results` and at most `capacity` words of `data`. Returns the number of words. Moves
 * reported levels from `written` to `reported`. */
uint32_t oracle_resolve(const struct oracle_item *items, uint32_t item_count, uint32_t capacity,
                        struct SluiceResolveResult *results, uint32_t *data);

#endif /* TESTS_DEVICE_RESOLVE_ORACLE_H */
