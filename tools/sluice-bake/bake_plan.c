#define _POSIX_C_SOURCE 200809L

#include "bake_plan.h"

#include "../common/names_in_lines.h"
#include "../common/output_file.h"
#include "../common/text.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char first_line[] = "sluice-bake plan 1";

bool plan_add(struct plan *plan, const struct plan_picture *picture)
{
    if (plan->count == plan->capacity) {
        size_t capacity = plan->capacity ? 2 * plan->capacity : 64;
        struct plan_picture *more = realloc(plan->pictures, capacity * sizeof *more);
        if (more) {
            plan->pictures = more;
            plan->capacity = capacity;
        }
    }
    if (!picture->input || !picture->output || plan->count == plan->capacity) {
        free(picture->input);
        free(picture->output);
        text_say("sluice-bake: out of memory");
        return false;
    }
    plan->pictures[plan->count++] = *picture;
    return true;
}

void plan_finish(struct plan *plan)
{
    for (size_t i = 0; i < plan->count; i++) {
        free(plan->pictures[i].input);
        free(plan->pictures[i].output);
    }
    free(plan->pictures);
    *plan = (struct plan){0};
}

/* Returns seconds of an encoder per 10^6 texels, by quality: NORMAL, FAST, BEST. */
static double encoder_work(SluiceFormat format, SluiceBakeQuality quality)
{
    static const struct {
        const char *name; /* start of the format's name */
        double work[3];
    } encoders[] = {{"BC1", {1.4, 1.4, 1.4}}, {"BC3", {1.5, 1.5, 1.5}},  {"BC6H", {0.3, 0.2, 0.7}},
                    {"BC7", {0.2, 0.1, 0.5}}, {"ASTC", {2.4, 0.9, 8.0}}, {"BC", {0.1, 0.1, 0.1}},
                    {"", {0.0, 0.0, 0.0}}};
    const char *name = sluiceGetFormatName(format);
    size_t i = 0;
    while (strncmp(name, encoders[i].name, strlen(encoders[i].name)) != 0)
        i++;
    return encoders[i].work[quality <= SLUICE_BAKE_QUALITY_BEST ? quality : 0];
}

/* Measured on one core with a JPEG of 2048 x 2048 (docs/cluster.md). Only the balance of shards
 * depends on it. */
double plan_cost(const SluiceBakeSettings *settings, SluiceFormat format, double texels,
                 uint64_t input_size)
{
    SluiceFormatInfo info = {.structSize = sizeof info};
    if (sluiceGetFormatInfo(format, &info) != SLUICE_SUCCESS)
        return 0.0;
    double work = 0.09 + encoder_work(format, settings->quality); /* reading and filtering */
    double bytes = (double)info.blockSize / ((double)info.blockWidth * info.blockHeight);
    if (!settings->uncompressed)
        work += bytes * (settings->compressionLevel > 12 ? 0.27 : 0.024);
    return 0.01 + work * texels * 1e-6 * 4.0 / 3.0 + 4e-9 * (double)input_size;
}

static void write_settings(FILE *out, const struct plan *plan)
{
    const SluiceBakeSettings *s = &plan->settings;
    fprintf(out,
            "settings\tformat=%d\tquality=%d\ttransfer=%d\talpha=%d\tfilter=%d\twrap-x=%d\twrap-y=%"
            "d\tnormal=%d\tcutout=%a\tcompression=%u\tuncompressed=%d\tkeep-primaries=%d\n",
            (int)s->format, (int)s->quality, (int)s->transfer, (int)s->alpha, (int)s->filter,
            (int)s->wrapX, (int)s->wrapY, s->normalMap, (double)s->cutout, s->compressionLevel,
            s->uncompressed, s->keepPrimaries);
}

bool plan_write(const struct plan *plan, const char *path)
{
    struct output_file *file = output_file_begin(path);
    if (!file)
        return false;
    FILE *out = output_file_stream(file);
    fprintf(out, "%s\nhash\t%016" PRIx64 "\n", first_line, plan->settings_hash);
    write_settings(out, plan);
    fprintf(out, "pictures\t%zu\nseconds\tbytes\twidth\theight\tlayers\tformat\tinput\toutput\n",
            plan->count);
    for (size_t i = 0; i < plan->count; i++) {
        const struct plan_picture *p = &plan->pictures[i];
        fprintf(out, "%.3f\t%" PRIu64 "\t%u\t%u\t%u\t%d\t", p->cost, p->size, p->width, p->height,
                p->layers, (int)p->format);
        line_write_name(out, p->input);
        putc('\t', out);
        line_write_name(out, p->output);
        putc('\n', out);
    }
    return output_file_end(file, true);
}

static bool read_settings(const char *line, struct plan *plan)
{
    SluiceBakeSettings *s = &plan->settings;
    int format, quality, transfer, alpha, filter, x, y, normal, uncompressed, keep, end = 0;
    double cutout;
    uint64_t hash;
    *s = (SluiceBakeSettings){.structSize = sizeof *s};
    if (sscanf(line,
               "settings\tformat=%d\tquality=%d\ttransfer=%d\talpha=%d\tfilter=%d\twrap-x=%d\t"
               "wrap-y=%d\tnormal=%d\tcutout=%la\tcompression=%u\tuncompressed=%d\t"
               "keep-primaries=%d%n",
               &format, &quality, &transfer, &alpha, &filter, &x, &y, &normal, &cutout,
               &s->compressionLevel, &uncompressed, &keep, &end) != 12 ||
        line[end] != '\0')
        return false;
    s->format = (SluiceFormat)format;
    s->quality = (SluiceBakeQuality)quality;
    s->transfer = (SluiceBakeTransfer)transfer;
    s->alpha = (SluiceBakeAlpha)alpha;
    s->filter = (SluiceBakeFilter)filter;
    s->wrapX = (SluiceBakeWrap)x;
    s->wrapY = (SluiceBakeWrap)y;
    s->normalMap = normal != 0;
    s->cutout = (float)cutout;
    s->uncompressed = uncompressed != 0;
    s->keepPrimaries = keep != 0;
    return sluiceHashBakeSettings(s, &hash) == SLUICE_SUCCESS && hash == plan->settings_hash;
}

