#include "support/roll.h"
#include "support/test.h"

/* The first outputs of SplitMix64 for seed 1234567, as published with the generator. */
static void rolls_are_the_same_on_every_machine(void **state)
{
    (void)state;
    roll_seed(1234567);
    assert_int_equal(roll(), (int)(6457827717110365317u >> 33));
    assert_int_equal(roll(), (int)(3203168211198807973u >> 33));
    assert_int_equal(roll(), (int)(9817491932198370423u >> 33));
}

static void a_seed_begins_its_sequence_again(void **state)
{
    (void)state;
    int first[100];
    roll_seed(7);
    for (int i = 0; i < 100; i++) {
        first[i] = roll();
        assert_in_range(first[i], 0, ROLL_MAX);
    }
    roll_seed(8);
    assert_int_not_equal(roll(), first[0]);
    roll_seed(7);
    for (int i = 0; i < 100; i++)
        assert_int_equal(roll(), first[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rolls_are_the_same_on_every_machine),
        cmocka_unit_test(a_seed_begins_its_sequence_again),
    };
    return RUN_TESTS(tests);
}
