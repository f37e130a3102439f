/** The program that draws a scene: where it is, which build, which options it has. */
#ifndef SLUICE_TRADEOFF_PROGRAM_H
#define SLUICE_TRADEOFF_PROGRAM_H

#include <stdbool.h>
#include <stdint.h>

#include "memory.h"

/** Zeroed is empty. */
struct program {
    struct text_list arguments; ///< its path, and what always stands behind it
    uint64_t build;             ///< hash over its files, and Sluice's libraries it is linked to
    char *help;                 ///< what it prints for --help
};

/** FNV-1a over more bytes; start with PROGRAM_HASH_START. */
#define PROGRAM_HASH_START UINT64_C(0xCBF29CE484222325)
uint64_t program_hash(uint64_t hash, const void *bytes, size_t size);

/** The path of this tool's own executable; to be freed. `argv0` where the system does not say. */
char *program_own_path(const char *argv0);
/**
 * Finds `relative` in the build tree that the tool is in, or `name` in the installed folder of the
 * samples, SAMPLES_FROM_BIN: relative to the tool's folder, or absolute; or `name` in the tool's
 * own folder. NULL if none is there; to be freed.
 */
char *program_find(const char *own_path, const char *relative, const char *name);

/**
 * Asks the program, whose `arguments` are set, for its help, which is kept in `results`, and for
 * its build. `results`/runs exists. False if it cannot be started or has no help, said on stderr.
 */
bool program_ask(struct program *program, const char *results);
/** The same from what `folder` keeps of an earlier sweep, without the program. */
bool program_recall(struct program *program, const char *folder);

bool program_has_option(const struct program *program, const char *name);
void program_finish(struct program *program);

#endif /* SLUICE_TRADEOFF_PROGRAM_H */
