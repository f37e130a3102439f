/*
 * Computes how much of a texture a ray's pixel covers, for rays that have no dFdx and dFdy: pass the
 * derivatives to a function that ends in Grad.
 *
 * Two ways to follow the pixel along a path:
 *
 *     cone          2 floats. The pixel stays round. Exact on planes and plane mirrors; an estimate
 *                   after curved surfaces and refraction. Choose it for most rays.
 *     differential  12 floats. Exact to first order through any mirror and lens. Needs the change of
 *                   the normal on curved surfaces. Choose it where reflections are in focus.
 *
 * Call in this order. Surfaces are hit after sluicePropagateCone or sluiceTransferDifferential:
 *
 *     SluiceRayCone cone = SluiceRayCone(0.0, sluicePixelSpread(fieldOfView, height));
 *     cone = sluicePropagateCone(cone, distance);
 *     SluiceRayTriangle t = sluiceFindRayTriangle(p0, p1, p2, uv0, uv1, uv2);
 *     sluiceConeGradients(t, cone, direction, dx, dy);
 *     color = sluiceDemandGrad(index, uv, dx, dy, resident);
 *     cone = sluiceReflectCone(cone, direction, normal, curvature);
 *
 * All lengths have the same unit, which is arbitrary. Angles are in radians. Directions and normals
 * have length 1 and the space of the positions. `eta` is as in GLSL's refract: the index of refraction
 * on the ray's side divided by the index beyond. Pure functions: no definitions are necessary. Limit:
 * edges of triangles from 1e-8 to 1e8.
 *
 * Sources: Akenine-Moeller et al., "Texture Level of Detail Strategies for Real-Time Ray Tracing",
 * Ray Tracing Gems, 2019; Akenine-Moeller et al., "Improved Shader and Texture Level of Detail Using
 * Ray Cones", JCGT 10(1), 2021; Igehy, "Tracing Ray Differentials", SIGGRAPH 1999. A cone's
 * refraction is the differential of the plane of incidence.
 */
#ifndef SLUICE_RAY_FOOTPRINT_GLSL
#define SLUICE_RAY_FOOTPRINT_GLSL

/* Smallest cosine of an angle of incidence. At smaller ones footprints would become infinite. */
#define SLUICE_RAY_LEAST_COSINE 1.0e-4

/** A cone around a ray. Both numbers are signed: behind a focus the width is negative. */
struct SluiceRayCone {
    float width;  /* diameter where the ray is now */
    float spread; /* radians: growth of the width per length. Negative: the cone converges */
};

/** Derivatives of a ray by the pixel's x and y. */
struct SluiceRayDifferential {
    vec3 positionX, positionY;   /* change of the position per pixel */
    vec3 directionX, directionY; /* change of the direction, of length 1, per pixel */
};

/** A triangle, ready for steps across its plane. */
struct SluiceRayTriangle {
    vec3 normal;           /* unit vector; seen from its side, corners run counterclockwise */
    vec3 weight1, weight2; /* gradients of the barycentric weights of the second and third corner */
    vec2 uv1, uv2;         /* from the first corner to the second and third */
};

/** Returns the triangle of three positions and uvs. Without an area, all gradients are 0. */
SluiceRayTriangle sluiceFindRayTriangle(vec3 p0, vec3 p1, vec3 p2, vec2 uv0, vec2 uv1, vec2 uv2)
{
    vec3 edge1 = p1 - p0, edge2 = p2 - p0, area = cross(edge1, edge2);
    float square = dot(area, area);
    float scale = square > 0.0 ? 1.0 / square : 0.0;
    SluiceRayTriangle t;
    t.normal = area * (square > 0.0 ? inversesqrt(square) : 0.0);
    t.weight1 = cross(edge2, area) * scale;
    t.weight2 = cross(area, edge1) * scale;
    t.uv1 = uv1 - uv0;
    t.uv2 = uv2 - uv0;
    return t;
}

/** Returns the change of uv along a step. Only the part of the step in the triangle's plane counts. */
vec2 sluiceUvAlong(SluiceRayTriangle t, vec3 along)
{
    return dot(t.weight1, along) * t.uv1 + dot(t.weight2, along) * t.uv2;
}

/**
 * Returns the change of the interpolated normal, of length 1, along a step. `n0` to `n2` are the
 * normals of the corners, `weights` the barycentric weights of the second and third corner. On a
 * sphere, divide the step by the radius instead.
 */
