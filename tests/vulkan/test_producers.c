/* Tiles filled by the application's commands: requests for texels, and the time when tiles are
 * shown. */
#include "vulkan/fake_vulkan.h"

#include "support/failing_allocator.h"
#include "support/streamer_manager.h"
#include "support/test.h"

#include <stdio.h>
#include <string.h>

enum { SIZE = 512, TILES = SIZE / FAKE_TILE, LEVELS = 10, MANAGER_ATTEMPTS = 5, CALLS = 4096 };

static const SluiceResidencyMode modes[] = {
    SLUICE_RESIDENCY_MODE_SPARSE, SLUICE_RESIDENCY_MODE_PAGED, SLUICE_RESIDENCY_MODE_DENSE};
enum { MODES = sizeof modes / sizeof *modes };

/* A tile of a batch. */
struct call {
    SluiceTextureId id;
    VkImage image;
    VkImageView view;
    uint32_t image_level;
    uint64_t frame;
    SluiceTileTarget target;
    SluiceResult answer;
};

struct fixture {
    struct fake_vulkan fake;
    SluiceVulkanStreamer *streamer;
    SluiceVulkanTexture texture;
    SluiceStreamingFrame frame; ///< the last one
    uint64_t time;
    uint32_t warnings;
    char last_warning[256];
    uint8_t wanted;         ///< requested level of all regions
    bool stuck;             ///< true: the GPU completes no more frames
    bool removes;           ///< true: the callback removes the texture, which is forbidden
    uint32_t failing_level; ///< failing level of the mip tail; 0: none
    /** Answers for level 0 tiles in the upper left quarter, for all other texels, and for the
     * batch. */
    SluiceResult first_answer, answer, batch_answer;
    struct call calls[CALLS];
    uint32_t call_count, batch_count;
    uint32_t tiles_per_frame; ///< this and later fields are set before setup; 0: default
    uint32_t timeout;
    const SluiceAllocationCallbacks *cb;
};

static uint8_t want(void *user, uint32_t region)
{
    (void)region;
    return ((struct fixture *)user)->wanted;
}

static void on_log(void *user, SluiceLogSeverity severity, const char *message)
{
    struct fixture *f = user;
    if (severity != SLUICE_LOG_WARNING)
        return;
    f->warnings++;
    snprintf(f->last_warning, sizeof f->last_warning, "%s", message);
}

static bool is_first(const SluiceImageRegion *region)
{
    return region->mipLevel == 0 && region->x < SIZE / 2 && region->y < SIZE / 2;
}

static SluiceResult record_tiles(void *user, const SluiceTileBatch *batch, SluiceResult *results)
{
    struct fixture *f = user;
    assert_int_equal(batch->structSize, sizeof *batch);
    assert_ptr_equal(batch->commandBuffer, fake_vulkan_commands(&f->fake));
    assert_true(batch->tileCount > 0);
    f->batch_count++;
    for (uint32_t i = 0; i < batch->tileCount; i++) {
        const SluiceTileTarget *target = &batch->pTiles[i];
        assert_int_equal(results[i], SLUICE_SUCCESS);
        results[i] = is_first(&target->region) ? f->first_answer : f->answer;
        if (f->failing_level && target->region.mipLevel == f->failing_level)
            results[i] = SLUICE_ERROR_IO;
        SluiceResult answer = f->batch_answer != SLUICE_SUCCESS ? f->batch_answer : results[i];
        assert_true(f->call_count < CALLS);
        f->calls[f->call_count++] = (struct call){
            batch->textureId, batch->image, batch->imageView, batch->mipLevel, batch->frameIndex,
            *target,          answer};
    }
    if (f->removes)
        CHECK_OK(sluiceRemoveVulkanTexture(f->streamer, batch->textureId));
    return f->batch_answer;
}

static SluiceImageInfo image_info(void)
{
    return (SluiceImageInfo){.structSize = sizeof(SluiceImageInfo),
                             .width = SIZE,
                             .height = SIZE,
                             .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                             .pName = "made picture"};
}

