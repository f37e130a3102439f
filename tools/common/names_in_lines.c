#include "names_in_lines.h"

#include <string.h>

static const char plain[] = "\t\n\r\\", escaped[] = "tnr\\";

void line_write_name(FILE *out, const char *name)
{
    for (; *name; name++) {
        const char *found = strchr(plain, *name);
        if (found)
            putc('\\', out);
        putc(found ? escaped[found - plain] : *name, out);
    }
}

bool line_read_name(char *name)
{
    char *to = name;
    for (const char *from = name; *from; from++) {
        if (strchr("\t\n\r", *from))
            return false;
        if (*from == '\\') {
            const char *found = *++from ? strchr(escaped, *from) : NULL;
            if (!found)
                return false;
            *to++ = plain[found - escaped];
        } else {
            *to++ = *from;
        }
    }
    *to = '\0';
    return to != name;
}
