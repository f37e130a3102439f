/* Byte pages: a callback writes them, shaders read each byte of them. The oracle is the function
 * that wrote them: shaders return a hash of all bytes of a page. */
#include "device/demand_runner.h"

#include "support/test.h"

#include <stdatomic.h>
#include <string.h>

static struct harness h;

/* A kind of page. */
struct store {
    uint32_t size, seed;
    atomic_uint reads;
    atomic_uint wrong;
    uint32_t failing_page; ///< UINT32_MAX: none
    atomic_uint failures;  ///< number of its reads that fail
    atomic_uint later;     ///< number of reads that return NOT_READY first
    SluiceDemandResourceId id;
    uint32_t first;
};

static uint8_t byte_of(const struct store *s, uint32_t page, uint32_t at)
{
    uint32_t x = (page * 2654435761u ^ at * 40503u) + s->seed * 977u;
    x ^= x >> 15;
    x *= 2246822519u;
    return (uint8_t)(x >> 13);
}

static uint32_t hash_of(const struct store *s, uint32_t page)
{
    uint32_t sum = 2166136261u;
    for (uint32_t i = 0; i < s->size; i++)
        sum = (sum ^ byte_of(s, page, i)) * 16777619u;
    return sum;
}

static SluiceResult read_page(void *user, uint32_t page, uint32_t size, void *bytes)
{
    struct store *s = user;
    atomic_fetch_add(&s->reads, 1);
    if (size != s->size)
        atomic_fetch_add(&s->wrong, 1);
    if (atomic_load(&s->later)) {
        atomic_fetch_sub(&s->later, 1);
        return SLUICE_NOT_READY;
    }
    if (page == s->failing_page && atomic_load(&s->failures)) {
        atomic_fetch_sub(&s->failures, 1);
        memset(bytes, 0xEE, size);
        return SLUICE_ERROR_UNSUPPORTED;
    }
    for (uint32_t i = 0; i < size; i++)
        ((uint8_t *)bytes)[i] = byte_of(s, page, i);
    return SLUICE_SUCCESS;
}

static void store_init(struct store *s, uint32_t size)
{
    memset(s, 0, sizeof *s);
    s->size = size;
    s->seed = size;
    s->failing_page = UINT32_MAX;
}

static void store_add(struct runner *r, struct store *s, uint32_t pages, uint32_t limit,
                      bool offsets)
{
    const SluiceDemandResourceCreateInfo info = {.structSize = sizeof info,
                                                 .pageCount = pages,
                                                 .rank = 4,
                                                 .maxResidentPageCount = limit,
                                                 .pUserData = s,
                                                 .pageSize = s->size,
                                                 .byteOffsets = offsets,
                                                 .pfnRead = read_page};
    CHECK_OK(sluiceAddDemandResource(r->loader, &info, &s->id, &s->first));
}

static void add_page(struct runner *r, const struct store *s, uint32_t page, bool offsets)
{
    runner_add(r, (struct RunnerInput){.kind = offsets ? RUNNER_BYTES : RUNNER_ADDRESS,
                                       .index = s->first + page,
                                       .dx = {(float)s->size}});
}

static void check_page(const struct runner *r, const struct store *s, uint32_t sample,
                       uint32_t page)
{
    struct RunnerOutput out = runner_output(r, sample);
    assert_true(out.resident);
    assert_int_equal(out.value[0], hash_of(s, page));
    assert_int_equal(out.value[1], 0); /* its place is a multiple of 16 bytes */
}

static void open_runner(struct runner *r, uint64_t budget, uint64_t bytes, bool addresses)
{
    if (!h.reads_bytes)
        skip();
    const SluiceDemandLoaderCreateInfo create = {.structSize = sizeof create,
                                                 .memoryBudget = budget,
                                                 .byteMemoryBudget = bytes,
                                                 .bufferDeviceAddress = addresses};
    h.runs_bytes = true;
    runner_init(r, &h, &create);
}

