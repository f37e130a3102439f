/* Every block of device memory comes from an allocator of the application. It hands out parts of
 * large blocks at odd offsets, and sometimes refuses. */
#include "device/demand_runner.h"
#include "device/scene.h"

#include "support/roll.h"
#include "support/test.h"

#include <string.h>

#define MIB (UINT64_C(1) << 20)

enum { BLOCKS = 64, BLOCK_SIZE = 32 << 20 };

/* VkDeviceMemory that is divided from front to back. Freed when all parts are returned. */
struct big_block {
    VkDeviceMemory memory; ///< VK_NULL_HANDLE: free
    uint64_t size, end;
    uint8_t *mapped;
    uint32_t type, parts;
    bool images;
};

struct allocator {
    struct harness *h;
    struct big_block blocks[BLOCKS];
    uint32_t refuse_one_in; ///< one tile allocation in this many; 0: none
    uint32_t random;
    uint64_t live_bytes, bytes_by_purpose[6];
    uint32_t live_parts, parts, refused, at_odd_offsets;
};

static uint64_t random_below(struct allocator *a, uint64_t limit)
{
    a->random = a->random * 1664525u + 1013904223u;
    return (a->random >> 8) % limit;
}

/* Returns an odd multiple of the alignment, slightly behind the end. */
static uint64_t place_in(struct allocator *a, const struct big_block *b,
                         const SluiceDeviceMemoryRequest *r)
{
    uint64_t unit = b->end / r->alignment + 1 + random_below(a, 3);
    return (unit | 1) * r->alignment;
}

static VkResult make_block(struct allocator *a, struct big_block *b,
                           const SluiceDeviceMemoryRequest *r)
{
    uint64_t size = r->size + 8 * r->alignment;
    *b = (struct big_block){.size = size > BLOCK_SIZE ? size : BLOCK_SIZE,
                            .type = r->memoryTypeIndex,
                            .images = r->images};
    const VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                       .allocationSize = b->size,
                                       .memoryTypeIndex = b->type};
    VkResult result = a->h->AllocateMemory(a->h->device, &info, NULL, &b->memory);
    if (result != VK_SUCCESS)
        *b = (struct big_block){0};
    return result;
}

