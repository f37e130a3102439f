#define _POSIX_C_SOURCE 200809L
#include "log.h"

#include "text.h"

#include <inttypes.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define MAX_FILES 256u      ///< the last entry stands for all others
#define MESSAGE_SLOTS 4096u ///< a power of two
#define MAX_MESSAGES 3072u  ///< later messages count as repeats

struct file {
    char *name; ///< owned; NULL: files that have no entry of their own
    const char *speaker;
    uint64_t hash;
    uint32_t said;
    uint64_t counted;
};

/* State of the program's log, shared by the callbacks of all streamers and sources. */
static struct {
    pthread_mutex_t lock;
    struct file files[MAX_FILES];
    uint32_t file_count, message_count;
    uint64_t messages[MESSAGE_SLOTS]; ///< hashes; 0: empty
} table = {.lock = PTHREAD_MUTEX_INITIALIZER};

/* FNV-1a. */
static uint64_t hash_of(const char *bytes, size_t size)
{
    uint64_t hash = 0xCBF29CE484222325u;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ (unsigned char)bytes[i]) * 0x100000001B3u;
    return hash ? hash : 1;
}

/* Returns the number of bytes before ": ", where a file's name ends. */
static size_t name_length(const char *message)
{
    const char *end = strstr(message, ": ");
    return end ? (size_t)(end - message) : strlen(message);
}

static struct file *find_file(const char *speaker, const char *message)
{
    size_t length = name_length(message);
    uint64_t hash = hash_of(message, length);
    for (uint32_t i = 0; i < table.file_count; i++)
        if (table.files[i].hash == hash)
            return &table.files[i];
    if (table.file_count < MAX_FILES) {
        struct file *file = &table.files[table.file_count++];
        bool has_name = table.file_count < MAX_FILES;
        *file = (struct file){.name = has_name ? strndup(message, length) : NULL,
                              .speaker = speaker,
                              .hash = has_name ? hash : 0};
    }
    return &table.files[table.file_count - 1];
}

/* Notes a message. Returns false if it was printed before, or if the table is full. */
static bool is_new(const char *message)
{
    uint64_t hash = hash_of(message, strlen(message));
    uint64_t slot = hash;
    for (; table.messages[slot % MESSAGE_SLOTS]; slot++)
        if (table.messages[slot % MESSAGE_SLOTS] == hash)
            return false;
    if (table.message_count == MAX_MESSAGES)
        return false;
    table.messages[slot % MESSAGE_SLOTS] = hash;
    table.message_count++;
    return true;
}

void log_say(void *user_data, SluiceLogSeverity severity, const char *message)
{
    const char *speaker = user_data ? user_data : "";
    if (severity == SLUICE_LOG_INFO)
        return;
    pthread_mutex_lock(&table.lock);
    struct file *file = find_file(speaker, message);
    if (file->said < LOG_LINES_PER_FILE && is_new(message)) {
        file->said++;
        text_say("%s%s", speaker, message);
    } else {
        file->counted++;
    }
    pthread_mutex_unlock(&table.lock);
}

void log_finish(void)
{
    pthread_mutex_lock(&table.lock);
    for (uint32_t i = 0; i < table.file_count; i++) {
        struct file *file = &table.files[i];
        if (file->counted > 0)
            text_say("%s%s: %" PRIu64 " more message%s", file->speaker,
                     file->name ? file->name : "other files", file->counted,
                     file->counted == 1 ? "" : "s, repeats among them");
        free(file->name);
    }
    table.file_count = table.message_count = 0;
    memset(table.messages, 0, sizeof table.messages);
    pthread_mutex_unlock(&table.lock);
}