static SluiceResult add(struct fixture *f, SluiceVulkanTexture *texture)
{
    const SluiceImageInfo image = image_info();
    const SluiceTileProducer producer = {.structSize = sizeof producer,
                                         .pImage = &image,
                                         .pUserData = f,
                                         .pfnRecordTiles = record_tiles,
                                         .timeoutFrames = f->timeout};
    SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info, .pProducer = &producer};
    return sluiceAddVulkanTexture(f->streamer, &info, texture);
}

static void setup(struct fixture *f, SluiceResidencyMode mode)
{
    *f = (struct fixture){.fake = {.tail_page_count = 1, .want = want},
                          .tiles_per_frame = f->tiles_per_frame,
                          .timeout = f->timeout,
                          .cb = f->cb};
    f->fake.user = f;
    f->fake.pAllocator = f->cb;
    f->fake.log = (SluiceLogCallback){f, on_log};
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .maxTextureCount = 2,
                                           .maxRegionCount = 256,
                                           .tilesPerFrame = f->tiles_per_frame,
                                           .feedbackTimeoutTicks = 1,
                                           .retryDelayTicks = 1,
                                           .givenUpRetryDelayTicks = UINT64_C(1) << 40};
    fake_vulkan_fill(&info);
    info.residencyMode = mode;
    CHECK_OK(fake_vulkan_create(&f->fake, &info, &f->streamer));
}

static void setup_with_texture(struct fixture *f, SluiceResidencyMode mode)
{
    setup(f, mode);
    CHECK_OK(add(f, &f->texture));
}

static void teardown(struct fixture *f)
{
    fake_vulkan_destroy(f->streamer);
    assert_int_equal(f->fake.live_objects, 0);
    f->tiles_per_frame = f->timeout = 0;
}

/* Completes binds at once, and frames unless the GPU is stuck. */
static void begin_frame(struct fixture *f)
{
    struct fake_vulkan *fake = &f->fake;
    f->frame = (SluiceStreamingFrame){.structSize = sizeof f->frame};
    fake->published = false;
    fake->copy_count = fake->bind_count = fake->destroyed_count = fake->freed_count = 0;
    fake->bind_value = fake->submitted_bind_value;
    f->time += 1000;
    CHECK_OK(
        sluiceBeginStreamingFrame(f->streamer, fake_vulkan_commands(fake), f->time, &f->frame));
    fake->frame_semaphore = f->frame.semaphore;
}

static void run_frames(struct fixture *f, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        begin_frame(f);
        CHECK_OK(sluiceEndStreamingFrame(f->streamer, fake_vulkan_commands(&f->fake)));
        if (!f->stuck)
            f->fake.frame_value = f->frame.signalValue;
    }
}

static SluiceTileState state_of(struct fixture *f, uint32_t tile)
{
    SluiceTileState state;
    CHECK_OK(sluiceGetTileState(manager_of(f->streamer), f->texture.textureId, tile, &state, NULL));
    return state;
}

static uint32_t count_states(struct fixture *f, SluiceTileState state)
{
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    uint32_t count = 0;
    CHECK_OK(sluiceGetTextureLayout(manager_of(f->streamer), f->texture.textureId, &layout));
    for (uint32_t tile = 0; tile < layout.tileCount; tile++)
        count += state_of(f, tile) == state;
    return count;
}

static SluiceVulkanStreamerStatistics statistics(const struct fixture *f)
{
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    CHECK_OK(sluiceGetVulkanStreamerStatistics(f->streamer, &stats));
    return stats;
}

/* Checks how often each texel of a level was requested. */
static void check_covered(const struct fixture *f, uint32_t level, uint8_t times)
{
    static uint8_t covered[SIZE][SIZE];
    uint32_t size = SIZE >> level;
    memset(covered, 0, sizeof covered);
    for (uint32_t i = 0; i < f->call_count; i++) {
        const SluiceImageRegion *region = &f->calls[i].target.region;
        if (region->mipLevel != level)
            continue;
        assert_true(region->x + region->width <= size && region->y + region->height <= size);
        for (uint32_t y = 0; y < region->height; y++)
            for (uint32_t x = 0; x < region->width; x++)
                covered[region->y + y][region->x + x]++;
    }
    for (uint32_t y = 0; y < size; y++)
        for (uint32_t x = 0; x < size; x++)
            if (covered[y][x] != times)
                fail_msg("level %u, texel %u, %u: asked for %u times, not %u", level, x, y,
                         covered[y][x], times);
}

