/* Changing texels of resident tiles, and replacing sources. */
#include "vulkan/control_reload.h"

#include "image/read_pool.h"
#include "vulkan/control_stage.h"
#include "vulkan/streamer.h"

#include <stdatomic.h>
#include <string.h>

static atomic_uint shade; ///< value of all texels, 1 to 255

static void shaded_texel(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                         uint32_t height, float rgba[4])
{
    (void)user, (void)level, (void)x, (void)y, (void)width, (void)height;
    rgba[0] = rgba[1] = rgba[2] = rgba[3] = (float)shade / 255;
}

static SluiceImageSource *make_source(uint32_t width, SluiceFormat format)
{
    SluiceProceduralImage image = {NULL, shaded_texel};
    SluiceImageInfo info = {.structSize = sizeof info,
                            .width = width,
                            .height = SIZE,
                            .format = format,
                            .pName = "shades"};
    SluiceImageSource *source;
    CHECK_OK(sluiceCreateProceduralImageSource(&image, &info, NULL, &source));
    return source;
}

/* Creates a stage whose texture 0 has the source, with all its tiles resident. */
static struct stage *begin(SluiceResidencyMode mode, SluiceImageSource *source)
{
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){
        .feedbackTimeoutTicks = 1000, .residencyMode = mode, .retryDelayTicks = 5});
    atomic_store(&shade, 1);
    CHECK_OK(sluiceReplaceVulkanSource(s->streamer, s->textures[0].textureId, source));
    memset(s->seen[0], 0, sizeof s->seen[0]);
    frames(s, 12);
    return s;
}

static SluiceVulkanTextureState state_now(const struct stage *s)
{
    SluiceVulkanTextureState now = {.structSize = sizeof now};
    CHECK_OK(sluiceGetVulkanTextureState(s->streamer, s->textures[0].textureId, NULL, &now));
    return now;
}

static bool is_copy_of(const struct fake_copy *copy, uint32_t texel)
{
    return copy->texel == texel * 0x01010101u;
}

/* Runs frames until no tile shows old texels. Returns the number of copies, which must all have the
 * new shade. */
static uint32_t settle(struct stage *s, uint32_t texel)
{
    uint32_t count = 0;
    for (uint32_t frame = 0; state_now(s).reloadingTileCount; frame++) {
        assert_true(frame < 100);
        assert_int_equal(state_now(s).residentLevel, 0);
        frames(s, 1);
        for (uint32_t i = 0; i < s->fake.copy_count; i++)
            assert_true(is_copy_of(&s->fake.copies[i], texel));
        count += s->fake.copy_count;
    }
    return count;
}

static const SluiceResidencyMode modes[] = {
    SLUICE_RESIDENCY_MODE_SPARSE, SLUICE_RESIDENCY_MODE_PAGED, SLUICE_RESIDENCY_MODE_DENSE};

void changed_tiles_are_copied_again_in_place(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        SluiceImageSource *source = make_source(SIZE, SLUICE_FORMAT_R8G8B8A8_UNORM);
        struct stage *s = begin(modes[i], source);
        const SluiceTextureId id = s->textures[0].textureId;
        CHECK_OK(sluiceSetVulkanPrimaryTexture(s->streamer, s->textures[1].textureId, id));
        frames(s, 12);
        const SluiceVulkanStreamerStatistics before = statistics(s);
        atomic_store(&shade, 2);
        CHECK_OK(sluiceInvalidateVulkanTexture(
            s->streamer, id, &(SluiceImageRegion){0, 3 * 128 + 5, 2 * 128 + 5, 1, 1, 0}, 1));
        assert_int_equal(state_now(s).reloadingTileCount, 1);
        assert_int_equal(settle(s, 2), 1); /* neither its neighbors nor its follower */
        const struct fake_copy *copy = &s->fake.copies[0];
        if (modes[i] != SLUICE_RESIDENCY_MODE_PAGED)
            assert_true(copy->image == s->textures[0].image && copy->level == 0 && copy->x == 3 &&
                        copy->y == 2);
        atomic_store(&shade,
                     3); /* changes the tile and the tiles over it; level 3 is in the mip tail */
        CHECK_OK(sluiceInvalidateVulkanTexture(
            s->streamer, id, &(SluiceImageRegion){0, 3 * 128 + 5, 2 * 128 + 5, 1, 1, 0}, 3));
        assert_int_equal(settle(s, 3), 3);
        frames(s, 2);
        const SluiceVulkanStreamerStatistics after = statistics(s);
        assert_int_equal(after.tilesReloaded, before.tilesReloaded + 4);
        assert_int_equal(after.tilesMapped, before.tilesMapped);
        assert_int_equal(after.tilesUnmapped, before.tilesUnmapped);
        stage_finish(s);
        sluiceDestroyImageSource(source);
    }
}

