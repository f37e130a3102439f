/* Sources behind a slow line, with a clock that the test sets. */
#include "slow_source.h"

#include "support/fault_source.h"
#include "support/test.h"

#include <string.h>

enum { SIZE = 64, PART = 16, PART_BYTES = PART * PART };

/** A picture of bytes whose values tell their position, behind a line. */
struct rig {
    uint64_t now;
    struct slow_line line;
    SluiceImageSource *memory, *slow;
    struct fault_source inner;
};

static uint64_t clock_of_rig(void *user_data)
{
    return *(const uint64_t *)user_data;
}

static uint8_t texel_at(uint32_t x, uint32_t y)
{
    return (uint8_t)(x * 7 + y * 13);
}

static void set_up(struct rig *rig, double latency, double bandwidth)
{
    static uint8_t texels[SIZE * SIZE];
    for (uint32_t i = 0; i < SIZE * SIZE; i++)
        texels[i] = texel_at(i % SIZE, i / SIZE);
    *rig = (struct rig){.now = 5000};
    struct slow_line_info line = {latency, bandwidth, clock_of_rig, &rig->now};
    SluiceImageInfo info = {sizeof info, SIZE, SIZE, 0, SLUICE_FORMAT_R8_UNORM, "bytes"};
    CHECK_OK(sluiceCreateMemoryImageSource(texels, &info, NULL, &rig->memory));
    fault_source_init(&rig->inner, rig->memory);
    assert_true(slow_line_init(&rig->line, &line));
    CHECK_OK(slow_source_create(&rig->line, &rig->inner.base, &rig->slow));
}

static void tear_down(struct rig *rig)
{
    sluiceDestroyImageSource(rig->slow);
    slow_line_finish(&rig->line);
    fault_source_finish(&rig->inner);
    sluiceDestroyImageSource(rig->memory);
}

/** Reads one of 16 parts, in rows of 4. */
static SluiceResult read_part(SluiceImageSource *source, uint32_t part)
{
    uint8_t texels[PART_BYTES];
    SluiceImageRegion region = {0, part % 4 * PART, part / 4 * PART, PART, PART, 0};
    memset(texels, 0xA5, sizeof texels);
    SluiceResult result = sluiceReadImageRegion(source, &region, texels, PART);
    for (uint32_t i = 0; i < PART_BYTES && result == SLUICE_SUCCESS; i++)
        assert_int_equal(texels[i], texel_at(region.x + i % PART, region.y + i / PART));
    return result;
}

static SluiceResult read_at(struct rig *rig, uint64_t now, uint32_t part)
{
    rig->now = now;
    return read_part(rig->slow, part);
}

static void a_read_is_there_one_latency_after_it_was_asked_for(void **state)
{
    (void)state;
    struct rig rig;
    set_up(&rig, 300, 0);
    CHECK_RESULT(read_at(&rig, 5000, 3), SLUICE_NOT_READY);
    CHECK_RESULT(read_at(&rig, 5299, 3), SLUICE_NOT_READY);
    assert_int_equal(atomic_load(&rig.inner.read_count), 0);
    CHECK_OK(read_at(&rig, 5300, 3));
    tear_down(&rig);
}

static void reads_are_in_latency_together(void **state)
{
    (void)state;
    struct rig rig;
    set_up(&rig, 300, 0);
    for (uint32_t i = 0; i < 16; i++)
        CHECK_RESULT(read_at(&rig, 5000 + i, i), SLUICE_NOT_READY);
    for (uint32_t i = 0; i < 16; i++)
        CHECK_OK(read_at(&rig, 5300 + i, i));
    tear_down(&rig);
}

static void bytes_go_through_the_line_one_after_another(void **state)
{
    (void)state;
    struct rig rig;
    set_up(&rig, 300, 2); /* a part takes 128 us */
    for (uint32_t i = 0; i < 3; i++)
        CHECK_RESULT(read_at(&rig, 5000, i), SLUICE_NOT_READY);
    for (uint32_t i = 0; i < 3; i++) {
        CHECK_RESULT(read_at(&rig, 5000 + 128 * (i + 1) + 299, i), SLUICE_NOT_READY);
        CHECK_OK(read_at(&rig, 5000 + 128 * (i + 1) + 300, i));
    }
    /* unused capacity of the line is lost */
    CHECK_RESULT(read_at(&rig, 9000, 8), SLUICE_NOT_READY);
    CHECK_RESULT(read_at(&rig, 9427, 8), SLUICE_NOT_READY);
    CHECK_OK(read_at(&rig, 9428, 8));
    tear_down(&rig);
}

