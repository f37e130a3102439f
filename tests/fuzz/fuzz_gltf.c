/*
 * Any bytes as a .gltf or .glb file of the viewer: refused with a message, or all of its materials,
 * textures, images and cameras with their paths can be read. With clang:
 *
 *     CC=clang meson setup BUILD -Db_sanitize=address,undefined -Db_lundef=false \
 *         -Dc_args=-fsanitize=fuzzer-no-link
 *     ninja -C BUILD tests/view/fuzz_gltf_libfuzzer
 *     BUILD/tests/view/fuzz_gltf_libfuzzer -max_len=4000 tests/fuzz/corpus/gltf
 *
 * In the ordinary test run standalone.c plays the corpus.
 */
#include "gltf_cameras.h"
#include "gltf_materials.h"

#include <math.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static uint64_t touched;

static void read_bytes(struct gltf_bytes bytes)
{
    for (uint64_t i = 0; i < bytes.size; i++)
        touched += bytes.bytes[i];
}

static void note(void *user, const char *where, const char *problem)
{
    (void)user;
    touched += (uint64_t)where[0] + (uint64_t)problem[0];
}

/* Cameras are finite, and times of paths do not fall. */
static void read_cameras(struct gltf_file *file)
{
    struct file_cameras cameras;
    if (!gltf_read_cameras(file, note, NULL, &cameras))
        abort();
    for (uint32_t i = 0; i < cameras.count; i++) {
        const struct camera_path *path = &cameras.items[i].path;
        float last = 0;
        for (size_t k = 0; k < path->count; k++) {
            const float *numbers = &path->points[k].camera.position.x;
            for (size_t n = 0; n < sizeof path->points[k].camera / sizeof *numbers; n++)
                if (!isfinite(numbers[n]))
                    abort();
            if (!(path->points[k].seconds >= last))
                abort();
            last = path->points[k].seconds;
        }
    }
    file_cameras_finish(&cameras);
}

static void read_all(struct gltf_file *file)
{
    read_cameras(file);
    struct scene_material material;
    for (uint32_t i = 0; i < file->lists[GLTF_MATERIALS].count; i++)
        if (gltf_read_material(file, i, &material))
            for (int k = 0; k < SLOT_COUNT; k++)
                if (material.slots[k].image != SCENE_NO_IMAGE &&
                    material.slots[k].image >= file->lists[GLTF_TEXTURES].count)
                    abort();
    for (uint32_t i = 0; i < file->lists[GLTF_TEXTURES].count; i++) {
        const struct gltf_texture texture = gltf_read_texture(file, i);
        const uint32_t images = file->lists[GLTF_IMAGES].count;
        if ((!texture.problem && texture.image >= images) ||
            (texture.fallback != GLTF_NONE && texture.fallback >= images))
            abort();
    }
    for (uint32_t i = 0; i < file->lists[GLTF_IMAGES].count; i++) {
        const struct gltf_image image = gltf_read_image(file, i);
        read_bytes(image.bytes);
        free(image.bytes.owned);
    }
    for (uint32_t i = 0; i < file->lists[GLTF_BUFFER_VIEWS].count; i++)
        read_bytes(gltf_view_bytes(file, i));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct gltf_file file;
    if (gltf_open_bytes("/nowhere/fuzz.gltf", data, size, &file))
        read_all(&file);
    else if (!file.error[0])
        abort();
    gltf_finish(&file);
    return 0;
}
