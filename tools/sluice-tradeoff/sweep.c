#include "sweep.h"

#include <stdlib.h>
#include <string.h>

int sweep_find_metric(const struct sweep *sweep, const char *name)
{
    for (uint32_t i = 0; i < sweep->metric_count; i++)
        if (strcmp(sweep->metrics[i].name, name) == 0)
            return (int)i;
    return -1;
}