static void sources_share_the_line(void **state)
{
    (void)state;
    struct rig rig;
    SluiceImageSource *other;
    set_up(&rig, 0, 2);
    CHECK_OK(slow_source_create(&rig.line, &rig.inner.base, &other));
    CHECK_RESULT(read_part(rig.slow, 0), SLUICE_NOT_READY);
    CHECK_RESULT(read_part(other, 0), SLUICE_NOT_READY);
    rig.now += 128;
    CHECK_OK(read_part(rig.slow, 0));
    CHECK_RESULT(read_part(other, 0), SLUICE_NOT_READY);
    rig.now += 128;
    CHECK_OK(read_part(other, 0));
    sluiceDestroyImageSource(other);
    tear_down(&rig);
}

static void what_came_stays_for_a_second_without_reads(void **state)
{
    (void)state;
    struct rig rig;
    set_up(&rig, 300, 0);
    CHECK_RESULT(read_at(&rig, 5000, 1), SLUICE_NOT_READY);
    CHECK_OK(read_at(&rig, 5300, 1));
    CHECK_OK(read_at(&rig, 1005300, 1));
    CHECK_OK(read_at(&rig, 2005300, 1));
    CHECK_RESULT(read_at(&rig, 3005301, 1), SLUICE_NOT_READY);
    CHECK_OK(read_at(&rig, 3005601, 1));
    tear_down(&rig);
}

static SluiceResult read_level(struct rig *rig, uint64_t now, uint32_t level)
{
    uint8_t texels[SIZE * SIZE];
    SluiceImageRegion region = {level, 0, 0, SIZE >> level, SIZE >> level, 0};
    rig->now = now;
    return sluiceReadImageRegion(rig->slow, &region, texels, SIZE >> level);
}

static void whole_levels_bring_the_coarser_ones(void **state)
{
    (void)state;
    struct rig rig;
    set_up(&rig, 300, 1);
    /* 64 bytes of level 3, 16 of level 4, 4 of level 5, 1 of level 6 */
    CHECK_RESULT(read_level(&rig, 5000, 3), SLUICE_NOT_READY);
    CHECK_RESULT(read_level(&rig, 5363, 3), SLUICE_NOT_READY);
    CHECK_OK(read_level(&rig, 5364, 3));
    CHECK_RESULT(read_level(&rig, 5364, 4), SLUICE_NOT_READY);
    CHECK_RESULT(read_level(&rig, 5384, 6), SLUICE_NOT_READY);
    CHECK_OK(read_level(&rig, 5385, 6));
    CHECK_OK(read_level(&rig, 5385, 5));
    CHECK_OK(read_level(&rig, 5385, 4));
    CHECK_RESULT(read_level(&rig, 5385, 2), SLUICE_NOT_READY);
    CHECK_RESULT(read_level(&rig, 5385 + 256 + 299, 2), SLUICE_NOT_READY);
    CHECK_OK(read_level(&rig, 5385 + 256 + 300, 2));
    tear_down(&rig);
}

static void without_latency_and_limit_nothing_waits(void **state)
{
    (void)state;
    struct rig rig;
    set_up(&rig, 0, 0);
    for (uint32_t i = 0; i < 16; i++)
        CHECK_OK(read_at(&rig, 5000, i));
    tear_down(&rig);
}

static void errors_of_the_source_come_through(void **state)
{
    (void)state;
    struct rig rig;
    SluiceImageInfo info = {.structSize = sizeof info};
    set_up(&rig, 300, 0);
    rig.inner.fail_at = 1;
    rig.inner.failure = SLUICE_ERROR_CORRUPT_DATA;
    CHECK_RESULT(read_at(&rig, 5000, 2), SLUICE_NOT_READY);
    CHECK_RESULT(read_at(&rig, 5300, 2), SLUICE_ERROR_CORRUPT_DATA);
    CHECK_OK(read_at(&rig, 5300, 2));
    CHECK_OK(sluiceGetImageInfo(rig.slow, &info));
    assert_string_equal(info.pName, "bytes");
    tear_down(&rig);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_read_is_there_one_latency_after_it_was_asked_for),
        cmocka_unit_test(reads_are_in_latency_together),
        cmocka_unit_test(bytes_go_through_the_line_one_after_another),
        cmocka_unit_test(sources_share_the_line),
        cmocka_unit_test(what_came_stays_for_a_second_without_reads),
        cmocka_unit_test(whole_levels_bring_the_coarser_ones),
        cmocka_unit_test(without_latency_and_limit_nothing_waits),
        cmocka_unit_test(errors_of_the_source_come_through),
    };
    return RUN_TESTS(tests);
}