/* Checks that targets do not overlap, and lie within their images. */
static void check_targets(const struct fixture *f, SluiceResidencyMode mode)
{
    for (uint32_t i = 0; i < f->call_count; i++) {
        const struct call *a = &f->calls[i];
        assert_ptr_equal(fake_vulkan_image_of(a->view), a->image);
        bool is_page = mode == SLUICE_RESIDENCY_MODE_PAGED && a->target.region.width == FAKE_TILE &&
                       a->target.region.mipLevel < 3 && a->image != f->texture.image;
        if (is_page) {
            assert_true(a->target.x == 0 && a->target.y == 0 && a->image_level == 0);
        } else {
            assert_ptr_equal(a->image, f->texture.image);
            assert_true(a->target.x == a->target.region.x && a->target.y == a->target.region.y);
            assert_int_equal(a->target.layer, 0);
        }
        for (uint32_t k = 0; k < i; k++) {
            const struct call *b = &f->calls[k];
            assert_false(a->image == b->image && a->image_level == b->image_level &&
                         a->target.layer == b->target.layer && a->target.x == b->target.x &&
                         a->target.y == b->target.y);
        }
    }
}

static void every_texel_is_produced_once_and_none_is_read(void **state)
{
    (void)state;
    for (int m = 0; m < MODES; m++) {
        static struct fixture f; /* large */
        setup_with_texture(&f, modes[m]);
        run_frames(&f, 12);
        for (uint32_t level = 0; level < LEVELS; level++)
            check_covered(&f, level, 1);
        check_targets(&f, modes[m]);
        SluiceVulkanStreamerStatistics stats = statistics(&f);
        assert_int_equal(count_states(&f, SLUICE_TILE_STATE_MAPPED), stats.tileCount);
        assert_int_equal(stats.bytesRead, 0);
        assert_int_equal(stats.bytesUploaded, 0);
        assert_true(stats.tilesProduced >= TILES * TILES + 4);
        assert_int_equal(stats.loadsInFlight, 0);
        assert_int_equal(f.warnings, 0);
        teardown(&f);
    }
}

static void a_tile_is_shown_when_its_frame_is_complete(void **state)
{
    (void)state;
    for (int m = 0; m < MODES; m++) {
        static struct fixture f; /* large */
        setup_with_texture(&f, modes[m]);
        uint64_t produced = 0;
        while (!produced) {
            f.stuck = true;
            run_frames(&f, 1);
            for (uint32_t i = 0; i < f.call_count && !produced; i++)
                produced = f.calls[i].target.region.mipLevel == 0 ? f.calls[i].frame : 0;
            if (!produced)
                f.fake.frame_value = f.frame.signalValue;
        }
        assert_int_equal(state_of(&f, 0), SLUICE_TILE_STATE_ALLOCATED);
        run_frames(&f, 1); /* begun after it, while it is pending */
        assert_int_equal(state_of(&f, 0), SLUICE_TILE_STATE_ALLOCATED);
        assert_true(statistics(&f).loadsInFlight > 0);
        f.fake.frame_value = produced;
        run_frames(&f, 1);
        assert_int_equal(state_of(&f, 0), SLUICE_TILE_STATE_MAPPED);
        check_covered(&f, 0, 1);
        f.fake.frame_value = f.frame.signalValue;
        teardown(&f);
    }
}

static uint64_t first_frame_asked(const struct fixture *f)
{
    for (uint32_t i = 0; i < f->call_count; i++)
        if (f->calls[i].target.region.mipLevel < 2)
            return f->calls[i].frame;
    return 0;
}

