/* Every allocation fails once: an ordinary result, and nothing is left. */
#include "pbrt/pbrt_files.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <string.h>

static struct pbrt_files files;

static const char PLY[] =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
    "z\n"
    "property float nx\nproperty float ny\nproperty float nz\nproperty float u\nproperty float v\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 0 0 1 0 0\n"
    "1 0 0 0 0 1 1 0\n1 1 0 0 0 1 1 1\n0 1 0 0 0 1 0 1\n4 0 1 2 3\n";

static const char SCENE[] =
    "LookAt 0 -5 0 0 0 0 0 0 1\nCamera \"perspective\" \"float fov\" 40\n"
    "Film \"image\" \"integer xresolution\" 64\nWorldBegin\nLightSource \"infinite\"\n"
    "Texture \"t\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [1 0 0]\n"
    "Texture \"a\" \"float\" \"constant\" \"float value\" 0\n"
    "Attribute \"shape\" \"float radius\" 2\nCoordinateSystem \"here\"\nCoordSysTransform "
    "\"camera\"\n"
    "AttributeBegin\nAttribute \"shape\" \"float zmax\" 1\nMaterial \"matte\" \"texture Kd\" "
    "\"t\"\n"
    "Texture \"t\" \"spectrum\" \"constant\"\nAreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n"
    "Shape \"sphere\" \"texture alpha\" \"a\"\nShape \"moebius\"\nAttributeEnd\nNamedMaterial "
    "\"later\"\n"
    "ObjectBegin \"o\"\nShape \"plymesh\" \"string filename\" \"a.ply\" \"rgb Kd\" [1 1 0]\n"
    "Shape \"loopsubdiv\" \"point P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 2]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1] \"integer indices\" [0 1 2 3]\n"
    "ObjectEnd\nObjectInstance \"o\"\n"
    "MakeNamedMaterial \"later\" \"string type\" \"mix\" \"string materials\" [\"x\" \"later\"]\n"
    "Shape \"trianglemesh\" \"point P\" [0 0 0 1 0 0 0 1 0] \"normal N\" [0 0 1 0 0 1 0 0 1]\n"
    "\"float uv\" [0 0 1 0 1 1] \"integer indices\" [0 1 2]\nImport \"part.pbrt\"\n"
    "Include \"part.pbrt\" \"float radius\" 3\n";

/* Calls the queries that take no memory. */
static void ask(const SluicePbrtScene *scene)
{
    SluicePbrtTexture texture = {.structSize = sizeof texture};
    SluicePbrtMaterial material = {.structSize = sizeof material};
    SluicePbrtLight light = {.structSize = sizeof light};
    SluicePbrtShape shape = {.structSize = sizeof shape};
    SluicePbrtObject object;
    const SluicePbrtInstance *instances;
    CHECK_OK(sluiceGetPbrtTexture(scene, 2, &texture));
    CHECK_OK(sluiceGetPbrtMaterial(scene, 0, &material));
    CHECK_OK(sluiceGetPbrtLight(scene, 0, &light));
    CHECK_OK(sluiceGetPbrtShape(scene, 0, &shape));
    CHECK_OK(sluiceGetPbrtObject(scene, 0, &object));
    CHECK_OK(sluiceGetPbrtInstances(scene, &instances));
    assert_string_equal(object.pName, "o");
    assert_non_null(instances);
}

/* Everything that can be asked of a scene. The first result that is no success. */
static SluiceResult use_scene(const char *path, const char *bounds_path,
                              const SluiceAllocationCallbacks *cb)
{
    SluicePbrtSceneCreateInfo info = {
        .structSize = sizeof info, .pPath = path, .pAllocator = cb, .pBoundsPath = bounds_path};
    SluicePbrtSceneInfo counts = {.structSize = sizeof counts};
    SluicePbrtScene *scene;
    SluiceResult result = sluiceOpenPbrtScene(&info, &scene);
    if (result != SLUICE_SUCCESS) {
        assert_null(scene);
        return result;
    }
    CHECK_OK(sluiceGetPbrtSceneInfo(scene, &counts));
    assert_int_equal(counts.shapeCount, 7);
    ask(scene);
    for (uint32_t i = 0; i < counts.shapeCount && result == SLUICE_SUCCESS; i++) {
        SluicePbrtMesh mesh = {.structSize = sizeof mesh};
        SluicePbrtBounds bounds;
        result = sluiceGetPbrtShapeBounds(scene, i, &bounds);
        if (result == SLUICE_SUCCESS)
            result = sluiceReadPbrtShape(scene, i, &mesh);
        sluiceFreePbrtMesh(scene, &mesh);
    }
    if (result == SLUICE_SUCCESS)
        result = sluiceWritePbrtBounds(scene, bounds_path);
    sluiceDestroyPbrtScene(scene);
    return result;
}

static void every_refused_allocation_is_survived(void **state)
{
    (void)state;
    char path[600], bounds[600];
    pbrt_files_init(&files);
    pbrt_write(&files, "a.ply", PLY, sizeof PLY - 1);
    pbrt_write(&files, "part.pbrt", "Shape \"sphere\"", 14);
    pbrt_write(&files, "scene.pbrt", SCENE, sizeof SCENE - 1);
    strcpy(path, pbrt_path(&files, "scene.pbrt"));
    strcpy(bounds, pbrt_path(&files, "bounds"));
    CHECK_OK(use_scene(path, bounds, NULL));
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct failing_allocator allocator;
        failing_allocator_init(&allocator, n);
        allocator.refuse_count = n % 2; /* 0: all later ones, too */
        result = use_scene(path, bounds, &allocator.callbacks);
        assert_int_equal(allocator.live_count, 0);
        if (result != SLUICE_SUCCESS)
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        if (allocator.calls <= n)
            CHECK_OK(result);
        else if (result == SLUICE_SUCCESS)
            result = SLUICE_ERROR_OUT_OF_HOST_MEMORY; /* it did without */
        assert_true(n < 2000);
    }
    pbrt_files_finish(&files);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_refused_allocation_is_survived),
    };
    return RUN_TESTS(tests);
}