static VkResult allocate(void *user, const SluiceDeviceMemoryRequest *r, SluiceDeviceMemory *memory)
{
    struct allocator *a = user;
    assert_true(r->size > 0 && r->alignment > 0 && r->pName);
    bool tiles = r->purpose <= SLUICE_DEVICE_MEMORY_PURPOSE_PAGES;
    if (tiles && a->refuse_one_in && random_below(a, a->refuse_one_in) == 0) {
        a->refused++;
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    struct big_block *b = NULL, *unused = NULL;
    uint64_t offset = 0;
    for (uint32_t i = 0; i < BLOCKS && !b; i++) {
        struct big_block *at = &a->blocks[i];
        if (!at->memory)
            unused = at;
        else if (at->type == r->memoryTypeIndex && at->images == r->images &&
                 (offset = place_in(a, at, r)) + r->size <= at->size)
            b = at;
    }
    if (!b) {
        assert_non_null(unused);
        VkResult result = make_block(a, unused, r);
        if (result != VK_SUCCESS)
            return result;
        b = unused;
        offset = place_in(a, b, r);
    }
    assert_true(offset + r->size <= b->size);
    if (r->mapped && !b->mapped)
        assert_int_equal(
            a->h->MapMemory(a->h->device, b->memory, 0, VK_WHOLE_SIZE, 0, (void **)&b->mapped),
            VK_SUCCESS);
    b->end = offset + r->size;
    b->parts++;
    a->parts++;
    a->live_parts++;
    a->live_bytes += r->size;
    a->bytes_by_purpose[r->purpose] += r->size;
    a->at_odd_offsets += offset / r->alignment % 2;
    *memory = (SluiceDeviceMemory){.memory = b->memory,
                                   .offset = offset,
                                   .pMapped = r->mapped ? b->mapped + offset : NULL,
                                   .pAllocation = b};
    return VK_SUCCESS;
}

static void release(void *user, const SluiceDeviceMemory *memory)
{
    struct allocator *a = user;
    struct big_block *b = memory->pAllocation;
    assert_true(b->memory == memory->memory && b->parts > 0);
    a->live_parts--;
    if (--b->parts > 0)
        return;
    a->h->FreeMemory(a->h->device, b->memory, NULL);
    *b = (struct big_block){0};
}

static struct harness h;
static struct allocator allocator;
static SluiceDeviceMemoryCallbacks callbacks = {&allocator, allocate, release};

static SluiceVulkanContext *context_with(uint32_t refuse_one_in, uint64_t budget)
{
    allocator = (struct allocator){.h = &h, .random = 1, .refuse_one_in = refuse_one_in};
    SluiceVulkanContextCreateInfo info = harness_context_info(&h);
    info.pDeviceMemory = &callbacks;
    info.memoryBudget = budget;
    sluiceDestroyVulkanContext(h.context);
    CHECK_OK(sluiceCreateVulkanContext(&info, &h.context));
    return h.context;
}

static void context_without(void)
{
    CHECK_OK(harness_set_context(&h, NULL));
    assert_int_equal(allocator.live_parts, 0);
    assert_true(allocator.parts > 10);
    assert_int_equal(allocator.at_odd_offsets, allocator.parts);
    for (uint32_t i = 0; i < BLOCKS; i++)
        assert_true(allocator.blocks[i].memory == VK_NULL_HANDLE);
}

static SluiceVulkanContextStatistics statistics(void)
{
    SluiceVulkanContextStatistics s = {.structSize = sizeof s};
    CHECK_OK(sluiceGetVulkanContextStatistics(h.context, &s));
    return s;
}

static const struct scene_aim fine = {0.05, 0.05, 0.9, 0.9, 0.2, 0.3, 0, 0};

/* Streams until all is sharp, and checks every level shown meanwhile. Returns the number of
 * frames. */
static uint32_t stream(SluiceResidencyMode mode, uint32_t limit)
{
    struct scene scene;
    uint32_t frames = 0;
    scene_init(
        &scene, &h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .residencyMode = mode,
                                         .feedbackTimeoutTicks = 1000,
                                         .heapTileCapacity = 32});
    for (uint32_t i = 0; i < 3; i++) {
        uint32_t t = scene_add(
            &scene, pattern_source(PATTERN_LEVEL, 1024, 1024, SLUICE_FORMAT_R8G8B8A8_UNORM));
        scene_aim(&scene, t, 200, &fine);
    }
    do {
        scene_settle(&scene, 2);
        scene_check_levels(&scene);
        frames += 2;
    } while (scene_missing(&scene) > 0 && frames < limit);
    assert_int_equal(scene_missing(&scene), 0);
    assert_int_equal(allocator.live_parts, statistics().memoryBlockCount);
    scene_finish(&scene);
    return frames;
}

static const struct {
    SluiceResidencyMode mode;
    SluiceDeviceMemoryPurpose purpose;
} modes[] = {{SLUICE_RESIDENCY_MODE_SPARSE, SLUICE_DEVICE_MEMORY_PURPOSE_HEAP},
             {SLUICE_RESIDENCY_MODE_PAGED, SLUICE_DEVICE_MEMORY_PURPOSE_PAGES},
             {SLUICE_RESIDENCY_MODE_DENSE, SLUICE_DEVICE_MEMORY_PURPOSE_IMAGE}};

static void textures_stream_in_memory_of_the_application(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 3; i++) {
        if (modes[i].mode == SLUICE_RESIDENCY_MODE_SPARSE && !h.caps.sparse)
            continue;
        context_with(0, 0);
        stream(modes[i].mode, 40);
        for (int p = SLUICE_DEVICE_MEMORY_PURPOSE_TABLE; p < 6; p++)
            assert_true(allocator.bytes_by_purpose[p] > 0);
        assert_true(allocator.bytes_by_purpose[modes[i].purpose] >= 4 * MIB);
        context_without();
    }
}

