#define _POSIX_C_SOURCE 200809L /* kill */

#include "trade.h"

#include "controls.h"
#include "own_path.h"

#include "../common/clock.h"
#include "../common/input.h"
#include "../common/text.h"

#include <dirent.h>
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define TRADE_FOLDER "sluice-view-trade"
#define PATH_FILE TRADE_FOLDER "/walk.path"
#define PAGE TRADE_FOLDER "/page.html"
#define RUN_SIZE "640x360"
#define LEAST_FRAMES 30
#define MOST_FRAMES 600
#define LOOK_SECONDS 0.5

const char *trade_page(void)
{
    return PAGE;
}

static void stop(struct trade *t)
{
    child_kill(&t->child);
    text_list_finish(&t->arguments);
    free(t->out);
    free(t->error);
    t->out = t->error = NULL;
}

void trade_finish(struct trade *t)
{
    stop(t);
    *t = (struct trade){0};
}

static void fail(struct trade *t, const char *reason)
{
    snprintf(t->reason, sizeof t->reason, "%s", reason);
    text_say("sluice-view: no sweep: %s", reason);
    t->state = TRADE_FAILED;
}

/* Finds sluice-tradeoff in the build tree, or installed beside this program. */
static char *find_program(void)
{
    static const char *const places[] = {"../sluice-tradeoff/sluice-tradeoff", "sluice-tradeoff"};
    char folder[4096];
    for (int i = 0; i < 2 && own_folder(folder, sizeof folder); i++) {
        char *path = memory_text("%s/%s", folder, places[i]);
        if (access(path, X_OK) == 0)
            return path;
        free(path);
    }
    return NULL;
}

static void add(struct text_list *list, const char *option, const char *value)
{
    text_list_add(list, option);
    text_list_add(list, value);
}

static void add_bases(const struct view_settings *settings, struct text_list *list)
{
    char value[64];
    uint32_t count;
    const struct control *controls = controls_get(&count);
    for (uint32_t i = 0; i < count; i++) {
        if (!control_is_of_sets(&controls[i]) || controls[i].flags & CONTROL_PASSING ||
            control_is_default(&controls[i], settings) ||
            strcmp(controls[i].option.name, "threads") == 0) /* passed as an argument of the runs */
            continue; /* the sweep sets sizes and views itself */
        char *base = memory_text("%s=%s", controls[i].option.name,
                                 control_write(&controls[i], settings, value, sizeof value));
        add(list, "--base", base);
        free(base);
    }
}

static bool write_path(const struct trade_request *r, unsigned *frames)
{
    struct camera_path still = {0};
    const struct camera_path *path = r->path;
    const double length = path && path->count > 0 ? (double)camera_path_length(path) : 0.0;
    if (!path || path->count == 0) {
        if (!camera_path_add(&still, 0, r->camera))
            return false;
        path = &still;
    }
    *frames = length * 60 > MOST_FRAMES    ? MOST_FRAMES
              : length * 60 < LEAST_FRAMES ? LEAST_FRAMES
                                           : (unsigned)(length * 60);
    const bool written = files_make_folders_of(PATH_FILE) && camera_path_write(PATH_FILE, path);
    camera_path_finish(&still);
    return written;
}

static void add_arguments(struct trade *t, const struct trade_request *r, const char *self,
                          unsigned frames)
{
    struct text_list *list = &t->arguments;
    char number[16], threads[16];
    snprintf(number, sizeof number, "%u", frames);
    snprintf(threads, sizeof threads, "%u", r->threads);
    text_list_add(list, "view");
    text_list_add(list, "--fresh");
    add(list, "--repeats", "1");
    add(list, "--results", TRADE_FOLDER);
    add(list, "--program", self);
    add_bases(r->settings, list);
    text_list_add(list, "--");
    for (size_t i = 0; i < r->paths->count; i++)
        text_list_add(list, r->paths->paths[i]);
    if (r->paths->count == 0)
        text_list_add(list, "--room");
    if (r->cache)
        add(list, "--cache", r->cache);
    if (r->device)
        add(list, "--device", r->device);
    if (r->threads > 0)
        add(list, "--threads", threads);
    add(list, "--play", PATH_FILE);
    add(list, "--frames", number);
    add(list, "--size", RUN_SIZE);
}

