#include "device_list.h"

#include <ctype.h>
#include <string.h>

#define MOST_INDEX 9999u

/** Parses an unsigned number. Returns the text behind it, or NULL. */
static const char *parse_number(const char *text, uint32_t *number)
{
    uint32_t value = 0;
    if (!isdigit((unsigned char)*text))
        return NULL;
    for (; isdigit((unsigned char)*text); text++)
        if ((value = 10 * value + (uint32_t)(*text - '0')) > MOST_INDEX)
            return NULL;
    *number = value;
    return text;
}

static bool parse_indices(const char *text, struct device_list *list)
{
    while (*text) {
        if (list->count == DEVICE_LIST_MOST)
            return false;
        text = parse_number(text, &list->indices[list->count++]);
        if (!text || (*text && *text != ','))
            return false;
        text += *text == ',';
    }
    return list->count > 0;
}

bool device_list_parse(const char *text, void *value)
{
    struct device_list *list = value;
    *list = (struct device_list){0};
    if (strcmp(text, "all") == 0) {
        list->wanted = DEVICE_LIST_ALL;
        return true;
    }
    if (strchr(text, ','))
        return parse_indices(text, list);
    const char *end = parse_number(text, &list->wanted);
    return end && *end == '\0' && list->wanted >= 1 && list->wanted <= DEVICE_LIST_MOST;
}
