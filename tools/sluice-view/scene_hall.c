#include "scene_hall.h"

#include "own_path.h"

#include "../common/files.h"
#include "../common/text.h"

#include <stdio.h>
#include <string.h>

/* Meson writes the path of the sources into a file beside the program. */
static bool read_path(const char *folder, char *path, size_t size)
{
    char name[4200];
    snprintf(name, sizeof name, "%s/hall.path", folder);
    FILE *file = fopen(name, "r");
    const bool read = file && fgets(path, (int)size, file);
    if (file)
        fclose(file);
    if (read)
        path[strcspn(path, "\n")] = '\0';
    return read && files_size(path) > 0;
}

bool scene_hall_look(char *path, size_t size)
{
    char folder[4096];
    if (own_folder(folder, sizeof folder)) {
        const char *separator = HALL_FROM_BIN[0] == '/' ? "" : "/";
        const int length = snprintf(path, size, "%s%s%s/hall.gltf", *separator ? folder : "",
                                    separator, HALL_FROM_BIN);
        if (length > 0 && (size_t)length < size && files_size(path) > 0)
            return true;
        if (read_path(folder, path, size))
            return true;
    }
    return false;
}

bool scene_hall_find(char *path, size_t size)
{
    if (scene_hall_look(path, size))
        return true;
    text_say("sluice-view: the hall is not installed (%s): showing a room of computed pictures",
             HALL_FROM_BIN);
    return false;
}
