/**
 * Recordings that the viewer shows frame by frame. The oracles are a player that never jumps and
 * the text dump of sluiceReplay.
 */
#include "played.h"
#include "replay/random_app.h"
#include "support/test.h"

#include <dirent.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define STEPS 1500

static struct played *open_copy(const void *data, size_t size, size_t most_point_size)
{
    char *copy = malloc(size + 1);
    assert_non_null(copy);
    memcpy(copy, data, size);
    return played_open_bytes("test.trace", copy, size, most_point_size, NULL, NULL);
}

/* FNV-1a over all that the panels ask: decisions so far, statistics, and of each texture its tiles
 * with states and slots, its MinMip map and its requested levels. */
static uint64_t add_bytes(uint64_t digest, const void *data, size_t size)
{
    const uint8_t *bytes = data;
    for (size_t i = 0; i < size; i++)
        digest = (digest ^ bytes[i]) * UINT64_C(0x100000001B3);
    return digest;
}

static uint64_t add_texture(uint64_t digest, const SluiceStreamedTextureManager *manager,
                            SluiceTextureId id)
{
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    SluiceTextureStatistics statistics = {.structSize = sizeof statistics};
    static uint8_t map[1 << 16];
    CHECK_OK(sluiceGetTextureLayout(manager, id, &layout));
    CHECK_OK(sluiceGetTextureStatistics(manager, id, &statistics));
    const uint64_t fields[] = {/* not the struct: its padding is undefined */
                               statistics.residentTileCount,
                               statistics.requestedTileCount,
                               statistics.mappedTotal,
                               statistics.unmappedTotal,
                               statistics.failedTotal,
                               statistics.wanted,
                               statistics.seen,
                               statistics.seenTime,
                               statistics.wantedTileCount,
                               statistics.residentSize,
                               statistics.wantedSize};
    digest = add_bytes(digest, fields, sizeof fields);
    for (uint32_t tile = 0; tile < layout.tileCount; tile++) {
        SluiceTileState state;
        SluiceTile at;
        CHECK_OK(sluiceGetTileState(manager, id, tile, &state, &at));
        digest = add_bytes(add_bytes(digest, &state, sizeof state), &at, sizeof at);
    }
    const size_t size = (size_t)layout.minMipWidth * layout.minMipHeight;
    assert_true(size <= sizeof map);
    CHECK_OK(sluiceWriteMinMipData(manager, id, layout.minMipWidth, size, map));
    digest = add_bytes(digest, map, size);
    CHECK_OK(sluiceWriteRequestedLevels(manager, id, layout.minMipWidth, size, map));
    return add_bytes(digest, map, size);
}

static uint64_t digest_of(SluiceTracePlayer *player)
{
    SluiceStreamedTextureManager *manager;
    SluiceStreamedTextureStatistics now = {.structSize = sizeof now};
    SluiceTracePlayerState state = {.structSize = sizeof state};
    SluiceTextureId ids[RANDOM_APP_TEXTURES];
    uint32_t count = RANDOM_APP_TEXTURES;
    CHECK_OK(sluiceGetTracePlayerManager(player, &manager));
    CHECK_OK(sluiceGetStatistics(manager, &now));
    CHECK_OK(sluiceGetTracePlayerState(player, &state));
    CHECK_OK(sluiceGetTracePlayerTextures(player, &count, ids));
    now.hostMemorySize = 0; /* tables are larger than they need to be */
    uint64_t digest = add_bytes(state.decisionHash, &now, sizeof now);
    digest = add_bytes(digest, &state.eventCount, sizeof state.eventCount);
    for (uint32_t i = 0; i < count; i++)
        digest = add_texture(digest, manager, ids[i]);
    return digest;
}

/* Goes from the first call to the last one. Returns a digest at the end of each frame. */
static uint64_t *play_naively(const struct trace_buffer *trace, const struct played *p)
{
    const SluiceTracePlayerCreateInfo info = {
        .structSize = sizeof info, .pData = trace->data, .size = trace->size};
    uint64_t *digests = calloc(p->frame_count, sizeof *digests), calls = 0;
    SluiceTracePlayer *player;
    CHECK_OK(sluiceCreateTracePlayer(&info, &player));
    for (uint32_t frame = 0; frame < p->frame_count; frame++) {
        const uint64_t end =
            frame + 1 < p->frame_count ? p->frames[frame + 1].first_call : p->end.eventCount;
        for (; calls < end; calls++)
            CHECK_OK(sluicePlayTraceCall(player));
        digests[frame] = digest_of(player);
    }
    sluiceDestroyTracePlayer(player);
    return digests;
}

static void check_state(struct played *p, const uint64_t *digests, uint32_t frame)
{
    assert_true(played_go(p, frame));
    assert_int_equal(p->frame, frame);
    assert_true(digest_of(p->player) == digests[frame]);
}

