/* How programs read a whole input: within a limit, which the memory that it takes keeps to, too. */
#define _DEFAULT_SOURCE
#include "support/test.h"

#include "input.h"

#include <errno.h>
#include <malloc.h>
#include <stdlib.h>
#include <string.h>

/* A stream of `size` bytes, of which each is x. */
static FILE *stream_of(size_t size)
{
    FILE *stream = tmpfile();
    assert_non_null(stream);
    for (size_t i = 0; i < size; i++)
        putc('x', stream);
    rewind(stream);
    return stream;
}

static bool read_stream(size_t there, uint64_t limit, char **data, size_t *size)
{
    FILE *stream = stream_of(there);
    *data = NULL;
    *size = 0;
    errno = 0;
    bool done = input_read_rest(stream, limit, data, size);
    int error = errno;
    fclose(stream);
    errno = error;
    return done;
}

static void an_input_is_whole_or_refused(void **state)
{
    static const size_t sizes[] = {0, 1, 65534, 65535, 65536, 65537, 131071, 131072, 300000};
    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        char *data;
        size_t size;
        for (uint64_t more = 0; more < 3; more++) {
            assert_true(read_stream(sizes[i], sizes[i] + more, &data, &size));
            assert_int_equal(size, sizes[i]);
            assert_int_equal(data[size], '\0');
            assert_int_equal(strlen(data), size);
            free(data);
        }
        if (sizes[i] == 0)
            continue;
        assert_false(read_stream(sizes[i], sizes[i] - 1, &data, &size));
        assert_int_equal(errno, EFBIG);
        assert_null(data);
    }
}

static void an_input_at_the_limit_takes_no_twice_the_memory(void **state)
{
    enum { SIZE = 5 << 18 }; /* just above a power of two, at which the room doubles */
    char *data;
    size_t size;
    (void)state;
    assert_true(read_stream(SIZE, SIZE, &data, &size));
    assert_in_range(malloc_usable_size(data), SIZE + 1, SIZE + 65536);
    free(data);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_input_is_whole_or_refused),
        cmocka_unit_test(an_input_at_the_limit_takes_no_twice_the_memory),
    };
    return RUN_TESTS(tests);
}
