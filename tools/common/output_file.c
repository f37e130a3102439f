#define _POSIX_C_SOURCE 200809L
#define _FILE_OFFSET_BITS 64
#include "output_file.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/alloc.h"
#include "base/part_file.h"
#include "output_names.h"
#include "text.h"

struct output_file {
    struct slc_part_file part;
    FILE *stream; ///< A separate descriptor of the same open file.
};

/* Global: a program has one set of inputs. */
static const char *speaker = "";
static pthread_mutex_t input_lock = PTHREAD_MUTEX_INITIALIZER; ///< guards the inputs
static struct input {
    dev_t device;
    ino_t inode;
} * inputs;
static size_t input_count, input_capacity;

void output_set_speaker(const char *text)
{
    speaker = text;
}

/* Makes room for one more. The mutex is held. */
static bool reserve_input(void)
{
    if (input_count < input_capacity)
        return true;
    size_t capacity = input_capacity ? 2 * input_capacity : 16;
    struct input *more = realloc(inputs, capacity * sizeof *more);
    if (!more)
        return false;
    inputs = more;
    input_capacity = capacity;
    return true;
}

bool output_add_input(const char *path)
{
    struct stat status;
    if (stat(path, &status) != 0 || !S_ISREG(status.st_mode))
        return true;
    pthread_mutex_lock(&input_lock);
    bool has_room = reserve_input();
    if (has_room)
        inputs[input_count++] = (struct input){status.st_dev, status.st_ino};
    pthread_mutex_unlock(&input_lock);
    if (!has_room)
        text_say("%sout of memory", speaker);
    return has_room;
}

static bool is_input(const char *path)
{
    struct stat status;
    if (stat(path, &status) != 0 || !S_ISREG(status.st_mode))
        return false;
    bool found = false;
    pthread_mutex_lock(&input_lock);
    for (size_t i = 0; i < input_count && !found; i++)
        found = inputs[i].device == status.st_dev && inputs[i].inode == status.st_ino;
    pthread_mutex_unlock(&input_lock);
    return found;
}

bool output_spares_inputs(const char *path)
{
    char part[4200]; /* the system opens no longer paths */
    int length = snprintf(part, sizeof part, "%s.sluice-part", path);
    bool spares = !is_input(path) && !((size_t)length < sizeof part && is_input(part));
    if (!spares)
        text_say("%s%s: would replace a file that is read; name another output", speaker, path);
    return spares;
}

/* Opening a pipe would wait for its reader; closing it would signal the end of the data. */
static bool is_stream(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && (S_ISFIFO(status.st_mode) || S_ISCHR(status.st_mode));
}

static bool refuse_name(const char *path)
{
    text_say("%s%s: two outputs of this run have this name; name another one", speaker, path);
    return false;
}

/* Several outputs may share a pipe or a device. */
static bool take_name(const char *path, enum output_name_owner owner)
{
    if (is_stream(path))
        return true;
    switch (output_name_take(path, owner)) {
    case OUTPUT_NAME_FREE: return true;
    case OUTPUT_NAME_TAKEN: return refuse_name(path);
    case OUTPUT_NAME_NO_MEMORY: break;
    }
    text_say("%s%s: out of memory", speaker, path);
    return false;
}

bool output_claim(const char *path)
{
    return output_spares_inputs(path) && take_name(path, OUTPUT_NAME_OF_LIBRARY);
}

static void on_log(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)user;
    (void)severity;
    text_say("%s%s", speaker, message);
}

static bool open_stream(struct output_file *file)
{
    int descriptor = fcntl(file->part.descriptor, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    if (descriptor < 0)
        return false;
    file->stream = fdopen(descriptor, "w");
    if (file->stream)
        return true;
    int error = errno;
    close(descriptor);
    errno = error;
    return false;
}

static struct output_file *begin(const char *path, uint32_t flags)
{
    const SluiceAllocationCallbacks memory = slc_allocator(NULL);
    const SluiceLogCallback log = {.pfnLog = on_log};
    if (!output_spares_inputs(path) || (output_name_is_of_library(path) && !refuse_name(path)))
        return NULL;
    struct output_file *file = calloc(1, sizeof *file);
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (file)
        result = slc_part_file_open(&file->part, path, SLC_PART_FILE_STREAM | flags, &memory, &log);
    if (result == SLUICE_SUCCESS && open_stream(file))
        return file;
    if (result == SLUICE_SUCCESS)
        text_say("%s%s: %s", speaker, path, strerror(errno));
    else if (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY)
        text_say("%s%s: out of memory", speaker, path);
    if (file)
        slc_part_file_finish(&file->part, false);
    free(file);
    return NULL;
}

struct output_file *output_file_begin(const char *path)
{
    return begin(path, 0);
}

struct output_file *output_file_begin_quickly(const char *path)
{
    return begin(path, SLC_PART_FILE_UNSYNCED);
}

bool output_can_write(const char *path)
{
    const SluiceAllocationCallbacks memory = slc_allocator(NULL);
    const SluiceLogCallback log = {.pfnLog = on_log};
    struct slc_part_file part;
    if (is_stream(path))
        return true;
    if (!output_spares_inputs(path) || !take_name(path, OUTPUT_NAME_OF_PROGRAM))
        return false;
    SluiceResult result = slc_part_file_open(&part, path, 0, &memory, &log);
    if (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY)
        text_say("%s%s: out of memory", speaker, path);
    slc_part_file_finish(&part, false);
    return result == SLUICE_SUCCESS;
}

FILE *output_file_stream(struct output_file *file)
{
    return file->stream;
}

/* Flushes the stream. Reports errors on stderr. */
static bool flush(struct output_file *file)
{
    bool failed = ferror(file->stream) != 0;
    errno = 0;
    if (fflush(file->stream) == 0 && !failed)
        return true;
    text_say("%s%s: cannot write%s%s", speaker, file->part.target, errno ? ": " : "",
             errno ? strerror(errno) : "");
    return false;
}

bool output_file_end(struct output_file *file, bool keep)
{
    if (!file)
        return false;
    keep = keep && flush(file);
    fclose(file->stream); /* the part file syncs its own descriptor */
    keep = slc_part_file_finish(&file->part, keep) == SLUICE_SUCCESS && keep;
    free(file);
    return keep;
}

bool output_file_print(const char *path, const char *format, ...)
{
    struct output_file *file = output_file_begin(path);
    if (!file)
        return false;
    va_list arguments;
    va_start(arguments, format);
    vfprintf(file->stream, format, arguments);
    va_end(arguments);
    return output_file_end(file, true);
}
