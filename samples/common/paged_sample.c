#include "paged_sample.h"

#include "../../tools/common/output_file.h"
#include "../../tools/common/text.h"

#include <stdio.h>
#include <stdlib.h>

#define EXIT_USAGE 2
#define EXIT_NO_DEVICE 77

int paged_sample_begin(enum option_outcome outcome, const struct paged_sample *sample,
                       struct gpu *gpu)
{
    bool unsupported = false;
    switch (outcome) {
    case OPTIONS_HELP: return text_exit_status(EXIT_SUCCESS);
    case OPTIONS_ERROR: return EXIT_USAGE;
    case OPTIONS_RUN: break;
    }
    if (sample->list_devices)
        return text_exit_status(gpu_list_devices() > 0 ? EXIT_SUCCESS : EXIT_NO_DEVICE);
    if (!output_can_write(sample->output))
        return EXIT_FAILURE;
    const struct gpu_request request = {
        .device = sample->device,
        .validation = sample->validation,
        .modes = {SLUICE_RESIDENCY_MODE_PAGED, SLUICE_RESIDENCY_MODE_PAGED}};
    if (!gpu_create(&request, gpu, &unsupported))
        return unsupported ? EXIT_NO_DEVICE : EXIT_FAILURE;
    return PAGED_SAMPLE_GOES_ON;
}

int paged_sample_end(struct gpu *gpu, bool good)
{
    uint32_t messages = atomic_load(&gpu->validation_messages);
    if (messages > 0)
        fprintf(stderr, "the validation layers had %u messages\n", messages);
    return good && messages == 0 ? text_exit_status(EXIT_SUCCESS) : EXIT_FAILURE;
}