static struct trace_buffer record_run(uint64_t seed)
{
    struct trace_buffer trace;
    if (seed % 2)
        record_late_run(&trace, seed, 60, STEPS);
    else
        record_random_run(&trace, seed, STEPS, false);
    return trace;
}

static void a_frame_has_the_state_of_a_player_that_never_jumped(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 6; seed++) {
        struct trace_buffer trace = record_run(seed);
        /* one checkpoint at most: only the first one stays */
        struct played *p = open_copy(trace.data, trace.size, seed % 3 == 2 ? 1 : 0);
        assert_non_null(p);
        assert_true(p->frame_count > 100);
        assert_int_equal(p->point_count == 1, seed % 3 == 2);
        uint64_t *digests = play_naively(&trace, p);
        uint32_t frame = 0;
        for (uint32_t jump = 0; jump < 60; jump++, frame = (frame * 31 + 17) % p->frame_count)
            check_state(p, digests, frame);
        for (frame = 0; frame < 20; frame++)
            check_state(p, digests, frame); /* step by step */
        check_state(p, digests, p->frame_count - 1);
        free(digests);
        played_close(p);
        trace_buffer_free(&trace);
    }
}

/* Forward, calls need memory now and then. */
static void frames_are_right_again_after_memory_was_short(void **state)
{
    (void)state;
    uint32_t failed = 0;
    for (uint64_t seed = 0; seed < 4; seed++) {
        struct trace_buffer trace = record_run(seed);
        struct played *p = open_copy(trace.data, trace.size, 0);
        uint64_t *digests = play_naively(&trace, p);
        for (uint32_t first = 0; first < p->frame_count; first += 50) {
            assert_true(played_go(p, first));
            const uint64_t left = p->memory_left;
            p->memory_left = 0;
            while (p->frame + 1 < p->frame_count && played_go(p, p->frame + 1))
                continue;
            failed += p->frame + 1 < p->frame_count;
            p->memory_left += left;
            check_state(p, digests, p->frame);
        }
        free(digests);
        played_close(p);
        trace_buffer_free(&trace);
    }
    assert_true(failed > 0);
}

static uint64_t sum_of(const struct played *p, enum played_figure figure)
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < p->frame_count; i++)
        sum += p->frames[i].figures[figure];
    return sum;
}

static void figures_of_frames_add_up_to_the_statistics_of_the_replay(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 6; seed += 2) { /* snapshots begin with totals */
        struct trace_buffer trace = record_run(seed);
        SluiceStreamedTextureStatistics s = {.structSize = sizeof s};
        SluiceReplayResult result = {.structSize = sizeof result};
        const SluiceReplayInfo info = {
            .structSize = sizeof info, .pData = trace.data, .size = trace.size, .pStatistics = &s};
        struct played *p = open_copy(trace.data, trace.size, 0);
        CHECK_OK(sluiceReplay(&info, &result));
        assert_int_equal(sum_of(p, PLAYED_LISTED), s.handedOutTotal);
        assert_int_equal(sum_of(p, PLAYED_LOADED), s.mappedTotal);
        assert_int_equal(sum_of(p, PLAYED_EVICTED), s.unmappedTotal);
        assert_int_equal(sum_of(p, PLAYED_CANCELED), s.canceledTotal);
        assert_int_equal(sum_of(p, PLAYED_FAILED), s.failedTotal);
        assert_int_equal(sum_of(p, PLAYED_RESTORED), s.restoredTotal);
        const uint32_t *last = p->frames[p->frame_count - 1].figures;
        assert_int_equal(last[PLAYED_REQUESTED], s.requestedTileCount);
        assert_int_equal(last[PLAYED_LOADING], s.allocatedTileCount);
        assert_int_equal(last[PLAYED_RESIDENT], s.mappedTileCount);
        assert_int_equal(last[PLAYED_STANDBY], s.standbyTileCount);
        assert_int_equal(last[PLAYED_HEAPS], s.heapCount);
        assert_true(p->end.decisionHash == result.decisionHash);
        played_close(p);
        trace_buffer_free(&trace);
    }
}

/* Counts of each frame in the dump, whose calls are known by their numbers. */
struct dumped {
    const struct played *p;
    uint32_t *maps, *refused;
    uint32_t frame;
    bool is_map;
};

static void count_line(void *user, const char *line)
{
    struct dumped *d = user;
    uint64_t event;
    char word[64] = "", rest[64] = "";
    if (sscanf(line, "%" SCNu64 " %63s %63s", &event, word, rest) < 2)
        return;
    while (d->frame + 1 < d->p->frame_count && event > d->p->frames[d->frame + 1].first_call)
        d->frame++;
    if (strcmp(word, "=") != 0 && strcmp(word, "map") != 0)
        d->is_map = strcmp(word, "update-feedback") == 0;
    if (strcmp(word, "=") == 0 && d->is_map && !strstr(rest, "ERROR"))
        d->maps[d->frame]++;
    if (strcmp(word, "allocate-heap") == 0 && strstr(rest, "ERROR"))
        d->refused[d->frame]++;
}