vec3 sluiceNormalAlong(SluiceRayTriangle t, vec3 n0, vec3 n1, vec3 n2, vec2 weights, vec3 along)
{
    vec3 sum = n0 + weights.x * (n1 - n0) + weights.y * (n2 - n0);
    vec3 change = dot(t.weight1, along) * (n1 - n0) + dot(t.weight2, along) * (n2 - n0);
    return (change - dot(sum, change) / dot(sum, sum) * sum) * inversesqrt(dot(sum, sum));
}

/** Returns the LOD of derivatives of uv: log2 of the longer one in texels. `size` is in texels. */
float sluiceGradientLod(vec2 dx, vec2 dy, vec2 size)
{
    dx *= size;
    dy *= size;
    return 0.5 * log2(max(dot(dx, dx), dot(dy, dy)));
}

/* Cones */

/** Returns the spread of a primary ray's cone. `fieldOfView` belongs to `size`, in pixels. */
float sluicePixelSpread(float fieldOfView, float size)
{
    return atan(2.0 * tan(0.5 * fieldOfView) / size);
}

/** Returns the cone after a distance. */
SluiceRayCone sluicePropagateCone(SluiceRayCone cone, float distance)
{
    return SluiceRayCone(cone.width + cone.spread * distance, cone.spread);
}

float sluiceRayCosine(vec3 direction, vec3 normal)
{
    return max(abs(dot(direction, normal)), SLUICE_RAY_LEAST_COSINE);
}

/**
 * Returns the cone after a mirror. `curvature` is 1 / radius of a sphere that fits the surface:
 * positive if the surface bulges toward the ray, 0 for planes. For rough surfaces add the spread of
 * the lobe to the result.
 */
SluiceRayCone sluiceReflectCone(SluiceRayCone cone, vec3 direction, vec3 normal, float curvature)
{
    float turn = curvature * cone.width / sluiceRayCosine(direction, normal);
    return SluiceRayCone(cone.width, cone.spread + 2.0 * turn);
}

/**
 * Returns the cone after refraction. `curvature` is as for sluiceReflectCone. If all light is
 * reflected, returns the reflected cone.
 */
SluiceRayCone sluiceRefractCone(SluiceRayCone cone, vec3 direction, vec3 normal, float eta,
                                float curvature)
{
    float before = sluiceRayCosine(direction, normal);
    float square = 1.0 - eta * eta * (1.0 - before * before);
    if (square <= 0.0)
        return sluiceReflectCone(cone, direction, normal, curvature);
    float after = max(sqrt(square), SLUICE_RAY_LEAST_COSINE);
    float turn = curvature * cone.width / before; /* turn of the normal across the cone */
    return SluiceRayCone(cone.width * after / before,
                         eta * before / after * (cone.spread + turn) - turn);
}

/**
 * Returns the mean curvature of a triangle's edges from the normals of its corners, for
 * sluiceReflectCone and sluiceRefractCone. Positive if the side that the normals are on is convex:
 * negate it for rays that come from the other side.
 */
float sluiceTriangleCurvature(vec3 p0, vec3 p1, vec3 p2, vec3 n0, vec3 n1, vec3 n2)
{
    vec3 a = p1 - p0, b = p2 - p1, c = p0 - p2;
    return (dot(n1 - n0, a) / dot(a, a) + dot(n2 - n1, b) / dot(b, b) + dot(n0 - n2, c) / dot(c, c)) /
           3.0;
}

/**
 * Writes the axes, in uv, of the ellipse that a cone cuts out of a triangle's plane: `dx` in the
 * plane of incidence, `dy` across. Any axes do as derivatives of a sample.
 */
void sluiceConeGradients(SluiceRayTriangle t, SluiceRayCone cone, vec3 direction, out vec2 dx,
                         out vec2 dy)
{
    vec3 a = direction - dot(t.normal, direction) * t.normal;
    if (dot(a, a) < 1.0e-8) /* straight on: any axis does */
        a = cross(t.normal, abs(t.normal.x) > 0.5 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0));
    a *= inversesqrt(max(dot(a, a), 1.0e-30)) * cone.width;
    dx = sluiceUvAlong(t, a / sluiceRayCosine(direction, t.normal));
    dy = sluiceUvAlong(t, cross(t.normal, a));
}

