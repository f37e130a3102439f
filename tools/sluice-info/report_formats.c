#include "report.h"

#include "../common/text.h"

#include <stdio.h>

static const char *answer_of(const struct device_report *r, SluiceFormat format, uint32_t mode)
{
    return format_mode_answer((enum format_mode)mode, !r->missing_for[mode][0], format,
                              &r->formats[format].capabilities);
}

static void print_cell(const char *text, uint32_t mode)
{
    if (mode + 1 < FORMAT_MODES)
        printf(" %-18s", text);
    else
        printf(" %s\n", text);
}

void print_formats(const struct device_report *r, bool follows)
{
    printf("%sdevice %u: %s\n", follows ? "\n" : "", r->index, r->capabilities.deviceName);
    printf("  driver: %s %s\n", r->capabilities.driverName, r->capabilities.driverInfo);
    for (uint32_t m = 0; m < FORMAT_MODES; m++)
        if (r->missing_for[m][0])
            printf("  no %s: %s\n", format_mode_names[m], r->missing_for[m]);
    printf("\n  %-26s %-8s", "format", "linear");
    for (uint32_t m = 0; m < FORMAT_MODES; m++)
        print_cell(format_mode_names[m], m);
    for (uint32_t f = 1; f < SLUICE_FORMAT_COUNT; f++) {
        printf("  %-26s %-8s", sluiceGetFormatName((SluiceFormat)f),
               r->formats[f].capabilities.linearFilter ? "yes" : "no");
        for (uint32_t m = 0; m < FORMAT_MODES; m++)
            print_cell(answer_of(r, (SluiceFormat)f, m), m);
    }
}

static void print_string(const char *name, const char *text, const char *end)
{
    printf("\"%s\":", name);
    text_write_json(stdout, text);
    printf("%s", end);
}

static void print_missing(const struct device_report *r)
{
    printf("\"missing\":{");
    for (uint32_t m = 0; m < FORMAT_MODES; m++)
        print_string(format_mode_names[m], r->missing_for[m], m + 1 < FORMAT_MODES ? "," : "},");
}

void print_formats_json(const struct device_report *r)
{
    printf("{\"index\":%u,", r->index);
    print_string("deviceName", r->capabilities.deviceName, ",");
    print_string("driverName", r->capabilities.driverName, ",");
    print_string("driverInfo", r->capabilities.driverInfo, ",");
    print_missing(r);
    printf("\"formats\":[");
    for (uint32_t f = 1; f < SLUICE_FORMAT_COUNT; f++) {
        printf("%s{", f == 1 ? "" : ",");
        print_string("format", sluiceGetFormatName((SluiceFormat)f), ",");
        printf("\"linearFilter\":%s,", r->formats[f].capabilities.linearFilter ? "true" : "false");
        for (uint32_t m = 0; m < FORMAT_MODES; m++)
            print_string(format_mode_names[m], answer_of(r, (SluiceFormat)f, m),
                         m + 1 < FORMAT_MODES ? "," : "}");
    }
    printf("]}\n");
}
