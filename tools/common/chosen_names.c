#include "chosen_names.h"

#include "text.h"

#include <stddef.h>
#include <string.h>

static bool has(const char *list, const char *name, size_t length)
{
    for (const char *at = list; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL)
        if (strncmp(at, name, length) == 0 && (at[length] == '\0' || at[length] == ','))
            return length > 0;
    return false;
}

bool names_have(const char *list, const char *name)
{
    return !list || has(list, name, strlen(name));
}

bool names_are_known(const char *list, const char *known)
{
    for (const char *at = list; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL) {
        size_t length = strcspn(at, ",");
        if (!has(known, at, length)) {
            text_say("there is nothing named \"%.*s\"; choose from %s", (int)length, at, known);
            return false;
        }
    }
    return true;
}
