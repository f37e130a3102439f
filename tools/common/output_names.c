#define _XOPEN_SOURCE 700
#include "output_names.h"

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

struct name {
    dev_t device; ///< device of the folder
    ino_t folder;
    char *word; ///< last part of the path; owned
    uint64_t hash;
    enum output_name_owner owner;
};

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static struct name *names;
static size_t name_count, name_capacity;

static uint64_t hash_word(uint64_t hash, const char *word)
{
    for (; *word; word++)
        hash = (hash ^ (unsigned char)*word) * UINT64_C(0x100000001B3);
    return hash;
}

/* Returns false without a folder, or when out of memory. */
static bool describe(const char *path, struct name *name, bool *has_memory)
{
    struct stat status;
    const char *slash = strrchr(path, '/');
    char *folder = slash ? strndup(path, (size_t)(slash - path) + 1) : strdup(".");
    *has_memory = folder != NULL;
    bool found = folder && stat(folder, &status) == 0;
    free(folder);
    if (!found)
        return false;
    *name = (struct name){.device = status.st_dev, .folder = status.st_ino};
    name->word = strdup(slash ? slash + 1 : path);
    *has_memory = name->word != NULL;
    if (name->word)
        name->hash = hash_word((uint64_t)status.st_dev * 31 + (uint64_t)status.st_ino, name->word);
    return name->word != NULL;
}

static struct name *find(const struct name *name)
{
    for (size_t i = 0; i < name_count; i++)
        if (names[i].hash == name->hash && names[i].device == name->device &&
            names[i].folder == name->folder && strcmp(names[i].word, name->word) == 0)
            return &names[i];
    return NULL;
}

static bool grow(void)
{
    size_t capacity = name_capacity ? 2 * name_capacity : 64;
    struct name *more = realloc(names, capacity * sizeof *more);
    if (!more)
        return false;
    names = more;
    name_capacity = capacity;
    return true;
}

/* Takes the word if the name is new. */
static enum output_name_answer add(struct name *name)
{
    if (find(name))
        return OUTPUT_NAME_TAKEN;
    if (name_count == name_capacity && !grow())
        return OUTPUT_NAME_NO_MEMORY;
    names[name_count++] = *name;
    name->word = NULL;
    return OUTPUT_NAME_FREE;
}

enum output_name_answer output_name_take(const char *path, enum output_name_owner owner)
{
    struct name name;
    bool has_memory;
    if (!describe(path, &name, &has_memory))
        return has_memory ? OUTPUT_NAME_FREE : OUTPUT_NAME_NO_MEMORY;
    name.owner = owner;
    pthread_mutex_lock(&lock);
    enum output_name_answer answer = add(&name);
    pthread_mutex_unlock(&lock);
    free(name.word);
    return answer;
}

bool output_name_is_of_library(const char *path)
{
    struct name name;
    bool has_memory;
    if (!describe(path, &name, &has_memory))
        return false;
    pthread_mutex_lock(&lock);
    const struct name *known = find(&name);
    bool is = known && known->owner == OUTPUT_NAME_OF_LIBRARY;
    pthread_mutex_unlock(&lock);
    free(name.word);
    return is;
}
