/* realpath, strtok_r */
#define _XOPEN_SOURCE 700

#include "recent.h"

#include "settings_file.h"

#include "../common/input.h"
#include "../common/names_in_lines.h"
#include "../common/output_file.h"
#include "../common/remote.h"
#include "../common/text.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define HEADER "sluice-view recent 1"
#define MAX_SIZE (1u << 20)

static bool is_kept(const char *name)
{
    return name[0] == '/' || (remote_is_url(name) && !strpbrk(name, "?#"));
}

static bool read_text(char *text, struct file_list *list)
{
    char *rest = NULL;
    char *line = strtok_r(text, "\n", &rest);
    bool good = line && strcmp(line, HEADER) == 0;
    while (good && (line = strtok_r(NULL, "\n", &rest)))
        good = list->count < RECENT_MOST && line_read_name(line) && is_kept(line) &&
               files_add(line, list);
    return good;
}

void recent_read(const char *path, struct file_list *list)
{
    char *text = NULL;
    size_t size = 0;
    files_finish(list);
    if (!input_read_file(path, MAX_SIZE, &text, &size)) {
        if (errno != ENOENT)
            text_say("sluice-view: %s: %s", path, input_reason(errno));
        return;
    }
    if (strlen(text) != size || !read_text(text, list)) {
        files_finish(list);
        settings_file_set_aside(path, "the list of recent files begins anew");
    }
    free(text);
}

bool recent_add(const char *name, struct file_list *list)
{
    char resolved[4096];
    const char *path = remote_is_url(name) ? name : realpath(name, resolved);
    struct file_list before = *list;
    if (!path || !is_kept(path))
        return true;
    *list = (struct file_list){0};
    bool added = files_add(path, list);
    for (size_t i = 0; added && i < before.count && list->count < RECENT_MOST; i++)
        if (strcmp(before.paths[i], path) != 0)
            added = files_add(before.paths[i], list);
    files_finish(&before);
    return added;
}

bool recent_write(const char *path, const struct file_list *list)
{
    if (!files_make_folders_of(path)) {
        text_say("sluice-view: %s: %s", path, strerror(errno));
        return false;
    }
    struct output_file *output = output_file_begin(path);
    if (!output)
        return false;
    FILE *file = output_file_stream(output);
    fprintf(file, HEADER "\n");
    for (size_t i = 0; i < list->count; i++) {
        line_write_name(file, list->paths[i]);
        fprintf(file, "\n");
    }
    return output_file_end(output, true);
}
