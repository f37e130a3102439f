#include "report.h"

#include "../common/text.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum status { BAKED, UNCHANGED, FAILED };
static const char *const names[] = {"baked", "unchanged", "failed"};

static enum status status_of(const struct bake_job *job)
{
    if (!job->is_done || job->result != SLUICE_SUCCESS)
        return FAILED;
    return job->report.skipped ? UNCHANGED : BAKED;
}

static const char *reason(const struct bake_job *job)
{
    if (!job->is_done)
        return "it was not begun";
    return job->message[0] ? job->message : sluiceGetResultName(job->result);
}

/* Formats a size with three digits in the largest fitting unit. */
static const char *size_text(uint64_t size, char text[16])
{
    static const char *const units[] = {"B", "KiB", "MiB", "GiB", "TiB"};
    double value = (double)size;
    int unit = 0;
    for (; value >= 1000.0 && unit < 4; unit++)
        value /= 1024.0;
    snprintf(text, 16, unit && value < 100.0 ? "%.1f %s" : "%.0f %s", value, units[unit]);
    return text;
}

static void print_row(const struct bake_job *job)
{
    const SluiceBakeReport *r = &job->report;
    char size[32] = "", in[16], out[16] = "";
    if (r->width)
        snprintf(size, sizeof size, "%ux%u", r->width, r->height);
    if (r->outputSize)
        size_text(r->outputSize, out);
    printf("%-9s  %13s  %-20s  %9s  %9s  ", names[status_of(job)], size,
           r->width ? sluiceGetFormatName(r->format) : "", size_text(job->size, in), out);
    text_write(stdout, job->output);
    if (status_of(job) == FAILED) {
        printf(": ");
        text_write(stdout, reason(job));
    }
    putchar('\n');
}

static void print_object(const struct bake_job *job)
{
    const SluiceBakeReport *r = &job->report;
    printf("{\"input\": ");
    text_write_json(stdout, job->input);
    printf(", \"output\": ");
    text_write_json(stdout, job->output);
    printf(", \"status\": \"%s\", \"result\": \"%s\"", names[status_of(job)],
           sluiceGetResultName(job->result));
    if (status_of(job) == FAILED) {
        printf(", \"error\": ");
        text_write_json(stdout, reason(job));
    }
    printf(", \"width\": %u, \"height\": %u, \"levels\": %u, \"layers\": %u, \"format\": \"%s\"",
           r->width, r->height, r->mipLevelCount, r->arrayLayerCount,
           sluiceGetFormatName(r->format));
    printf(", \"input_size\": %" PRIu64 ", \"output_size\": %" PRIu64 ", \"memory\": %" PRIu64
           ", \"resumed_tiles\": %" PRIu64 ", \"replaced_texels\": %" PRIu64
           ", \"nan_texels\": %" PRIu64 ", \"infinite_texels\": %" PRIu64
           ", \"clamped_texels\": %" PRIu64 "}\n",
           job->size, r->outputSize, r->memorySize, r->resumedTileCount, r->replacedTexelCount,
           r->nanTexelCount, r->infiniteTexelCount, r->clampedTexelCount);
}

static void print_totals(const struct bake_job *jobs, size_t count, double seconds)
{
    size_t counts[3] = {0};
    double texels = 0.0; /* texels of level 0 in all baked files */
    uint64_t in = 0, out = 0;
    char in_text[16], out_text[16];
    for (size_t i = 0; i < count; i++) {
        counts[status_of(&jobs[i])]++;
        in += jobs[i].size;
        out += jobs[i].report.outputSize;
        if (status_of(&jobs[i]) == BAKED)
            texels += (double)jobs[i].report.width * jobs[i].report.height *
                      jobs[i].report.arrayLayerCount;
    }
    printf("%zu baked, %zu unchanged, %zu failed; %s in, %s out", counts[BAKED], counts[UNCHANGED],
           counts[FAILED], size_text(in, in_text), size_text(out, out_text));
    if (counts[BAKED] > 0 && seconds > 0.0)
        printf("; %.1f s, %.2f Mtexel/s", seconds, texels * 1e-6 / seconds);
    putchar('\n');
}

/* Formats "3 texels held NaN, stored as 0; ...". */
static void print_replaced(const char *input, const SluiceBakeReport *r)
{
    const struct {
        uint64_t count;
        const char *what;
    } kinds[] = {
        {r->nanTexelCount, "held NaN, stored as 0"},
        {r->infiniteTexelCount, "held an infinity, stored as a finite number"},
        {r->clampedTexelCount, "held a number beyond +-65504, stored as that"},
    };
    char text[256] = "";
    size_t used = 0;
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++)
        if (kinds[i].count)
            used += (size_t)snprintf(text + used, sizeof text - used, "%s%" PRIu64 " texels %s",
                                     used ? "; " : "", kinds[i].count, kinds[i].what);
    if (used)
        text_say("sluice-bake: %s: %s", input, text);
}

static void print_remarks(const struct bake_job *job)
{
    const char *why = reason(job);
    if (status_of(job) != FAILED) {
        bake_job_say_warnings(job, "sluice-bake: ");
        print_replaced(job->input, &job->report);
    } else if (strncmp(why, job->input, strlen(job->input)) == 0) {
        text_say("sluice-bake: %s", why);
    } else {
        text_say("sluice-bake: %s: %s", job->input, why);
    }
}

size_t print_outcomes(const struct bake_job *jobs, size_t count, double seconds, bool json)
{
    size_t failed = 0;
    bool lacks_memory = false;
    if (!json)
        printf("%-9s  %13s  %-20s  %9s  %9s  %s\n", "", "texels", "format", "in", "out", "store");
    for (size_t i = 0; i < count; i++) {
        failed += status_of(&jobs[i]) == FAILED;
        lacks_memory |= jobs[i].is_done && jobs[i].result == SLUICE_ERROR_LIMIT_EXCEEDED;
        print_remarks(&jobs[i]);
        if (json)
            print_object(&jobs[i]);
        else
            print_row(&jobs[i]);
    }
    if (lacks_memory)
        text_say("sluice-bake: --memory raises the limit");
    if (!json)
        print_totals(jobs, count, seconds);
    return failed;
}
