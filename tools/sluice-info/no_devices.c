#include "show.h"

#include <stdio.h>

int show_devices(const struct options *options)
{
    (void)options;
    fprintf(stderr, "sluice-info: this build knows nothing of Vulkan\n");
    return NOT_SHOWN;
}