/* Parses a line: numbers, then names, separated by tabs. Changes the line. */
static bool read_picture(char *line, struct plan_picture *p)
{
    int format, end = 0;
    *p = (struct plan_picture){0};
    if (sscanf(line, "%lf\t%" SCNu64 "\t%u\t%u\t%u\t%d\t%n", &p->cost, &p->size, &p->width,
               &p->height, &p->layers, &format, &end) != 6 ||
        end == 0 || !isfinite(p->cost) || p->cost < 0.0 || p->width == 0 || p->height == 0)
        return false;
    p->format = (SluiceFormat)format;
    char *input = line + end, *output = strchr(input, '\t');
    if (!output || strchr(output + 1, '\t'))
        return false;
    *output++ = '\0';
    if (!line_read_name(input) || !line_read_name(output))
        return false;
    p->input = strdup(input);
    p->output = strdup(output);
    return true;
}

struct reader {
    FILE *file;
    const char *path;
    char *line;
    size_t size;
    uint64_t number;
};

static bool refuse(const struct reader *reader, const char *why)
{
    text_say("sluice-bake: %s: line %" PRIu64 ": %s", reader->path, reader->number, why);
    return false;
}

/* Reads a line and removes its end. Returns false at the end of the file, also in the middle of a
 * line. */
static bool next_line(struct reader *reader)
{
    ssize_t length = getline(&reader->line, &reader->size, reader->file);
    reader->number++;
    if (length <= 0 || reader->line[length - 1] != '\n' || strlen(reader->line) != (size_t)length)
        return false;
    reader->line[length - 1] = '\0';
    return true;
}

static bool read_head(struct reader *reader, struct plan *plan, size_t *count)
{
    int end = 0;
    if (!next_line(reader) || strcmp(reader->line, first_line) != 0)
        return refuse(reader, "this is no plan of sluice-bake");
    if (!next_line(reader) ||
        sscanf(reader->line, "hash\t%16" SCNx64 "%n", &plan->settings_hash, &end) != 1 ||
        reader->line[end] != '\0')
        return refuse(reader, "the hash of the settings is missing");
    if (!next_line(reader) || !read_settings(reader->line, plan))
        return refuse(reader, "these are no settings of this version; make the plan again");
    if (!next_line(reader) || sscanf(reader->line, "pictures\t%zu%n", count, &end) != 1 ||
        reader->line[end] != '\0' || !next_line(reader))
        return refuse(reader, "the number of pictures is missing");
    return true;
}

static bool read_all(struct reader *reader, struct plan *plan)
{
    size_t count = 0;
    if (!read_head(reader, plan, &count))
        return false;
    for (size_t i = 0; i < count; i++) {
        struct plan_picture picture;
        if (!next_line(reader))
            return refuse(reader, "the plan ends early");
        if (!read_picture(reader->line, &picture))
            return refuse(reader, "this is no picture with its numbers");
        if (!plan_add(plan, &picture))
            return false;
        if (i > 0 && strcmp(plan->pictures[i - 1].output, plan->pictures[i].output) >= 0)
            return refuse(reader, "stores are not in order, or twice");
    }
    return next_line(reader) ? refuse(reader, "there are more pictures than counted") : true;
}

bool plan_read(struct plan *plan, const char *path)
{
    struct reader reader = {.file = fopen(path, "r"), .path = path};
    *plan = (struct plan){0};
    if (!reader.file) {
        text_say("sluice-bake: %s: %s", path, strerror(errno));
        return false;
    }
    bool done = read_all(&reader, plan);
    if (ferror(reader.file)) {
        text_say("sluice-bake: %s: %s", path, strerror(errno));
        done = false;
    }
    free(reader.line);
    fclose(reader.file);
    if (!done)
        plan_finish(plan);
    return done;
}

struct ranked {
    double cost;
    size_t index;
};

static int by_cost(const void *a, const void *b)
{
    const struct ranked *x = a, *y = b;
    if (x->cost != y->cost)
        return x->cost > y->cost ? -1 : 1;
    return x->index < y->index ? -1 : x->index > y->index;
}

bool plan_balance(const struct plan *plan, uint32_t shard_count, uint32_t *shards)
{
    struct ranked *ranked = malloc((plan->count + 1) * sizeof *ranked);
    double *loads = calloc(shard_count, sizeof *loads);
    bool enough_memory = ranked && loads;
    for (size_t i = 0; i < plan->count && enough_memory; i++)
        ranked[i] = (struct ranked){plan->pictures[i].cost, i};
    if (enough_memory)
        qsort(ranked, plan->count, sizeof *ranked, by_cost);
    for (size_t i = 0; i < plan->count && enough_memory; i++) {
        uint32_t least = 0;
        for (uint32_t s = 1; s < shard_count; s++)
            if (loads[s] < loads[least])
                least = s;
        shards[ranked[i].index] = least;
        loads[least] += ranked[i].cost;
    }
    free(ranked);
    free(loads);
    if (!enough_memory)
        text_say("sluice-bake: out of memory");
    return enough_memory;
}
