/* NULL and zero in every argument of the functions of sluice-pbrt. */
#include "null_arguments/calls.h"

#include <sluice/pbrt.h>

#include <stdio.h>
#include <unistd.h>

/* clang-format off */
/* CALLS
sluiceOpenPbrtScene(&f->create, &f->out.scene) => sluiceDestroyPbrtScene(f->out.scene)
!sluiceDestroyPbrtScene(f->scene)
sluiceGetPbrtSceneInfo(f->scene, &f->out.info)
sluiceGetPbrtTexture(f->scene, 0, &f->out.texture)
sluiceGetPbrtMaterial(f->scene, 0, &f->out.material)
sluiceGetPbrtLight(f->scene, 0, &f->out.light)
sluiceGetPbrtShape(f->scene, 0, &f->out.shape)
sluiceGetPbrtObject(f->scene, 0, &f->out.object)
sluiceGetPbrtInstances(f->scene, &f->out.instances)
sluiceGetPbrtShapeBounds(f->scene, 0, &f->out.bounds)
sluiceWritePbrtBounds(f->scene, f->bounds_path)
sluiceReadPbrtShape(f->scene, 0, &f->out.mesh) => sluiceFreePbrtMesh(f->scene, &f->out.mesh)
sluiceFreePbrtMesh(f->scene, &f->out.mesh)
*/
/* clang-format on */

struct fixture {
    SluicePbrtSceneCreateInfo create;
    SluicePbrtScene *scene;
    char bounds_path[64];
    struct {
        SluicePbrtScene *scene;
        SluicePbrtSceneInfo info;
        SluicePbrtTexture texture;
        SluicePbrtMaterial material;
        SluicePbrtLight light;
        SluicePbrtShape shape;
        SluicePbrtObject object;
        const SluicePbrtInstance *instances;
        SluicePbrtBounds bounds;
        SluicePbrtMesh mesh;
    } out;
};

static char scene_path[64];

CALLS_FUNCTIONS

static void fixture_init(struct fixture *f, void **state)
{
    static const char SCENE[] = "WorldBegin\nTexture \"t\" \"spectrum\" \"constant\"\n"
                                "LightSource \"infinite\"\nObjectBegin \"o\"\nShape \"sphere\"\n"
                                "ObjectEnd\nObjectInstance \"o\"\n";
    (void)state;
    snprintf(scene_path, sizeof scene_path, "/tmp/sluice-null-%ld.pbrt", (long)getpid());
    snprintf(f->bounds_path, sizeof f->bounds_path, "/tmp/sluice-null-%ld.bounds", (long)getpid());
    FILE *file = fopen(scene_path, "w");
    assert_non_null(file);
    fputs(SCENE, file);
    fclose(file);
    f->create.structSize = sizeof f->create;
    f->create.pPath = scene_path;
    CHECK_OK(sluiceOpenPbrtScene(&f->create, &f->scene));
}

static void fixture_finish(struct fixture *f)
{
    sluiceDestroyPbrtScene(f->scene);
    unlink(scene_path);
    unlink(f->bounds_path);
}

#include "pbrt_calls.h"

int main(void)
{
    const struct CMUnitTest tests[] = {CALLS_TESTS};
    return RUN_TESTS(tests);
}
