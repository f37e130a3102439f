/* Traces all rays of a pixel. Declare `Payload payload` and trace() before including this file:
 * trace() follows the path's ray and fills the payload. It is called in one place, so that
 * compilers inline it once. */
#ifndef PBRT_PIXEL_GLSL
#define PBRT_PIXEL_GLSL

layout(std430, set = 1, binding = PBRT_BINDING_DEBUG) buffer Debug
{
    PbrtDebug debug;
};

void trace(Path path);

void tellDebug(bool complete)
{
    debug.kind = payload.distance < 0.0 ? 1u : payload.triangle == PBRT_NONE ? 2u : 3u;
    debug.place = payload.place;
    debug.triangle = payload.triangle;
    debug.distance = payload.distance;
    debug.missing = complete ? 0u : 1u;
    for (int i = 0; i < 3; i++)
        debug.diffuse[i] = payload.diffuse[i];
}

/** Traces the pixel at index `place` of the list. */
void tracePixel(uint place)
{
    uint pixel = pixelAt(place);
    Path path = startPath(pixel);
    for (bool first = true; !path.done; first = false) {
        payload.isShadow = path.isShadow || isLast(path);
        payload.coneWidth = path.coneWidth;
        payload.coneSpread = path.coneSpread;
        payload.missing = false;
        payload.triangle = first ? pixel : PBRT_NONE;
        trace(path);
        path.complete = path.complete && !payload.missing;
        if (first && pixel == debug.pixel)
            tellDebug(path.complete);
        if (preview && first && (payload.distance < 0.0 || payload.triangle == PBRT_NONE))
            probes[pixel].texture = PBRT_NONE; /* no surface wrote it */
        if (path.isShadow)
            endShadow(path, payload.distance < 0.0);
        else
            meetSurface(path, payload);
        chooseRay(path);
    }
    if (path.skyWeight != vec3(0.0) && path.complete)
        path.light += path.skyWeight * skyLight(path.skyDirection, path.skySpread, path.complete);
    if (preview)
        probes[pixel].launch = path.complete ? 0u : launch.launchIndex;
    endPixel(pixel, path.light, path.complete);
}

#endif
