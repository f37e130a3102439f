/* A week of a moving camera. The memory in use stays constant, and every invariant holds. */
#include "core/sound.h"
#include "extremes/note.h"

#include "core/check.h"

#include <math.h>
#include <stdlib.h>

enum { TEXTURES = 32, IN_VIEW = 6, LOADS = 256, REGIONS = 1024 };

/* Ten million frames in a week, in microseconds. */
static const uint64_t frame_time = 60480;
static const uint64_t week_frames = 10000000;

static uint64_t frame_count = 300000;

/* Frames until the slowest turn of the camera has met most positions of the others. */
static const uint64_t warm_up = 100000;

struct soak {
    struct fixture f;
    SluiceTextureId ids[TEXTURES];
    uint64_t random, frame;
    uint32_t loading;
    SluiceTile loads[LOADS];
    uint8_t map[REGIONS];
};

static SluiceStreamedTextureDesc shape_of(uint32_t texture)
{
    static const uint32_t shapes[][2] = {{4096, 2048}, {2048, 2048}, {3001, 1999}, {700, 4000}};
    return full_chain(shapes[texture % 4][0], shapes[texture % 4][1], 128, 128);
}

static void add_texture(struct soak *s, uint32_t texture)
{
    SluiceStreamedTextureDesc desc = shape_of(texture);
    s->ids[texture] = fixture_add(&s->f, &desc);
    if (texture % 8 == 7) /* its own neighbor's follower */
        CHECK_OK(sluiceSetPrimaryTexture(s->f.manager, s->ids[texture], s->ids[texture - 1]));
}

/* Returns a coordinate of the camera along a row of pictures: a sum of three periods without a
 * common one. */
static double position(uint64_t frame)
{
    double t = (double)frame;
    return TEXTURES * (0.5 + 0.3 * sin(t / 997) + 0.15 * sin(t / 311.7) + 0.049 * sin(t / 47.3));
}

static double distance(uint64_t frame)
{
    return 2.2 + 1.5 * sin((double)frame / 613.1) + 0.6 * sin((double)frame / 83.9);
}

/* A window of the picture, finer where the camera is nearer, with holes as few pixels make. */
static void draw_map(struct soak *s, const SluiceStreamedTextureLayout *layout, double aside)
{
    uint32_t w = layout->feedbackWidth, h = layout->feedbackHeight;
    double near = distance(s->frame) + fabs(aside) / 2;
    uint32_t level = near < 0 ? 0 : (uint32_t)near;
    uint32_t left = (uint32_t)((0.5 + 0.4 * sin((double)s->frame / 71)) * w * 0.6);
    uint32_t top = (uint32_t)((0.5 + 0.4 * cos((double)s->frame / 133)) * h * 0.6);
    memset(s->map, SLUICE_MIP_UNTOUCHED, (size_t)w * h);
    for (uint32_t y = top; y < h && y < top + h / 3 + 1; y++)
        for (uint32_t x = left; x < w && x < left + w / 3 + 1; x++)
            if (next_random(&s->random) % 4)
                s->map[y * w + x] = (uint8_t)(level + next_random(&s->random) % 2);
}

/* Feeds two maps a frame, in turns, of the textures in view. Textures that just left the view get
 * an empty map. */
static void feed(struct soak *s)
{
    double at = position(s->frame);
    for (uint32_t i = 0; i < 2; i++) {
        int32_t offset = (int32_t)((s->frame * 2 + i) % (IN_VIEW + 2)) - IN_VIEW / 2 - 1;
        int32_t texture = (int32_t)at + offset;
        if (texture < 0 || texture >= TEXTURES || texture % 8 == 7)
            continue;
        SluiceTextureId id = s->ids[texture];
        SluiceStreamedTextureLayout layout = fixture_layout(&s->f, id);
        assert_true(layout.feedbackWidth * layout.feedbackHeight <= REGIONS);
        draw_map(s, &layout, at - texture);
        if (abs(offset) > IN_VIEW / 2)
            memset(s->map, SLUICE_MIP_UNTOUCHED, sizeof s->map);
        fixture_feed_map(&s->f, id, s->map, s->frame * frame_time, 40 * frame_time);
    }
}

static void drop_load(struct soak *s, uint32_t i)
{
    s->loads[i] = s->loads[--s->loading];
}

/* Loads end after some frames, in any order, one in fifty badly. */
static void answer(struct soak *s)
{
    for (uint32_t i = 0; i < s->loading;) {
        SluiceTextureId id = s->loads[i].textureId;
        uint32_t tile = s->loads[i].tileIndex, dice = next_random(&s->random) % 150;
        if (dice >= 53) {
            i++;
            continue;
        }
        if (dice == 0)
            CHECK_OK(sluiceReportFailedTiles(s->f.manager, id, 1, &tile, s->frame * frame_time));
        else if (dice < 3)
            CHECK_OK(sluiceReportCanceledTiles(s->f.manager, id, 1, &tile, s->frame + 1));
        else
            CHECK_OK(sluiceUpdateTilesMapping(s->f.manager, id, 1, &tile));
        drop_load(s, i);
    }
}

