/**
 * Scenes in the formats of pbrt-v3 and pbrt-v4, for renderers that load on demand.
 * Link `sluice-pbrt`.
 *
 * Opening a scene reads its text. The data of shapes stays in files until the application asks for
 * one shape. Materials, lights and textures are reduced to what a preview shows; docs/pbrt.md says
 * how. Pictures are named and not opened.
 *
 * All matrices have three rows and four columns: element [row * 4 + column], with the translation
 * in column 3. Points are column vectors. Colors are linear, with the primaries of Rec. 709.
 */
#ifndef SLUICE_PBRT_H
#define SLUICE_PBRT_H

#include <sluice/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/** An index that stands for none. */
#define SLUICE_PBRT_NONE UINT32_MAX

/** A scene. Constant after sluiceOpenPbrtScene, apart from bounds of PLY files that become known.
 */
typedef struct SluicePbrtScene SluicePbrtScene;

/** Settings of a scene. A field of zero selects its default. */
typedef struct SluicePbrtSceneCreateInfo {
    uint32_t structSize;                         ///< sizeof(SluicePbrtSceneCreateInfo).
    const char *pPath;                           ///< Required. The scene file. Copied.
    const SluiceAllocationCallbacks *pAllocator; ///< Default: malloc and free.
    /** Messages "FILE:LINE:COLUMN: TEXT". Warnings name approximated or ignored input, errors name
     *  input that is left out. At most 1000 messages while the scene is opened, and one for each
     *  later call that fails. */
    SluiceLogCallback log;
    /** File that sluiceWritePbrtBounds has written. It is read if it exists; entries of files that
     *  have changed since are not used. Default: NULL, none. */
    const char *pBoundsPath;
    uint32_t maxIncludeDepth;  ///< Files that include one another. At most 256. Default: 64.
    uint32_t maxIncludeCount;  ///< Included files in all. Default: 2^16.
    uint32_t maxBlockDepth;    ///< Blocks in blocks. At most 2^16. Default: 1024.
    uint32_t maxShapeCount;    ///< At most 2^31 - 1. Default: 2^24.
    uint32_t maxInstanceCount; ///< At most 2^31 - 1. Default: 2^26.
    uint64_t maxTextSize;      ///< Bytes of text in all, decompressed. Default: 2^38.
    uint64_t maxMeshSize;      ///< Bytes in memory of one shape that is read. Default: 2^34.
    void *pUserData;
    /** Reports the bytes of text that were read, decompressed, on the thread of
     *  sluiceOpenPbrtScene: before each 128 KiB of a file. Return false to stop with
     *  SLUICE_ERROR_CANCELED: no file is read any more, and nothing is logged. May be NULL. */
    bool (*pfnProgress)(void *pUserData, uint64_t readSize);
} SluicePbrtSceneCreateInfo;

/**
 * Opens a scene and reads its text.
 *
 * A shape, light or parameter that is malformed is left out, with a message. The rest is kept.
 * `*pScene` belongs to the caller, who destroys it with sluiceDestroyPbrtScene.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT; SLUICE_ERROR_FILE_NOT_FOUND;
 *         SLUICE_ERROR_IO; SLUICE_ERROR_CORRUPT_DATA if the text ends inside a string or list, if a
 *         matrix does not have 16 values, if the file is no text or has no WorldBegin;
 *         SLUICE_ERROR_UNSUPPORTED for compressed text if Sluice was built without zlib;
 *         SLUICE_ERROR_LIMIT_EXCEEDED; SLUICE_ERROR_CANCELED; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: any thread.
 * Source: "Input File Format" of pbrt-v3 and of pbrt-v4.
 */
SLUICE_API SluiceResult sluiceOpenPbrtScene(const SluicePbrtSceneCreateInfo *pInfo,
                                            SluicePbrtScene **pScene);

/** Destroys a scene. Free its meshes first. NULL is allowed. Thread safety: external on `scene`. */
SLUICE_API void sluiceDestroyPbrtScene(SluicePbrtScene *scene);

/** Kind of a camera. Cameras of other kinds are taken as perspective ones, with a warning. */
typedef enum SluicePbrtCameraKind {
    SLUICE_PBRT_CAMERA_PERSPECTIVE = 0,
    SLUICE_PBRT_CAMERA_ORTHOGRAPHIC = 1
} SluicePbrtCameraKind;

