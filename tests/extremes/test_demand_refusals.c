/* Refuses every allocation of every call of a demand loader. The next call must work. */
#include "device/demand_runner.h"
#include "extremes/note.h"
#include "support/failing_allocator.h"

#include <string.h>

static struct harness h;

struct life {
    struct failing_allocator memory;
    struct runner r;
    struct runner_image image, other;
    SluiceDemandTextureId texture, variant, grid;
    SluiceDemandResourceId resource, small, large, answered;
    uint32_t first_page, first_small, first_large, first_answered;
};

static SluiceResult fill(void *user, uint32_t page, uint64_t *value)
{
    (void)user;
    *value = 1000 + page;
    return SLUICE_SUCCESS;
}

static SluiceResult create_texture(struct life *l)
{
    const SluiceDemandTextureCreateInfo info = {.structSize = sizeof info,
                                                .image = runner_image_desc(&l->image),
                                                .pSampler = &runner_nearest};
    return sluiceAddDemandTexture(l->r.loader, &info, &l->texture);
}

static SluiceResult create_variant(struct life *l)
{
    const SluiceDemandSampler sampler = {.structSize = sizeof sampler, .maxAnisotropy = 8};
    return sluiceAddDemandTextureVariant(l->r.loader, l->texture, &sampler, &l->variant);
}

static SluiceResult create_grid(struct life *l)
{
    SluiceDemandTextureId ids[40];
    const SluiceDemandGridCreateInfo info = {
        .structSize = sizeof info, .columnCount = 8, .rowCount = 5, .pTextureIds = ids};
    for (uint32_t i = 0; i < 40; i++)
        ids[i] = i % 2 ? l->texture : SLUICE_NO_DEMAND_TEXTURE;
    return sluiceAddDemandGrid(l->r.loader, &info, &l->grid);
}

static SluiceResult create_resource(struct life *l)
{
    const SluiceDemandResourceCreateInfo info = {
        .structSize = sizeof info, .pageCount = 3000, .maxResidentPageCount = 100, .pfnFill = fill};
    return sluiceAddDemandResource(l->r.loader, &info, &l->resource, &l->first_page);
}

static SluiceResult read_bytes(void *user, uint32_t page, uint32_t size, void *bytes)
{
    (void)user;
    memset(bytes, (int)page, size);
    return SLUICE_SUCCESS;
}

static SluiceResult create_bytes(struct life *l)
{
    const SluiceDemandResourceCreateInfo info = {
        .structSize = sizeof info, .pageCount = 3000, .pageSize = 5000, .pfnRead = read_bytes};
    return sluiceAddDemandResource(l->r.loader, &info, &l->small, &l->first_small);
}

static SluiceResult create_large(struct life *l)
{
    const SluiceDemandResourceCreateInfo info = {.structSize = sizeof info,
                                                 .pageCount = 3000,
                                                 .maxResidentPageCount = 2,
                                                 .pageSize = 200000,
                                                 .pfnRead = read_bytes};
    return sluiceAddDemandResource(l->r.loader, &info, &l->large, &l->first_large);
}

static SluiceResult create_answered(struct life *l)
{
    const SluiceDemandResourceCreateInfo info = {.structSize = sizeof info, .pageCount = 3000};
    return sluiceAddDemandResource(l->r.loader, &info, &l->answered, &l->first_answered);
}

/* Sets more pages than the initial arrays of a loader hold. */
static SluiceResult set_pages(struct life *l)
{
    static const uint8_t bytes[5000];
    SluiceResult result = sluiceSetDemandPageBytes(l->r.loader, l->small, 2999, bytes, true);
    for (uint32_t i = 0; i < 200 && result >= 0; i++)
        result = sluiceSetDemandPageValue(l->r.loader, l->answered, i, i, i % 2);
    return result < 0 ? result : SLUICE_SUCCESS;
}

static SluiceResult preload(struct life *l)
{
    const SluiceImageRegion region = {.width = 1, .height = 1};
    SluiceDemandTicket ticket;
    SluiceResult result = sluicePreloadDemandRegion(l->r.loader, l->texture, &region, NULL);
    if (result == SLUICE_SUCCESS)
        result = sluicePreloadDemandTexture(l->r.loader, l->texture, 0, &ticket);
    if (result == SLUICE_SUCCESS)
        result = sluiceWaitDemandTicket(l->r.loader, ticket, UINT64_MAX, NULL);
    return result;
}