/* A picture is taken down and another of its size hung up: its loads are over with it. */
static void replace_texture(struct soak *s)
{
    uint32_t texture = next_random(&s->random) % (TEXTURES / 8) * 8 + next_random(&s->random) % 6;
    for (uint32_t i = 0; i < s->loading;)
        if (s->loads[i].textureId == s->ids[texture])
            drop_load(s, i);
        else
            i++;
    CHECK_OK(sluiceRemoveStreamedTexture(s->f.manager, s->ids[texture], s->frame + 1));
    add_texture(s, texture);
}

static void take_updates(struct soak *s)
{
    SluiceMinMipRect rects[64];
    uint32_t count = 64;
    assert_true(sluiceGetMinMipUpdates(s->f.manager, &count, rects) >= 0);
    count = 16;
    assert_true(sluiceGetGivenUpTiles(s->f.manager, &count, s->f.tiles) >= 0);
    if (count)
        CHECK_OK(sluiceRetryFailedTiles(s->f.manager, SLUICE_ALL_TEXTURES));
    if (s->frame % 200 == 0) {
        SluiceTileMove moves[32];
        count = 32;
        CHECK_OK(sluiceDefragmentTiles(s->f.manager, s->frame + 1, &count, moves));
    }
}

static void run_frame(struct soak *s)
{
    s->frame++;
    CHECK_OK(sluiceCompleteRetireValue(s->f.manager, s->frame - 1));
    feed(s);
    CHECK_OK(fixture_to_cancel(&s->f, SLUICE_ALL_TEXTURES));
    answer(s);
    CHECK_OK(fixture_to_unmap(&s->f, SLUICE_ALL_TEXTURES, s->frame + 1));
    uint32_t room = LOADS - s->loading < 32 ? LOADS - s->loading : 32;
    assert_true(fixture_to_map_at_most(&s->f, SLUICE_ALL_TEXTURES, room) >= 0);
    memcpy(s->loads + s->loading, s->f.tiles, s->f.count * sizeof *s->loads);
    s->loading += s->f.count;
    take_updates(s);
    if (s->frame % 997 == 0)
        replace_texture(s);
}

static void open_soak(struct soak *s)
{
    *s = (struct soak){.random = 2024};
    fixture_open(&s->f, 64, false);
    s->f.heaps.limit = 12; /* too few for the nearest views */
    const SluiceStreamedTextureManagerConfig config = {.structSize = sizeof config,
                                                       .numExtraStandbyTiles = 64,
                                                       .retryDelayTicks = 3 * frame_time,
                                                       .maxLoadAttempts = 3,
                                                       .prefetchLevels = 1};
    CHECK_OK(sluiceSetConfig(s->f.manager, &config));
    for (uint32_t i = 0; i < TEXTURES; i++)
        add_texture(s, i);
}

static uint64_t larger(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

/* Checks that the camera moved enough to make the result meaningful. */
static void check_activity(const struct fixture *f)
{
    SluiceStreamedTextureStatistics s = fixture_statistics(f);
    assert_true(s.mappedTotal > frame_count && s.unmappedTotal > frame_count);
    assert_true(s.failedTotal > frame_count / 100 && s.restoredTotal > frame_count / 100);
    assert_true(s.canceledTotal > frame_count / 1000);
    assert_true(f->heaps.refused > 0);
}

static void a_week_of_a_moving_camera_takes_no_more_memory_than_its_first_hours(void **state)
{
    (void)state;
    static struct soak s;
    uint64_t early = 0, late = 0, resident = 0;
    open_soak(&s);
    for (uint64_t i = 0; i < frame_count; i++) {
        run_frame(&s);
        uint64_t *peak = i < warm_up ? &early : &late;
        *peak = larger(*peak, s.f.memory.live_bytes);
        if (i == warm_up)
            resident = resident_size();
        if (i % (frame_count / 100) == 0) {
            assert_null(slc_manager_check(s.f.manager));
            assert_true(fixture_statistics(&s.f).hostMemorySize == s.f.memory.live_bytes);
        }
    }
    check_activity(&s.f);
    uint64_t grown = resident_size();
    note("soak: bytes of the manager, against its first hours", frame_count, (double)late,
         (double)early);
    note("soak: bytes of the process, against its first hours", frame_count, (double)grown,
         (double)resident + (1 << 20));
    assert_true(late <= early);
    assert_true(grown <= resident + (1 << 20));
    fixture_close(&s.f);
}

int main(int argc, char **argv)
{
    if (is_long(argc, argv))
        frame_count = week_frames;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_week_of_a_moving_camera_takes_no_more_memory_than_its_first_hours),
    };
    return RUN_TESTS(tests);
}
