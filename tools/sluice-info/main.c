/* Says what the Vulkan devices of this machine can do for Sluice. */
#include "devices.h"
#include "options.h"
#include "report.h"

#include <stdio.h>
#include <string.h>

enum { OK = 0, NO_DEVICE = 1, WRONG_USAGE = 2 };

static bool is_wanted(const struct options *options, const struct device_report *report)
{
    char number[16];
    snprintf(number, sizeof number, "%u", report->index);
    return !options->device || strcmp(options->device, number) == 0 ||
           strstr(report->capabilities.deviceName, options->device);
}

static void print_names(const struct devices *devices, FILE *out)
{
    for (uint32_t i = 0; i < devices->count; i++) {
        SluiceVulkanDeviceCapabilities caps;
        if (sluiceGetVulkanDeviceCapabilities(devices->instance, devices->devices[i], devices->get,
                                              &caps) == SLUICE_SUCCESS)
            fprintf(out, "%u: %s\n", i, caps.deviceName);
    }
}

static int show(const struct devices *devices, const struct options *options)
{
    uint32_t shown = 0;
    for (uint32_t i = 0; i < devices->count; i++) {
        struct device_report report;
        if (!ask_device(devices, i, options->width, options->height, &report) ||
            !is_wanted(options, &report))
            continue;
        if (options->json)
            print_json(&report);
        else
            print_table(&report, shown > 0);
        shown++;
    }
    if (shown)
        return OK;
    if (options->device) {
        fprintf(stderr, "sluice-info: no device is called '%s'; there are\n", options->device);
        print_names(devices, stderr);
    }
    return NO_DEVICE;
}

int main(int argc, char **argv)
{
    struct options options;
    if (!parse_options(&options, argc, argv))
        return WRONG_USAGE;
    if (options.help) {
        print_help();
        return OK;
    }
    struct devices devices;
    if (!open_devices(&devices))
        return NO_DEVICE;
    int status = OK;
    if (options.list)
        print_names(&devices, stdout);
    else
        status = show(&devices, &options);
    close_devices(&devices);
    if (fflush(stdout) != 0 || ferror(stdout)) {
        fprintf(stderr, "sluice-info: cannot write the answer\n");
        return NO_DEVICE;
    }
    return status;
}