/** Counts of a scene, its camera and its film. */
typedef struct SluicePbrtSceneInfo {
    uint32_t structSize; ///< sizeof(SluicePbrtSceneInfo).
    uint32_t version;    ///< 3 if the scene has a WorldEnd, otherwise 4.
    uint32_t shapeCount; ///< Shapes of the world and of objects.
    uint32_t objectCount;
    uint32_t instanceCount;
    uint32_t materialCount;
    uint32_t textureCount;
    uint32_t lightCount;
    uint32_t warningCount; ///< Warnings, including those that were not logged.
    uint32_t errorCount;   ///< Errors, including those that were not logged.
    uint64_t textSize;     ///< Bytes of text that were read. A file counts each time.
    uint32_t filmWidth;    ///< Pixels. Default: 1280.
    uint32_t filmHeight;   ///< Pixels. Default: 720.
    float cropWindow[4];   ///< Part of the film to render: x0, x1, y0, y1, from 0 to 1.
    SluicePbrtCameraKind cameraKind;
    /** Camera space is left-handed: +x right, +y up, +z forward. */
    float cameraToWorld[12];
    float fieldOfView;     ///< Angle of the shorter side of a square window, in degrees.
    float screenWindow[4]; ///< x0, x1, y0, y1; [-1, 1] is the shorter side.
    float lensRadius;      ///< In camera space. 0: a pinhole.
    float focalDistance;   ///< In camera space.
} SluicePbrtSceneInfo;

/**
 * Gets counts, camera and film.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize.
 * Thread safety: may run beside calls that take a const scene.
 */
SLUICE_API SluiceResult sluiceGetPbrtSceneInfo(const SluicePbrtScene *scene,
                                               SluicePbrtSceneInfo *pInfo);

/** A constant, or a texture. Never grows. */
typedef struct SluicePbrtValue {
    float value[3];   ///< The constant, or the mean of the texture as far as it is known.
    uint32_t texture; ///< Index of the texture, or SLUICE_PBRT_NONE.
} SluicePbrtValue;

/** Kind of a texture. Textures of other kinds are constants with a typical value. */
typedef enum SluicePbrtTextureKind {
    SLUICE_PBRT_TEXTURE_CONSTANT = 0,
    SLUICE_PBRT_TEXTURE_IMAGE = 1,
    SLUICE_PBRT_TEXTURE_SCALE = 2,       ///< inputs[0] * inputs[1]
    SLUICE_PBRT_TEXTURE_MIX = 3,         ///< inputs[0] * (1 - amount) + inputs[1] * amount
    SLUICE_PBRT_TEXTURE_CHECKERBOARD = 4 ///< inputs[(floor(s) + floor(t)) & 1]
} SluicePbrtTextureKind;

/** Texels outside of [0, 1]. */
typedef enum SluicePbrtWrap {
    SLUICE_PBRT_WRAP_REPEAT = 0,
    SLUICE_PBRT_WRAP_BLACK = 1,
    SLUICE_PBRT_WRAP_CLAMP = 2,
    SLUICE_PBRT_WRAP_OCTAHEDRAL = 3
} SluicePbrtWrap;

/** Filter of a picture. */
typedef enum SluicePbrtFilter {
    SLUICE_PBRT_FILTER_DEFAULT = 0, ///< The scene does not say.
    SLUICE_PBRT_FILTER_POINT = 1,
    SLUICE_PBRT_FILTER_BILINEAR = 2,
    SLUICE_PBRT_FILTER_TRILINEAR = 3,
    SLUICE_PBRT_FILTER_EWA = 4 ///< Anisotropic.
} SluicePbrtFilter;

/** Transfer function of a picture's numbers. */
typedef enum SluicePbrtEncoding {
    SLUICE_PBRT_ENCODING_DEFAULT = 0, ///< sRGB for PNG and TGA with 8 bits, otherwise linear.
    SLUICE_PBRT_ENCODING_SRGB = 1,
    SLUICE_PBRT_ENCODING_LINEAR = 2,
    SLUICE_PBRT_ENCODING_GAMMA = 3 ///< A power: SluicePbrtTexture::gamma.
} SluicePbrtEncoding;

/** Mapping of surface points to texture coordinates. */
typedef enum SluicePbrtMapping {
    SLUICE_PBRT_MAPPING_UV = 0, ///< s = scale[0] * u + delta[0], t = scale[1] * v + delta[1]
    /** s = dot(p, axes[0..2]) + delta[0], t = dot(p, axes[3..5]) + delta[1] */
    SLUICE_PBRT_MAPPING_PLANAR = 1,
    SLUICE_PBRT_MAPPING_SPHERICAL = 2,
    SLUICE_PBRT_MAPPING_CYLINDRICAL = 3
} SluicePbrtMapping;

