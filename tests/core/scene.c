#include "core/scene.h"

#include "core/check.h"

#include <stdlib.h>
#include <string.h>

/* Textures and windows ---------------------------------------------------------------------- */

void scene_configure(struct scene *s)
{
    CHECK_OK(sluiceSetConfig(s->f.manager, &s->config));
}

static void open_scene(struct scene *s, uint32_t heap_capacity, uint32_t heap_count, bool packed)
{
    memset(s, 0, sizeof *s);
    fixture_open(&s->f, heap_capacity, packed);
    s->config.structSize = sizeof s->config;
    s->config.maxHeapCount = heap_count;
    scene_configure(s);
    s->maps_per_frame = 8;
    s->load_frames = s->retire_frames = 2;
    s->loads_per_frame = 64;
    s->timeout_frames = 16;
}

void scene_open(struct scene *s, uint32_t heap_capacity, uint32_t heap_count)
{
    open_scene(s, heap_capacity, heap_count, false);
}

void scene_open_packed(struct scene *s, uint32_t heap_capacity, uint32_t heap_count)
{
    open_scene(s, heap_capacity, heap_count, true);
}

static void *zeroed(size_t size)
{
    void *p = calloc(1, size);
    assert_non_null(p);
    return p;
}

struct scene_texture *scene_add(struct scene *s, uint32_t size, struct scene_window window)
{
    assert_true(s->texture_count < SCENE_TEXTURES);
    struct scene_texture *t = &s->textures[s->texture_count++];
    SluiceStreamedTextureDesc desc = full_chain(size, size, 128, 128);
    *t = (struct scene_texture){.id = fixture_add(&s->f, &desc), .window = window};
    t->layout = fixture_layout(&s->f, t->id);
    size_t regions = (size_t)t->layout.feedbackWidth * t->layout.feedbackHeight;
    t->uploads = zeroed(t->layout.tileCount);
    t->min_mip = zeroed(regions);
    memset(t->min_mip, SLUICE_MIP_UNTOUCHED, regions);
    t->feedback = zeroed(regions);
    return t;
}

static void forget_texture(struct scene_texture *t)
{
    free(t->uploads);
    free(t->min_mip);
    free(t->feedback);
    *t = (struct scene_texture){.id = SLUICE_NO_TEXTURE};
}

void scene_remove(struct scene *s, struct scene_texture *t)
{
    CHECK_OK(sluiceRemoveStreamedTexture(s->f.manager, t->id, s->frame));
    uint32_t kept = 0;
    for (uint32_t i = 0; i < s->load_count; i++)
        if (s->loads[i].id != t->id)
            s->loads[kept++] = s->loads[i];
    s->load_count = kept;
    forget_texture(t);
}

void scene_close(struct scene *s)
{
    for (uint32_t i = 0; i < s->texture_count; i++)
        forget_texture(&s->textures[i]);
    const char *wrong = slc_manager_check(s->f.manager);
    assert_string_equal(wrong ? wrong : "", "");
    fixture_close(&s->f);
}

static struct scene_texture *find(struct scene *s, SluiceTextureId id)
{
    for (uint32_t i = 0; i < s->texture_count; i++)
        if (s->textures[i].id == id)
            return &s->textures[i];
    fail_msg("a texture that is not there is listed");
    return NULL;
}

uint8_t scene_wanted(const struct scene_texture *t, uint32_t x, uint32_t y)
{
    const struct scene_window *w = &t->window;
    if (x < w->x || x - w->x >= w->width || y < w->y || y - w->y >= w->height)
        return SLUICE_MIP_UNTOUCHED;
    if (!w->rings)
        return w->level;
    int32_t dx = (int32_t)(2 * (x - w->x) + 1) - (int32_t)w->width;
    int32_t dy = (int32_t)(2 * (y - w->y) + 1) - (int32_t)w->height;
    uint32_t away = (uint32_t)(abs(dx) > abs(dy) ? abs(dx) : abs(dy)) / 2;
    return (uint8_t)(w->level + away / w->rings);
}

/* Frames ------------------------------------------------------------------------------------ */

static uint32_t hash(uint32_t a, uint32_t b, uint32_t c)
{
    uint64_t state = ((uint64_t)a << 40) ^ ((uint64_t)b << 20) ^ c;
    next_random(&state);
    state ^= state >> 29;
    next_random(&state);
    state ^= state >> 31;
    return next_random(&state);
}

