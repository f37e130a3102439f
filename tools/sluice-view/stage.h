/** A stage: the scene that is shown and its streamer, as the window and the panels use them. */
#ifndef SLUICE_VIEW_STAGE_H
#define SLUICE_VIEW_STAGE_H

#include "camera.h"
#include "frames.h"
#include "settings.h"

#include <sluice/vulkan_explain.h>

#define STAGE_NO_TEXTURE UINT32_MAX
#define STAGE_TICKS_PER_SECOND 1000000u ///< unit of time stamps: 1 us
#define STAGE_HEAP_TILES 64u            ///< per heap at most: 4 MiB
#define STAGE_LEAST_HEAP_TILES 8u

struct shader_code;
struct stage;
struct scene_data;
struct played;
struct traced;

struct stage_texture {
    SluiceTextureId id;
    const char *name, *path; ///< "" if it has none
    uint32_t width, height, level_count;
    uint32_t primary; ///< index of the texture that it follows; STAGE_NO_TEXTURE: none
    const char *format;
    uint64_t size; ///< bytes of all its tiles
};

/** A surface under a pixel, as stage_pick finds it. */
struct stage_pick {
    bool hit;
    uint32_t texture; ///< STAGE_NO_TEXTURE: none
    float u, v;       ///< 0 to 1, within the texture
    struct vec3 position;
    uint32_t material, first_index; ///< material and first index of the triangle
};

/** A pixel of a picture. */
struct stage_pixel {
    struct view_camera camera;
    uint32_t width, height; ///< pixels of the picture
    float x, y;             ///< 0 to 1 from the left and the top
};

/** A predicted camera. Feedback is also written from its position. */
struct stage_ahead {
    bool draw;
    struct view_camera camera;
    uint32_t width, height; ///< pixels, fewer than in the picture
    float lod_bias;         ///< levels, added to the LOD bias of the settings
};

struct stage_draw {
    const struct view_settings *settings;
    struct view_camera camera;
    struct stage_ahead ahead;
    uint32_t width, height;     ///< pixels of the picture
    uint64_t number;            ///< number of the frame
    uint64_t time_stamp;        ///< microseconds
    VkBuffer copy;              ///< receives a copy of the picture; VK_NULL_HANDLE: none
    const struct target *large; ///< target of a second, larger picture; NULL: none
    VkBuffer large_copy;        ///< receives a copy of the larger picture
};

/** Options that stay fixed while a scene is open. */
struct stage_request {
    const struct gpu *gpu;
    uint32_t threads;
    bool waits; ///< each frame waits for its loads, so that all runs draw the same pictures
    const struct shader_code *code; ///< SCENE_SHADER_COUNT modules; NULL: shaders of the build
};

/** Creates a stage. Takes the scene, which is empty afterwards. NULL, with a line on stderr, on
 *  failure. */
struct stage *stage_create(const struct stage_request *request,
                           const struct view_settings *settings, struct scene_data *scene);
void stage_destroy(struct stage *stage);
/** Fills `scene` for a second stage of the same traced scene, without reading its files again.
 *  False without memory, and for scenes that are not traced: open their files instead. */
bool stage_share_scene(const struct stage *stage, struct scene_data *scene);
/** Records the picture of a frame. Its views and signals go into `end`. */
bool stage_record(struct stage *stage, const struct stage_draw *draw, VkCommandBuffer commands,
                  struct frames_end *end);
/** Applies settings that may change while the scene is open. */
void stage_apply(struct stage *stage, const struct view_settings *settings);
/** Prepares pipelines of other shaders. False on failure: nothing has changed. */
bool stage_prepare_shaders(struct stage *stage, const struct shader_code *code);
/** Draws with the prepared shaders from now on. No frame may be in flight. */
void stage_take_shaders(struct stage *stage);
/** Destroys the prepared shaders. */
void stage_drop_shaders(struct stage *stage);
/** Evicts everything that can be evicted. */
void stage_restart(struct stage *stage);
/** Waits until all reads are done. Makes pictures equal in every run. */
bool stage_settle(struct stage *stage);

/** Number of pictures whose finer levels were still being baked in the last frame. */
uint32_t stage_baking_count(const struct stage *stage);
/** Part of all tiles that is resident, 0 to 1. */
double stage_resident_part(const struct stage *stage);
const char *stage_name(const struct stage *stage);
/** Returns the streamer; NULL for traced scenes and for recordings. */
SluiceVulkanStreamer *stage_streamer(const struct stage *stage);
/** Returns the manager that decides about the textures; NULL for traced scenes. */
SluiceStreamedTextureManager *stage_manager(const struct stage *stage);
/** Returns the traced pbrt scene; NULL for other scenes. */
struct traced *stage_traced(const struct stage *stage);
/** Returns the recording that is shown instead of a scene; NULL for scenes. */
struct played *stage_played(const struct stage *stage);
SluiceVulkanContext *stage_context(const struct stage *stage);
/** Returns the settings that the scene was opened with. */
const struct view_settings *stage_opened(const struct stage *stage);
/** Tiles per heap: an eighth of the budget that the scene was opened with. */
uint32_t stage_heap_tiles(const struct stage *stage);
/** Number of messages about the scene: images that are missing, extensions not supported. */
uint32_t stage_message_count(const struct stage *stage);
const char *stage_message(const struct stage *stage, uint32_t index);
uint32_t stage_texture_count(const struct stage *stage);
const struct stage_texture *stage_texture(const struct stage *stage, uint32_t index);
/** Finds the surface that a camera sees at x, y, 0 to 1 from the left and the top. */
struct stage_pick stage_pick(const struct stage *stage, const struct view_camera *camera,
                             float aspect, float x, float y);
/** Writes the offset in texels of level 0, along u and v, from a pixel to the pixel on its right,
 *  then to the pixel below. `pick` is the surface at this pixel. False if it has no texture. */
bool stage_pick_pixel(const struct stage *stage, const struct stage_pick *pick,
                      const struct stage_pixel *pixel, float texels[4]);
/** Finds a point of a surface that shows a texture at u, v (0 to 1), and the normal of its
 *  triangle. False if no surface shows this point of the texture. */
bool stage_find_texel(const struct stage *stage, uint32_t texture, float u, float v,
                      struct vec3 *position, struct vec3 *normal);
uint32_t stage_triangle_count(const struct stage *stage);
/** Time stamp of the last frame that was recorded. */
uint64_t stage_now(const struct stage *stage);
/** Lends a source to other readers. Traced scenes have a source once rays have opened the picture.
 *  NULL: none. Call stage_return_source before the stage is destroyed. Any thread. */
SluiceImageSource *stage_borrow_source(const struct stage *stage, uint32_t index);
void stage_return_source(const struct stage *stage, uint32_t index, SluiceImageSource *source);
/** Returns the source that the streamer reads. */
const SluiceImageSource *stage_source(const struct stage *stage, uint32_t index);
/** Returns the first camera of the scene. */
struct view_camera stage_camera(const struct stage *stage);
/** Writes the corners of the box around the scene. */
void stage_bounds(const struct stage *stage, struct vec3 bounds[2]);
/** Number of cameras in the file. */
uint32_t stage_camera_count(const struct stage *stage);
const struct file_camera *stage_file_camera(const struct stage *stage, uint32_t index);
/** Returns the path that the camera walks until the user moves it. */
const struct camera_path *stage_tour(const struct stage *stage);

#endif /* SLUICE_VIEW_STAGE_H */