void trade_begin(struct trade *t, const struct trade_request *request)
{
    char self[4096];
    unsigned frames;
    stop(t);
    t->done = t->total = 0;
    char *program = find_program();
    if (!program || !own_path(self, sizeof self)) {
        fail(t, "sluice-tradeoff is not beside this program");
    } else if (!write_path(request, &frames)) {
        fail(t, "the camera path cannot be written");
    } else {
        text_list_add(&t->arguments, program);
        add_arguments(t, request, self, frames);
        t->out = memory_copy_text(TRADE_FOLDER "/table.txt");
        t->error = memory_copy_text(TRADE_FOLDER "/messages.txt");
        const struct child_info info = {
            .arguments = t->arguments.items, .out = t->out, .error = t->error};
        unlink(TRADE_FOLDER "/sweep.runs"); /* left by the previous sweep */
        t->state = TRADE_RUNS;
        if (!child_begin(&info, &t->child))
            fail(t, strerror(errno));
    }
    free(program);
}

void trade_cancel(struct trade *t)
{
    if (t->state != TRADE_RUNS)
        return;
    kill(t->child.pid,
         SIGTERM); /* sluice-tradeoff ends its children, which have groups of their own */
    t->state = TRADE_CANCELED;
}

/* Counts the lines of a file. Each line is a run. */
static unsigned count_lines(const char *path)
{
    unsigned count = 0;
    FILE *file = input_open(path);
    for (int c; file && (c = fgetc(file)) != EOF;)
        count += c == '\n';
    if (file)
        fclose(file);
    return count;
}

/* Counts complete runs. Their folders have a repeat and a key in their name, and no suffix. */
static unsigned count_runs(const char *path)
{
    unsigned count = 0;
    DIR *folder = opendir(path);
    for (const struct dirent *entry; folder && (entry = readdir(folder));) {
        const char *dot = strchr(entry->d_name, '.');
        count += !dot || strcmp(dot, ".failed") == 0;
    }
    if (folder)
        closedir(folder);
    return count;
}

/* Reads the advice: lines such as "quality       budget 16" below the table. */
static void read_advice(struct trade *t)
{
    static const char *const names[TRADE_ADVICE] = {"quality", "balanced", "small memory"};
    char line[1024];
    FILE *file = input_open(t->out);
    while (file && fgets(line, sizeof line, file))
        for (int i = 0; i < TRADE_ADVICE; i++) {
            const size_t length = strlen(names[i]);
            if (strncmp(line, names[i], length) != 0 || line[length] != ' ')
                continue;
            const char *value = line + length + strspn(line + length, " ");
            snprintf(t->advice[i], sizeof t->advice[i], "%s: %.*s", names[i],
                     (int)strcspn(value, "\n"), value);
        }
    if (file)
        fclose(file);
}

static void take_end(struct trade *t, enum child_state ended, int status)
{
    if (t->state == TRADE_CANCELED)
        return;
    t->done = count_runs(TRADE_FOLDER "/runs");
    t->total = count_lines(TRADE_FOLDER "/sweep.runs");
    read_advice(t);
    t->state = TRADE_DONE;
    if (ended == CHILD_DONE)
        return;
    char *reason = child_reason(&t->child, status);
    fail(t, reason);
    free(reason);
}

void trade_watch(struct trade *t)
{
    int status = 0;
    if (t->child.pid <= 0 || clock_seconds() - t->looked < LOOK_SECONDS)
        return;
    t->looked = clock_seconds();
    t->done = count_runs(TRADE_FOLDER "/runs");
    t->total = count_lines(TRADE_FOLDER "/sweep.runs");
    const enum child_state state = child_poll(&t->child, &status);
    if (state != CHILD_RUNS)
        take_end(t, state, status);
}

void trade_wait(struct trade *t)
{
    int status = 0;
    if (t->child.pid > 0)
        take_end(t, child_wait(&t->child, &status), status);
}

/* xdg-open may become the browser, or start the browser as a child. */
void trade_open_page(void)
{
    struct text_list arguments = {0};
    add(&arguments, "/usr/bin/env", "xdg-open");
    text_list_add(&arguments, PAGE);
    const struct child_info info = {.arguments = arguments.items,
                                    .out = TRADE_FOLDER "/open.txt",
                                    .error = TRADE_FOLDER "/open-messages.txt"};
    if (!child_begin_detached(&info))
        text_say("sluice-view: xdg-open: %s", strerror(errno));
    text_list_finish(&arguments);
}
