#define _POSIX_C_SOURCE 200809L
#define _FILE_OFFSET_BITS 64
#include "frame_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../../tools/common/output_file.h"
#include "../../tools/common/text.h"

static bool take_descriptor(int descriptor, size_t frame_size, struct frame_file *file)
{
    *file = (struct frame_file){descriptor >= 0, descriptor, frame_size, NULL};
    return file->is_open;
}

bool frame_file_create(const char *path, size_t frame_size, struct frame_file *file)
{
    struct output_file *output = output_file_begin(path);
    if (!output || !take_descriptor(fileno(output_file_stream(output)), frame_size, file)) {
        output_file_end(output, false);
        *file = (struct frame_file){0};
        return false;
    }
    file->output = output;
    return true;
}

bool frame_file_keep(struct frame_file *file)
{
    bool kept = file->output && output_file_end(file->output, true);
    *file = (struct frame_file){0};
    return kept;
}

bool frame_file_create_scratch(const char *folder, size_t frame_size, struct frame_file *file)
{
    char path[4096];
    int length = snprintf(path, sizeof path, "%s/frames-XXXXXX", folder);
    errno = ENAMETOOLONG;
    if ((size_t)length < sizeof path && take_descriptor(mkstemp(path), frame_size, file)) {
        unlink(path);
        return true;
    }
    text_say("%s: no room for frames: %s", folder, strerror(errno));
    return false;
}

bool frame_file_open(const char *path, size_t frame_size, uint32_t count, struct frame_file *file)
{
    struct stat status; /* opening a pipe must not block, so O_NONBLOCK */
    if (!take_descriptor(open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK), frame_size, file))
        return false;
    if (fstat(file->descriptor, &status) == 0 && S_ISREG(status.st_mode) &&
        (uint64_t)status.st_size == (uint64_t)frame_size * count)
        return true;
    frame_file_close(file);
    return false;
}

void frame_file_close(struct frame_file *file)
{
    if (file->output)
        output_file_end(file->output, false);
    else if (file->is_open)
        close(file->descriptor);
    *file = (struct frame_file){0};
}

bool frame_file_write(const struct frame_file *file, uint32_t frame, const uint8_t *pixels)
{
    off_t at = (off_t)frame * (off_t)file->frame_size;
    for (size_t done = 0; done < file->frame_size;) {
        ssize_t count =
            pwrite(file->descriptor, pixels + done, file->frame_size - done, at + (off_t)done);
        if (count < 0 && errno == EINTR)
            continue;
        if (count <= 0) {
            text_say("frame %u cannot be kept: %s", frame, strerror(errno));
            return false;
        }
        done += (size_t)count;
    }
    return true;
}

bool frame_file_read(const struct frame_file *file, uint32_t frame, uint8_t *pixels)
{
    off_t at = (off_t)frame * (off_t)file->frame_size;
    for (size_t done = 0; done < file->frame_size;) {
        ssize_t count =
            pread(file->descriptor, pixels + done, file->frame_size - done, at + (off_t)done);
        if (count < 0 && errno == EINTR)
            continue;
        if (count <= 0) {
            text_say("frame %u cannot be read again: %s", frame,
                     count ? strerror(errno) : "the file ends before it");
            return false;
        }
        done += (size_t)count;
    }
    return true;
}
