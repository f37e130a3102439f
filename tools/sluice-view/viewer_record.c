#include "viewer.h"

#include "traced.h"

#include "../common/log.h"
#include "../common/text.h"

#include <sluice/replay.h>

#include <stdio.h>
#include <string.h>
#include <unistd.h>

static void name_recording(struct viewer *v)
{
    unsigned number = 0;
    do
        snprintf(v->recording, sizeof v->recording, "sluice-view-%02u.trace", ++number);
    while (access(v->recording, F_OK) == 0 && number < 1000);
}

static void say_failed(struct viewer *v, SluiceResult result)
{
    text_say("sluice-view: %s: cannot be recorded: %s", v->recording, sluiceGetResultName(result));
    app_say(&v->app, "Cannot record %s: Shift+I says why", v->recording);
    v->recording_failed = true;
}

void viewer_begin_recording(struct viewer *v, const char *path)
{
    SluiceStreamedTextureManager *manager = NULL;
    viewer_end_recording(v);
    if (!v->stage)
        return;
    if (stage_played(v->stage)) {
        text_say("sluice-view: a recording cannot be recorded; use sluice-replay --record");
        return;
    }
    if (path)
        snprintf(v->recording, sizeof v->recording, "%s", path);
    else
        name_recording(v);
    const SluiceFileRecordingInfo info = {
        .structSize = sizeof info, .pPath = v->recording, .log = {.pfnLog = log_say}};
    const struct traced *traced = stage_traced(v->stage);
    SluiceResult result = traced
                              ? sluiceBeginDemandRecording(traced->loader, &info, &v->recorder)
                              : sluiceGetVulkanStreamerManager(stage_streamer(v->stage), &manager);
    if (result == SLUICE_SUCCESS && !traced)
        result = sluiceBeginFileRecording(manager, &info, &v->recorder);
    if (result == SLUICE_SUCCESS)
        app_say(&v->app, "Recording %s for sluice-replay; Ctrl+R ends it", v->recording);
    else
        say_failed(v, result);
    v->app.tracing = v->recorder != NULL;
}

void viewer_end_recording(struct viewer *v)
{
    if (!v->recorder)
        return;
    const SluiceResult result = sluiceEndRecording(v->recorder);
    v->recorder = NULL;
    v->app.tracing = false;
    if (result == SLUICE_SUCCESS)
        app_say(&v->app, "Recorded %s", v->recording);
    else
        say_failed(v, result);
}
