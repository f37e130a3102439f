/*
 * Bytes decide what is called; the manager and the naive one must agree after every call.
 *
 * With a fuzzing engine: compile with -DSLUICE_FUZZING_ENGINE -fsanitize=fuzzer. Without one, main
 * replays the files that are named.
 */
#include "core/differential.h"

#include <inttypes.h>
#include <stdlib.h>

#define MAX_CALLS 400u
#define MAX_FILE_SIZE ((size_t)1 << 20)

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#define MESSAGE_SIZE 512

/* Returns the number of calls, or -1 with what differs in `message`. */
static int play(const uint8_t *data, size_t size, FILE *log, char message[MESSAGE_SIZE])
{
    static const uint8_t nothing = 0;
    struct differential *d = differential_create();
    struct choice choice = {.bytes = size ? data : &nothing, .size = size};
    const char *what;
    int calls = differential_run(d, choice, MAX_CALLS, log, &what);
    snprintf(message, MESSAGE_SIZE, "%s", what);
    differential_destroy(d);
    return calls;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char message[MESSAGE_SIZE];
    if (play(data, size, NULL, message) < 0) {
        play(data, size, stderr, message);
        fprintf(stderr, "%s\n", message);
        abort();
    }
    return 0;
}

#if !defined(SLUICE_FUZZING_ENGINE)
static int play_file(const char *name, uint8_t *buffer, int number)
{
    FILE *file = fopen(name, "rb");
    if (!file) {
        printf("not ok %d - %s cannot be opened\n", number, name);
        return 1;
    }
    size_t size = fread(buffer, 1, MAX_FILE_SIZE, file);
    fclose(file);
    char message[MESSAGE_SIZE];
    int calls = play(buffer, size, NULL, message);
    if (calls >= 0) {
        printf("ok %d - %s plays %d calls alike\n", number, name, calls);
        return 0;
    }
    play(buffer, size, stderr, message);
    printf("not ok %d - %s\n# %s\n", number, name, message);
    return 1;
}

int main(int argc, char **argv)
{
    uint8_t *buffer = malloc(MAX_FILE_SIZE);
    int failures = 0;
    if (!buffer)
        return EXIT_FAILURE;
    printf("1..%d\n", argc - 1);
    for (int i = 1; i < argc; i++)
        failures += play_file(argv[i], buffer, i);
    free(buffer);
    return failures ? EXIT_FAILURE : EXIT_SUCCESS;
}
#endif
