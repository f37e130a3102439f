/* Replaces neural.c in builds without the Vulkan loader or zlib. */
#include "neural.h"

#include <stdio.h>

bool neural_bake(const struct options *options)
{
    (void)options;
    fprintf(stderr,
            "sluice-bake: --neural needs the Vulkan loader and zlib, which were missing when "
            "this program was built\n");
    return false;
}
