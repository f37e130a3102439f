#include "base/said.h"

#include "support/test.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>

static void each_fault_is_said_once_and_only_so_many(void **state)
{
    (void)state;
    struct slc_said said = {0};
    for (uint64_t i = 0; i < 100; i++)
        for (int again = 0; again < 3; again++)
            assert_int_equal(slc_said_note(&said, i + 1), again || i >= SLC_SAID_MAX
                                                              ? SLC_SAY_NOTHING
                                                          : i + 1 == SLC_SAID_MAX ? SLC_SAY_IT_LAST
                                                                                  : SLC_SAY_IT);
    assert_int_equal(slc_said_note(NULL, 1), SLC_SAY_IT);
    assert_int_equal(slc_said_note(NULL, 1), SLC_SAY_IT);
}

static void texts_that_differ_have_keys_that_differ(void **state)
{
    (void)state;
    uint64_t keys[1000];
    for (uint32_t i = 0; i < 1000; i++) {
        char text[64];
        snprintf(text, sizeof text, "at %u: the checksum of a tile is wrong", i);
        keys[i] = slc_said_key(text);
        for (uint32_t k = 0; k < i; k++)
            assert_true(keys[i] != keys[k]);
    }
}

struct crowd {
    struct slc_said said;
    atomic_uint said_count;
};

static void *say(void *argument)
{
    struct crowd *crowd = argument;
    for (uint64_t i = 0; i < 1000; i++)
        crowd->said_count += slc_said_note(&crowd->said, i % 8 + 1) != SLC_SAY_NOTHING;
    return NULL;
}

static void threads_say_it_once_together(void **state)
{
    (void)state;
    struct crowd crowd = {0};
    pthread_t threads[4];
    for (int i = 0; i < 4; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, say, &crowd), 0);
    for (int i = 0; i < 4; i++)
        pthread_join(threads[i], NULL);
    assert_int_equal(crowd.said_count, 8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_fault_is_said_once_and_only_so_many),
        cmocka_unit_test(texts_that_differ_have_keys_that_differ),
        cmocka_unit_test(threads_say_it_once_together),
    };
    return RUN_TESTS(tests);
}
