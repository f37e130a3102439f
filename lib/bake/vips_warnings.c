#include "bake/vips_warnings.h"

#include "base/log.h"
#include "image/input_file.h"
#include "platform/thread.h"

#include <stdio.h>
#include <string.h>

#include <vips/vips.h>

static struct slc_mutex mutex = SLC_MUTEX_INITIALIZER; ///< guards the next two variables
static uint32_t listener_count;
static guint handler;

static GPrivate current = G_PRIVATE_INIT(NULL); ///< struct slc_vips_warnings of this thread

static void log_line(struct slc_vips_warnings *warnings, const char *line)
{
    char printable[512];
    slc_printable(line, printable, sizeof printable);
    enum slc_say say = slc_said_note(&warnings->said, slc_said_key(printable));
    if (say != SLC_SAY_NOTHING)
        slc_log(warnings->log, SLUICE_LOG_WARNING, "%s: libvips: %s%s", warnings->path, printable,
                say == SLC_SAY_IT_LAST ? "; further warnings of this picture are not logged" : "");
}

/*
 * Logs a warning of libvips. A message of several lines is the error buffer of the whole process:
 * with two pictures at a time, a line may belong to the other picture.
 */
static void on_warning(const gchar *domain, GLogLevelFlags level, const gchar *message,
                       gpointer user)
{
    struct slc_vips_warnings *warnings = g_private_get(&current);
    (void)user;
    if (!warnings) { /* on a thread of the application or of libvips */
        g_log_default_handler(domain, level, message, NULL);
        return;
    }
    while (*message) {
        char line[512];
        size_t size = strcspn(message, "\n");
        snprintf(line, sizeof line, "%.*s", (int)(size < sizeof line ? size : sizeof line - 1),
                 message);
        if (*line)
            log_line(warnings, line);
        warnings->was_buffered |= message[size] == '\n';
        message += size + (message[size] == '\n');
    }
}

void slc_vips_warnings_listen(void)
{
    slc_mutex_lock(&mutex);
    if (listener_count++ == 0)
        handler =
            g_log_set_handler("VIPS", G_LOG_LEVEL_WARNING | G_LOG_FLAG_FATAL | G_LOG_FLAG_RECURSION,
                              on_warning, NULL);
    slc_mutex_unlock(&mutex);
}

void slc_vips_warnings_end(void)
{
    slc_mutex_lock(&mutex);
    if (--listener_count == 0)
        g_log_remove_handler("VIPS", handler);
    slc_mutex_unlock(&mutex);
}

void slc_vips_warnings_enter(struct slc_vips_warnings *warnings)
{
    warnings->outer = g_private_get(&current);
    g_private_set(&current, warnings);
}

/* Removes logged text from the buffer; otherwise the next failing picture would report it. */
void slc_vips_warnings_leave(struct slc_vips_warnings *warnings)
{
    g_private_set(&current, warnings->outer);
    if (warnings->was_buffered)
        vips_error_clear();
    warnings->was_buffered = false;
}
