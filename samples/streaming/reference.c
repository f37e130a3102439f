#define _POSIX_C_SOURCE 200809L
#include "reference.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <zlib.h>

#include "../../tools/common/files.h"
#include "../../tools/common/progress.h"
#include "../../tools/common/text.h"
#include "gallery.h"
#include "reference_key.h"
#include "supersample.h"

/** State while the frames are drawn. */
struct drawing {
    const struct gallery *gallery;
    struct settings settings; ///< settings of the truth
    struct target target;
    struct view view;
    uint32_t first; ///< frames spent on filling the view
    struct supersample tables;
    uint8_t *small; ///< owned; the averaged frame
    struct frame_file frames;
    struct reference_content content;
};

static bool open_view(struct drawing *drawing)
{
    const struct gallery *gallery = drawing->gallery;
    const struct settings *settings = &drawing->settings;
    const struct gpu *gpu = &gallery->gpu;
    uint32_t factor = settings->reference_supersample;
    uint32_t width = factor * settings->size[0], height = factor * settings->size[1];
    const VkPhysicalDeviceLimits *limits = &gpu->properties.limits;
    if (width > limits->maxFramebufferWidth || height > limits->maxFramebufferHeight ||
        width > limits->maxImageDimension2D || height > limits->maxImageDimension2D) {
        fprintf(stderr, "the device draws no frames of %ux%u\n", width, height);
        return false;
    }
    struct view_request request = {.gpu = gpu,
                                   .room = &gallery->room,
                                   .target = &drawing->target,
                                   .settings = settings,
                                   .pictures = &gallery->pictures,
                                   .floor = gallery->floor,
                                   .wall = gallery->wall,
                                   .mode = gpu->modes[1],
                                   .everything = true};
    return target_create(gpu, width, height, settings->samples, &drawing->target) &&
           view_create(&request, NULL, &drawing->view) &&
           gallery_fill(&drawing->view, &gallery->room);
}

static void close_view(struct drawing *drawing)
{
    view_destroy(&drawing->view);
    target_destroy(&drawing->gallery->gpu, &drawing->target);
}

static bool keep_frame(struct drawing *drawing, uint32_t frame)
{
    const struct settings *settings = &drawing->settings;
    uint32_t slot = (drawing->first + frame) % VIEW_FRAMES_IN_FLIGHT;
    if (!view_wait(&drawing->view, slot))
        return false;
    const uint8_t *pixels = view_pixels(&drawing->view, slot);
    if (settings->reference_supersample > 1) {
        supersample_average(&drawing->tables, pixels, settings->reference_supersample,
                            settings->size[0], settings->size[1], drawing->small);
        pixels = drawing->small;
    }
    drawing->content.checksum =
        (uint32_t)crc32_z(drawing->content.checksum, pixels, drawing->frames.frame_size);
    return frame_file_write(&drawing->frames, frame, pixels);
}

static bool draw_frames(struct drawing *drawing)
{
    const struct settings *settings = &drawing->settings;
    struct progress progress;
    struct view_frame drawn = {0};
    progress_begin(&progress, "drawing the frames to compare with", "frames", settings->frames);
    drawing->first = drawing->view.frame_index;
    for (uint32_t frame = 0; frame < settings->frames + VIEW_FRAMES_IN_FLIGHT; frame++) {
        if (frame >= VIEW_FRAMES_IN_FLIGHT && !keep_frame(drawing, frame - VIEW_FRAMES_IN_FLIGHT))
            return false;
        struct camera camera = gallery_camera(settings, &drawing->gallery->room, frame);
        if (frame < settings->frames && !view_draw(&drawing->view, &camera, 0, &drawn))
            return false;
        progress_update(&progress, frame);
    }
    drawing->content.device_memory = drawn.statistics.tileMemorySize;
    progress_end(&progress);
    return true;
}

