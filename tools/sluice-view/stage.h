/** The scene that is shown, with its streamer: what the window, the panels and the twin see of it.
 */
#ifndef SLUICE_VIEW_STAGE_H
#define SLUICE_VIEW_STAGE_H

#include "camera.h"
#include "frames.h"
#include "settings.h"

#include <sluice/vulkan_explain.h>

#define STAGE_NO_TEXTURE UINT32_MAX
#define STAGE_TICKS_PER_SECOND 1000000u ///< of time stamps
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

/** What is under a pixel. */
struct stage_pick {
    bool hit;
    uint32_t texture; ///< STAGE_NO_TEXTURE: none
    float u, v;       ///< 0 to 1, within the texture
    struct vec3 position;
    uint32_t material, first_index; ///< of the triangle
};

/** A pixel of a picture. */
struct stage_pixel {
    struct view_camera camera;
    uint32_t width, height; ///< of the picture
    float x, y;             ///< 0 to 1 from the left and the top
};

/** Where the camera will be: feedback is written from there, too. */
struct stage_ahead {
    bool draw;
    struct view_camera camera;
    uint32_t width, height; ///< pixels, fewer than those of the picture
    float lod_bias;         ///< added to that of the settings
};

struct stage_draw {
    const struct view_settings *settings;
    struct view_camera camera;
    struct stage_ahead ahead;
    uint32_t width, height;     ///< of the picture
    uint64_t number;            ///< of the frame
    uint64_t time_stamp;        ///< microseconds
    VkBuffer copy;              ///< gets the picture, too; VK_NULL_HANDLE: none
    const struct target *large; ///< the picture is drawn into it once more; NULL: no
    VkBuffer large_copy;        ///< gets that picture
};

/** Options that are fixed while a scene is open. */
struct stage_request {
    const struct gpu *gpu;
    uint32_t threads;
    bool waits; ///< frames wait for all that they asked for, so that each run is the same
    const struct shader_code *code; ///< SCENE_SHADER_COUNT modules; NULL: those of the build
};

/** Takes the scene, which is empty afterwards. Says on stderr what failed. */
struct stage *stage_create(const struct stage_request *request,
                           const struct view_settings *settings, struct scene_data *scene);
void stage_destroy(struct stage *stage);
/** Fills a scene for a second stage from one that is traced, whose files are not read again. False
 *  without memory, and for others: open their files. */
bool stage_share_scene(const struct stage *stage, struct scene_data *scene);
/** Records the picture of a frame. Its views and signals go into `end`. */
bool stage_record(struct stage *stage, const struct stage_draw *draw, VkCommandBuffer commands,
                  struct frames_end *end);
/** Settings that change while the scene is open. */
void stage_apply(struct stage *stage, const struct view_settings *settings);
/** Prepares other shaders. False, and nothing has changed, if that failed. */
bool stage_prepare_shaders(struct stage *stage, const struct shader_code *code);
/** Draws with the shaders that are prepared. No frame may be in flight. */
void stage_take_shaders(struct stage *stage);
/** Destroys the shaders that are prepared. */
void stage_drop_shaders(struct stage *stage);
/** Evicts everything that can be evicted. */
void stage_restart(struct stage *stage);
/** Waits until all reads are done, for pictures that are the same in every run. */
bool stage_settle(struct stage *stage);

/** Pictures whose finer levels are still being made, as of the last frame. */
uint32_t stage_baking_count(const struct stage *stage);
/** Part of all tiles that is resident. */
double stage_resident_part(const struct stage *stage);
const char *stage_name(const struct stage *stage);
/** NULL for scenes that are traced, and for recordings. */
SluiceVulkanStreamer *stage_streamer(const struct stage *stage);
/** The manager that decides about the textures; NULL for scenes that are traced. */
SluiceStreamedTextureManager *stage_manager(const struct stage *stage);
/** The scene of pbrt, whose rays ask a demand loader; NULL for others. */
struct traced *stage_traced(const struct stage *stage);
/** The recording that is shown instead of a scene; NULL for scenes. */
struct played *stage_played(const struct stage *stage);
SluiceVulkanContext *stage_context(const struct stage *stage);
/** Settings that the scene was opened with. */
const struct view_settings *stage_opened(const struct stage *stage);
/** Tiles per heap: an eighth of the budget that the scene was opened with. */
uint32_t stage_heap_tiles(const struct stage *stage);
/** What the scene lacks: images that are missing, extensions that are not supported. */
uint32_t stage_message_count(const struct stage *stage);
const char *stage_message(const struct stage *stage, uint32_t index);
uint32_t stage_texture_count(const struct stage *stage);
const struct stage_texture *stage_texture(const struct stage *stage, uint32_t index);
/** What a camera sees at x, y, 0 to 1 from the left and the top. */
struct stage_pick stage_pick(const struct stage *stage, const struct view_camera *camera,
                             float aspect, float x, float y);
/** Writes how many texels of level 0 lie between a pixel and the one to its right, and the one
 * below: along u and v each. `pick` is of this pixel. False if it has no texture. */
bool stage_pick_pixel(const struct stage *stage, const struct stage_pick *pick,
                      const struct stage_pixel *pixel, float texels[4]);
/** Finds a point of a surface that has a texel of a texture, u and v from 0 to 1, and the normal of
 *  its triangle. False if no surface has it. */
bool stage_find_texel(const struct stage *stage, uint32_t texture, float u, float v,
                      struct vec3 *position, struct vec3 *normal);
uint32_t stage_triangle_count(const struct stage *stage);
/** Time stamp of the last frame that was recorded. */
uint64_t stage_now(const struct stage *stage);
/** A source for other readers, from any thread: of a traced scene, if rays have opened its picture.
 *  NULL: none. Return it before the stage is destroyed. */
SluiceImageSource *stage_borrow_source(const struct stage *stage, uint32_t index);
void stage_return_source(const struct stage *stage, uint32_t index, SluiceImageSource *source);
/** The source that the streamer reads. */
const SluiceImageSource *stage_source(const struct stage *stage, uint32_t index);
/** A place to begin, and the box around everything. */
struct view_camera stage_camera(const struct stage *stage);
void stage_bounds(const struct stage *stage, struct vec3 bounds[2]);
/** Cameras of the file. */
uint32_t stage_camera_count(const struct stage *stage);
const struct file_camera *stage_file_camera(const struct stage *stage, uint32_t index);
/** The path that the camera walks before anybody touches it. */
const struct camera_path *stage_tour(const struct stage *stage);

#endif /* SLUICE_VIEW_STAGE_H */