static void without_bindings_a_tile_is_asked_for_when_it_gets_its_slot(void **state)
{
    (void)state;
    for (int m = 0; m < MODES; m++) {
        static struct fixture f; /* large */
        setup_with_texture(&f, modes[m]);
        uint64_t handed_out = 0;
        for (uint32_t i = 0; i < 12; i++) {
            run_frames(&f, 1);
            bool is_waiting = state_of(&f, 0) == SLUICE_TILE_STATE_ALLOCATED ||
                              state_of(&f, TILES * TILES) == SLUICE_TILE_STATE_ALLOCATED;
            handed_out = !handed_out && is_waiting ? f.frame.frameIndex : handed_out;
        }
        bool binds = modes[m] == SLUICE_RESIDENCY_MODE_SPARSE;
        assert_true(handed_out > 0);
        assert_true(binds ? first_frame_asked(&f) > handed_out
                          : first_frame_asked(&f) == handed_out);
        teardown(&f);
    }
}

static void frames_hold_no_more_tiles_than_they_may(void **state)
{
    (void)state;
    for (int m = 0; m < MODES; m++) {
        static struct fixture f; /* large */
        f.tiles_per_frame = 3;
        setup_with_texture(&f, modes[m]);
        uint32_t most = 0;
        for (uint32_t i = 0; i < 30; i++) {
            uint32_t before = f.call_count, count = 0;
            run_frames(&f, 1);
            for (uint32_t k = before; k < f.call_count; k++)
                count += f.calls[k].target.region.mipLevel < 2;
            most = count > most ? count : most;
        }
        assert_int_equal(most, 3);
        check_covered(&f, 0, 1);
        teardown(&f);
    }
}

static void check_first_level(struct fixture *f, SluiceTileState first_state, uint8_t first_level)
{
    uint8_t map[TILES * TILES];
    CHECK_OK(sluiceWriteMinMipData(manager_of(f->streamer), f->texture.textureId, TILES, sizeof map,
                                   map));
    for (uint32_t y = 0; y < TILES; y++)
        for (uint32_t x = 0; x < TILES; x++) {
            bool first = x < TILES / 2 && y < TILES / 2;
            assert_int_equal(state_of(f, y * TILES + x),
                             first ? first_state : SLUICE_TILE_STATE_MAPPED);
            assert_int_equal(map[y * TILES + x], first ? first_level : 0);
        }
}

static void tiles_of_a_producer_that_fails_stay_coarser_and_are_reported(void **state)
{
    (void)state;
    for (int m = 0; m < MODES; m++) {
        static struct fixture f; /* large */
        setup(&f, modes[m]);
        f.first_answer = SLUICE_ERROR_IO;
        CHECK_OK(add(&f, &f.texture));
        run_frames(&f, 40);
        check_first_level(&f, SLUICE_TILE_STATE_GIVEN_UP, 1);
        SluiceVulkanStreamerStatistics stats = statistics(&f);
        assert_int_equal(stats.tilesFailed, 4 * MANAGER_ATTEMPTS);
        assert_int_equal(stats.givenUpTileCount, 4);
        assert_int_equal(stats.loadsInFlight, 0);
        assert_int_equal(f.warnings, 2);
        assert_non_null(strstr(f.last_warning, "made picture: "));
        assert_non_null(strstr(f.last_warning, "calls of its producer failed"));

        f.first_answer = SLUICE_SUCCESS;
        CHECK_OK(sluiceRetryVulkanSource(f.streamer, NULL));
        run_frames(&f, 6);
        check_first_level(&f, SLUICE_TILE_STATE_MAPPED, 0);
        assert_int_equal(f.warnings, 2);
        teardown(&f);
    }
}