static void refusals_cost_time_and_nothing_else(void **state)
{
    (void)state;
    uint32_t refused = 0;
    h.quiet = true;
    for (uint32_t i = 0; i < 2; i++) { /* dense images are allocated at the start or not at all */
        if (modes[i].mode == SLUICE_RESIDENCY_MODE_SPARSE && !h.caps.sparse)
            continue;
        context_with(0, 0);
        struct scene scene;
        scene_init(
            &scene, &h,
            (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                             .residencyMode = modes[i].mode,
                                             .feedbackTimeoutTicks = 1000,
                                             .heapTileCapacity = 8});
        uint32_t t = scene_add(
            &scene, pattern_source(PATTERN_LEVEL, 2048, 2048, SLUICE_FORMAT_R8G8B8A8_UNORM));
        scene_aim(&scene, t, 200, &fine);
        allocator.refuse_one_in = 2;
        for (uint32_t frame = 0; frame < 300 && (frame < 12 || scene_missing(&scene)); frame++) {
            scene_settle(&scene, 1);
            scene_check_levels(&scene);
        }
        assert_int_equal(scene_missing(&scene), 0);
        refused += allocator.refused;
        scene_finish(&scene);
        context_without();
    }
    h.quiet = false;
    assert_true(refused > 0);
}

static void demand_loading_takes_memory_of_the_application(void **state)
{
    (void)state;
    for (uint32_t refuse_one_in = 0; refuse_one_in < 3; refuse_one_in += 2) {
        struct runner r;
        struct runner_image image;
        context_with(0, 0);
        h.quiet = refuse_one_in > 0;
        runner_init(&r, &h, NULL);
        runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 2048, 2048, 7);
        SluiceDemandTextureId id = runner_add_texture(&r, &image);
        allocator.refuse_one_in = refuse_one_in;
        for (uint32_t i = 0; i < 256; i++)
            runner_add_texel(&r, id, 2048, 2048, 0, i % 16 * 128 + 5, i / 16 * 128 + 9);
        assert_true(runner_load(&r, 400) < 400);
        if (refuse_one_in == 0)
            for (uint32_t i = 0; i < 256; i++)
                runner_check_texel(&r, i, &image, 0, i % 16 * 128 + 5, i / 16 * 128 + 9);
        assert_true(allocator.bytes_by_purpose[SLUICE_DEVICE_MEMORY_PURPOSE_PAGES] > 0);
        runner_finish(&r);
        runner_image_finish(&image);
        context_without();
        h.quiet = false;
    }
}

/* One budget for a streamer's tiles and a demand loader's pages. */
static void budgets_hold_for_both_front_ends_together(void **state)
{
    (void)state;
    const uint64_t budget = 12 * MIB;
    for (uint32_t i = 0; i < 2; i++) {
        if (modes[i].mode == SLUICE_RESIDENCY_MODE_SPARSE && !h.caps.sparse)
            continue;
        context_with(0, budget);
        struct scene scene;
        struct runner r;
        struct runner_image image;
        h.quiet = true;
        scene_init(
            &scene, &h,
            (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                             .residencyMode = modes[i].mode,
                                             .feedbackTimeoutTicks = 1000,
                                             .heapTileCapacity = 16});
        uint32_t t = scene_add(
            &scene, pattern_source(PATTERN_LEVEL, 2048, 2048, SLUICE_FORMAT_R8G8B8A8_UNORM));
        scene_aim(&scene, t, 200, &fine);
        runner_init(&r, &h, NULL);
        runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 2048, 2048, 7);
        SluiceDemandTextureId id = runner_add_texture(&r, &image);
        for (uint32_t s = 0; s < 256; s++)
            runner_add_texel(&r, id, 2048, 2048, 0, s % 16 * 128 + 5, s / 16 * 128 + 9);
        for (uint32_t round = 0; round < 10; round++) {
            scene_settle(&scene, 2);
            scene_check_levels(&scene);
            runner_load(&r, 4);
            assert_true(statistics().tileMemorySize <= budget);
        }
        assert_true(statistics().tileMemorySize > budget / 2);
        assert_true(statistics().refusedBlockCount > 0);
        assert_int_equal(statistics().memoryBudget, budget);
        runner_finish(&r);
        runner_image_finish(&image);
        scene_finish(&scene);
        h.quiet = false;
        context_without();
    }
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(textures_stream_in_memory_of_the_application),
        cmocka_unit_test(refusals_cost_time_and_nothing_else),
        cmocka_unit_test(demand_loading_takes_memory_of_the_application),
        cmocka_unit_test(budgets_hold_for_both_front_ends_together),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
