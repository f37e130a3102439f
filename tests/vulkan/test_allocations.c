/* A camera moves in circles: after the first circle the streamer allocates no more memory. */
#include "vulkan/fake_vulkan.h"

#include "support/gray_source.h"
#include "support/test.h"

#include <stdatomic.h>
#include <stdlib.h>

/* REGIONS: of each texture, in tiles of FAKE_TILE. */
enum { TEXTURES = 40, REGIONS = 64, ROUND = 200, VIEW = 10 };

/* Shapes differ in size, with equal numbers of regions. */
enum { SHAPES = 3 };
static const uint32_t sizes[SHAPES][2] = {{1024, 1024}, {1000, 900}, {1024, 950}};

struct allocations {
    atomic_uint count; ///< loader threads may allocate, too
    SluiceAllocationCallbacks callbacks;
};

static void *allocate(void *user, size_t size, size_t alignment)
{
    struct allocations *a = user;
    atomic_fetch_add(&a->count, 1);
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void release(void *user, void *memory, size_t size)
{
    (void)user, (void)size;
    free(memory);
}

struct walk {
    struct fake_vulkan fake;
    struct allocations allocations;
    SluiceVulkanStreamer *streamer;
    SluiceImageSource *sources[SHAPES];
    uint32_t step;
};

/* Textures stand in a circle, and a window moves around: levels are finer near its middle. */
static uint8_t want(void *user, uint32_t region)
{
    const struct walk *w = user;
    uint32_t texture = region / REGIONS % TEXTURES;
    uint32_t first = (w->step % ROUND) * TEXTURES / ROUND;
    uint32_t at = (texture + TEXTURES - first) % TEXTURES;
    if (at >= VIEW)
        return SLUICE_MIP_UNTOUCHED;
    uint32_t off = at < VIEW / 2 ? VIEW / 2 - at : at - VIEW / 2;
    return (region * 0x9E3779B1u) >> 30 ? (uint8_t)(off / 3) : SLUICE_MIP_UNTOUCHED;
}

static void frame(struct walk *w)
{
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    w->step++;
    w->fake.published = false;
    w->fake.copy_count = w->fake.bind_count = w->fake.destroyed_count = w->fake.freed_count = 0;
    w->fake.bind_value = w->fake.submitted_bind_value;
    CHECK_OK(sluiceWaitVulkanStreamerIdle(w->streamer));
    CHECK_OK(
        sluiceBeginStreamingFrame(w->streamer, fake_vulkan_commands(&w->fake), w->step, &frame));
    CHECK_OK(sluiceEndStreamingFrame(w->streamer, fake_vulkan_commands(&w->fake)));
    w->fake.frame_semaphore = frame.semaphore;
    w->fake.frame_value = frame.signalValue;
}

static void walk_init(struct walk *w, SluiceResidencyMode mode, bool mixes, uint32_t share)
{
    *w = (struct walk){.fake = {.want = want, .user = w},
                       .allocations = {.callbacks = {&w->allocations, allocate, release}}};
    for (uint32_t i = 0; i < SHAPES; i++) {
        w->sources[i] = gray_source(sizes[i][0], sizes[i][1]);
    }
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .maxTextureCount = TEXTURES,
                                           .maxRegionCount = 16384,
                                           .texturesPerFrame = share,
                                           .heapTileCapacity = 64,
                                           .feedbackTimeoutTicks = 3 * TEXTURES / share + 10};
    w->fake.pAllocator = &w->allocations.callbacks;
    fake_vulkan_fill(&info);
    info.residencyMode = mode;
    info.pagedTextures = mixes;
    CHECK_OK(fake_vulkan_create(&w->fake, &info, &w->streamer));
    for (uint32_t i = 0; i < TEXTURES; i++) {
        SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create,
                                                .source = w->sources[i % SHAPES]};
        if (mixes && i % 2)
            create.residencyMode = SLUICE_RESIDENCY_MODE_PAGED;
        SluiceVulkanTexture texture;
        CHECK_OK(sluiceAddVulkanTexture(w->streamer, &create, &texture));
        assert_int_equal(texture.tableIndex, i);
    }
}

static void check_walk(SluiceResidencyMode mode, bool mixes, uint32_t share)
{
    static struct walk walk; /* large */
    walk_init(&walk, mode, mixes, share);
    for (uint32_t i = 0; i < 2 * ROUND; i++)
        frame(&walk);
    SluiceVulkanStreamerStatistics before = {.structSize = sizeof before},
                                   after = {.structSize = sizeof after};
    sluiceGetVulkanStreamerStatistics(walk.streamer, &before);
    uint32_t warm = atomic_load(&walk.allocations.count);
    assert_true(warm > 0);
    for (uint32_t i = 0; i < ROUND; i++)
        frame(&walk);
    sluiceGetVulkanStreamerStatistics(walk.streamer, &after);
    assert_true(after.tilesMapped - before.tilesMapped > 2 * TEXTURES);
    assert_true(after.tilesUnmapped - before.tilesUnmapped > 2 * TEXTURES);
    assert_int_equal(atomic_load(&walk.allocations.count), warm);
    fake_vulkan_destroy(walk.streamer);
    for (uint32_t i = 0; i < SHAPES; i++)
        sluiceDestroyImageSource(walk.sources[i]);
    assert_int_equal(walk.fake.live_objects, 0);
}

static void sparse_walk_allocates_nothing_in_its_later_rounds(void **state)
{
    (void)state;
    check_walk(SLUICE_RESIDENCY_MODE_SPARSE, false, TEXTURES);
    check_walk(SLUICE_RESIDENCY_MODE_SPARSE, false, 3);
}

static void paged_walk_allocates_nothing_in_its_later_rounds(void **state)
{
    (void)state;
    check_walk(SLUICE_RESIDENCY_MODE_PAGED, false, 3);
}

static void
a_walk_along_sparse_and_paged_textures_allocates_nothing_in_its_later_rounds(void **state)
{
    (void)state;
    check_walk(SLUICE_RESIDENCY_MODE_SPARSE, true, TEXTURES);
}

static void dense_walk_allocates_nothing_in_its_later_rounds(void **state)
{
    (void)state;
    check_walk(SLUICE_RESIDENCY_MODE_DENSE, false, 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sparse_walk_allocates_nothing_in_its_later_rounds),
        cmocka_unit_test(paged_walk_allocates_nothing_in_its_later_rounds),
        cmocka_unit_test(
            a_walk_along_sparse_and_paged_textures_allocates_nothing_in_its_later_rounds),
        cmocka_unit_test(dense_walk_allocates_nothing_in_its_later_rounds),
    };
    return RUN_TESTS(tests);
}