/* Sizes around those of words, the alignment, staging slots and slabs. */
static const uint32_t sizes[] = {1,     3,     4,     15,     16,      17,      100,
                                 65535, 65536, 65537, 131072, 1000000, 1048575, 1048576};
enum { SIZES = sizeof sizes / sizeof sizes[0] };

static void check_every_size(bool addresses, bool offsets)
{
    struct runner r;
    struct store stores[SIZES];
    open_runner(&r, 128u << 20, 64u << 20, addresses);
    for (uint32_t i = 0; i < SIZES; i++) {
        store_init(&stores[i], sizes[i]);
        store_add(&r, &stores[i], 100, 0, offsets);
        add_page(&r, &stores[i], 0, offsets);
        add_page(&r, &stores[i], 99, offsets);
    }
    runner_load(&r, 20);
    assert_int_equal(r.requests.missingCount, 0);
    for (uint32_t i = 0; i < SIZES; i++) {
        check_page(&r, &stores[i], 2 * i, 0);
        check_page(&r, &stores[i], 2 * i + 1, 99);
        assert_int_equal(stores[i].reads, 2);
        assert_int_equal(stores[i].wrong, 0);
    }
    SluiceDemandStatistics s = runner_statistics(&r);
    assert_int_equal(s.residentBytePageCount, 2 * SIZES);
    assert_int_equal(s.residentResourcePageCount, 0);
    assert_true(s.byteMemorySize > 0 && s.byteMemorySize <= 64u << 20);
    assert_true(s.byteChunkCount >= 1);
    runner_finish(&r);
}

static void shaders_read_pages_of_every_size_by_offsets(void **state)
{
    (void)state;
    check_every_size(false, true);
}

static void shaders_read_pages_of_every_size_by_addresses(void **state)
{
    (void)state;
    check_every_size(true, false);
}

static void a_loader_with_addresses_has_resources_with_offsets(void **state)
{
    (void)state;
    check_every_size(true, true);
}

/* Uses more pages than fit, in turns. Each page is right whenever it is resident. */
static void evicted_pages_come_back_right(void **state)
{
    (void)state;
    enum { PAGES = 400, SEEN = 50 };
    for (uint32_t limited = 0; limited < 2; limited++) {
        struct runner r;
        struct store small, large;
        open_runner(&r, 32u << 20, 4u << 20, true);
        store_init(&small, 20000);
        store_init(&large, 300000);
        store_add(&r, &small, PAGES, limited ? 60 : 0, false);
        store_add(&r, &large, PAGES, limited ? 6 : 0, false);
        for (uint32_t round = 0; round < 24; round++) {
            runner_clear(&r);
            for (uint32_t i = 0; i < SEEN; i++)
                add_page(&r, &small, (round * 31 + i) % PAGES, false);
            for (uint32_t i = 0; i < 4; i++)
                add_page(&r, &large, (round * 3 + i) % PAGES, false);
            runner_load(&r, 60);
            assert_int_equal(r.requests.missingCount, 0);
            for (uint32_t i = 0; i < SEEN; i++)
                check_page(&r, &small, i, (round * 31 + i) % PAGES);
            for (uint32_t i = 0; i < 4; i++)
                check_page(&r, &large, SEEN + i, (round * 3 + i) % PAGES);
            assert_true(runner_statistics(&r).byteMemorySize <= 4u << 20);
        }
        SluiceDemandStatistics s = runner_statistics(&r);
        assert_true(s.evictedCount > 100);
        assert_int_equal(small.wrong + large.wrong, 0);
        assert_int_equal(s.bytesRead,
                         (uint64_t)small.reads * small.size + (uint64_t)large.reads * large.size);
        runner_finish(&r);
    }
}