/** Draws into a new file for `path`. The caller renames it. */
static bool draw(const struct gallery *gallery, const char *path, struct drawing *drawing)
{
    *drawing = (struct drawing){.gallery = gallery, .settings = gallery->settings};
    struct settings *settings = &drawing->settings;
    settings->anisotropy = settings->reference_anisotropy;
    settings->lod_bias = settings->reference_lod_bias;
    settings->samples = settings->reference_samples;
    supersample_init(&drawing->tables);
    drawing->content.checksum = (uint32_t)crc32_z(0, NULL, 0);
    size_t size = 4 * (size_t)settings->size[0] * settings->size[1];
    drawing->small = malloc(size);
    if (!drawing->small)
        fprintf(stderr, "out of memory\n");
    bool drawn = drawing->small && frame_file_create(path, size, &drawing->frames) &&
                 open_view(drawing) && draw_frames(drawing);
    close_view(drawing);
    if (!drawn)
        frame_file_close(&drawing->frames);
    free(drawing->small);
    return drawn;
}

static bool is_undamaged(const struct frame_file *frames, uint32_t count, uint32_t checksum)
{
    uint8_t *pixels = malloc(frames->frame_size);
    uint32_t sum = (uint32_t)crc32_z(0, NULL, 0);
    bool read = pixels != NULL;
    for (uint32_t i = 0; i < count && read; i++) {
        read = frame_file_read(frames, i, pixels);
        sum = read ? (uint32_t)crc32_z(sum, pixels, frames->frame_size) : 0;
    }
    free(pixels);
    return read && sum == checksum;
}

struct paths {
    char text[4096], frames[4096];
};

static enum reference_match open_kept(const struct settings *settings, const struct paths *paths,
                                      const char *key, struct reference *reference)
{
    struct reference_content content;
    size_t size = 4 * (size_t)settings->size[0] * settings->size[1];
    enum reference_match match = reference_key_compare(paths->text, key, &content);
    if (match == REFERENCE_MISSING && access(paths->frames, F_OK) == 0)
        match = REFERENCE_FOREIGN;
    if (match == REFERENCE_FOREIGN)
        text_say("--reference: what is in %s was not written by this program; remove "
                 "reference.txt and reference.frames there, or name another folder",
                 settings->reference);
    if (match != REFERENCE_MATCHES)
        return match;
    if (frame_file_open(paths->frames, size, settings->frames, &reference->frames) &&
        is_undamaged(&reference->frames, settings->frames, content.checksum)) {
        reference->device_memory = content.device_memory;
        return REFERENCE_MATCHES;
    }
    text_say("%s: damaged", paths->frames);
    reference_close(reference);
    return REFERENCE_DIFFERS;
}

/** Writes the text first: its checksum marks older frames beside it as damaged. */
static bool draw_anew(const struct gallery *gallery, const struct paths *paths, const char *key)
{
    struct drawing *drawing = malloc(sizeof *drawing);
    if (!drawing)
        fprintf(stderr, "out of memory\n");
    bool drawn = drawing && draw(gallery, paths->frames, drawing);
    if (drawn) {
        drawn = reference_key_write(paths->text, key, &drawing->content);
        drawn = drawn && frame_file_keep(&drawing->frames);
        frame_file_close(&drawing->frames);
    }
    free(drawing);
    return drawn;
}

bool reference_open(const struct gallery *gallery, struct reference *reference)
{
    const struct settings *settings = &gallery->settings;
    struct paths paths;
    *reference = (struct reference){0};
    snprintf(paths.text, sizeof paths.text, "%s/reference.txt", settings->reference);
    int length =
        snprintf(paths.frames, sizeof paths.frames, "%s/reference.frames", settings->reference);
    if ((size_t)length >= sizeof paths.frames) {
        fprintf(stderr, "--reference: the folder's name is too long\n");
        return false;
    }
    char *key = reference_key_create(settings, &gallery->gpu, &gallery->pictures);
    if (!key)
        fprintf(stderr, "out of memory\n");
    enum reference_match match = REFERENCE_FOREIGN;
    if (key)
        match = open_kept(settings, &paths, key, reference);
    if ((match == REFERENCE_MISSING || match == REFERENCE_DIFFERS) &&
        files_make_folders(settings->reference) && draw_anew(gallery, &paths, key))
        match = open_kept(settings, &paths, key, reference);
    free(key);
    return match == REFERENCE_MATCHES;
}

void reference_close(struct reference *reference)
{
    frame_file_close(&reference->frames);
    *reference = (struct reference){0};
}
