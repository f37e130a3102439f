/*
 * Light of a pixel, one ray after the other:
 *
 *     for (Path path = startPath(pixel); !path.done; chooseRay(path)) {
 *         trace the ray;
 *         if (path.isShadow) endShadow(path, whether nothing was hit);
 *         else meetSurface(path, what was hit);
 *     }
 *     add path.skyWeight * the sky at path.skyDirection
 *
 * The result depends only on the pixel, the sample and the rays' hits, not on earlier launches.
 */
#ifndef PBRT_PATH_GLSL
#define PBRT_PATH_GLSL

#define MEAN_SKY 10.0      /* skySpread of the whole sky */
#define NO_LAMP (launch.lightCount + 1u) /* index lightCount stands for all emitting shapes */
#define DIFFUSE_SPREAD 0.35 /* cone spread after a diffuse bounce, where detail does not matter */

struct Path {
    vec3 origin, direction; /* next ray to trace */
    float far, coneWidth, coneSpread;
    bool isShadow, done, complete;
    vec3 light;
    vec3 share; /* throughput: factor for light found later */
    vec3 skyWeight, skyDirection;
    float skySpread;
    uint depth, lamp; /* next lamp to test */
    float chance;     /* density of the ray's direction per solid angle; 0: no lamp was sampled */
    /* Surface hit last. */
    vec3 at, normal, face, albedo;
    float distance;
    vec3 pending;     /* light of the lamp, or weight of the sky, added if the shadow ray is free */
    bool pendingSky;
    vec3 nextShare, nextDirection; /* continuation of the path after the lamps */
    float nextSpread, nextChance;
    bool goesOn;
    uint random; /* state of the generator */
};

float random1(inout uint state)
{
    state = state * 747796405u + 2891336453u;
    return float(hashWord(state) >> 8) / 16777216.0;
}

vec3 random3(inout uint state)
{
    float x = random1(state), y = random1(state);
    return vec3(x, y, random1(state));
}

Path startPath(uint pixel)
{
    Path path;
    bool parallel = (launch.flags & PBRT_LAUNCH_ORTHOGRAPHIC) != 0u;
    startPixel(pixel, path.origin, path.direction);
    path.far = FAR;
    path.coneWidth = parallel ? launch.spread : 0.0;
    path.coneSpread = parallel ? 0.0 : launch.spread;
    path.isShadow = path.done = path.pendingSky = path.goesOn = false;
    path.complete = true;
    path.light = path.skyWeight = path.skyDirection = path.pending = vec3(0.0);
    path.share = vec3(1.0);
    path.skySpread = launch.spread;
    path.depth = 0u;
    path.lamp = NO_LAMP;
    path.chance = path.nextChance = 0.0;
    path.random = hashWord(pixel * 0x9e3779b1u ^ hashWord(launch.sampleIndex + 1u));
    return path;
}

/** Offsets the origin from the surface, to the side of `direction`. */
vec3 leave(Path path, vec3 direction)
{
    vec3 a = abs(path.at);
    float step = 4.0e-6 * (max(a.x, max(a.y, a.z)) + path.distance) + 1.0e-30;
    return path.at + (dot(path.face, direction) < 0.0 ? -step : step) * path.face;
}

vec3 cosineDirection(vec3 normal, inout uint random)
{
    float turn = 2.0 * PI * random1(random), square = random1(random), radius = sqrt(square);
    vec3 side = normalize(abs(normal.x) > 0.5 ? vec3(normal.y, -normal.x, 0.0)
                                              : vec3(0.0, normal.z, -normal.y));
    return normalize(radius * (cos(turn) * side + sin(turn) * cross(normal, side)) +
                     sqrt(max(1.0 - square, 0.0)) * normal);
}

/** Fresnel reflectance of glass for unpolarized light. */
float reflectance(float cosine, float eta)
{
    float square = 1.0 - eta * eta * (1.0 - cosine * cosine);
    if (square <= 0.0)
        return 1.0;
    float beyond = sqrt(square);
    float s = (eta * cosine - beyond) / (eta * cosine + beyond);
    float p = (cosine - eta * beyond) / (cosine + eta * beyond);
    return 0.5 * (s * s + p * p);
}

/** Chooses the next direction at a mirror or glass. */
void scatterSharply(inout Path path, Payload s, vec3 normal, bool inside)
{
    vec3 direction = reflect(path.direction, normal), share = s.specular;
    if (s.kind == PBRT_SURFACE_GLASS) {
        float eta = inside ? max(s.eta, 1.0) : 1.0 / max(s.eta, 1.0);
        float mirrored = reflectance(min(abs(dot(path.direction, normal)), 1.0), eta);
        if (random1(path.random) >= mirrored) {
            direction = refract(path.direction, normal, eta);
            share = s.transmission;
        }
    } else if (s.roughness > 0.0) {
        vec3 lobe = cosineDirection(direction, path.random);
        direction = normalize(mix(direction, lobe, clamp(s.roughness, 0.0, 1.0)));
    }
    path.nextDirection = direction;
    path.nextShare = share;
    path.nextSpread = path.coneSpread + s.roughness;
}