/** A texture. (0, 0) is the lower left corner of a picture. */
typedef struct SluicePbrtTexture {
    uint32_t structSize; ///< sizeof(SluicePbrtTexture).
    SluicePbrtTextureKind kind;
    const char *pName; ///< Lives as long as the scene, as do all strings here.
    const char *pFile; ///< Text that defines it.
    uint32_t line;     ///< In pFile, from 1.
    bool isFloat;      ///< One number, in value[0], rather than a color.
    float value[3];    ///< CONSTANT: the value. Others: the mean, if it is known, or 0.5.
    SluicePbrtValue inputs[2];
    SluicePbrtValue amount;
    const char *pImagePath; ///< IMAGE: the picture. Otherwise NULL.
    SluicePbrtWrap wrap;
    SluicePbrtFilter filter;
    SluicePbrtEncoding encoding;
    float gamma;
    float imageScale; ///< Factor of texels.
    bool invert;      ///< Texels are 1 - texel.
    float maxAnisotropy;
    SluicePbrtMapping mapping;
    float scale[2], delta[2];
    float axes[6];
    float worldToTexture[12]; ///< For mappings other than UV.
} SluicePbrtTexture;

/**
 * Gets a texture. Inputs have lower indices than the texture itself. Textures contain one another
 * at most 32 deep; the same texture may be an input of many.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize or an
 *         `index` that is not below textureCount.
 * Thread safety: may run beside calls that take a const scene.
 */
SLUICE_API SluiceResult sluiceGetPbrtTexture(const SluicePbrtScene *scene, uint32_t index,
                                             SluicePbrtTexture *pTexture);

/** Kind of a reduced material. */
typedef enum SluicePbrtMaterialKind {
    SLUICE_PBRT_MATERIAL_DIFFUSE = 0,
    SLUICE_PBRT_MATERIAL_GLOSSY = 1, ///< Diffuse below a coat.
    SLUICE_PBRT_MATERIAL_MIRROR = 2, ///< Mirrors and metals.
    SLUICE_PBRT_MATERIAL_GLASS = 3,
    SLUICE_PBRT_MATERIAL_NONE = 4, ///< No surface: rays pass.
    SLUICE_PBRT_MATERIAL_MIX = 5   ///< materials[0] * (1 - amount) + materials[1] * amount
} SluicePbrtMaterialKind;

/** A material. */
typedef struct SluicePbrtMaterial {
    uint32_t structSize; ///< sizeof(SluicePbrtMaterial).
    SluicePbrtMaterialKind kind;
    const char *pType;        ///< The scene's word: "matte", "coateddiffuse".
    SluicePbrtValue diffuse;  ///< Reflected in all directions. MIRROR and GLASS: 0.
    SluicePbrtValue specular; ///< Reflected in one direction.
    SluicePbrtValue transmission;
    SluicePbrtValue opacity; ///< 0: rays pass. 1, unless the material is "uber".
    SluicePbrtValue roughness;
    float eta;             ///< Index of refraction.
    uint32_t materials[2]; ///< MIX. Otherwise SLUICE_PBRT_NONE.
    SluicePbrtValue amount;
} SluicePbrtMaterial;

/**
 * Gets a material. No two materials are equal. Mixtures contain one another at most 32 deep.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize or an
 *         `index` that is not below materialCount.
 * Thread safety: may run beside calls that take a const scene.
 */
SLUICE_API SluiceResult sluiceGetPbrtMaterial(const SluicePbrtScene *scene, uint32_t index,
                                              SluicePbrtMaterial *pMaterial);

/** Kind of a light. */
typedef enum SluicePbrtLightKind {
    SLUICE_PBRT_LIGHT_DISTANT = 0,
    SLUICE_PBRT_LIGHT_POINT = 1,
    SLUICE_PBRT_LIGHT_SPOT = 2,
    SLUICE_PBRT_LIGHT_INFINITE = 3,
    SLUICE_PBRT_LIGHT_AREA = 4 ///< Named by shapes that emit light.
} SluicePbrtLightKind;

/** Layout of an infinite light's picture on the sphere. */
typedef enum SluicePbrtSkyLayout {
    /** u = atan2(y, x) / 2 pi, v = acos(z) / pi; row 0 shows +z. */
    SLUICE_PBRT_SKY_LATITUDE_LONGITUDE = 0,
    SLUICE_PBRT_SKY_EQUAL_AREA = 1 ///< The octahedral square of pbrt-v4.
} SluicePbrtSkyLayout;