/* Includes the mip tail: nothing is shown before. */
static void a_batch_fails_as_a_whole(void **state)
{
    (void)state;
    for (int m = 0; m < MODES; m++) {
        static struct fixture f; /* large */
        setup(&f, modes[m]);
        f.batch_answer = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        CHECK_OK(add(&f, &f.texture));
        run_frames(&f, 40);
        assert_int_equal(count_states(&f, SLUICE_TILE_STATE_MAPPED), 0);
        assert_int_equal(statistics(&f).tilesProduced, 0);
        f.batch_answer = SLUICE_SUCCESS;
        CHECK_OK(sluiceRetryVulkanSource(f.streamer, NULL));
        run_frames(&f, 12);
        assert_int_equal(count_states(&f, SLUICE_TILE_STATE_MAPPED), statistics(&f).tileCount);
        teardown(&f);
    }
}

/* Finer levels of the tail are recorded when a coarser one fails. */
static void a_mip_tail_that_failed_keeps_its_pages_until_its_frame_is_complete(void **state)
{
    (void)state;
    for (int m = 0; m < MODES; m++) {
        static struct fixture f; /* large */
        setup(&f, modes[m]);
        f.failing_level = LEVELS - 1;
        CHECK_OK(add(&f, &f.texture));
        while (f.call_count == 0) {
            f.stuck = true;
            run_frames(&f, 1);
            if (f.call_count == 0)
                f.fake.frame_value = f.frame.signalValue;
        }
        uint32_t packed = statistics(&f).tileCount - 1;
        uint64_t produced = f.frame.signalValue;
        assert_true(f.calls[0].answer == SLUICE_SUCCESS);
        run_frames(&f, 1);
        assert_int_equal(state_of(&f, packed), SLUICE_TILE_STATE_ALLOCATED);
        assert_int_equal(statistics(&f).tilesFailed, 0);
        f.fake.frame_value = produced;
        run_frames(&f, 1);
        assert_true(statistics(&f).tilesFailed > 0);
        f.failing_level = 0;
        f.stuck = false;
        run_frames(&f, 20);
        assert_int_equal(count_states(&f, SLUICE_TILE_STATE_MAPPED), statistics(&f).tileCount);
        assert_int_equal(statistics(&f).loadsInFlight, 0);
        teardown(&f);
    }
}

static uint32_t count_calls(const struct fixture *f, SluiceResult answer)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < f->call_count; i++)
        count += f->calls[i].answer == answer;
    return count;
}

static void tiles_that_are_not_ready_are_asked_for_again(void **state)
{
    (void)state;
    for (int m = 0; m < MODES; m++) {
        static struct fixture f; /* large */
        setup(&f, modes[m]);
        f.first_answer = SLUICE_NOT_READY;
        CHECK_OK(add(&f, &f.texture));
        run_frames(&f, 20);
        check_first_level(&f, SLUICE_TILE_STATE_ALLOCATED, 1);
        uint32_t asked = count_calls(&f, SLUICE_NOT_READY);
        run_frames(&f, 1); /* each once per frame */
        assert_int_equal(count_calls(&f, SLUICE_NOT_READY), asked + 4);
        f.first_answer = SLUICE_SUCCESS;
        run_frames(&f, 2);
        check_first_level(&f, SLUICE_TILE_STATE_MAPPED, 0);
        assert_int_equal(statistics(&f).tilesFailed, 0);
        assert_int_equal(f.warnings, 0);
        teardown(&f);
    }
}

static void tiles_that_are_never_ready_fail(void **state)
{
    (void)state;
    for (int m = 0; m < MODES; m++) {
        static struct fixture f; /* large */
        f.timeout = 5;
        setup(&f, modes[m]);
        f.first_answer = SLUICE_NOT_READY;
        CHECK_OK(add(&f, &f.texture));
        run_frames(&f, 80);
        check_first_level(&f, SLUICE_TILE_STATE_GIVEN_UP, 1);
        /* the frame of the first question, and five more */
        assert_int_equal(count_calls(&f, SLUICE_NOT_READY), 4 * 6 * MANAGER_ATTEMPTS);
        assert_int_equal(statistics(&f).tilesFailed, 4 * MANAGER_ATTEMPTS);
        assert_int_equal(f.warnings, 2);
        teardown(&f);
    }
}

