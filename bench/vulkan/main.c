/* Costs of streaming on a Vulkan device. run.sh builds this and makes a table of its output. */
#include "bench.h"

#include "../../tools/common/chosen_names.h"
#include "../../tools/common/shared_options.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const struct {
    const char *name;
    measurement *measure;
} measurements[] = {
    {"sampling", measure_sampling}, {"feedback", measure_feedback}, {"fill", measure_fill},
    {"produce", measure_produce},   {"budget", measure_budget},     {"resolve", measure_resolve},
    {"host", measure_host},         {"sharp", measure_sharp},       {"unseen", measure_unseen},
    {"small", measure_small},
};
#define MEASUREMENT_COUNT (sizeof measurements / sizeof *measurements)
#define MEASUREMENT_NAMES "sampling,feedback,fill,produce,budget,resolve,host,sharp,unseen,small"

static const char *const mode_names[] = {"auto", "sparse", "paged", "dense"};

void report(const struct bench *bench, double value, const char *unit, const char *name, ...)
{
    char text[128];
    va_list arguments;
    va_start(arguments, name);
    vsnprintf(text, sizeof text, name, arguments);
    va_end(arguments);
    figure(bench->mode_name, text, value, unit);
    fflush(stdout);
}

uint32_t device_local_type(const struct gpu *gpu, uint32_t allowed)
{
    for (uint32_t i = 0; i < gpu->memory.memoryTypeCount; i++)
        if ((allowed & 1u << i) &&
            (gpu->memory.memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT))
            return i;
    return 0;
}

bool check(SluiceResult result, const char *what)
{
    if (result >= 0)
        return true;
    fprintf(stderr, "%s: %s\n", what, sluiceGetResultName(result));
    return false;
}

double median(struct samples *samples)
{
    return samples->count ? samples_quantile(samples, 0.5) : NAN;
}

double typical(const struct bench *bench, struct samples *samples)
{
    return bench->wall && samples->count ? samples_quantile(samples, 0.0) : median(samples);
}

struct arguments {
    const char *device, *only;
    int residency; ///< index in mode_names; 0 is "all"
    int clock;     ///< auto, device, host
    uint32_t size[2], texture_size, threads;
    bool json, quick, list, validation;
};

/* Defaults: 1080p over a texture of more than a GiB, or as much as a CPU can hold. */
static void fill_in_sizes(struct bench *bench)
{
    static const uint32_t sizes[3][2] = {{1920, 1080}, {640, 360}, {160, 90}};
    static const uint32_t textures[3] = {16384, 8192, 2048};
    uint32_t which = options.quick ? 2 : bench->wall ? 1 : 0;
    if (bench->size[0] == 0)
        memcpy(bench->size, sizes[which], sizeof bench->size);
    if (bench->texture_size == 0)
        bench->texture_size = textures[which];
}

/* Returns 0; 1 if a measurement failed; 77 if the device lacks the mode. */
static int measure_mode(const struct arguments *arguments, SluiceResidencyMode mode)
{
    struct bench bench = {.mode = mode,
                          .mode_name = mode_names[mode],
                          .size = {arguments->size[0], arguments->size[1]},
                          .texture_size = arguments->texture_size,
                          .threads = arguments->threads};
    struct gpu_request request = {.device = arguments->device,
                                  .validation = arguments->validation,
                                  .modes = {mode, SLUICE_RESIDENCY_MODE_DENSE}};
    bool unsupported;
    if (!gpu_create(&request, &bench.gpu, &unsupported))
        return unsupported ? 77 : 1;
    const SluiceVulkanDeviceCapabilities *caps = &bench.gpu.capabilities;
    bench.wall = caps->deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    if (arguments->clock)
        bench.wall = arguments->clock == 2;
    bench.wall |= !(caps->timestampPeriod > 0);
    fill_in_sizes(&bench);
    fprintf(stderr, "%s: %s, %s %s%s\n", bench.mode_name, caps->deviceName, caps->driverName,
            caps->driverInfo, bench.wall ? ", wall time" : "");
    int status = 0;
    for (size_t i = 0; i < MEASUREMENT_COUNT; i++) {
        if (!names_have(arguments->only, measurements[i].name))
            continue;
        fprintf(stderr, "%s: %s\n", bench.mode_name, measurements[i].name);
        if (!measurements[i].measure(&bench)) {
            fprintf(stderr, "%s: %s failed\n", bench.mode_name, measurements[i].name);
            status = 1;
        }
    }
    if (atomic_load(&bench.gpu.validation_messages) > 0)
        status = 1;
    gpu_destroy(&bench.gpu);
    return status;
}

static int measure(const struct arguments *arguments)
{
    int status = 77;
    for (int mode = 1; mode <= 3; mode++) {
        if (arguments->residency && arguments->residency != mode)
            continue;
        int outcome = measure_mode(arguments, (SluiceResidencyMode)mode);
        if (outcome == 1 || status == 77)
            status = outcome;
    }
    return status;
}

int main(int argc, char **argv)
{
    struct arguments a = {0};
    const struct option rows[] = {
        option_device(&a.device),
        {OPTION_CHOICE, "residency", "all|sparse|paged|dense", "all", &a.residency,
         "mode to measure"},
        option_only(&a.only,
                    "some of sampling, feedback, fill, produce, budget, resolve, host, sharp, "
                    "unseen, small; without spaces"),
        {OPTION_EXTENT, "size", "WxH", "0x0", a.size,
         "of pictures in pixels; 0x0: 1920x1080, on software devices 640x360, with --quick 160x90",
         0, 8192},
        {OPTION_UINT, "texture-size", "N", "0", &a.texture_size,
         "width and height of the texture of scenes in texels, a power of 2; 0: 16384, on software "
         "devices 8192, with --quick 2048",
         0, 16384},
        {OPTION_RENAMED, "texture", "texture-size"},
        option_threads(&a.threads),
        {OPTION_CHOICE, "clock", "auto|device|host", "auto", &a.clock,
         "clock that times draws; auto: the host's on software devices"},
        {OPTION_FLAG, "quick", .value = &a.quick,
         .help = "small and few: to see that everything works"},
        option_validation(&a.validation),
        option_json(&a.json),
        option_list_devices(&a.list),
    };
    const struct option_table table = {"vulkan_figures",
                                       "usage: vulkan_figures [options]\n"
                                       "Measures what streaming costs; a figure per line.\n",
                                       NULL, rows, sizeof rows / sizeof *rows};
    switch (options_parse(&table, argc, argv)) {
    case OPTIONS_HELP: return 0;
    case OPTIONS_ERROR: return 2;
    case OPTIONS_RUN: break;
    }
    if (a.list)
        return gpu_list_devices() > 0 ? 0 : 77;
    if (!names_are_known(a.only, MEASUREMENT_NAMES))
        return 2;
    if ((a.size[0] == 0) != (a.size[1] == 0)) {
        options_refuse(&table, "--size wants two numbers, or 0x0");
        return 2;
    }
    options.json = a.json;
    options.quick = a.quick;
    if (a.texture_size && (a.texture_size < 1024 || (a.texture_size & (a.texture_size - 1)))) {
        options_refuse(&table, "--texture-size wants a power of 2 from 1024 to 16384");
        return 2;
    }
    return measure(&a);
}
