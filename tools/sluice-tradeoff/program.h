/** The program that draws a scene: its path, build and options. */
#ifndef SLUICE_TRADEOFF_PROGRAM_H
#define SLUICE_TRADEOFF_PROGRAM_H

#include <stdbool.h>
#include <stdint.h>

#include "memory.h"

/** Zeroed is empty. */
struct program {
    struct text_list arguments; ///< path of the program, and its constant arguments
    uint64_t build;             ///< hash of its files and of the Sluice libraries it links
    char *help;                 ///< output of --help
};

/** FNV-1a over more bytes. Start with PROGRAM_HASH_START. */
#define PROGRAM_HASH_START UINT64_C(0xCBF29CE484222325)
uint64_t program_hash(uint64_t hash, const void *bytes, size_t size);

/** Returns the path of this tool's executable; `argv0` if the system does not tell. The caller
 * frees it. */
char *program_own_path(const char *argv0);
/**
 * Finds a program: `relative` in the tool's build tree, or `name` in the installed folder of the
 * samples, or `name` in the tool's own folder. SAMPLES_FROM_BIN is the samples' folder, absolute or
 * relative to the tool's. Returns NULL if none exists. The caller frees the path.
 */
char *program_find(const char *own_path, const char *relative, const char *name);

/**
 * Asks the program for its help and build, and keeps them in `results`. Set `arguments` before;
 * `results`/runs must exist. Returns false if the program cannot be started or has no help, and
 * reports it on stderr.
 */
bool program_ask(struct program *program, const char *results);
/** Reads help and build from `folder`, as kept by an earlier sweep, without the program. */
bool program_recall(struct program *program, const char *folder);

bool program_has_option(const struct program *program, const char *name);
void program_finish(struct program *program);

#endif /* SLUICE_TRADEOFF_PROGRAM_H */