/* Unwanted tiles are not waited for. */
static void tiles_that_are_not_ready_and_not_wanted_are_given_back(void **state)
{
    (void)state;
    for (int m = 0; m < MODES; m++) {
        static struct fixture f; /* large */
        setup(&f, modes[m]);
        f.first_answer = SLUICE_NOT_READY;
        CHECK_OK(add(&f, &f.texture));
        run_frames(&f, 12);
        f.wanted = 2;
        run_frames(&f, 12);
        assert_int_equal(statistics(&f).loadsInFlight, 0);
        assert_int_equal(statistics(&f).tilesCanceled, 4);
        assert_int_equal(count_states(&f, SLUICE_TILE_STATE_ALLOCATED), 0);
        uint32_t asked = f.call_count;
        run_frames(&f, 4);
        assert_int_equal(f.call_count, asked);
        f.wanted = 0;
        f.first_answer = SLUICE_SUCCESS;
        run_frames(&f, 8);
        check_first_level(&f, SLUICE_TILE_STATE_MAPPED, 0);
        teardown(&f);
    }
}

/* The commands of an abandoned frame never wrote its tiles. */
static void tiles_of_abandoned_frames_are_asked_for_again(void **state)
{
    (void)state;
    for (int m = 0; m < MODES; m++) {
        static struct fixture f; /* large */
        setup_with_texture(&f, modes[m]);
        uint32_t lost = 0;
        for (uint32_t i = 0; i < 24; i++) {
            uint32_t before = f.call_count;
            fake_vulkan_mark(&f.fake);
            begin_frame(&f);
            CHECK_OK(sluiceAbandonStreamingFrame(f.streamer, &f.frame));
            fake_vulkan_undo(&f.fake);
            lost += f.call_count - before;
            f.call_count = before;
            if (i % 5 > 0 && i % 5 < 4)
                run_frames(&f, 1);
        }
        assert_true(lost > 0);
        for (uint32_t level = 0; level < LEVELS; level++)
            check_covered(&f, level, 1);
        assert_int_equal(count_states(&f, SLUICE_TILE_STATE_MAPPED), statistics(&f).tileCount);
        teardown(&f);
    }
}

static void a_producer_may_fail_after_its_frame_was_abandoned(void **state)
{
    (void)state;
    for (int m = 0; m < MODES; m++) {
        static struct fixture f; /* large */
        setup_with_texture(&f, modes[m]);
        while (count_calls(&f, SLUICE_SUCCESS) == 0 || !is_first(&f.calls[0].target.region)) {
            f.call_count = 0;
            fake_vulkan_mark(&f.fake);
            begin_frame(&f);
            bool first = false;
            for (uint32_t i = 0; i < f.call_count; i++)
                first |= is_first(&f.calls[i].target.region);
            if (first) {
                CHECK_OK(sluiceAbandonStreamingFrame(f.streamer, &f.frame));
                fake_vulkan_undo(&f.fake);
                break;
            }
            CHECK_OK(sluiceEndStreamingFrame(f.streamer, fake_vulkan_commands(&f.fake)));
            f.fake.frame_value = f.frame.signalValue;
        }
        f.first_answer = SLUICE_ERROR_IO;
        run_frames(&f, 40);
        check_first_level(&f, SLUICE_TILE_STATE_GIVEN_UP, 1);
        teardown(&f);
    }
}

static void a_texture_is_removed_while_it_is_produced(void **state)
{
    (void)state;
    for (int m = 0; m < MODES; m++)
        for (uint32_t frames = 1; frames < 8; frames++) {
            static struct fixture f; /* large */
            setup(&f, modes[m]);
            f.first_answer = SLUICE_NOT_READY;
            CHECK_OK(add(&f, &f.texture));
            run_frames(&f, frames - 1);
            f.stuck = true;
            run_frames(&f, 1);
            CHECK_OK(sluiceRemoveVulkanTexture(f.streamer, f.texture.textureId));
            uint32_t asked = f.call_count;
            run_frames(&f, 1);
            VkImage image = f.texture.image;
            for (uint32_t i = 0; i < f.fake.destroyed_count; i++)
                assert_ptr_not_equal(f.fake.destroyed_images[i], image);
            f.stuck = false;
            f.fake.frame_value = f.frame.signalValue;
            run_frames(&f, 3);
            assert_int_equal(f.call_count, asked);
            assert_int_equal(statistics(&f).loadsInFlight, 0);
            assert_int_equal(statistics(&f).textureCount, 0);
            teardown(&f);
        }
}

