/* test_memory SLUICE_BAKE MAKE_PICTURE: pictures larger than memory are baked within what they may
 * take. */
#define _DEFAULT_SOURCE

#include "bake/baked.h"
#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#define WIDTH "1024"
#define HEIGHT "131072" /* 512 MiB of RGBA */
#define MOST_KIB (96 * 1024)

static char *const *arguments;

/* Peak of the program in KiB; -1 if it fails. */
static long run(const char *const *command)
{
    struct rusage usage;
    int status;
    pid_t pid = fork();
    if (pid == 0) {
        execv(command[0], (char *const *)command);
        _exit(127);
    }
    if (pid < 0 || wait4(pid, &status, 0, &usage) != pid || !WIFEXITED(status) ||
        WEXITSTATUS(status) != 0)
        return -1;
    return usage.ru_maxrss;
}

static void a_tall_picture_takes_a_part_of_its_size(void **state)
{
    (void)state;
    struct bake_folder folder;
    char in[256], out[256];
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    SKIP_TEST("sanitizers keep memory of their own");
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
    SKIP_TEST("sanitizers keep memory of their own");
#endif
#endif
    bake_folder_init(&folder);
    bake_folder_file(&folder, "tall.png", in);
    bake_folder_file(&folder, "tall.store", out);
    const char *make[] = {arguments[2], "plain", WIDTH, HEIGHT, "0", in, NULL};
    const char *bake[] = {arguments[1], in,         "-o",   out, "--compression",
                          "1",          "--memory", "128M", NULL};
    assert_true(run(make) > 0);
    long peak = run(bake);
    print_message("# peak %ld KiB\n", peak);
    assert_true(peak > 0 && peak < MOST_KIB);
    bake_folder_finish(&folder);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_tall_picture_takes_a_part_of_its_size)};
    if (argc != 3)
        return 2;
    arguments = argv;
    return RUN_TESTS(tests);
}