static SluiceResult launch(struct life *l)
{
    SluiceResult result = runner_submit(&l->r);
    if (result == SLUICE_SUCCESS)
        result = sluiceProcessDemandRequests(l->r.loader, &l->r.launch, UINT64_MAX, &l->r.requests,
                                             &l->r.ticket);
    if (result == SLUICE_SUCCESS)
        result = sluiceWaitDemandTicket(l->r.loader, l->r.ticket, UINT64_MAX, NULL);
    return result;
}

static SluiceResult replace(struct life *l)
{
    const SluiceDemandImage image = runner_image_desc(&l->other);
    return sluiceReplaceDemandImage(l->r.loader, l->texture, &image);
}

static SluiceResult invalidate(struct life *l)
{
    SluiceResult result = sluiceInvalidateDemandTexture(l->r.loader, l->texture);
    if (result == SLUICE_SUCCESS)
        result = sluiceInvalidateDemandPages(l->r.loader, l->resource, 1, 2000);
    if (result == SLUICE_SUCCESS)
        result = sluiceInvalidateDemandPages(l->r.loader, l->small, 10, 2000);
    return result;
}

static SluiceResult destroy(struct life *l)
{
    SluiceResult result = sluiceRemoveDemandTexture(l->r.loader, l->grid);
    if (result == SLUICE_SUCCESS)
        result = sluiceRemoveDemandTexture(l->r.loader, l->texture);
    if (result == SLUICE_SUCCESS)
        result = sluiceRemoveDemandResource(l->r.loader, l->resource);
    if (result == SLUICE_SUCCESS)
        result = sluiceRemoveDemandResource(l->r.loader, l->small);
    if (result == SLUICE_SUCCESS)
        result = sluiceRemoveDemandResource(l->r.loader, l->large);
    if (result == SLUICE_SUCCESS)
        result = sluiceRemoveDemandResource(l->r.loader, l->answered);
    return result;
}

/* Calls in the order of a loader's life. Launches between them use the created and changed
 * objects. */
static SluiceResult (*const calls[])(struct life *) = {
    create_texture,  create_variant, create_grid, create_resource, create_bytes, create_large,
    create_answered, set_pages,      launch,      launch,          launch,       preload,
    launch,          invalidate,     launch,      launch,          replace,      launch,
    launch,          launch,         destroy,     launch};
enum { CALLS = sizeof calls / sizeof calls[0] };

static void open_life(struct life *l)
{
    failing_allocator_init(&l->memory, UINT64_MAX);
    runner_image_init(&l->image, SLUICE_FORMAT_R8G8B8A8_UNORM, 300, 300, 1);
    runner_image_init(&l->other, SLUICE_FORMAT_R8G8B8A8_UNORM, 300, 300, 2);
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                               .memoryBudget = 8u << 20,
                                               .maxTextureCount = 64,
                                               .pageCapacity = 1u << 16,
                                               .maxTilesInFlight = 16};
    const SluiceVulkanContextCreateInfo context = {.pAllocator = &l->memory.callbacks,
                                                   .loaderThreadCount = 1};
    CHECK_OK(harness_set_context(&h, &context));
    runner_init(&l->r, &h, &info);
}

/* Checks which of two images level 0 shows, at a texel where they differ. */
static void check_shown(struct life *l, struct runner_image *image)
{
    runner_clear(&l->r);
    runner_add_texel(&l->r, l->texture, 300, 300, 0, 299, 299);
    /* After a refused image of pages, the loader waits 60 launches before it tries again. */
    for (uint32_t i = 0;
         i < 3 || (i < 200 && (l->r.requests.missingCount || l->r.requests.lodBias > 0.0f)); i++)
        CHECK_OK(launch(l));
    assert_int_equal(l->r.requests.missingCount, 0);
    runner_check_texel(&l->r, 0, image, 0, 299, 299);
}

static void aim(struct life *l)
{
    runner_clear(&l->r);
    runner_add_texel(&l->r, l->texture, 300, 300, 0, 299, 299);
    for (uint32_t i = 0; i < 50; i++)
        runner_add_page(&l->r, l->first_page + i * 50);
    for (uint32_t i = 0; i < 20; i++)
        runner_add_page(&l->r, l->first_small + i * 50);
    for (uint32_t i = 0; i < 300; i++)
        runner_add_page(&l->r, l->first_answered + 100 + i);
    for (uint32_t i = 0; i < 2; i++)
        runner_add_page(&l->r, l->first_large + i * 50);
}