void mip_tails_and_all_tiles_are_copied_again(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        SluiceImageSource *source = make_source(SIZE, SLUICE_FORMAT_R8G8B8A8_UNORM);
        struct stage *s = begin(modes[i], source);
        const SluiceTextureId id = s->textures[0].textureId;
        atomic_store(&shade, 4);
        CHECK_OK(sluiceInvalidateVulkanTexture(s->streamer, id, NULL, UINT32_MAX));
        assert_int_equal(state_now(s).reloadingTileCount, 64 + 16 + 4 + 1);
        assert_int_equal(settle(s, 4), 64 + 16 + 4 + 8); /* a tail of eight levels */
        /* Tiles that are not resident are read anew; unmapped ones are not restored. */
        memset(s->seen[0], SLUICE_MIP_UNTOUCHED, sizeof s->seen[0]);
        frames(s, 2);
        CHECK_OK(sluiceEvictVulkanTexture(s->streamer, id, 0));
        frames(s, 3);
        assert_int_equal(state_now(s).residentLevel, TAIL);
        atomic_store(&shade, 5);
        CHECK_OK(sluiceInvalidateVulkanTexture(s->streamer, id, NULL, UINT32_MAX));
        assert_int_equal(state_now(s).reloadingTileCount, 1);
        memset(s->seen[0], 0, sizeof s->seen[0]);
        uint32_t count = 0;
        for (uint32_t frame = 0; frame < 20; frame++) {
            frames(s, 1);
            for (uint32_t k = 0; k < s->fake.copy_count; k++)
                assert_true(is_copy_of(&s->fake.copies[k], 5));
            count += s->fake.copy_count;
        }
        assert_int_equal(count, 64 + 16 + 4 + 8);
        assert_int_equal(state_now(s).residentLevel, 0);
        stage_finish(s);
        sluiceDestroyImageSource(source);
    }
}

void a_reload_that_fails_keeps_the_old_texels(void **state)
{
    (void)state;
    SluiceImageSource *source = make_source(SIZE, SLUICE_FORMAT_R8G8B8A8_UNORM);
    struct fault_source faults;
    fault_source_init(&faults, source);
    struct stage *s = begin(SLUICE_RESIDENCY_MODE_SPARSE, &faults.base);
    atomic_store(&shade, 6);
    faults.failure = SLUICE_ERROR_IO;
    faults.fail_at = faults.read_count + 1;
    faults.fails_on = true;
    CHECK_OK(sluiceInvalidateVulkanTexture(s->streamer, s->textures[0].textureId,
                                           &(SluiceImageRegion){.width = 1, .height = 1}, 1));
    for (uint32_t frame = 0; frame < 12; frame++) { /* two reads of four attempts each */
        frames(s, 1);
        assert_int_equal(s->fake.copy_count, 0);
        assert_int_equal(state_now(s).residentLevel, 0);
        assert_int_equal(state_now(s).reloadingTileCount, 1);
    }
    assert_int_equal(faults.read_count, faults.fail_at + 7);
    assert_non_null(strstr(s->last, "shades"));
    faults.fail_at = 0;
    assert_int_equal(settle(s, 6), 1);
    stage_finish(s);
    fault_source_finish(&faults);
    sluiceDestroyImageSource(source);
}