/* The callback must not do it, but no tile or page may be lost. */
static void a_texture_may_be_removed_by_its_producer(void **state)
{
    (void)state;
    static const SluiceResult answers[] = {SLUICE_SUCCESS, SLUICE_NOT_READY, SLUICE_ERROR_IO};
    for (uint32_t n = 0; n < 2 * MODES * 3; n++) {
        static struct fixture f; /* large */
        bool after_tail = n >= MODES * 3;
        setup(&f, modes[n % MODES]);
        CHECK_OK(add(&f, &f.texture));
        f.wanted = after_tail ? LEVELS - 1 : 0;
        while (after_tail && f.call_count == 0)
            run_frames(&f, 1);
        f.wanted = 0;
        f.removes = true;
        f.batch_answer = answers[n / MODES % 3];
        run_frames(&f, 12);
        assert_int_equal(statistics(&f).textureCount, 0);
        assert_int_equal(statistics(&f).loadsInFlight, 0);
        teardown(&f);
    }
}

static void without_memory_for_pages_tiles_wait_and_come_later(void **state)
{
    (void)state;
    static struct fixture f; /* large */
    setup_with_texture(&f, SLUICE_RESIDENCY_MODE_PAGED);
    run_frames(&f, 1);
    f.fake.memory_limit = f.fake.live_memory;
    run_frames(&f, 20);
    assert_int_equal(statistics(&f).tilesProduced, 0);
    assert_int_equal(statistics(&f).tilesFailed, 0);
    f.fake.memory_limit = 0;
    run_frames(&f, 200);
    check_first_level(&f, SLUICE_TILE_STATE_MAPPED, 0);
    check_covered(&f, 0, 1);
    teardown(&f);
}

static void two_textures_with_producers_share_no_tiles(void **state)
{
    (void)state;
    for (int m = 0; m < MODES; m++) {
        static struct fixture f; /* large */
        SluiceVulkanTexture other;
        setup_with_texture(&f, modes[m]);
        run_frames(&f, 12);
        CHECK_OK(add(&f, &other));
        uint32_t first = f.call_count;
        run_frames(&f, 12);
        for (uint32_t i = first; i < f.call_count; i++)
            assert_true(f.calls[i].id == other.textureId);
        assert_int_equal(f.call_count, 2 * first);
        assert_int_equal(statistics(&f).tilesShared, 0);
        /* an evicted tile that is wanted again has its texels */
        f.wanted = 3;
        run_frames(&f, 8);
        f.wanted = 0;
        run_frames(&f, 12);
        check_first_level(&f, SLUICE_TILE_STATE_MAPPED, 0);
        teardown(&f);
    }
}

