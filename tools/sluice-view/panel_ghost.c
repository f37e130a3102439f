#include "panels.h"

#include "overlay.h"

#include <stdio.h>

#define NEAR_PART 0.02f /* this and the next two: parts of the scene's diagonal */
#define FAR_PART 0.25f
#define BOOKMARK_PART 0.015f
#define MOST_SEGMENTS 256u

void panel_ghost(const struct view_app *app)
{
    if (!app->is_frozen || !app->stage || app->height <= 0)
        return;
    overlay_frustum(app, &app->frozen, NEAR_PART, UI_ORANGE);
    overlay_frustum(app, &app->frozen, FAR_PART, UI_ORANGE);
}

static void draw_path(const struct view_app *app, const struct camera_path *path)
{
    const float length = camera_path_length(path);
    struct view_camera before, now;
    if (length <= 0 || !camera_path_get(path, 0, &before))
        return;
    for (uint32_t i = 1; i <= MOST_SEGMENTS; i++) {
        camera_path_get(path, length * (float)i / MOST_SEGMENTS, &now);
        overlay_edge(app, before.position, now.position, UI_BLUE);
        before = now;
    }
}

void panel_path(const struct view_app *app)
{
    char text[4];
    if (!app->settings.show_path || !app->stage || app->height <= 0)
        return;
    draw_path(app, app_path(app, app->path.count > 0 ? FOLLOW_PATH : FOLLOW_CAMERA));
    for (int i = 0; i < APP_BOOKMARKS; i++) {
        if (!app->bookmark_set[i])
            continue;
        snprintf(text, sizeof text, "%d", i + 1);
        overlay_frustum(app, &app->bookmarks[i], BOOKMARK_PART, UI_ORANGE);
        overlay_label(app, app->bookmarks[i].position, text);
    }
}
