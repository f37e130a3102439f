#include "show.h"

#include "devices.h"
#include "report.h"
#include "../common/text.h"

#include <stdio.h>
#include <string.h>

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
        SluiceVulkanDeviceCapabilities caps = {.structSize = sizeof caps};
        if (sluiceGetVulkanDeviceCapabilities(devices->instance, devices->devices[i], devices->get,
                                              &caps) == SLUICE_SUCCESS)
            fprintf(out, "%u: %s\n", i, caps.deviceName);
    }
}

static void print_device(const struct options *options, const struct device_report *report,
                         bool follows)
{
    if (options->formats && options->json)
        print_formats_json(report);
    else if (options->formats)
        print_formats(report, follows);
    else if (options->json)
        print_json(report);
    else
        print_table(report, follows);
}

static int print_devices(const struct devices *devices, const struct options *options)
{
    uint32_t shown = 0;
    for (uint32_t i = 0; i < devices->count; i++) {
        struct device_report report;
        if (!ask_device(devices, i, options->image[0], options->image[1], &report) ||
            !is_wanted(options, &report))
            continue;
        print_device(options, &report, shown > 0);
        shown++;
    }
    if (shown)
        return ALL_SHOWN;
    if (options->device) {
        text_say("sluice-info: no device is called '%s'; there are", options->device);
        print_names(devices, stderr);
    }
    return NOT_SHOWN;
}

int show_devices(const struct options *options)
{
    struct devices devices;
    if (!open_devices(&devices))
        return NOT_SHOWN;
    int status = ALL_SHOWN;
    if (options->list_devices)
        print_names(&devices, stdout);
    else
        status = print_devices(&devices, options);
    close_devices(&devices);
    return status;
}