/**
 * Returns the LOD of a cone on a triangle: that of its longer axis where uv is not distorted. `size`
 * is in texels. Cheaper than sluiceConeGradients, but blurs at flat angles: it is for samplers
 * without anisotropy.
 */
float sluiceConeLod(SluiceRayTriangle t, SluiceRayCone cone, vec3 direction, vec2 size)
{
    vec2 a = t.uv1 * size, b = t.uv2 * size;
    float texels = abs(a.x * b.y - a.y * b.x) * length(cross(t.weight1, t.weight2));
    return 0.5 * log2(texels) + log2(abs(cone.width) / sluiceRayCosine(direction, t.normal));
}

/* Differentials */

/**
 * Returns the differential of a camera's ray. `toward` is the direction before it is normalized,
 * `right` and `down` its change per pixel in x and y.
 */
SluiceRayDifferential sluiceCameraDifferential(vec3 toward, vec3 right, vec3 down)
{
    float scale = inversesqrt(dot(toward, toward));
    vec3 d = toward * scale;
    return SluiceRayDifferential(vec3(0.0), vec3(0.0), scale * (right - dot(d, right) * d),
                                 scale * (down - dot(d, down) * d));
}

/** Returns the differential at the ray's hit. `normal`: normal of the true surface. */
SluiceRayDifferential sluiceTransferDifferential(SluiceRayDifferential ray, vec3 direction,
                                                 float distance, vec3 normal)
{
    float facing = dot(direction, normal);
    facing = facing < 0.0 ? min(facing, -SLUICE_RAY_LEAST_COSINE) : max(facing, SLUICE_RAY_LEAST_COSINE);
    vec3 x = ray.positionX + distance * ray.directionX, y = ray.positionY + distance * ray.directionY;
    ray.positionX = x - dot(x, normal) / facing * direction;
    ray.positionY = y - dot(y, normal) / facing * direction;
    return ray;
}

vec3 sluiceReflectChange(vec3 change, vec3 direction, vec3 normal, vec3 normalChange)
{
    float facing = dot(direction, normal), turn = dot(change, normal) + dot(direction, normalChange);
    return change - 2.0 * (facing * normalChange + turn * normal);
}

/**
 * Returns the differential after a mirror. `direction`: direction of the incoming ray. `normalX` and
 * `normalY`: changes of the normal along positionX and positionY (see sluiceNormalAlong); 0 on planes.
 */
SluiceRayDifferential sluiceReflectDifferential(SluiceRayDifferential ray, vec3 direction,
                                                vec3 normal, vec3 normalX, vec3 normalY)
{
    ray.directionX = sluiceReflectChange(ray.directionX, direction, normal, normalX);
    ray.directionY = sluiceReflectChange(ray.directionY, direction, normal, normalY);
    return ray;
}

/**
 * Returns the differential after refraction. `normal` is on the side that the ray comes from, with
 * `normalX` and `normalY` as for sluiceReflectDifferential. If all light is reflected, returns the
 * reflected differential.
 */
SluiceRayDifferential sluiceRefractDifferential(SluiceRayDifferential ray, vec3 direction,
                                                vec3 normal, vec3 normalX, vec3 normalY, float eta)
{
    float before = dot(direction, normal);
    float square = 1.0 - eta * eta * (1.0 - before * before);
    if (square <= 0.0)
        return sluiceReflectDifferential(ray, direction, normal, normalX, normalY);
    float after = -max(sqrt(square), SLUICE_RAY_LEAST_COSINE);
    float bend = eta * before - after;
    float slope = eta - eta * eta * before / after;
    float turnX = dot(ray.directionX, normal) + dot(direction, normalX);
    float turnY = dot(ray.directionY, normal) + dot(direction, normalY);
    ray.directionX = eta * ray.directionX - bend * normalX - slope * turnX * normal;
    ray.directionY = eta * ray.directionY - bend * normalY - slope * turnY * normal;
    return ray;
}

/** Writes the derivatives of uv of a differential that was transferred to the triangle. */
void sluiceDifferentialGradients(SluiceRayTriangle t, SluiceRayDifferential ray, out vec2 dx, out vec2 dy)
{
    dx = sluiceUvAlong(t, ray.positionX);
    dy = sluiceUvAlong(t, ray.positionY);
}

#endif