static void maps_and_refused_heaps_are_those_of_the_dump(void **state)
{
    (void)state;
    uint32_t refused = 0;
    for (uint64_t seed = 0; seed < 4; seed++) {
        struct trace_buffer trace = record_run(seed);
        struct played *p = open_copy(trace.data, trace.size, 0);
        struct dumped d = {.p = p,
                           .maps = calloc(p->frame_count, sizeof *d.maps),
                           .refused = calloc(p->frame_count, sizeof *d.refused)};
        SluiceReplayResult result = {.structSize = sizeof result};
        const SluiceReplayInfo info = {.structSize = sizeof info,
                                       .pData = trace.data,
                                       .size = trace.size,
                                       .pUserData = &d,
                                       .pfnLine = count_line};
        CHECK_OK(sluiceReplay(&info, &result));
        for (uint32_t i = 0; i < p->frame_count; i++) {
            assert_int_equal(p->frames[i].figures[PLAYED_MAPS], d.maps[i]);
            assert_int_equal(p->frames[i].figures[PLAYED_REFUSED], d.refused[i]);
            refused += d.refused[i];
        }
        free(d.maps);
        free(d.refused);
        played_close(p);
        trace_buffer_free(&trace);
    }
    assert_true(refused > 0);
}

static void check_same_log(const struct played *a, const struct played *b)
{
    assert_int_equal(a->log.loads, b->log.loads);
    assert_int_equal(a->log.stale, b->log.stale);
    assert_memory_equal(a->log.waits, b->log.waits, sizeof a->log.waits);
    assert_memory_equal(a->log.stages->queue, b->log.stages->queue, sizeof a->log.waits);
    assert_memory_equal(a->log.stages->load, b->log.stages->load, sizeof a->log.waits);
    for (uint32_t i = 0; i < a->texture_count; i++)
        for (uint32_t tile = 0; tile < a->textures[i].tile_count; tile++)
            assert_memory_equal(tile_log_get(&a->log, a->textures[i].id, tile),
                                tile_log_get(&b->log, a->textures[i].id, tile),
                                sizeof(struct tile_log_tile));
    assert_int_equal(a->timeout, b->timeout);
    assert_int_equal(a->event_count, b->event_count);
    for (uint32_t age = 1; age <= a->event_count; age++)
        assert_memory_equal(&a->events[(a->event_next + PLAYED_EVENTS - age) % PLAYED_EVENTS],
                            &b->events[(b->event_next + PLAYED_EVENTS - age) % PLAYED_EVENTS],
                            sizeof *a->events);
}

/* `steps` goes from frame to frame; `jumps` comes from anywhere. */
static void events_loads_and_waits_are_the_same_after_a_jump(void **state)
{
    (void)state;
    struct trace_buffer trace = record_run(9);
    struct played *steps = open_copy(trace.data, trace.size, 0);
    struct played *jumps = open_copy(trace.data, trace.size, 0);
    assert_true(steps->log.loads < 5);
    for (uint32_t frame = 0; frame < steps->frame_count; frame += 13) {
        while (steps->frame < frame)
            assert_true(played_go(steps, steps->frame + 1));
        assert_true(played_go(jumps, frame * 7 % jumps->frame_count));
        assert_true(played_go(jumps, frame));
        check_same_log(steps, jumps);
    }
    assert_true(steps->log.loads > 50);
    played_close(steps);
    played_close(jumps);
    trace_buffer_free(&trace);
}

static void a_search_finds_the_next_frame_that_has_some(void **state)
{
    (void)state;
    struct trace_buffer trace = record_run(2);
    struct played *p = open_copy(trace.data, trace.size, 0);
    static const enum played_figure figures[] = {PLAYED_FAILED, PLAYED_LOST, PLAYED_EVICTED};
    for (int i = 0; i < 3; i++) {
        uint32_t found = 0, frames = p->frames[0].figures[figures[i]] > 0;
        for (uint32_t at = 0; (at = played_find(p, at, figures[i], 1)) != UINT32_MAX;) {
            assert_true(p->frames[at].figures[figures[i]] > 0);
            assert_true(at > found);
            found = at;
            frames++;
        }
        for (uint32_t at = 0; at < p->frame_count; at++)
            frames -= p->frames[at].figures[figures[i]] > 0;
        assert_int_equal(frames, 0);
        assert_true(found > 0);
        uint32_t before = played_find(p, found, figures[i], -1);
        assert_true(before == UINT32_MAX || played_find(p, before, figures[i], 1) == found);
    }
    const uint32_t longest = played_longest(p);
    for (uint32_t i = 0; i < p->frame_count; i++)
        assert_true(p->frames[i].figures[PLAYED_MICROSECONDS] <=
                    p->frames[longest].figures[PLAYED_MICROSECONDS]);
    played_close(p);
    trace_buffer_free(&trace);
}