/** Adds the light of an emitter, weighted because lamps may find the same emitter. */
void meetEmitter(inout Path path, Payload s)
{
    float weight = 1.0;
    if (s.density > 0.0 && path.chance > 0.0)
        weight = weightOf(path.chance, emitterChance(s.density, s.distance,
                                                     abs(dot(s.face, path.direction))));
    path.light += path.share * s.emission * weight;
}

/** Returns whether this is the last ray, which only collects emitted light. */
bool isLast(Path path)
{
    return launch.mode == PBRT_MODE_PATH && path.depth > launch.bounces;
}

void meetForPath(inout Path path, Payload s, vec3 normal)
{
    bool inside = dot(s.normal, path.direction) > 0.0;
    meetEmitter(path, s);
    if (isLast(path))
        return;
    path.goesOn = true;
    path.albedo = s.diffuse / PI;
    path.lamp = s.diffuse == vec3(0.0) ? NO_LAMP : 0u;
    path.nextChance = 0.0;
    if (s.kind == PBRT_SURFACE_MIRROR || s.kind == PBRT_SURFACE_GLASS) {
        scatterSharply(path, s, normal, inside);
    } else {
        path.nextDirection = cosineDirection(normal, path.random);
        path.nextChance = max(dot(normal, path.nextDirection), 1.0e-20) / PI;
        path.nextShare = s.diffuse;
        path.nextSpread = DIFFUSE_SPREAD;
    }
    path.goesOn = path.nextShare != vec3(0.0);
}

void meetForOcclusion(inout Path path, Payload s, vec3 normal)
{
    path.light += s.emission;
    path.pending = previewColor(s);
    path.pendingSky = true;
    path.direction = cosineDirection(normal, path.random);
    path.origin = leave(path, path.direction);
    path.far = launch.mode == PBRT_MODE_NEAR ? 128.0 : 1.0e6;
    path.isShadow = true;
}

void meetSurface(inout Path path, Payload s)
{
    path.distance = s.distance;
    path.goesOn = false;
    path.lamp = NO_LAMP;
    if (s.distance < 0.0) {
        path.skyWeight = path.share;
        path.skyDirection = path.direction;
        path.skySpread = path.coneSpread;
        return;
    }
    path.at = path.origin + s.distance * path.direction;
    path.face = s.face;
    vec3 facing = dot(s.normal, path.direction) > 0.0 ? -s.normal : s.normal;
    bool forward = (launch.flags & PBRT_LAUNCH_FACE_FORWARD) != 0u;
    vec3 normal = forward || launch.mode != PBRT_MODE_PRIMARY ? facing : s.normal;
    path.normal = normal;
    if (s.missing || launch.mode == PBRT_MODE_PRIMARY) {
        path.light += path.share * shadePreview(s, path.at, path.direction, normal);
        path.skyWeight = path.share * previewColor(s);
        path.skyDirection = normal;
        path.skySpread = MEAN_SKY;
        return;
    }
    path.coneWidth += path.coneSpread * s.distance;
    if (launch.mode == PBRT_MODE_PATH)
        meetForPath(path, s, normal);
    else
        meetForOcclusion(path, s, normal);
}

/** Ends a shadow ray to a lamp or the sky. */
void endShadow(inout Path path, bool isFree)
{
    bool lit = !path.pendingSky || (launch.flags & PBRT_LAUNCH_DARK_SKY) != 0u;
    path.pendingSky = false;
    if (!isFree)
        return;
    if (lit) {
        path.light += path.pending;
    } else {
        path.skyWeight = path.pending;
        path.skyDirection = path.direction;
        path.skySpread = DIFFUSE_SPREAD;
    }
}

/** Sets a shadow ray to the next lamp that lights the surface. */
bool chooseLamp(inout Path path)
{
    for (; path.lamp < NO_LAMP; path.lamp++) {
        vec3 toward, color;
        float distance;
        if (path.lamp < launch.lightCount
                ? !lampAt(path.lamp, path.at, toward, distance, color)
                : !emitterAt(random3(path.random), path.at, path.normal, toward, distance, color))
            continue;
        path.pending = path.share * path.albedo * color * max(dot(path.normal, toward), 0.0);
        if (path.pending == vec3(0.0))
            continue;
        path.direction = toward;
        path.origin = leave(path, toward);
        path.far = distance * 0.9999;
        path.isShadow = true;
        path.lamp++;
        return true;
    }
    return false;
}

/** Sets the next ray, or ends the path. */
void chooseRay(inout Path path)
{
    if (path.pendingSky) /* the ray of ambient occlusion is already set */
        return;
    if (path.complete && chooseLamp(path))
        return;
    path.done = !path.goesOn || !path.complete;
    path.isShadow = false;
    path.goesOn = false;
    path.share *= path.nextShare;
    path.chance = path.nextChance;
    path.direction = path.nextDirection;
    path.origin = leave(path, path.direction);
    path.far = FAR;
    path.coneSpread = path.nextSpread;
    path.depth++;
}

#endif