/* A size takes what another had: slabs change their stride. */
static void memory_moves_between_sizes(void **state)
{
    (void)state;
    struct runner r;
    struct store stores[5];
    open_runner(&r, 16u << 20, 4u << 20, true);
    for (uint32_t i = 0; i < 5; i++) {
        store_init(&stores[i], 1000 + 60000 * i);
        store_add(&r, &stores[i], 4000, 0, false);
    }
    for (uint32_t round = 0; round < 10; round++) {
        const struct store *s = &stores[round * 3 % 5];
        uint32_t count = (3u << 20) / (s->size + 16);
        runner_clear(&r);
        for (uint32_t i = 0; i < count; i++)
            add_page(&r, s, i, false);
        runner_load(&r, 200);
        assert_int_equal(r.requests.missingCount, 0);
        for (uint32_t i = 0; i < count; i += 7)
            check_page(&r, s, i, i);
    }
    runner_finish(&r);
}

static void pages_that_went_and_whose_slot_nobody_took_come_back_unread(void **state)
{
    (void)state;
    struct runner r;
    struct store s;
    enum { COUNT = 60 };
    open_runner(&r, 32u << 20, 4u << 20, true);
    store_init(&s, 4096);
    store_add(&r, &s, 3000, COUNT, false);
    for (uint32_t half = 0; half < 2; half++) { /* the limit evicts, and slots are left */
        runner_clear(&r);
        for (uint32_t i = 0; i < COUNT; i++)
            add_page(&r, &s, half * COUNT + i, false);
        runner_load(&r, 9);
    }
    uint32_t reads = s.reads;
    runner_clear(&r);
    for (uint32_t i = 0; i < COUNT; i++)
        add_page(&r, &s, i, false);
    runner_load(&r, 9);
    for (uint32_t i = 0; i < COUNT; i++)
        check_page(&r, &s, i, i);
    assert_int_equal(s.reads, reads);
    assert_int_equal(runner_statistics(&r).restoredCount, COUNT);
    runner_finish(&r);
}

static void a_page_that_fails_is_missing_and_tried_again(void **state)
{
    (void)state;
    for (uint32_t large = 0; large < 2; large++) {
        struct runner r;
        struct store s;
        if (!h.reads_bytes)
            skip();
        const SluiceDemandLoaderCreateInfo create = {.structSize = sizeof create,
                                                     .failureRetryDelayNs = 1000000};
        h.runs_bytes = true;
        runner_init(&r, &h, &create);
        store_init(&s, large ? 200000 : 200);
        s.failing_page = 5;
        s.failures = 1;
        store_add(&r, &s, 64, 0, true);
        add_page(&r, &s, 4, true);
        add_page(&r, &s, 5, true);
        h.quiet = true;
        for (uint32_t i = 0; i < 3; i++) {
            runner_launch(&r);
            CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, NULL));
        }
        h.quiet = false;
        check_page(&r, &s, 0, 4);
        for (uint32_t i = 0; i < 1000 && !runner_output(&r, 1).resident; i++)
            runner_launch(&r);
        check_page(&r, &s, 1, 5);
        assert_int_equal(runner_statistics(&r).failedCount, 1);
        runner_finish(&r);
    }
}

static void invalidated_pages_are_read_again(void **state)
{
    (void)state;
    struct runner r;
    struct store s;
    open_runner(&r, 32u << 20, 4u << 20, true);
    store_init(&s, 5000);
    store_add(&r, &s, 40, 0, false);
    for (uint32_t i = 0; i < 40; i++)
        add_page(&r, &s, i, false);
    runner_load(&r, 9);
    for (uint32_t round = 0; round < 9; round++) { /* at every moment of a read */
        s.seed++;
        CHECK_OK(sluiceInvalidateDemandPages(r.loader, s.id, 0, 40));
        for (uint32_t i = 0; i < round; i++)
            runner_launch(&r);
        s.seed++;
        CHECK_OK(sluiceInvalidateDemandPages(r.loader, s.id, 0, 40));
        runner_load(&r, 9);
        for (uint32_t i = 0; i < 40; i++)
            check_page(&r, &s, i, i);
    }
    runner_finish(&r);
}

