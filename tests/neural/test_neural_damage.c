/* Files with flipped bytes and lost ends: an error, or something that decodes (fuzz_neural.c). */
#include "neural/made_file.h"
#include "neural/worked_example.h"
#include "support/roll.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Half of the flips hit the text, where a digit or a bracket becomes another one. */
static void damage(uint8_t *bytes, size_t size, size_t text_end)
{
    static const char CHARACTERS[] = "0123456789-.e\"[]{},: \\u";
    for (int n = 1 + roll() % 3; n > 0; n--) {
        size_t at = (size_t)roll() % (roll() % 4 ? text_end : size);
        if (roll() % 2)
            bytes[at] = (uint8_t)CHARACTERS[(size_t)roll() % (sizeof CHARACTERS - 1)];
        else
            bytes[at] ^= (uint8_t)(1 << roll() % 8);
    }
}

static void damage_often(const uint8_t *file, size_t size, size_t text_end, int count)
{
    uint8_t *bytes = malloc(size);
    assert_non_null(bytes);
    for (int i = 0; i < count; i++) {
        memcpy(bytes, file, size);
        damage(bytes, size, text_end);
        size_t left = roll() % 8 ? size : (size_t)roll() % size;
        uint8_t *exact = malloc(left ? left : 1); /* so that a sanitizer sees its end */
        assert_non_null(exact);
        memcpy(exact, bytes, left);
        LLVMFuzzerTestOneInput(exact, left);
        free(exact);
    }
    free(bytes);
}

static void ten_thousand_damaged_files_are_survived(void **state)
{
    static const struct made_shape tiny = {1, 4, 4, 1, 4, 1, 4, 2, SLUICE_NEURAL_NETWORK_SMALL};
    static uint8_t example[WORKED_EXAMPLE_MAX_SIZE];
    struct made_file file;
    (void)state;
    size_t size = write_worked_example(example);
    sluiceDestroyNeuralSet(open_made_file(&tiny, 1, &file));
    roll_seed(11);
    damage_often(example, size, 1500, 8000);
    damage_often(file.bytes, file.size, 3500, 2000);
    free(file.bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(ten_thousand_damaged_files_are_survived)};
    return RUN_TESTS(tests);
}