static void feed(struct scene *s, struct scene_texture *t)
{
    const SluiceStreamedTextureLayout *l = &t->layout;
    uint32_t at = (uint32_t)(t - s->textures), region = 0;
    for (uint32_t y = 0; y < l->feedbackHeight; y++) {
        for (uint32_t x = 0; x < l->feedbackWidth; x++, region++) {
            bool missed = s->missing && hash(at, t->maps, region) % 100 < s->missing;
            t->feedback[region] = missed ? SLUICE_MIP_UNTOUCHED : scene_wanted(t, x, y);
        }
    }
    t->maps++;
    fixture_feed_map(&s->f, t->id, t->feedback, s->frame * SCENE_TICKS,
                     (uint64_t)s->timeout_frames * SCENE_TICKS);
}

static void feed_some(struct scene *s)
{
    uint32_t fed = 0;
    for (uint32_t i = 0; i < s->texture_count && fed < s->maps_per_frame; i++) {
        struct scene_texture *t = &s->textures[s->next++ % s->texture_count];
        if (t->id == SLUICE_NO_TEXTURE || t->silent)
            continue;
        feed(s, t);
        fed++;
    }
}

static void end_load(struct scene *s, uint32_t at)
{
    memmove(&s->loads[at], &s->loads[at + 1], (--s->load_count - at) * sizeof *s->loads);
}

static void answer(struct scene *s)
{
    uint32_t done = 0;
    for (; done < s->load_count && s->loads[done].due <= s->frame; done++)
        CHECK_OK(
            sluiceUpdateTilesMapping(s->f.manager, s->loads[done].id, 1, &s->loads[done].tile));
    s->load_count -= done;
    memmove(s->loads, &s->loads[done], s->load_count * sizeof *s->loads);
}

static void cancel(struct scene *s)
{
    CHECK_OK(fixture_to_cancel(&s->f, SLUICE_ALL_TEXTURES));
    for (uint32_t i = 0; i < s->f.count; i++) {
        const SluiceTile *tile = &s->f.tiles[i];
        CHECK_OK(sluiceReportCanceledTiles(s->f.manager, tile->textureId, 1, &tile->tileIndex, 0));
        uint32_t at = 0;
        while (s->loads[at].id != tile->textureId || s->loads[at].tile != tile->tileIndex)
            assert_true(++at < s->load_count);
        end_load(s, at);
    }
}

static void hand_out(struct scene *s)
{
    uint32_t room = FIXTURE_ROOM - s->load_count;
    room = room < s->loads_per_frame ? room : s->loads_per_frame;
    assert_true(fixture_to_map_at_most(&s->f, SLUICE_ALL_TEXTURES, room) >= 0);
    for (uint32_t i = 0; i < s->f.count; i++) {
        const SluiceTile *tile = &s->f.tiles[i];
        struct scene_texture *t = find(s, tile->textureId);
        t->uploads[tile->tileIndex] += t->uploads[tile->tileIndex] < 255;
        s->loads[s->load_count++] =
            (struct scene_load){tile->textureId, tile->tileIndex, s->frame + s->load_frames};
    }
    s->uploads += s->f.count;
}

static void publish(struct scene *s)
{
    SluiceMinMipRect rects[SCENE_TEXTURES];
    uint32_t count = SCENE_TEXTURES;
    CHECK_OK(sluiceGetMinMipUpdates(s->f.manager, &count, rects));
    for (uint32_t i = 0; i < count; i++) {
        struct scene_texture *t = find(s, rects[i].textureId);
        uint32_t width = t->layout.minMipWidth;
        size_t first = (size_t)rects[i].y * width + rects[i].x;
        CHECK_OK(sluiceWriteMinMipRect(s->f.manager, &rects[i], width,
                                       (size_t)width * t->layout.minMipHeight - first,
                                       t->min_mip + first));
    }
}

static void release_heaps(struct scene *s)
{
    uint32_t ids[FIXTURE_HEAPS], count = FIXTURE_HEAPS;
    CHECK_OK(sluiceGetEmptyHeaps(s->f.manager, &count, ids));
    for (uint32_t i = 0; i < count; i++)
        CHECK_OK(sluiceReleaseHeap(s->f.manager, ids[i]));
}

