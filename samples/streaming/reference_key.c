#define _POSIX_C_SOURCE 200809L
#include "reference_key.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../../tools/common/input.h"
#include "../../tools/common/output_file.h"
#include "../../tools/common/text.h"

#define MAX_SIZE (16u << 20) ///< maximum bytes of a text file that is read
#define FIRST_WORDS "frames of the gallery with everything resident"

/** Writes a line with the file's size and time, if there is one. */
static void write_picture(FILE *out, const struct picture *picture)
{
    struct stat status;
    fprintf(out, "picture: ");
    text_write(out, picture->path);
    if (stat(picture->path, &status) == 0)
        fprintf(out, " %" PRIu64 " bytes of %" PRId64 ".%09ld", (uint64_t)status.st_size,
                (int64_t)status.st_mtim.tv_sec, status.st_mtim.tv_nsec);
    fprintf(out, "\n");
}

char *reference_key_create(const struct settings *settings, const struct gpu *gpu,
                           const struct picture_list *pictures)
{
    static const char *const formats[] = {"auto", "rgba16f", "rgba8"};
    static const char *const modes[] = {"auto", "sparse", "paged", "dense"};
    char *key = NULL;
    size_t size;
    FILE *out = open_memstream(&key, &size);
    if (!out)
        return NULL;
    fprintf(out, FIRST_WORDS ", version 1\ndevice: ");
    text_write(out, gpu->properties.deviceName);
    fprintf(out, "\ndriver: %u\n", gpu->properties.driverVersion);
    fprintf(out, "residency: %s\n", modes[gpu->modes[1]]);
    fprintf(out, "size: %ux%u\n", settings->size[0], settings->size[1]);
    fprintf(out, "frames: %u\nrest-frames: %u\n", settings->frames, settings->rest_frames);
    fprintf(out, "samples: %u\n", settings->reference_samples);
    fprintf(out, "supersample: %u\n", settings->reference_supersample);
    fprintf(out, "anisotropy: %u\n", settings->reference_anisotropy);
    fprintf(out, "lod-bias: %.9g\n", settings->reference_lod_bias);
    fprintf(out, "generate-scale: %u\n", settings->generate_scale);
    fprintf(out, "format: %s\n", formats[settings->format]);
    for (uint32_t i = 0; i < pictures->count; i++)
        write_picture(out, &pictures->pictures[i]);
    bool written = !ferror(out);
    if (fclose(out) == 0 && written)
        return key;
    free(key);
    return NULL;
}

/** Reads the whole file as a string. Free the result. NULL on error. */
static char *read_text(const char *path)
{
    FILE *file = input_open(path);
    char *text = file ? malloc(MAX_SIZE + 1) : NULL;
    if (text) {
        size_t size = fread(text, 1, MAX_SIZE, file);
        text[size] = '\0';
        if (size == MAX_SIZE || ferror(file) || strlen(text) != size) {
            free(text);
            text = NULL;
        }
    }
    if (file)
        fclose(file);
    return text;
}

/** Reports the first line in which the texts differ. */
static void explain(const char *path, const char *text, const char *key)
{
    while (*text && *key) {
        int length = (int)strcspn(text, "\n"), key_length = (int)strcspn(key, "\n");
        if (length != key_length || strncmp(text, key, (size_t)length) != 0) {
            text_say("%s: these frames have \"%.*s\", not \"%.*s\"", path, length, text, key_length,
                     key);
            return;
        }
        text += length + (text[length] != '\0');
        key += key_length + (key[key_length] != '\0');
    }
    text_say("%s: is cut off", path);
}

/** Accepts also the beginning of such a text, which an older version may have cut off. */
static bool is_of_this_program(const char *text)
{
    size_t length = strlen(text), whole = strlen(FIRST_WORDS);
    return strncmp(text, FIRST_WORDS, length < whole ? length : whole) == 0;
}

enum reference_match reference_key_compare(const char *path, const char *key,
                                           struct reference_content *content)
{
    char *text = read_text(path);
    size_t length = strlen(key);
    enum reference_match match = text ? REFERENCE_DIFFERS : REFERENCE_MISSING;
    if (text && strncmp(text, key, length) == 0 &&
        sscanf(text + length, "device-memory: %" SCNu64 "\nchecksum: %" SCNx32,
               &content->device_memory, &content->checksum) == 2)
        match = REFERENCE_MATCHES;
    else if (text && is_of_this_program(text))
        explain(path, text, key);
    else if (text || access(path, F_OK) == 0)
        match = REFERENCE_FOREIGN;
    free(text);
    return match;
}

bool reference_key_write(const char *path, const char *key, const struct reference_content *content)
{
    return output_file_print(path, "%sdevice-memory: %" PRIu64 "\nchecksum: %08" PRIx32 "\n", key,
                             content->device_memory, content->checksum);
}