/* The loader refuses one read for lack of room. */
void a_refused_reload_of_a_mip_tail_is_tried_again(void **state)
{
    (void)state;
    SluiceImageSource *source = make_source(SIZE, SLUICE_FORMAT_R8G8B8A8_UNORM);
    struct stage *s = begin(SLUICE_RESIDENCY_MODE_SPARSE, source);
    struct slc_read_queue *queue = &s->streamer->loader->queue;
    atomic_store(&shade, 9);
    CHECK_OK(sluiceInvalidateVulkanTexture(
        s->streamer, s->textures[0].textureId,
        &(SluiceImageRegion){.mipLevel = TAIL, .width = 1, .height = 1}, 1));
    const uint32_t room = queue->free_count;
    queue->free_count = 0;
    frames(s, 1);
    queue->free_count = room;
    assert_int_equal(state_now(s).reloadingTileCount, 1);
    assert_int_equal(settle(s, 9), 8);
    stage_finish(s);
    sluiceDestroyImageSource(source);
}

/* The failure is final for the reader, and too frequent for the manager. */
void given_up_tiles_are_tried_again_after_a_change(void **state)
{
    (void)state;
    SluiceImageSource *source = make_source(SIZE, SLUICE_FORMAT_R8G8B8A8_UNORM);
    struct fault_source faults;
    fault_source_init(&faults, source);
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){
        .feedbackTimeoutTicks = 1000, .retryDelayTicks = 1, .givenUpRetryDelayTicks = UINT64_MAX});
    const SluiceTextureId id = s->textures[0].textureId;
    CHECK_OK(sluiceReplaceVulkanSource(s->streamer, id, &faults.base));
    frames(s, 12);
    CHECK_OK(sluiceWaitVulkanStreamerIdle(s->streamer));
    faults.failure = SLUICE_ERROR_UNSUPPORTED;
    faults.fail_at = faults.read_count + 1;
    faults.fails_on = true;
    s->seen[0][0] = 0;
    for (uint32_t i = 0; i < 100 && statistics(s).givenUpTileCount < 3; i++)
        frames(s, 1);
    assert_int_equal(statistics(s).givenUpTileCount, 3); /* one of each level above the mip tail */
    faults.fail_at = 0;
    const uint64_t reads = faults.read_count;
    frames(s, 10);
    assert_int_equal(faults.read_count, reads);
    CHECK_OK(sluiceInvalidateVulkanTexture(s->streamer, id,
                                           &(SluiceImageRegion){.width = 1, .height = 1}, 3));
    frames(s, 10);
    assert_int_equal(faults.read_count, reads + 3);
    assert_int_equal(statistics(s).givenUpTileCount, 0);
    stage_finish(s);
    fault_source_finish(&faults);
    sluiceDestroyImageSource(source);
}

/* Runs a frame without waiting for reads. */
static void hasty_frame(struct stage *s)
{
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    s->fake.published = false;
    s->fake.copy_count = s->fake.bind_count = 0;
    CHECK_OK(
        sluiceBeginStreamingFrame(s->streamer, fake_vulkan_commands(&s->fake), ++s->time, &frame));
    CHECK_OK(sluiceEndStreamingFrame(s->streamer, fake_vulkan_commands(&s->fake)));
    s->fake.frame_semaphore = frame.semaphore;
    s->fake.frame_value = frame.signalValue;
}

static bool is_in_use(const struct stage *s, const SluiceImageSource *source)
{
    bool in_use;
    CHECK_OK(sluiceIsVulkanSourceInUse(s->streamer, source, &in_use));
    return in_use;
}

void a_replaced_source_is_in_use_until_its_reads_end(void **state)
{
    (void)state;
    SluiceImageSource *old = make_source(SIZE, SLUICE_FORMAT_R8G8B8A8_UNORM);
    struct fault_source slow, fast;
    fault_source_init(&slow, old);
    fault_source_init(&fast, old);
    struct stage *s = begin(SLUICE_RESIDENCY_MODE_SPARSE, &slow.base);
    assert_true(is_in_use(s, &slow.base) && !is_in_use(s, &fast.base));
    slow.holds = true;
    CHECK_OK(sluiceInvalidateVulkanTexture(s->streamer, s->textures[0].textureId,
                                           &(SluiceImageRegion){.width = 1, .height = 1}, 1));
    hasty_frame(s);
    fault_source_await(&slow, 1);
    atomic_store(&shade, 7);
    CHECK_OK(sluiceReplaceVulkanSource(s->streamer, s->textures[0].textureId, &fast.base));
    const uint64_t calls = s->memory.calls;
    assert_true(is_in_use(s, &slow.base) && is_in_use(s, &fast.base));
    assert_int_equal(s->memory.calls, calls);
    hasty_frame(s);
    assert_true(is_in_use(s, &slow.base));
    const uint64_t reads = slow.read_count;
    fault_source_release(&slow);
    assert_int_equal(settle(s, 7), 64 + 16 + 4 + 8);
    assert_true(!is_in_use(s, &slow.base) && slow.read_count == reads);
    stage_finish(s);
    fault_source_finish(&slow);
    fault_source_finish(&fast);
    sluiceDestroyImageSource(old);
}

