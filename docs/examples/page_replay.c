/* The lines that docs/replay.md shows, compiled as they are there. */
#include <sluice/replay.h>

SluiceResult page_record(SluiceStreamedTextureManager *manager);
SluiceResult page_record(SluiceStreamedTextureManager *manager)
{
    SluiceRecorder *recorder;
    sluiceBeginRecordingToFile(manager, "run.trace", NULL, &recorder);
    /* ... any calls ... */
    SluiceResult result = sluiceEndRecording(recorder);
    return result;
}

SluiceResult page_play(const void *trace, size_t traceSize, const SluiceRecordWriter *checkpoint);
SluiceResult page_play(const void *trace, size_t traceSize, const SluiceRecordWriter *checkpoint)
{
    const SluiceTracePlayerCreateInfo info = {
        .structSize = sizeof info, .pData = trace, .size = traceSize, .tileEventCapacity = 4096};
    SluiceTracePlayer *player;
    SluiceResult result = sluiceCreateTracePlayer(&info, &player);
    SluiceTraceCall call = {.structSize = sizeof call};
    while (result == SLUICE_SUCCESS) {
        result = sluiceGetNextTraceCall(player, &call);
        if (result != SLUICE_SUCCESS || call.kind == SLUICE_TRACE_CALL_NONE)
            break;
        if (call.kind == SLUICE_TRACE_CALL_REPORT_FAILED)
            result = sluiceWriteTraceCheckpoint(player, checkpoint); /* to come back to it */
        if (result == SLUICE_SUCCESS)
            result = sluicePlayTraceCall(player);
    }
    sluiceDestroyTracePlayer(player);
    return result;
}
