#include "oracle/census.h"

#include <stdlib.h>

bool oracle_census_create(struct oracle_census *census, const struct oracle_scene *scene)
{
    size_t count = scene->place_count;
    *census =
        (struct oracle_census){.count = count,
                               .is_visible = calloc(count + 1, 1),
                               .is_entered = calloc(count + 1, 1),
                               .is_material_visible = calloc(scene->info.materialCount + 1u, 1),
                               .waiting = calloc(count + 1, sizeof *census->waiting)};
    if (!census->is_visible || !census->is_entered || !census->is_material_visible ||
        !census->waiting)
        return false;
    for (size_t i = 0; i < count; i++)
        census->waiting[census->waiting_count++] = (uint32_t)i;
    return true;
}

void oracle_census_finish(struct oracle_census *census)
{
    free(census->is_visible);
    free(census->is_entered);
    free(census->is_material_visible);
    free(census->waiting);
    *census = (struct oracle_census){0};
}

/* Clips the part of a ray between two planes of a box. */
static bool clip(double origin, double direction, double least, double most, double *from,
                 double *to)
{
    if (direction == 0)
        return origin >= least && origin <= most;
    double a = (least - origin) / direction, b = (most - origin) / direction;
    *from = fmax(*from, fmin(a, b));
    *to = fmin(*to, fmax(a, b));
    return *from <= *to;
}

static bool enters(const struct oracle_ray *ray, const struct oracle_box *box, double longest)
{
    double from = 0, to = longest;
    return clip(ray->origin.x, ray->direction.x, box->least.x, box->most.x, &from, &to) &&
           clip(ray->origin.y, ray->direction.y, box->least.y, box->most.y, &from, &to) &&
           clip(ray->origin.z, ray->direction.z, box->least.z, box->most.z, &from, &to);
}

void oracle_census_add(struct oracle_census *census, const struct oracle_scene *scene,
                       const struct oracle_ray *ray, const struct oracle_hit *hit)
{
    double longest = hit ? hit->t : 1e300;
    census->ray_count++;
    census->hit_count += hit != NULL;
    if (hit) {
        const struct oracle_place *place = &scene->places[hit->place];
        census->is_visible[hit->place] = 1;
        census->is_material_visible[scene->shapes[place->shape].material] = 1;
    }
    size_t kept = 0;
    for (size_t i = 0; i < census->waiting_count; i++) {
        uint32_t place = census->waiting[i];
        bool is_hit = hit && hit->place == place; /* whatever rounding says of flat boxes */
        if (is_hit || enters(ray, &scene->places[place].box, longest))
            census->is_entered[place] = 1;
        else
            census->waiting[kept++] = place;
    }
    census->waiting_count = kept;
}

size_t oracle_census_count(const uint8_t *flags, size_t count)
{
    size_t sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += flags[i];
    return sum;
}
