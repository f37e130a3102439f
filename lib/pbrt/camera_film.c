#include "pbrt/parser.h"

#include "pbrt/growth.h"

#include <string.h>

#define MAX_PIXELS 65536

bool slc_pbrt_camera(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    SluicePbrtScene *scene = parser->scene;
    uint32_t type, camera;
    bool found;
    if (!slc_pbrt_read_name(parser, "type of the camera", &type, &found) ||
        !slc_pbrt_read_parameters(parser))
        return false;
    struct slc_pbrt_parameters parameters = parser->parameters;
    parser->parameters = parser->camera;
    parser->camera = parameters;
    parser->camera_place = *place;
    if (!slc_pbrt_inverse(&parser->state.transform, &parser->camera_to_world)) {
        parser->camera_to_world = slc_pbrt_identity();
        slc_pbrt_say(scene, SLUICE_LOG_WARNING, place,
                     "the transform of the camera is singular: it is ignored");
    }
    const char *kind = found ? slc_pbrt_name(&scene->names, type) : "";
    scene->info.cameraKind = SLUICE_PBRT_CAMERA_PERSPECTIVE;
    if (strcmp(kind, "orthographic") == 0)
        scene->info.cameraKind = SLUICE_PBRT_CAMERA_ORTHOGRAPHIC;
    else if (strcmp(kind, "perspective") != 0)
        slc_pbrt_say(scene, SLUICE_LOG_WARNING, place,
                     "\"%s\" is no camera that is known: perspective is taken", kind);
    if (!slc_pbrt_grow(&scene->allocator, &parser->coordinates, &parser->coordinate_capacity,
                       parser->coordinate_count + 1, sizeof *parser->coordinates))
        return slc_pbrt_out_of_memory(parser);
    parser->coordinates[parser->coordinate_count] = parser->camera_to_world;
    return slc_pbrt_intern(parser, "camera", &camera) &&
           slc_pbrt_define(parser, camera, SLC_PBRT_COORDINATES,
                           (uint32_t)parser->coordinate_count++);
}

static uint32_t read_resolution(struct slc_pbrt_parser *parser, const char *name,
                                uint32_t otherwise, const struct slc_pbrt_place *place)
{
    int32_t pixels = slc_pbrt_get_integer(&parser->parameters, name, (int32_t)otherwise);
    if (pixels >= 1 && pixels <= MAX_PIXELS)
        return (uint32_t)pixels;
    slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, place, "%s %d is not in 1 to %d: %u is taken",
                 name, (int)pixels, MAX_PIXELS, otherwise);
    return otherwise;
}

/* Four numbers, if they are there and in order. */
static bool read_window(struct slc_pbrt_parser *parser,
                        const struct slc_pbrt_parameters *parameters, const char *name,
                        const struct slc_pbrt_place *place, float least, float most,
                        float window[4])
{
    const struct slc_pbrt_parameter *p =
        slc_pbrt_find(parameters, SLC_PBRT_TYPES(SLC_PBRT_FLOAT), name);
    if (!p)
        return false;
    const union slc_pbrt_cell *cells = slc_pbrt_cells(parameters, p);
    if (p->count < 4 || !(cells[0].number < cells[1].number) ||
        !(cells[2].number < cells[3].number) || cells[0].number < least || cells[1].number > most ||
        cells[2].number < least || cells[3].number > most) {
        slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, place,
                     "%s is not x0 < x1, y0 < y1 within its range: it is ignored", name);
        return false;
    }
    for (int i = 0; i < 4; i++)
        window[i] = cells[i].number;
    return true;
}

bool slc_pbrt_film(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    SluicePbrtSceneInfo *info = &parser->scene->info;
    uint32_t type;
    bool found;
    if (!slc_pbrt_read_name(parser, "type of the film", &type, &found) ||
        !slc_pbrt_read_parameters(parser))
        return false;
    info->filmWidth = read_resolution(parser, "xresolution", 1280, place);
    info->filmHeight = read_resolution(parser, "yresolution", 720, place);
    read_window(parser, &parser->parameters, "cropwindow", place, 0, 1, info->cropWindow);
    return true;
}

static float positive(struct slc_pbrt_parser *parser, const char *name, float otherwise)
{
    float value = slc_pbrt_get_float(&parser->camera, name, otherwise);
    return value >= 0 ? value : otherwise;
}

static void read_field_of_view(struct slc_pbrt_parser *parser)
{
    SluicePbrtSceneInfo *info = &parser->scene->info;
    float angle = slc_pbrt_get_float(&parser->camera, "fov", 90);
    float half = slc_pbrt_get_float(&parser->camera, "halffov", -1);
    if (half > 0)
        angle = 2 * half;
    info->fieldOfView = 90;
    if (angle > 0 && angle < 180)
        info->fieldOfView = angle;
    else
        slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, &parser->camera_place,
                     "fov %g is not between 0 and 180: 90 is taken", (double)angle);
}

void slc_pbrt_finish_camera(struct slc_pbrt_parser *parser)
{
    SluicePbrtSceneInfo *info = &parser->scene->info;
    float aspect = slc_pbrt_get_float(&parser->camera, "frameaspectratio",
                                      (float)info->filmWidth / (float)info->filmHeight);
    if (!(aspect > 0))
        aspect = (float)info->filmWidth / (float)info->filmHeight;
    float x = aspect > 1 ? aspect : 1, y = aspect > 1 ? 1 : 1 / aspect;
    float window[4] = {-x, x, -y, y};
    memcpy(info->screenWindow, window, sizeof window);
    read_window(parser, &parser->camera, "screenwindow", &parser->camera_place, -1e30f, 1e30f,
                info->screenWindow);
    read_field_of_view(parser);
    info->lensRadius = positive(parser, "lensradius", 0);
    info->focalDistance = positive(parser, "focaldistance", 1e6f);
    slc_pbrt_to_floats(&parser->camera_to_world, info->cameraToWorld);
}