static void a_cut_recording_shows_the_frames_before_the_cut(void **state)
{
    (void)state;
    struct trace_buffer trace = record_run(4);
    struct played *whole = open_copy(trace.data, trace.size, 0);
    assert_false(whole->damaged);
    for (size_t cut = 0; cut < trace.size; cut += 1009) {
        struct played *p = open_copy(trace.data, cut, 0);
        if (!p)
            continue;
        assert_true(p->damaged && p->message[0]);
        assert_true(p->frame_count <= whole->frame_count);
        for (uint32_t i = 0; i + 1 < p->frame_count; i++)
            assert_memory_equal(p->frames[i].figures, whole->frames[i].figures,
                                sizeof p->frames[i].figures);
        assert_true(played_go(p, p->frame_count - 1) && played_go(p, 0));
        played_close(p);
    }
    played_close(whole);
    trace_buffer_free(&trace);
}

static void walk(struct played *p)
{
    for (uint32_t i = 0; p && i < 8; i++)
        assert_true(played_go(p, i * 5 % p->frame_count));
    played_close(p);
}

static void files_of_the_fuzzer_are_shown_or_refused(void **state)
{
    (void)state;
    char path[4096], data[1 << 16];
    uint32_t files = 0, shown = 0;
    snprintf(path, sizeof path, "%s/tests/fuzz/corpus/replay", getenv("SLUICE_SOURCE_ROOT"));
    DIR *folder = opendir(path);
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder));) {
        char name[8192];
        snprintf(name, sizeof name, "%s/%s", path, entry->d_name);
        FILE *file = entry->d_name[0] != '.' ? fopen(name, "rb") : NULL;
        if (!file)
            continue;
        const size_t size = fread(data, 1, sizeof data, file);
        fclose(file);
        struct played *p = size > 1 ? open_copy(data + 1, size - 1, 0) : NULL;
        files++;
        shown += p != NULL;
        walk(p);
    }
    closedir(folder);
    assert_true(files > 100 && shown > 0 && shown < files);
}

/* Textures of 16384 x 16384 texels in tiles of 128 x 128. */
static struct trace_buffer record_large_textures(uint32_t count)
{
    static const SluiceStreamedTextureDesc desc = {.width = 16384,
                                                   .height = 16384,
                                                   .mipLevelCount = 8,
                                                   .regularMipCount = 8,
                                                   .tileWidth = 128,
                                                   .tileHeight = 128};
    struct random_app app;
    struct trace_buffer trace;
    SluiceRecorder *recorder;
    SluiceTextureId id;
    const SluiceRecordWriter writer = trace_buffer_writer(&trace);
    random_app_init(&app, 1, false);
    CHECK_OK(sluiceBeginRecording(app.manager, &writer, NULL, &recorder));
    for (uint32_t i = 0; i < count; i++)
        CHECK_OK(sluiceAddStreamedTexture(app.manager, &desc, &id));
    CHECK_OK(sluiceEndRecording(recorder));
    random_app_finish(&app);
    return trace;
}

static void a_small_file_of_very_many_tiles_is_refused(void **state)
{
    (void)state;
    struct trace_buffer trace = record_large_textures(100);
    struct played *p = open_copy(trace.data, trace.size, 0);
    assert_non_null(p);
    assert_int_equal(p->texture_count, 100);
    played_close(p);
    trace_buffer_free(&trace);
    trace = record_large_textures(2500);
    assert_true(trace.size < 100000);
    assert_null(open_copy(trace.data, trace.size, 0));
    trace_buffer_free(&trace);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_frame_has_the_state_of_a_player_that_never_jumped),
        cmocka_unit_test(frames_are_right_again_after_memory_was_short),
        cmocka_unit_test(figures_of_frames_add_up_to_the_statistics_of_the_replay),
        cmocka_unit_test(maps_and_refused_heaps_are_those_of_the_dump),
        cmocka_unit_test(events_loads_and_waits_are_the_same_after_a_jump),
        cmocka_unit_test(a_search_finds_the_next_frame_that_has_some),
        cmocka_unit_test(a_cut_recording_shows_the_frames_before_the_cut),
        cmocka_unit_test(files_of_the_fuzzer_are_shown_or_refused),
        cmocka_unit_test(a_small_file_of_very_many_tiles_is_refused),
    };
    return RUN_TESTS(tests);
}