static void run_frame(struct scene *s)
{
    s->frame++;
    if (s->frame > s->retire_frames)
        CHECK_OK(sluiceCompleteRetireValue(s->f.manager, s->frame - s->retire_frames));
    answer(s);
    if (s->texture_count)
        feed_some(s);
    cancel(s);
    CHECK_OK(fixture_to_unmap(&s->f, SLUICE_ALL_TEXTURES, s->frame));
    s->unmapped += s->f.count;
    hand_out(s);
    publish(s);
    if (s->releases_heaps)
        release_heaps(s);
}

void scene_run(struct scene *s, uint32_t frames)
{
    for (uint32_t i = 0; i < frames; i++)
        run_frame(s);
}

/* Looking ----------------------------------------------------------------------------------- */

void scene_rest(struct scene *s)
{
    for (uint32_t i = 0; i < s->texture_count; i++)
        if (s->textures[i].id)
            memset(s->textures[i].uploads, 0, s->textures[i].layout.tileCount);
}

uint32_t scene_most_uploads(const struct scene *s)
{
    uint32_t most = 0;
    for (uint32_t i = 0; i < s->texture_count; i++)
        for (uint32_t k = 0; s->textures[i].id && k < s->textures[i].layout.tileCount; k++)
            most = s->textures[i].uploads[k] > most ? s->textures[i].uploads[k] : most;
    return most;
}

uint32_t scene_round(const struct scene *s)
{
    return (s->texture_count + s->maps_per_frame - 1) / s->maps_per_frame;
}

uint32_t scene_deficit(const struct scene_texture *t)
{
    uint32_t sum = 0, regions = 0;
    for (uint32_t y = 0; y < t->layout.minMipHeight; y++) {
        for (uint32_t x = 0; x < t->layout.minMipWidth; x++) {
            uint32_t shown = t->min_mip[y * t->layout.minMipWidth + x];
            uint32_t wanted = scene_wanted(t, x, y), packed = t->layout.desc.regularMipCount;
            if (wanted == SLUICE_MIP_UNTOUCHED)
                continue;
            shown = shown == SLUICE_MIP_UNTOUCHED ? packed + 1 : shown;
            wanted = wanted < packed ? wanted : packed;
            sum += shown > wanted ? shown - wanted : 0;
            regions++;
        }
    }
    return regions ? 1000 * sum / regions : 0;
}

uint32_t scene_mean_deficit(const struct scene *s)
{
    uint32_t sum = 0, count = 0;
    for (uint32_t i = 0; i < s->texture_count; i++) {
        if (s->textures[i].id == SLUICE_NO_TEXTURE || !s->textures[i].window.width)
            continue;
        sum += scene_deficit(&s->textures[i]);
        count++;
    }
    return count ? sum / count : 0;
}

bool scene_shows_something(const struct scene_texture *t)
{
    for (uint32_t y = 0; y < t->layout.minMipHeight; y++)
        for (uint32_t x = 0; x < t->layout.minMipWidth; x++)
            if (scene_wanted(t, x, y) != SLUICE_MIP_UNTOUCHED &&
                t->min_mip[y * t->layout.minMipWidth + x] == SLUICE_MIP_UNTOUCHED)
                return false;
    return true;
}

uint32_t scene_tiles_in(const struct scene *s, const struct scene_texture *t, SluiceTileState state)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < t->layout.tileCount; i++)
        count += fixture_state(&s->f, t->id, i) == state;
    return count;
}

uint32_t scene_working_set(const struct scene *s)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->texture_count; i++) {
        const struct scene_texture *t = &s->textures[i];
        const SluiceStreamedTextureLayout *l = &t->layout;
        count += t->window.width ? l->desc.packedTileCount : 0;
        for (uint32_t k = 0; k < l->desc.regularMipCount; k++) {
            for (uint32_t tile = 0; tile < l->levelWidthInTiles[k] * l->levelHeightInTiles[k];
                 tile++) {
                uint32_t width = l->levelWidthInTiles[k], edge = 1u << k;
                uint32_t x0 = tile % width * edge, y0 = tile / width * edge;
                bool wanted = false;
                for (uint32_t at = 0; at < edge * edge && !wanted; at++)
                    wanted = scene_wanted(t, x0 + at % edge, y0 + at / edge) <= k;
                count += wanted;
            }
        }
    }
    return count;
}