/* Lets call `step` run with n allocations refused in turn, after all earlier calls succeeded. */
static uint64_t press(struct life *l, uint32_t step, bool lasting)
{
    for (uint64_t n = 0;; n++) {
        assert_true(n < 300);
        l->memory.refuse_from = l->memory.calls + n;
        l->memory.refuse_count = lasting ? 0 : 1;
        SluiceResult result = calls[step](l);
        bool refused = l->memory.calls > l->memory.refuse_from;
        l->memory.refuse_from = UINT64_MAX;
        if (result == SLUICE_SUCCESS && !refused)
            return n;
        if (result == SLUICE_SUCCESS && calls[step] != launch)
            return n + 1; /* succeeded without it */
        if (result != SLUICE_SUCCESS)
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    }
}

static void every_call_survives_every_refused_allocation(void **state)
{
    (void)state;
    uint64_t refusals = 0, left = 0;
    h.quiet = true;
    for (uint32_t lasting = 0; lasting < 2; lasting++) {
        static struct life l;
        l = (struct life){0};
        open_life(&l);
        for (uint32_t step = 0; step < CALLS; step++) {
            refusals += press(&l, step, lasting);
            if (calls[step] == set_pages)
                aim(&l);
            if (calls[step] == preload)
                check_shown(&l, &l.image);
            if (calls[step] == replace)
                check_shown(&l, &l.other);
        }
        runner_finish(&l.r);
        CHECK_OK(harness_set_context(&h, NULL));
        left += l.memory.live_count + (l.image.opened - l.image.closed) +
                (l.other.opened - l.other.closed);
        runner_image_finish(&l.image);
        runner_image_finish(&l.other);
    }
    h.quiet = false;
    note("demand loader: refused allocations, what is left behind", refusals, (double)left, 0);
    assert_int_equal(left, 0);
    assert_true(refusals > 20);
}

static void questions_take_no_memory(void **state)
{
    (void)state;
    static struct life l;
    l = (struct life){0};
    open_life(&l);
    for (uint32_t step = 0; step < 10; step++)
        CHECK_OK(calls[step](&l));
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    SluiceDemandLaunch launch = {.structSize = sizeof launch};
    assert_int_equal(h.DeviceWaitIdle(h.device), VK_SUCCESS);
    assert_int_equal(h.BeginCommandBuffer(h.commands[0], &begin), VK_SUCCESS);
    CHECK_OK(sluiceBeginDemandLaunch(l.r.loader, h.commands[0], &launch));
    uint64_t calls_before = l.memory.calls;
    l.memory.refuse_from = 0;
    CHECK_OK(sluiceAbandonDemandLaunch(l.r.loader, &launch));
    SluiceDemandBuffers buffers = {.structSize = sizeof buffers};
    SluiceVulkanPages pages = {.structSize = sizeof pages};
    SluiceDemandByteBuffers byte_buffers = {.structSize = sizeof byte_buffers};
    VkDescriptorSetLayout layout;
    SluiceDemandTicketStatus status = {.structSize = sizeof status};
    sluiceGetDemandBuffers(l.r.loader, &buffers);
    sluiceGetDemandPages(l.r.loader, &pages);
    sluiceGetDemandByteBuffers(l.r.loader, &byte_buffers);
    uint32_t missed[8], missed_count = 8;
    CHECK_RESULT(sluiceGetMissedDemandPages(l.r.loader, l.answered, &missed_count, missed),
                 SLUICE_SUCCESS);
    CHECK_OK(sluiceGetDemandDescriptorSetLayout(l.r.loader, &layout));
    (void)runner_statistics(&l.r);
    CHECK_OK(sluiceGetDemandTicketStatus(l.r.loader, l.r.ticket, &status));
    CHECK_OK(sluiceWaitDemandTicket(l.r.loader, l.r.ticket, 0, NULL));
    CHECK_OK(sluiceCancelDemandTicket(l.r.loader, l.r.ticket));
    CHECK_OK(sluiceAbortDemandLoader(l.r.loader));
    assert_int_equal(l.memory.calls, calls_before);
    l.memory.refuse_from = UINT64_MAX;
    runner_finish(&l.r);
    CHECK_OK(harness_set_context(&h, NULL));
    assert_int_equal(h.EndCommandBuffer(h.commands[0]), VK_SUCCESS);
    assert_int_equal(l.memory.live_count, 0);
    runner_image_finish(&l.image);
    runner_image_finish(&l.other);
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_call_survives_every_refused_allocation),
        cmocka_unit_test(questions_take_no_memory),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