static SluiceVulkanWaitStatus wait_for(const struct stage *s, SluiceTextureRequestId request,
                                       uint64_t timeout)
{
    SluiceVulkanWaitStatus status;
    const uint64_t calls = s->memory.calls;
    CHECK_OK(sluiceWaitVulkanRequest(s->streamer, request, timeout, &status));
    assert_int_equal(s->memory.calls, calls);
    return status;
}

static SluiceTextureRequestId request_all(const struct stage *s)
{
    SluiceTextureRequestId request;
    const SluiceVulkanTextureRequest all = {.structSize = sizeof all, .until = UINT64_MAX};
    CHECK_OK(sluiceRequestVulkanTexture(s->streamer, s->textures[0].textureId, &all, &request));
    return request;
}

/* Waits end with the reads, before their timeout of a minute. Any frame then takes the results. */
void waits_end_with_reads_and_ask_for_frames(void **state)
{
    (void)state;
    const uint64_t minute = 60000000000;
    for (int i = 0; i < 3; i++) {
        struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){.residencyMode = modes[i]});
        SluiceTextureRequestId request = request_all(s);
        assert_int_equal(wait_for(s, request, minute), SLUICE_VULKAN_WAIT_FRAME);
        s->faults.holds = true;
        hasty_frame(s);
        fault_source_await(&s->faults, 1);
        SluiceVulkanWaitStatus status = wait_for(s, request, 0);
        for (uint32_t n = 0; n < 10 && status == SLUICE_VULKAN_WAIT_FRAME; n++) {
            hasty_frame(s);
            status = wait_for(s, request, 1000);
        }
        assert_int_equal(status, SLUICE_VULKAN_WAIT_TIMEOUT); /* only reads are pending */
        fault_source_release(&s->faults);
        uint32_t count = 0;
        while ((status = wait_for(s, request, minute)) == SLUICE_VULKAN_WAIT_FRAME) {
            s->fake.bind_value = s->fake.submitted_bind_value;
            hasty_frame(s);
            assert_true(++count < 200);
        }
        assert_int_equal(status, SLUICE_VULKAN_WAIT_READY);
        assert_int_equal(state_now(s).residentLevel, 0);
        stage_finish(s);
    }
}

void waits_tell_of_failures_and_of_requests_that_are_over(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 1000});
    s->faults.failure = SLUICE_ERROR_IO; /* before the first read: readers look at these */
    s->faults.fails_on = true;
    s->faults.fail_at = 20;
    SluiceTextureRequestId request = request_all(s);
    frames(s, 1);
    SluiceVulkanWaitStatus status = SLUICE_VULKAN_WAIT_FRAME;
    for (uint32_t n = 0; n < 60 && status == SLUICE_VULKAN_WAIT_FRAME; n++) {
        frames(s, 1);
        status = wait_for(s, request, 60000000000);
    }
    assert_int_equal(status, SLUICE_VULKAN_WAIT_FAILED);
    CHECK_OK(sluiceWithdrawVulkanRequest(s->streamer, request));
    assert_int_equal(wait_for(s, request, 0), SLUICE_VULKAN_WAIT_OVER);
    CHECK_RESULT(sluiceWaitVulkanRequest(s->streamer, request + 7, 0, &status),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    stage_finish(s);
}

