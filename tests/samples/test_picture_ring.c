/* Pictures that are written while the next ones are filled. */
#include "picture_ring.h"

#include "support/test.h"

#include <stdatomic.h>

#define MOST 16u

struct writes {
    atomic_uint count[MOST];
    atomic_uint filled; ///< pictures that the test has filled
    uint32_t waits_for; ///< filled ones before picture 0 is written
    uint32_t failing;   ///< picture
    float value[MOST];  ///< seen in the picture
};

static bool write_picture(void *user_data, const struct picture *picture, uint32_t index)
{
    struct writes *writes = user_data;
    while (index == 0 && atomic_load(&writes->filled) < writes->waits_for)
        ;
    writes->value[index] = picture->rgba[picture->width * picture->height - 1][0];
    atomic_fetch_add(&writes->count[index], 1);
    return index != writes->failing;
}

static void fill(struct picture_ring *ring, struct writes *writes, uint32_t index)
{
    struct picture *picture = picture_ring_next(ring);
    for (uint32_t i = 0; i < picture->width * picture->height; i++)
        picture->rgba[i][0] = (float)index;
    atomic_fetch_add(&writes->filled, 1);
}

static void all_pictures_are_written_once_as_they_were_filled(void **state)
{
    (void)state;
    for (uint32_t count = 1; count <= 4; count++) {
        struct writes writes = {.failing = MOST};
        struct picture_ring ring;
        const uint32_t size[2] = {5, 3};
        assert_true(picture_ring_create(count, size, false, write_picture, &writes, &ring));
        for (uint32_t i = 0; i < MOST; i++) {
            fill(&ring, &writes, i);
            assert_true(picture_ring_write(&ring, i));
        }
        assert_true(picture_ring_wait(&ring));
        for (uint32_t i = 0; i < MOST; i++) {
            assert_int_equal(atomic_load(&writes.count[i]), 1);
            assert_true(writes.value[i] == (float)i);
        }
        picture_ring_destroy(&ring);
    }
}

/* It would wait forever, if the next picture could not be filled meanwhile. */
static void the_next_picture_is_filled_while_one_is_written(void **state)
{
    (void)state;
    struct writes writes = {.waits_for = 2, .failing = MOST};
    struct picture_ring ring;
    const uint32_t size[2] = {4, 4};
    assert_true(picture_ring_create(2, size, false, write_picture, &writes, &ring));
    for (uint32_t i = 0; i < 2; i++) {
        fill(&ring, &writes, i);
        assert_true(picture_ring_write(&ring, i));
    }
    assert_true(picture_ring_wait(&ring));
    picture_ring_destroy(&ring);
}

static void a_picture_that_was_not_written_fails_the_ring(void **state)
{
    (void)state;
    struct writes writes = {.failing = 1};
    struct picture_ring ring;
    const uint32_t size[2] = {4, 4};
    assert_true(picture_ring_create(2, size, false, write_picture, &writes, &ring));
    for (uint32_t i = 0; i < 3; i++) {
        fill(&ring, &writes, i);
        (void)picture_ring_write(&ring, i);
    }
    assert_false(picture_ring_wait(&ring));
    assert_false(picture_ring_write(&ring, 3));
    picture_ring_destroy(&ring);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_pictures_are_written_once_as_they_were_filled),
        cmocka_unit_test(the_next_picture_is_filled_while_one_is_written),
        cmocka_unit_test(a_picture_that_was_not_written_fails_the_ring),
    };
    return RUN_TESTS(tests);
}