/** A light. */
typedef struct SluicePbrtLight {
    uint32_t structSize; ///< sizeof(SluicePbrtLight).
    SluicePbrtLightKind kind;
    const char *pFile; ///< Text that defines it.
    uint32_t line;     ///< In pFile, from 1.
    float color[3];    ///< Radiance, or intensity of POINT and SPOT. A factor of the picture.
    float position[3]; ///< In world space: POINT and SPOT.
    /** Unit vector in world space. DISTANT: towards the light. SPOT: away from it. */
    float direction[3];
    float coneAngle;        ///< SPOT: half of the opening angle, in degrees.
    float coneDeltaAngle;   ///< SPOT: the light falls off over these last degrees.
    const char *pImagePath; ///< INFINITE: picture of the sky, or NULL.
    SluicePbrtSkyLayout layout;
    float lightToWorld[12];
    bool isTwoSided; ///< AREA: also emits on the back.
} SluicePbrtLight;

/**
 * Gets a light.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize or an
 *         `index` that is not below lightCount.
 * Thread safety: may run beside calls that take a const scene.
 */
SLUICE_API SluiceResult sluiceGetPbrtLight(const SluicePbrtScene *scene, uint32_t index,
                                           SluicePbrtLight *pLight);

/** Kind of a shape. Shapes of other kinds are left out, with one warning of each kind. */
typedef enum SluicePbrtShapeKind {
    SLUICE_PBRT_SHAPE_TRIANGLES = 0, ///< trianglemesh
    SLUICE_PBRT_SHAPE_PLY = 1,       ///< plymesh
    SLUICE_PBRT_SHAPE_SPHERE = 2,
    SLUICE_PBRT_SHAPE_DISK = 3,
    SLUICE_PBRT_SHAPE_CYLINDER = 4,
    SLUICE_PBRT_SHAPE_LOOP = 5,    ///< loopsubdiv
    SLUICE_PBRT_SHAPE_BILINEAR = 6 ///< bilinearmesh
} SluicePbrtShapeKind;

/** A shape of the world or of an object. */
typedef struct SluicePbrtShape {
    uint32_t structSize; ///< sizeof(SluicePbrtShape).
    SluicePbrtShapeKind kind;
    const char *pFile;       ///< Text that has the Shape.
    uint32_t line;           ///< In pFile, from 1.
    uint32_t column;         ///< In bytes, from 1.
    uint32_t object;         ///< Object that the shape is part of, or SLUICE_PBRT_NONE.
    uint32_t material;       ///< Index of the material.
    uint32_t areaLight;      ///< Index of the light that the shape is, or SLUICE_PBRT_NONE.
    SluicePbrtValue alpha;   ///< 0 cuts out. 1 if the scene says nothing.
    bool reverseOrientation; ///< Of ReverseOrientation; a mirroring transform reverses as well.
    /** From the space of the shape to the world, or to that of the object's instances. May be
     *  singular. */
    float transform[12];
    const char *pPlyPath; ///< PLY: the file. Equal pointers are equal files. Otherwise NULL.
    float radius;         ///< SPHERE, DISK, CYLINDER.
    float innerRadius;    ///< DISK.
    float zMin, zMax;     ///< SPHERE, CYLINDER. DISK: both are the height.
    float phiMax;         ///< SPHERE, DISK, CYLINDER; degrees.
    uint32_t levels;      ///< LOOP: times to subdivide, 0 to 8. Default: 3.
} SluicePbrtShape;

/**
 * Gets a shape, apart from its triangles and its bounds.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize or an
 *         `index` that is not below shapeCount.
 * Thread safety: may run beside calls that take a const scene.
 */
SLUICE_API SluiceResult sluiceGetPbrtShape(const SluicePbrtScene *scene, uint32_t index,
                                           SluicePbrtShape *pShape);

/** An object: a run of shapes that instances place. Never grows. */
typedef struct SluicePbrtObject {
    const char *pName;
    uint32_t firstShape, shapeCount;
} SluicePbrtObject;

/** An object in the world. Never grows. */
typedef struct SluicePbrtInstance {
    uint32_t object;
    float transform[12]; ///< From the space of SluicePbrtShape::transform to the world.
} SluicePbrtInstance;

/**
 * Gets an object.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT if `index` is not below
 *         objectCount.
 * Thread safety: may run beside calls that take a const scene.
 */
