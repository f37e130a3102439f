/* Makes tile stores from pictures. */
#define _XOPEN_SOURCE 700

#include "../common/clock.h"
#include "../common/descriptors.h"
#include "../common/files.h"
#include "find.h"
#include "neural.h"
#include "options.h"
#include "report.h"
#include "shards.h"
#include "../common/text.h"
#include "verify.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>

enum { OK = 0, FAILED = 1, WRONG_USAGE = 2 };

static struct bake_job *make_jobs(const struct options *options, const SluiceBakeSettings *settings,
                                  const struct files *files)
{
    struct bake_job *jobs = calloc(files->count ? files->count : 1, sizeof *jobs);
    if (!jobs)
        fprintf(stderr, "sluice-bake: out of memory\n");
    for (size_t i = 0; i < files->count && jobs; i++)
        jobs[i] = (struct bake_job){.input = files->files[i].input,
                                    .output = files->files[i].output,
                                    .size = files->files[i].size,
                                    .settings = *settings,
                                    .force = options->force};
    return jobs;
}

static struct bake_conditions conditions_of(const struct options *options)
{
    return (struct bake_conditions){.threads = options->threads,
                                    .memory = options->memory,
                                    .quiet = true,
                                    .speaker = "sluice-bake: "};
}

/* Bakes one store, whose layers are the inputs. */
static int bake_layers(const struct options *options)
{
    struct bake_conditions conditions = conditions_of(options);
    struct bake_job job = {.input = options->inputs.items[0],
                           .output = options->output,
                           .layers = (const char *const *)options->inputs.items,
                           .layer_count = (uint32_t)options->inputs.count,
                           .cube = options->cube,
                           .settings = options->settings,
                           .force = options->force};
    for (uint32_t i = 0; i < job.layer_count; i++)
        job.size += files_size(job.layers[i]);
    double start = clock_seconds();
    if (!bake_jobs_run(&job, 1, &conditions))
        return FAILED;
    return print_outcomes(&job, 1, clock_seconds() - start, options->json) ? FAILED : OK;
}

static int bake_files(const struct options *options, const SluiceBakeSettings *settings,
                      const struct files *files)
{
    struct bake_conditions conditions = conditions_of(options);
    int status = FAILED;
    struct bake_job *jobs = make_jobs(options, settings, files);
    double start = clock_seconds();
    if (jobs && bake_jobs_run(jobs, files->count, &conditions)) {
        double seconds = clock_seconds() - start;
        status = print_outcomes(jobs, files->count, seconds, options->json) ? FAILED : OK;
    }
    free(jobs);
    return status;
}

static int bake(const struct options *options)
{
    struct files files;
    int status = FAILED;
    if (find_files(&files, &options->inputs, options->output)) {
        if (options->plan)
            status = shards_plan(options, &files) ? OK : FAILED;
        else
            status = bake_files(options, &options->settings, &files);
        if (files.unreadable_count > 0)
            status = FAILED;
    }
    free_files(&files);
    return status;
}

static int bake_shard(const struct options *options)
{
    struct plan plan;
    struct files files;
    int status = FAILED;
    if (shards_choose(options, &plan, &files))
        status = bake_files(options, &plan.settings, &files);
    free(files.files); /* names are the plan's */
    plan_finish(&plan);
    return status;
}

int main(int argc, char **argv)
{
    struct options options;
    int status = OK;
    descriptors_raise();
    signal(SIGXFSZ, SIG_IGN); /* files that may not grow are an error like a full disk */
    enum option_outcome outcome = parse_options(&options, argc, argv);
    if (outcome == OPTIONS_ERROR)
        return WRONG_USAGE;
    if (outcome == OPTIONS_HELP)
        status = OK;
    else if (options.verify)
        status = verify_files(&options.inputs, options.json) ? OK : FAILED;
    else if (options.merge)
        status = shards_merge(&options) ? OK : FAILED;
    else if (options.shard.count)
        status = bake_shard(&options);
    else if (options.neural)
        status = neural_bake(&options) ? OK : FAILED;
    else
        status = options.cube || options.array ? bake_layers(&options) : bake(&options);
    return text_flush("sluice-bake: ") ? status : FAILED;
}
