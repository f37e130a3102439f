/* Makes tile stores of pictures. */
#define _XOPEN_SOURCE 700

#include "report.h"
#include "verify.h"

#include <stdio.h>
#include <stdlib.h>

enum { OK = 0, FAILED = 1, WRONG_USAGE = 2 };

static int bake(const struct options *options)
{
    struct files files;
    int status = FAILED;
    if (!find_files(&files, options->inputs, options->input_count, options->output)) {
        free_files(&files);
        return FAILED;
    }
    struct outcome *outcomes = calloc(files.count ? files.count : 1, sizeof *outcomes);
    if (!outcomes)
        fprintf(stderr, "sluice-bake: out of memory\n");
    else if (bake_files(options, &files, outcomes))
        status = print_outcomes(&files, outcomes, options->json) ? FAILED : OK;
    free(outcomes);
    free_files(&files);
    return status;
}

int main(int argc, char **argv)
{
    struct options options;
    int status = OK;
    setenv("VIPS_WARNING", "0", 0); /* what matters comes as an error, with the file's name */
    if (!parse_options(&options, argc, argv))
        return WRONG_USAGE;
    if (options.help)
        print_help();
    else if (options.verify)
        status = verify_files(options.inputs, options.input_count, options.json) ? OK : FAILED;
    else
        status = bake(&options);
    if (fflush(stdout) != 0 || ferror(stdout)) {
        fprintf(stderr, "sluice-bake: cannot write the answer\n");
        return FAILED;
    }
    return status;
}