static void wrong_producers_are_refused(void **state)
{
    (void)state;
    static struct fixture f; /* large */
    setup(&f, SLUICE_RESIDENCY_MODE_DENSE);
    SluiceVulkanTexture texture;
    SluiceImageInfo image = image_info();
    SluiceTileProducer producer = {
        .structSize = sizeof producer, .pImage = &image, .pfnRecordTiles = record_tiles};
    SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info, .pProducer = &producer};
    SluiceImageSource source = {NULL};
    info.source = &source;
    CHECK_RESULT(sluiceAddVulkanTexture(f.streamer, &info, &texture),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    info.source = NULL;
    info.pProducer = NULL;
    CHECK_RESULT(sluiceAddVulkanTexture(f.streamer, &info, &texture), SLUICE_ERROR_NULL_POINTER);
    info.pProducer = &producer;
    producer.pfnRecordTiles = NULL;
    CHECK_RESULT(sluiceAddVulkanTexture(f.streamer, &info, &texture), SLUICE_ERROR_NULL_POINTER);
    producer.pfnRecordTiles = record_tiles;
    producer.pImage = NULL;
    CHECK_RESULT(sluiceAddVulkanTexture(f.streamer, &info, &texture), SLUICE_ERROR_NULL_POINTER);
    producer.pImage = &image;
    producer.structSize = 0;
    CHECK_RESULT(sluiceAddVulkanTexture(f.streamer, &info, &texture),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    producer.structSize = sizeof producer;
    image.structSize = 1;
    CHECK_RESULT(sluiceAddVulkanTexture(f.streamer, &info, &texture),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    image.structSize = sizeof image;
    image.mipLevelCount = 1;
    CHECK_RESULT(sluiceAddVulkanTexture(f.streamer, &info, &texture),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    image.mipLevelCount = 0;
    image.width = 0;
    CHECK_RESULT(sluiceAddVulkanTexture(f.streamer, &info, &texture),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    image.width = SIZE;
    CHECK_OK(sluiceAddVulkanTexture(f.streamer, &info, &texture));
    teardown(&f);
}

static void adding_fails_without_leaks(void **state)
{
    (void)state;
    for (int m = 0; m < MODES; m++) {
        static struct fixture f; /* large */
        struct failing_allocator allocator;
        failing_allocator_init(&allocator, UINT64_MAX);
        f.cb = &allocator.callbacks;
        setup(&f, modes[m]);
        SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        for (uint32_t n = 0; result != SLUICE_SUCCESS; n++) {
            run_frames(&f, 2);
            allocator.refuse_from = allocator.calls + n;
            result = add(&f, &f.texture);
            assert_true(result == SLUICE_SUCCESS || result == SLUICE_ERROR_OUT_OF_HOST_MEMORY);
            allocator.refuse_from = UINT64_MAX;
        }
        CHECK_OK(sluiceRemoveVulkanTexture(f.streamer, f.texture.textureId));
        f.fake.failure = VK_ERROR_OUT_OF_DEVICE_MEMORY;
        result = SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
        for (uint32_t n = 1; result != SLUICE_SUCCESS; n++) {
            run_frames(&f, 2);
            f.fake.failing_call = f.fake.calls + n;
            result = add(&f, &f.texture);
            assert_true(result == SLUICE_SUCCESS || result == SLUICE_ERROR_OUT_OF_DEVICE_MEMORY);
            f.fake.failing_call = 0;
        }
        run_frames(&f, 12);
        check_covered(&f, 0, 1);
        teardown(&f);
        f.cb = NULL;
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_texel_is_produced_once_and_none_is_read),
        cmocka_unit_test(a_tile_is_shown_when_its_frame_is_complete),
        cmocka_unit_test(without_bindings_a_tile_is_asked_for_when_it_gets_its_slot),
        cmocka_unit_test(frames_hold_no_more_tiles_than_they_may),
        cmocka_unit_test(tiles_of_a_producer_that_fails_stay_coarser_and_are_reported),
        cmocka_unit_test(a_batch_fails_as_a_whole),
        cmocka_unit_test(a_mip_tail_that_failed_keeps_its_pages_until_its_frame_is_complete),
        cmocka_unit_test(tiles_that_are_not_ready_are_asked_for_again),
        cmocka_unit_test(tiles_that_are_never_ready_fail),
        cmocka_unit_test(tiles_that_are_not_ready_and_not_wanted_are_given_back),
        cmocka_unit_test(tiles_of_abandoned_frames_are_asked_for_again),
        cmocka_unit_test(a_producer_may_fail_after_its_frame_was_abandoned),
        cmocka_unit_test(a_texture_is_removed_while_it_is_produced),
        cmocka_unit_test(a_texture_may_be_removed_by_its_producer),
        cmocka_unit_test(without_memory_for_pages_tiles_wait_and_come_later),
        cmocka_unit_test(two_textures_with_producers_share_no_tiles),
        cmocka_unit_test(wrong_producers_are_refused),
        cmocka_unit_test(adding_fails_without_leaks),
    };
    return RUN_TESTS(tests);
}
