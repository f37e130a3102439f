/* NULL and zero in every argument of the functions of proxy.h. */
#include "null_arguments/calls.h"

#include <sluice/proxy.h>

/* clang-format off */
/* CALLS
sluiceCreateProxySet(&f->create, &f->out.set) => sluiceDestroyProxySet(f->out.set)
!sluiceDestroyProxySet(f->set)
sluiceAddGeometryProxy(f->set, &f->box, &f->out.id)
sluiceAddMaterialProxy(f->materials, &f->out.id)
!sluiceRemoveProxy(f->set, f->id)
sluiceGetProxyBox(f->set, f->id, &f->out.box)
sluiceGetProxyBounds(f->set, &f->out.box)
sluiceGetProxySetInfo(f->set, &f->out.info)
sluiceAddProxyRequests(f->set, &f->requests)
sluiceGetRequestedProxies(f->set, ?&f->list, one(f), f->out.ids)
sluiceClearProxyRequests(f->set, f->id)
sluiceWriteProxyBoxes(f->set, &f->write, &f->out.version, &f->out.count)
*/
/* clang-format on */

struct fixture {
    SluiceProxySetCreateInfo create;
    SluiceProxySet *set, *materials;
    SluiceProxyBox box, boxes[64];
    SluiceProxyId id;
    SluiceProxyRequests requests;
    uint32_t indices[1], room;
    SluiceProxyListInfo list;
    SluiceProxyBoxWrite write;
    SluiceProxyRange ranges[1];
    struct {
        SluiceProxySet *set;
        SluiceProxyId id, ids[1];
        SluiceProxyBox box;
        SluiceProxySetInfo info;
        uint64_t version;
        uint32_t count;
    } out;
};

CALLS_FUNCTIONS

static uint32_t *one(struct fixture *f)
{
    f->room = 1;
    return &f->room;
}

static void fixture_init(struct fixture *f, void **state)
{
    (void)state;
    f->create = (SluiceProxySetCreateInfo){.structSize = sizeof f->create,
                                           .kind = SLUICE_PROXY_KIND_MATERIAL};
    CHECK_OK(sluiceCreateProxySet(&f->create, &f->materials));
    f->create.kind = SLUICE_PROXY_KIND_GEOMETRY;
    f->create.maxProxyCount = 64;
    CHECK_OK(sluiceCreateProxySet(&f->create, &f->set));
    f->box = (SluiceProxyBox){{0, 0, 0}, {1, 1, 1}};
    CHECK_OK(sluiceAddGeometryProxy(f->set, &f->box, &f->id));
    f->requests = (SluiceProxyRequests){.structSize = sizeof f->requests,
                                        .begunLaunch = 1,
                                        .processedLaunch = 1,
                                        .indexCount = 1,
                                        .pIndices = f->indices};
    f->list.structSize = sizeof f->list;
    f->write = (SluiceProxyBoxWrite){.structSize = sizeof f->write,
                                     .capacity = 64,
                                     .pBoxes = f->boxes,
                                     .rangeCapacity = 1,
                                     .pRanges = f->ranges};
}

static void fixture_finish(struct fixture *f)
{
    sluiceDestroyProxySet(f->set);
    sluiceDestroyProxySet(f->materials);
}

#include "proxy_calls.h"

int main(void)
{
    const struct CMUnitTest tests[] = {CALLS_TESTS};
    return RUN_TESTS(tests);
}
