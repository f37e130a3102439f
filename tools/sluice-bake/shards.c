#define _XOPEN_SOURCE 700 /* realpath */

#include "shards.h"

#include "../common/log.h"
#include "../common/names_in_lines.h"
#include "../common/output_file.h"
#include "../common/progress.h"
#include "../common/text.h"

#include <sluice/store.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char speaker[] = "sluice-bake: ";

/* Adds a picture with the facts in its header. Returns false when out of memory; counts other
 * errors in `failures`. */
static bool describe(SluiceBaker *baker, const struct file *file, struct plan *plan,
                     size_t *failures)
{
    SluiceBakeReport report = {.structSize = sizeof report};
    SluiceBakeInfo info = {.structSize = sizeof info,
                           .pInputPath = file->input,
                           .pOutputPath = file->output,
                           .pSettings = &plan->settings};
    SluiceResult result = sluiceDescribeBake(baker, &info, &report);
    if (result != SLUICE_SUCCESS) {
        text_say("sluice-bake: %s: left out of the plan: %s", file->input,
                 sluiceGetResultName(result));
        ++*failures;
        return true;
    }
    double texels = (double)report.width * report.height * report.arrayLayerCount;
    return plan_add(plan, &(struct plan_picture){
                              .input = strdup(file->input),
                              .output = strdup(file->output),
                              .cost = plan_cost(&plan->settings, report.format, texels, file->size),
                              .size = file->size,
                              .width = report.width,
                              .height = report.height,
                              .layers = report.arrayLayerCount,
                              .format = report.format});
}

static bool describe_all(SluiceBaker *baker, const struct files *files, struct plan *plan)
{
    struct progress progress;
    size_t failures = 0;
    bool enough_memory = true, shows = isatty(STDERR_FILENO);
    if (shows)
        progress_begin(&progress, "looking at", "pictures", files->count);
    for (size_t i = 0; i < files->count && enough_memory; i++) {
        enough_memory = describe(baker, &files->files[i], plan, &failures);
        if (shows)
            progress_update(&progress, i + 1);
    }
    if (shows)
        progress_end(&progress);
    return enough_memory && failures == 0;
}

static void print_plan(const struct plan *plan, const char *path, bool json)
{
    double cost = 0.0, most = 0.0, texels = 0.0;
    for (size_t i = 0; i < plan->count; i++) {
        const struct plan_picture *p = &plan->pictures[i];
        cost += p->cost;
        most = p->cost > most ? p->cost : most;
        texels += (double)p->width * p->height * p->layers;
    }
    if (json) {
        printf("{\"plan\": ");
        text_write_json(stdout, path);
        printf(", \"pictures\": %zu, \"texels\": %.0f, \"seconds\": %.1f, \"longest\": %.1f}\n",
               plan->count, texels, cost, most);
        return;
    }
    printf("%zu pictures, %.1f Mtexel; about %.0f s on one processor, the longest %.0f s\n",
           plan->count, texels * 1e-6, cost, most);
    printf("next: sluice-bake --shard 1/N ");
    text_write(stdout, path);
    printf(" for each of N shards, then sluice-bake --merge -o CATALOGUE ");
    text_write(stdout, path);
    putchar('\n');
}

bool shards_plan(const struct options *options, const struct files *files)
{
    struct plan plan = {.settings = options->settings};
    SluiceBakerCreateInfo info = {.structSize = sizeof info,
                                  .threadCount = 1,
                                  .maxMemory = options->memory,
                                  .log = {speaker, log_say}};
    SluiceBaker *baker;
    plan.settings.structSize = sizeof plan.settings;
    if (sluiceHashBakeSettings(&plan.settings, &plan.settings_hash) != SLUICE_SUCCESS ||
        sluiceCreateBaker(&info, &baker) != SLUICE_SUCCESS) {
        text_say("sluice-bake: pictures cannot be looked at");
        return false;
    }
    bool done = describe_all(baker, files, &plan);
    sluiceDestroyBaker(baker);
    log_finish();
    bool written = plan_write(&plan, options->plan);
    if (written)
        print_plan(&plan, options->plan, options->json);
    plan_finish(&plan);
    return done && written;
}

bool shards_choose(const struct options *options, struct plan *plan, struct files *files)
{
    *files = (struct files){0};
    if (!plan_read(plan, options->inputs.items[0]))
        return false;
    uint32_t *shards = malloc((plan->count + 1) * sizeof *shards);
    files->files = malloc((plan->count + 1) * sizeof *files->files);
    bool done = shards && files->files;
    if (!done)
        text_say("sluice-bake: out of memory");
    done = done && plan_balance(plan, options->shard.count, shards);
    for (size_t i = 0; i < plan->count && done; i++) {
        const struct plan_picture *p = &plan->pictures[i];
        if (shards[i] == options->shard.number - 1)
            files->files[files->count++] = (struct file){p->input, p->output, p->size};
    }
    free(shards);
    return done;
}

/* Returns how a store differs from the planned one. NULL: it does not; then writes its `hash` and
 * `size`. */