static void chunks_that_run_empty_are_freed(void **state)
{
    (void)state;
    struct runner r;
    struct store s;
    open_runner(&r, 64u << 20, 32u << 20, true);
    store_init(&s, 65536);
    store_add(&r, &s, 1000, 0, false);
    for (uint32_t i = 0; i < 400; i++)
        add_page(&r, &s, i, false);
    runner_load(&r, 20);
    assert_true(runner_statistics(&r).byteMemorySize >= 400u * 65536);
    CHECK_OK(sluiceInvalidateDemandPages(r.loader, s.id, 0, 1000));
    runner_clear(&r);
    for (uint32_t i = 0; i < 70; i++)
        runner_launch(&r);
    assert_int_equal(runner_statistics(&r).byteMemorySize, 0);
    assert_int_equal(runner_statistics(&r).byteChunkCount, 0);
    add_page(&r, &s, 7, false);
    runner_load(&r, 9);
    check_page(&r, &s, 0, 7);
    runner_finish(&r);
}

/* Launches under way read pages of a resource that goes. */
static void removed_resources_give_their_memory_back(void **state)
{
    (void)state;
    struct runner r;
    open_runner(&r, 16u << 20, 4u << 20, true);
    for (uint32_t round = 0; round < 6; round++) {
        struct store s;
        store_init(&s, 30000 + round * 20000);
        store_add(&r, &s, 40, round % 2 ? 30 : 0, false);
        runner_clear(&r);
        for (uint32_t i = 0; i < 20; i++)
            add_page(&r, &s, i, false);
        if (round != 3)
            runner_load(&r, 60);
        for (uint32_t i = 0; i < 20 && round != 3; i++)
            check_page(&r, &s, i, i);
        CHECK_OK(runner_submit(&r));
        CHECK_OK(sluiceRemoveDemandResource(r.loader, s.id));
        CHECK_RESULT(sluiceInvalidateDemandPages(r.loader, s.id, 0, 1), SLUICE_ERROR_STALE_TEXTURE);
        CHECK_OK(sluiceProcessDemandRequests(r.loader, &r.launch, UINT64_MAX, &r.requests, NULL));
    }
    runner_finish(&r);
}

/* Copies of abandoned launches are made by the next one. */
static void abandoned_launches_lose_no_page(void **state)
{
    (void)state;
    struct runner r;
    struct store s;
    open_runner(&r, 16u << 20, 2u << 20, true);
    store_init(&s, 50000);
    store_add(&r, &s, 200, 0, false);
    for (uint32_t round = 0; round < 10; round++) {
        runner_clear(&r);
        for (uint32_t i = 0; i < 20; i++)
            add_page(&r, &s, (round * 20 + i) % 200, false);
        runner_launch(&r);
        CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, NULL));
        VkCommandBuffer commands = h.commands[(r.launch.launchIndex + 1) % RUNNER_LAUNCHES];
        const VkCommandBufferBeginInfo begin = {.sType =
                                                    VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
        SluiceDemandLaunch launch = {.structSize = sizeof launch};
        assert_int_equal(h.ResetCommandBuffer(commands, 0), VK_SUCCESS);
        assert_int_equal(h.BeginCommandBuffer(commands, &begin), VK_SUCCESS);
        CHECK_OK(sluiceBeginDemandLaunch(r.loader, commands, &launch));
        assert_int_equal(h.EndCommandBuffer(commands), VK_SUCCESS);
        if (round % 3 == 1)
            CHECK_OK(sluiceInvalidateDemandPages(r.loader, s.id, 0, 200));
        CHECK_OK(sluiceAbandonDemandLaunch(r.loader, &launch));
        if (round % 3 == 2)
            CHECK_OK(sluiceInvalidateDemandPages(r.loader, s.id, 0, 200));
        uint32_t reads = s.reads;
        runner_load(&r, 60);
        assert_true(round % 3 != 0 || s.reads == reads);
        for (uint32_t i = 0; i < 20; i++)
            check_page(&r, &s, i, (round * 20 + i) % 200);
    }
    runner_finish(&r);
}