SLUICE_API SluiceResult sluiceGetPbrtObject(const SluicePbrtScene *scene, uint32_t index,
                                            SluicePbrtObject *pObject);

/**
 * Gets all instances: instanceCount of them, in the order of the text. They belong to the scene.
 * NULL if there are none.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 * Thread safety: may run beside calls that take a const scene.
 */
SLUICE_API SluiceResult sluiceGetPbrtInstances(const SluicePbrtScene *scene,
                                               const SluicePbrtInstance **ppInstances);

/** Bounds of a shape. Never grows. */
typedef struct SluicePbrtBounds {
    float least[3], most[3];
} SluicePbrtBounds;

/**
 * Gets the bounds of a shape after its transform: in the world, or in the space of the object's
 * instances.
 *
 * The first call for a PLY file reads its header and its vertices, once for all shapes of that
 * file; nothing is kept but the bounds. pBoundsPath saves reading them again in a later run.
 *
 * Errors, logged with the line of the Shape: SLUICE_ERROR_NULL_POINTER;
 *         SLUICE_ERROR_INVALID_ARGUMENT if `index` is not below shapeCount;
 *         SLUICE_ERROR_FILE_NOT_FOUND; SLUICE_ERROR_IO; SLUICE_ERROR_CORRUPT_DATA;
 *         SLUICE_ERROR_UNSUPPORTED; SLUICE_ERROR_LIMIT_EXCEEDED; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 *         A PLY file that failed fails again without being read, but for want of memory.
 * Thread safety: external on `scene`.
 */
SLUICE_API SluiceResult sluiceGetPbrtShapeBounds(SluicePbrtScene *scene, uint32_t index,
                                                 SluicePbrtBounds *pBounds);

/**
 * Writes the bounds of all PLY files that are known, with path, size and time of each file.
 * Replaces the file at `pPath`.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_FILE_NOT_FOUND; SLUICE_ERROR_BUSY;
 *         SLUICE_ERROR_IO; SLUICE_ERROR_OUT_OF_HOST_MEMORY. The old file stays then.
 * Thread safety: external on `scene`.
 */
SLUICE_API SluiceResult sluiceWritePbrtBounds(SluicePbrtScene *scene, const char *pPath);

/** Triangles of a shape, before its transform. Filled by sluiceReadPbrtShape. */
typedef struct SluicePbrtMesh {
    uint32_t structSize; ///< sizeof(SluicePbrtMesh).
    uint32_t vertexCount;
    uint32_t triangleCount;
    const float *pPositions;  ///< [vertexCount][3]
    const float *pNormals;    ///< [vertexCount][3], or NULL. As the file has them.
    const float *pUvs;        ///< [vertexCount][2], or NULL: (0, 0), (1, 0), (1, 1) of a triangle.
    const uint32_t *pIndices; ///< [triangleCount][3], each below vertexCount.
    uint64_t bytesRead;       ///< Bytes read from files.
} SluicePbrtMesh;

/**
 * Reads the triangles of one shape from its file.
 *
 * Spheres, disks and cylinders become 64 segments for a whole turn, loopsubdiv becomes its
 * limit surface after `levels` subdivisions, bilinear patches and quads become two triangles, and
 * larger polygons a fan. The arrays belong to the caller, who frees them with sluiceFreePbrtMesh.
 * After an error all fields of the mesh but structSize are 0, unless structSize is wrong.
 *
 * Errors, logged with the line of the Shape: SLUICE_ERROR_NULL_POINTER;
 *         SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize or an `index` that is not below
 *         shapeCount; SLUICE_ERROR_FILE_NOT_FOUND; SLUICE_ERROR_IO, also if the text has changed
 *         since the scene was opened; SLUICE_ERROR_CORRUPT_DATA; SLUICE_ERROR_UNSUPPORTED;
 *         SLUICE_ERROR_LIMIT_EXCEEDED if the mesh is larger than maxMeshSize;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: may run beside calls that take a const scene.
 */
SLUICE_API SluiceResult sluiceReadPbrtShape(const SluicePbrtScene *scene, uint32_t index,
                                            SluicePbrtMesh *pMesh);

/**
 * Frees the arrays of a mesh and sets all fields but structSize to 0. A mesh that could not be read
 * is allowed.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize.
 * Thread safety: may run beside calls that take a const scene; external on `pMesh`.
 */
SLUICE_API SluiceResult sluiceFreePbrtMesh(const SluicePbrtScene *scene, SluicePbrtMesh *pMesh);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_PBRT_H */
