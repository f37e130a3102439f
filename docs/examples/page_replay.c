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