void sources_of_another_shape_are_refused(void **state)
{
    (void)state;
    SluiceImageSource *wide = make_source(2 * SIZE, SLUICE_FORMAT_R8G8B8A8_UNORM);
    SluiceImageSource *srgb = make_source(SIZE, SLUICE_FORMAT_R8G8B8A8_SRGB);
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){0});
    const SluiceTextureId id = s->textures[0].textureId;
    CHECK_RESULT(sluiceReplaceVulkanSource(s->streamer, id, wide), SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(s->last, "the new source has 2048 x 1024"));
    assert_non_null(strstr(s->last, "remove the texture and add a new one"));
    CHECK_RESULT(sluiceReplaceVulkanSource(s->streamer, id, srgb), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceInvalidateVulkanTexture(s->streamer, id,
                                               &(SluiceImageRegion){0, 1000, 0, 25, 1, 0}, 1),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    frames(s, 3);
    assert_true(!is_in_use(s, wide) && is_in_use(s, &s->faults.base));
    stage_finish(s);
    sluiceDestroyImageSource(wide);
    sluiceDestroyImageSource(srgb);
}

/* Gives all tiles of one size the same identity. */
static bool identify(SluiceImageSource *source, const SluiceImageRegion *region, uint64_t *identity)
{
    (void)source, (void)region;
    *identity = 1;
    return true;
}

void equal_tiles_get_pages_of_their_own(void **state)
{
    (void)state;
    SluiceImageSource *source = make_source(SIZE, SLUICE_FORMAT_R8G8B8A8_UNORM);
    struct fault_source equal;
    fault_source_init(&equal, source);
    SluiceImageSourceInterface interface = *equal.base.pInterface;
    interface.pfnIdentifyRegion = identify;
    equal.base.pInterface = &interface;
    struct stage *s = begin(SLUICE_RESIDENCY_MODE_PAGED, &equal.base);
    CHECK_OK(sluiceReplaceVulkanSource(s->streamer, s->textures[1].textureId, &equal.base));
    s->seen[1][0] = 0;
    frames(s, 12);
    assert_true(statistics(s).tilesShared > 64); /* two pages at most, with the tail's */
    const SluiceImageRegion first = {.width = 1, .height = 1};
    struct fake_copy targets[3] = {{0}};
    for (uint32_t i = 0; i < 3; i++) { /* shared with all others, and then no longer */
        atomic_store(&shade, 8 + i);
        CHECK_OK(sluiceInvalidateVulkanTexture(s->streamer, s->textures[0].textureId, &first, 1));
        assert_int_equal(settle(s, 8 + i), 1);
        targets[i] = s->fake.copies[0];
    }
    assert_true(targets[1].image == targets[0].image && targets[1].layer == targets[0].layer);
    CHECK_OK(sluiceInvalidateVulkanTexture(s->streamer, s->textures[1].textureId, &first, 1));
    frames(s, 1);
    for (uint32_t i = 0; i < 4 && s->fake.copy_count == 0; i++)
        frames(s, 1);
    assert_int_equal(s->fake.copy_count, 1); /* not to the page of texture 0 */
    assert_true(s->fake.copies[0].image != targets[0].image ||
                s->fake.copies[0].layer != targets[0].layer);
    stage_finish(s);
    fault_source_finish(&equal);
    sluiceDestroyImageSource(source);
}

void reloads_survive_every_refused_allocation(void **state)
{
    (void)state;
    SluiceImageSource *source = make_source(SIZE, SLUICE_FORMAT_R8G8B8A8_UNORM);
    for (uint32_t replaces = 0; replaces < 2; replaces++) {
        struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){0});
        const SluiceTextureId id = s->textures[0].textureId;
        memset(s->seen[0], 0, sizeof s->seen[0]);
        frames(s, 12);
        SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
            s->memory.refuse_from = s->memory.calls + n;
            result = replaces ? sluiceReplaceVulkanSource(s->streamer, id, source)
                              : sluiceInvalidateVulkanTexture(s->streamer, id, NULL, UINT32_MAX);
            s->memory.refuse_from = UINT64_MAX;
            assert_true(n > 0 || result == SLUICE_ERROR_OUT_OF_HOST_MEMORY);
            assert_int_equal(state_now(s).reloadingTileCount, result ? 0 : 85);
            assert_true(is_in_use(s, &s->faults.base)); /* other textures have it, too */
        }
        frames(s, 12);
        assert_int_equal(state_now(s).reloadingTileCount, 0);
        stage_finish(s);
    }
    sluiceDestroyImageSource(source);
}
