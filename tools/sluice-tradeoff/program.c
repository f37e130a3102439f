#define _POSIX_C_SOURCE 200809L
#include "program.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../common/input.h"
#include "../common/output_file.h"
#include "../common/text.h"
#include "../sluice-replay/file.h"
#include "child.h"
#include "folders.h"
#include "help_text.h"

#define LONGEST_PATH 4096
#define ANSWER_SECONDS 20.0

uint64_t program_hash(uint64_t hash, const void *bytes, size_t size)
{
    const unsigned char *at = bytes;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ at[i]) * UINT64_C(0x100000001B3);
    return hash;
}

char *program_own_path(const char *argv0)
{
    char path[LONGEST_PATH];
    ssize_t length = readlink("/proc/self/exe", path, sizeof path - 1);
    if (length <= 0)
        return memory_copy_text(argv0);
    path[length] = '\0';
    return memory_copy_text(path);
}

char *program_find(const char *own_path, const char *relative, const char *name)
{
    const char *slash = strrchr(own_path, '/');
    int length = slash ? (int)(slash - own_path) : 1;
    const char *folder = slash ? own_path : ".";
    char *in_build_tree = memory_text("%.*s/%s", length, folder, relative);
    char *installed = SAMPLES_FROM_BIN[0] == '/'
                          ? memory_text("%s/%s", SAMPLES_FROM_BIN, name)
                          : memory_text("%.*s/%s/%s", length, folder, SAMPLES_FROM_BIN, name);
    char *beside = memory_text("%.*s/%s", length, folder, name);
    char *found = access(in_build_tree, X_OK) == 0 ? in_build_tree
                  : access(installed, X_OK) == 0   ? installed
                  : access(beside, X_OK) == 0      ? beside
                                                   : NULL;
    if (found != beside)
        free(beside);
    if (found != in_build_tree)
        free(in_build_tree);
    if (found != installed)
        free(installed);
    return found;
}

/* Runs the program with --help in a folder of its own, which contains `path`. */
static bool ask_help(const struct program *program, const char *path, char *environment)
{
    struct text_list arguments = {0};
    struct child child;
    int status = 0;
    char *error = memory_text("%s.log", path);
    text_list_add_all(&arguments, &program->arguments);
    text_list_add(&arguments, "--help");
    const struct child_info info = {arguments.items, path, error, ANSWER_SECONDS, environment};
    bool started = child_begin(&info, &child);
    bool done = started && child_wait(&child, &status) == CHILD_DONE;
    if (!started) {
        text_say("sluice-tradeoff: %s: %s", path, strerror(errno));
    } else if (!done) {
        char *reason = child_reason(&child, status);
        text_say("sluice-tradeoff: %s --help: %s", program->arguments.items[0], reason);
        free(reason);
    }
    free(error);
    text_list_finish(&arguments);
    return done;
}

static bool hash_file(const char *path, uint64_t *hash)
{
    char *bytes;
    size_t size;
    if (!read_file(path, &bytes, &size))
        return false;
    *hash = program_hash(*hash, bytes, size);
    free(bytes);
    return true;
}

/* Hashes the libraries that the dynamic linker lists as "name => path (address)". */
static void hash_libraries(const char *list_path, uint64_t *hash)
{
    char *text;
    size_t size;
    if (!read_file(list_path, &text, &size))
        return;
    for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n")) {
        char *path = strstr(line, "=> ");
        char *end = path ? strstr(path, " (0x") : NULL;
        if (!end || !strstr(line, "sluice"))
            continue;
        *end = '\0';
        hash_file(path + 3, hash);
    }
    free(text);
}

/* Hashes the program and its libraries: a build may change libraries without the program. */
static bool find_build(struct program *program, const char *folder)
{
    char trace[] = "LD_TRACE_LOADED_OBJECTS=1";
    char *list_path = memory_text("%s/libraries.txt", folder);
    program->build = PROGRAM_HASH_START;
    bool read = hash_file(program->arguments.items[0], &program->build);
    if (!read)
        text_say("sluice-tradeoff: %s: %s", program->arguments.items[0], strerror(errno));
    for (size_t i = 1; i < program->arguments.count; i++)
        hash_file(program->arguments.items[i], &program->build); /* a trace, if any */
    if (read && ask_help(program, list_path, trace))
        hash_libraries(list_path, &program->build);
    free(list_path);
    return read;
}

static bool read_help(struct program *program, const char *path)
{
    size_t size;
    if (read_file(path, &program->help, &size))
        return true;
    text_say("sluice-tradeoff: %s: %s", path, strerror(errno));
    return false;
}

/* Asks for --help in `folder`, and keeps the answer in the results for program_recall. */
static bool keep_help(struct program *program, const char *folder, const char *results)
{
    char *answer = memory_text("%s/help.txt", folder);
    char *help = memory_text("%s/program-help.txt", results);
    char *build = memory_text("%s/program-build.txt", results);
    bool kept = ask_help(program, answer, NULL) && read_help(program, answer) &&
                output_file_print(help, "%s", program->help) &&
                output_file_print(build, "%016" PRIx64 "\n", program->build);
    free(build);
    free(help);
    free(answer);
    return kept;
}

bool program_ask(struct program *program, const char *results)
{
    char *folder = folders_make_scratch(results);
    bool asked = folder && find_build(program, folder) && keep_help(program, folder, results);
    folders_remove_scratch(folder);
    return asked;
}

bool program_recall(struct program *program, const char *folder)
{
    char *help_path = memory_text("%s/program-help.txt", folder);
    char *build_path = memory_text("%s/program-build.txt", folder);
    FILE *file = input_open(build_path);
    bool recalled = file && fscanf(file, "%16" SCNx64, &program->build) == 1;
    if (file)
        fclose(file);
    if (!recalled)
        text_say("sluice-tradeoff: %s: there is no sweep", folder);
    recalled = recalled && read_help(program, help_path);
    free(build_path);
    free(help_path);
    return recalled;
}

bool program_has_option(const struct program *program, const char *name)
{
    struct help_entry entry;
    bool found = help_text_find(program->help, name, &entry);
    help_entry_finish(&entry);
    return found;
}

void program_finish(struct program *program)
{
    text_list_finish(&program->arguments);
    free(program->help);
    *program = (struct program){0};
}
