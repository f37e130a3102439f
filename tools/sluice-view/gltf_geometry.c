#include "gltf_geometry.h"

#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/material.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/*
 * Assimp numbers materials in the order of their use, opens image files, and lets extensions change
 * its input. So Assimp reads a generated file: the geometry, buffers named by number, and materials
 * named by number.
 */
#define SCENE_NAME "scene.gltf"

struct memory_files {
    const struct gltf_file *gltf;
    char *text; ///< contents of SCENE_NAME
};

struct memory_file {
    struct aiFile file;
    struct gltf_bytes bytes;
    uint64_t at;
};

static size_t read_file(struct aiFile *base, char *to, size_t size, size_t count)
{
    struct memory_file *file = (struct memory_file *)base;
    const uint64_t left = file->bytes.size - file->at;
    if (size == 0)
        return 0;
    const size_t whole = left / size < count ? (size_t)(left / size) : count;
    memcpy(to, file->bytes.bytes + file->at, whole * size);
    file->at += whole * size;
    return whole;
}

static size_t write_file(struct aiFile *base, const char *from, size_t size, size_t count)
{
    (void)base, (void)from, (void)size, (void)count;
    return 0;
}

static size_t tell(struct aiFile *base)
{
    return (size_t)((struct memory_file *)base)->at;
}

static size_t file_size(struct aiFile *base)
{
    return (size_t)((struct memory_file *)base)->bytes.size;
}

static enum aiReturn seek(struct aiFile *base, size_t offset, enum aiOrigin origin)
{
    struct memory_file *file = (struct memory_file *)base;
    const uint64_t from = origin == aiOrigin_SET   ? 0
                          : origin == aiOrigin_CUR ? file->at
                                                   : file->bytes.size;
    if (offset > file->bytes.size - from)
        return aiReturn_FAILURE;
    file->at = from + offset;
    return aiReturn_SUCCESS;
}

static void flush(struct aiFile *base)
{
    (void)base;
}

/* Finds the bytes of a name. Assimp may put a folder in front of the name. */
static bool find_bytes(const struct memory_files *files, const char *path, struct gltf_bytes *bytes)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    unsigned number;
    char rest;
    if (strcmp(name, SCENE_NAME) == 0) {
        *bytes = (struct gltf_bytes){(const uint8_t *)files->text, strlen(files->text), NULL};
        return true;
    }
    if (sscanf(name, "%u.bi%c", &number, &rest) != 2 || rest != 'n' ||
        number >= files->gltf->lists[GLTF_BUFFERS].count)
        return false;
    *bytes = files->gltf->buffers[number];
    return true;
}

static struct aiFile *open_file(struct aiFileIO *io, const char *path, const char *mode)
{
    struct memory_file *file = NULL;
    struct gltf_bytes bytes;
    if (!strchr(mode, 'w') && find_bytes((const struct memory_files *)io->UserData, path, &bytes))
        file = calloc(1, sizeof *file);
    if (!file)
        return NULL;
    file->bytes = bytes;
    file->file = (struct aiFile){.ReadProc = read_file,
                                 .WriteProc = write_file,
                                 .TellProc = tell,
                                 .FileSizeProc = file_size,
                                 .SeekProc = seek,
                                 .FlushProc = flush,
                                 .UserData = NULL};
    return &file->file;
}

static void close_file(struct aiFileIO *io, struct aiFile *file)
{
    (void)io;
    free(file);
}

static bool add_numbered(cJSON *root, const struct gltf_file *file)
{
    char name[32];
    cJSON *materials = cJSON_AddArrayToObject(root, "materials");
    cJSON *buffers = cJSON_AddArrayToObject(root, "buffers");
    bool added = materials && buffers;
    for (uint32_t i = 0; added && i < file->lists[GLTF_MATERIALS].count; i++) {
        cJSON *material = cJSON_CreateObject();
        snprintf(name, sizeof name, "%u", i);
        added = cJSON_AddItemToArray(materials, material) &&
                cJSON_AddStringToObject(material, "name", name);
    }
    for (uint32_t i = 0; added && i < file->lists[GLTF_BUFFERS].count; i++) {
        cJSON *buffer = cJSON_CreateObject();
        snprintf(name, sizeof name, "%u.bin", i);
        added = cJSON_AddItemToArray(buffers, buffer) &&
                cJSON_AddStringToObject(buffer, "uri", name) &&
                cJSON_AddNumberToObject(buffer, "byteLength", (double)file->buffers[i].size);
    }
    return added;
}

static char *write_geometry(const struct gltf_file *file)
{
    static const char *const members[] = {"asset",       "scene",   "scenes", "nodes",    "meshes",
                                          "bufferViews", "cameras", "skins",  "accessors"};
    cJSON *root = cJSON_CreateObject();
    bool made = root && add_numbered(root, file);
    for (size_t i = 0; made && i < sizeof members / sizeof *members; i++) {
        cJSON *member = cJSON_GetObjectItemCaseSensitive(file->json, members[i]);
        made = !member || cJSON_AddItemReferenceToObject(root, members[i], member);
    }
    char *text = made ? cJSON_PrintUnformatted(root) : NULL;
    cJSON_Delete(root);
    return text;
}

const struct aiScene *gltf_import_geometry(const struct gltf_file *file, unsigned flags)
{
    struct memory_files files = {file, write_geometry(file)};
    struct aiFileIO io = {open_file, close_file, (char *)&files};
    const struct aiScene *scene = files.text ? aiImportFileEx(SCENE_NAME, flags, &io) : NULL;
    cJSON_free(files.text);
    return scene;
}

uint32_t gltf_material_number(const struct gltf_file *file, const struct aiMaterial *material)
{
    const uint32_t count = file->lists[GLTF_MATERIALS].count;
    struct aiString name;
    unsigned number;
    char rest;
    if (aiGetMaterialString(material, AI_MATKEY_NAME, &name) != aiReturn_SUCCESS ||
        sscanf(name.data, "%u%c", &number, &rest) != 1)
        return count;
    return number < count ? number : count;
}
