/** Measures calls whose cost grew with the square of n when they searched a list: with n and with
 * 2n. */
#include "micro.h"

#include "figures.h"
#include "rig.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const SluiceStreamedTextureManagerConfig plain = {.structSize = sizeof plain,
                                                         .missesToExpire = 1};

/** Describes a texture of one packed tile. */
static SluiceStreamedTextureDesc one_tile(void)
{
    return square_desc(64, 128);
}

static SluiceTextureId *add_many(struct rig *rig, uint32_t count)
{
    const SluiceStreamedTextureDesc desc = one_tile();
    SluiceTextureId *ids = must_allocate(count * sizeof *ids);
    for (uint32_t i = 0; i < count; i++)
        ids[i] = rig_add(rig, &desc);
    return ids;
}

/** A call with room for 16 moves, of `n` heaps of which all are three quarters empty. */
static double defragment(uint32_t n)
{
    enum { CAPACITY = 4, MOVES = 16 };
    struct rig rig;
    SluiceTileMove moves[MOVES];
    uint32_t count = MOVES;
    rig_init(&rig, CAPACITY, &plain, 8192);
    SluiceTextureId *ids = add_many(&rig, n * CAPACITY);
    rig_drain(&rig);
    for (uint32_t i = 0; i < n * CAPACITY; i++)
        if (i % CAPACITY)
            must(sluiceRemoveStreamedTexture(rig.manager, ids[i], 0), "remove");
    uint64_t start = now_ns();
    must(sluiceDefragmentTiles(rig.manager, 0, &count, moves), "defragment");
    double ns = (double)(now_ns() - start);
    free(ids);
    rig_finish(&rig);
    return ns;
}

static void fail_all(struct rig *rig, const SluiceTextureId *ids, uint32_t count, uint64_t time)
{
    const uint32_t tile = 0;
    for (uint32_t i = 0; i < count; i++)
        must(sluiceReportFailedTiles(rig->manager, ids[i], 1, &tile, time), "failed");
}

static void hand_out_all(struct rig *rig, uint32_t count)
{
    for (uint32_t got; count > 0; count -= got) {
        got = rig->room;
        must(sluiceGetTilesToMap(rig->manager, SLUICE_ALL_TEXTURES, &got, rig->tiles), "map");
        if (got == 0)
            must(SLUICE_ERROR_INVALID_ARGUMENT, "too few tiles");
    }
}

/** `n` failures reported before `n` that are due later. */
static double failures(uint32_t n)
{
    struct rig rig;
    SluiceStreamedTextureManagerConfig config = plain;
    config.retryDelayTicks = 1000000;
    rig_init(&rig, 256, &config, 8192);
    SluiceTextureId *ids = add_many(&rig, 2 * n);
    hand_out_all(&rig, 2 * n);
    fail_all(&rig, ids, n, 0);
    config.retryDelayTicks = 1000;
    must(sluiceSetConfig(rig.manager, &config), "config");
    uint64_t start = now_ns();
    fail_all(&rig, ids + n, n, 1);
    double ns = (double)(now_ns() - start);
    free(ids);
    rig_finish(&rig);
    return ns;
}

/** Removes `n` followers of one texture, the newest first. */
static double followers(uint32_t n)
{
    struct rig rig;
    rig_init(&rig, 256, &plain, 8192);
    SluiceTextureId *ids = add_many(&rig, n + 1);
    for (uint32_t i = 1; i <= n; i++)
        must(sluiceSetPrimaryTexture(rig.manager, ids[i], ids[0]), "follow");
    uint64_t start = now_ns();
    for (uint32_t i = n; i > 0; i--)
        must(sluiceRemoveStreamedTexture(rig.manager, ids[i], 0), "remove");
    double ns = (double)(now_ns() - start);
    free(ids);
    rig_finish(&rig);
    return ns;
}

/** Removes `n` textures. Each has a given-up tile without requests. */
static double reports(uint32_t n)
{
    struct rig rig;
    SluiceStreamedTextureManagerConfig config = plain;
    config.maxLoadAttempts = 1;
    rig_init(&rig, 256, &config, 8192);
    SluiceTextureId *ids = add_many(&rig, n);
    hand_out_all(&rig, n);
    fail_all(&rig, ids, n, 0);
    uint64_t start = now_ns();
    for (uint32_t i = 0; i < n; i++)
        must(sluiceRemoveStreamedTexture(rig.manager, ids[i], 0), "remove");
    double ns = (double)(now_ns() - start);
    free(ids);
    rig_finish(&rig);
    return ns;
}

/** Asks for `n` heaps and gives them back. */
static double heaps(uint32_t n)
{
    struct rig rig;
    rig_init(&rig, 1, &plain, 8192);
    SluiceTextureId *ids = add_many(&rig, n);
    uint64_t start = now_ns();
    hand_out_all(&rig, n);
    for (uint32_t i = 0; i < n; i++)
        must(sluiceRemoveStreamedTexture(rig.manager, ids[i], 0), "remove");
    for (uint32_t i = 0; i < n; i++)
        must(sluiceReleaseHeap(rig.manager, i), "release");
    double ns = (double)(now_ns() - start);
    free(ids);
    rig_finish(&rig);
    return ns;
}

static double least(double (*run)(uint32_t n), uint32_t n)
{
    double best = run(n);
    for (uint32_t i = 1; i < (options.quick ? 2 : 7); i++) {
        double ns = run(n);
        best = ns < best ? ns : best;
    }
    return best;
}

static void time_growth(const char *name, double (*run)(uint32_t n), uint32_t n)
{
    char full[64];
    double once = least(run, n), twice = least(run, 2 * n);
    snprintf(full, sizeof full, "growth.%s.%u", name, n);
    figure(full, NULL, once / 1e3, "us");
    snprintf(full, sizeof full, "growth.%s.%u", name, 2 * n);
    figure(full, NULL, twice / 1e3, "us");
    snprintf(full, sizeof full, "growth.%s.ratio", name);
    figure(full, NULL, twice / once, "x");
}

void bench_growth(void)
{
    time_growth("defragment", defragment, 2048);
    time_growth("failures", failures, 10000);
    time_growth("followers", followers, 10000);
    time_growth("reports", reports, 10000);
    time_growth("heaps", heaps, 10000);
}
