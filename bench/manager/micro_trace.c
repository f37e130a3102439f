/** Measurements with the harness's textures and maps: a camera cut, and the minimum time of a
 * trace. */
#include "micro.h"

#include "figures.h"
#include "rig.h"
#include "sltrace.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A full turn takes 50 s. After this many frames the camera is on the other side. */
enum { HALF_A_TURN = 1500, FRAME = 16667, ROOM = 1u << 19 };

static const slt_params cut_scene = {.seed = 1,
                                     .textureCount = 10000,
                                     .frameCount = HALF_A_TURN + 1,
                                     .texturesPerFrame = 3334,
                                     .frameMicros = FRAME,
                                     .visiblePermille = 200,
                                     .dropPermille = 300,
                                     .setSize = 3,
                                     .profile = 1,
                                     .speedMilliTurns = 20000};

struct seen {
    SluiceTextureId id;
    SluiceStreamedTextureDesc desc;
    uint32_t primary;
    SluiceFeedbackDesc map[2]; ///< primaries: maps before and after the cut
};

struct cut {
    struct rig rig;
    struct seen *textures;
    uint8_t *maps, *min_mip;
    SluiceMinMipRect *rects;
    uint32_t listed; ///< tiles of the last frame, in rig.tiles
};

/** Nanoseconds of the parts of a frame. */
struct parts {
    double feedback, follow, lists, min_mip;
};

static SluiceStreamedTextureDesc desc_of(const slt_texture *t)
{
    return (SluiceStreamedTextureDesc){.width = t->width,
                                       .height = t->height,
                                       .mipLevelCount = t->mipCount,
                                       .regularMipCount = t->regularMips,
                                       .packedTileCount = t->packedTiles,
                                       .tileWidth = t->tileW,
                                       .tileHeight = t->tileH,
                                       .feedbackRegionWidth = t->fbRegionW,
                                       .feedbackRegionHeight = t->fbRegionH};
}

static void cut_init(struct cut *cut)
{
    const slt_params *p = &cut_scene;
    SluiceStreamedTextureManagerConfig config = {.structSize = sizeof config,
                                                 .numExtraStandbyTiles = 1000};
    *cut = (struct cut){0};
    rig_init(&cut->rig, 1024, &config, ROOM);
    cut->textures = must_allocate(p->textureCount * sizeof *cut->textures);
    cut->rects = must_allocate(p->textureCount * sizeof *cut->rects);
    cut->min_mip = must_allocate(1 << 18);
    size_t size = 0;
    slt_texture t;
    for (uint32_t i = 0; i < p->textureCount; i++) {
        slt_make_texture(p, i, &t);
        struct seen *seen = &cut->textures[i];
        *seen = (struct seen){.desc = desc_of(&t), .primary = t.primary};
        seen->id = rig_add(&cut->rig, &seen->desc);
        if (t.primary == i)
            size += (size_t)2 * t.fbW * t.fbH;
    }
    uint8_t *next = cut->maps = must_allocate(size);
    for (uint32_t i = 0; i < p->textureCount; i += p->setSize)
        for (uint32_t side = 0; side < 2; side++) {
            slt_make_texture(p, i, &t);
            slt_fill(p, &t, i, side * HALF_A_TURN, next);
            cut->textures[i].map[side] = map_for(&cut->textures[i].desc, next);
            next += (size_t)t.fbW * t.fbH;
        }
}

static void cut_finish(struct cut *cut)
{
    free(cut->textures);
    free(cut->rects);
    free(cut->min_mip);
    free(cut->maps);
    rig_finish(&cut->rig);
}

static void bring_maps(struct cut *cut, uint32_t side)
{
    for (uint32_t i = 0; i < cut_scene.textureCount; i += cut_scene.setSize) {
        const struct seen *seen = &cut->textures[i];
        rig_feedback(&cut->rig, seen->id, &seen->map[side], 0, TIMEOUT);
    }
}

static void bring_followers(struct cut *cut)
{
    for (uint32_t i = 0; i < cut_scene.textureCount; i++) {
        const struct seen *seen = &cut->textures[i];
        if (seen->primary != i)
            must(sluiceMatchPrimaryTexture(cut->rig.manager, cut->textures[seen->primary].id,
                                           seen->id, cut->rig.time, TIMEOUT),
                 "match");
    }
}

/** Reads all lists completely. Tiles to map stay in rig.tiles. */
static void read_lists(struct cut *cut)
{
    struct rig *rig = &cut->rig;
    uint32_t canceled = ROOM, unmapped = ROOM;
    cut->listed = ROOM;
    must(sluiceGetTilesToCancel(rig->manager, SLUICE_ALL_TEXTURES, &canceled, rig->tiles),
         "cancel");
    must(sluiceGetTilesToUnmap(rig->manager, SLUICE_ALL_TEXTURES, 0, &unmapped, rig->tiles),
         "unmap");
    must(sluiceGetTilesToMap(rig->manager, SLUICE_ALL_TEXTURES, &cut->listed, rig->tiles), "map");
    if (cut->listed == ROOM || unmapped == ROOM || canceled > 0)
        must(SLUICE_ERROR_INVALID_ARGUMENT, "lists of a camera cut");
}

static void write_min_mips(struct cut *cut)
{
    uint32_t count = cut_scene.textureCount;
    must(sluiceGetMinMipUpdates(cut->rig.manager, &count, cut->rects), "MinMip");
    for (uint32_t i = 0; i < count; i++)
        must(sluiceWriteMinMipRect(cut->rig.manager, &cut->rects[i], cut->rects[i].width, 1 << 18,
                                   cut->min_mip),
             "MinMip");
}

