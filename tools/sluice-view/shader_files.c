#define _XOPEN_SOURCE 700 /* mkdtemp */

#include "shader_files.h"

#include "own_path.h"

#include "../common/files.h"
#include "../common/input.h"
#include "../common/text.h"
#include "../sluice-tradeoff/child.h"
#include "../sluice-tradeoff/memory.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define MAX_SPIRV (16u << 20)
#define COMPILE_SECONDS 60.0

static const struct {
    const char *file, *option;
} shaders[SCENE_SHADER_COUNT] = {[SCENE_VERTEX] = {"scene.vert", NULL},
                                 [SCENE_FRAGMENT] = {"scene.frag", NULL},
                                 [SCENE_MASKED_FRAGMENT] = {"scene.frag", "-DMASKED"}};

/** Paths: lines of the file that Meson writes beside the program. */
struct places {
    char compiler[4096], shaders[4096], include[4096];
};

static bool read_line(FILE *file, char *line, size_t size)
{
    if (!fgets(line, (int)size, file))
        return false;
    line[strcspn(line, "\n")] = '\0';
    return line[0] != '\0';
}

static bool read_places(struct places *places)
{
    char folder[4096];
    if (!own_folder(folder, sizeof folder))
        return false;
    char *path = memory_text("%s/shaders.path", folder);
    FILE *file = input_open(path);
    const bool read = file && read_line(file, places->compiler, sizeof places->compiler) &&
                      read_line(file, places->shaders, sizeof places->shaders) &&
                      read_line(file, places->include, sizeof places->include);
    if (file)
        fclose(file);
    free(path);
    return read;
}

const char *shader_files_missing(char *text, size_t size)
{
    struct places places;
    if (!read_places(&places))
        snprintf(text, size, "Shaders are compiled again in a build tree alone");
    else if (access(places.compiler, X_OK) != 0)
        snprintf(text, size, "Shaders cannot be compiled: there is no %.3000s", places.compiler);
    else
        return NULL;
    return text;
}

static bool read_words(const char *path, struct shader_code *code)
{
    char *bytes = NULL;
    if (!input_read_file(path, MAX_SPIRV, &bytes, &code->size) || code->size < 20 ||
        code->size % 4 != 0) {
        free(bytes);
        return false;
    }
    code->words = (uint32_t *)(void *)bytes; /* aligned, since malloc allocated it */
    return true;
}

/* Shows messages of the compiler, which writes them to standard output. */
static void say_messages(const char *path)
{
    char line[1024];
    FILE *file = input_open(path);
    while (file && fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = '\0';
        text_say("sluice-view: %s", line);
    }
    if (file)
        fclose(file);
}

static void list_arguments(const struct places *places, int shader, const char *module,
                           struct text_list *list)
{
    char *include = memory_text("-I%s", places->include);
    char *source = memory_text("%s/%s", places->shaders, shaders[shader].file);
    text_list_add(list, places->compiler);
    text_list_add_parts(list, "-V --quiet --target-env vulkan1.2", ' ');
    text_list_add(list, include);
    if (shaders[shader].option)
        text_list_add(list, shaders[shader].option);
    text_list_add(list, "-o");
    text_list_add(list, module);
    text_list_add(list, source);
    free(source);
    free(include);
}

static bool compile(const struct places *places, int shader, const char *folder,
                    struct shader_code *code)
{
    struct text_list arguments = {0};
    struct child child;
    int status = 0;
    char *module = memory_text("%s/module", folder), *out = memory_text("%s/out", folder);
    char *error = memory_text("%s/error", folder);
    list_arguments(places, shader, module, &arguments);
    const struct child_info info = {
        .arguments = arguments.items, .out = out, .error = error, .limit = COMPILE_SECONDS};
    bool done = child_begin(&info, &child);
    done = done && child_wait(&child, &status) == CHILD_DONE && read_words(module, code);
    if (!done) {
        say_messages(out);
        say_messages(error);
        text_say("sluice-view: %s: cannot be compiled", shaders[shader].file);
    }
    unlink(module);
    unlink(out);
    unlink(error);
    free(module);
    free(out);
    free(error);
    text_list_finish(&arguments);
    return done;
}

bool shader_files_compile(struct shader_code code[SCENE_SHADER_COUNT])
{
    struct places places;
    const char *base = getenv("TMPDIR");
    char *folder = memory_text("%s/sluice-view-XXXXXX", base && base[0] ? base : "/tmp");
    memset(code, 0, SCENE_SHADER_COUNT * sizeof *code);
    bool compiled = mkdtemp(folder) != NULL;
    if (!compiled)
        text_say("sluice-view: %s: %s", folder, strerror(errno));
    for (int i = 0; compiled && i < SCENE_SHADER_COUNT; i++)
        compiled = read_places(&places) && compile(&places, i, folder, &code[i]);
    rmdir(folder);
    free(folder);
    if (!compiled)
        shader_files_finish(code);
    return compiled;
}

void shader_files_finish(struct shader_code code[SCENE_SHADER_COUNT])
{
    for (int i = 0; i < SCENE_SHADER_COUNT; i++) {
        free(code[i].words);
        code[i] = (struct shader_code){0};
    }
}
