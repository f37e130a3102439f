#include "show.h"

#include <stdio.h>

int self_test(const struct options *options)
{
    (void)options;
    fprintf(stderr, "sluice-info: this build has no self-test\n");
    return NOT_SHOWN;
}