/** Runs a frame with a map of every primary. */
static struct parts frame(struct cut *cut, uint32_t side, uint64_t step)
{
    cut->rig.time += step;
    uint64_t t0 = now_ns();
    bring_maps(cut, side);
    uint64_t t1 = now_ns();
    bring_followers(cut);
    uint64_t t2 = now_ns();
    read_lists(cut);
    uint64_t t3 = now_ns();
    write_min_mips(cut);
    uint64_t t4 = now_ns();
    return (struct parts){(double)(t1 - t0), (double)(t2 - t1), (double)(t3 - t2),
                          (double)(t4 - t3)};
}

static int by_texture(const void *a, const void *b)
{
    const SluiceTile *x = a, *y = b;
    return x->textureId < y->textureId ? -1 : x->textureId > y->textureId;
}

/** Maps the tiles of the last frame, one call per texture, and updates the MinMip maps. */
static double arrive(struct cut *cut)
{
    qsort(cut->rig.tiles, cut->listed, sizeof *cut->rig.tiles, by_texture);
    uint64_t start = now_ns();
    rig_answer(&cut->rig, cut->listed);
    write_min_mips(cut);
    return (double)(now_ns() - start);
}

/** Repeats the view until the previous one has expired and been unmapped. */
static void settle(struct cut *cut, uint32_t side)
{
    for (uint32_t i = 0; i < 6; i++) {
        frame(cut, side, i == 0 ? 2 * TIMEOUT : STEP);
        arrive(cut);
    }
}

/**
 * Cuts there and back, `step` microseconds after the last map. After one frame the old view is
 * still held; after more than the timeout it is dropped in the same frame.
 */
static void time_cut(struct cut *cut, const char *name, uint64_t step)
{
    struct samples samples[6]; /* total, its four parts, arrival */
    static const char *const parts[] = {"total", "feedback", "follow", "lists", "min_mip"};
    enum { PARTS = sizeof parts / sizeof *parts };
    for (uint32_t i = 0; i <= PARTS; i++)
        samples_init(&samples[i], repetitions(10));
    settle(cut, 0);
    uint32_t listed = 0;
    for (uint32_t i = 0; i < samples[0].room; i++) {
        uint32_t side = (i + 1) % 2;
        struct parts p = frame(cut, side, step);
        listed = cut->listed;
        double part[PARTS] = {p.feedback + p.follow + p.lists + p.min_mip, p.feedback, p.follow,
                              p.lists, p.min_mip};
        for (uint32_t k = 0; k < PARTS; k++)
            samples_add(&samples[k], part[k]);
        samples_add(&samples[PARTS], arrive(cut));
        settle(cut, side);
    }
    char whole[64];
    for (uint32_t i = 0; i <= PARTS; i++) {
        snprintf(whole, sizeof whole, "%s.%s", name, i < PARTS ? parts[i] : "arrival");
        figure_times(whole, &samples[i]);
        samples_finish(&samples[i]);
    }
    figure(name, "requested", listed, "tiles");
}

void bench_cut(void)
{
    struct cut cut;
    cut_init(&cut);
    time_cut(&cut, "cut", FRAME);
    time_cut(&cut, "cut_lapsed", 2 * TIMEOUT);
    cut_finish(&cut);
}

/** Copies each map to a position of its own, as in the harness. */
static double copy_frame(const uint8_t *from, uint8_t *to, const size_t *sizes, uint32_t count)
{
    uint64_t start = now_ns();
    for (uint32_t i = 0; i < count; i++) {
        memcpy(to + ((size_t)i << 18), from + ((size_t)i << 18), sizes[i]);
        touched(to);
    }
    return (double)(now_ns() - start);
}

static void figure_floor(const char *path, struct samples *samples)
{
    const char *slash = strrchr(path, '/');
    char name[96];
    snprintf(name, sizeof name, "floor.%s", slash ? slash + 1 : path);
    char *suffix = strstr(name, ".slt");
    if (suffix)
        *suffix = '\0';
    figure_frames(name, samples);
}

void bench_floor(const char *path)
{
    slt_trace trace;
    if (!slt_open(&trace, path)) {
        fprintf(stderr, "cannot read the trace %s\n", path);
        exit(1);
    }
    uint32_t room = trace.p.texturesPerFrame;
    uint8_t *from = must_allocate((size_t)room << 18), *to = must_allocate((size_t)room << 18);
    size_t *sizes = must_allocate(room * sizeof *sizes);
    struct samples samples;
    samples_init(&samples, trace.p.frameCount);
    uint64_t time;
    uint32_t count, texture = 0;
    while (slt_next_frame(&trace, &time, &count)) {
        for (uint32_t i = 0; i < count; i++) {
            if (count > room || !slt_next_map(&trace, &texture, from + ((size_t)i << 18)))
                must(SLUICE_ERROR_CORRUPT_DATA, path);
            sizes[i] = (size_t)trace.tex[texture].fbW * trace.tex[texture].fbH;
        }
        samples_add(&samples, copy_frame(from, to, sizes, count));
    }
    figure_floor(path, &samples);
    samples_finish(&samples);
    free(from);
    free(to);
    free(sizes);
    free(trace.tex);
    free(trace.data);
}
