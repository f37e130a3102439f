/* Threads side by side, and the image source that they share. */
#include "crew.h"
#include "shared_source.h"

#include "support/test.h"

#include <stdatomic.h>

#define MOST 8u

struct calls {
    atomic_uint count[MOST];
    atomic_uint meeting; ///< members that have come
    uint32_t expected;   ///< ... that wait for each other
    uint32_t failing;    ///< member
};

static bool note_call(void *user_data, uint32_t index)
{
    struct calls *calls = user_data;
    atomic_fetch_add(&calls->count[index], 1);
    atomic_fetch_add(&calls->meeting, 1);
    while (atomic_load(&calls->meeting) < calls->expected)
        ;
    return index != calls->failing;
}

/* They would wait forever, if one began after another. */
static void members_work_at_the_same_time_and_once(void **state)
{
    (void)state;
    for (uint32_t count = 1; count <= MOST; count++) {
        struct calls calls = {.expected = count, .failing = MOST};
        assert_true(crew_run(count, note_call, &calls));
        for (uint32_t i = 0; i < MOST; i++)
            assert_int_equal(atomic_load(&calls.count[i]), i < count);
    }
}

static void one_failure_fails_the_crew_after_all_have_worked(void **state)
{
    (void)state;
    for (uint32_t failing = 0; failing < 3; failing++) {
        struct calls calls = {.failing = failing};
        assert_false(crew_run(3, note_call, &calls));
        assert_int_equal(atomic_load(&calls.meeting), 3);
    }
}

/** A source that counts how often it is opened and destroyed. */
struct counted {
    SluiceImageSource base;
    uint32_t opened, destroyed;
    SluiceResult result;
};

static SluiceResult get_info(SluiceImageSource *source, SluiceImageInfo *info)
{
    (void)source;
    (void)info;
    return SLUICE_SUCCESS;
}

static SluiceResult read_region(SluiceImageSource *source, const SluiceImageRegion *region,
                                void *texels, size_t pitch, SluiceImageFault *fault)
{
    (void)source, (void)region, (void)texels, (void)pitch, (void)fault;
    return SLUICE_SUCCESS;
}

static void destroy(SluiceImageSource *source)
{
    ((struct counted *)source)->destroyed++;
}

static SluiceResult open(void *user_data, SluiceImageSource **source)
{
    static const SluiceImageSourceInterface interface = {.structSize = sizeof interface,
                                                         .pfnGetInfo = get_info,
                                                         .pfnDestroy = destroy,
                                                         .pfnReadRegionLocated = read_region};
    struct counted *counted = user_data;
    if (counted->result != SLUICE_SUCCESS)
        return counted->result;
    counted->base.pInterface = &interface;
    counted->opened++;
    *source = &counted->base;
    return SLUICE_SUCCESS;
}

static void all_users_get_one_source_that_the_last_destroys(void **state)
{
    (void)state;
    struct counted counted = {0};
    struct shared_source shared;
    SluiceImageSource *sources[3] = {0};
    assert_true(shared_source_init(&shared, open, &counted));
    for (int round = 1; round <= 2; round++) {
        for (int i = 0; i < 3; i++) {
            CHECK_OK(shared_source_open(&shared, &sources[i]));
            assert_ptr_equal(sources[i], &counted.base);
        }
        assert_int_equal(counted.opened, round);
        for (int i = 0; i < 3; i++) {
            assert_int_equal(counted.destroyed, round - 1);
            shared_source_close(&shared, sources[i]);
        }
        assert_int_equal(counted.destroyed, round);
    }
    shared_source_finish(&shared);
}

static void a_failed_opening_is_tried_by_the_next_user(void **state)
{
    (void)state;
    struct counted counted = {.result = SLUICE_ERROR_IO};
    struct shared_source shared;
    SluiceImageSource *source = NULL;
    assert_true(shared_source_init(&shared, open, &counted));
    CHECK_RESULT(shared_source_open(&shared, &source), SLUICE_ERROR_IO);
    assert_null(source);
    counted.result = SLUICE_SUCCESS;
    CHECK_OK(shared_source_open(&shared, &source));
    shared_source_close(&shared, source);
    assert_int_equal(counted.destroyed, 1);
    shared_source_finish(&shared);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(members_work_at_the_same_time_and_once),
        cmocka_unit_test(one_failure_fails_the_crew_after_all_have_worked),
        cmocka_unit_test(all_users_get_one_source_that_the_last_destroys),
        cmocka_unit_test(a_failed_opening_is_tried_by_the_next_user),
    };
    return RUN_TESTS(tests);
}
