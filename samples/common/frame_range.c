#include "frame_range.h"

#include <stdio.h>
#include <string.h>

bool frame_range_parse(const char *text, void *value)
{
    struct frame_range *range = value;
    int end = 0;
    range->given = true;
    return strspn(text, "0123456789-") == strlen(text) && text[0] != '-' &&
           sscanf(text, "%6u-%6u%n", &range->first, &range->last, &end) == 2 && text[end] == '\0' &&
           range->first <= range->last;
}
