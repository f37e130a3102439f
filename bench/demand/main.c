/* Costs of demand loading on a Vulkan device. run.sh builds this and makes a table of its
 * output. */
#include "rig.h"

#include "../../tools/common/chosen_names.h"
#include "../../tools/common/shared_options.h"

#include <stdio.h>

static const struct {
    const char *name;
    measurement *measure;
} measurements[] = {
    {"create", measure_create}, {"fill", measure_fill},     {"sampling", measure_sampling},
    {"trips", measure_trips},   {"budget", measure_budget}, {"bytes", measure_bytes},
    {"small", measure_small},
};
#define MEASUREMENT_COUNT (sizeof measurements / sizeof *measurements)
#define MEASUREMENT_NAMES "create,fill,sampling,trips,budget,bytes,small"

bool check(SluiceResult result, const char *what)
{
    if (result >= 0)
        return true;
    fprintf(stderr, "%s: %s\n", what, sluiceGetResultName(result));
    return false;
}

struct arguments {
    const char *device, *only;
    uint32_t threads;
    bool json, quick, list, validation;
};

static int measure(const struct arguments *arguments)
{
    struct bench bench = {.threads = arguments->threads};
    struct gpu_request request = {
        .device = arguments->device,
        .validation = arguments->validation,
        .modes = {SLUICE_RESIDENCY_MODE_PAGED, SLUICE_RESIDENCY_MODE_DENSE}};
    bool unsupported;
    if (!gpu_create(&request, &bench.gpu, &unsupported))
        return unsupported ? 77 : 1;
    const SluiceVulkanDeviceCapabilities *caps = &bench.gpu.capabilities;
    bench.wall = caps->deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU || !(caps->timestampPeriod > 0);
    /* 4.2 million samples of 16 textures of 8192 x 8192, or as much as a CPU can hold */
    bench.edge = options.quick ? 256 : bench.wall ? 512 : 2048;
    bench.texture_size = options.quick || bench.wall ? 4096 : 8192;
    bench.columns = options.quick ? 2 : 4;
    fprintf(stderr, "%s, %s %s%s\n", caps->deviceName, caps->driverName, caps->driverInfo,
            bench.wall ? ", wall time" : "");
    int status = 0;
    for (size_t i = 0; i < MEASUREMENT_COUNT; i++) {
        if (!names_have(arguments->only, measurements[i].name))
            continue;
        fprintf(stderr, "%s\n", measurements[i].name);
        if (!measurements[i].measure(&bench)) {
            fprintf(stderr, "%s failed\n", measurements[i].name);
            status = 1;
        }
        fflush(stdout);
    }
    if (atomic_load(&bench.gpu.validation_messages) > 0)
        status = 1;
    gpu_destroy(&bench.gpu);
    return status;
}

int main(int argc, char **argv)
{
    struct arguments a = {0};
    const struct option rows[] = {
        option_device(&a.device),
        option_only(&a.only, "some of " MEASUREMENT_NAMES),
        option_threads(&a.threads),
        {OPTION_FLAG, "quick", .value = &a.quick,
         .help = "small and few: to see that everything works"},
        option_validation(&a.validation),
        option_json(&a.json),
        option_list_devices(&a.list),
    };
    const struct option_table table = {"demand_figures",
                                       "usage: demand_figures [options]\n"
                                       "Measures what demand loading costs; a figure per line.\n",
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
    options.json = a.json;
    options.quick = a.quick;
    return measure(&a);
}