static void pages_that_wait_for_staging_memory_blur_no_texture(void **state)
{
    (void)state;
    struct runner r;
    struct store s;
    if (!h.reads_bytes)
        skip();
    const SluiceDemandLoaderCreateInfo create = {
        .structSize = sizeof create, .memoryBudget = 16u << 20, .maxTilesInFlight = 16};
    h.runs_bytes = true;
    runner_init(&r, &h, &create);
    store_init(&s, 1000);
    store_add(&r, &s, 3000, 0, true);
    for (uint32_t i = 0; i < 3000; i++)
        add_page(&r, &s, i, true);
    for (uint32_t i = 0; i < 4; i++) {
        runner_launch(&r);
        assert_true(r.requests.postponedCount > 1000); /* more than there is room for tiles */
        assert_true(r.requests.lodBias == 0.0f);
    }
    runner_load(&r, 400);
    assert_int_equal(r.requests.missingCount, 0);
    runner_finish(&r);
}

static SluiceResult fill(void *user, uint32_t page, uint64_t *value)
{
    (void)user;
    *value = page;
    return SLUICE_SUCCESS;
}

static void wrong_arguments_are_refused(void **state)
{
    (void)state;
    struct runner r;
    struct store s;
    SluiceDemandLoader *loader;
    open_runner(&r, 16u << 20, 0, false);
    store_init(&s, 100);
    SluiceDemandResourceId id;
    uint32_t first;
    const SluiceDemandResourceCreateInfo good = {.structSize = sizeof good,
                                                 .pageCount = 10,
                                                 .pUserData = &s,
                                                 .pageSize = 100,
                                                 .pfnRead = read_page};
    SluiceDemandResourceCreateInfo info = good;
    h.quiet = true;
    info.pageSize = (1u << 20) + 1;
    CHECK_RESULT(sluiceAddDemandResource(r.loader, &info, &id, &first),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(h.last_message, "pageSize is 1048577"));
    info = good;
    info.pageSize = 0; /* pfnRead is for bytes, pfnFill for values */
    CHECK_RESULT(sluiceAddDemandResource(r.loader, &info, &id, &first),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(h.last_message, "pfnRead"));
    info = good;
    info.pfnFill = fill;
    CHECK_RESULT(sluiceAddDemandResource(r.loader, &info, &id, &first),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    info = good;
    info.rank = 16;
    CHECK_RESULT(sluiceAddDemandResource(r.loader, &info, &id, &first),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(h.last_message, "rank"));
    for (uint32_t i = 0; i <= 256; i++) {
        info = good;
        info.pageSize = 16 + 16 * i;
        CHECK_RESULT(sluiceAddDemandResource(r.loader, &info, &id, &first),
                     i < 256 ? SLUICE_SUCCESS : SLUICE_ERROR_LIMIT_EXCEEDED);
    }
    SluiceDemandLoaderCreateInfo create = {.structSize = sizeof create,
                                           .context = h.context,
                                           .memoryBudget = 8u << 20,
                                           .byteMemoryBudget = 9u << 20};
    CHECK_RESULT(sluiceCreateDemandLoader(&create, &loader), SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(h.last_message, "byteMemoryBudget"));
    create.byteMemoryBudget = 100;
    CHECK_RESULT(sluiceCreateDemandLoader(&create, &loader), SLUICE_ERROR_INVALID_ARGUMENT);
    h.quiet = false;
    runner_finish(&r);
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shaders_read_pages_of_every_size_by_offsets),
        cmocka_unit_test(shaders_read_pages_of_every_size_by_addresses),
        cmocka_unit_test(a_loader_with_addresses_has_resources_with_offsets),
        cmocka_unit_test(evicted_pages_come_back_right),
        cmocka_unit_test(memory_moves_between_sizes),
        cmocka_unit_test(pages_that_went_and_whose_slot_nobody_took_come_back_unread),
        cmocka_unit_test(a_page_that_fails_is_missing_and_tried_again),
        cmocka_unit_test(invalidated_pages_are_read_again),
        cmocka_unit_test(chunks_that_run_empty_are_freed),
        cmocka_unit_test(removed_resources_give_their_memory_back),
        cmocka_unit_test(abandoned_launches_lose_no_page),
        cmocka_unit_test(pages_that_wait_for_staging_memory_blur_no_texture),
        cmocka_unit_test(wrong_arguments_are_refused),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