static const char *defect_of(const struct plan *plan, const struct plan_picture *picture,
                             uint64_t *hash, uint64_t *size)
{
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create,
                                               .pPath = picture->output};
    SluiceStoreInfo info = {.structSize = sizeof info};
    SluiceImageSource *source;
    SluiceResult result = sluiceCreateStoreImageSource(&create, &source);
    if (result == SLUICE_ERROR_FILE_NOT_FOUND)
        return "is missing";
    if (result != SLUICE_SUCCESS)
        return sluiceGetResultName(result);
    const char *defect = NULL;
    if (sluiceGetStoreInfo(source, &info) != SLUICE_SUCCESS ||
        info.settingsHash != plan->settings_hash)
        defect = "was made with other settings";
    else if (info.sourceSize != picture->size || info.layout.width != picture->width ||
             info.layout.height != picture->height || info.arrayLayerCount != picture->layers ||
             info.layout.format != picture->format)
        defect = "was made from another picture";
    else if (sluiceHashStore(source, hash) != SLUICE_SUCCESS)
        defect = "has a damaged index";
    *size = info.fileSize;
    sluiceDestroyImageSource(source);
    return defect;
}

/* Writes a path relative to the catalogue's folder, so that both can be moved together. */
static void write_store_name(FILE *out, const char *catalogue, const char *store)
{
    const char *slash = strrchr(catalogue, '/');
    const size_t folder = slash ? (size_t)(slash - catalogue) + 1 : 0;
    char *real = NULL, *real_folder = NULL;
    if (strncmp(store, catalogue, folder) == 0 && store[folder] != '/') {
        store += folder;
    } else if ((real = realpath(store, NULL))) {
        char *name = slash ? strndup(catalogue, folder) : strdup(".");
        real_folder = name ? realpath(name, NULL) : NULL;
        const size_t length = real_folder ? strlen(real_folder) : 0;
        const bool below =
            length > 1 && strncmp(real, real_folder, length) == 0 && real[length] == '/';
        store = below ? real + length + 1 : real;
        free(name);
    }
    line_write_name(out, store);
    free(real_folder);
    free(real);
}

static void write_entry(FILE *out, const char *catalogue, const struct plan_picture *p,
                        uint64_t hash, uint64_t size)
{
    fprintf(out, "%016" PRIx64 "\t%s\t%u\t%u\t%u\t%" PRIu64 "\t", hash,
            sluiceGetFormatName(p->format), p->width, p->height, p->layers, size);
    line_write_name(out, p->input);
    putc('\t', out);
    write_store_name(out, catalogue, p->output);
    putc('\n', out);
}

static void print_defect(const struct plan_picture *p, const char *defect, bool json)
{
    if (json) {
        printf("{\"store\": ");
        text_write_json(stdout, p->output);
        printf(", \"defect\": \"%s\"}\n", defect);
    } else {
        text_write(stdout, p->output);
        printf(": %s\n", defect);
    }
}

/* Prints "shards to run again, of 8: 2,5", in the form that sbatch --array accepts. */
static void print_shards(const struct options *options, const struct plan *plan, const bool *lacks)
{
    uint32_t count = options->shard.count, printed = 0;
    uint32_t *shards = count ? malloc((plan->count + 1) * sizeof *shards) : NULL;
    bool *again = count ? calloc(count, sizeof *again) : NULL;
    if (shards && again && plan_balance(plan, count, shards)) {
        for (size_t i = 0; i < plan->count; i++)
            again[shards[i]] |= lacks[i];
        printf(options->json ? "{\"shards\": %u, \"again\": [" : "shards to run again, of %u: ",
               count);
        for (uint32_t s = 0; s < count; s++)
            if (again[s])
                printf("%s%u", printed++ ? "," : "", s + 1);
        puts(options->json ? "]}" : "");
    }
    free(shards);
    free(again);
}

/* Returns the number of missing or wrong stores. `lacks`: marks them. */
static size_t check_all(const struct options *options, const struct plan *plan, FILE *out,
                        bool *lacks)
{
    size_t count = 0;
    fprintf(out,
            "sluice catalogue 1\nhash\tformat\twidth\theight\tlayers\tbytes\tpicture\tstore\n");
    for (size_t i = 0; i < plan->count; i++) {
        uint64_t hash = 0, size = 0;
        const char *defect = defect_of(plan, &plan->pictures[i], &hash, &size);
        lacks[i] = defect != NULL;
        count += lacks[i];
        if (defect)
            print_defect(&plan->pictures[i], defect, options->json);
        else
            write_entry(out, options->output, &plan->pictures[i], hash, size);
    }
    return count;
}

bool shards_merge(const struct options *options)
{
    struct plan plan;
    if (!plan_read(&plan, options->inputs.items[0]))
        return false;
    struct output_file *file = output_file_begin(options->output);
    bool *lacks = calloc(plan.count + 1, sizeof *lacks);
    bool done = false;
    if (file && lacks) {
        size_t missing = check_all(options, &plan, output_file_stream(file), lacks);
        if (missing)
            print_shards(options, &plan, lacks);
        if (!options->json)
            printf("%zu of %zu stores are there%s\n", plan.count - missing, plan.count,
                   missing ? "; no catalogue is written" : "");
        done = missing == 0;
    }
    if (file)
        done = output_file_end(file, done) && done;
    if (!lacks)
        text_say("sluice-bake: out of memory");
    free(lacks);
    plan_finish(&plan);
    return done;
}
