#include "messages.h"

#include "../common/text.h"

#include <pthread.h>
#include <stdio.h>
#include <string.h>

#define LINE_SIZE 512u

/* The program has one list, since text_say has one listener. */
static struct {
    pthread_mutex_t lock;
    char lines[MESSAGES_KEPT][LINE_SIZE]; ///< line n is at n % MESSAGES_KEPT
    uint32_t count;
} list = {.lock = PTHREAD_MUTEX_INITIALIZER};

static const char *without_speaker(const char *line)
{
    static const char *const speakers[] = {"sluice-view: ", "sluice-info: "};
    for (size_t i = 0; i < sizeof speakers / sizeof *speakers; i++)
        if (strncmp(line, speakers[i], strlen(speakers[i])) == 0)
            return line + strlen(speakers[i]);
    return line;
}

static void keep(void *user_data, const char *line)
{
    (void)user_data;
    pthread_mutex_lock(&list.lock);
    snprintf(list.lines[list.count % MESSAGES_KEPT], LINE_SIZE, "%s", without_speaker(line));
    list.count++;
    pthread_mutex_unlock(&list.lock);
}

void messages_begin(void)
{
    list.count = 0;
    text_set_listener(keep, NULL);
}

void messages_end(void)
{
    text_set_listener(NULL, NULL);
}

uint32_t messages_count(void)
{
    pthread_mutex_lock(&list.lock);
    const uint32_t count = list.count;
    pthread_mutex_unlock(&list.lock);
    return count;
}

bool messages_get(uint32_t number, char *text, size_t size)
{
    pthread_mutex_lock(&list.lock);
    const bool kept = number < list.count && list.count - number <= MESSAGES_KEPT;
    if (kept)
        snprintf(text, size, "%s", list.lines[number % MESSAGES_KEPT]);
    pthread_mutex_unlock(&list.lock);
    return kept;
}

/* Advice by words of a line. The first row that matches is used. */
static const struct {
    const char *words, *advice;
} advices[] = {
    {"KHR_texture_basisu",
     "Export the file with PNG, JPEG or WebP images, or with a source beside each extension."},
    {"KHR_draco_mesh_compression", "Export the file without compression of meshes."},
    {"EXT_meshopt_compression", "Export the file without compression of meshes."},
    {"KHR_mesh_quantization", "Export the file without quantization of meshes."},
    {"No such file", "Check the name; files that a scene names lie beside it."},
    {"FILE_NOT_FOUND", "Check the name; files that a scene names lie beside it."},
    {"ermission denied", "Make the file and its folder readable for you."},
    {"is no regular file", "Choose a file, not a folder or a device."},
    {"is no picture and no folder", "Open one scene, or pictures alone."},
    {"is no glTF of version 2", "Export the file as glTF 2.0."},
    {"is no .glb of version 2", "Export the file as glTF 2.0."},
    {"TEXCOORD_", "Export the file with two sets of texture coordinates at most."},
    {"which is not supported", "The rest is shown without it."},
    {"is not supported", "The rest is shown without it."},
    {"write the file again with all levels", "Bake a tile store of it with sluice-bake."},
    {"ends before a level fits", "Bake a tile store of it with sluice-bake."},
    {"several layers", "Bake the layers as pictures of their own."},
    {"texels are integers", "Write the picture in a format of fractions or floats."},
    {"has no triangles", "Export the meshes as triangles, with their materials."},
    {"no picture to show", "Choose a folder with pictures, or a scene."},
    {"without sluice-http", "Copy the file here, or build with libcurl."},
    {"out of memory", "Close other programs, or open a smaller scene."},
    {"OUT_OF_HOST_MEMORY", "Close other programs, or open a smaller scene."},
    {"OUT_OF_DEVICE_MEMORY", "Lower the budget (U), or open a smaller scene."},
    {"too large", "Split the scene."},
    {"checksum", "The file is damaged: copy it or bake it again."},
    {"CORRUPT_DATA", "The file is damaged or cut off: copy or export it again."},
    {"ends at byte", "The file is damaged or cut off: copy or export it again."},
    {"is not valid JSON", "The file is damaged or cut off: copy or export it again."},
    {"is no base64", "The file is damaged or cut off: copy or export it again."},
    {"cut off", "The file is damaged or cut off: copy or export it again."},
    {"is damaged", "The file is damaged: copy or export it again."},
    {"UNSUPPORTED", "Write the file in another format that docs/images.md lists."},
};

const char *messages_advice(const char *text)
{
    for (size_t i = 0; i < sizeof advices / sizeof *advices; i++)
        if (strstr(text, advices[i].words))
            return advices[i].advice;
    return NULL;
}
