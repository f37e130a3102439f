/* Run names, a line per run: "3 budget-16-r4-0123456789abcdef budget 16". Repeats count from 0. */
#include "run_names.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../common/output_file.h"
#include "../sluice-replay/file.h"

bool run_names_write(const struct runs *runs)
{
    char *path = memory_text("%s/sweep.runs", runs->results);
    struct output_file *output = output_file_begin(path);
    for (uint32_t i = 0; i < runs->count && output; i++) {
        const struct run *run = &runs->items[i];
        fprintf(output_file_stream(output), "%u %s %s\n", run->repeat, run->key,
                runs->sweep->points[run->point].label);
    }
    free(path);
    return output_file_end(output, true);
}

char *run_names_read(const char *results)
{
    size_t size;
    char *names = NULL, *path = memory_text("%s/sweep.runs", results);
    read_file(path, &names, &size);
    free(path);
    return names;
}

char *run_names_find(const char *names, const char *label, uint32_t repeat)
{
    char *number = memory_text("%u ", repeat), *found = NULL;
    for (const char *line = names; line && *line && !found;) {
        size_t length = strcspn(line, "\n");
        const char *key = line + strlen(number);
        bool same = strncmp(line, number, strlen(number)) == 0;
        size_t key_length = same ? strcspn(key, " /\n") : 0;
        if (key_length > 0 && key[key_length] == ' ' &&
            (size_t)(line + length - key) == key_length + 1 + strlen(label) &&
            strncmp(key + key_length + 1, label, strlen(label)) == 0)
            found = memory_text("%.*s", (int)key_length, key);
        line += length + (line[length] == '\n');
    }
    free(number);
    return found;
}
