/** Compiles the shaders of scenes from their sources while the program runs. */
#ifndef SLUICE_VIEW_SHADER_FILES_H
#define SLUICE_VIEW_SHADER_FILES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum scene_shader { SCENE_VERTEX, SCENE_FRAGMENT, SCENE_MASKED_FRAGMENT, SCENE_SHADER_COUNT };

/** A SPIR-V module. */
struct shader_code {
    uint32_t *words; ///< owned
    size_t size;     ///< bytes
};

/** Returns why shaders cannot be compiled here, written to `text`; NULL: they can. */
const char *shader_files_missing(char *text, size_t size);
/** Compiles all shaders in a temporary folder, and waits. False, with the compiler's messages on
 *  stderr, if a shader failed: `code` needs no shader_files_finish then. */
bool shader_files_compile(struct shader_code code[SCENE_SHADER_COUNT]);
void shader_files_finish(struct shader_code code[SCENE_SHADER_COUNT]);

#endif /* SLUICE_VIEW_SHADER_FILES_H */
