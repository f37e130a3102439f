/* Textures of a set share what their maps asked for, and nobody can tell: docs/manager.md, "Sets".
 */
#include "core/fixture.h"

#include <string.h>

/* Heaps of 6 slots, one at most: too much is wanted from 22 tiles on. All happens at one time. */
static void feed_all(struct fixture *f, uint32_t count, const SluiceTextureId *ids, uint8_t level,
                     uint64_t timeout)
{
    for (uint32_t i = 0; i < count; i++)
        fixture_feed(f, ids[i], level, 1, timeout);
}

static void set_config(struct fixture *f, uint32_t prefetch_levels)
{
    const SluiceStreamedTextureManagerConfig config = {.numExtraStandbyTiles = 100,
                                                       .maxHeapCount = 1,
                                                       .missesToForget = 1,
                                                       .prefetchLevels = prefetch_levels};
    CHECK_OK(sluiceSetConfig(f->manager, &config));
}

static uint32_t bias_after_handing_out(struct fixture *f)
{
    assert_true(fixture_to_map(f, SLUICE_ALL_TEXTURES) >= 0);
    return fixture_statistics(f).globalMipBias;
}

/* The bias looks at maps that found a state: 6 textures hold something, so 6 of these are needed.
 */
static void an_empty_map_of_a_prefetched_primary_is_none_for_a_follower_without_state(void **state)
{
    (void)state;
    for (uint32_t more = 0; more < 2; more++) {
        struct fixture f;
        fixture_open(&f, 6, false);
        SluiceTextureId primary = fixture_add_small(&f), kept[2], others[4];
        for (uint32_t i = 0; i < 2; i++)
            kept[i] = fixture_add_small(&f);
        feed_all(&f, 2, kept, 2, 1000);
        set_config(&f, 1);
        assert_int_equal(bias_after_handing_out(&f), 0);
        CHECK_STATE(&f, primary, 4, CANCELLED); /* prefetched, so it has a state */
        set_config(&f, 0);
        SluiceTextureId follower = fixture_add_small(&f);
        CHECK_OK(sluiceSetPrimaryTexture(f.manager, follower, primary));
        for (uint32_t i = 0; i < 4; i++)
            others[i] = fixture_add_small(&f);
        feed_all(&f, 4, others, 0, 0);
        uint32_t bias = bias_after_handing_out(&f);
        assert_true(bias > 0);
        feed_all(&f, 4, others, SLUICE_MIP_UNTOUCHED, 0);
        for (; bias > 0; bias--) {
            feed_all(&f, 2, kept, 2, 1000);
            assert_int_equal(bias_after_handing_out(&f), bias - 1);
        }
        feed_all(&f, 4, others, 0, 0);
        fixture_feed(&f, primary, SLUICE_MIP_UNTOUCHED, 1, 0);
        if (more)
            fixture_feed(&f, primary, SLUICE_MIP_UNTOUCHED, 1, 0);
        assert_int_equal(bias_after_handing_out(&f) > 0, more);
        fixture_close(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_empty_map_of_a_prefetched_primary_is_none_for_a_follower_without_state),
    };
    return RUN_TESTS(tests);
}
