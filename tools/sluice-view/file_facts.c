/* open_memstream */
#define _XOPEN_SOURCE 700

#include "file_facts.h"

#include "messages.h"

#include "../common/remote.h"
#include "../sluice-info/file_report.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void drop_report(struct file_facts *facts)
{
    free(facts->report);
    facts->report = NULL;
    facts->path[0] = '\0';
}

void file_facts_finish(struct file_facts *facts)
{
    drop_report(facts);
    *facts = (struct file_facts){0};
}

void file_facts_begin(struct file_facts *facts)
{
    facts->first_message = messages_count();
}

/* Keeps the path, without the "#name" of a picture in the file. */
static void take_path(struct file_facts *facts, const char *path)
{
    snprintf(facts->path, sizeof facts->path, "%s", path);
    char *name = strrchr(facts->path, '#');
    if (name && access(facts->path, F_OK) != 0)
        *name = '\0';
}

void file_facts_look(struct file_facts *facts, const char *path)
{
    char *text = NULL;
    size_t size = 0;
    drop_report(facts);
    take_path(facts, path);
    if (remote_is_url(path) || !report_takes(facts->path))
        return;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return;
    const bool reported = report_file(facts->path, false, out);
    if (fclose(out) == 0 && reported)
        facts->report = text;
    else
        free(text);
}

bool file_facts_note(struct file_facts *facts, const char *const *paths, size_t count, bool opened)
{
    const bool said = messages_count() > facts->first_message;
    facts->failed[0] = '\0';
    if (!opened)
        snprintf(facts->failed, sizeof facts->failed, "%s", count > 0 ? paths[0] : "the room");
    drop_report(facts);
    if (count == 1)
        file_facts_look(facts, paths[0]);
    return !opened || said || facts->report;
}
